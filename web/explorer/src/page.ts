// SPDX-License-Identifier: BSD-3-Clause
// The page: one state, which controls, pictures, words and the link show.
import type { Mmbrdf } from "mmbrdf";

import { Address } from "./address";
import { showMatrix, showTables } from "./answer";
import { standalone } from "./chart";
import { Controls } from "./controls";
import { narrow, showCurve } from "./curves";
import { element } from "./dom";
import { Hemispheres } from "./hemispheres";
import { type Incidence, Measured, type Near, nothing } from "./measured";
import { Shelf, Shown } from "./models";
import { mostBytes, readInParts, tooLarge } from "./reading";
import { Residuals } from "./residuals";
import { type Along, along } from "./scan";
import { type Asked, choices, fromLink, start, type State, toLink, understood } from "./state";
import { csv, type Named, pictureWords, programLines, pythonLines, save } from "./take";
import type { Curves, Numbers, Question, Reply } from "./worker";
import Beside from "./worker?worker&inline";

const noIncidences: Incidence[] = [];

export class Page {
  state: State;
  limits: number[] = [];
  readonly #shelf: Shelf;
  readonly #hemispheres: Hemispheres;
  readonly #controls: Controls;
  readonly #address = new Address(() => this.#calm());
  readonly #beside = new Beside();
  #shown!: Shown;
  #other?: Shown;
  #measured?: Measured;
  #near: Near = nothing;
  #residuals?: Residuals;
  #along!: Along;
  #numbers?: Numbers[]; // of the state that is shown, as the worker answers
  #curves?: Curves[];
  #asked = 0; // number of the last question to the worker
  #busy = true; // the worker answers one question at a time
  #open = true; // what is shown has not all its answers
  #drawing = false;
  #reading = Promise.resolve();
  #failed = false; // to show what was asked for
  #last?: State; // that was shown
  #chart = { svg: "", words: "" };

