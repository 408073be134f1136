// SPDX-License-Identifier: BSD-3-Clause
// Curves, parts of uncertainties, scales and what is taken along.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";

import { analyzed, folder, run, without_program } from "../../mmbrdf/test/program.mjs";
import { answered, browser, opened, skip } from "./browser.mjs";

let chromium;
before(async () => {
  if (!skip) chromium = await browser();
});
after(async () => chromium?.close());

const near = (value, expected, size, what) => assert.ok(Math.abs(value - expected) <= size, `${what}: ${value}, not ${expected}`);

async function settled(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await answered(page);
}

const records = (text) => {
  const [head, ...rows] = text.trim().split("\n").map((line) => line.split(","));
  return rows.map((row) => Object.fromEntries(row.map((field, c) => [head[c], field])));
};

async function csv(page) {
  const waiting = page.waitForEvent("download");
  await page.click("#csv");
  return readFileSync(await (await waiting).path(), "utf8");
}

/** What the command of the page that begins so prints, as CSV. */
async function of_command(page, begins) {
  const command = (await page.textContent("#program")).split("\n").find((line) => line.startsWith(begins));
  const words = command.replace(/ -o curve\.csv$/, "").split(" ").slice(1);
  return records(run(...words, ...(words.includes("--format") ? [] : ["--format", "csv"])));
}

for (const scan of ["plane", "azimuth"])
  test(`a curve along the ${scan} has the numbers of its command, also after the light has moved`, { skip: skip || without_program }, async () => {
    const { page, complaints } = await opened(chromium, { hash: `#model=ptfe-532&scan=${scan}&phiI=20&thetaR=40&curve=entropy` });
    await settled(page);
    for (const theta of ["45", "60"]) {
      await page.fill("#thetaI", theta);
      await settled(page);
      const ours = records(await csv(page));
      const theirs = await of_command(page, "mmbrdf analyze ptfe-532 -w 532 -i " + theta + (scan === "plane" ? ",20 --scan theta_r" : ",20 -r 40,0 --scan phi_r"));
      assert.equal(ours.length, scan === "plane" ? 171 : 121);
      assert.equal(theirs.length, ours.length);
      ours.forEach((row, i) => {
        assert.equal(row.theta_i_deg, theta);
        for (const name of ["f11", "u_f11", "f_ss", "u_f_sp", "entropy", "u_entropy"]) near(Number(row[name]), Number(theirs[i][name]), 1e-9, `${name} in row ${i}`);
        assert.equal(row.validity, theirs[i].validity);
      });
    }
    assert.deepEqual(complaints, []);
  });

test("the CSV of the plane of incidence has signed polar angles, that of an azimuth the turn from the light", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532&phiI=20" });
  await settled(page);
  const plane = records(await csv(page));
  plane.forEach((row, i) => {
    assert.equal(row.theta_r_signed_deg, String(i - 85));
    assert.equal(Number(row.theta_r_deg), Math.abs(i - 85));
    assert.equal(row.phi_r_deg, i < 85 ? "20" : "200"); // negative on the side of the light
  });
  await page.selectOption("#scan", "azimuth");
  await settled(page);
  records(await csv(page)).forEach((row, i) => {
    assert.equal(row.phi_r_from_light_deg, String(3 * i - 180));
    assert.equal(Number(row.phi_r_deg), 20 + 3 * i - 180);
    assert.equal(row.theta_r_deg, "30");
  });
});

test("reflectance against wavelength has the numbers of its command, with their uncertainties", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#curve=dhr_wavelength&thetaI=8" });
  await settled(page);
  const ours = records(await csv(page));
  const theirs = await of_command(page, "mmbrdf integrate ptfe -q dhr -w 351,");
  assert.equal(ours.length, 25);
  ours.forEach((row, i) => {
    near(Number(row.wavelength_nm), Number(theirs[i].wavelength_nm), 1e-9, "wavelength");
    assert.equal(row.theta_i_deg, "8");
    near(Number(row.dhr), Number(theirs[i].dhr), 1e-9, "dhr"); // as many digits as are printed
    near(Number(row.u_dhr), Number(theirs[i].u_dhr), 1e-9, "u of it");
  });
  assert.equal(await page.isVisible("#scan"), false);
  assert.deepEqual(complaints, []);
});

test("coefficients against wavelength are those of the file of the model", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium, { hash: "#curve=coefficients&block=44" });
  await settled(page);
  const file = `${folder}/ptfe.json`;
  run("convert", "ptfe", file);
  const { blocks } = JSON.parse(readFileSync(file, "utf8"));
  const { modes, coefficients } = blocks.find(({ elements }) => elements === "44");
  for (const row of records(await csv(page))) {
    const micrometres = Number(row.wavelength_nm) / 1000;
    modes.forEach(([name, ...indices], i) => {
      const expected = coefficients[i] + micrometres * coefficients[modes.length + i];
      near(Number(row[`44: ${name} (${indices.join(" ")})`]), expected, 1e-14, `${indices} at ${row.wavelength_nm} nm`);
    });
  }
  assert.equal(await page.locator("#chart path.curve").count(), 4);
  assert.equal(await page.inputValue("#block"), "44");
  await page.selectOption("#block", "11");
  await settled(page);
  assert.match(await page.textContent("#chart"), /coefficient, sr⁻¹/);
  assert.deepEqual(complaints, []);
});

