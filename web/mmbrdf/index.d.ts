// SPDX-License-Identifier: BSD-3-Clause
/**
 * Mueller-matrix BRDFs: models evaluated anywhere, with uncertainties and the range in which they hold.
 *
 * Angles are in degrees, wavelengths in nanometres, BRDFs in sr^-1. Both directions point away from the sample: to the
 * source and to the detector; forward scattering is phiR - phiI = 180. A negative polar angle means the opposite azimuth.
 * Matrices are 16 numbers, row by row: f11, f12, ... f44. NaN (null in an {@link Answer}) is what is not known.
 *
 * All functions throw an Error with one line of what is wrong, the same that the program mmbrdf prints.
 */

/** Which axes the Stokes components refer to: those at the normal, s and p of each beam, or of the scattering plane. */
export type Frame = "xy" | "sp" | "scattering_plane";

/** Signs of the Stokes components: `germer2017` has s first and S4 = left - right; docs/conventions.md has them all. */
export type StokesConvention =
  | "germer2017"
  | "s_first_right"
  | "p_first_left"
  | "p_first_right"
  | "p_first_left_handed_axes_left"
  | "p_first_left_handed_axes_right";

/** Angles in degrees; azimuths are 0 unless given. */
export interface Geometry {
  thetaI: number;
  phiI?: number;
  thetaR: number;
  phiR?: number;
}

/** One, several, or a list of numbers, four for each: thetaI, phiI, thetaR, phiR. */
export type Geometries = Geometry | readonly Geometry[] | readonly number[] | Float64Array;

export interface MatrixOptions {
  /** Default: "xy". */
  frame?: Frame;
  /** Default: "germer2017". */
  convention?: StokesConvention;
  /** f11 in sr^-1, and all others divided by it. Default: false. */
  normalized?: boolean;
}

/** A number that is derived from a matrix: a row of the library's table. */
export interface Quantity {
  name: string;
  /** Empty for a ratio. */
  unit: string;
  meaning: string;
}

export interface Validity {
  /** "ok", "interpolated" between fitted wavelengths, "unknown", or what is outside: "theta_i+wavelength". */
  validity: string;
  /** Whether the model is known to extrapolate there. */
  extrapolated: boolean;
  /** A sentence with the fitted range; empty unless extrapolated. */
  line: string;
}

/** All that a model says at one geometry. Uncertainties are standard ones (k = 1), in first order. */
export interface Answer {
  elements: (number | null)[];
  uncertainties: (number | null)[] | null;
  validity: string;
  extrapolated: boolean;
  /** Whether the data of the fit determine every element; null: not known. */
  estimable: boolean | null;
  /** Whether a scatterer can have this matrix; null: not all elements were measured. */
  realizable: boolean | null;
  /** Standard uncertainties of f11 in sr^-1 by cause. */
  budget: { name: string; u_f11: number }[];
  quantities: {
    name: string;
    value: number | null;
    uncertainty: number | null;
    /** Standard uncertainty from each cause alone. */
    parts: Record<string, number>;
  }[];
}

/** Numbers in the order of the question; uncertainties are NaN where they are not known. */
export interface WithUncertainties {
  values: Float64Array;
  uncertainties: Float64Array;
}

/** A model at one wavelength. */
export interface ModelAt {
  readonly model: Model;
  /** nm */
  readonly wavelength: number;

  /** Matrices, 16 numbers for each geometry: those of the program to 1e-12 of f11. */
  evaluate(geometries: Geometries, options?: MatrixOptions): Float64Array;

  /** Standard uncertainties of the elements. They do not depend on the convention. The first call takes longer. */
  standardUncertainty(geometries: Geometries, options?: Omit<MatrixOptions, "convention">): Float64Array;

  /** Where the model extrapolates. */
  outside(geometries: Geometries): Validity[];

  /** Every quantity of {@link Mmbrdf.quantities} with its uncertainty, of the matrix in the frame sp. */
  quantities(geometries: Geometries): Record<string, WithUncertainties>;

  /** Everything at one geometry, with the parts of the uncertainties. */
  answer(geometry: Geometry | readonly number[], options?: Omit<MatrixOptions, "normalized">): Answer;

  /** The coefficients at this wavelength, one for each of {@link Model.modes}: those of f11 in sr^-1, others without unit. */
  coefficients(): Float64Array;

  /** Directional-hemispherical reflectance for unpolarized light from these polar angles. */
  directionalHemisphericalReflectance(theta: number | readonly number[] | Float64Array): WithUncertainties;

  /** Gives its memory back; it cannot be used after that. */
  free(): void;
}

/** A basis function with its indices; which elements it feeds says the block, whose modes were fitted together. */
export interface Mode {
  block: string;
  function: string;
  n: number;
  m: number;
  k: number;
  l: number;
}

export interface Model {
  readonly name: string;
  /** A line of words. */
  readonly basis: string;
  readonly fittedRange: string;
  /** Fitted wavelengths in nm; empty if they are not known. */
  readonly wavelengths: number[];
  readonly thetaIMax: number | null;
  readonly thetaRMax: number | null;
  readonly hasUncertainty: boolean;
  readonly provenance: Record<string, string>;
  /** Block after block, in the order of coefficients. */
  readonly modes: Mode[];

