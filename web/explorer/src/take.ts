// SPDX-License-Identifier: BSD-3-Clause
// What is taken along: files, and the lines that give the same numbers elsewhere.
import type { Drawing } from "./curves";
import { short } from "./numbers";
import type { Along } from "./scan";
import type { State } from "./state";
import type { Bands } from "./worker";

export function save(name: string, contents: Blob | string, type = "text/plain") {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(contents instanceof Blob ? contents : new Blob([contents], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** A name for a shell, in quotes if it needs them. */
const shell = (text: string) => (/^[\w./-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`);

/** What a command calls it: a file without a folder or an ending is not the built-in model of that name. */
const fileName = (name: string, ownFile: boolean) => shell(ownFile && !/[./]/.test(name) ? `./${name}` : name);

export interface Named {
  name: string;
  ownFile: boolean;
}

/** What is shown, by its names in lines for elsewhere. */
export interface Told {
  state: State;
  along: Along;
  ownFile: boolean;
  hasUncertainty: boolean;
}

/** `others`: a model or samples beside it. */
export function programLines({ state, along: { kind, x }, ownFile, hasUncertainty }: Told, others: Named[]): string {
  const light = `-w ${state.wavelength} -i ${state.thetaI},${state.phiI}`;
  const model = fileName(state.model, ownFile);
  const where = `${model} ${light}`;
  const frame = state.frame === "xy" ? "" : ` --frame ${state.frame}`;
  const curve = {
    plane: `mmbrdf analyze ${where} --scan theta_r=-85:85:1${frame} -o curve.csv`,
    azimuth: `mmbrdf analyze ${where} -r ${state.thetaR},0 --scan phi_r=${state.phiI - 180}:${state.phiI + 180}:3${frame} -o curve.csv`,
    dhr: `mmbrdf integrate ${model} -q dhr -w ${state.wavelength} --theta ${x.join(",")} --format csv`,
    dhr_wavelength: `mmbrdf integrate ${model} -q dhr -w ${x.join(",")} --theta ${state.thetaI} --format csv`,
    coefficients: `# Coefficients are in the file of the model: mmbrdf convert ${model} model.json`,
  };
  const lines = [
    `mmbrdf evaluate ${where} -r ${state.thetaR},${state.phiR}${frame}${state.normalized ? " --normalized" : ""}${hasUncertainty ? " --uncertainty" : ""}`,
    `mmbrdf analyze ${where} -r ${state.thetaR},${state.phiR}${frame}`,
    curve[kind],
    ...others.map((other) => `mmbrdf compare ${model} ${fileName(other.name, other.ownFile)} -w ${state.wavelength}`),
  ];
  if (state.convention !== "germer2017")
    lines.push(`# The program's signs are those of germer2017; Python converts to ${state.convention}.`);
  return lines.join("\n");
}

/** The list of the azimuths of a curve around the normal. */
const turns = (phiI: number) => (Number.isInteger(phiI) ? `range(${phiI - 180}, ${phiI + 181}, 3)` : `[${phiI} + turn for turn in range(-180, 181, 3)]`);

export function pythonLines({ state, along: { kind, x }, ownFile, hasUncertainty }: Told): string {
  const { wavelength, thetaI, phiI, thetaR, phiR, frame, convention } = state;
  const light = `${wavelength}, theta_i_deg=${thetaI}, phi_i_deg=${phiI}`;
  const where = `${light}, theta_r_deg=${thetaR}, phi_r_deg=${phiR}`;
  const reflectance = (of: string) => [
    `dhr = mmbrdf.directional_hemispherical_reflectance(model, ${of})`,
    ...(hasUncertainty ? [`u_dhr = mmbrdf.directional_hemispherical_uncertainty(model, ${of})`] : []),
  ];
  const curve = {
    plane: [`curve = model.analyze(${light}, theta_r_deg=range(-85, 86), phi_r_deg=${phiI + 180})`],
    azimuth: [`curve = model.analyze(${light}, theta_r_deg=${thetaR}, phi_r_deg=${turns(phiI)})`],
    dhr: reflectance(`${wavelength}, range(${x[0]}, ${x.length})`),
    dhr_wavelength: reflectance(`[${x.join(", ")}], ${thetaI}`),
    coefficients: [],
  };
  return [
    "import mmbrdf",
    "",
    `model = mmbrdf.${ownFile ? "load_model" : "material"}(${JSON.stringify(state.model)})`,
    `f = model.evaluate(${where}, frame="${frame}")`,
    ...(hasUncertainty ? [`u = model.evaluate_uncertainty(${where}, frame="${frame}")`] : []),
    `quantities = model.analyze(${where})`,
    ...curve[kind],
    ...(convention === "germer2017" ? [] : [`f = mmbrdf.convert(f, "germer2017", "${convention}")`]),
    ...(state.normalized ? ["m = mmbrdf.normalized(f)  # but for m11; of what it is uncertain by the program tells"] : []),
  ].join("\n");
}

/** The lines over a picture of the hemispheres; `points`: what they show, if there are any. */
export function pictureWords(state: State, limits: number[], points: string): string[] {
  const other = state.compare && state.shown !== "model";
  const model = !other ? state.model : state.shown === "other" ? state.compare : `${state.compare} − ${state.model}`;
  const projection = state.projection === "lambert" ? "equal solid angles" : "direction cosines";
  return [
    `${model} at ${state.wavelength} nm, light from θi = ${state.thetaI}°, φi = ${state.phiI}°; ring: θr = ${state.thetaR}°, φr = ${state.phiR}°`,
    `Frame ${state.frame}, signs of ${state.convention}, ${projection}; striped: extrapolated`,
    `f11 from ${short(limits[0])} to ${short(limits[1])} sr⁻¹; ${state.normalized ? "others are divided by f11" : "others in sr⁻¹"}`,
    ...(points ? [points] : []),
  ];
}

/** A number that is not known has no digits. */
const table = (head: string[], rows: (string | number)[][]) =>
  [head, ...rows].map((row) => row.map((one) => (Number.isNaN(one) ? "" : String(one))).join(",") + "\n").join("");

const quoted = (name: string) => (/[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name);

/** The curve that is shown: all quantities over its directions, all modes over its wavelengths. */
export function csv({ state, along, curves, mmbrdf, at, other }: Drawing): string {
  const { x, kind } = along;
  const [bands, beside] = [curves[0].bands, other && curves[1]?.bands];
  if (kind === "dhr" || kind === "dhr_wavelength") {
    const rows = (name: string, { dhr }: Bands) =>
      x.map((value, i) => [quoted(name), ...(kind === "dhr" ? [state.wavelength, value] : [value, state.thetaI]), dhr.values[i], dhr.uncertainties[i]]);
    const of = beside ? rows(state.compare, beside) : [];
    return table(["model", "wavelength_nm", "theta_i_deg", "dhr", "u_dhr"], [...rows(state.model, bands), ...of]);
  }
  if (kind === "coefficients") {
    const names = at.model.modes.map(({ block, function: name, n, m, k, l }) => `${block.replaceAll(",", " ")}: ${name} (${[n, m, k, l].join(" ")})`);
    return table(["wavelength_nm", ...names], x.map((value, i) => [value, ...names.map((_, mode) => bands[String(mode)].values[i])]));
  }
  const names = ["f11", ...mmbrdf.quantities.map(({ name }) => name)];
  const validity = at.outside(along.geometries);
  const signed = kind === "plane" ? "theta_r_signed_deg" : "phi_r_from_light_deg";
  const group = (name: string) => [name, `u_${name}`, ...(beside ? [`other_${name}`, `u_other_${name}`] : [])];
  const otherValidity = beside && other?.outside(along.geometries);
  const head = ["wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg", signed, ...names.flatMap(group), "validity", ...(beside ? ["other_validity"] : [])];
  const numbers = (of: Bands | undefined, name: string, i: number) => (of ? [of[name].values[i], of[name].uncertainties[i]] : []);
  const rows = along.geometries.map((one, i) => [
    state.wavelength, one.thetaI, one.phiI!, one.thetaR, one.phiR!, x[i],
    ...names.flatMap((name) => [...numbers(bands, name, i), ...numbers(beside, name, i)]),
    validity[i].validity, ...(otherValidity ? [otherValidity[i].validity] : []),
  ]);
  return table(head, rows);
}
