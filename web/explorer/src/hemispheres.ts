// SPDX-License-Identifier: BSD-3-Clause
// The sixteen pictures: a canvas that the module paints, with names, limits and marks over it.
import type { Hemisphere, Mmbrdf, ModelAt } from "mmbrdf";

import { f11Gradient, palette, signedGradient, signedPalette } from "./colors";
import { element } from "./dom";
import { short } from "./numbers";
import { pictureOf } from "./picture";
import { draw, type Points, takenBy } from "./points";
import { areOfPaper, folded, type State } from "./state";

export const pixels = 192;
const grasp = 14; // px around a mark

type Angles = [number, number];
type Moved = (what: "source" | "detector", to: Angles) => void;

/** What is to be seen: a model, and if there is one another beside it, and points over the pictures. */
export interface View {
  at: ModelAt;
  other?: ModelAt;
  points?: Points;
}

export class Hemispheres {
  #grid?: Hemisphere;
  #first?: Hemisphere; // of which the other is subtracted
  #projection = "";
  readonly #box = document.querySelector<HTMLElement>("#hemispheres")!;
  readonly #canvas = document.querySelector<HTMLCanvasElement>("#canvas")!;
  readonly #context: CanvasRenderingContext2D;
  readonly #tiles: HTMLElement[];

  constructor(
    readonly mmbrdf: Mmbrdf,
    moved: Moved,
  ) {
    this.#canvas.width = this.#canvas.height = 4 * pixels;
    this.#context = this.#canvas.getContext("2d")!;
    this.#tiles = [...Array(16).keys()].map(() => {
      const tile = document.createElement("div");
      tile.innerHTML =
        '<b></b><span class="limit"></span><i class="mark source"></i><i class="mark detector"></i>';
      document.querySelector("#tiles")!.append(tile);
      return tile;
    });
    this.#listen(moved);
  }

  /** The limits that were used; times go to the performance timeline as "frame". */
  show({ at, other, points }: View, state: State): number[] {
    const begun = performance.now();
    const difference = other !== undefined && state.shown === "difference";
    const grid = this.#evaluated(other && state.shown !== "model" ? other : at, state);
    if (difference) {
      this.#first ??= this.mmbrdf.hemisphere(pixels, { projection: state.projection });
      this.#first.evaluate(at, state.thetaI, state.phiI, state);
      grid.subtract(this.#first);
    }
    const extremes = grid.extremes();
    const limits = state.limits.length ? state.limits : automatic(extremes, difference);
    grid.colors.set(difference ? signedPalette : palette);
    grid.limits.set(limits);
    grid.paint();
    const painted = performance.now();
    this.#context.putImageData(new ImageData(grid.image as Uint8ClampedArray<ArrayBuffer>, 4 * pixels, 4 * pixels), 0, 0);
    performance.measure("module", { start: begun, end: painted });
    const place = (theta: number, phi: number) => placed(state, theta, phi);
    if (points) draw(this.#context, pixels, points, limits, place);
    performance.measure("frame", { start: begun, end: performance.now() });
    this.#canvas.dataset.points = String(points ? takenBy(points) : 0);
    this.#label(state, limits, difference, extremes);
    element("legend-points").textContent = points?.words ?? "";
    return limits;
  }

  #evaluated(at: ModelAt, state: State): Hemisphere {
    if (!this.#grid || this.#projection !== state.projection) {
      this.#grid?.free();
      this.#first?.free();
      this.#first = undefined;
      this.#projection = state.projection;
      this.#grid = this.mmbrdf.hemisphere(pixels, { projection: state.projection });
    }
    this.#grid.evaluate(at, state.thetaI, state.phiI, state);
    return this.#grid;
  }

  /** An element without extremes is not known. */
  #label(state: State, limits: number[], difference: boolean, extremes: Float32Array) {
    const known = [...Array(16).keys()].map((e) => Number.isFinite(extremes[2 * e]));
    element("legend-unknown").hidden = !known.includes(false);
    const [source, detector] = [placed(state, state.thetaI, state.phiI), placed(state, state.thetaR, state.phiR)];
    this.#tiles.forEach((tile, e) => {
      const letter = state.normalized && e ? "m" : "f";
      const [name, limit, sun, eye] = tile.children as unknown as HTMLElement[];
      name.textContent = `${difference ? "Δ" : ""}${letter}${1 + (e >> 2)}${1 + (e & 3)}`;
      limit.textContent = !known[e] ? "not known" : e || difference ? `± ${short(limits[2 * e + 1])}` : `${short(limits[0])} … ${short(limits[1])}`;
      for (const [mark, [x, y]] of [[sun, source], [eye, detector]] as const) {
        mark.style.left = `${50 + 50 * x}%`;
        mark.style.top = `${50 - 50 * y}%`;
      }
    });
    const ramp = (gradient: string) => `<i class="ramp" style="background:${gradient}"></i>`;
    const unit = state.normalized ? "" : " sr<sup>-1</sup>";
    const lock = areOfPaper(state) ? ", as in the paper" : state.limits.length ? ", locked" : "";
    element("legend-f11").innerHTML =
      `${difference ? "Δ" : ""}f11: ${short(limits[0])}${ramp(difference ? signedGradient : f11Gradient)}${short(limits[1])} sr<sup>-1</sup>${lock}`;
    element("legend-others").innerHTML =
      `others: −${ramp(signedGradient)}+ of the limit in each picture${unit}${lock}`;
  }

  #listen(moved: Moved) {
    let held: "source" | "detector" | undefined;
    let state: State | undefined;
    let tile: [number, number] = [0, 0]; // where the drag began: it ends at the edge of the disc there
    const at = (event: PointerEvent): { x: number; y: number; size: number } => {
      const box = this.#box.getBoundingClientRect();
      const size = box.width / 4;
      const [px, py] = [(event.clientX - box.left) / size, (event.clientY - box.top) / size];
      if (!held) tile = [Math.floor(px), Math.floor(py)];
      return { x: 2 * (px - tile[0]) - 1, y: 1 - 2 * (py - tile[1]), size };
    };
    this.current = (now: State) => (state = now);
    this.#box.addEventListener("pointerdown", (event) => {
      if (!state || event.button !== 0 || !event.isPrimary) return; // not a second finger
      const { x, y, size } = at(event);
      const near = (theta: number, phi: number) => {
        const [mx, my] = placed(state!, theta, phi);
        return (Math.hypot(mx - x, my - y) * size) / 2 <= grasp;
      };
      held = near(state.thetaI, state.phiI) ? "source" : "detector";
      this.#box.setPointerCapture(event.pointerId);
      moved(held, direction(state, x, y));
    });
    this.#box.addEventListener("pointermove", (event) => {
      if (!held || !state || !event.isPrimary) return;
      const { x, y } = at(event);
      moved(held, direction(state, x, y));
    });
    for (const end of ["pointerup", "pointercancel"] as const)
      this.#box.addEventListener(end, ({ isPrimary }) => (held = isPrimary ? undefined : held));
    this.#box.addEventListener("keydown", (event) => {
      const steps: Record<string, Angles> = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };
      const step = steps[event.key];
      if (!step || !state || event.altKey || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      const [theta, phi] = event.shiftKey ? [state.thetaR, state.phiR] : [state.thetaI, state.phiI];
      moved(event.shiftKey ? "detector" : "source", folded(theta + step[0], phi + step[1]));
    });
  }

  /** Tells what is shown to who drags. */
  current: (state: State) => void = () => {};

  /** With the name and the limits of each, marks and scales, and lines that say what it is. */
  async png(title: string[]): Promise<Blob> {
    const tiles = this.#tiles.map((tile) => {
      const [name, limit, ...marks] = tile.children as unknown as HTMLElement[];
      const at = marks.map(({ style }) => [parseFloat(style.left) / 100, parseFloat(style.top) / 100] as Angles);
      return { name: name.textContent!, limit: limit.textContent!, source: at[0], detector: at[1] };
    });
    return pictureOf(this.#canvas, tiles, title);
  }
}

