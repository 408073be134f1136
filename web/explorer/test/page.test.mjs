// SPDX-License-Identifier: BSD-3-Clause
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { readFileSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { join } from "node:path";
import { gzipSync } from "node:zlib";

import { analyzed, folder, refusal, run, without_program } from "../../mmbrdf/test/program.mjs";
import { answered, browser, opened, page_file, skip } from "./browser.mjs";

let chromium;
before(async () => {
  if (!skip) chromium = await browser();
});
after(async () => chromium?.close());

const set = async (page, name, value) => page.fill(`#${name}`, String(value));
const near = (value, expected, size, what) =>
  assert.ok(Math.abs(value - expected) <= size, `${what}: ${value}, not ${expected}`);

/** The matrix as it can be read on the page. */
const matrix = (page) =>
  page.$$eval("#matrix td", (cells) =>
    cells.map((cell) => [cell.querySelector(".value").textContent, cell.querySelector(".u").textContent]),
  );

test("f11, its uncertainty and the CSV of the in-plane curve are found by their names", { skip: skip || without_program }, async () => {
  const { page } = await opened(chromium);
  await page.getByRole("combobox", { name: "Model", exact: true }).selectOption("ptfe");
  await page.getByRole("spinbutton", { name: "Wavelength" }).fill("600");
  await answered(page);
  const expected = /f11 = ([\d.]+) sr⁻¹, standard uncertainty ([\d.]+) sr⁻¹/;
  const [, f11, u] = expected.exec(await page.getByRole("status").textContent());
  const [row] = analyzed("ptfe", 600, [[45, 0, 30, 180]], "xy");
  near(Number(f11), Number(row.f11), 0.00005, "f11");
  near(Number(u), Number(row.u_f11), 0.00005, "u");
  assert.ok(await page.locator("#quantities").getByText("0 for a perfect depolarizer, 1 where no light is depolarized").isVisible()); // 0.04 is not "little depolarized"

  const waiting = page.waitForEvent("download");
  await page.getByRole("button", { name: "Curve as CSV" }).click();
  const csv = readFileSync(await (await waiting).path(), "utf8").trim().split("\n");
  const head = csv[0].split(",");
  const scan = csv.slice(1).map((line) => Object.fromEntries(line.split(",").map((field, c) => [head[c], field])));
  const where = scan.map((one) => [one.theta_i_deg, one.phi_i_deg, one.theta_r_deg, one.phi_r_deg]);
  assert.equal(scan.length, 171);
  analyzed("ptfe", 600, where, "xy").forEach((theirs, i) => {
    for (const name of ["f11", "u_f11", "f_ss", "f_sp", "u_f_pp", "entropy"])
      near(Number(scan[i][name]), Number(theirs[name]), 1e-9 * Number(theirs.f11), `${where[i]}: ${name}`);
    assert.equal(scan[i].validity, theirs.validity);
  });
});

test("the lines of the page give the numbers of the page", { skip: skip || without_program }, async () => {
  for (const normalized of [false, true]) {
    const { page } = await opened(chromium, { hash: `#wavelength=600&thetaI=50&frame=sp&digits=true&normalized=${normalized}` });
    await answered(page);
    const [evaluate] = (await page.textContent("#program")).split("\n");
    const printed = JSON.parse(run(...evaluate.split(" ").slice(1), "--format", "json"));
    const [values, u] = [printed.mueller.flat(), printed.u_mueller.flat()];
    if (normalized) [values[0], u[0]] = [printed.f11, printed.u_f11];
    (await matrix(page)).forEach(([value, uncertainty], e) => {
      near(Number(value), values[e], 1e-12, `element ${e}`);
      near(Number(uncertainty), u[e], 1e-9, `u of element ${e}`);
    });
    assert.equal(/m = mmbrdf\.normalized\(f\)/.test(await page.textContent("#python")), normalized);
  }
});

test("the page takes at most 900 kB to load, compressed", { skip }, () => {
  const bytes = gzipSync(readFileSync(page_file), { level: 9 }).length;
  assert.ok(bytes <= 900000, `${bytes} bytes`);
});

test("a drag of the light moves it, pictures follow, and the link says where it is", { skip }, async () => {
  const { page, complaints } = await opened(chromium);
  await answered(page);
  const box = await page.locator("#hemispheres").boundingBox();
  const size = box.width / 4;
  const inFirst = (x, y) => [box.x + (size / 2) * (1 + x), box.y + (size / 2) * (1 - y)];
  await page.mouse.move(...inFirst(Math.SQRT1_2, 0));
  await page.mouse.down();
  await page.mouse.move(...inFirst(0, 0.5), { steps: 8 });
  await page.mouse.up();
  await answered(page);
  near(Number(await page.inputValue("#thetaI")), 30, 1.5, "theta_i");
  near(Number(await page.inputValue("#phiI")), 90, 2, "phi_i");
  assert.equal(await page.inputValue("#thetaR"), "30");

  const link = page.url();
  const { page: again } = await opened(chromium, { hash: link.slice(link.indexOf("#")) });
  assert.equal(await again.inputValue("#phiI"), await page.inputValue("#phiI"));
  await answered(again);
  assert.equal(await again.textContent("#matrix"), await page.textContent("#matrix"));
  assert.deepEqual(complaints, []);
});

test("a locked scale stays, a free one follows", { skip }, async () => {
  const { page } = await opened(chromium);
  const legend = () => page.textContent("#legend-f11");
  await page.check("#locked");
  const locked = await legend();
  await set(page, "thetaI", 75);
  await page.waitForFunction(() => location.hash.includes("thetaI=75"));
  assert.match(locked, /locked/);
  assert.equal(await legend(), locked);
  await page.uncheck("#locked");
  await page.waitForFunction((before) => document.querySelector("#legend-f11").textContent !== before, locked);
});

test("what is beyond the fitted range is said in words", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#thetaI=80" });
  assert.match(await page.getByRole("status").textContent(), /Extrapolated: .*theta_i <= 75/);
});

