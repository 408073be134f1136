// SPDX-License-Identifier: BSD-3-Clause
// What samples differ by from the model: data - model, and that over u of both together.
import type { ModelAt, WithUncertainties } from "mmbrdf";

import { atCursor, type Measured, type Near } from "./measured";
import { toPlaceOf, uncertaintyText } from "./numbers";
import type { Points } from "./points";
import type { State } from "./state";

export interface Residual {
  value: number;
  u: number;
  model: number;
  uModel: number;
  difference: number;
  /** NaN where u of the sample is not stated; that of the model counts where it is known. */
  overU: number;
}

export function residual(measured: WithUncertainties, model: WithUncertainties | undefined, i: number): Residual {
  const [value, u] = [measured.values[i], measured.uncertainties[i]];
  const [predicted, uModel] = model ? [model.values[i], model.uncertainties[i]] : [NaN, NaN];
  const difference = value - predicted;
  return { value, u, model: predicted, uModel, difference, overU: difference / Math.hypot(u, Number.isFinite(uModel) ? uModel : 0) };
}

/** The uncertainty whose digits its numbers end at: its own, or that of the model; three digits where neither says anything. */
export function placeOf({ u, uModel, difference }: Residual): number {
  const rounding = 1e-12; // of what is 0 by symmetry
  return u > 0 ? u : uModel > rounding ? uModel : Math.abs(difference) / 10;
}

/** Root mean square of what is known; NaN of nothing. */
function rms(values: number[]): number {
  const known = values.filter(Number.isFinite);
  return Math.sqrt(known.reduce((sum, one) => sum + one * one, 0) / known.length);
}

/** Of the samples that are near: sixteen residuals of each, one after the other. */
export class Residuals {
  readonly all: Residual[];

  /** `model`: its elements where they are, as the worker has them; without uncertainties until it has. */
  constructor(
    readonly state: State,
    readonly measured: Measured,
    readonly near: Near,
    at: ModelAt,
    model?: WithUncertainties,
  ) {
    const elements = measured.samples.elements(near.which, state);
    const values = model?.values ?? at.evaluate(near.places, state);
    const uncertainties = model?.uncertainties ?? new Float64Array(values.length).fill(NaN);
    this.all = Array.from(values, (_, i) => residual(elements, { values, uncertainties }, i));
  }

  points(): Points {
    const of = { values: "value", residuals: "difference", over_u: "overU" } as const;
    const values = Float64Array.from(this.all, (one) => one[of[this.state.points]]);
    const { geometries } = this.near;
    const { name } = this.measured.samples;
    const none = geometries.length > 0 && !values.some(Number.isFinite);
    if (this.state.points === "values") return { geometries, values, words: `points: ${name}, in the colours of the pictures` };
    if (this.state.points === "over_u") {
      const words = none ? `no points: ${name} does not state its uncertainties` : `points: (${name} − model) / u from −3 blue to 3 red`;
      return { geometries, values, ends: Array(16).fill(3), words };
    }
    const ends = [...Array(16).keys()].map((e) => 3 * rms(Array.from(values).filter((_, i) => i % 16 === e)) || 1);
    return { geometries, values, ends, words: `points: ${name} − model, from −3 rms blue to 3 rms red in each picture` };
  }

  /** The one at the chosen direction, if there is one. */
  atCursor(): { residuals: Residual[]; words: string } | undefined {
    const i = atCursor(this.state, this.near);
    if (i === undefined) return undefined;
    const { thetaR, phiR } = this.near.geometries[i];
    const [f11] = this.all.slice(16 * i);
    const u = Number.isFinite(f11.u) ? ` ± ${uncertaintyText(f11.u)}` : ", its uncertainty is not stated";
    const over = Number.isFinite(f11.overU) ? `, ${toPlaceOf(f11.overU, 0.1)} u of both` : "";
    const value = Number.isFinite(f11.value)
      ? `f11 = ${toPlaceOf(f11.value, placeOf(f11))} sr⁻¹${u}; data − model ${toPlaceOf(f11.difference, placeOf(f11))} sr⁻¹${over}.`
      : "f11 was not measured.";
    const words = `Sample ${this.near.which[i] + 1} of ${this.measured.samples.name}, at θr ${toPlaceOf(thetaR, null)}°, φr ${toPlaceOf(phiR!, null)}°: ${value}`;
    return { residuals: this.all.slice(16 * i, 16 * i + 16), words };
  }

  words(): string {
    const { samples } = this.measured;
    const missing = 16 - samples.measured.length;
    const about = [
      `${samples.name}: ${samples.count} ${samples.count === 1 ? "sample" : "samples"}`,
      samples.hasUncertainty ? "with uncertainties" : "without uncertainties",
      missing ? `${missing} elements were not measured and have no points` : "",
      samples.understood,
    ];
    const said = `${about.filter((one) => one).join(", ")}.`;
    if (!this.near.which.length) return `${said} None at this light and wavelength.`;
    const of11 = this.all.filter((_, i) => i % 16 === 0);
    const off = rms(of11.map(({ difference }) => difference));
    const over = rms(of11.map(({ overU }) => overU));
    const f11 = Number.isFinite(off) ? ` rms of data − model of f11: ${toPlaceOf(off, off)} sr⁻¹${Number.isFinite(over) ? `, ${toPlaceOf(over, 0.1)} u of both` : ""}.` : "";
    const { count, each } = this.near;
    const some = each > 1 ? `, of which one in ${each} is shown` : "";
    return `${said} ${count} at this light and wavelength${some}.${f11}`;
  }

  /** A row for each sample that is near, with a group of columns for each element that was measured. */
  csv(): string {
    const { samples } = this.measured;
    const names = [...Array(16).keys()].map((e) => `${this.state.normalized && e ? "m" : "f"}${1 + (e >> 2)}${1 + (e & 3)}`);
    const taken = names.flatMap((name, e) => (this.all.some((one, i) => i % 16 === e && Number.isFinite(one.value)) ? [[e, name] as const] : []));
    const group = (name: string) => [name, `u_${name}`, `model_${name}`, `u_model_${name}`, `residual_${name}`, `residual_over_u_${name}`];
    const head = ["sample", "wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg", ...taken.flatMap(([, name]) => group(name))];
    const rows = this.near.which.map((which, i) => {
      const { wavelength, geometry: g } = this.measured.place(which);
      const numbers = taken.flatMap(([e]) => {
        const one = this.all[16 * i + e];
        return [one.value, one.u, one.model, one.uModel, one.difference, one.overU];
      });
      return [which + 1, wavelength, g.thetaI, g.phiI, g.thetaR, g.phiR, ...numbers].join(",");
    });
    return [`# ${samples.name} and ${this.state.model}: elements in the frame ${this.state.frame}, signs of ${this.state.convention}`, head.join(","), ...rows, ""].join("\n").replaceAll("NaN", "");
  }
}
