// SPDX-License-Identifier: BSD-3-Clause
// The page: one state, which controls, pictures, words and the link show.
import wasmText from "virtual:wasm";

import load, { type Mmbrdf, type Model, type ModelAt } from "mmbrdf";

import { type Chart, drawn, standalone } from "./chart";
import { Hemispheres } from "./hemispheres";
import { toPlaceOf, uncertaintyText, withoutRounding } from "./numbers";
import { cursor, dhrAngles, scanned } from "./scan";
import { allowed, angles, fromLink, longest, start, type State, toLink, understood } from "./state";
import "./style.css";
import { csv, pythonLines, programLines, save } from "./take";
import type { Question, Reply } from "./worker";
import Beside from "./worker?worker&inline";

const element = <T extends HTMLElement = HTMLElement>(id: string) => document.getElementById(id) as T;
const polarized = ["f_ss", "f_pp", "f_sp", "f_ps"];
const coverage = 1.96; // of a normal distribution, 95 %

async function bytesOf(text: string): Promise<Uint8Array> {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

class Page {
  state: State;
  model!: Model;
  at!: ModelAt;
  reply?: Reply;
  limits: number[] = [];
  readonly files = new Map<string, { contents: Uint8Array; path: string; opened: string }>();
  readonly hemispheres: Hemispheres;
  readonly beside = new Beside();
  #opened = 0; // number of the last file
  #asked = 0; // number of the last question to the worker
  #busy = true; // the worker answers one question at a time
  #drawing = false;
  #failed = false; // to show the state
  #chart = "";

  constructor(
    readonly mmbrdf: Mmbrdf,
    wasm: Uint8Array,
  ) {
    this.state = fromLink(location.hash);
    this.hemispheres = new Hemispheres(mmbrdf, (what, [theta, phi]) =>
      this.change(what === "source" ? { thetaI: theta, phiI: phi } : { thetaR: theta, phiR: phi }),
    );
    this.#fillChoices();
    this.#listen();
    this.#open(this.state.model, this.state, true);
    this.beside.onmessage = ({ data }: MessageEvent<Reply>) => this.#answered(data);
    this.beside.onerror = () => this.#trouble("Uncertainties cannot be computed: this browser starts no worker");
    this.beside.postMessage({ wasm });
  }

  // ---- controls ------------------------------------------------------------------------------------------------------

  #fillChoices() {
    for (const name of this.mmbrdf.materials) element("model").append(new Option(name, name));
    const curves: [string, string][] = [["polarized", "co- and cross-polarized BRDF, plane of incidence"], ["f11", "f11, plane of incidence"]];
    for (const { name, meaning } of this.mmbrdf.quantities)
      if (!polarized.includes(name)) curves.push([name, `${name.replaceAll("_", " ")}: ${meaning}`]);
    curves.push(["dhr", "directional-hemispherical reflectance against θi"]);
    for (const [value, words] of curves) element("curve").append(new Option(words, value));
  }

  /** Says at a field what it takes, and at the answer that it is of what was there before. */
  #valid(input: HTMLInputElement, is: boolean) {
    const id = input.id as keyof typeof allowed;
    input.setAttribute("aria-invalid", String(!is));
    element(`${id}-wrong`).textContent = is ? "" : `${allowed[id]}. Shown is ${this.state[id]}.`;
    const wrong = document.querySelectorAll("#controls [aria-invalid=true]").length;
    element("former").textContent = wrong ? "A field is not filled in rightly: this is the answer of its former value." : "";
  }

  #listen() {
    for (const id of Object.keys(allowed) as (keyof typeof allowed)[]) {
      const input = element<HTMLInputElement>(id);
      const words = document.createElement("p");
      Object.assign(words, { id: `${id}-wrong`, className: "wrong", role: "alert" });
      input.closest("label")!.after(words);
      input.setAttribute("aria-describedby", words.id);
      input.addEventListener("input", () => {
        const good = input.value !== "" && input.checkValidity() && (id !== "wavelength" || Number(input.value) <= longest);
        this.#valid(input, good);
        if (good) this.change({ [id]: Number(input.value) }, input);
      });
    }
    for (const id of ["frame", "convention", "projection", "curve"] as const)
      element<HTMLSelectElement>(id).addEventListener("change", (event) =>
        this.change({ [id]: (event.target as HTMLSelectElement).value }),
      );
    for (const id of ["normalized", "digits"] as const)
      element<HTMLInputElement>(id).addEventListener("change", (event) =>
        this.change({ [id]: (event.target as HTMLInputElement).checked, ...(id === "normalized" ? { limits: [] } : {}) }),
      );
    element<HTMLInputElement>("locked").addEventListener("change", (event) =>
      this.change({ limits: (event.target as HTMLInputElement).checked ? this.limits : [] }),
    );
    element<HTMLSelectElement>("model").addEventListener("change", (event) => this.#open((event.target as HTMLSelectElement).value));
    element<HTMLInputElement>("file").addEventListener("change", (event) => {
      const input = event.target as HTMLInputElement;
      const [file] = input.files ?? [];
      if (file) void this.#read(file).then(() => (input.value = "")); // so that the same file can be opened again
    });
    element("controls").addEventListener("submit", (event) => event.preventDefault());
    addEventListener("dragover", (event) => {
      event.preventDefault();
      document.body.classList.add("dropping");
    });
    addEventListener("dragleave", () => document.body.classList.remove("dropping"));
    addEventListener("drop", (event) => {
      event.preventDefault();
      document.body.classList.remove("dropping");
      const file = event.dataTransfer?.files[0];
      if (file) void this.#read(file);
    });
    const ofCurve = (id: "csv" | "svg", contents: () => string, type: string) =>
      element(id).addEventListener("click", () => {
        if (this.reply && !this.#drawing) return save(`${this.#fileName()}.${id}`, contents(), type);
        const why = this.#busy || this.#drawing ? "not there yet: its uncertainties are being computed" : "not known";
        element("take-state").textContent = `The curve is ${why}.`;
      });
    ofCurve("csv", () => csv(this.state, this.reply!.curves!, this.mmbrdf, this.at), "text/csv");
    ofCurve("svg", () => standalone(this.#chart), "image/svg+xml");
    element("png").addEventListener("click", async () => save("hemispheres.png", await this.hemispheres.png()));
    element("link").addEventListener("click", async () => {
      await navigator.clipboard?.writeText(location.href).catch(() => undefined);
      element("link").textContent = "The link is in the address bar, and copied";
    });
    addEventListener("hashchange", () => {
      if (location.hash === toLink(this.state)) return;
      const asked = fromLink(location.hash);
      this.#open(asked.model, asked);
    });
  }

  // ---- models --------------------------------------------------------------------------------------------------------

  async #read(file: File) {
    const contents = new Uint8Array(await file.arrayBuffer());
    try {
      this.mmbrdf.model(contents, file.name).free();
    } catch (error) {
      this.#trouble((error as Error).message);
      return;
    }
    const name = this.mmbrdf.materials.includes(file.name) ? `${file.name} (file)` : file.name;
    if (!this.files.has(name)) element("model").append(new Option(name, name));
    this.files.set(name, { contents, path: file.name, opened: `file ${(this.#opened += 1)}` });
    this.#open(name);
  }

  /** Another model, and what a link asks of it; all that was shown stays where there is no such model. */
  #open(name: string, asked?: State, first = false) {
    let line = "";
    const file = this.files.get(name);
    try {
      const model = file ? this.mmbrdf.model(file.contents, name) : this.mmbrdf.material(name);
      if (this.model) this.model.free();
      this.model = model;
    } catch (error) {
      line = `${(error as Error).message}. A link does not hold files: open it again.`;
      if (!first) {
        this.#trouble(line);
        return this.#show();
      }
      this.model = this.mmbrdf.material((name = start.model));
    }
    if (asked) {
      const curves = Array.from(element<HTMLSelectElement>("curve").options, ({ value }) => value);
      const known = { frame: this.mmbrdf.frames, convention: this.mmbrdf.conventions, projection: ["projected", "lambert"], curve: curves };
      const { state, line: more } = understood(asked, known);
      this.state = state;
      line = [line, more].filter((one) => one).join(" ");
    }
    this.#trouble(line);
    this.at = undefined as unknown as ModelAt;
    const known = this.model.wavelengths;
    const inside = known.length && this.state.wavelength >= known[0] && this.state.wavelength <= known[known.length - 1];
    const wavelength = first || inside || !known.length ? this.state.wavelength : known[0];
    this.reply = undefined;
    this.change({ model: name, wavelength });
  }

  #trouble(words: string) {
    element("trouble").textContent = words;
  }

  // ---- showing -------------------------------------------------------------------------------------------------------

  change(some: Partial<State>, typed?: HTMLInputElement) {
    Object.assign(this.state, some);
    if (this.#drawing) return;
    this.#drawing = true;
    requestAnimationFrame(() => {
      this.#drawing = false;
      this.#show(typed);
    });
  }

  #show(typed?: HTMLInputElement) {
    const { state } = this;
    try {
      if (!this.at || this.at.wavelength !== state.wavelength) {
        const at = this.model.at(state.wavelength);
        if (this.at) this.at.free();
        this.at = at;
      }
      this.limits = this.hemispheres.show(this.at, state);
      this.hemispheres.current(state);
    } catch (error) {
      this.#failed = true;
      return this.#trouble((error as Error).message);
    }
    if (this.#failed) this.#trouble("");
    this.#failed = false;
    for (const id of ["wavelength", ...angles] as const) {
      const input = element<HTMLInputElement>(id);
      if (input === typed) continue;
      input.value = String(state[id]);
      this.#valid(input, true);
    }
    for (const id of ["model", "frame", "convention", "projection", "curve"] as const) element<HTMLSelectElement>(id).value = state[id];
    for (const id of ["normalized", "digits"] as const) element<HTMLInputElement>(id).checked = state[id];
    element<HTMLInputElement>("locked").checked = state.limits.length > 0;
    element("facts").textContent = `${this.model.basis}. Fitted: ${this.model.fittedRange}.`;
    history.replaceState(null, "", toLink(state));
    const file = this.files.get(state.model);
    const shown = file ? { ...state, model: file.path } : state; // what the program calls it
    element("program").textContent = programLines(shown, state.curve, Boolean(file));
    element("python").textContent = pythonLines(shown, Boolean(file));
    this.#ask();
    this.#showMatrix();
  }

  #geometry() {
    const { thetaI, phiI, thetaR, phiR } = this.state;
    return { thetaI, phiI, thetaR, phiR };
  }

  /** Of a sum whose terms are as large as `size`. */
  #number(value: number, u: number | null, size = 0): string {
    return this.state.digits ? String(value) : toPlaceOf(withoutRounding(value, size), u);
  }

  /** The matrix at once; what the worker said of it stays until it answers again. */
  #showMatrix() {
    const { state, reply } = this;
    const matrix = this.at.evaluate(this.#geometry(), state);
    const u = reply?.u;
    const uText = (one: number | undefined) => (one === undefined ? "…" : this.state.digits ? String(one) : uncertaintyText(one));
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
        cell.querySelector(".value")!.textContent = this.#number(matrix[e], u ? u[e] : null, state.normalized && e ? 1 : matrix[0]);
        cell.querySelector(".u")!.textContent = uText(u?.[e]);
      }
    }
    element("matrix").querySelector("caption")!.textContent = state.normalized
      ? "f11 in sr⁻¹, all others divided by it; with standard uncertainties"
      : "In sr⁻¹, with standard uncertainties";
    this.#showWords(matrix[0], u ? u[0] : null);
  }

  #showWords(f11: number, u: number | null) {
    const { reply } = this;
    const [where] = this.at.outside(this.#geometry());
    const beyond = where.extrapolated ? `Extrapolated: ${where.line}` : "";
    const inside: Record<string, string> = {
      ok: "Inside the fitted range.",
      interpolated: "Inside the fitted range, interpolated between wavelengths.",
      unknown: "The fitted range is not known.",
    };
    const yes = (is: boolean | null | undefined, words: string, not: string) => (is === undefined || is === null ? "" : is ? words : not);
    const words = element("words");
    words.innerHTML = '<span id="f11"></span> <span class="beyond"></span> <span id="validity"></span> <span id="physical"></span>';
    element("f11").textContent =
      `f11 = ${this.#number(f11, u)} sr⁻¹, ` +
      (u === null && this.model.hasUncertainty && !reply
        ? "its uncertainty is being computed."
        : u === null || Number.isNaN(u)
          ? "its uncertainty is not known."
          : `standard uncertainty ${this.state.digits ? u : uncertaintyText(u)} sr⁻¹.`);
    words.querySelector(".beyond")!.textContent = beyond && `${beyond}.`;
    element("validity").textContent = where.extrapolated ? "" : (inside[where.validity] ?? where.validity);
    element("physical").textContent =
      yes(reply?.answer?.realizable, "Realizable: a scatterer can have this matrix.", "Not realizable: no scatterer has this matrix.") +
      yes(reply?.answer?.estimable, "", " The data of the fit do not determine every element here.");
  }

  // ---- the worker ----------------------------------------------------------------------------------------------------

  #ask() {
    this.#asked += 1;
    this.reply = undefined; // it was of another question
    document.body.dataset.busy = "true";
    this.#waiting(true);
    if (!this.#busy) this.#send();
  }

  /** Whether what is computed beside is of an earlier question. */
  #waiting(is: boolean) {
    for (const id of ["quantities", "parts", "chart"]) element(id).setAttribute("aria-busy", String(is));
    for (const id of ["csv", "svg"]) element(id).setAttribute("aria-disabled", String(is));
    if (!is) element("take-state").textContent = "";
  }

  #send() {
    this.#busy = true;
    const { contents, opened = `built-in ${this.state.model}` } = this.files.get(this.state.model) ?? {};
    const question: Question = { id: this.#asked, state: { ...this.state }, opened, contents };
    this.beside.postMessage(question);
  }

  #answered(reply: Reply) {
    this.#busy = false;
    if (reply.id !== this.#asked) return this.#send();
    delete document.body.dataset.busy;
    if (reply.error) return this.#trouble(reply.error);
    this.reply = reply;
    this.#waiting(false);
    this.#showMatrix();
    this.#showTables();
    this.#showChart();
  }

  #showTables() {
    const answer = this.reply!.answer!;
    const rows = element("quantities").querySelector("tbody")!;
    rows.innerHTML = "";
    for (const { name, value, uncertainty } of answer.quantities) {
      const known = this.mmbrdf.quantities.find((one) => one.name === name)!;
      const row = rows.insertRow();
      row.dataset.quantity = name;
      const head = document.createElement("th");
      head.scope = "row";
      head.textContent = name.replaceAll("_", " ");
      head.title = known.meaning;
      row.append(head);
      row.insertCell().textContent = value === null ? "no meaning here" : this.#number(value, uncertainty, known.unit === "sr^-1" ? answer.elements[0]! : 1);
      row.insertCell().textContent = this.state.digits && uncertainty !== null ? String(uncertainty) : uncertaintyText(uncertainty);
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

  // ---- curves --------------------------------------------------------------------------------------------------------

  /** Names of what is drawn, and their x. */
  #curve(): { names: string[]; x: number[]; label: string } {
    const { curve } = this.state;
    if (curve === "dhr") return { names: ["dhr"], x: dhrAngles, label: "polar angle θi of the light, degrees" };
    return { names: curve === "polarized" ? polarized : [curve], x: scanned, label: "θr in the plane of incidence, degrees; negative on the side of the light" };
  }

  #showChart() {
    const { names, x, label } = this.#curve();
    const { model, state } = this;
    const curves = names.map((name) => {
      const { values, uncertainties } = this.reply!.curves![name];
      return { name: name.replace("_", " "), x, y: values, half: uncertainties.map((u) => coverage * u) };
    });
    const beyond: [number, number][] = [];
    const limit = state.curve === "dhr" ? model.thetaIMax : model.thetaRMax;
    if (limit !== null && state.curve !== "dhr" && -limit > x[0]) beyond.push([x[0], -limit]);
    if (limit !== null && limit < x[x.length - 1]) beyond.push([limit, x[x.length - 1]]);
    if (this.at.outside({ thetaI: state.thetaI, thetaR: 0 })[0].extrapolated && state.curve !== "dhr") beyond.splice(0, 2, [x[0], x[x.length - 1]]);
    const unit = state.curve === "dhr" ? "" : (this.mmbrdf.quantities.find(({ name }) => name === names[0])?.unit ?? "sr^-1");
    const yLabel = names.length > 1 ? "BRDF, sr⁻¹" : `${names[0].replaceAll("_", " ")}${unit ? ", sr⁻¹" : ""}`;
    const chart: Chart = { curves, xLabel: label, yLabel, beyond, at: cursor(state) };
    const words = `${yLabel} against ${label}: ${curves.map((one) => `${one.name} from ${toPlaceOf(Math.min(...one.y), null)} to ${toPlaceOf(Math.max(...one.y), null)}`).join("; ")}.`;
    this.#chart = drawn(chart, words);
    element("chart").innerHTML = this.#chart;
    element("chart-words").textContent = `${model.name} at ${state.wavelength} nm. Bands hold 95 % (1.96 u). Hatched: extrapolated.`;
  }

  #fileName() {
    return `${this.state.model.replace(/\.\w+$/, "")}-${this.state.wavelength}nm-${this.state.curve}`;
  }
}

const wasm = await bytesOf(wasmText);
new Page(await load({ wasm }), wasm);
document.body.dataset.ready = "true";
