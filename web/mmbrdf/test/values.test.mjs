// SPDX-License-Identifier: BSD-3-Clause
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import load from "../index.js";
import { analyzed, folder, geometries, run, without_program } from "./program.mjs";

const mmbrdf = await load();
const element_names = [...Array(16).keys()].map((e) => `f${1 + Math.floor(e / 4)}${1 + (e % 4)}`);
const value_tolerance = 1e-12; // of f11: another kernel, with its own rounding of 142 terms
const batch_error = 1e-12; // prediction.hpp, of the largest variance
const uncertainty_tolerance = 1e-9; // relative: sums over a covariance of some thousand terms

/** One of several wavelengths, one of a single wavelength, and published coefficients, which have no uncertainty. */
function models() {
  const coefficients = join(folder, "published.csv");
  run("convert", "ptfe-633", coefficients);
  return [
    ["ptfe", 600, mmbrdf.material("ptfe")],
    ["ptfe-351", 351, mmbrdf.material("ptfe-351")],
    [coefficients, 633, mmbrdf.model(readFileSync(coefficients), coefficients)],
  ];
}

test("a model that does not say to which wavelengths it was fitted has none", { skip: without_program }, () => {
  const [several, , published] = models().map(([, , model]) => model);
  assert.deepEqual(several.wavelengths, [351, 532, 633, 1064]);
  assert.deepEqual(published.wavelengths, []);
});

test("matrices, uncertainties, ranges and quantities are those of the program", { skip: without_program }, () => {
  const where = geometries();
  for (const [name, wavelength, model] of models())
    for (const frame of mmbrdf.frames) {
      const at = model.at(wavelength);
      const matrices = at.evaluate(where.flat(), { frame });
      const u = at.standardUncertainty(where.flat(), { frame });
      const outside = at.outside(where.flat());
      const quantities = at.quantities(where.flat());
      analyzed(name, wavelength, where, frame).forEach((row, i) => {
        const place = `${name}, ${frame}, ${where[i]}`;
        const f11 = Number(row.f11);
        element_names.forEach((element, e) => {
          const off = Math.abs(matrices[16 * i + e] - Number(row[element])) / f11;
          assert.ok(off <= value_tolerance, `${place}: ${element} is off by ${off} of f11`);
          assert_same_u(u[16 * i + e], row[`u_${element}`], Number(row.u_f11), `${place}: u of ${element}`);
        });
        assert.equal(outside[i].validity, row.validity, place);
        for (const [quantity, { values, uncertainties }] of Object.entries(quantities)) {
          const off = Math.abs(values[i] - Number(row[quantity]));
          assert.ok(off <= 1e-9, `${place}: ${quantity} is off by ${off}`);
          assert_same_u(uncertainties[i], row[`u_${quantity}`], 1, `${place}: u of ${quantity}`);
        }
      });
    }
});

/** Both unknown, or equal: what is 0 but for rounding is the root of what is left of variances as large as others. */
function assert_same_u(u, text, size, what) {
  if (text === "") return assert.ok(Number.isNaN(u), `${what} is ${u}, not unknown`);
  const expected = Number(text);
  const off = Math.abs(u ** 2 - expected ** 2);
  const tolerance = 2 * uncertainty_tolerance * expected ** 2 + batch_error * size ** 2;
  assert.ok(off <= tolerance, `${what} is ${u}, not ${text}`);
}

test("directional-hemispherical reflectances are those of the program", { skip: without_program }, () => {
  const at = mmbrdf.material("ptfe").at(532);
  const { values, uncertainties } = at.directionalHemisphericalReflectance([0, 8, 45, 75]);
  const place = ["-q", "dhr", "-w", "532", "--theta", "0,8,45,75", "--format", "csv"];
  const [header, ...rows] = run("integrate", "ptfe", ...place).trim().split("\n");
  const column = (name) => header.split(",").indexOf(name);
  rows.forEach((row, i) => {
    const fields = row.split(",").map(Number);
    const [dhr, u] = [fields[column("dhr")], fields[column("u_dhr")]];
    assert.ok(Math.abs(values[i] - dhr) <= 1e-12, `${values[i]}, not ${dhr}`);
    assert.ok(Math.abs(uncertainties[i] / u - 1) <= uncertainty_tolerance, `${uncertainties[i]}, not ${u}`);
  });
  assert.equal(rows.length, 4);
});

test("an answer has the same numbers as the lists, with parts whose squares add up", () => {
  const at = mmbrdf.material("ptfe").at(532);
  const geometry = { thetaI: 45, thetaR: 30, phiR: 180 };
  const answer = at.answer(geometry, { frame: "sp", convention: "p_first_right" });
  const matrix = at.evaluate(geometry, { frame: "sp", convention: "p_first_right" });
  assert.deepEqual(answer.elements, [...matrix]);
  assert.ok(answer.realizable && answer.estimable && !answer.extrapolated);
  const squares = answer.budget.reduce((sum, { u_f11 }) => sum + u_f11 ** 2, 0);
  assert.ok(Math.abs(Math.sqrt(squares) / answer.uncertainties[0] - 1) < 1e-9);
  const lists = at.quantities(geometry);
  for (const { name, value } of answer.quantities) assert.equal(value, lists[name].values[0], name);
});

