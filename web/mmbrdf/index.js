// SPDX-License-Identifier: BSD-3-Clause
// Types and contracts are in index.d.ts.
import { Calls, stringOf } from "./calls.js";
import instantiate from "./dist/mmbrdf_module.mjs";
import { SampleReader } from "./samples.js";

/** Four angles for each geometry, as one list of numbers. */
function angles(geometries) {
  const list = ArrayBuffer.isView(geometries)
    ? geometries
    : Array.isArray(geometries)
      ? geometries.flatMap((one) => (typeof one === "number" ? [one] : anglesOf(one)))
      : anglesOf(geometries);
  if (list.length % 4) throw new Error(`${list.length} angles: there must be four for each geometry`);
  return list;
}

function anglesOf({ thetaI, phiI = 0, thetaR, phiR = 0 }) {
  for (const [name, value] of Object.entries({ thetaI, phiI, thetaR, phiR }))
    if (typeof value !== "number") throw new Error(`${name} = ${value}, must be a number of degrees`);
  return [thetaI, phiI, thetaR, phiR];
}

class At {
  #calls;
  #at;
  #freed;

  constructor(calls, at, model, wavelength, freed) {
    this.#calls = calls;
    this.#at = at;
    this.#freed = freed;
    this.model = model;
    this.wavelength = wavelength;
  }

  #address() {
    if (!this.model.isOpen) throw new Error(`model '${this.model.name}' was freed`);
    if (!this.#at) throw new Error(`model '${this.model.name}' at ${this.wavelength} nm was freed`);
    return this.#at;
  }

