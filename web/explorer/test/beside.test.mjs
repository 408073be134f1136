// SPDX-License-Identifier: BSD-3-Clause
// What is shown beside a model: samples of a file, and another model.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { join } from "node:path";

import { analyzed, folder, refusal, run, without_program } from "../../mmbrdf/test/program.mjs";
import { answered, browser, opened, skip } from "./browser.mjs";

let chromium;
before(async () => {
  if (!skip) chromium = await browser();
});
after(async () => chromium?.close());

const near = (value, expected, size, what) => assert.ok(Math.abs(value - expected) <= size, `${what}: ${value}, not ${expected}`);
const trouble = (page) => page.textContent("#trouble");
const points = async (page) => Number(await page.getAttribute("#canvas", "data-points"));

async function settled(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await answered(page);
}

/** Rows of a CSV that a button makes, by column. */
async function taken(page, button) {
  const waiting = page.waitForEvent("download");
  await page.click(button);
  const lines = readFileSync(await (await waiting).path(), "utf8").trim().split("\n").filter((line) => !line.startsWith("#"));
  const fields = (line) => line.match(/("[^"]*"|[^,]*)(,|$)/g).map((one) => one.replace(/,$/, "").replaceAll('"', ""));
  const head = fields(lines[0]);
  return lines.slice(1).map((line) => Object.fromEntries(fields(line).map((field, c) => [head[c], field])));
}

const head = ["wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg"];
const names = [...Array(16).keys()].map((e) => `${1 + (e >> 2)}${1 + (e & 3)}`);
const column = (name) => (name === "11" ? "f11" : `m${name}`);

/** Samples 1 % brighter than ptfe-532, in the plane of incidence and beside it, of these elements; at 60 degrees there is one more. */
function measured(name, { elements = names, u = true } = {}) {
  const where = [...Array(29).keys()].map((i) => [45, 180, Math.abs(5 * i - 70), i < 14 ? 180 : 0]);
  for (const phi of [30, 60, 90, 120]) where.push([45, 180, 30, phi]);
  where.push([60, 180, 30, 0]);
  const rows = analyzed("ptfe-532", 532, where, "xy").map((row, i) => {
    const values = elements.map((e) => (e === "11" ? 1.01 * row.f11 : row[`f${e}`] / row.f11));
    return [532, ...where[i], ...values, ...(u ? elements.map((e) => (e === "11" ? 0.002 : 0.004)) : [])].join(",");
  });
  const file = join(folder, name);
  writeFileSync(file, [[...head, ...elements.map(column), ...(u ? elements.map((e) => `u_${column(e)}`) : [])].join(","), ...rows, ""].join("\n"));
  return file;
}

test("samples of a file are points, with residuals to a model and over the uncertainties of both", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#model=ptfe-532&digits=true" });
  await page.setInputFiles("#file", measured("samples.csv"));
  await page.waitForSelector("#samples-csv:visible");
  await settled(page);
  assert.equal(await page.inputValue("#phiI"), "180"); // the light of the samples
  assert.equal(await points(page), 33 * 16);
  assert.match(await page.textContent("#samples-words"), /^samples\.csv: 34 samples, with uncertainties\. 33 at this light and wavelength\. rms of data − model of f11: 0\.003\d/);
  assert.equal(await page.locator("#chart circle.sample").count(), 29 * 4); // in the plane of incidence, of four curves
  assert.equal(await page.locator("#chart circle.residual").count(), 29 * 4);

  const rows = await taken(page, "#samples-csv");
  assert.equal(rows.length, 33);
  const theirs = analyzed("ptfe-532", 532, rows.map((row) => head.slice(1).map((name) => row[name])), "xy");
  rows.forEach((row, i) => {
    const model = Number(theirs[i].f11);
    near(Number(row.model_f11), model, 1e-12, "f11 of the model");
    near(Number(row.residual_f11), 0.01 * model, 1e-12, "residual");
    const u = Math.hypot(0.002, Number(theirs[i].u_f11));
    near(Number(row.residual_over_u_f11), (0.01 * model) / u, 1e-6, "residual over u"); // u to 1e-9
    near(Number(row.residual_f22), 0.01 * Number(theirs[i].f22), 1e-12, "residual of f22"); // m22 is the model's
  });
  assert.deepEqual(complaints, []);
});

