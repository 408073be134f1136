// SPDX-License-Identifier: BSD-3-Clause
// Types and contracts are in index.d.ts.
export class Samples {
  #calls;
  #samples;

  constructor(calls, samples, name) {
    this.#calls = calls;
    this.#samples = samples;
    this.name = name;
    Object.assign(this, JSON.parse(calls.text(calls.module._describe_samples(samples))));
  }

  #address() {
    if (!this.#samples) throw new Error(`samples '${this.name}' were freed`);
    return this.#samples;
  }

  get places() {
    return this.#calls.numbers(this.#calls.module._places_of_samples(this.#address()), 5 * this.count);
  }

  /** Memory for numbers of samples and for results of so many bytes each. */
  #each(which, bytes, work) {
    const list = Uint32Array.from(which, (one) => {
      if (!Number.isInteger(one) || one < 0 || one >= this.count)
        throw new Error(`sample ${one}: there are ${this.count}, counted from 0`);
      return one;
    });
    return this.#calls.with([4 * list.length, ...bytes.map((one) => one * list.length)], (numbers, ...out) => {
      this.#calls.module.HEAPU32.set(list, numbers / 4);
      return work(numbers, list.length, ...out);
    });
  }

  elements(which, { frame, convention, normalized = false } = {}) {
    const calls = this.#calls;
    return this.#each(which, [128, 128], (numbers, count, values, uncertainties) => {
      calls.checked(
        calls.module._elements_of_samples(
          this.#address(), numbers, count, calls.frame(frame), calls.convention(convention), normalized, values, uncertainties),
      );
      return { values: calls.numbers(values, 16 * count), uncertainties: calls.numbers(uncertainties, 16 * count) };
    });
  }

  quantities(which) {
    const calls = this.#calls;
    const size = 8 * calls.known.quantities.length;
    return this.#each(which, [size, size], (numbers, count, values, uncertainties) => {
      calls.checked(calls.module._quantities_of_samples(this.#address(), numbers, count, values, uncertainties));
      return calls.byQuantity(count, values, uncertainties);
    });
  }

  free() {
    if (this.#samples) this.#calls.module._free_samples(this.#samples);
    this.#samples = 0;
  }
}

export class SampleReader {
  #calls;
  #reading;
  #length;
  #name;
  #ended = false;

  constructor(calls, reading, length, name) {
    this.#calls = calls;
    this.#reading = reading;
    this.#length = length;
    this.#name = name;
  }

  #address() {
    if (!this.#reading) throw new Error(`the reader of '${this.#name}' was freed`);
    return this.#reading;
  }

  get count() {
    return this.#calls.module._reading_count(this.#address());
  }

  get share() {
    return this.#calls.module._reading_position(this.#address()) / this.#length;
  }

  read(rows) {
    const address = this.#address();
    if (!this.#ended) this.#ended = this.#calls.checked(this.#calls.module._reading_continued(address, rows)) === 2;
    return !this.#ended;
  }

  samples() {
    try {
      while (this.read(10000));
      return new Samples(this.#calls, this.#calls.checked(this.#calls.module._reading_ended(this.#address())), this.#name);
    } finally {
      this.free();
    }
  }

  free() {
    if (this.#reading) this.#calls.module._free_reading(this.#reading);
    this.#reading = 0;
  }
}
