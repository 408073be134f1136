// SPDX-License-Identifier: BSD-3-Clause
// The form: what it offers, what it is told, and what it shows of the state.
import type { Mmbrdf } from "mmbrdf";

import { choice, element, field } from "./dom";
import { polarized } from "./curves";
import type { Incidence } from "./measured";
import { kindOf } from "./scan";
import { allowed, angles, choices, longest, paperLimits, type State } from "./state";

const mostIncidences = 500; // in a list

/** Who is told. */
export interface Listener {
  state: State;
  /** Of the colour scales, as they are. */
  limits: number[];
  change(some: Partial<State>, typed?: HTMLInputElement): void;
  open(name: string): void;
  read(files: File[]): Promise<void>;
  /** Without the samples that are shown. */
  forget(): void;
}

export class Controls {
  #incidences: Incidence[] = [];

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
    for (const id of ["model", "compare", ...choices] as const) choice(id).value = state[id];
    for (const id of ["normalized", "digits"] as const) field(id).checked = state[id];
    field("locked").checked = state.limits.length > 0;
    for (const one of document.querySelectorAll<HTMLElement>(".of-other")) one.hidden = !state.compare;
    const kind = kindOf(state);
    element("scan-label").hidden = kind !== "plane" && kind !== "azimuth";
    element("block-label").hidden = kind !== "coefficients";
  }

  /** A model that can be chosen. */
  offer(name: string) {
    for (const id of ["model", "compare"]) if (!this.values(id).includes(name)) element(id).append(new Option(name, name));
  }

  /** What can be chosen of a list. */
  values(id: string): string[] {
    return Array.from(choice(id).options, ({ value }) => value);
  }

  /** Blocks of the model's modes, of which `block` is shown. */
  showBlocks(blocks: string[], block: string) {
    if (String(this.values("block")) !== String(blocks)) choice("block").replaceChildren(...blocks.map((one) => new Option(one, one)));
    choice("block").value = block;
  }

  /** Where there are samples, of which this is shown, if any is; none: there are no samples. */
  showIncidences(incidences: Incidence[], { wavelength, thetaI, phiI }: State) {
    for (const one of document.querySelectorAll<HTMLElement>(".of-samples")) one.hidden = !incidences.length;
    const words = (one: Incidence) => `${one.wavelength} nm, θi ${one.thetaI}°, φi ${one.phiI}° (${one.count})`;
    const here = incidences.findIndex((one) => one.wavelength === wavelength && one.thetaI === thetaI && one.phiI === phiI);
    if (this.#incidences !== incidences) {
      const listed = incidences.slice(0, mostIncidences).map((one, i) => new Option(words(one), String(i)));
      const more = incidences.length - listed.length;
      const none = more > 0 ? `another light, or one of ${more} more` : "another light than any of them";
      choice("incidence").replaceChildren(new Option(none, "-1"), ...listed);
      this.#incidences = incidences;
    }
    choice("incidence").value = String(here < mostIncidences ? here : -1);
  }

  #fill(mmbrdf: Mmbrdf) {
    for (const name of mmbrdf.materials) this.offer(name);
    const curves: [string, string][] = [["polarized", "co- and cross-polarized BRDF"], ["f11", "f11, unpolarized BRDF"]];
    for (const { name, meaning } of mmbrdf.quantities)
      if (!polarized.includes(name)) curves.push([name, `${name.replaceAll("_", " ")}: ${meaning}`]);
    curves.push(["dhr", "directional-hemispherical reflectance against θi"]);
    curves.push(["dhr_wavelength", "directional-hemispherical reflectance against wavelength"]);
    curves.push(["coefficients", "coefficients of the modes against wavelength"]);
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
    for (const id of [...choices, "block", "compare"] as const)
      choice(id).addEventListener("change", () =>
        this.page.change({ [id]: choice(id).value, ...(id === "shown" || id === "compare" ? { limits: [] } : {}) }),
      );
    choice("incidence").addEventListener("change", () => {
      const asked = this.#incidences[Number(choice("incidence").value)];
      if (asked) this.page.change({ wavelength: asked.wavelength, thetaI: asked.thetaI, phiI: asked.phiI });
    });
    element("no-samples").addEventListener("click", () => this.page.forget());
    element("paper").addEventListener("click", () => this.page.change({ normalized: true, limits: paperLimits }));
    for (const id of ["normalized", "digits"] as const)
      field(id).addEventListener("change", () =>
        this.page.change({ [id]: field(id).checked, ...(id === "normalized" ? { limits: [] } : {}) }),
      );
    field("locked").addEventListener("change", () => this.page.change({ limits: field("locked").checked ? this.page.limits : [] }));
    choice("model").addEventListener("change", () => this.page.open(choice("model").value));
  }

  #listenToFiles() {
    field("file").addEventListener("change", () => {
      void this.page.read([...(field("file").files ?? [])]).then(() => (field("file").value = "")); // so that the same file can be opened again
    });
    addEventListener("dragover", (event) => {
      event.preventDefault();
      document.body.classList.add("dropping");
    });
    addEventListener("dragleave", () => document.body.classList.remove("dropping"));
    addEventListener("drop", (event) => {
      event.preventDefault();
      document.body.classList.remove("dropping");
      void this.page.read([...(event.dataTransfer?.files ?? [])]);
    });
  }
}
