// SPDX-License-Identifier: BSD-3-Clause
// The form: what it offers, what it is told, and what it shows of the state.
import type { Mmbrdf } from "mmbrdf";

import { choice, element, field } from "./dom";
import { allowed, angles, longest, type State } from "./state";

export const polarized = ["f_ss", "f_pp", "f_sp", "f_ps"];

/** Who is told. */
export interface Listener {
  state: State;
  /** Of the colour scales, as they are. */
  limits: number[];
  change(some: Partial<State>, typed?: HTMLInputElement): void;
  open(name: string): void;
  read(file: File): Promise<void>;
}

export class Controls {
  constructor(
    mmbrdf: Mmbrdf,
    readonly page: Listener,
  ) {
    this.#fill(mmbrdf);
    this.#listenToNumbers();
    this.#listenToChoices();
    this.#listenToFiles();
    element("controls").addEventListener("submit", (event) => event.preventDefault());
  }

  /** All but what is being typed. */
  show(typed?: HTMLInputElement) {
    const { state } = this.page;
    for (const id of ["wavelength", ...angles] as const) {
      const input = field(id);
      if (input === typed) continue;
      input.value = String(state[id]);
      this.#valid(input, true);
    }
    for (const id of ["model", "frame", "convention", "projection", "curve"] as const) choice(id).value = state[id];
    for (const id of ["normalized", "digits"] as const) field(id).checked = state[id];
    field("locked").checked = state.limits.length > 0;
  }

  /** Names of curves that there are. */
  get curves(): string[] {
    return Array.from(choice("curve").options, ({ value }) => value);
  }

  #fill(mmbrdf: Mmbrdf) {
    for (const name of mmbrdf.materials) element("model").append(new Option(name, name));
    const curves: [string, string][] = [["polarized", "co- and cross-polarized BRDF, plane of incidence"], ["f11", "f11, plane of incidence"]];
    for (const { name, meaning } of mmbrdf.quantities)
      if (!polarized.includes(name)) curves.push([name, `${name.replaceAll("_", " ")}: ${meaning}`]);
    curves.push(["dhr", "directional-hemispherical reflectance against θi"]);
    for (const [value, words] of curves) element("curve").append(new Option(words, value));
  }

  /** Says at a field what it takes, and at the answer that it is of what was there before. */
  #valid(input: HTMLInputElement, is: boolean) {
    const id = input.id as keyof typeof allowed;
    input.setAttribute("aria-invalid", String(!is));
    element(`${id}-wrong`).textContent = is ? "" : `${allowed[id]}. Shown is ${this.page.state[id]}.`;
    const wrong = document.querySelectorAll("#controls [aria-invalid=true]").length;
    element("former").textContent = wrong ? "A field is not filled in rightly: this is the answer of its former value." : "";
  }

  #listenToNumbers() {
    for (const id of Object.keys(allowed) as (keyof typeof allowed)[]) {
      const input = field(id);
      const words = document.createElement("p");
      Object.assign(words, { id: `${id}-wrong`, className: "wrong", role: "alert" });
      input.closest("label")!.after(words);
      input.setAttribute("aria-describedby", words.id);
      input.addEventListener("input", () => {
        const good = input.value !== "" && input.checkValidity() && (id !== "wavelength" || Number(input.value) <= longest);
        this.#valid(input, good);
        if (good) this.page.change({ [id]: Number(input.value) }, input);
      });
    }
  }

  #listenToChoices() {
    for (const id of ["frame", "convention", "projection", "curve"] as const)
      choice(id).addEventListener("change", () => this.page.change({ [id]: choice(id).value }));
    for (const id of ["normalized", "digits"] as const)
      field(id).addEventListener("change", () =>
        this.page.change({ [id]: field(id).checked, ...(id === "normalized" ? { limits: [] } : {}) }),
      );
    field("locked").addEventListener("change", () => this.page.change({ limits: field("locked").checked ? this.page.limits : [] }));
    choice("model").addEventListener("change", () => this.page.open(choice("model").value));
  }

  #listenToFiles() {
    field("file").addEventListener("change", () => {
      const [file] = field("file").files ?? [];
      if (file) void this.page.read(file).then(() => (field("file").value = "")); // so that the same file can be opened again
    });
    addEventListener("dragover", (event) => {
      event.preventDefault();
      document.body.classList.add("dropping");
    });
    addEventListener("dragleave", () => document.body.classList.remove("dropping"));
    addEventListener("drop", (event) => {
      event.preventDefault();
      document.body.classList.remove("dropping");
      const file = event.dataTransfer?.files[0];
      if (file) void this.page.read(file);
    });
  }
}
