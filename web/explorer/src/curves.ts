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
/** A window in which the words of a wide chart would be too small. */
export const narrow = matchMedia("(max-width: 511px)");

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

/** Whether a model extrapolates at each x. */
function extrapolates(at: ModelAt, { state, along: { kind, x, geometries } }: Drawing): boolean[] {
  if (geometries.length === x.length) return at.outside(geometries).map(({ extrapolated }) => extrapolated);
  return x.map((wavelength) => leaves(at, wavelength) || (kind === "dhr_wavelength" && state.thetaI > (at.model.thetaIMax ?? 90)));
}

/** Half way to those that are not outside, in x. */
function stretches(x: number[], outside: boolean[]): [number, number][] {
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

/** Shows it, and returns its SVG and what is said of it. */
export function showCurve(drawing: Drawing): { svg: string; words: string } {
  const { state, at, other, along, samples } = drawing;
  const chosen = chosenCurves(drawing);
  const isDifference = other !== undefined && state.shown === "difference";
  const outside = extrapolates(at, drawing);
  const otherOutside = other && extrapolates(other, drawing);
  const yLabel = labels(drawing, chosen, isDifference ? "difference of " : "");
  const chart: Chart = {
    width: narrow.matches ? 400 : 640,
    curves: lines(drawing, chosen),
    points: points(drawing, chosen),
    xLabel: along.label,
    yLabel,
    residualLabel: samples?.hasUncertainty ? "(data − model) / u" : "data − model",
    beyond: stretches(along.x, isDifference ? outside.map((is, i) => is || otherOutside![i]) : outside),
    at: cursor(state, along),
  };
  const span = (one: Curve) => `${one.name}${one.thin ? ` of ${state.compare}` : ""} from ${toPlaceOf(Math.min(...Array.from(one.y)), null)} to ${toPlaceOf(Math.max(...Array.from(one.y)), null)}`;
  const svg = drawn(chart, `${yLabel} against ${along.label}: ${chart.curves.map(span).join("; ")}.`);
  element("chart").innerHTML = svg;
  const said = words(drawing, chart, otherOutside);
  element("chart-words").textContent = said;
  return { svg, words: said };
}

/** The model, and where: what runs along the curve is at its axis. */
function place({ state, at, along: { kind } }: Drawing): string {
  const { name, basis } = at.model;
  const azimuth = /^isotropic/.test(basis) ? "" : ", light from φi = 0°"; // that of reflectances, as the program has them
  return {
    plane: `${name} at ${state.wavelength} nm, light from θi = ${state.thetaI}°, φi = ${state.phiI}°`,
    azimuth: `${name} at ${state.wavelength} nm, light from θi = ${state.thetaI}°, φi = ${state.phiI}°`,
    dhr: `${name} at ${state.wavelength} nm${azimuth}`,
    dhr_wavelength: `${name}, light from θi = ${state.thetaI}°${azimuth && ", φi = 0°"}`,
    coefficients: name,
  }[kind];
}

function words(drawing: Drawing, chart: Chart, otherOutside?: boolean[]): string {
  const { state, at, other, along, samples } = drawing;
  const hatched = "Hatched: extrapolated.";
  if (along.kind === "coefficients") return `${place(drawing)}. The four largest of ${modesOf(at, state.block).length} modes (n, m, k, l); the CSV has all. ${hatched}`;
  const isDifference = other !== undefined && state.shown === "difference";
  const parts = [isDifference ? `${state.compare} − ${place(drawing)}, as if independent.` : `${place(drawing)}.`];
  const known = (list: ArrayLike<number>) => Array.from(list).some(Number.isFinite);
  if (!chart.curves.some(({ y, thin }) => !thin && known(y))) parts.push("It is not known: elements that it takes were not measured.");
  parts.push(chart.curves.some(({ half }) => known(half)) ? "Bands hold 95 % (1.96 u)." : "There are no bands: uncertainties are not known.");
  if (other && !isDifference) parts.push(`Thin: ${state.compare}${otherOutside!.every((is) => is) ? ", extrapolated" : otherOutside!.some((is) => is) ? ", extrapolated in part" : ""}.`);
  if (samples) parts.push(chart.points.length ? `Points: ${chart.points.length} of ${samples.name}, with bars of 1.96 u where it is stated.` : `No samples of ${samples.name} lie on this curve.`);
  return [...parts, hatched].join(" ");
}
