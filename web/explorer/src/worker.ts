// SPDX-License-Identifier: BSD-3-Clause
// Uncertainties, beside the page: the first one of a model takes seconds, in which the page goes on.
import load, { type Answer, type Mmbrdf, type Model, type ModelAt } from "mmbrdf";

import { dhrAngles, inPlane } from "./scan";
import { chosen, type State } from "./state";

export interface Question {
  id: number;
  state: State;
  /** Which model it is: other for each file that was opened, whatever its name. */
  opened: string;
  /** The file of the model; none of a built-in one. */
  contents?: Uint8Array;
}

export interface Band {
  values: Float64Array;
  uncertainties: Float64Array;
}

export interface Reply {
  id: number;
  error?: string;
  answer?: Answer;
  /** Standard uncertainties of the elements as they are shown. */
  u?: Float64Array;
  /** Over thetas: quantities in the plane of incidence, and "dhr" over the polar angle of the light. */
  curves?: Record<string, Band>;
}

let mmbrdf: Mmbrdf;
let model: Model | undefined;
let at: ModelAt | undefined;
let of = ""; // Question.opened of the model

/** What was there stays where the new one cannot be made. */
function prepared({ state, opened, contents }: Question): ModelAt {
  if (!model || of !== opened) {
    const next = contents ? mmbrdf.model(contents, state.model) : mmbrdf.material(state.model);
    at?.free();
    at = undefined;
    model?.free();
    model = next;
    of = opened;
  }
  if (!at || at.wavelength !== state.wavelength) {
    const next = model.at(state.wavelength);
    at?.free();
    at = next;
  }
  return at;
}

function reply(question: Question): Reply {
  const { state, id } = question;
  const here = prepared(question);
  const geometry = chosen(state);
  const scan = inPlane(state);
  const f11 = here.evaluate(scan).filter((_, i) => i % 16 === 0);
  const u11 = here.standardUncertainty(scan).filter((_, i) => i % 16 === 0);
  return {
    id,
    answer: here.answer(geometry, { frame: state.frame, convention: state.convention }),
    u: here.standardUncertainty(geometry, { frame: state.frame, normalized: state.normalized }),
    curves: {
      f11: { values: f11, uncertainties: u11 },
      ...here.quantities(scan),
      dhr: here.directionalHemisphericalReflectance(dhrAngles),
    },
  };
}

self.onmessage = async ({ data }: MessageEvent<{ wasm: Uint8Array } | Question>) => {
  if ("wasm" in data) {
    mmbrdf = await load({ wasm: data.wasm });
    self.postMessage({ id: 0 });
    return;
  }
  try {
    self.postMessage(reply(data));
  } catch (error) {
    self.postMessage({ id: data.id, error: (error as Error).message });
  }
};
