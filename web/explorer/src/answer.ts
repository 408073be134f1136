// SPDX-License-Identifier: BSD-3-Clause
// The matrix of the chosen direction, in numbers and words, and the tables beside it.
import type { Answer, Mmbrdf, ModelAt } from "mmbrdf";

import { element } from "./dom";
import { placeOf, type Residual } from "./residuals";
import { toPlaceOf, uncertaintyText, withoutRounding } from "./numbers";
import { chosen, type State } from "./state";
import type { Numbers } from "./worker";

/** Of a sum whose terms are as large as `size`. */
function numberText(state: State, value: number, u: number | null, size = 0): string {
  return state.digits ? String(value) : toPlaceOf(withoutRounding(value, size), u);
}

/** What the matrix is shown with. */
export interface Beside {
  at: ModelAt;
  other?: ModelAt;
  /** What the worker said of both; nothing until it has. */
  numbers?: Numbers[];
  /** Sixteen residuals of the sample that is nearest, and what that is. */
  sample?: { residuals: Residual[]; words: string };
}

/** The matrix at once; uncertainties when the worker has them. */
export function showMatrix(state: State, beside: Beside) {
  const { at, other, numbers, sample } = beside;
  const matrix = at.evaluate(chosen(state), state);
  const u = numbers?.[0].u;
  const second = other?.evaluate(chosen(state), state);
  const body = element("matrix").querySelector("tbody")!;
  body.innerHTML = "";
  for (let row = 0; row < 4; ++row) {
    const line = body.insertRow();
    for (let column = 0; column < 4; ++column) {
      const e = 4 * row + column;
      const name = `${state.normalized && e ? "m" : "f"}${row + 1}${column + 1}`;
      const size = state.normalized && e ? 1 : matrix[0];
      const cell = line.insertCell();
      cell.dataset.element = name;
      cell.innerHTML = `<small>${name}</small><span class="value"></span> <small>± <span class="u"></span></small>`;
      cell.querySelector(".value")!.textContent = numberText(state, matrix[e], u ? u[e] : null, size);
      cell.querySelector(".u")!.textContent = uText(state, u?.[e]);
      if (second) {
        const uOther = numbers?.[1]?.u[e] ?? NaN;
        const both = Math.hypot(u?.[e] ?? NaN, uOther);
        addLine(cell, "other", `other ${numberText(state, second[e], uOther, size)}, Δ ${numberText(state, second[e] - matrix[e], both, size)}${inU(second[e] - matrix[e], both, size)}`);
      }
      const residual = sample?.residuals[e];
      if (residual && Number.isFinite(residual.value))
        addLine(cell, "measured", `data ${numberText(state, residual.value, placeOf(residual), size)}, data − model ${numberText(state, residual.difference, placeOf(residual), size)}${inU(residual.overU, 1, 0)}`);
    }
  }
  element("matrix").querySelector("caption")!.textContent = state.normalized
    ? "f11 in sr⁻¹, all others divided by it; with standard uncertainties"
    : "In sr⁻¹, with standard uncertainties";
  element("answer").classList.toggle("digits", state.digits);
  element("sample-words").textContent = sample?.words ?? "";
  showWords(state, beside, matrix[0], u ? u[0] : null);
}

const uText = (state: State, u: number | undefined) => (u === undefined ? "…" : state.digits ? String(u) : uncertaintyText(u));

/** Nothing where u is not known, or both are rounding. */
const inU = (difference: number, u: number, size: number) =>
  Number.isFinite(difference / u) && u > 1e-12 * Math.abs(size) ? ` (${toPlaceOf(difference / u, 0.1)} u)` : "";

function addLine(cell: HTMLElement, className: string, words: string) {
  const line = document.createElement("small");
  line.className = className;
  line.textContent = words;
  cell.append(line);
}

const insideWords: Record<string, string> = {
  ok: "Inside the fitted range.",
  interpolated: "Inside the fitted range, interpolated between wavelengths.",
  unknown: "The fitted range is not known.",
};

