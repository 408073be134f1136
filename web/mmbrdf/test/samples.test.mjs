// SPDX-License-Identifier: BSD-3-Clause
// Measured samples: what the file says, beside what a model says.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import load from "../index.js";
import { folder, refusal, run, without_program } from "./program.mjs";

const mmbrdf = await load();
const names = [...Array(16).keys()].map((e) => `${1 + (e >> 2)}${1 + (e & 3)}`);

/** What a model gives without noise is the model. */
function simulated(material = "ptfe-532") {
  const contents = run("simulate", material, "--grid", "random:40", "--seed", "3");
  const samples = mmbrdf.samples(contents, "samples.csv");
  return { samples, contents, all: [...Array(samples.count).keys()] };
}

const head = ["wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg"];

/** One sample with a number and an uncertainty for each of some elements. */
function table(elements, u = true) {
  const column = (name) => (name === "11" ? "f11" : `m${name}`);
  const columns = [...elements.map(column), ...(u ? elements.map((name) => `u_${column(name)}`) : [])];
  const values = [...elements.map((_, i) => 0.3 / (i + 1)), ...(u ? elements.map((_, i) => 0.001 * (i + 1)) : [])];
  return `${[...head, ...columns].join(",")}\n532,40,20,30,200,${values.join(",")}\n`;
}

test("samples of a model without noise are the model, in all frames, conventions and quantities", { skip: without_program }, () => {
  const { samples, all } = simulated();
  const at = mmbrdf.material("ptfe-532").at(532);
  const geometries = all.map((i) => [...samples.places.subarray(5 * i + 1, 5 * i + 5)]).flat();
  const rounding = 1e-12; // of f11: files have as many digits as it takes, angles to 1 in the last place
  for (const frame of mmbrdf.frames)
    for (const convention of ["germer2017", "p_first_right"])
      for (const normalized of [false, true]) {
        const { values } = samples.elements(all, { frame, convention, normalized });
        const expected = at.evaluate(geometries, { frame, convention, normalized });
        values.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) <= rounding, `${frame}, ${convention}: ${value}, not ${expected[i]}`));
      }
  const measured = samples.quantities(all);
  for (const [name, { values }] of Object.entries(at.quantities(geometries)))
    values.forEach((value, i) => assert.ok(Math.abs(measured[name].values[i] - value) <= 1e-9, name)); // roots of what is near 0
});

test("samples say what there is of them, and where", { skip: without_program }, () => {
  const { samples, contents, all } = simulated();
  assert.equal(samples.count, 40);
  assert.deepEqual(samples.wavelengths.map((nm) => Number(nm.toFixed(9))), [532]);
  assert.deepEqual(samples.measured, names.map((name) => (name === "11" ? "f11" : `m${name}`)));
  assert.equal(samples.hasUncertainty, false);
  assert.equal(samples.understood, "");
  const rows = contents.trim().split("\n").slice(1).map((row) => row.split(",").map(Number));
  all.forEach((i) => rows[i].slice(0, 5).forEach((number, c) => assert.ok(Math.abs(samples.places[5 * i + c] - number) <= 1e-9)));
  const { uncertainties } = samples.elements(all);
  assert.ok(uncertainties.every(Number.isNaN));
});

test("uncertainties are those of the file, and of products with f11", () => {
  const samples = mmbrdf.samples(table(names), "all.csv");
  assert.ok(samples.hasUncertainty);
  const normalized = samples.elements([0], { normalized: true });
  const { values, uncertainties } = samples.elements([0]);
  names.forEach((name, e) => {
    const [m, u] = [0.3 / (e + 1), 0.001 * (e + 1)];
    assert.ok(Math.abs(normalized.uncertainties[e] - u) <= 1e-15, name);
    const expected = e ? Math.hypot(m * 0.001, 0.3 * u) : u;
    assert.ok(Math.abs(values[e] - (e ? 0.3 * m : m)) <= 1e-15, name);
    assert.ok(Math.abs(uncertainties[e] - expected) <= 1e-15, name);
  });
  const { f_ss } = samples.quantities([0]);
  assert.ok(f_ss.uncertainties[0] > 0);
});

