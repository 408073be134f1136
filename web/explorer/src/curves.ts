// SPDX-License-Identifier: BSD-3-Clause
// The curve that is chosen, as a chart and in words.
import type { Mmbrdf, ModelAt, Samples, WithUncertainties } from "mmbrdf";

import { type Chart, type Curve, drawn, type Point } from "./chart";
import { element } from "./dom";
import { alongCurve, type Near } from "./measured";
import { toPlaceOf } from "./numbers";
import { residual } from "./residuals";
import { type Along, cursor } from "./scan";
import type { State } from "./state";
import type { Bands, Curves } from "./worker";

export const polarized = ["f_ss", "f_pp", "f_sp", "f_ps"];
const coverage = 1.96; // of a normal distribution, 95 %

/** All that a curve is drawn of. */
export interface Drawing {
  state: State;
  mmbrdf: Mmbrdf;
  at: ModelAt;
  other?: ModelAt;
  along: Along;
  curves: Curves[];
  samples?: Samples;
  near: Near;
}

/** Of two models that know nothing of each other. */
function difference(first: WithUncertainties, second: WithUncertainties): WithUncertainties {
  return {
    values: second.values.map((value, i) => value - first.values[i]),
    uncertainties: second.uncertainties.map((u, i) => Math.hypot(u, first.uncertainties[i])),
  };
}

/** The modes of a block, by their numbers. */
export function modesOf({ model }: ModelAt, block: string): number[] {
  return model.modes.flatMap((mode, i) => (mode.block === block ? [i] : []));
}

/** What is drawn: keys of bands, and their names. */
function chosenCurves({ state, at, curves }: Drawing): [string, string][] {
  if (state.curve === "polarized") return polarized.map((name) => [name, name.replace("_", " ")]);
  if (state.curve === "dhr_wavelength") return [["dhr", "dhr"]];
  if (state.curve !== "coefficients") return [[state.curve, state.curve.replaceAll("_", " ")]];
  const size = (i: number) => Math.max(...curves[0].bands[i].values.map(Math.abs));
  return modesOf(at, state.block)
    .sort((a, b) => size(b) - size(a))
    .slice(0, 4)
    .map((i) => {
      const { function: name, n, m, k, l } = at.model.modes[i];
      return [String(i), `${name} (${[n, m, k, l].join(", ")})`];
    });
}

function lines({ state, along, curves, other }: Drawing, chosen: [string, string][]): Curve[] {
  const of = (band: WithUncertainties, name: string, color: number, thin = false): Curve => ({
    name, x: along.x, y: band.values, half: band.uncertainties.map((u) => coverage * u), color, thin,
  });
  const [first, second] = curves.map(({ bands }: { bands: Bands }) => bands);
  const both = other && second && chosen.every(([key]) => second[key]) && along.kind !== "coefficients";
  if (both && state.shown === "difference") return chosen.map(([key, name], c) => of(difference(first[key], second[key]), `Δ ${name}`, c));
  return [
    ...chosen.map(([key, name], c) => of(first[key], name, c)),
    ...(both ? chosen.map(([key, name], c) => of(second[key], name, c, true)) : []),
  ];
}

/** Measured, where samples lie along the curve: of the model alone, not of differences of models. */
function points({ state, along, curves, samples, near, other }: Drawing, chosen: [string, string][]): Point[] {
  if (!samples || !near.which.length || (other && state.shown === "difference")) return [];
  const where = near.geometries.map((geometry) => alongCurve(state, along, geometry));
  const elements = samples.elements(near.which);
  const f11 = (list: Float64Array) => list.filter((_, i) => i % 16 === 0);
  const measured: Bands = { f11: { values: f11(elements.values), uncertainties: f11(elements.uncertainties) }, ...samples.quantities(near.which) };
  return chosen.flatMap(([key], color) =>
    where.flatMap((x, i) => {
      if (x === undefined || !measured[key] || !Number.isFinite(measured[key].values[i])) return [];
      const { value, u, difference: d, overU } = residual(measured[key], curves[0].quantities[key], i);
      return [{ x, y: value, half: coverage * u, color, residual: samples.hasUncertainty ? overU : d }];
    }),
  );
}

