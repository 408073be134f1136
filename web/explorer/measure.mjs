// SPDX-License-Identifier: BSD-3-Clause
// How fast the page is here: node measure.mjs, after ./dev test web. Medians; nothing is promised by a test.
import { readFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

import { answered, browser, opened, page_file } from "./test/browser.mjs";

const chromium = await browser();
const median = (list) => list.sort((a, b) => a - b)[Math.floor(list.length / 2)];

const first = [];
const uncertain = [];
for (let i = 0; i < 5; ++i) {
  const { page } = await opened(chromium);
  first.push(await page.evaluate(() => performance.getEntriesByName("frame")[0].startTime + performance.getEntriesByName("frame")[0].duration));
  await answered(page);
  uncertain.push(await page.evaluate(() => performance.now()));
  await page.context().close();
}

const { page } = await opened(chromium);
await answered(page);
await page.evaluate(async () => {
  performance.clearMeasures();
  const field = document.querySelector("#phiI");
  for (let i = 0; i < 300; ++i) {
    field.value = String(i / 2);
    field.dispatchEvent(new Event("input", { bubbles: true }));
    await new Promise(requestAnimationFrame);
    await new Promise(requestAnimationFrame);
  }
});
const times = (name) => page.evaluate((of) => performance.getEntriesByName(of).map(({ duration }) => duration), name);
const frames = await times("frame");
const inModule = await times("module");
await chromium.close();

const bytes = readFileSync(page_file);
console.log(`first picture        ${median(first).toFixed(0)} ms after the navigation (least ${first[0].toFixed(0)})`);
console.log(`first uncertainties  ${median(uncertain).toFixed(0)} ms`);
console.log(`a frame              ${median(frames).toFixed(1)} ms (least ${frames[0].toFixed(1)}) of ${frames.length}: 16 x 192 x 192`);
console.log(`of it in the module  ${median(inModule).toFixed(1)} ms (least ${inModule[0].toFixed(1)})`);
console.log(`the page             ${bytes.length} bytes, ${gzipSync(bytes, { level: 9 }).length} compressed`);
