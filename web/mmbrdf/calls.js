// SPDX-License-Identifier: BSD-3-Clause
const utf8 = new TextEncoder();
const text = new TextDecoder();

/** Calls of the WebAssembly module: memory for arguments is had and given back here, and errors become exceptions. */
export class Calls {
  constructor(module) {
    this.module = module;
    this.known = JSON.parse(this.text(module._about()));
  }

  /** The text at this address; throws the module's message for 0. */
  text(address) {
    if (!address) throw this.#error();
    return this.read(address);
  }

  read(address) {
    const bytes = this.module.HEAPU8;
    return text.decode(bytes.subarray(address, bytes.indexOf(0, address)));
  }

  /** What a call returned, but for 0. */
  checked(result) {
    if (!result) throw this.#error();
    return result;
  }

  #error() {
    const words = this.read(this.module._error_text());
    return new Error(words === "std::bad_alloc" ? "not enough memory: ask for less at once, and free() what is not needed" : words);
  }

  /** Calls work(addresses) with memory for these numbers of bytes, and gives it back. */
  with(sizes, work) {
    const addresses = [];
    try {
      for (const size of sizes) {
        const address = this.module._malloc(Math.max(size, 8));
        if (!address) throw new Error(`not enough memory for ${size} bytes: ask for less at once, and free() what is not needed`);
        addresses.push(address);
      }
      return work(...addresses);
    } finally {
      for (const address of addresses) this.module._free(address);
    }
  }

  /** The same for texts, each with its name in messages: they end in a zero byte. */
  withTexts(texts, work) {
    const bytes = texts.map(([one, what]) => bytesOf(one, what));
    return this.with(
      bytes.map((one) => one.length + 1),
      (...addresses) => {
        bytes.forEach((one, i) => {
          this.module.HEAPU8.set(one, addresses[i]);
          this.module.HEAPU8[addresses[i] + one.length] = 0;
        });
        return work(...addresses.flatMap((address, i) => [address, bytes[i].length]));
      },
    );
  }

  /** A copy of numbers in the module's memory. */
  numbers(address, count) {
    return this.module.HEAPF64.slice(address / 8, address / 8 + count);
  }

  /** Of lists of `count` numbers for each quantity of the table. */
  byQuantity(count, values, uncertainties) {
    const rows = this.known.quantities.map(({ name }, q) => [
      name,
      {
        values: this.numbers(values + 8 * q * count, count),
        uncertainties: this.numbers(uncertainties + 8 * q * count, count),
      },
    ]);
    return Object.fromEntries(rows);
  }

  number(list, name, what) {
    const position = list.indexOf(name);
    if (position < 0) throw new Error(`${what} '${name}' is not one of ${list.join(", ")}`);
    return position;
  }

  frame(name = "xy") {
    return this.number(this.known.frames, name, "frame");
  }

  convention(name = "germer2017") {
    return this.number(this.known.conventions, name, "convention");
  }
}

/** Of any realm: `instanceof` knows those of its own. */
const kindOf = (value) => Object.prototype.toString.call(value).slice(8, -1);

export function stringOf(value, what) {
  if (typeof value !== "string") throw new Error(`${what} must be a string, not ${named(value)}`);
  return value;
}

/** UTF-8 of a text, or bytes that are that. */
function bytesOf(value, what) {
  if (typeof value === "string") return utf8.encode(value);
  if (kindOf(value) === "Uint8Array") return value;
  if (kindOf(value) === "ArrayBuffer") return new Uint8Array(value);
  throw new Error(`${what} must be a string, or an ArrayBuffer or a Uint8Array of UTF-8, not ${named(value)}`);
}

const named = (value) => (value === null || value === undefined ? String(value) : `of type ${kindOf(value)}`);
