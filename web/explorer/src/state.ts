// SPDX-License-Identifier: BSD-3-Clause
// What is shown, and the link that says it.
import type { Frame, Geometry, StokesConvention } from "mmbrdf";

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
  /** What runs along a curve of directions: θr in the plane of incidence, or the azimuth at fixed polar angles. */
  scan: "plane" | "azimuth";
  /** Elements that are fed by the modes of a curve of coefficients. */
  block: string;
  /** Another model; empty: none. */
  compare: string;
  /** Which of both the hemispheres show. */
  shown: "model" | "other" | "difference";
  /** What points of samples show. */
  points: "values" | "residuals" | "over_u";
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
  scan: "plane",
  block: "11",
  compare: "",
  shown: "model",
  points: "values",
  limits: [],
};

export const angles = ["thetaI", "phiI", "thetaR", "phiR"] as const;

export const longest = 1e9; // nm: models know none above a metre
/** What the fields take. */
export const allowed = {
  wavelength: `1 to ${longest} nm`,
  thetaI: "0 to 90 degrees",
  phiI: "A number of degrees",
  thetaR: "0 to 90 degrees",
  phiR: "A number of degrees",
};

export function toLink(state: State): string {
  const parameters = new URLSearchParams();
  for (const [name, value] of Object.entries(state))
    if (String(value) !== String(start[name as keyof State]) || name === "model" || name === "wavelength")
      parameters.set(name, String(value));
  return "#" + parameters.toString();
}

/** What a link asks for. */
export interface Asked {
  /** The rest is as at the start. Which values are allowed the page knows. */
  state: State;
  /** What it names. */
  named: Set<string>;
  /** Sentences on what is not understood. */
  lines: string[];
}

export function fromLink(hash: string): Asked {
  const state: Record<string, unknown> = { ...start };
  const named = new Set<string>();
  const lines: string[] = [];
  for (const [name, value] of new URLSearchParams(hash.replace(/^#/, ""))) {
    if (!name) continue;
    const usual = Object.hasOwn(start, name) ? start[name as keyof State] : undefined;
    if (usual === undefined) lines.push(`${name} of the link means nothing here`);
    else if (Array.isArray(usual)) state[name] = value ? value.split(",").map(Number) : usual;
    else if (typeof usual === "string") state[name] = value;
    else if (typeof usual === "boolean" && /^(true|false)$/.test(value)) state[name] = value === "true";
    else if (typeof usual === "number" && value.trim() !== "" && Number.isFinite(Number(value))) state[name] = Number(value);
    else {
      lines.push(`${name} = ${value} of the link must be ${typeof usual === "number" ? "a number" : "true or false"}: ${usual} is shown`);
      continue;
    }
    named.add(name);
  }
  return { state: state as unknown as State, named, lines };
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

/** What of a link is not allowed, or not among these words, is as at the start, and a sentence says so. */
export function understood(asked: Asked, known: Record<(typeof choices)[number], string[]>): { state: State; line: string } {
  const state = { ...asked.state };
  const lines = [...asked.lines];
  for (const name of choices) {
    if (known[name].includes(state[name])) continue;
    lines.push(`${name} = ${state[name]} of the link must be one of ${known[name].join(", ")}: ${start[name]} is shown`);
    Object.assign(state, { [name]: start[name] });
  }
  const refuse = (name: (typeof angles)[number] | "wavelength", allowed: string) => {
    lines.push(`${name} = ${state[name]} of the link must be ${allowed}: ${start[name]} is shown`);
    state[name] = start[name];
  };
  if (!(state.wavelength >= 1 && state.wavelength <= longest)) refuse("wavelength", `1 to ${longest} nm`);
  for (const name of ["thetaI", "thetaR"] as const) if (!(Math.abs(state[name]) <= 90)) refuse(name, "0 to 90 degrees");
  for (const name of ["phiI", "phiR"] as const) if (!(Math.abs(state[name]) <= 1e6)) refuse(name, "an azimuth in degrees");
  [state.thetaI, state.phiI] = folded(state.thetaI, state.phiI);
  [state.thetaR, state.phiR] = folded(state.thetaR, state.phiR);
  if (state.limits.length && !areLimits(state.limits)) {
    lines.push("limits of the link must be 16 pairs, each of a smaller and a larger number: the colour scales are not locked");
    state.limits = [];
  }
  return { state, line: lines.map((one) => `${one}.`).join(" ") };
}

/** Germer (2017): f11 from 0.25 to 0.45 sr^-1, the others, divided by it, 0.1 to both sides of 0. */
export const paperLimits = [...Array(16).keys()].flatMap((e) => (e ? [-0.1, 0.1] : [0.25, 0.45]));

export const areOfPaper = ({ limits, normalized }: State) => normalized && String(limits) === String(paperLimits);

/** What is chosen from a list that is the same for all models. */
export const choices = ["frame", "convention", "projection", "curve", "scan", "shown", "points"] as const;

/** Where the matrix is. */
export function chosen({ thetaI, phiI, thetaR, phiR }: State): Geometry {
  return { thetaI, phiI, thetaR, phiR };
}
