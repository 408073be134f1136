// SPDX-License-Identifier: BSD-3-Clause
// Colour maps that survive colour blindness: cividis for f11, red to blue through white for what has a sign.
import { interpolateCividis, interpolateRdBu } from "d3-scale-chromatic";

type Rgb = [number, number, number];

function rgb(css: string): Rgb {
  const hex = /^#(..)(..)(..)$/.exec(css);
  const parts = hex ? hex.slice(1).map((two) => parseInt(two, 16)) : (css.match(/[\d.]+/g) ?? []).map(Number);
  return [parts[0], parts[1], parts[2]];
}

const f11 = (t: number) => rgb(interpolateCividis(t));
const signed = (t: number) => rgb(interpolateRdBu(1 - t));

/** Stripes: dark on light colours, light on dark ones. */
function striped([r, g, b]: Rgb): Rgb {
  const to = 0.3 * r + 0.59 * g + 0.11 * b > 110 ? 0 : 255;
  const mixed = (x: number) => Math.round(0.45 * x + 0.55 * to);
  return [mixed(r), mixed(g), mixed(b)];
}

const packed = ([r, g, b]: Rgb) => (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;

/** As Hemisphere.colors asks for them. */
export const palette = new Uint32Array(1025);
for (let i = 0; i < 256; ++i) {
  palette[i] = packed(f11(i / 255));
  palette[256 + i] = packed(signed(i / 255));
  palette[512 + i] = packed(striped(f11(i / 255)));
  palette[768 + i] = packed(striped(signed(i / 255)));
}
palette[1024] = packed([150, 150, 150]);

/** Where f11 has a sign, too: of differences. */
export const signedPalette = palette.slice();
for (const first of [0, 512]) signedPalette.copyWithin(first, first + 256, first + 512);

/** The colour at a place from 0 to 1 of a scale. */
export function colorAt(of: "f11" | "signed", t: number): string {
  return `rgb(${(of === "f11" ? f11 : signed)(Math.min(1, Math.max(0, t))).join(",")})`;
}

function gradient(of: (t: number) => Rgb): string {
  const stops = [...Array(11).keys()].map((i) => `rgb(${of(i / 10).join(",")})`);
  return `linear-gradient(to right, ${stops.join(",")})`;
}
export const f11Gradient = gradient(f11);
export const signedGradient = gradient(signed);