test("a sample at the chosen direction is shown in the matrix, and in words", { skip: skip || without_program }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532&digits=true" });
  await page.setInputFiles("#file", measured("samples.csv"));
  await page.waitForSelector("#samples-csv:visible");
  await page.fill("#phiR", "0");
  await settled(page);
  const [row] = analyzed("ptfe-532", 532, [[45, 180, 30, 0]], "xy");
  const cell = await page.textContent("#matrix td[data-element=f11] .measured");
  const [, data, off, over] = /^data (\S+), data − model (\S+) \((\S+) u\)$/.exec(cell);
  near(Number(data), 1.01 * row.f11, 1e-12, "data");
  near(Number(off), 0.01 * row.f11, 1e-12, "data - model");
  near(Number(over), (0.01 * row.f11) / Math.hypot(0.002, row.u_f11), 0.01, "over u"); // it is shown with two decimals
  assert.match(await page.textContent("#sample-words"), /^Sample 21 of samples\.csv, at θr 30°, φr 0°: f11 = /);
  await page.fill("#phiR", "10"); // none within a degree
  await settled(page);
  assert.equal(await page.textContent("#sample-words"), "");
  assert.equal(await page.locator("#matrix .measured").count(), 0);
});

test("elements that were not measured have no points, and uncertainties that are not stated no residuals over them", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#model=ptfe-532&curve=f11" });
  await page.setInputFiles("#file", measured("f11.csv", { elements: ["11"], u: false }));
  await page.waitForSelector("#samples-csv:visible");
  await settled(page);
  assert.equal(await points(page), 33);
  assert.match(await page.textContent("#samples-words"), /without uncertainties, 15 elements were not measured and have no points/);
  assert.equal(await page.locator("#chart circle.sample").count(), 29);
  assert.equal(await page.textContent("#legend-points"), "points: f11.csv, in the colours of the pictures");
  await page.selectOption("#points", "residuals");
  await settled(page);
  assert.match(await page.textContent("#legend-points"), /^points: f11\.csv − model, from −3 rms/);
  await page.selectOption("#points", "over_u");
  await settled(page);
  assert.equal(await points(page), 0);
  assert.equal(await page.textContent("#legend-points"), "no points: f11.csv does not state its uncertainties");
  await page.selectOption("#curve", "polarized");
  await settled(page);
  assert.equal(await page.locator("#chart circle.sample").count(), 0);
  const [row] = await taken(page, "#samples-csv");
  const group = ["f11", "u_f11", "model_f11", "u_model_f11", "residual_f11", "residual_over_u_f11"];
  assert.deepEqual(Object.keys(row), ["sample", ...head, ...group]);
  assert.equal(row.u_f11 + row.residual_over_u_f11, "");
  assert.deepEqual(complaints, []);
});

test("the list of lights goes to another, and samples can be taken away", { skip: skip || without_program }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532" });
  await page.setInputFiles("#file", measured("samples.csv"));
  await page.waitForSelector("#samples-csv:visible");
  await settled(page);
  await page.selectOption("#incidence", { label: "532 nm, θi 60°, φi 180° (1)" });
  await settled(page);
  assert.equal(await page.inputValue("#thetaI"), "60");
  assert.equal(await points(page), 16);
  await page.fill("#thetaI", "20");
  await settled(page);
  assert.equal(await points(page), 0);
  assert.match(await page.textContent("#samples-words"), /None at this light and wavelength/);
  await page.click("#no-samples");
  await settled(page);
  assert.equal(await page.isVisible("#samples-csv"), false);
  assert.equal(await page.textContent("#samples-words"), "");
});

test("of many lights the list has the first, and says how many more there are", { skip: skip || without_program }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532" });
  await page.setInputFiles("#file", { name: "many.csv", mimeType: "text/csv", buffer: Buffer.from(run("simulate", "ptfe-532", "--grid", "random:600")) });
  await page.waitForSelector("#samples-csv:visible");
  await settled(page);
  const lights = await page.$$eval("#incidence option", (all) => all.map((one) => one.textContent));
  assert.equal(lights.length, 501);
  assert.equal(lights[0], "another light, or one of 100 more");
  assert.equal(await points(page), 16); // the nearest of all lights is shown
});

