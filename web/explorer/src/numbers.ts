// SPDX-License-Identifier: BSD-3-Clause
// Numbers as people read them.

/** 0 for what is rounding alone, of a sum whose terms are as large as `size`. */
export function withoutRounding(value: number, size: number): number {
  return Math.abs(value) < 1e-12 * Math.abs(size) ? 0 : value;
}

/** To the place where two significant digits of the uncertainty end; six digits where it is not known. */
export function toPlaceOf(value: number, u: number | null): string {
  if (!Number.isFinite(value)) return "not known";
  if (u === null || !(u > 0) || !Number.isFinite(u)) return value === 0 ? "0" : String(Number(value.toPrecision(6)));
  const decimals = 1 - Number(u.toExponential(1).split("e")[1]);
  if (decimals > 12) return "0";
  return decimals < 0 ? String(Number(value.toPrecision(6))) : value.toFixed(decimals).replace(/^-(0(\.0*)?)$/, "$1");
}

export function uncertaintyText(u: number | null): string {
  return u === null || !Number.isFinite(u) ? "not known" : u < 1e-12 ? "0" : toPlaceOf(u, u);
}

/** Few digits, for scales. */
export function short(value: number): string {
  return String(Number(value.toPrecision(2)));
}