test("a file that is none of ours gives the program's line, and the page goes on", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium);
  const file = join(folder, "cut.json");
  run("convert", "ptfe-532", join(folder, "whole.json"));
  const whole = readFileSync(join(folder, "whole.json"), "utf8");
  for (const share of [0, 0.1, 0.5, 0.99]) {
    writeFileSync(file, whole.slice(0, Math.floor(share * whole.length)));
    await page.setInputFiles("#file", file);
    const line = refusal("evaluate", "cut.json", "-w", "532", "-i", "45,0", "-r", "30,180");
    await page.waitForFunction((expected) => document.querySelector("#trouble").textContent === expected, line);
  }
  await set(page, "wavelength", 633);
  await answered(page);
  assert.match(await page.getByRole("status").textContent(), /f11 = 0\.3/);
  assert.deepEqual(complaints, []);
});

test("nothing is asked of a network, and nothing is complained of", { skip }, async () => {
  const { page, requests, complaints } = await opened(chromium);
  await answered(page);
  for (const frame of ["sp", "scattering_plane"]) await page.selectOption("#frame", frame);
  for (const curve of ["f11", "entropy", "dhr"]) await page.selectOption("#curve", curve);
  await page.selectOption("#projection", "lambert");
  await page.check("#normalized");
  await answered(page);
  const outside = requests.filter((url) => !/^(file|data|blob):/.test(url));
  assert.deepEqual(outside, []);
  assert.equal(requests.filter((url) => url.startsWith("file:")).length, 1);
  assert.deepEqual(complaints, []);
});

for (const [colorScheme, width] of [["light", 1280], ["dark", 1280], ["light", 390]])
  test(`axe finds no violation (${colorScheme}, ${width} pixels wide)`, { skip }, async () => {
    const { page } = await opened(chromium, { colorScheme, viewport: { width, height: 844 } });
    await answered(page);
    await page.addScriptTag({ path: createRequire(import.meta.url).resolve("axe-core") });
    const { violations } = await page.evaluate(() => window.axe.run());
    assert.deepEqual(violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(" ")}`), []);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= width, `the page is ${wide} pixels wide`);
  });

test("keys alone reach every control, and move both directions", { skip }, async () => {
  const { page } = await opened(chromium);
  await answered(page);
  const wanted = await page.$$eval("input, select, button, #hemispheres", (all) => all.filter((one) => one.checkVisibility()).map(({ id }) => id));
  const reached = new Set();
  for (let i = 0; i < wanted.length + 12; ++i) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => document.activeElement.id));
  }
  assert.deepEqual(wanted.filter((id) => !reached.has(id)), []);
  await page.focus("#hemispheres");
  for (const key of ["ArrowUp", "ArrowUp", "ArrowRight", "Shift+ArrowDown", "Shift+ArrowLeft"]) {
    await page.keyboard.press(key);
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  }
  const fields = await Promise.all(["thetaI", "phiI", "thetaR", "phiR"].map((id) => page.inputValue(`#${id}`)));
  assert.deepEqual(fields, ["47", "1", "29", "179"]);
});

test("the picture of the README", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#thetaI=60&phiI=180&thetaR=40&phiR=20&normalized=true", viewport: { width: 1180, height: 1010 } });
  await answered(page);
  const picture = await page.screenshot({ path: process.env.MMBRDF_SCREENSHOT, clip: { x: 0, y: 0, width: 1180, height: 1010 } });
  assert.ok(picture.length < 450000, `${picture.length} bytes`); // its colours are reduced for docs/explorer.png
});
