// SPDX-License-Identifier: BSD-3-Clause
// The page: one state, which controls, pictures, words and the link show.
import type { Mmbrdf, Model, ModelAt } from "mmbrdf";

import { showMatrix, showTables } from "./answer";
import { standalone } from "./chart";
import { Controls } from "./controls";
import { showCurve } from "./curves";
import { element } from "./dom";
import { Hemispheres } from "./hemispheres";
import { fromLink, start, type State, toLink, understood } from "./state";
import { csv, pythonLines, programLines, save } from "./take";
import type { Question, Reply } from "./worker";
import Beside from "./worker?worker&inline";

export class Page {
  state: State;
  model!: Model;
  at!: ModelAt;
  reply?: Reply;
  limits: number[] = [];
  readonly files = new Map<string, { contents: Uint8Array; path: string; opened: string }>();
  readonly hemispheres: Hemispheres;
  readonly controls: Controls;
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
    this.controls = new Controls(mmbrdf, this);
    this.#listen();
    this.open(this.state.model, this.state, true);
    this.beside.onmessage = ({ data }: MessageEvent<Reply>) => this.#answered(data);
    this.beside.onerror = () => this.#trouble("Uncertainties cannot be computed: this browser starts no worker");
    this.beside.postMessage({ wasm });
  }

  #listen() {
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
      this.open(asked.model, asked);
    });
  }

  // ---- models --------------------------------------------------------------------------------------------------------

  async read(file: File) {
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
    this.open(name);
  }

  /** Another model, and what a link asks of it; all that was shown stays where there is no such model. */
  open(name: string, asked?: State, first = false) {
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
      const known = { frame: this.mmbrdf.frames, convention: this.mmbrdf.conventions, projection: ["projected", "lambert"], curve: this.controls.curves };
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
    this.controls.show(typed);
    element("facts").textContent = `${this.model.basis}. Fitted: ${this.model.fittedRange}.`;
    history.replaceState(null, "", toLink(state));
    const file = this.files.get(state.model);
    const shown = file ? { ...state, model: file.path } : state; // what the program calls it
    element("program").textContent = programLines(shown, state.curve, Boolean(file));
    element("python").textContent = pythonLines(shown, Boolean(file));
    this.#ask();
    showMatrix(state, this.at, this.reply);
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
    showMatrix(this.state, this.at, reply);
    showTables(this.state, this.mmbrdf, reply);
    this.#chart = showCurve(this.state, this.at, this.mmbrdf, reply.curves!);
  }

  #fileName() {
    return `${this.state.model.replace(/\.\w+$/, "")}-${this.state.wavelength}nm-${this.state.curve}`;
  }
}
