// SPDX-License-Identifier: BSD-3-Clause
// What is shown, and the link that says it.
import type { Frame, StokesConvention } from "mmbrdf";

export interface State {
  model: string;
  wavelength: number;
  thetaI: number;
  phiI: number;
  thetaR: number;
  phiR: number;
  frame: Frame;
  convention: StokesConvention;
  projection: "projected" | "lambert";
  normalized: boolean;
  digits: boolean;
  curve: string;
  /** Of the colour scales, 32 numbers: empty where they follow the picture. */
  limits: number[];
}

export const start: State = {
  model: "ptfe",
  wavelength: 532,
  thetaI: 45,
  phiI: 0,
  thetaR: 30,
  phiR: 180,
  frame: "xy",
  convention: "germer2017",
  projection: "projected",
  normalized: false,
  digits: false,
  curve: "polarized",
  limits: [],
};

export const angles = ["thetaI", "phiI", "thetaR", "phiR"] as const;

export function toLink(state: State): string {
  const parameters = new URLSearchParams();
  for (const [name, value] of Object.entries(state))
    if (String(value) !== String(start[name as keyof State]) || name === "model" || name === "wavelength")
      parameters.set(name, String(value));
  return "#" + parameters.toString();
}

/** What of a link is understood; the rest is as at the start. Which values are allowed the page knows. */
export function fromLink(hash: string): State {
  const parameters = new URLSearchParams(hash.replace(/^#/, ""));
  const state: Record<string, unknown> = { ...start };
  for (const [name, value] of parameters) {
    const usual = (start as unknown as Record<string, unknown>)[name];
    if (Array.isArray(usual)) {
      if (value) state[name] = value.split(",").map(Number);
    } else if (typeof usual === "number") {
      if (value !== "" && Number.isFinite(Number(value))) state[name] = Number(value);
    } else if (typeof usual === "boolean") {
      state[name] = value === "true";
    } else if (typeof usual === "string") {
      state[name] = value;
    }
  }
  return state as unknown as State;
}

/** Of sixteen colour scales, the lower end and the upper one, as the numbers of the pictures hold them. */
export function areLimits(limits: number[]): boolean {
  const held = limits.map(Math.fround);
  return held.length === 32 && held.every((one, i) => Number.isFinite(one) && (i % 2 === 0 || held[i - 1] < one));
}

/** A polar angle in 0 ... 90 and an azimuth in -180 ... 180, of others; what is inside keeps its digits. */
export function folded(theta: number, phi: number): [number, number] {
  if (theta >= 0 && theta <= 90 && phi > -180 && phi <= 180) return [theta, phi];
  const [t, p] = theta < 0 ? [-theta, phi + 180] : [theta, phi];
  const round = (x: number) => Number(x.toPrecision(12)); // without the rounding of a sum
  const turned = round(p - 360 * Math.floor((p + 180) / 360));
  return [Math.min(90, t), turned === -180 ? 180 : turned];
}
