// SPDX-License-Identifier: BSD-3-Clause
// The program mmbrdf, whose numbers those of the module are compared with. MMBRDF_PROGRAM says where it is.
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const program = process.env.MMBRDF_PROGRAM ?? new URL("../../../build/release/mmbrdf", import.meta.url).pathname;
export const has_program = existsSync(program);
export const without_program = has_program ? false : `no program at ${program} (MMBRDF_PROGRAM)`;

export const folder = mkdtempSync(join(tmpdir(), "mmbrdf-web-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

/** What it prints. */
export function run(...args) {
  return execFileSync(program, args, { encoding: "utf8", maxBuffer: 1 << 28, stdio: ["ignore", "pipe", "ignore"] });
}

/** The line in which it refuses, without the name of the program. */
export function refusal(...args) {
  const { status, stderr } = spawnSync(program, args, { encoding: "utf8", cwd: folder });
  return status === 0 ? null : stderr.replace(/^mmbrdf: /, "").trimEnd();
}

/** Rows of `analyze` at these geometries, four angles each: by column. */
export function analyzed(model, wavelength, geometries, frame) {
  const file = join(folder, "geometries.csv");
  const rows = geometries.map((one) => [wavelength, ...one].join(","));
  writeFileSync(file, ["wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg", ...rows, ""].join("\n"));
  const [header, ...lines] = run("analyze", model, "-g", file, "--frame", frame, "--format", "csv").trim().split("\n");
  return lines.map((line) => {
    const fields = line.split(",");
    return Object.fromEntries(header.split(",").map((name, c) => [name, fields[c]]));
  });
}

/** The same 200 geometries each time: singular ones, then anywhere, up to beyond the fitted range. */
export function geometries(count = 200) {
  const result = [[0, 0, 0, 0], [45, 0, 45, 0], [45, 0, 45, 180], [0, 30, 60, 70], [-45, 10, 30, 20], [90, 0, 89, 180]];
  let state = 12345;
  const random = () => (state = (1103515245 * state + 12345) % 2147483648) / 2147483648;
  while (result.length < count) result.push([85 * random(), 360 * random(), 85 * random(), 360 * random() - 180]);
  return result;
}
