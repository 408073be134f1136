// SPDX-License-Identifier: BSD-3-Clause
// What is no model, or no question, gives the line of the program, and the module goes on.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import load from "../index.js";
import { folder, refusal, run, without_program } from "./program.mjs";

const mmbrdf = await load();

const question = ["-w", "532", "-i", "45,0", "-r", "30,180"];

/** Fifty files that are none of ours: cut off, of another version, with a field or a number that is wrong. */
function malformed() {
  const [json, csv] = ["model.json", "coefficients.csv"].map((name) => {
    run("convert", "ptfe-532", join(folder, name));
    return readFileSync(join(folder, name), "utf8");
  });
  const cut = (text, share) => text.slice(0, Math.floor(text.length * share));
  const line = (number, change) => csv.split("\n").map((one, i) => (i === number ? change(one) : one)).join("\n");
  const shares = [0.0001, 0.001, 0.003, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99, 0.9999];
  const changes = [
    ['"schema_version": 1', '"schema_version": 2'],
    ['"schema_version": 1', '"schema_version": "1"'],
    ['"mmbrdf model"', '"mmbrdf instrument"'],
    ['"format"', '"formula"'],
    ['"isotropic"', '"isotropical"'],
    ['"basis"', '"base"'],
    ['[7, 4]', '[7, 5]'],
    ['[7, 4]', '[7]'],
    ['"powers": 0', '"powers": 1'],
    ['"powers": 0', '"powers": -1'],
    ['"powers": 0', '"powers": 0.5'],
    ['"lambert"', '"mercator"'],
    ['"germer2017"', '"p_first_left"'],
    ['"um"', '"nm"'],
    ['[0.532]', '[0.532, 0.351]'],
    ['[0.532]', '[-1]'],
    ['75.0', '95.0'],
    ['75.0', '"75"'],
    ['"pairs": "////', '"pairs": "!!!!'],
    ['"coefficients": [', '"coefficients": [1, '],
    ['"coefficients": [', '"coefficients": [1e400, '],
    ['"coefficients": [', '"coefficients": ["one", '],
    ['"name"', '"name": "twice", "name"'],
    ['"ptfe-532"', '532'],
  ];
  return [
    "", "\n\n", "ptfe", "{}", "[]", "null", "\u0000{}", "\ufeff{", "{\"a\": \u0001}", new Uint8Array([0x7b, 0xff, 0xfe]),
    ...shares.map((share) => cut(json, share)),
    ...changes.map(([from, to]) => {
      assert.ok(json.includes(from), from);
      return json.replace(from, to);
    }),
    cut(csv, 0.5).replace(/[^,]*$/, ""), // a line without its number
    line(3, (one) => one + ", 1"),
    line(3, (one) => one.replace("1", "x")),
    line(3, (one) => one.replace(/[^,]*$/, " 1e999")),
    line(3, (one) => one.replace(/[^,]*$/, " nan")),
    line(3, (one) => one.replace(/[^,]*$/, " 0x10")),
    line(3, (one) => one + "\n" + one),
    line(0, () => "2, 1, 0, 0, 0, 0, 0, 1"),
    line(0, () => "1, 1, 0, 0, 0, 0, 10, 1"),
    line(0, () => "1, 1, 1, 2, 0, 0, 0, 1"),
    line(0, () => "1, 1, 99999, 0, 0, 0, 0, 1"),
  ];
}

test("files that are no models are refused in the words of the program", { skip: without_program }, () => {
  const files = malformed();
  let refused = 0;
  files.forEach((contents, i) => {
    const name = `file${i}.${i % 2 ? "json" : "csv"}`;
    writeFileSync(join(folder, name), contents);
    const expected = refusal("evaluate", name, ...question);
    if (expected === null) return;
    ++refused;
    assert.throws(() => mmbrdf.model(contents, name), (error) => {
      assert.equal(error.message, expected);
      return true;
    });
  });
  assert.ok(refused >= 50, `${refused} of ${files.length} files were refused by the program`);
  assert.equal(mmbrdf.material("ptfe").at(532).evaluate([45, 0, 30, 180]).length, 16);
});

test("what cannot be asked says what and where", () => {
  const model = mmbrdf.material("ptfe");
  const at = model.at(532);
  const cases = [
    [() => mmbrdf.material("gold"), /^material 'gold' is not one of ptfe, ptfe-351, ptfe-532, ptfe-633, ptfe-1064$/],
    [() => model.at(0), /wavelength/],
    [() => model.at(NaN), /wavelength/],
    [() => at.evaluate([91, 0, 30, 180]), /91/],
    [() => at.evaluate([45, 0, NaN, 180]), /nan/],
    [() => at.evaluate([45, Infinity, 30, 180]), /inf/],
    [() => at.evaluate([45, 0, 30]), /^3 angles: there must be four for each geometry$/],
    [() => at.evaluate({ thetaI: 45, thetaR: "30" }), /^thetaR = 30, must be a number of degrees$/],
    [() => at.evaluate([45, 0, 30, 180], { frame: "ps" }), /^frame 'ps' is not one of xy, sp, scattering_plane$/],
    [() => at.evaluate([45, 0, 30, 180], { convention: "mine" }), /^convention 'mine' is not one of germer2017,/],
    [() => at.directionalHemisphericalReflectance(95), /95/],
    [() => mmbrdf.hemisphere(4), /^pixels = 4, must be in 8...2048$/],
    [() => mmbrdf.hemisphere(64, { projection: "peters" }), /^projection 'peters' is not one of/],
  ];
  for (const [ask, message] of cases) assert.throws(ask, { message });
});

