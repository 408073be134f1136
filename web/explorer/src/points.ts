// SPDX-License-Identifier: BSD-3-Clause
// Samples as points over the hemispheres, in the colours of the pictures or of what they differ by.
import type { Geometry } from "mmbrdf";

import { colorAt } from "./colors";

export interface Points {
  geometries: Geometry[];
  /** Sixteen elements of each; NaN is not known, and has no point. */
  values: Float64Array;
  /** Ends of the scales of differences, one for each element; none of measured values, which have the scales of the pictures. */
  ends?: number[];
  /** What they show, for a legend. */
  words: string;
}

/** How many points there are in all sixteen pictures. */
export const takenBy = ({ values }: Points) => values.filter(Number.isFinite).length;

/** `place` says where a direction is in the disc of a tile: -1 ... 1 to the right and upwards. */
export function draw(
  context: CanvasRenderingContext2D,
  pixels: number,
  { geometries, values, ends }: Points,
  limits: number[],
  place: (theta: number, phi: number) => [number, number],
) {
  geometries.forEach(({ thetaR, phiR }, i) => {
    const [x, y] = place(thetaR, phiR!);
    for (let e = 0; e < 16; ++e) {
      const value = values[16 * i + e];
      if (!Number.isFinite(value)) continue;
      const [low, high] = ends ? [-ends[e], ends[e]] : [limits[2 * e], limits[2 * e + 1]];
      context.beginPath();
      context.arc(((e % 4) + (1 + x) / 2) * pixels, ((e >> 2) + (1 - y) / 2) * pixels, 2.6, 0, 2 * Math.PI);
      context.fillStyle = colorAt(e || ends ? "signed" : "f11", (value - low) / (high - low));
      context.fill();
      context.lineWidth = 0.8;
      context.strokeStyle = "#000";
      context.stroke();
    }
  });
}