function showWords(state: State, { at, other, numbers }: Beside, f11: number, u: number | null) {
  const answer = numbers?.[0].answer;
  const [where] = at.outside(chosen(state));
  const [otherWhere] = other?.outside(chosen(state)) ?? [];
  const yes = (is: boolean | null | undefined, words: string, not: string) => (is === undefined || is === null ? "" : is ? words : not);
  const words = element("words");
  words.innerHTML = '<span id="f11"></span> <span class="beyond"></span> <span id="validity"></span> <span id="physical"></span> <span id="other-beyond" class="beyond"></span>';
  element("f11").textContent =
    `f11 = ${numberText(state, f11, u)} sr⁻¹, ` +
    (u === null && at.model.hasUncertainty && !answer
      ? "its uncertainty is being computed."
      : u === null || Number.isNaN(u)
        ? "its uncertainty is not known."
        : `standard uncertainty ${state.digits ? u : uncertaintyText(u)} sr⁻¹.`);
  words.querySelector(".beyond")!.textContent = where.extrapolated ? `Extrapolated: ${where.line}.` : "";
  element("validity").textContent = where.extrapolated ? "" : (insideWords[where.validity] ?? where.validity);
  element("physical").textContent =
    yes(answer?.realizable, "Realizable: a scatterer can have this matrix.", "Not realizable: no scatterer has this matrix.") +
    yes(answer?.estimable, "", " The data of the fit do not determine every element here.");
  element("other-beyond").textContent = otherWhere?.extrapolated ? `${state.compare} is extrapolated here: ${otherWhere.line}.` : "";
}

export function showTables(state: State, mmbrdf: Mmbrdf, answer: Answer) {
  const rows = element("quantities").querySelector("tbody")!;
  rows.innerHTML = "";
  for (const { name, value, uncertainty } of answer.quantities) {
    const known = mmbrdf.quantities.find((one) => one.name === name)!;
    const row = rows.insertRow();
    row.dataset.quantity = name;
    row.append(heading("row", name.replaceAll("_", " ")));
    const size = known.unit === "sr^-1" ? answer.elements[0]! : 1;
    row.insertCell().textContent = value === null ? (answer.elements.includes(null) ? "not known" : "no meaning here") : numberText(state, value, uncertainty, size);
    row.insertCell().textContent = state.digits && uncertainty !== null ? String(uncertainty) : uncertaintyText(uncertainty);
    row.insertCell().textContent = known.unit.replace("^-1", "⁻¹") || "1";
    row.insertCell().textContent = known.meaning;
  }
  showParts(state, mmbrdf, answer);
}

function heading(scope: "row" | "col", words: string, title = ""): HTMLElement {
  const head = document.createElement("th");
  Object.assign(head, { scope, textContent: words, title });
  return head;
}

const causes: [RegExp, string][] = [
  [/^fit$/, "noise of the data, and misfit that looks like it"],
  [/^posterior$/, "noise, the end of the basis, and the anisotropy of the sample"],
  [/^declared /, "an error that all readings share, as it was declared"],
  [/^projection$/, "what the evaluated modes miss of the mean"],
];

/** Of f11, and of the quantity of the curve if it is one. */
function showParts(state: State, mmbrdf: Mmbrdf, answer: Answer) {
  const quantity = answer.quantities.find(({ name }) => name === state.curve);
  const of = mmbrdf.quantities.find(({ name }) => name === quantity?.name);
  const table = element<HTMLTableElement>("parts");
  table.tHead!.innerHTML = "";
  const head = table.tHead!.insertRow();
  head.append(heading("col", "Cause"), heading("col", "u(f11), sr⁻¹"));
  if (of) head.append(heading("col", `u(${of.name.replaceAll("_", " ")})${of.unit ? ", sr⁻¹" : ""}`, of.meaning));
  head.append(heading("col", "What it is"));
  const body = table.tBodies[0];
  body.innerHTML = "";
  for (const { name, u_f11 } of answer.budget) {
    const row = body.insertRow();
    row.dataset.cause = name;
    row.append(heading("row", name));
    row.insertCell().textContent = uncertaintyText(u_f11);
    if (of) row.insertCell().textContent = uncertaintyText(quantity?.parts[name] ?? null);
    row.insertCell().textContent = causes.find(([is]) => is.test(name))?.[1] ?? "";
  }
  if (!answer.budget.length) body.insertRow().insertCell().textContent = "not known of this model";
}