test("numbers of files are read to the last bit, however they are written", { skip: without_program }, () => {
  const rows = (values) => values.map((value, i) => `1, 1, ${2 * i}, 0, 0, 0, 0, ${value}`).join("\n");
  for (const value of ["2.063534944706443", "+1.5", ".5", "5.", "1E-3", "4.9406564584124654e-324", "0.1e+1"]) {
    const contents = rows([value]);
    const file = join(folder, "numbers.csv");
    writeFileSync(file, contents);
    const expected = JSON.parse(run("evaluate", file, ...question, "--format", "json")).mueller[0][0];
    const f11 = mmbrdf.model(contents, "numbers.csv").at(532).evaluate([45, 0, 30, 180])[0];
    assert.ok(Math.abs(f11 - expected) <= 2e-16 * Math.abs(expected), `${value}: ${f11}, not ${expected}`);
  }
});

test("what is no model at a wavelength, or was freed, is refused by a hemisphere in a line", async () => {
  const model = mmbrdf.material("ptfe-532");
  const [at, freed] = [model.at(532), model.at(600)];
  freed.free();
  const foreign = (await load()).material("ptfe-532").at(532);
  const hemisphere = mmbrdf.hemisphere(8);
  for (const wrong of [undefined, null, 0, {}, { address: 8 }, model, hemisphere, foreign])
    assert.throws(() => hemisphere.evaluate(wrong, 45), { message: /^evaluate\(\) of a hemisphere takes what model\.at\(wavelength\) returned/ });
  assert.throws(() => hemisphere.evaluate(freed, 45), { message: "model 'ptfe-532' at 600 nm was freed" });
  hemisphere.evaluate(at, 45);
  hemisphere.free();
  hemisphere.free();
  const uses = [
    () => hemisphere.evaluate(at, 45), () => hemisphere.extremes(), () => hemisphere.paint(),
    ...["positions", "values", "limits", "colors", "image"].map((name) => () => hemisphere[name]),
  ];
  for (const use of uses) assert.throws(use, { message: "the hemisphere was freed" });
  assert.equal(at.evaluate([45, 0, 30, 180]).length, 16);
  model.free();
});

test("contents are texts or bytes of UTF-8, and nothing else", { skip: without_program }, () => {
  const path = join(folder, "bytes.json");
  run("convert", "ptfe-532", path);
  const text = readFileSync(path, "utf8");
  const bytes = new TextEncoder().encode(text);
  const f11 = (contents) => mmbrdf.model(contents, "bytes.json").at(532).evaluate([45, 0, 30, 180])[0];
  const buffer = new ArrayBuffer(bytes.length);
  new Uint8Array(buffer).set(bytes);
  for (const contents of [bytes, buffer, readFileSync(path)]) assert.equal(f11(contents), f11(text));
  for (const [contents, type] of [
    [undefined, "undefined"], [null, "null"], [7, "of type Number"], [{}, "of type Object"], [[1], "of type Array"],
    [new Float64Array(2), "of type Float64Array"], [new DataView(buffer), "of type DataView"], [Promise.resolve(""), "of type Promise"],
  ])
    assert.throws(() => mmbrdf.model(contents, "x.json"), {
      message: `contents must be a string, or an ArrayBuffer or a Uint8Array of UTF-8, not ${type}`,
    });
  assert.throws(() => mmbrdf.model(text), { message: "path must be a string, not undefined" });
  assert.throws(() => mmbrdf.material(532), { message: "name must be a string, not of type Number" });
});

test("where memory ends a sentence says so, and the module goes on", async () => {
  const own = await load();
  const { grow } = WebAssembly.Memory.prototype;
  WebAssembly.Memory.prototype.grow = () => {
    throw new RangeError("no more");
  };
  try {
    assert.throws(() => own.hemisphere(2048), { message: /^not enough memory: ask for less at once/ });
    const at = own.material("ptfe-532").at(532);
    assert.throws(() => at.evaluate(new Float64Array(4e6)), { message: /^not enough memory for \d+ bytes: ask for less at once/ });
    assert.equal(at.evaluate([45, 0, 30, 180]).length, 16);
  } finally {
    WebAssembly.Memory.prototype.grow = grow;
  }
});
