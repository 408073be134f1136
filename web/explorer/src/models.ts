// SPDX-License-Identifier: BSD-3-Clause
// The models of the page: those that are built in, and files that were opened.
import type { Mmbrdf, Model, ModelAt } from "mmbrdf";

import type { Source } from "./worker";

export interface OpenedFile {
  contents: Uint8Array;
  /** What it is called. */
  path: string;
  /** Other for each file, whatever its name. */
  opened: string;
}

export class Shelf {
  readonly files = new Map<string, OpenedFile>();
  #opened = 0;

  constructor(readonly mmbrdf: Mmbrdf) {}

  has(name: string): boolean {
    return this.files.has(name) || this.mmbrdf.materials.includes(name);
  }

  /** Its name on the page. Throws the line of the program for what is no model. */
  add(contents: Uint8Array, path: string): string {
    this.mmbrdf.model(contents, path).free();
    const name = this.mmbrdf.materials.includes(path) ? `${path} (file)` : path;
    this.files.set(name, { contents, path, opened: `file ${(this.#opened += 1)}` });
    return name;
  }

  model(name: string): Model {
    const file = this.files.get(name);
    return file ? this.mmbrdf.model(file.contents, name) : this.mmbrdf.material(name);
  }

  source(name: string): Source {
    const { contents, opened = `built-in ${name}` } = this.files.get(name) ?? {};
    return { name, opened, contents };
  }
}

/** A model that is shown, at a wavelength. */
export class Shown {
  #at?: ModelAt;

  constructor(
    readonly name: string,
    readonly model: Model,
    readonly source: Source,
  ) {}

  at(wavelength: number): ModelAt {
    if (this.#at?.wavelength !== wavelength) {
      const at = this.model.at(wavelength);
      this.#at?.free();
      this.#at = at;
    }
    return this.#at!;
  }

  free() {
    this.model.free();
  }
}
