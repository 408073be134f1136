// SPDX-License-Identifier: BSD-3-Clause
// What a matrix takes here, beside the baseline kernel of the processor: node measure.mjs [mmbrdf-bench], after ./dev test web
// and ./dev bench. Both in turns, time of the processor in single precision at one incidence of ptfe at 532 nm; nothing is
// promised by a test. The kernel's time is its own; the module's is that of a hemisphere, with all that is around the kernel.
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";

import load from "./index.js";

const bench = process.argv[2] ?? fileURLToPath(new URL("../../build/release/mmbrdf-bench", import.meta.url));
const kernel = "evaluate_prepared_incidence/baseline/float";
const hemispheres = 300; // of a turn

function native() {
  const options = [`--benchmark_filter=${kernel}$`, "--benchmark_min_time=0.3", "--benchmark_format=json"];
  const [{ ns_per_evaluation }] = JSON.parse(execFileSync(bench, options, { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] })).benchmarks;
  return ns_per_evaluation;
}

const mmbrdf = await load();
const at = mmbrdf.material("ptfe").at(532);
const hemisphere = mmbrdf.hemisphere(192);

function module() {
  const begun = process.cpuUsage();
  for (let i = 0; i < hemispheres; ++i) hemisphere.evaluate(at, 45, i / 2);
  const { user, system } = process.cpuUsage(begun);
  return (1000 * (user + system)) / (hemispheres * hemisphere.count);
}

for (let i = 0; i < 3; ++i) module(); // compiled for speed after that
const turns = [...Array(7)].map(() => [native(), module()]);
const median = (list) => list.sort((a, b) => a - b)[Math.floor(list.length / 2)];
const row = (name, list, unit) => console.log(`${name} ${median(list).toFixed(2)}${unit} (${list[0].toFixed(2)} to ${list.at(-1).toFixed(2)})`);
row("native, baseline kernel ", turns.map(([ns]) => ns), " ns a matrix");
row("the module, a hemisphere", turns.map(([, ns]) => ns), " ns a matrix");
row("ratio                   ", turns.map(([theirs, ours]) => ours / theirs), "");
