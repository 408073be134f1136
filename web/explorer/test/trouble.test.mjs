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

test("a link to a model that is not here leaves what is shown, and says so in a line", { skip }, async () => {
  const { page, complaints } = await opened(chromium);
  await settled(page);
  const [expected, link] = [await matrix(page), page.url()];
  await follow(page, "#model=nosuch.json&thetaI=10");
  assert.match(await trouble(page), /^material 'nosuch.json' is not one of .*A link does not hold files: open it again\.$/);
  assert.equal(await matrix(page), expected);
  assert.equal(page.url(), link);
  assert.match(await page.textContent("#words"), /standard uncertainty 0\.00\d+ sr/);
  await page.fill("#thetaI", "50");
  await settled(page);
  assert.match(await page.textContent("#words"), /standard uncertainty 0\.00\d+ sr/);
  await follow(page, "#model=ptfe&wavelength=600");
  assert.equal(await trouble(page), "");
  assert.deepEqual(complaints, []);
});

const no_limits = Array(32).fill(1).join(",");
for (const [asked, line, shown] of [
  ["wavelength=1e300", /^wavelength = 1e\+300 of the link must be 1 to 1000000000 nm: 532 is shown\.$/, { wavelength: "532" }],
  ["wavelength=-3", /^wavelength = -3 of the link must be/, { wavelength: "532" }],
  ["thetaI=95&thetaR=-100", /^thetaI = 95 .*: 45 is shown\. thetaR = -100 .*: 30 is shown\.$/, { thetaI: "45", thetaR: "30" }],
  ["thetaI=-20&phiI=1000", /^$/, { thetaI: "20", phiI: "100" }],
  ["phiR=1e300", /^phiR = 1e\+300 .*: 180 is shown\.$/, { phiR: "180" }],
  [`limits=${no_limits}`, /^limits of the link must be 16 pairs/, {}],
  ["limits=1,2", /^limits of the link must be 16 pairs/, {}],
  ["wavelength=6OO", /^wavelength = 6OO of the link must be a number: 532 is shown\.$/, { wavelength: "532" }],
  ["wavelength=300", /^$/, { wavelength: "300" }], // beyond the fitted range, as asked for
  ["frame=s&wave=600&digits=1", /^wave of the link means nothing here\. digits = 1 .* true or false: false .*\. frame = s .* one of xy, sp, scattering_plane: xy is shown\.$/, {}],
])
  test(`a link with ${asked.slice(0, 40)} shows a page that lives`, { skip }, async () => {
    const { page, complaints } = await opened(chromium, { hash: `#${asked}` });
    const look = async () => {
      await settled(page);
      assert.match(await trouble(page), line);
      for (const [id, value] of Object.entries(shown)) assert.equal(await page.inputValue(`#${id}`), value);
      assert.equal(await page.isChecked("#locked"), false);
      assert.match(await page.textContent("#words"), /f11 = .* standard uncertainty /);
    };
    await look();
    await follow(page, "#thetaI=20");
    await follow(page, `#${asked}`);
    await look();
    assert.deepEqual(complaints, []);
  });

test("a link without a wavelength shows one that the model was fitted to", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-633" });
  await settled(page);
  assert.equal(await page.inputValue("#wavelength"), "633");
});