  /** Prepared at a wavelength in nm. Throws for one that is not positive. */
  at(wavelength: number): ModelAt;

  /** Gives its memory back, and with it what was prepared of it. */
  free(): void;
}

/** Measured matrices, as the program reads them. Samples are counted from 0, in the order of the file. */
export interface Samples {
  readonly name: string;
  readonly count: number;
  /** nm, rising. */
  readonly wavelengths: number[];
  /** Elements that any of them has: "f11", "m12" ... "m44". All others are NaN. */
  readonly measured: string[];
  /** Whether all of them have uncertainties. */
  readonly hasUncertainty: boolean;
  /** How the table was read, where it is not as the project's own; else empty. */
  readonly understood: string;
  /** A copy of five numbers of each: wavelength in nm, thetaI, phiI, thetaR and phiR in degrees. */
  readonly places: Float64Array;

  /** Sixteen elements of each, and their standard uncertainties; NaN: not measured, or not known. */
  elements(which: ArrayLike<number>, options?: MatrixOptions): WithUncertainties;

  /** Every quantity of {@link Mmbrdf.quantities}, of the matrix in the frame sp; errors of elements count as uncorrelated. */
  quantities(which: ArrayLike<number>): Record<string, WithUncertainties>;

  /** Gives the memory back; they cannot be used after that. */
  free(): void;
}

/** A table of samples while it is read, some rows at a time, between which a page goes on. */
export interface SampleReader {
  /** Samples read so far. */
  readonly count: number;
  /** Of the file, from 0 to 1. */
  readonly share: number;

  /** At most so many rows more; whether there may be others. Throws for a row that is wrong. */
  read(rows: number): boolean;

  /** All of the table, the rows that are left as well; frees the reader. */
  samples(): Samples;

  /** Gives the memory back; it cannot be used after that. */
  free(): void;
}

/**
 * Pictures of the sixteen elements over the hemisphere of reflected directions. In each tile is a disc, x to the right
 * and y upwards. What `values`, `limits`, `colors` and `image` return are views into the memory of the module, not
 * copies: ask for them again after any other call, which may move it.
 */
export interface Hemisphere {
  /** Of a side of a tile. */
  readonly pixels: number;
  /** How many directions are in a disc. */
  readonly count: number;
  /** Of each direction: row * 4 * pixels + column in its tile. */
  readonly positions: Uint32Array;
  /** Of each element, one after the other, a number for each direction. In single precision, to 2e-5 of f11. */
  readonly values: Float32Array;
  /** Lower and upper end of the colour scale of each element: set them before paint(). */
  readonly limits: Float32Array;
  /** RGBA: 256 colours for f11, 256 for the others, the same for stripes where the model extrapolates, and one for NaN. */
  readonly colors: Uint32Array;
  /** RGBA of 4 x 4 tiles, transparent beside the discs: `new ImageData(image, 4 * pixels, 4 * pixels)`. */
  readonly image: Uint8ClampedArray;

  /** All elements, with light from there. Throws, as all here do, after free(), and where `at` or its model was freed. */
  evaluate(at: ModelAt, theta: number, phi?: number, options?: MatrixOptions): void;
  /**
   * Makes of `values` their difference: this - first. Beyond the range is what is so of either. Throws unless both have as
   * many pixels, and one projection.
   */
  subtract(first: Hemisphere): void;
  /** Smallest and largest of each element, 32 numbers. */
  extremes(): Float32Array;
  /** Writes `image` from `values`, `limits` and `colors`. */
  paint(): void;
  free(): void;
}

export interface Mmbrdf {
  readonly version: string;
  /** Names of the built-in models. */
  readonly materials: string[];
  readonly quantities: Quantity[];
  readonly frames: Frame[];
  readonly conventions: StokesConvention[];

  /** A built-in model. */
  material(name: string): Model;

  /**
   * A model from the contents of a file, JSON or published coefficients: a text, or its bytes in UTF-8; `path` is its name
   * in messages. Throws for contents of another type.
   */
  model(contents: string | ArrayBuffer | Uint8Array, path: string): Model;

  /** Whether contents begin as a file of samples does, and none of a model. */
  holdsSamples(contents: string | ArrayBuffer | Uint8Array): boolean;

  /** Samples from the contents of a file, otherwise as {@link model}. */
  samples(contents: string | ArrayBuffer | Uint8Array, path: string): Samples;

  /** The same in parts. Throws for a header that is wrong. */
  sampleReader(contents: string | ArrayBuffer | Uint8Array, path: string): SampleReader;

  /** Tiles of 8 to 2048 pixels; in direction cosines, or in the projection that keeps solid angles. */
  hemisphere(pixels: number, options?: { projection?: "projected" | "lambert" }): Hemisphere;
}

export interface LoadOptions {
  /** The bytes of mmbrdf_module.wasm, for pages that bring them along. Default: they are fetched beside this module. */
  wasm?: ArrayBuffer | Uint8Array;
}

export function load(options?: LoadOptions): Promise<Mmbrdf>;
export default load;
