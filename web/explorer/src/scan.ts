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