test("the address bar is changed a few times a second, and has the link of what is shown in the end", { skip }, async () => {
  const { page } = await opened(chromium);
  await settled(page);
  const changes = await page.evaluate(async () => {
    let count = 0;
    const replace = history.replaceState.bind(history);
    history.replaceState = (...to) => ((count += 1), replace(...to));
    const field = document.getElementById("phiI");
    for (let i = 1; i <= 40; ++i) {
      field.value = String(i);
      field.dispatchEvent(new Event("input", { bubbles: true }));
      await new Promise(requestAnimationFrame);
      await new Promise((done) => setTimeout(done, 10));
    }
    return { count, seconds: performance.now() / 1000 };
  });
  assert.ok(changes.count <= 3 * changes.seconds + 1, `${changes.count} in less than ${changes.seconds} s`);
  await settled(page);
  assert.match(page.url(), /[#&]phiI=40(&|$)/);
});

test("an answer that comes between a change and its picture is not taken for one of what is chosen", { skip }, async () => {
  const { page, complaints } = await opened(chromium);
  await settled(page);
  await page.evaluate(async () => {
    const change = (id, value) => {
      const field = document.getElementById(id);
      field.value = value;
      for (const type of ["input", "change"]) field.dispatchEvent(new Event(type, { bubbles: true }));
    };
    change("thetaI", "50");
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const draw = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (work) => setTimeout(() => draw(work), 3000); // the answer to 50 degrees comes first
    change("curve", "dhr");
    window.requestAnimationFrame = draw;
    await new Promise((done) => setTimeout(done, 3100));
  });
  await settled(page);
  assert.match(await page.getAttribute("#chart svg", "aria-label"), /^directional-hemispherical reflectance against/);
  assert.deepEqual(complaints, []);
});

for (const [can, words] of [[true, /^The link is copied\.$/], [false, /^The link is in the address bar: /]])
  test(`a link that ${can ? "is" : "cannot be"} copied is said to be so, until it is another`, { skip }, async () => {
    const { page, complaints } = await opened(chromium, { hash: "#thetaI=20" });
    await settled(page);
    await page.evaluate((copies) => {
      const clipboard = copies ? { writeText: async (text) => void (window.copied = text) } : undefined;
      Object.defineProperty(navigator, "clipboard", { value: clipboard });
    }, can);
    await page.click("#link");
    await page.waitForFunction(() => document.getElementById("link-state").textContent);
    assert.match(await page.textContent("#link-state"), words);
    if (can) assert.equal(await page.evaluate(() => window.copied), page.url());
    await page.fill("#thetaI", "21");
    await settled(page);
    assert.equal(await page.textContent("#link-state"), "");
    assert.deepEqual(complaints, []);
  });

test("of files that are opened together each is taken, and one that is wrong has its line", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium);
  await settled(page);
  const samples = Buffer.from(run("simulate", "ptfe-633", "--grid", "random:20"));
  const files = [file_of("ptfe-633", "one.json"), { name: "none.json", mimeType: "", buffer: Buffer.from("{") }, { name: "samples.csv", mimeType: "text/csv", buffer: samples }];
  await page.setInputFiles("#file", files);
  await page.waitForSelector("#samples-csv:visible");
  await settled(page);
  assert.equal(await page.inputValue("#model"), "one.json");
  assert.match(await trouble(page), /^none\.json:1: not JSON[^.]*$/);
  assert.match(await page.textContent("#samples-words"), /^samples\.csv: 20 samples/);
  assert.equal(await page.textContent("#reading"), "");
  await page.evaluate(() => {
    Blob.prototype.arrayBuffer = () => Promise.reject(new DOMException("a folder")); // as Chromium has it
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([], "folder"));
    document.body.dispatchEvent(new DragEvent("drop", { bubbles: true, dataTransfer }));
  });
  await page.waitForFunction(() => document.getElementById("trouble").textContent === "folder: cannot be read: is it a file, and still there?");
  assert.deepEqual(complaints, []);
});

