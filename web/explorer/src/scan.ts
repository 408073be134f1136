// SPDX-License-Identifier: BSD-3-Clause
// Where curves are asked for.
import type { Geometry, Model } from "mmbrdf";

import type { State } from "./state";

/** Polar angles of curves in the plane of incidence: negative ones on the side of the light. */
export const scanned = [...Array(171).keys()].map((i) => i - 85);
/** Of curves around the normal, from the azimuth of the light. */
export const turned = [...Array(121).keys()].map((i) => 3 * i - 180);
export const dhrAngles = [...Array(86).keys()];

/** What runs along a curve. */
export type Kind = "plane" | "azimuth" | "dhr" | "dhr_wavelength" | "coefficients";

export function kindOf({ curve, scan }: State): Kind {
  return curve === "dhr" || curve === "dhr_wavelength" || curve === "coefficients" ? curve : scan;
}

/** The numbers along a curve, in degrees or nanometres, and where the model is asked: of wavelengths at a direction of the light alone. */
export interface Along {
  kind: Kind;
  x: number[];
  label: string;
  geometries: Geometry[];
}

export function along(state: State, model: Model): Along {
  const { thetaI, phiI, thetaR } = state;
  const kind = kindOf(state);
  if (kind === "plane") {
    const label = "θr in the plane of incidence, degrees; negative on the side of the light";
    return { kind, label, x: scanned, geometries: scanned.map((theta) => inPlane(state, theta)) };
  }
  if (kind === "azimuth") {
    const label = `φr − φi at θr = ${thetaR}°, degrees; forward at ±180`;
    return { kind, label, x: turned, geometries: turned.map((phi) => ({ thetaI, phiI, thetaR, phiR: phiI + phi })) };
  }
  if (kind === "dhr") {
    const geometries = dhrAngles.map((theta) => ({ thetaI: theta, thetaR: 0 }));
    return { kind, label: "polar angle θi of the light, degrees", x: dhrAngles, geometries };
  }
  return { kind, label: "wavelength, nm", x: wavelengthsOf(state, model), geometries: [{ thetaI, thetaR: 0 }] };
}

function inPlane({ thetaI, phiI }: State, theta: number): Geometry {
  return { thetaI, phiI, thetaR: Math.abs(theta), phiR: theta < 0 ? phiI : phiI + 180 };
}

/** From the first to the last that the model was fitted to, or a fifth to both sides of the one that is shown. */
function wavelengthsOf({ wavelength }: State, { wavelengths }: Model): number[] {
  const [from, to] = wavelengths.length > 1 ? [wavelengths[0], wavelengths[wavelengths.length - 1]] : [0.8 * wavelength, 1.2 * wavelength];
  return [...Array(25).keys()].map((i) => Number((from + ((to - from) * i) / 24).toPrecision(12)));
}

/** An azimuth from that of the light, in -180 ... 180. */
export const fromLight = (phiR: number, phiI: number) => {
  const turn = (((phiR - phiI) % 360) + 360) % 360;
  return turn > 180 ? turn - 360 : turn;
};

/** Where the chosen direction is in the curve, if it is. */
export function cursor(state: State, { kind, x }: Along): number | undefined {
  const inside = (value: number) => (value >= x[0] && value <= x[x.length - 1] ? value : undefined);
  if (kind === "dhr") return inside(state.thetaI);
  if (kind === "dhr_wavelength" || kind === "coefficients") return inside(state.wavelength);
  const turn = fromLight(state.phiR, state.phiI);
  if (kind === "azimuth") return turn;
  return inside(state.thetaR === 0 ? 0 : turn === 180 ? state.thetaR : turn === 0 ? -state.thetaR : NaN);
}