test("of thousands of samples at a light one in so many is shown, and the page says so", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#model=ptfe-532&curve=f11" });
  const row = (i) => `532,45,180,${(i % 700) / 10},${i % 360},0.33`;
  const rows = [[...head, "f11"].join(","), ...[...Array(10001).keys()].map(row), ""];
  await page.setInputFiles("#file", { name: "many.csv", mimeType: "text/csv", buffer: Buffer.from(rows.join("\n")) });
  await page.waitForSelector("#samples-csv:visible");
  await settled(page);
  assert.match(await page.textContent("#samples-words"), /\. 10001 at this light and wavelength, of which one in 6 is shown\./);
  assert.equal(await points(page), 1667);
  assert.deepEqual(complaints, []);
});

test("a negative polar angle of a sample is the opposite azimuth", { skip }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#model=ptfe-532" });
  const rows = [[...head, "f11"].join(","), "532,-45,0,30,0,0.33", "532,45,180,-30,0,0.32", "532,-45,0,-30,180,0.31", ""];
  await page.setInputFiles("#file", { name: "negative.csv", mimeType: "text/csv", buffer: Buffer.from(rows.join("\n")) });
  await page.waitForSelector("#samples-csv:visible");
  await settled(page);
  const lights = await page.$$eval("#incidence option", (all) => all.map((one) => one.textContent));
  assert.deepEqual(lights.slice(1), ["532 nm, θi 45°, φi 180° (3)"]);
  assert.equal(await page.inputValue("#phiI"), "180");
  assert.equal(await points(page), 3);
  assert.deepEqual(complaints, []);
});

test("samples at a wavelength that no model takes leave what is shown, and say why", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#model=ptfe-532" });
  const rows = [[...head, "f11"].join(","), "1e20,45,0,30,0,0.33", ""];
  await page.setInputFiles("#file", { name: "far.csv", mimeType: "text/csv", buffer: Buffer.from(rows.join("\n")) });
  await page.waitForFunction(() => document.querySelector("#trouble").textContent === "wavelength 1e+20 nm is more than a metre");
  await settled(page);
  assert.equal(await page.inputValue("#wavelength"), "532");
  await page.fill("#thetaI", "20");
  await settled(page);
  const [row] = analyzed("ptfe-532", 532, [[20, 0, 30, 180]], "xy");
  near(Number(/f11 = (\S+) sr/.exec(await page.textContent("#words"))[1]), Number(row.f11), 0.0001, "f11");
  assert.equal(await trouble(page), "");
  assert.deepEqual(complaints, []);
});

test("samples that cannot be read give the program's line, and those that are shown stay", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#model=ptfe-532" });
  const good = readFileSync(measured("samples.csv"), "utf8");
  await page.setInputFiles("#file", join(folder, "samples.csv"));
  await page.waitForSelector("#samples-csv:visible");
  const file = join(folder, "wrong.csv");
  const rows = good.split("\n");
  for (const contents of [
    rows[0], rows.slice(0, 9).join("\n") + "\n532,95,0,0,0", good.replace("532,45", "x,45"), good.replace("u_m44", "u_m45"), good.replace("theta_i_deg", "alpha"), good.slice(0, 1000),
  ]) {
    writeFileSync(file, contents);
    const line = refusal("compare", "ptfe-532", "wrong.csv");
    assert.match(line, /^wrong\.csv/);
    await page.setInputFiles("#file", file);
    await page.waitForFunction((expected) => document.querySelector("#trouble").textContent === expected, line);
  }
  await page.fill("#thetaR", "31");
  await settled(page);
  assert.equal(await points(page), 33 * 16);
  assert.deepEqual(complaints, []);
});