test("elements that were not measured are unknown", () => {
  const samples = mmbrdf.samples(table(["11"]), "f11.csv");
  assert.deepEqual(samples.measured, ["f11"]);
  const { values, uncertainties } = samples.elements([0], { frame: "sp" });
  values.forEach((value, e) => assert.equal(Number.isNaN(value), e > 0, names[e]));
  uncertainties.forEach((value, e) => assert.equal(Number.isNaN(value), e > 0, names[e]));
  const { f_ss } = samples.quantities([0]);
  assert.ok(Number.isNaN(f_ss.values[0]) && Number.isNaN(f_ss.uncertainties[0]));
});

/** Files that begin as samples, and are none. */
function malformed() {
  const good = table(names);
  const [first, row] = good.split("\n");
  const change = (from, to) => {
    assert.ok(good.includes(from), from);
    return good.replace(from, to);
  };
  return [
    first, `${first}\n\n`, change("40,", "95,"), change("40,", "nan,"), change("40,", "x,"), change("532,", "-532,"), change("532,", "0,"), change("532,", ","),
    change("0.3,", "inf,"), change("0.001,", "-0.001,"), change("theta_i_deg", "theta_deg"), change("wavelength_nm", "wavelength"),
    change("m12", "m11"), change("u_m44", "u_m45"), change(",u_m44", ""), `${good}${row},1\n`, `${good}532,40\n`, `${first},${first}\n${row},${row}\n`,
    good.replace("m12", "sample_rotation"), `name\n1\n`, "wavelength_nm,f11\n532,0.3\n",
    "VERSION  1.0\nVARS 4\n", "Source  Measured\nSymmetry  PlaneSymmetrical\nSpectralContent  Monochrome\nScatterType  BRDF\nSampleRotation  1\n0\nAngleOfIncidence  1\n0\n",
    "\x93NUMPY", `${first}\n${"1".repeat(400)}\n`,
  ];
}

test("files that begin as samples and are none are refused in the words of the program", { skip: without_program }, () => {
  let refused = 0;
  malformed().forEach((contents, i) => {
    const name = `samples${i}.csv`;
    writeFileSync(join(folder, name), contents);
    if (!mmbrdf.holdsSamples(contents)) return;
    const expected = refusal("compare", "ptfe-532", name);
    if (expected === null) return assert.equal(mmbrdf.samples(contents, name).name, name);
    ++refused;
    assert.throws(() => mmbrdf.samples(contents, name), (error) => {
      assert.equal(error.message, expected);
      return true;
    });
  });
  assert.ok(refused >= 18, `${refused} files were refused`);
});

test("models begin otherwise than samples", { skip: without_program }, () => {
  for (const ending of ["json", "csv"]) {
    const file = join(folder, `model.${ending}`);
    run("convert", "ptfe-532", file);
    assert.equal(mmbrdf.holdsSamples(readFileSync(file)), false);
  }
  assert.equal(mmbrdf.holdsSamples(table(["11"])), true);
  assert.equal(mmbrdf.holdsSamples(""), false);
});

test("samples that are not there, or were freed, are refused in a line", () => {
  const samples = mmbrdf.samples(table(["11"]), "f11.csv");
  for (const which of [1, -1, 0.5, NaN]) assert.throws(() => samples.elements([which]), { message: `sample ${which}: there are 1, counted from 0` });
  samples.free();
  for (const ask of [() => samples.places, () => samples.elements([0]), () => samples.quantities([0])]) assert.throws(ask, { message: "samples 'f11.csv' were freed" });
  samples.free();
});

test("coefficients are those of the file of the model, power after power of the wavelength", { skip: without_program }, () => {
  const file = join(folder, "coefficients.json");
  run("convert", "ptfe", file);
  const { blocks } = JSON.parse(readFileSync(file, "utf8"));
  const model = mmbrdf.material("ptfe");
  const micrometres = 0.6;
  const expected = blocks.flatMap(({ coefficients, modes }) => modes.map((_, i) => coefficients[i] + micrometres * coefficients[modes.length + i]));
  const found = model.at(600).coefficients();
  assert.equal(found.length, expected.length);
  found.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) <= 1e-15, `${value}, not ${expected[i]}`));
  const modes = blocks.flatMap(({ elements, modes: of }) => of.map(([name, n, m, k, l]) => ({ block: elements, function: name, n, m, k, l })));
  assert.deepEqual(model.modes, modes);
});

