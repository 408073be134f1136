// SPDX-License-Identifier: BSD-3-Clause
// A chart of curves with bands, as SVG: what is shown is what is exported.
import { scaleLinear } from "d3-scale";
import { area, line } from "d3-shape";

export interface Curve {
  name: string;
  x: number[];
  y: ArrayLike<number>;
  /** Half widths of its band; empty: none. */
  half: ArrayLike<number>;
}

export interface Chart {
  curves: Curve[];
  xLabel: string;
  yLabel: string;
  /** Where the model extrapolates, in x. */
  beyond: [number, number][];
  /** A vertical line, where the direction of the matrix is. */
  at?: number;
}

const [width, height, left, right, top, bottom] = [640, 380, 62, 12, 14, 66];
const colors = ["var(--s1)", "var(--s2)", "var(--s3)", "var(--s4)"];
const dashes = ["", "7 3", "2 3", "9 3 2 3"];

const escaped = (text: string) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");

export function drawn(chart: Chart, description: string): string {
  const xs = chart.curves.flatMap((curve) => curve.x);
  const ends = chart.curves.flatMap(({ y, half }) =>
    Array.from(y).flatMap((value, i) => [value - (half[i] || 0), value + (half[i] || 0)]).filter(Number.isFinite),
  );
  const [low, high] = ends.length ? [Math.min(...ends), Math.max(...ends)] : [0, 1];
  const x = scaleLinear([Math.min(...xs), Math.max(...xs)], [left, width - right]);
  const y = scaleLinear([low, high === low ? low + 1 : high], [height - bottom, top]).nice();
  const parts: string[] = [];
  const text = (px: number, py: number, words: string, more = "") =>
    parts.push(`<text x="${px}" y="${py}" fill="currentColor" font-size="13" ${more}>${escaped(words)}</text>`);

  parts.push(
    `<defs><pattern id="hatch" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">` +
      `<rect width="2" height="7" fill="currentColor" opacity="0.28"/></pattern></defs>`,
  );
  for (const [from, to] of chart.beyond)
    parts.push(
      `<rect x="${x(from)}" y="${top}" width="${x(to) - x(from)}" height="${height - top - bottom}" fill="url(#hatch)"/>`,
    );
  for (const tick of y.ticks(6)) {
    parts.push(`<path d="M${left} ${y(tick)}H${width - right}" stroke="currentColor" opacity="0.2"/>`);
    text(left - 6, y(tick) + 4, String(tick), 'text-anchor="end"');
  }
  for (const tick of x.ticks(9)) {
    parts.push(`<path d="M${x(tick)} ${height - bottom}v5" stroke="currentColor"/>`);
    text(x(tick), height - bottom + 19, String(tick), 'text-anchor="middle"');
  }
  chart.curves.forEach((curve, i) => {
    const points = curve.x.map((value, p) => ({ x: value, y: curve.y[p], half: curve.half[p] ?? NaN }));
    const color = colors[i % colors.length];
    const band = area<(typeof points)[0]>()
      .defined((p) => Number.isFinite(p.y) && Number.isFinite(p.half))
      .x((p) => x(p.x))
      .y0((p) => y(p.y - p.half))
      .y1((p) => y(p.y + p.half))(points);
    const path = line<(typeof points)[0]>().defined((p) => Number.isFinite(p.y)).x((p) => x(p.x)).y((p) => y(p.y))(points);
    if (band) parts.push(`<path d="${band}" fill="${color}" opacity="0.22"/>`);
    if (path)
      parts.push(`<path d="${path}" fill="none" stroke="${color}" stroke-width="2" stroke-dasharray="${dashes[i % 4]}"/>`);
    const key = left + 8 + 140 * i;
    parts.push(
      `<path d="M${key} ${height - 9}h26" stroke="${color}" stroke-width="2" stroke-dasharray="${dashes[i % 4]}"/>`,
    );
    text(key + 32, height - 5, curve.name);
  });
  if (chart.at !== undefined)
    parts.push(`<path d="M${x(chart.at)} ${top}V${height - bottom}" stroke="currentColor" stroke-dasharray="3 3"/>`);
  parts.push(`<path d="M${left} ${top}V${height - bottom}H${width - right}" fill="none" stroke="currentColor"/>`);
  text((left + width - right) / 2, height - bottom + 37, chart.xLabel, 'text-anchor="middle"');
  parts.push(
    `<text transform="translate(14 ${(top + height - bottom) / 2}) rotate(-90)" fill="currentColor" font-size="13" text-anchor="middle">${escaped(chart.yLabel)}</text>`,
  );
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" font-family="system-ui, sans-serif" role="img" ` +
    `aria-label="${escaped(description)}">${parts.join("")}</svg>`
  );
}

/** For a file, which has no style sheet: dark on white. */
export function standalone(svg: string): string {
  const fixed: Record<string, string> = { "var(--s1)": "#0b57a4", "var(--s2)": "#b34700", "var(--s3)": "#3a7d1f", "var(--s4)": "#8a2c86" };
  return svg
    .replace(/var\(--s\d\)/g, (name) => fixed[name])
    .replace("<svg ", '<svg color="#1b1f24" style="background:#fff" ');
}
