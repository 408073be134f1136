// SPDX-License-Identifier: BSD-3-Clause
// A chart of curves with bands, and points with bars, as SVG: what is shown is what is exported.
import { scaleLinear } from "d3-scale";
import { area, line } from "d3-shape";

export interface Curve {
  name: string;
  x: number[];
  y: ArrayLike<number>;
  /** Half widths of its band; empty: none. */
  half: ArrayLike<number>;
  /** Those of one colour belong together; counted from 0. */
  color: number;
  /** Of another model. */
  thin?: boolean;
}

/** Measured, beside the curves of one colour. */
export interface Point {
  x: number;
  y: number;
  /** Half of its bar; NaN: none. */
  half: number;
  color: number;
  /** For the panel of residuals. */
  residual: number;
}

export interface Chart {
  /** Of the picture; its words have 13 of these. */
  width: number;
  curves: Curve[];
  points: Point[];
  xLabel: string;
  yLabel: string;
  residualLabel: string;
  /** Where the model extrapolates, in x. */
  beyond: [number, number][];
  /** A vertical line, where the direction of the matrix is. */
  at?: number;
}

type Scale = ReturnType<typeof scaleLinear<number, number>>;

const [left, right, top, plot, panel] = [62, 12, 14, 300, 96];
const [entry, step] = [140, 18]; // the width of an entry of the legend, and from line to line of words
const colors = ["var(--s1)", "var(--s2)", "var(--s3)", "var(--s4)"];
const dashes = ["", "7 3", "2 3", "9 3 2 3"];

const escaped = (text: string) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");

const words = (x: number, y: number, text: string, more = "") =>
  `<text x="${x}" y="${y}" fill="currentColor" font-size="13" ${more}>${escaped(text)}</text>`;

function ends(values: number[]): [number, number] {
  const known = values.filter(Number.isFinite);
  if (!known.length) return [0, 1];
  const [low, high] = known.reduce(([least, most], one) => [Math.min(least, one), Math.max(most, one)], [Infinity, -Infinity]);
  return [low, high === low ? low + 1 : high];
}

export function drawn(chart: Chart, description: string): string {
  const withPanel = chart.points.some(({ residual }) => Number.isFinite(residual));
  const below = top + plot + (withPanel ? panel : 0);
  const { width } = chart;
  const x = scaleLinear(ends(chart.curves.flatMap((curve) => curve.x)), [left, width - right]);
  const around = (y: number, half: number) => [y - (half || 0), y + (half || 0)];
  const all = [
    ...chart.curves.flatMap(({ y, half }) => Array.from(y).flatMap((value, i) => around(value, half[i]))),
    ...chart.points.flatMap(({ y, half }) => around(y, half)),
  ];
  const y = scaleLinear(ends(all), [top + plot, top]).nice();
  const label = chart.xLabel.length * 6.6 > width - left ? chart.xLabel.split(/(?<=;) /) : [chart.xLabel];
  const underLabel = below + 43 + step * label.length;
  const [drawnLegend, height] = legend(chart.curves, underLabel, width);
  const parts = [
    `<defs><pattern id="hatch" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">` +
      `<rect width="2" height="7" fill="currentColor" opacity="0.28"/></pattern></defs>`,
    ...chart.beyond.map(([from, to]) => `<rect x="${x(from)}" y="${top}" width="${x(to) - x(from)}" height="${plot}" fill="url(#hatch)"/>`),
    ...rows(y, 6, width),
    ...chart.curves.map((curve) => curvePath(curve, x, y)),
    ...chart.points.map((point) => pointMark(point, x, y)),
    ...drawnLegend,
    ...(withPanel ? residuals(chart, x) : []),
    ...x.ticks(width / 70).map((tick) => `<path d="M${x(tick)} ${below}v5" stroke="currentColor"/>` + words(x(tick), below + 19, String(tick), 'text-anchor="middle"')),
    chart.at === undefined ? "" : `<path d="M${x(chart.at)} ${top}V${below}" stroke="currentColor" stroke-dasharray="3 3"/>`,
    `<path d="M${left} ${top}V${below}H${width - right}" fill="none" stroke="currentColor"/>`,
    ...label.map((text, i) => words((left + width - right) / 2, below + 37 + step * i, text, 'text-anchor="middle"')),
    sideways(top + plot / 2, chart.yLabel),
  ];
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" font-family="system-ui, sans-serif" role="img" ` +
    `aria-label="${escaped(description)}">${parts.join("")}</svg>`
  );
}

