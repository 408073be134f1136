// SPDX-License-Identifier: BSD-3-Clause
// Uncertainties, beside the page: the first one of a model takes seconds, in which the page goes on.
import load, { type Answer, type Mmbrdf, type Model, type ModelAt, type WithUncertainties } from "mmbrdf";

import type { Along } from "./scan";
import { chosen, type State } from "./state";

/** A model: a built-in one, or a file. */
export interface Source {
  name: string;
  /** Which it is: other for each file that was opened, whatever its name. */
  opened: string;
  contents?: Uint8Array;
}

export interface Question {
  id: number;
  /** First the chosen direction, which takes less time; then the curve, and where samples are. */
  what: "numbers" | "curves";
  state: State;
  /** One, or that and another beside it. */
  sources: Source[];
  along: Along;
  /** Where samples are, four angles each. */
  places: Float64Array;
}

export interface Numbers {
  answer: Answer;
  /** Standard uncertainties of the elements as they are shown. */
  u: Float64Array;
}

/** Over what runs along the curve: all quantities, or "dhr", or the numbers of modes. */
export type Bands = Record<string, WithUncertainties>;

export interface Curves {
  bands: Bands;
  /** Sixteen elements at each place of a sample, as they are shown, and the quantities there. */
  elements: WithUncertainties;
  quantities: Bands;
}

export interface Reply {
  id: number;
  error?: string;
  /** Of each source. */
  numbers?: Numbers[];
  curves?: Curves[];
}

let mmbrdf: Mmbrdf;

/** A model that was asked for, at the wavelength that was. What was there stays where a new one cannot be made. */
class Slot {
  #model?: Model;
  #at?: ModelAt;
  #opened = "";
  #bands: Bands = {};
  #of = ""; // of which curve they are

  at({ name, opened, contents }: Source, wavelength: number): ModelAt {
    if (!this.#model || this.#opened !== opened) {
      const next = contents ? mmbrdf.model(contents, name) : mmbrdf.material(name);
      this.#model?.free();
      [this.#model, this.#at, this.#opened] = [next, undefined, opened];
    }
    if (this.#at?.wavelength !== wavelength) {
      const next = this.#model.at(wavelength);
      this.#at?.free();
      this.#at = next;
    }
    return this.#at!;
  }

  /** Kept until another curve is asked for: the direction seen from moves along most of them. */
  bands(at: ModelAt, { along, state }: Question): Bands {
    const overWavelengths = along.kind === "dhr_wavelength" || along.kind === "coefficients";
    const of = JSON.stringify([this.#opened, along, overWavelengths || state.wavelength]);
    if (this.#of !== of) this.#bands = bands(at, along, state);
    this.#of = of;
    return this.#bands;
  }
}

const slots = [new Slot(), new Slot()];

function numbers(at: ModelAt, state: State): Numbers {
  const { frame, convention, normalized } = state;
  return {
    answer: at.answer(chosen(state), { frame, convention }),
    u: at.standardUncertainty(chosen(state), { frame, normalized }),
  };
}

/** f11, and all quantities. */
function quantities(at: ModelAt, where: Question["places"] | Along["geometries"]): Bands {
  const f11 = (elements: Float64Array) => elements.filter((_, i) => i % 16 === 0);
  return {
    f11: { values: f11(at.evaluate(where)), uncertainties: f11(at.standardUncertainty(where)) },
    ...at.quantities(where),
  };
}

function bands(at: ModelAt, along: Along, state: State): Bands {
  if (along.kind === "dhr") return { dhr: at.directionalHemisphericalReflectance(along.x) };
  if (along.kind === "plane" || along.kind === "azimuth") return quantities(at, along.geometries);
  const lists = along.x.map((wavelength) => {
    const there = at.model.at(wavelength);
    const { values, uncertainties } =
      along.kind === "coefficients"
        ? { values: there.coefficients(), uncertainties: new Float64Array(at.model.modes.length).fill(NaN) }
        : there.directionalHemisphericalReflectance(state.thetaI);
    there.free();
    return { values, uncertainties };
  });
  const of = (i: number): WithUncertainties => ({
    values: Float64Array.from(lists, ({ values }) => values[i]),
    uncertainties: Float64Array.from(lists, ({ uncertainties }) => uncertainties[i]),
  });
  return along.kind === "dhr_wavelength" ? { dhr: of(0) } : Object.fromEntries(at.model.modes.map((_, i) => [String(i), of(i)]));
}

function curves(at: ModelAt, slot: Slot, question: Question): Curves {
  const { places, state } = question;
  return {
    bands: slot.bands(at, question),
    elements: { values: at.evaluate(places, state), uncertainties: at.standardUncertainty(places, state) },
    quantities: places.length ? quantities(at, places) : {},
  };
}

function reply(question: Question): Reply {
  const { id, what, state, sources } = question;
  const ats = sources.map((source, i) => slots[i].at(source, state.wavelength));
  return what === "numbers" ? { id, numbers: ats.map((at) => numbers(at, state)) } : { id, curves: ats.map((at, i) => curves(at, slots[i], question)) };
}

self.onmessage = async ({ data }: MessageEvent<{ wasm: Uint8Array } | Question>) => {
  const id = "wasm" in data ? 0 : data.id;
  try {
    if ("wasm" in data) mmbrdf = await load({ wasm: data.wasm });
    self.postMessage("wasm" in data ? { id } : reply(data));
  } catch (error) {
    self.postMessage({ id, error: (error as Error).message });
  }
};
