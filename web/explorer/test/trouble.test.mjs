// SPDX-License-Identifier: BSD-3-Clause
// What people do that was not thought of: the page says so in a line, and what it shows belongs together.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";

import load from "../../mmbrdf/index.js";
import { folder, run, without_program } from "../../mmbrdf/test/program.mjs";
import { answered, browser, opened, skip } from "./browser.mjs";

let chromium;
before(async () => {
  if (!skip) chromium = await browser();
});
after(async () => chromium?.close());

/** When the page has drawn what was changed, and its uncertainties are there. */
async function settled(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await answered(page);
}

const matrix = (page) => page.textContent("#matrix");
const trouble = (page) => page.textContent("#trouble");
const follow = async (page, hash) => {
  await page.evaluate((to) => (location.hash = to), hash);
  await settled(page);
};

/** A built-in model as a file. */
function file_of(material, name) {
  const path = `${folder}/${material}.json`;
  run("convert", material, path);
  return { name, mimeType: "application/json", buffer: readFileSync(path) };
}

test("two files of one name are two models, with uncertainties of their own", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#digits=true" });
  await page.selectOption("#model", "ptfe-633");
  await settled(page);
  const expected = await matrix(page);
  for (const material of ["ptfe-532", "ptfe-633"]) {
    await page.setInputFiles("#file", file_of(material, "same.json"));
    await page.waitForFunction((nm) => document.querySelector("#wavelength").value === nm, material.slice(5));
    await settled(page);
  }
  assert.equal(await matrix(page), expected);
  assert.deepEqual(complaints, []);
});