test("conventions change signs, and normalised matrices are divided by f11", () => {
  const at = mmbrdf.material("ptfe").at(532);
  const geometry = [[60, 0, 40, 100]].flat();
  const ours = at.evaluate(geometry);
  const theirs = at.evaluate(geometry, { convention: "s_first_right" });
  const changed = [3, 7, 11, 12, 13, 14];
  ours.forEach((value, e) => assert.equal(theirs[e], changed.includes(e) ? -value : value));
  const divided = at.evaluate(geometry, { normalized: true });
  ours.forEach((value, e) => assert.ok(Math.abs(divided[e] - (e ? value / ours[0] : value)) < 1e-15));
});

test("a hemisphere has the matrices of its directions, to single precision", () => {
  const at = mmbrdf.material("ptfe").at(532);
  const single_precision_error = 2e-5; // batch.hpp, of f11
  for (const projection of ["projected", "lambert"])
    for (const options of [{}, { frame: "sp", convention: "p_first_left", normalized: true }]) {
      const hemisphere = mmbrdf.hemisphere(32, { projection });
      hemisphere.evaluate(at, 60, 180, options);
      const { count, positions, values } = hemisphere;
      for (let i = 0; i < count; i += 7) {
        const row = Math.floor(positions[i] / 128);
        const [x, y] = [(2 * (positions[i] % 128) + 1) / 32 - 1, 1 - (2 * row + 1) / 32];
        const r = Math.hypot(x, y);
        const theta = (projection === "lambert" ? 2 * Math.asin(r / Math.SQRT2) : Math.asin(r)) * (180 / Math.PI);
        const phi = Math.atan2(y, x) * (180 / Math.PI);
        const matrix = at.evaluate([60, 180, theta, phi], options);
        const size = options.normalized ? 1 : matrix[0];
        for (let e = 0; e < 16; ++e) assert.ok(Math.abs(values[e * count + i] - matrix[e]) <= single_precision_error * size);
      }
      hemisphere.free();
    }
});

test("an image has the colours of its values, stripes beyond the fitted range, a colour for NaN, and nothing beside the discs", () => {
  const pixels = 61; // rows that are no multiple of what is done at once
  const hemisphere = mmbrdf.hemisphere(pixels);
  hemisphere.evaluate(mmbrdf.material("ptfe").at(532), 60, 180);
  hemisphere.colors.forEach((_, i, colors) => (colors[i] = 0xff000000 + i));
  const extremes = hemisphere.extremes();
  hemisphere.limits.set(extremes);
  const { count, positions } = hemisphere;
  const values = hemisphere.values.slice();
  for (let e = 0; e < 16; ++e) {
    const column = values.subarray(e * count, (e + 1) * count);
    assert.deepEqual([...extremes.subarray(2 * e, 2 * e + 2)], [Math.min(...column), Math.max(...column)]);
  }
  const isUnknown = (i) => i % count === 100;
  hemisphere.values.forEach((_, i, all) => isUnknown(i) && (all[i] = NaN));
  hemisphere.paint();
  const image = new Uint32Array(hemisphere.image.slice().buffer);
  assert.equal(image.filter((pixel) => pixel !== 0).length, 16 * count);
  let striped = 0;
  values.forEach((value, at) => {
    const [e, i] = [Math.floor(at / count), at % count];
    const color = image[(Math.floor(e / 4) * 4 * pixels + (e % 4)) * pixels + positions[i]] - 0xff000000;
    if (isUnknown(at)) return assert.equal(color, 1024);
    const share = (value - extremes[2 * e]) / (extremes[2 * e + 1] - extremes[2 * e]);
    assert.ok(Math.abs((color % 512) - (e ? 256 : 0) - 255.999 * share) <= 1.001, `${color} at ${share} of element ${e}`);
    striped += color >= 512;
  });
  assert.ok(striped > 0 && striped < (16 * count) / 10, `${striped} of ${16 * count} are in stripes`); // theta_r > 81.87 degrees
});

test("what was freed says so", () => {
  const model = mmbrdf.material("ptfe-532");
  const at = model.at(532);
  model.free();
  assert.throws(() => at.evaluate([45, 0, 30, 180]), /model 'ptfe-532' was freed/);
  assert.throws(() => model.at(532), /was freed/);
});

test("memory is given back", () => {
  const once = () => {
    const model = mmbrdf.material("ptfe-532");
    const at = model.at(532);
    at.standardUncertainty([45, 0, 30, 180]);
    const hemisphere = mmbrdf.hemisphere(256);
    hemisphere.evaluate(at, 45);
    [hemisphere, at, model].forEach((one) => one.free());
    return hemisphere_memory();
  };
  const hemisphere_memory = () => {
    const hemisphere = mmbrdf.hemisphere(8);
    const size = hemisphere.image.buffer.byteLength;
    hemisphere.free();
    return size;
  };
  const first = once();
  for (let i = 0; i < 20; ++i) once();
  assert.equal(once(), first);
});

test("a model that is freed gives back what was prepared of it", () => {
  const size = () => {
    const hemisphere = mmbrdf.hemisphere(8);
    const bytes = hemisphere.image.buffer.byteLength;
    hemisphere.free();
    return bytes;
  };
  const once = () => {
    const model = mmbrdf.material("ptfe-532");
    for (const wavelength of [532, 600]) model.at(wavelength).standardUncertainty([45, 0, 30, 180]);
    model.free();
    return size();
  };
  const first = once();
  for (let i = 0; i < 40; ++i) once();
  assert.equal(once(), first);
});
