// SPDX-License-Identifier: BSD-3-Clause
// Samples of a file, and those of them that belong to what is shown.
import type { Geometry, Samples } from "mmbrdf";

import { type Along, fromLight } from "./scan";
import { folded, type State } from "./state";

/** How far samples may be from what is shown. */
export const near = { wavelength: 0.05, degrees: 1 };

const mostShown = 2000; // samples: the page answers in seconds to these, and the pictures have no place for more points

const radians = Math.PI / 180;

/** The angle between two directions, degrees. */
function between(thetaA: number, phiA: number, thetaB: number, phiB: number): number {
  const cosine =
    Math.cos(thetaA * radians) * Math.cos(thetaB * radians) +
    Math.sin(thetaA * radians) * Math.sin(thetaB * radians) * Math.cos((phiA - phiB) * radians);
  return Math.acos(Math.min(1, Math.max(-1, cosine))) / radians;
}

/** Samples at the light that is shown, with numbers of the file. */
export interface Near {
  /** Of `count` there one in `each`. */
  which: number[];
  count: number;
  each: number;
  geometries: Geometry[];
  /** As the worker takes them. */
  places: Float64Array;
}

export const nothing: Near = { which: [], count: 0, each: 1, geometries: [], places: new Float64Array() };

/** An incident direction and a wavelength of which there are samples. */
export interface Incidence {
  wavelength: number;
  thetaI: number;
  phiI: number;
  count: number;
}

export class Measured {
  readonly #places: Float64Array;
  readonly incidences: Incidence[];

  constructor(readonly samples: Samples) {
    this.#places = samples.places;
    for (let i = 0; i < samples.count; ++i) for (const k of [5 * i + 1, 5 * i + 3]) this.#places.set(folded(this.#places[k], this.#places[k + 1]), k);
    const found = new Map<string, Incidence>();
    let known: Incidence | undefined;
    for (let i = 0; i < samples.count; ++i) {
      const asBefore = [0, 1, 2].every((k) => this.#places[5 * i + k] === this.#places[5 * i - 5 + k]);
      if (!known || !asBefore) known = this.#incidence(i, found);
      known.count += 1;
    }
    this.incidences = [...found.values()].sort((a, b) => a.wavelength - b.wavelength || a.thetaI - b.thetaI || a.phiI - b.phiI);
  }

  /** Of a sample; a new one is added. */
  #incidence(i: number, found: Map<string, Incidence>): Incidence {
    const [wavelength, thetaI, phiI] = this.#places.subarray(5 * i, 5 * i + 3);
    const key = [1e3 * wavelength, 1e6 * thetaI, 1e6 * phiI].map(Math.round).join();
    const digits = (value: number, places: number) => Number(value.toFixed(places));
    const known = found.get(key) ?? { wavelength: digits(wavelength, 4), thetaI: digits(thetaI, 6), phiI: digits(phiI, 6), count: 0 };
    found.set(key, known);
    return known;
  }

  place(i: number): { wavelength: number; geometry: Geometry } {
    const [wavelength, thetaI, phiI, thetaR, phiR] = this.#places.subarray(5 * i, 5 * i + 5);
    return { wavelength, geometry: { thetaI, phiI, thetaR, phiR } };
  }

  near(state: State): Near {
    const all: number[] = [];
    for (let i = 0; i < this.samples.count; ++i) {
      const [wavelength, thetaI] = [this.#places[5 * i], this.#places[5 * i + 1]];
      if (Math.abs(wavelength - state.wavelength) > near.wavelength || Math.abs(thetaI - state.thetaI) > near.degrees) continue;
      if (between(thetaI, this.#places[5 * i + 2], state.thetaI, state.phiI) <= near.degrees) all.push(i);
    }
    const each = Math.ceil(all.length / mostShown) || 1;
    const which = all.filter((_, i) => i % each === 0);
    const places = new Float64Array(which.flatMap((i) => [...this.#places.subarray(5 * i + 1, 5 * i + 5)]));
    return { which, count: all.length, each, geometries: which.map((i) => this.place(i).geometry), places };
  }

  /** The incidence that is nearest to what is shown: of the nearest wavelength and polar angle the nearest azimuth. */
  nearest({ wavelength, thetaI, phiI }: State): Incidence {
    const off = (one: Incidence) =>
      1e6 * Math.abs(one.wavelength - wavelength) + 1e3 * Math.abs(one.thetaI - thetaI) + Math.abs(fromLight(one.phiI, phiI));
    return this.incidences.reduce((best, one) => (off(one) < off(best) ? one : best));
  }
}

/** Where samples are along a curve; undefined where they are beside it. */
export function alongCurve(state: State, { kind }: Along, geometry: Geometry): number | undefined {
  const turn = fromLight(geometry.phiR!, geometry.phiI!);
  const off = Math.asin(Math.min(1, Math.abs(Math.sin(geometry.thetaR * radians) * Math.sin(turn * radians)))) / radians;
  if (kind === "plane") return off > near.degrees ? undefined : Math.abs(turn) < 90 ? -geometry.thetaR : geometry.thetaR;
  if (kind === "azimuth") return Math.abs(geometry.thetaR - state.thetaR) > near.degrees ? undefined : turn;
  return undefined;
}

/** The nearest sample to the chosen direction, if one is near. */
export function atCursor(state: State, { geometries }: Near): number | undefined {
  const off = geometries.map(({ thetaR, phiR }) => between(thetaR, phiR!, state.thetaR, state.phiR));
  const least = off.reduce((best, one, i) => (one < off[best] ? i : best), 0);
  return off[least] <= near.degrees ? least : undefined;
}
