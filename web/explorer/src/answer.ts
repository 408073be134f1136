// SPDX-License-Identifier: BSD-3-Clause
// The matrix of the chosen direction, in numbers and words, and the tables beside it.
import type { Mmbrdf, ModelAt } from "mmbrdf";

import { element } from "./dom";
import { toPlaceOf, uncertaintyText, withoutRounding } from "./numbers";
import { chosen, type State } from "./state";
import type { Reply } from "./worker";

/** Of a sum whose terms are as large as `size`. */
function numberText(state: State, value: number, u: number | null, size = 0): string {
  return state.digits ? String(value) : toPlaceOf(withoutRounding(value, size), u);
}

/** The matrix at once; what the worker said of it stays until it answers again. */
export function showMatrix(state: State, at: ModelAt, reply?: Reply) {
  const matrix = at.evaluate(chosen(state), state);
  const u = reply?.u;
  const uText = (one: number | undefined) => (one === undefined ? "…" : state.digits ? String(one) : uncertaintyText(one));
  const body = element("matrix").querySelector("tbody")!;
  body.innerHTML = "";
  for (let row = 0; row < 4; ++row) {
    const line = body.insertRow();
    for (let column = 0; column < 4; ++column) {
      const e = 4 * row + column;
      const cell = line.insertCell();
      const name = `${state.normalized && e ? "m" : "f"}${row + 1}${column + 1}`;
      cell.dataset.element = name;
      cell.innerHTML = `<small>${name}</small><span class="value"></span> <small>± <span class="u"></span></small>`;
      cell.querySelector(".value")!.textContent = numberText(state, matrix[e], u ? u[e] : null, state.normalized && e ? 1 : matrix[0]);
      cell.querySelector(".u")!.textContent = uText(u?.[e]);
    }
  }
  element("matrix").querySelector("caption")!.textContent = state.normalized
    ? "f11 in sr⁻¹, all others divided by it; with standard uncertainties"
    : "In sr⁻¹, with standard uncertainties";
  showWords(state, at, matrix[0], u ? u[0] : null, reply);
}

const insideWords: Record<string, string> = {
  ok: "Inside the fitted range.",
  interpolated: "Inside the fitted range, interpolated between wavelengths.",
  unknown: "The fitted range is not known.",
};

function showWords(state: State, at: ModelAt, f11: number, u: number | null, reply?: Reply) {
  const [where] = at.outside(chosen(state));
  const yes = (is: boolean | null | undefined, words: string, not: string) => (is === undefined || is === null ? "" : is ? words : not);
  const words = element("words");
  words.innerHTML = '<span id="f11"></span> <span class="beyond"></span> <span id="validity"></span> <span id="physical"></span>';
  element("f11").textContent =
    `f11 = ${numberText(state, f11, u)} sr⁻¹, ` +
    (u === null && at.model.hasUncertainty && !reply
      ? "its uncertainty is being computed."
      : u === null || Number.isNaN(u)
        ? "its uncertainty is not known."
        : `standard uncertainty ${state.digits ? u : uncertaintyText(u)} sr⁻¹.`);
  words.querySelector(".beyond")!.textContent = where.extrapolated ? `Extrapolated: ${where.line}.` : "";
  element("validity").textContent = where.extrapolated ? "" : (insideWords[where.validity] ?? where.validity);
  element("physical").textContent =
    yes(reply?.answer?.realizable, "Realizable: a scatterer can have this matrix.", "Not realizable: no scatterer has this matrix.") +
    yes(reply?.answer?.estimable, "", " The data of the fit do not determine every element here.");
}

export function showTables(state: State, mmbrdf: Mmbrdf, reply: Reply) {
  const answer = reply.answer!;
  const rows = element("quantities").querySelector("tbody")!;
  rows.innerHTML = "";
  for (const { name, value, uncertainty } of answer.quantities) {
    const known = mmbrdf.quantities.find((one) => one.name === name)!;
    const row = rows.insertRow();
    row.dataset.quantity = name;
    const head = document.createElement("th");
    head.scope = "row";
    head.textContent = name.replaceAll("_", " ");
    head.title = known.meaning;
    row.append(head);
    const size = known.unit === "sr^-1" ? answer.elements[0]! : 1;
    row.insertCell().textContent = value === null ? "no meaning here" : numberText(state, value, uncertainty, size);
    row.insertCell().textContent = state.digits && uncertainty !== null ? String(uncertainty) : uncertaintyText(uncertainty);
    row.insertCell().textContent = known.unit.replace("^-1", "⁻¹") || "1";
  }
  const parts = element("parts").querySelector("tbody")!;
  parts.innerHTML = "";
  for (const { name, u_f11 } of answer.budget) {
    const row = parts.insertRow();
    row.insertCell().textContent = name;
    row.insertCell().textContent = uncertaintyText(u_f11);
  }
  if (!answer.budget.length) parts.insertRow().insertCell().textContent = "not known of this model";
}