/** f11 from its smallest to its largest; the others, and differences, as far to both sides. */
function automatic(extremes: Float32Array, difference: boolean): number[] {
  const limits = Array.from(extremes);
  for (let e = 0; e < 16; ++e) {
    const size = Math.max(Math.abs(limits[2 * e]), Math.abs(limits[2 * e + 1]));
    if (!Number.isFinite(size)) limits.splice(2 * e, 2, 0, 1);
    else if (e || difference) limits.splice(2 * e, 2, -(size || 1), size || 1);
    else if (limits[0] === limits[1]) limits[1] = limits[0] + 1;
  }
  return limits;
}

const radians = Math.PI / 180;

/** In the disc of a tile: -1 ... 1 to the right and upwards. */
function placed(state: State, theta: number, phi: number): Angles {
  const r = state.projection === "lambert" ? Math.SQRT2 * Math.sin((theta * radians) / 2) : Math.sin(theta * radians);
  return [r * Math.cos(phi * radians), r * Math.sin(phi * radians)];
}

/** The direction there; beyond the disc the one at its edge. To tenths of a degree. */
function direction(state: State, x: number, y: number): Angles {
  const r = Math.min(1, Math.hypot(x, y));
  const theta = state.projection === "lambert" ? 2 * Math.asin(r / Math.SQRT2) : Math.asin(r);
  const tenths = (angle: number) => Math.round((angle / radians) * 10) / 10;
  return [tenths(theta), tenths(Math.atan2(y, x))];
}