/** Where the model extrapolates, in x. */
function beyond({ state, at, along: { kind, x, geometries } }: Drawing): [number, number][] {
  const angles = geometries.length === x.length ? at.outside(geometries).map(({ extrapolated }) => extrapolated) : undefined;
  const outside = angles ?? x.map((wavelength) => leaves(at, wavelength) || (kind === "dhr_wavelength" && state.thetaI > (at.model.thetaIMax ?? 90)));
  const result: [number, number][] = [];
  outside.forEach((is, i) => {
    if (!is) return;
    const [from, to] = [x[Math.max(0, i - 1)], x[Math.min(x.length - 1, i + 1)]];
    const half = [(from + x[i]) / 2, (to + x[i]) / 2] as [number, number];
    const last = result[result.length - 1];
    if (last && last[1] >= half[0]) last[1] = half[1];
    else result.push(half);
  });
  return result;
}

/** Whether the wavelengths of the fit are known, and this is not between them. */
function leaves({ model: { wavelengths } }: ModelAt, wavelength: number): boolean {
  const rounding = 1e-6;
  return wavelengths.length > 0 && (wavelength < wavelengths[0] - rounding || wavelength > wavelengths[wavelengths.length - 1] + rounding);
}

function labels({ state, mmbrdf, along }: Drawing, chosen: [string, string][], change: string): string {
  if (along.kind === "coefficients") return state.block === "11" ? "coefficient, sr⁻¹" : "coefficient";
  if (chosen.length > 1) return `${change}BRDF, sr⁻¹`;
  const [[key, name]] = chosen;
  const unit = key === "dhr" ? "" : (mmbrdf.quantities.find((one) => one.name === key)?.unit ?? "sr^-1");
  return `${change}${key === "dhr" ? "directional-hemispherical reflectance" : name}${unit ? ", sr⁻¹" : ""}`;
}

/** Shows it, and returns its SVG. */
export function showCurve(drawing: Drawing): string {
  const { state, other, along, samples } = drawing;
  const chosen = chosenCurves(drawing);
  const isDifference = other !== undefined && state.shown === "difference";
  const yLabel = labels(drawing, chosen, isDifference ? "difference of " : "");
  const chart: Chart = {
    curves: lines(drawing, chosen),
    points: points(drawing, chosen),
    xLabel: along.label,
    yLabel,
    residualLabel: samples?.hasUncertainty ? "(data − model) / u" : "data − model",
    beyond: beyond(drawing),
    at: cursor(state, along),
  };
  const span = (one: Curve) => `${one.name}${one.thin ? ` of ${state.compare}` : ""} from ${toPlaceOf(Math.min(...Array.from(one.y)), null)} to ${toPlaceOf(Math.max(...Array.from(one.y)), null)}`;
  const svg = drawn(chart, `${yLabel} against ${along.label}: ${chart.curves.map(span).join("; ")}.`);
  element("chart").innerHTML = svg;
  element("chart-words").textContent = words(drawing, chart, isDifference);
  return svg;
}

function words({ state, at, other, along, samples }: Drawing, chart: Chart, isDifference: boolean): string {
  const what = along.kind === "dhr_wavelength" || along.kind === "coefficients" ? at.model.name : `${at.model.name} at ${state.wavelength} nm`;
  const parts = [isDifference ? `${state.compare} − ${what}, as if independent.` : `${what}.`];
  if (along.kind === "coefficients") return `${parts[0]} The four largest of ${modesOf(at, state.block).length} modes (n, m, k, l); the CSV has all. Hatched: extrapolated.`;
  parts.push("Bands hold 95 % (1.96 u).");
  if (other && !isDifference) parts.push(`Thin: ${state.compare}.`);
  if (samples) parts.push(chart.points.length ? `Points: ${chart.points.length} of ${samples.name}, with bars of 1.96 u where it is stated.` : `No samples of ${samples.name} lie on this curve.`);
  return [...parts, "Hatched: extrapolated."].join(" ");
}