test("while uncertainties are computed, older numbers are marked, and no file is made of them", { skip }, async () => {
  const { page } = await opened(chromium);
  await settled(page);
  const saved = [];
  page.on("download", (one) => saved.push(one.suggestedFilename()));
  const marks = () =>
    page.evaluate(() => [
      ...["quantities", "parts", "chart"].map((id) => document.getElementById(id).getAttribute("aria-busy")),
      ...["csv", "svg"].map((id) => document.getElementById(id).getAttribute("aria-disabled")),
    ]);
  assert.deepEqual(await marks(), Array(5).fill("false"));
  const during = await page.evaluate(async () => {
    const model = document.getElementById("model");
    model.value = "ptfe-633"; // another model: its first uncertainty takes longest
    model.dispatchEvent(new Event("change"));
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    for (const id of ["csv", "svg"]) document.getElementById(id).click();
    return [
      ...["quantities", "parts", "chart"].map((id) => document.getElementById(id).getAttribute("aria-busy")),
      ...["csv", "svg"].map((id) => document.getElementById(id).getAttribute("aria-disabled")),
      document.getElementById("take-state").textContent,
    ];
  });
  assert.deepEqual(during, [...Array(5).fill("true"), "The curve is not there yet: its uncertainties are being computed."]);
  await settled(page);
  assert.deepEqual(await marks(), Array(5).fill("false"));
  assert.equal(await page.textContent("#take-state"), "");
  const waiting = page.waitForEvent("download");
  await page.click("#svg");
  assert.match(readFileSync(await (await waiting).path(), "utf8"), /^<svg /);
  assert.deepEqual(saved, ["ptfe-633-633nm-polarized.svg"]);
});

test("a field that is not filled in rightly says what it takes, and the answer that it is of the former value", { skip }, async () => {
  const { page, complaints } = await opened(chromium);
  await settled(page);
  const expected = await matrix(page);
  const typed = async (id, text) => {
    await page.focus(`#${id}`);
    await page.keyboard.press("Control+A");
    await page.keyboard.type(text);
    await settled(page);
  };
  for (const [id, text, words] of [
    ["thetaI", "95", "0 to 90 degrees. Shown is 9."], // 9 is on the way to 95
    ["thetaR", "-1", "0 to 90 degrees. Shown is 30."],
    ["phiR", "e", "A number of degrees. Shown is 180."],
    ["wavelength", "0", "1 to 1000000000 nm. Shown is 532."],
  ]) {
    await typed(id, text);
    assert.equal(await page.textContent(`#${id}-wrong`), words);
    assert.equal(await page.getAttribute(`#${id}`, "aria-invalid"), "true");
    assert.equal(await page.getAttribute(`#${id}`, "aria-describedby"), `${id}-wrong`);
    assert.match(await page.textContent("#former"), /its former value/);
  }
  for (const [id, text] of [["thetaI", "45"], ["thetaR", "30"], ["phiR", "180"], ["wavelength", "532"]]) await typed(id, text);
  assert.equal(await page.textContent("#former"), "");
  assert.equal(await page.textContent("#thetaI-wrong"), "");
  assert.equal(await matrix(page), expected);
  assert.deepEqual(complaints, []);
});

test("elements that are 0 but for rounding are shown as 0 before their uncertainties are there", { skip }, async () => {
  for (const normalized of [false, true]) {
    const { page } = await opened(chromium, { hash: `#normalized=${normalized}` });
    const shown = await page.evaluate(async () => {
      document.getElementById("frame").dispatchEvent(new Event("change"));
      await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
      return Array.from(document.querySelectorAll("#matrix td"), (cell) => cell.textContent);
    });
    assert.match(shown[0], /^f110\.\d+ ± …$/); // its uncertainty is not there
    for (const e of [2, 3, 6, 7, 8, 9, 12, 13]) assert.match(shown[e], /^[fm]\d\d0 ± …$/); // in the plane of incidence
  }
});

test("a drag beyond the disc where it began ends at 90 degrees, on the side of the pointer", { skip }, async () => {
  const { page } = await opened(chromium);
  await settled(page);
  const box = await page.locator("#hemispheres").boundingBox();
  const size = box.width / 4;
  const inSecond = (x, y) => [box.x + size + (size / 2) * (1 + x), box.y + (size / 2) * (1 - y)];
  await page.mouse.move(...inSecond(Math.SQRT1_2, 0));
  await page.mouse.down();
  for (const [x, phi] of [[1.5, "0"], [3, "0"], [-1.5, "180"], [-4, "180"]]) {
    await page.mouse.move(...inSecond(x, 0), { steps: 4 });
    await settled(page);
    assert.equal(await page.inputValue("#thetaI"), "90", `x = ${x}`);
    assert.equal(await page.inputValue("#phiI"), phi, `x = ${x}`);
  }
  await page.mouse.up();
});