test("parts of an uncertainty add up in squares, of f11 and of the quantity of the curve, and say what they are", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#curve=f_ss&digits=true" });
  await page.selectOption("#curve", "entropy");
  await settled(page);
  const rows = await page.$$eval("#parts tbody tr", (all) => all.map((row) => Array.from(row.cells, (cell) => cell.textContent)));
  assert.deepEqual(rows.map(([name]) => name), ["posterior", "declared scale", "declared source arm", "declared receiver arm", "projection"]);
  for (const [name, , , words] of rows) assert.ok(words.length > 20, name);
  const total = async (selector) => Number(await page.textContent(selector));
  const u = [await total("#matrix td[data-element=f11] .u"), await total("#quantities tr[data-quantity=entropy] td:nth-child(3)")];
  u.forEach((expected, i) => {
    const sum = Math.hypot(...rows.map((row) => (row[1 + i] === "0" ? 0 : Number(row[1 + i]))));
    near(sum / expected, 1, 0.03, "of the sum of squares"); // parts are shown with two digits
  });
  assert.match(await page.textContent("#parts thead"), /u\(f11\), sr⁻¹u\(entropy\)/);
});

test("the scales of the paper are those of the paper, locked and in the link", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532" });
  await settled(page);
  await page.click("#paper");
  await settled(page);
  const look = async (one) => {
    assert.match(await one.textContent("#legend-f11"), /^f11: 0\.250\.45 sr-1, as in the paper$/);
    assert.equal(await one.textContent("#tiles div:nth-child(6) .limit"), "± 0.1");
    assert.ok((await one.isChecked("#normalized")) && (await one.isChecked("#locked")));
  };
  await look(page);
  await page.fill("#thetaI", "70");
  await settled(page);
  await look(page);
  const { page: again } = await opened(chromium, { hash: page.url().slice(page.url().indexOf("#")) });
  await settled(again);
  await look(again);
  await again.uncheck("#normalized"); // they are of elements that are divided by f11
  await settled(again);
  assert.doesNotMatch(await again.textContent("#legend-f11"), /paper|locked/);
});

test("the SVG says of what it is", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532&thetaI=20&curve=f11" });
  await settled(page);
  const words = async () => {
    const waiting = page.waitForEvent("download");
    await page.click("#svg");
    const svg = readFileSync(await (await waiting).path(), "utf8");
    const [, height] = /viewBox="0 0 \d+ (\d+)"/.exec(svg);
    for (const [, y] of svg.matchAll(/<text x="\S+" y="([\d.]+)"/g)) assert.ok(Number(y) < height, `${y} of ${height}`);
    return svg.replaceAll(/<text[^>]*>/g, " ");
  };
  const all = await words();
  assert.match(all, /ptfe-532 at 532 nm, light from θi = 20°, φi = 0°\. Bands hold 95 % \(1\.96 u\)\./);
  await page.selectOption("#curve", "dhr_wavelength");
  await settled(page);
  assert.match(await words(), /ptfe-532, light from θi = 20°\. Bands/);
});

test("what of a model is not known is said to be so: f11 alone was measured, or there are no uncertainties", { skip: skip || without_program }, async () => {
  const { page, complaints } = await opened(chromium);
  const [data, model, published] = ["f11.csv", "f11.json", "published.csv"].map((name) => `${folder}/${name}`);
  const rows = run("simulate", "ptfe-532", "--noise", "speckle:0.01").split("\n").map((line) => line.split(",").slice(0, 6).join(","));
  writeFileSync(data, rows.join("\n"));
  run("fit", data, "-o", model);
  await page.setInputFiles("#file", model);
  await page.waitForFunction(() => document.querySelector("#model").value === "f11.json");
  await settled(page);
  assert.match(await page.textContent("#chart-words"), /It is not known: elements that it takes were not measured\./);
  assert.equal(await page.textContent("#quantities tr[data-quantity=entropy] td"), "not known");
  assert.equal(await page.textContent("#tiles div:nth-child(2) .limit"), "not known");
  assert.ok(await page.isVisible("#legend-unknown"));

  run("convert", "ptfe-532", published);
  await page.setInputFiles("#file", published);
  await page.waitForFunction(() => document.querySelector("#model").value === "published.csv");
  await settled(page);
  assert.equal(await page.inputValue("#wavelength"), "532"); // it stays: the file says none
  assert.match(await page.textContent("#chart-words"), /There are no bands: uncertainties are not known\./);
  assert.equal(await page.isVisible("#legend-unknown"), false);
  assert.doesNotMatch(await page.textContent("#python"), /uncertainty/); // which Python would refuse
  assert.doesNotMatch(await page.textContent("#program"), /--uncertainty/);
  assert.deepEqual(complaints, []);
});

