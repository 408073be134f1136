// SPDX-License-Identifier: BSD-3-Clause
// Where curves are asked for.
import type { Geometry } from "mmbrdf";

import type { State } from "./state";

/** Polar angles of curves in the plane of incidence: negative ones on the side of the light. */
export const scanned = [...Array(171).keys()].map((i) => i - 85);
export const dhrAngles = [...Array(86).keys()];

export function inPlane(state: State): Geometry[] {
  return scanned.map((theta) => ({
    thetaI: state.thetaI,
    phiI: state.phiI,
    thetaR: Math.abs(theta),
    phiR: theta < 0 ? state.phiI : state.phiI + 180,
  }));
}

/** Where the chosen direction is in the curve, if it is. */
export function cursor(state: State): number | undefined {
  if (state.curve === "dhr") return state.thetaI <= 85 ? state.thetaI : undefined;
  const turn = (((state.phiR - state.phiI) % 360) + 360) % 360;
  const theta = state.thetaR === 0 ? 0 : turn === 180 ? state.thetaR : turn === 0 ? -state.thetaR : NaN;
  return Math.abs(theta) <= 85 ? theta : undefined;
}