/** Lines across, with their numbers. */
function rows(y: Scale, count: number, width: number): string[] {
  return y
    .ticks(count)
    .map((tick) => `<path d="M${left} ${y(tick)}H${width - right}" stroke="currentColor" opacity="0.2"/>` + words(left - 6, y(tick) + 4, String(tick), 'text-anchor="end"'));
}

const sideways = (y: number, text: string) =>
  `<text transform="translate(14 ${y}) rotate(-90)" fill="currentColor" font-size="13" text-anchor="middle">${escaped(text)}</text>`;

const stroke = ({ color, thin }: Curve) =>
  `stroke="${colors[color % 4]}" stroke-width="${thin ? 1 : 2}" stroke-dasharray="${thin ? "1 2" : dashes[color % 4]}"`;

function curvePath(curve: Curve, x: Scale, y: Scale): string {
  const points = curve.x.map((value, p) => ({ x: value, y: curve.y[p], half: curve.half[p] ?? NaN }));
  type P = (typeof points)[0];
  const band = area<P>()
    .defined((p) => Number.isFinite(p.y) && Number.isFinite(p.half))
    .x((p) => x(p.x))
    .y0((p) => y(p.y - p.half))
    .y1((p) => y(p.y + p.half))(points);
  const path = line<P>().defined((p) => Number.isFinite(p.y)).x((p) => x(p.x)).y((p) => y(p.y))(points);
  return (
    (band ? `<path d="${band}" fill="${colors[curve.color % 4]}" opacity="${curve.thin ? 0.12 : 0.22}"/>` : "") +
    (path ? `<path d="${path}" class="${curve.thin ? "other" : "curve"}" fill="none" ${stroke(curve)}/>` : "")
  );
}

function pointMark({ x: px, y: py, half, color }: Point, x: Scale, y: Scale): string {
  const bar = Number.isFinite(half) ? `<path d="M${x(px)} ${y(py - half)}V${y(py + half)}" stroke="${colors[color % 4]}"/>` : "";
  return `${bar}<circle class="sample" cx="${x(px)}" cy="${y(py)}" r="3" fill="${colors[color % 4]}"/>`;
}

/** One entry for each colour, as another model's are thin; and where it ends. */
function legend(curves: Curve[], y: number, width: number): [string[], number] {
  const perLine = Math.max(1, Math.floor((width - left) / entry));
  const entries = curves.filter(({ thin }) => !thin);
  const keys = entries.map((curve, i) => {
    const [px, py] = [left + 8 + entry * (i % perLine), y + step * Math.floor(i / perLine)];
    return `<path d="M${px} ${py - 4}h26" ${stroke(curve)}/>` + words(px + 32, py, curve.name);
  });
  return [keys, y + step * (Math.ceil(entries.length / perLine) - 1) + 5];
}

/** A panel below: points about 0. */
function residuals({ width, points, residualLabel }: Chart, x: Scale): string[] {
  const largest = Math.max(...points.map(({ residual }) => Math.abs(residual)).filter(Number.isFinite));
  const y = scaleLinear([-largest || -1, largest || 1], [top + plot + panel - 4, top + plot + 22]).nice(3);
  return [
    ...rows(y, 3, width),
    ...points
      .filter(({ residual }) => Number.isFinite(residual))
      .map(({ x: px, residual, color }) => `<circle class="residual" cx="${x(px)}" cy="${y(residual)}" r="2.5" fill="${colors[color % 4]}"/>`),
    words(left + 6, top + plot + 14, residualLabel),
  ];
}

/** For a file, which has no style sheet: dark on white, with words below. */
export function standalone(svg: string, said: string): string {
  const fixed: Record<string, string> = { "var(--s1)": "#0b57a4", "var(--s2)": "#b34700", "var(--s3)": "#3a7d1f", "var(--s4)": "#8a2c86" };
  const [width, height] = /viewBox="0 0 (\d+) (\d+)"/.exec(svg)!.slice(1).map(Number);
  const lines = said.match(new RegExp(`\\S(.{0,${Math.floor(width / 6.7)}}\\S)?(?=\\s|$)`, "g")) ?? [];
  return svg
    .replace(/var\(--s\d\)/g, (name) => fixed[name])
    .replace(/viewBox="[^"]*"/, `viewBox="0 0 ${width} ${height + step * lines.length + 8}" color="#1b1f24" style="background:#fff"`)
    .replace("</svg>", () => `${lines.map((text, i) => words(left - 48, height + step * (i + 1), text)).join("")}</svg>`);
}
