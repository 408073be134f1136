// SPDX-License-Identifier: BSD-3-Clause
// What is taken along: files, and the lines that give the same numbers elsewhere.
import type { Mmbrdf, ModelAt } from "mmbrdf";

import { dhrAngles, inPlane } from "./scan";
import type { State } from "./state";
import type { Band } from "./worker";

export function save(name: string, contents: Blob | string, type = "text/plain") {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(contents instanceof Blob ? contents : new Blob([contents], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** A name for a shell, in quotes if it needs them. */
const shell = (text: string) => (/^[\w./-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`);

export function programLines(state: State, curve: string, ownFile: boolean): string {
  const light = `-w ${state.wavelength} -i ${state.thetaI},${state.phiI}`;
  const model = shell(ownFile && !/[./]/.test(state.model) ? `./${state.model}` : state.model); // not the built-in one
  const where = `${model} ${light}`;
  const frame = state.frame === "xy" ? "" : ` --frame ${state.frame}`;
  const lines = [
    `mmbrdf evaluate ${where} -r ${state.thetaR},${state.phiR}${frame}${state.normalized ? " --normalized" : ""}`,
    `mmbrdf analyze ${where} -r ${state.thetaR},${state.phiR}${frame}`,
    curve === "dhr"
      ? `mmbrdf integrate ${model} -q dhr -w ${state.wavelength} --theta ${dhrAngles.join(",")} --format csv`
      : `mmbrdf analyze ${where} --scan theta_r=-85:85:1${frame} -o curve.csv`,
  ];
  if (state.convention !== "germer2017")
    lines.push(`# The program's signs are those of germer2017; Python converts to ${state.convention}.`);
  return lines.join("\n");
}

export function pythonLines(state: State, ownFile: boolean): string {
  const angles = `theta_i_deg=${state.thetaI}, phi_i_deg=${state.phiI}, theta_r_deg=${state.thetaR}, phi_r_deg=${state.phiR}`;
  const lines = [
    "import mmbrdf",
    "",
    `model = mmbrdf.${ownFile ? "load_model" : "material"}(${JSON.stringify(state.model)})`,
    `f = model.evaluate(${state.wavelength}, ${angles}, frame="${state.frame}")`,
    `u = model.evaluate_uncertainty(${state.wavelength}, ${angles}, frame="${state.frame}")`,
    `all = model.analyze(${state.wavelength}, ${angles})`,
  ];
  if (state.convention !== "germer2017") lines.push(`f = mmbrdf.convert(f, "germer2017", "${state.convention}")`);
  return lines.join("\n");
}

/** The curve that is shown, or all quantities over its directions. */
export function csv(state: State, curves: Record<string, Band>, mmbrdf: Mmbrdf, at: ModelAt): string {
  if (state.curve === "dhr") {
    const model = /[",\n]/.test(state.model) ? `"${state.model.replaceAll('"', '""')}"` : state.model;
    const rows = dhrAngles.map((theta, i) => [model, state.wavelength, theta, curves.dhr.values[i], curves.dhr.uncertainties[i]].join(","));
    return ["model,wavelength_nm,theta_i_deg,dhr,u_dhr", ...rows, ""].join("\n").replaceAll(/(?<=,)NaN(?=,|$)/gm, "");
  }
  const names = ["f11", ...mmbrdf.quantities.map(({ name }) => name)];
  const where = inPlane(state);
  const validity = at.outside(where);
  const head = ["wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg", ...names.flatMap((name) => [name, `u_${name}`]), "validity"];
  const rows = where.map((one, i) =>
    [state.wavelength, one.thetaI, one.phiI, one.thetaR, one.phiR, ...names.flatMap((name) => [curves[name].values[i], curves[name].uncertainties[i]]), validity[i].validity].join(","),
  );
  return [head.join(","), ...rows, ""].join("\n").replaceAll("NaN", "");
}
