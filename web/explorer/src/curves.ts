// SPDX-License-Identifier: BSD-3-Clause
// The curve that is chosen, as a chart and in words.
import type { Mmbrdf, ModelAt } from "mmbrdf";

import { drawn } from "./chart";
import { polarized } from "./controls";
import { element } from "./dom";
import { toPlaceOf } from "./numbers";
import { cursor, dhrAngles, scanned } from "./scan";
import type { State } from "./state";
import type { Band } from "./worker";

const coverage = 1.96; // of a normal distribution, 95 %

/** Names of what is drawn, and their x. */
function chosenCurve({ curve }: State): { names: string[]; x: number[]; label: string } {
  if (curve === "dhr") return { names: ["dhr"], x: dhrAngles, label: "polar angle θi of the light, degrees" };
  return { names: curve === "polarized" ? polarized : [curve], x: scanned, label: "θr in the plane of incidence, degrees; negative on the side of the light" };
}

/** Where the model extrapolates, in x. */
function beyond(state: State, at: ModelAt, x: number[]): [number, number][] {
  const whole: [number, number] = [x[0], x[x.length - 1]];
  const { thetaIMax, thetaRMax } = at.model;
  if (state.curve === "dhr") return thetaIMax !== null && thetaIMax < whole[1] ? [[thetaIMax, whole[1]]] : [];
  if (at.outside({ thetaI: state.thetaI, thetaR: 0 })[0].extrapolated) return [whole];
  const result: [number, number][] = [];
  if (thetaRMax !== null && -thetaRMax > whole[0]) result.push([whole[0], -thetaRMax]);
  if (thetaRMax !== null && thetaRMax < whole[1]) result.push([thetaRMax, whole[1]]);
  return result;
}

/** Shows it, and returns its SVG. */
export function showCurve(state: State, at: ModelAt, mmbrdf: Mmbrdf, bands: Record<string, Band>): string {
  const { names, x, label } = chosenCurve(state);
  const curves = names.map((name) => {
    const { values, uncertainties } = bands[name];
    return { name: name.replace("_", " "), x, y: values, half: uncertainties.map((u) => coverage * u) };
  });
  const unit = state.curve === "dhr" ? "" : (mmbrdf.quantities.find(({ name }) => name === names[0])?.unit ?? "sr^-1");
  const yLabel = names.length > 1 ? "BRDF, sr⁻¹" : `${names[0].replaceAll("_", " ")}${unit ? ", sr⁻¹" : ""}`;
  const words = `${yLabel} against ${label}: ${curves.map((one) => `${one.name} from ${toPlaceOf(Math.min(...one.y), null)} to ${toPlaceOf(Math.max(...one.y), null)}`).join("; ")}.`;
  const svg = drawn({ curves, xLabel: label, yLabel, beyond: beyond(state, at, x), at: cursor(state) }, words);
  element("chart").innerHTML = svg;
  element("chart-words").textContent = `${at.model.name} at ${state.wavelength} nm. Bands hold 95 % (1.96 u). Hatched: extrapolated.`;
  return svg;
}
