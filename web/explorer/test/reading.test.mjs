// SPDX-License-Identifier: BSD-3-Clause
// A table that takes a while to read: the page goes on, and the reading can be stopped.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";

import { answered, browser, opened, skip } from "./browser.mjs";

let chromium;
before(async () => {
  if (!skip) chromium = await browser();
});
after(async () => chromium?.close());

const row = (i) => `532,45,0,${(i % 70) + 0.123456789012345},180,0.3,${"0.0123456789012345,".repeat(14)}0.5`;

/** Opens a table of some 20 MB: it takes 2 s to read at least, in parts of some milliseconds. */
const openLargeTable = (page) =>
  page.evaluate(
    ([head, rows]) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([head, ...Array(900).fill(rows)], "large.csv"));
      document.body.dispatchEvent(new DragEvent("drop", { bubbles: true, dataTransfer }));
    },
    [
      `wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f11,${[...Array(15).keys()].map((e) => `m${1 + ((e + 1) >> 2)}${1 + ((e + 1) % 4)}`).join(",")}\n`,
      [...Array(70).keys()].map((i) => `${row(i)}\n`).join(""),
    ],
  );
const reading = (page) => page.textContent("#reading");

test("while a large table is read the page says how far it is, shows what is asked of it, and in the end the samples", { skip }, async () => {
  const { page, complaints } = await opened(chromium);
  await answered(page);
  await openLargeTable(page);
  await page.waitForFunction(() => /^Reading large\.csv: \d0 % …$/.test(document.getElementById("reading").textContent));
  await page.fill("#thetaI", "20");
  await page.waitForFunction(() => location.hash.includes("thetaI=20"));
  assert.match(await reading(page), /^Reading large\.csv: \d0 % …$/); // that was shown meanwhile
  await page.waitForFunction(() => document.getElementById("samples-words").textContent.startsWith("large.csv: 63000 samples"), undefined, { timeout: 60000 });
  assert.equal(await reading(page), "");
  assert.equal(await page.isVisible("#stop-reading"), false);
  assert.equal(await page.inputValue("#thetaI"), "45"); // the light of the samples
  assert.deepEqual(complaints, []);
});

test("the reading of a large table can be stopped, and what was shown stays", { skip }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#thetaI=20" });
  await answered(page);
  assert.equal(await page.isVisible("#stop-reading"), false);
  await openLargeTable(page);
  await page.getByRole("button", { name: "Stop reading" }).click();
  await page.waitForFunction(() => document.getElementById("trouble").textContent);
  assert.match(await page.textContent("#trouble"), /^large\.csv: stopped at sample \d+: none of them is shown\.$/);
  assert.equal(await reading(page), "");
  assert.equal(await page.isVisible("#stop-reading"), false);
  assert.equal(await page.isVisible("#samples-csv"), false);
  assert.equal(await page.inputValue("#thetaI"), "20");
  assert.deepEqual(complaints, []);
});

test("a file that is too large for the memory of a page is refused in a line that says what to do", { skip }, async () => {
  const { page, complaints } = await opened(chromium);
  await answered(page);
  await page.evaluate(() => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File(["wavelength_nm"], "huge.csv"));
    Object.defineProperty(File.prototype, "size", { get: () => 640000000 });
    document.body.dispatchEvent(new DragEvent("drop", { bubbles: true, dataTransfer }));
  });
  await page.waitForFunction(() => document.getElementById("trouble").textContent);
  assert.match(await page.textContent("#trouble"), /^huge\.csv: 640 MB: the page reads up to 500 MB; the program takes larger tables/);
  assert.deepEqual(complaints, []);
});