test("a difference of hemispheres has the differences of their values, and the range of both", () => {
  const [first, second] = ["ptfe-532", "ptfe-633"].map((name) => {
    const hemisphere = mmbrdf.hemisphere(32);
    hemisphere.evaluate(mmbrdf.material(name).at(532), 60, 180);
    return hemisphere;
  });
  const [a, b] = [first.values.slice(), second.values.slice()];
  second.subtract(first);
  second.values.forEach((value, i) => assert.equal(value, Math.fround(b[i] - a[i])));
  const striped = () => {
    second.colors.forEach((_, i, colors) => (colors[i] = 0xff000000 + i));
    second.limits.set(second.extremes());
    second.paint();
    return new Uint32Array(second.image.slice().buffer).filter((pixel) => pixel - 0xff000000 >= 512).length;
  };
  second.evaluate(mmbrdf.material("ptfe-532").at(532), 45);
  const before = striped();
  first.evaluate(mmbrdf.material("ptfe-532").at(532), 80); // beyond the fit in all directions
  second.subtract(first);
  assert.ok(striped() > 5 * before, `${striped()} pixels of stripes, ${before} before`);
  assert.throws(() => second.subtract(mmbrdf.hemisphere(64)), /as many pixels/);
  assert.throws(() => second.subtract(mmbrdf.hemisphere(32, { projection: "lambert" })), /the same projection/);
  assert.throws(() => second.subtract({}), { message: "subtract() of a hemisphere takes another, of the same load()" });
});

test("a number of a table is the double that is nearest to its text", () => {
  let state = 7;
  const random = () => (state = (1103515245 * state + 12345) % 2147483648) / 2147483648;
  const digits = (count) => [...Array(count)].map(() => Math.floor(10 * random())).join("");
  const texts = ["0", "-0", "1", ".5", "5.", "9007199254740993", "0.30000000000000004", "9999999999999999999", "1e22", "1E-5", "-2.5e-300", "1".repeat(25)];
  for (const places of [1, 6, 15, 16, 17, 18, 19, 20, 25])
    for (let i = 0; i < 200; ++i) texts.push(`${i % 2 ? "-" : ""}${i % 3 ? "0" : digits(1)}.${i % 5 ? "" : "000"}${digits(places)}`);
  const rows = texts.map((text) => `532,40,20,30,200,0.25,${text}\n`);
  const samples = mmbrdf.samples([[...head, "f11", "m12"].join(","), "\n", ...rows].join(""), "numbers.csv");
  const { values } = samples.elements(texts.map((_, i) => i), { normalized: true });
  texts.forEach((text, i) => assert.ok(Object.is(values[16 * i + 1], Number(text)), `${text} is ${values[16 * i + 1]}`));
});

test("a table that is read in parts is what it is at once, and says how far it is", { skip: without_program }, () => {
  const { samples, contents, all } = simulated();
  const reader = mmbrdf.sampleReader(contents, "samples.csv");
  assert.equal(reader.count, 0);
  const begun = reader.share;
  assert.ok(begun > 0 && begun < 0.1, `${begun} is read with the header`);
  assert.equal(reader.read(30), true);
  assert.equal(reader.count, 30);
  assert.ok(Math.abs(reader.share - 0.75) < 0.03, `${reader.share}`); // of 40 rows
  assert.equal(reader.read(30), false);
  assert.equal(reader.share, 1);
  const parts = reader.samples();
  assert.deepEqual(parts.places, samples.places);
  assert.deepEqual(parts.elements(all), samples.elements(all));
  for (const use of [() => reader.count, () => reader.share, () => reader.read(1), () => reader.samples()])
    assert.throws(use, { message: "the reader of 'samples.csv' was freed" });
});

test("a row that is wrong is refused where it is, when it is read", () => {
  const contents = `${[...head, "f11"].join(",")}\n${"532,40,20,30,200,0.25\n".repeat(5)}532,40,20,30,200,x\n`;
  const reader = mmbrdf.sampleReader(contents, "samples.csv");
  assert.equal(reader.read(5), true);
  const line = "samples.csv:7: f11: 'x' is not a number";
  assert.throws(() => reader.read(1), { message: line });
  reader.free();
  assert.throws(() => mmbrdf.samples(contents, "samples.csv"), { message: line });
  assert.throws(() => mmbrdf.sampleReader("532,1\n", "samples.csv"), /^Error: samples\.csv:1: no header line/);
});