test("a second finger moves nothing", { skip }, async () => {
  const { page } = await opened(chromium);
  await settled(page);
  const moved = await page.evaluate(async () => {
    const box = document.querySelector("#hemispheres");
    const { left, top, width } = box.getBoundingClientRect();
    const at = (type, x, more) =>
      box.dispatchEvent(new PointerEvent(type, { bubbles: true, clientX: left + (width / 8) * (1 + x), clientY: top + width / 8, ...more }));
    box.setPointerCapture = () => {}; // there is no pointer of that number
    const [first, second] = [{ pointerId: 1, isPrimary: true }, { pointerId: 2, isPrimary: false }];
    at("pointerdown", 0.5, first);
    at("pointerdown", -0.5, second);
    at("pointermove", -0.2, second);
    at("pointerup", -0.2, second);
    at("pointermove", Math.sin(Math.PI / 9), first);
    at("pointerup", Math.sin(Math.PI / 9), first);
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    return ["thetaR", "phiR"].map((id) => document.getElementById(id).value);
  });
  assert.deepEqual(moved, ["20", "0"]);
});

test("a link keeps the digits that were typed", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#thetaI=45.12345&phiI=-179.98765" });
  await settled(page);
  const fields = () => Promise.all(["thetaI", "phiI"].map((id) => page.inputValue(`#${id}`)));
  assert.deepEqual(await fields(), ["45.12345", "-179.98765"]);
  await page.focus("#hemispheres");
  await page.keyboard.press("ArrowUp");
  await settled(page);
  assert.deepEqual(await fields(), ["46.12345", "-179.98765"]);
});

test("a file that has the name of a built-in model is another entry of the list", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium);
  await page.setInputFiles("#file", file_of("ptfe-633", "ptfe"));
  await page.waitForFunction(() => document.querySelector("#model").value === "ptfe (file)");
  await settled(page);
  assert.equal(await page.inputValue("#wavelength"), "633");
  assert.match(await page.textContent("#program"), /^mmbrdf evaluate \.\/ptfe -w 633/);
  await page.selectOption("#model", "ptfe");
  await settled(page);
  assert.match(await page.textContent("#program"), /^mmbrdf evaluate ptfe -w 633/);
  assert.equal(await trouble(page), "");
  assert.deepEqual(complaints, []);
});

test("the CSV of reflectances says of what it is, and its command has the same angles", { skip: skip || without_program }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-633&wavelength=633&curve=dhr" });
  await settled(page);
  const waiting = page.waitForEvent("download");
  await page.click("#csv");
  const [head, ...rows] = readFileSync(await (await waiting).path(), "utf8").trim().split("\n");
  assert.equal(head, "model,wavelength_nm,theta_i_deg,dhr,u_dhr");
  const command = (await page.textContent("#program")).split("\n").find((line) => line.startsWith("mmbrdf integrate"));
  const [names, ...theirs] = run(...command.split(" ").slice(1)).trim().split("\n").map((line) => line.split(","));
  assert.equal(rows.length, 86);
  assert.equal(theirs.length, 86);
  rows.forEach((row, i) => {
    const [model, wavelength, theta, dhr] = row.split(",");
    assert.deepEqual([model, wavelength, theta], ["ptfe-633", "633", String(i)]);
    assert.ok(Math.abs(Number(dhr) - Number(theirs[i][names.indexOf("dhr")])) < 1e-9, row); // as many digits as are printed
  });
});