  /** Of what model.at() of this module returned. */
  static addressIn(calls, at) {
    if (typeof at !== "object" || at === null || !(#at in at) || at.#calls !== calls)
      throw new Error("evaluate() of a hemisphere takes what model.at(wavelength) returned, of the same load()");
    return at.#address();
  }

  #each(geometries, bytes, work) {
    const list = angles(geometries);
    const count = list.length / 4;
    return this.#calls.with([8 * list.length, ...bytes.map((one) => one * count)], (degrees, ...out) => {
      this.#calls.module.HEAPF64.set(list, degrees / 8);
      return work(degrees, count, ...out);
    });
  }

  evaluate(geometries, { frame, convention, normalized = false } = {}) {
    const calls = this.#calls;
    return this.#each(geometries, [128], (degrees, count, out) => {
      calls.checked(
        calls.module._evaluate_at(
          this.#address(), degrees, count, calls.frame(frame), calls.convention(convention), normalized, out),
      );
      return calls.numbers(out, 16 * count);
    });
  }

  standardUncertainty(geometries, { frame, normalized = false } = {}) {
    const calls = this.#calls;
    return this.#each(geometries, [128], (degrees, count, out) => {
      calls.checked(
        calls.module._uncertainty_at(this.#address(), degrees, count, calls.frame(frame), normalized, out));
      return calls.numbers(out, 16 * count);
    });
  }

  outside(geometries) {
    const calls = this.#calls;
    return this.#each(geometries, [4], (degrees, count, out) => {
      calls.checked(calls.module._outside_at(this.#address(), degrees, count, out));
      const reasons = calls.module.HEAPU32.slice(out / 4, out / 4 + count);
      return Array.from(reasons, (one) => JSON.parse(calls.text(calls.module._outside_words(this.#address(), one))));
    });
  }

  quantities(geometries) {
    const calls = this.#calls;
    const size = 8 * calls.known.quantities.length;
    return this.#each(geometries, [size, size], (degrees, count, values, uncertainties) => {
      calls.checked(calls.module._quantities_at(this.#address(), degrees, count, values, uncertainties));
      return calls.byQuantity(count, values, uncertainties);
    });
  }

  answer(geometry, { frame, convention } = {}) {
    const calls = this.#calls;
    return this.#each(geometry, [], (degrees, count) => {
      if (count !== 1) throw new Error(`${count} geometries: answer() takes one`);
      return JSON.parse(
        calls.text(
          calls.module._answer_at(this.#address(), degrees, calls.frame(frame), calls.convention(convention)),
        ),
      );
    });
  }

  coefficients() {
    const calls = this.#calls;
    const count = this.model.modes.length;
    return calls.with([8 * count], (out) => {
      calls.module._coefficients_at(this.#address(), out);
      return calls.numbers(out, count);
    });
  }

  directionalHemisphericalReflectance(theta) {
    const calls = this.#calls;
    const list = typeof theta === "number" ? [theta] : theta;
    return calls.with([8 * list.length, 8 * list.length, 8 * list.length], (degrees, values, uncertainties) => {
      calls.module.HEAPF64.set(list, degrees / 8);
      calls.checked(calls.module._dhr_at(this.#address(), degrees, list.length, values, uncertainties));
      return { values: calls.numbers(values, list.length), uncertainties: calls.numbers(uncertainties, list.length) };
    });
  }

  free() {
    if (this.#at) this.#calls.module._free_at(this.#at);
    this.#at = 0;
    this.#freed(this);
  }
}

class Model {
  #calls;
  #model;
  #prepared = new Set(); // of it, and not freed
  #modes; // once asked for

  constructor(calls, model) {
    this.#calls = calls;
    this.#model = model;
    Object.assign(this, JSON.parse(calls.text(calls.module._describe(model))));
  }

  get isOpen() {
    return this.#model !== 0;
  }

  get modes() {
    if (!this.#model) throw new Error(`model '${this.name}' was freed`);
    this.#modes ??= JSON.parse(this.#calls.text(this.#calls.module._modes_of(this.#model)));
    return this.#modes;
  }

  at(wavelength) {
    if (!this.#model) throw new Error(`model '${this.name}' was freed`);
    const address = this.#calls.checked(this.#calls.module._at_wavelength(this.#model, wavelength));
    const at = new At(this.#calls, address, this, wavelength, (one) => this.#prepared.delete(one));
    this.#prepared.add(at);
    return at;
  }

  free() {
    for (const at of [...this.#prepared]) at.free();
    if (this.#model) this.#calls.module._free_model(this.#model);
    this.#model = 0;
  }
}

class Hemisphere {
  #calls;
  #given;

  constructor(calls, pixels, lambert) {
    this.#calls = calls;
    this.#given = calls.checked(calls.module._new_hemisphere(pixels, lambert));
    this.pixels = pixels;
    this.count = calls.module._hemisphere_count(this.#address);
  }

  get #address() {
    if (!this.#given) throw new Error("the hemisphere was freed");
    return this.#given;
  }

  #view(Kind, address, length) {
    return new Kind(this.#calls.module.HEAPU8.buffer, address, length);
  }

  get positions() {
    return this.#view(Uint32Array, this.#calls.module._hemisphere_positions(this.#address), this.count);
  }

  get values() {
    return this.#view(Float32Array, this.#calls.module._hemisphere_values(this.#address), 16 * this.count);
  }

  get limits() {
    return this.#view(Float32Array, this.#calls.module._hemisphere_limits(this.#address), 32);
  }

  get colors() {
    return this.#view(Uint32Array, this.#calls.module._hemisphere_colors(this.#address), 1025);
  }

  get image() {
    const length = 64 * this.pixels * this.pixels;
    return this.#view(Uint8ClampedArray, this.#calls.module._hemisphere_image(this.#address), length);
  }

  evaluate(at, theta, phi = 0, { frame, convention, normalized = false } = {}) {
    const calls = this.#calls;
    calls.checked(
      calls.module._hemisphere_evaluate(
        this.#address, At.addressIn(calls, at), theta, phi, calls.frame(frame), calls.convention(convention), normalized),
    );
  }

  subtract(first) {
    if (!(first instanceof Hemisphere) || first.#calls !== this.#calls)
      throw new Error("subtract() of a hemisphere takes another, of the same load()");
    this.#calls.checked(this.#calls.module._hemisphere_subtract(this.#address, first.#address));
  }

  extremes() {
    return this.#calls.with([128], (out) => {
      this.#calls.module._hemisphere_extremes(this.#address, out);
      return this.#calls.module.HEAPF32.slice(out / 4, out / 4 + 32);
    });
  }

  paint() {
    this.#calls.module._hemisphere_paint(this.#address);
  }

  free() {
    if (this.#given) this.#calls.module._free_hemisphere(this.#given);
    this.#given = 0;
  }
}

class Mmbrdf {
  #calls;

  constructor(calls) {
    this.#calls = calls;
    Object.assign(this, calls.known);
  }

  material(name) {
    const { module } = this.#calls;
    return this.#calls.withTexts([[stringOf(name, "name"), "name"]], (address) => this.#open(module._material_named(address)));
  }

  model(contents, path) {
    const { module } = this.#calls;
    return this.#calls.withTexts([[contents, "contents"], [stringOf(path, "path"), "path"]], (address, length, name) =>
      this.#open(module._model_read(address, length, name)),
    );
  }

  holdsSamples(contents) {
    const { module } = this.#calls;
    return this.#calls.withTexts([[contents, "contents"]], (address, length) => Boolean(module._samples_are_in(address, length)));
  }

  samples(contents, path) {
    return this.sampleReader(contents, path).samples();
  }

  sampleReader(contents, path) {
    const { module } = this.#calls;
    return this.#calls.withTexts([[contents, "contents"], [stringOf(path, "path"), "path"]], (address, length, name) =>
      new SampleReader(this.#calls, this.#calls.checked(module._reading_begun(address, length, name)), length, path),
    );
  }

  #open(model) {
    return new Model(this.#calls, this.#calls.checked(model));
  }

  hemisphere(pixels, { projection = "projected" } = {}) {
    const number = this.#calls.number(["projected", "lambert"], projection, "projection");
    return new Hemisphere(this.#calls, pixels, number);
  }
}

async function wasmBytes() {
  const url = new URL("./dist/mmbrdf_module.wasm", import.meta.url);
  if (url.protocol === "file:" && typeof process !== "undefined") {
    const { readFile } = await import(/* @vite-ignore */ "node:fs/promises");
    return readFile(url);
  }
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}

export async function load({ wasm } = {}) {
  const module = await instantiate({ wasmBinary: wasm ?? (await wasmBytes()), printErr: () => {} });
  return new Mmbrdf(new Calls(module));
}

export default load;