test("two models: both numbers and their difference, from a link that keeps them", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#model=ptfe-532&digits=true&curve=f11&compare=ptfe-633&shown=difference" });
  await settled(page);
  assert.match(await page.textContent("#legend-f11"), /^Δf11: -/);
  assert.match(await page.textContent("#tiles"), /Δf44/);
  const [first] = analyzed("ptfe-532", 532, [[45, 0, 30, 180]], "xy");
  const [second] = analyzed("ptfe-633", 532, [[45, 0, 30, 180]], "xy");
  for (const name of names.map((e) => `f${e}`)) {
    const [, other, off] = /^other (\S+), Δ (\S+?)( \(.*)?$/.exec(await page.textContent(`#matrix td[data-element=${name}] .other`));
    near(Number(other), Number(second[name]), 1e-12, `${name} of the other`);
    near(Number(off), second[name] - first[name], 1e-12, `difference of ${name}`);
  }
  const rows = await taken(page, "#csv");
  const where = rows.map((row) => head.slice(1).map((name) => row[name]));
  const [ours, others] = ["ptfe-532", "ptfe-633"].map((name) => analyzed(name, 532, where, "xy"));
  rows.forEach((row, i) => {
    near(Number(row.f11), Number(ours[i].f11), 1e-12, "f11");
    near(Number(row.other_f11), Number(others[i].f11), 1e-12, "f11 of the other");
    near(Number(row.u_other_f11), Number(others[i].u_f11), 1e-9, "its u");
    assert.deepEqual([row.validity, row.other_validity], [ours[i].validity, others[i].validity]);
  });
  assert.match(rows[85].other_validity, /wavelength/);
  assert.match(await page.textContent("#other-beyond"), /^ptfe-633 is extrapolated here: outside the fitted range \(wavelength\)/);
  const hatched = await page.$$eval("#chart rect[fill='url(#hatch)']", (all) => all.map((one) => Number(one.getAttribute("width"))));
  assert.deepEqual(hatched, [566]); // all of the difference
  const off = rows.map((_, i) => others[i].f11 - ours[i].f11);
  const [, low, high] = /Δ f11 from (\S+) to (\S+)\.$/.exec(await page.getAttribute("#chart svg", "aria-label"));
  near(Number(low), Math.min(...off), 1e-7, "the least of the curve of differences"); // six digits are said
  near(Number(high), Math.max(...off), 1e-7, "the largest");
  assert.match(page.url(), /compare=ptfe-633&.*shown=difference|shown=difference.*compare=ptfe-633/);
  assert.match(await page.textContent("#program"), /\nmmbrdf compare ptfe-532 ptfe-633 -w 532$/);
  assert.deepEqual(complaints, []);
});

test("of another model that is extrapolated the words of the curve say so", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532&compare=ptfe-633&curve=f11" });
  await settled(page);
  assert.match(await page.textContent("#chart-words"), /Thin: ptfe-633, extrapolated\./);
  await page.fill("#wavelength", "633");
  await settled(page);
  assert.match(await page.textContent("#chart-words"), /Thin: ptfe-633, extrapolated in part\./); // beyond 81.87 degrees
  assert.equal(await page.textContent("#other-beyond"), "");
});

test("a model beside itself differs by nothing, and goes when it is not chosen", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532&compare=ptfe-532&curve=f11" });
  await settled(page);
  assert.equal(await page.locator("#chart path.other").count(), 1);
  const cells = await page.$$eval("#matrix .other", (all) => all.map((one) => one.textContent));
  assert.equal(cells.length, 16);
  for (const words of cells) assert.match(words, /, Δ 0(\.0*)?( \(0\.\d+ u\))?$/);
  await page.selectOption("#shown", "difference");
  await settled(page);
  assert.match(await page.textContent("#legend-f11"), /^Δf11: -1.*1 sr/); // all is 0: a scale about it
  await page.selectOption("#compare", "");
  await settled(page);
  assert.equal(await page.locator("#matrix .other").count(), 0);
  assert.doesNotMatch(await page.textContent("#legend-f11"), /Δ/);
});

test("a link to another model that is not here leaves it out, and says so in a line", { skip }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#model=ptfe-532&compare=mine.json" });
  await settled(page);
  assert.equal(await trouble(page), "compare = mine.json of the link is not here. A link does not hold files: open it again.");
  assert.equal(await page.inputValue("#compare"), "");
  assert.match(await page.textContent("#words"), /standard uncertainty 0\.00\d+ sr/);
  assert.deepEqual(complaints, []);
});

test("a file can be the other model", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#model=ptfe-532&wavelength=532" });
  const file = join(folder, "mine.json");
  run("convert", "ptfe-633", file);
  await page.setInputFiles("#file", file);
  await page.waitForFunction(() => document.querySelector("#model").value === "mine.json");
  await page.selectOption("#model", "ptfe-532");
  await page.selectOption("#compare", "mine.json");
  await settled(page);
  assert.match(await page.textContent("#matrix td[data-element=f11] .other"), /^other 0\.3\d+, Δ .*u\)$/);
  assert.match(await page.textContent("#program"), /\nmmbrdf compare ptfe-532 mine\.json -w /);
  assert.deepEqual(complaints, []);
});
