// SPDX-License-Identifier: BSD-3-Clause
// What npm packs is whole: it is installed in an empty folder, and used there as people use it.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { folder } from "./program.mjs";

const here = new URL("..", import.meta.url).pathname;
const npm = (...args) => execFileSync("npm", args, { encoding: "utf8", cwd: folder, stdio: ["ignore", "pipe", "ignore"] });

test("the packed package is installed without a network, and the first lines of its README run", () => {
  const [{ filename, files }] = JSON.parse(npm("pack", here, "--json"));
  const names = files.map(({ path }) => path).sort();
  assert.deepEqual(names, [
    "LICENSE", "README.md", "calls.js", "dist/mmbrdf_module.mjs", "dist/mmbrdf_module.wasm", "index.d.ts", "index.js", "package.json",
    "samples.js",
  ]);
  const project = join(folder, "project");
  mkdirSync(project);
  writeFileSync(join(project, "package.json"), '{"type": "module"}');
  npm("install", "--offline", "--no-audit", "--prefix", project, join(folder, filename));
  const example = /```js\n(import load[\s\S]*?)```/.exec(readFileSync(join(here, "README.md"), "utf8"))[1];
  writeFileSync(join(project, "example.js"), example);
  const printed = execFileSync(process.execPath, ["example.js"], { encoding: "utf8", cwd: project });
  const promised = [...example.matchAll(/console\.log\(.*\/\/ (.*)/g)].map(([, words]) => words.trim());
  assert.deepEqual(printed.trim().split("\n"), promised);
});

test("the version is the project's", () => {
  const { version } = JSON.parse(readFileSync(join(here, "package.json")));
  const cmake = readFileSync(join(here, "../../CMakeLists.txt"), "utf8");
  assert.equal(version, /project\(mmbrdf VERSION ([\d.]+)/.exec(cmake)[1]);
});