  constructor(
    readonly mmbrdf: Mmbrdf,
    wasm: Uint8Array,
  ) {
    const asked = fromLink(location.hash);
    this.state = asked.state;
    this.#shelf = new Shelf(mmbrdf);
    this.#hemispheres = new Hemispheres(mmbrdf, (what, [theta, phi]) =>
      this.change(what === "source" ? { thetaI: theta, phiI: phi } : { thetaR: theta, phiR: phi }),
    );
    this.#controls = new Controls(mmbrdf, this);
    this.#listen();
    this.open(this.state.model, asked, true);
    this.#beside.onmessage = ({ data }: MessageEvent<Reply>) => this.#answered(data);
    this.#beside.onerror = () => this.#trouble("Uncertainties cannot be computed: this browser starts no worker");
    this.#beside.postMessage({ wasm });
  }

  #listen() {
    const ofCurve = (id: "csv" | "svg" | "samples-csv", contents: () => string, name: () => string, type: string) =>
      element(id).addEventListener("click", () => {
        if (this.#curves && !this.#drawing) return save(name(), contents(), type);
        const why = this.#busy || this.#drawing ? "not there yet: its uncertainties are being computed" : "not known";
        element("take-state").textContent = `The curve is ${why}.`;
      });
    ofCurve("csv", () => csv(this.#drawn(this.#curves!)), () => `${this.#fileName()}.csv`, "text/csv");
    ofCurve("svg", () => standalone(this.#chart.svg, this.#chart.words), () => `${this.#fileName()}.svg`, "image/svg+xml");
    ofCurve("samples-csv", () => this.#residuals!.csv(), () => "samples.csv", "text/csv");
    element("png").addEventListener("click", async () => save("hemispheres.png", await this.#hemispheres.png(pictureWords(this.state, this.limits, element("legend-points").textContent!))));
    element("link").addEventListener("click", () => void this.#copyLink());
    narrow.addEventListener("change", () => {
      if (this.#curves && !this.#drawing) this.#chart = showCurve(this.#drawn(this.#curves));
    });
    addEventListener("hashchange", () => {
      if (location.hash === toLink(this.state)) return;
      const asked = fromLink(location.hash);
      this.open(asked.state.model, asked);
    });
  }

  async #copyLink() {
    const { model, compare } = this.state;
    const files = this.#measured || this.#shelf.files.has(model) || this.#shelf.files.has(compare);
    const link = location.href.replace(/#.*$/, "") + toLink(this.state);
    const where = await (navigator.clipboard?.writeText(link) ?? Promise.reject()).then(
      () => "The link is copied.",
      () => "The link is in the address bar: this browser does not let the page copy it.",
    );
    element("link-state").textContent = files ? `${where} It does not hold files: who follows it has to open them.` : where;
  }

  // ---- files and models ----------------------------------------------------------------------------------------------

  /** One after the other, after those that are still being read. */
  read(files: File[]): Promise<void> {
    this.#reading = this.#reading.then(async () => {
      const lines = [];
      for (const file of files) lines.push(await this.#readOne(file));
      element("reading").textContent = "";
      const line = lines.filter((one) => one).join(" ");
      if (line) this.#trouble(line);
    });
    return this.#reading;
  }

  /** Returns what is wrong with it. */
  async #readOne(file: File): Promise<string> {
    if (file.size > mostBytes) return tooLarge(file);
    element("reading").textContent = `Reading ${file.name} …`;
    let contents: Uint8Array;
    try {
      contents = new Uint8Array(await file.arrayBuffer());
    } catch {
      return `${file.name}: cannot be read: is it a file, and still there?`;
    }
    try {
      if (this.mmbrdf.holdsSamples(contents)) await this.#measure(contents, file.name);
      else {
        const name = this.#shelf.add(contents, file.name);
        this.#controls.offer(name);
        this.open(name);
      }
      return "";
    } catch (error) {
      return (error as Error).message;
    }
  }

  /** Samples, and the nearest light at which there are some. */
  async #measure(contents: Uint8Array, name: string) {
    const samples = await readInParts(this.mmbrdf.sampleReader(contents, name), name);
    this.#measured?.samples.free();
    this.#measured = new Measured(samples);
    this.#trouble("");
    const { wavelength, thetaI, phiI } = this.#measured.nearest(this.state);
    this.change({ wavelength, thetaI, phiI });
  }

  forget() {
    this.#measured?.samples.free();
    this.#measured = undefined;
    this.change({ points: start.points });
  }

  /** Another model, and what a link asks of it; all that was shown stays where there is no such model. */
  open(name: string, asked?: Asked, first = false) {
    let line = "";
    try {
      const shown = this.#opened(name);
      this.#shown?.free();
      this.#shown = shown;
    } catch (error) {
      line = `${(error as Error).message}. A link does not hold files: open it again.`;
      if (!first) {
        this.#trouble(line);
        return this.#show();
      }
      this.#shown = this.#opened((name = start.model));
    }
    if (asked) {
      const known = Object.fromEntries(choices.map((id) => [id, this.#controls.values(id)])) as Record<(typeof choices)[number], string[]>;
      const { state, line: more } = understood(asked, known);
      this.state = state;
      line = [line, more, this.#comparable(state)].filter((one) => one).join(" ");
    }
    this.#trouble(line);
    const known = this.#shown.model.wavelengths;
    const inside = known.length && this.state.wavelength >= known[0] && this.state.wavelength <= known[known.length - 1];
    const wavelength = asked?.named.has("wavelength") || inside || !known.length ? this.state.wavelength : known[0];
    this.change({ model: name, wavelength });
  }

  #opened(name: string): Shown {
    return new Shown(name, this.#shelf.model(name), this.#shelf.source(name));
  }

  /** Takes what is not here out of the state, and says so. */
  #comparable(state: State): string {
    const { compare } = state;
    if (!compare || this.#shelf.has(compare)) return "";
    state.compare = "";
    return `compare = ${compare} of the link is not here. A link does not hold files: open it again.`;
  }

  /** The other model is that of the state. */
  #compare() {
    const { compare } = this.state;
    if (compare === (this.#other?.name ?? "") && (!compare || this.#other!.source.opened === this.#shelf.source(compare).opened)) return;
    const next = compare ? this.#opened(compare) : undefined;
    this.#other?.free();
    this.#other = next;
  }

  #trouble(words: string) {
    this.#failed = false; // what was, is no more said
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
    const wrong = this.#draw();
    if (wrong || this.#failed) this.#trouble(wrong);
    this.#failed = wrong !== "";
    const { state } = this;
    this.#last = { ...state };
    this.#controls.show(wrong ? undefined : typed);
    this.#controls.showIncidences(this.#measured?.incidences ?? noIncidences, state);
    const { model } = this.#shown;
    const blocks = [...new Set(model.modes.map(({ block }) => block))];
    if (!blocks.includes(state.block)) state.block = blocks[0];
    this.#controls.showBlocks(blocks, state.block);
    element("facts").textContent = `${model.basis}. Fitted: ${model.fittedRange}.`;
    this.#address.show(toLink(state));
    element("link-state").textContent = ""; // that was another link
    const file = this.#shelf.files.get(state.model);
    const named = file ? { ...state, model: file.path } : state; // what the program calls it
    const told = { state: named, along: this.#along, ownFile: Boolean(file), hasUncertainty: model.hasUncertainty };
    element("program").textContent = programLines(told, this.#compared());
    element("python").textContent = pythonLines(told);
    this.#ask();
    this.#matrix();
  }

  /** Pictures of the state, or of the last that could be shown: returns why then. */
  #draw(): string {
    const draw = () => {
      this.#compare();
      this.#near = this.#measured?.near(this.state) ?? nothing;
      this.#along = along(this.state, this.#shown.model);
      this.#picture();
      this.#hemispheres.current(this.state);
    };
    this.#numbers = this.#curves = undefined; // they were of another question
    try {
      draw();
      return "";
    } catch (error) {
      this.state = { ...(this.#last ?? start), model: this.#shown.name };
      draw();
      return (error as Error).message;
    }
  }

  get #ats() {
    return { at: this.#shown.at(this.state.wavelength), other: this.#other?.at(this.state.wavelength) };
  }

  /** Hemispheres, with samples over them unless they show a difference of models. */
  #picture() {
    const { state } = this;
    const { at, other } = this.#ats;
    this.#residuals = this.#measured && new Residuals(state, this.#measured, this.#near, at, this.#curves?.[0].elements);
    const points = other && state.shown !== "model" ? undefined : this.#residuals?.points();
    this.limits = this.#hemispheres.show({ at, other, points }, state);
    element("samples-words").textContent = this.#residuals?.words() ?? "";
  }

  #matrix() {
    showMatrix(this.state, { ...this.#ats, numbers: this.#numbers, sample: this.#residuals?.atCursor() });
  }

  // ---- the worker ----------------------------------------------------------------------------------------------------

  #ask() {
    this.#asked += 1;
    this.#open = true;
    document.body.dataset.busy = "true";
    this.#waiting(["quantities", "parts", "chart"], true);
    if (!this.#busy) this.#send("numbers");
  }

  /** Nothing more will change of itself, if nothing is open and the address bar has the link. */
  #calm(open = this.#open) {
    this.#open = open;
    if (!open && !this.#address.waits) delete document.body.dataset.busy;
  }

  /** Whether what is computed beside is of an earlier question. */
  #waiting(ids: string[], is: boolean) {
    for (const id of ids) element(id).setAttribute("aria-busy", String(is));
    if (!ids.includes("chart")) return;
    for (const id of ["csv", "svg", "samples-csv"]) element(id).setAttribute("aria-disabled", String(is));
    if (!is) element("take-state").textContent = "";
  }

  #send(what: Question["what"]) {
    this.#busy = true;
    const sources = [this.#shown, ...(this.#other ? [this.#other] : [])].map(({ source }) => source);
    const question: Question = { id: this.#asked, what, state: { ...this.state }, sources, along: this.#along, places: this.#near.places };
    this.#beside.postMessage(question);
  }

  #answered({ id, error, numbers, curves }: Reply) {
    this.#busy = false;
    if (id === 0 && error !== undefined) return this.#trouble(`Uncertainties cannot be computed: ${error}`);
    if (this.#asked === 0 || this.#drawing) return; // what is to be drawn will ask
    if (id !== this.#asked) return this.#send("numbers");
    if (error !== undefined) {
      this.#calm(false);
      this.#trouble(error);
      this.#failed = true; // until something else is shown
      return;
    }
    if (numbers) {
      this.#numbers = numbers;
      this.#waiting(["quantities", "parts"], false);
      showTables(this.state, this.mmbrdf, numbers[0].answer);
      this.#matrix();
      return this.#send("curves");
    }
    this.#calm(false);
    this.#curves = curves!;
    this.#waiting(["chart"], false);
    this.#chart = showCurve(this.#drawn(curves!));
    if (!this.#measured) return;
    this.#picture(); // now with uncertainties of the model
    this.#matrix();
  }

  #drawn(curves: Curves[]) {
    return { ...this.#ats, state: this.state, mmbrdf: this.mmbrdf, along: this.#along, curves, samples: this.#measured?.samples, near: this.#near };
  }

  /** What the program calls what is compared. */
  #compared(): Named[] {
    const { compare } = this.state;
    const file = this.#shelf.files.get(compare);
    const samples = this.#measured?.samples.name;
    return [
      ...(compare ? [{ name: file?.path ?? compare, ownFile: Boolean(file) }] : []),
      ...(samples ? [{ name: samples, ownFile: true }] : []),
    ];
  }

  #fileName() {
    return `${this.state.model.replace(/\.\w+$/, "")}-${this.state.wavelength}nm-${this.state.curve}`;
  }
}
