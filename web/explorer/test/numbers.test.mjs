// SPDX-License-Identifier: BSD-3-Clause
// What can be read on the page is what the program prints, at many directions.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { join } from "node:path";

import { analyzed, folder, geometries, run, without_program } from "../../mmbrdf/test/program.mjs";
import { answered, browser, opened, skip } from "./browser.mjs";

let chromium;
before(async () => {
  if (!skip) chromium = await browser();
});
after(async () => chromium?.close());

const near = (value, expected, size, what) =>
  assert.ok(Math.abs(value - expected) <= size, `${what}: ${value}, not ${expected}`);

/** Types four angles of each direction and reads the matrix and its uncertainties, as texts, when they are there. */
const typed_and_read = (page, directions) =>
  page.evaluate(async (all) => {
    const busy = () => document.querySelector("#quantities").getAttribute("aria-busy") === "true";
    const read = [];
    for (const angles of all) {
      ["thetaI", "phiI", "thetaR", "phiR"].forEach((id, i) => {
        const field = document.getElementById(id);
        field.value = angles[i];
        field.dispatchEvent(new Event("input", { bubbles: true }));
      });
      await new Promise(requestAnimationFrame);
      await new Promise((done) => {
        const ask = () => (busy() ? setTimeout(ask) : done());
        setTimeout(ask);
      });
      read.push(Array.from(document.querySelectorAll("#matrix td"), (cell) => [".value", ".u"].map((part) => cell.querySelector(part).textContent)));
    }
    return read;
  }, directions);

for (const [name, wavelength] of [["ptfe", 600], ["ptfe-1064", 1064], ["published.csv", 633]])
  test(`numbers on the page are those of the program at 200 directions in all frames: ${name}`, { skip: skip || without_program }, async () => {
    const file = join(folder, name);
    const { page, complaints } = await opened(chromium, { hash: "#digits=true&curve=dhr" }); // the curve that takes least time
    if (name.endsWith("csv")) {
      run("convert", "ptfe-633", file);
      await page.setInputFiles("#file", file);
    } else await page.selectOption("#model", name);
    await page.waitForFunction((model) => document.querySelector("#model").value === model, name);
    await page.fill("#wavelength", String(wavelength));
    await answered(page);
    const where = geometries(201).filter(([theta]) => theta >= 0); // of 201 one is below 0, which fields do not take
    for (const frame of ["xy", "sp", "scattering_plane"]) {
      await page.selectOption("#frame", frame);
      const rows = analyzed(name.endsWith("csv") ? file : name, wavelength, where, frame);
      const read = await typed_and_read(page, rows.map((row) => [row.theta_i_deg, row.phi_i_deg, row.theta_r_deg, row.phi_r_deg]));
      assert.equal(read.length, 200);
      rows.forEach((row, i) => {
        read[i].forEach(([value, u], e) => {
          const element = `f${1 + (e >> 2)}${1 + (e & 3)}`;
          const what = `${frame}, ${where[i]}: ${element}`;
          near(Number(value), Number(row[element]), 1e-12 * Number(row.f11), what);
          if (row.u_f11 === "") assert.equal(u, "NaN", what);
          else near(Number(u) ** 2, Number(row[`u_${element}`]) ** 2, 1e-9 * Number(row.u_f11) ** 2, `${what}, square of u`);
        });
      });
    }
    assert.deepEqual(complaints, []);
  });