test("the PNG says what it shows: lines above, and in each tile its name, its limits and both directions", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532" });
  await settled(page);
  const waiting = page.waitForEvent("download");
  await page.click("#png");
  const bytes = readFileSync(await (await waiting).path()).toString("base64");
  const seen = await page.evaluate(async (data) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
    const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    /** Pixels of a box that are as `is` says. */
    const count = (x, y, width, height, is) => {
      const { data: rgb } = context.getImageData(x, y, width, height);
      let found = 0;
      for (let i = 0; i < rgb.length; i += 4) found += is(rgb[i], rgb[i + 1], rgb[i + 2]) ? 1 : 0;
      return found;
    };
    const dark = (r, g, b) => r + g + b < 250;
    const top = image.height - 768 - 12;
    const tiles = [...Array(16).keys()].map((e) => {
      const [x, y] = [12 + 192 * (e % 4), top + 192 * (e >> 2)];
      const sun = count(x, y, 192, 192, (r, g, b) => r === 255 && g === 212 && b === 0);
      return { name: count(x, y, 34, 20, dark), limit: count(x + 120, y + 174, 72, 18, dark), sun };
    });
    return { width: image.width, words: count(0, 0, image.width, top, dark), tiles };
  }, bytes);
  assert.equal(seen.width, 768 + 24);
  assert.ok(seen.words > 1000, `${seen.words} dark pixels above`);
  for (const [e, { name, limit, sun }] of seen.tiles.entries()) assert.ok(name > 30 && limit > 30 && sun > 20, `tile ${e}: ${name}, ${limit}, ${sun}`);
});

test("in a window as wide as a phone no number is broken in two", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532&curve=depolarization_ratio", viewport: { width: 360, height: 780 } });
  await settled(page);
  const broken = await page.$$eval("#quantities td:not(:last-child), #parts tbody td:not(:last-child)", (cells) => cells.flatMap((cell) => {
    const words = document.createRange();
    words.selectNodeContents(cell);
    return words.getClientRects().length === 1 ? [] : [cell.textContent];
  }));
  assert.deepEqual(broken, []);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 360);
});

test("the words of a chart can be read on a phone, and are all inside it, also when it is turned", { skip }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532", viewport: { width: 360, height: 780 } });
  await settled(page);
  const look = async (least) => {
    const { small, outside } = await page.$eval("#chart svg", (svg, size) => {
      const [all, box] = [Array.from(svg.querySelectorAll("text")), svg.getBoundingClientRect()];
      const scale = box.width / svg.viewBox.baseVal.width;
      const boxes = all.map((one) => [one.textContent, one.getBoundingClientRect()]);
      return {
        small: all.filter((one) => Number(one.getAttribute("font-size")) * scale < size).map((one) => one.textContent),
        outside: boxes.filter(([, b]) => b.left < box.left - 1 || b.right > box.right + 1 || b.bottom > box.bottom + 1).map(([text]) => text),
      };
    }, least);
    assert.deepEqual([small, outside], [[], []]);
  };
  for (const [curve, scan] of [["polarized", "plane"], ["polarized", "azimuth"], ["dhr_wavelength"], ["coefficients"]]) {
    await page.selectOption("#curve", curve);
    if (scan) await page.selectOption("#scan", scan);
    await settled(page);
    await look(10); // px
  }
  await page.setViewportSize({ width: 780, height: 360 });
  await page.waitForFunction(() => document.querySelector("#chart svg").viewBox.baseVal.width === 640);
  await look(13);
});

test("a window as wide as a phone has nothing to scroll to the side, whatever is shown", { skip: skip || without_program }, async () => {
  const { page } = await opened(chromium, { hash: "#model=ptfe-532&compare=ptfe-633&digits=true&curve=coefficients", viewport: { width: 360, height: 780 } });
  const name = "samples_of_a_long_name_that_has_no_place_to_break_in_it_anywhere.csv";
  await page.setInputFiles("#file", { name, mimeType: "text/csv", buffer: Buffer.from(run("simulate", "ptfe-532", "--grid", "random:20")) });
  await page.waitForSelector("#samples-csv:visible");
  for (const curve of ["coefficients", "polarized", "dhr"]) {
    await page.selectOption("#curve", curve);
    await settled(page);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 360, curve);
  }
  const narrow = await page.$$eval("select, input, button", (all) => all.filter((one) => one.checkVisibility()).flatMap((one) => {
    const { left, right } = one.getBoundingClientRect();
    return left < 0 || right > 360 ? [one.id] : [];
  }));
  assert.deepEqual(narrow, []);
});
