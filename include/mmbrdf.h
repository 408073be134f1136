/* SPDX-License-Identifier: BSD-3-Clause */
/* mmbrdf from C, and from all that calls C: evaluates models of Mueller-matrix BRDFs. C99.
 *
 *   mmbrdf_error error;
 *   mmbrdf_model* model = NULL;
 *   mmbrdf_prepared* at_532 = NULL;
 *   const double geometry_rad[4] = {0.785, 0, 0.524, 3.1416};
 *   double matrix[16];
 *   if (mmbrdf_material("ptfe", &model, &error) || mmbrdf_prepare(model, 0.532, &at_532, &error) ||
 *       mmbrdf_evaluate(at_532, 1, geometry_rad, NULL, 1, matrix, &error))
 *     fprintf(stderr, "%s\n", error.message);
 *   mmbrdf_free_prepared(at_532);
 *   mmbrdf_free_model(model);
 *
 * Units: angles in radians, wavelengths in micrometres, BRDFs in sr^-1; each name says it. A wavelength of 532 is one of
 * 532 000 nm and no error: mmbrdf_outside tells. Directions point away from the sample, to the source and to the detector;
 * phi is counted from x towards y, and forward is phi_r - phi_i = pi. More is in docs/conventions.md.
 *
 * A geometry is four numbers: theta_i, phi_i (to the source), theta_r, phi_r (to the detector); thetas in [0, pi/2]. n of
 * them stand one behind the other, and so do their results. n = 0 asks for nothing, and pointers may be null then.
 *
 * Functions that can fail return a code, MMBRDF_OK = 0, and fill *error unless that is null. After a failure handles are
 * null, and what other results hold is not defined. Messages count geometries from 1.
 *
 * What was not measured is unknown: NaN, and so are uncertainties that nobody knows. Nothing else is NaN.
 *
 * There is no global state. Handles may be used in any number of threads at once, but freed in one only. `threads` is
 * for one call: 1 for the calling thread alone, 0 for one on each core; results do not depend on it. */
#pragma once

#include <stdint.h>

/* Of this header; mmbrdf_version() is that of the library. Before 1.0 both must have the same major and minor number. */
#define MMBRDF_VERSION_MAJOR 0
#define MMBRDF_VERSION_MINOR 1
#define MMBRDF_VERSION_PATCH 0
#define MMBRDF_VERSION "0.1.0"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- errors -------------------------------------------------------------------------------------------------------*/

enum {
  MMBRDF_OK = 0,
  MMBRDF_INVALID_ARGUMENT = 1, /* the caller's mistake: the message names the value */
  MMBRDF_FAILED = 2,           /* the world's: a file that is not there, or is wrong; the message has file and line */
  MMBRDF_OUT_OF_MEMORY = 3,
  MMBRDF_INTERNAL = 4 /* a mistake of the library: please report it */
};

/* In the caller's memory. */
typedef struct mmbrdf_error {
  int code;
  char message[500]; /* one line, ends with 0; empty if code is 0. What is longer ends with "..." */
} mmbrdf_error;

/* ---- models -------------------------------------------------------------------------------------------------------*/

typedef struct mmbrdf_model mmbrdf_model;
typedef struct mmbrdf_prepared mmbrdf_prepared; /* a model at one wavelength; it needs the model no more */

const char* mmbrdf_version(void);

/* Built-in models: number 0 ... mmbrdf_material_count() - 1; null for another number. */
int mmbrdf_material_count(void);
const char* mmbrdf_material_name(int number);

/* A built-in model by its name, and one from a file: JSON, or published coefficients. */
int mmbrdf_material(const char* name, mmbrdf_model** model, mmbrdf_error* error);
int mmbrdf_load_model(const char* path, mmbrdf_model** model, mmbrdf_error* error);

int mmbrdf_prepare(const mmbrdf_model* model, double wavelength_um, mmbrdf_prepared** prepared, mmbrdf_error* error);

/* Null is nothing to free. */
void mmbrdf_free_model(mmbrdf_model* model);
void mmbrdf_free_prepared(mmbrdf_prepared* prepared);

/* What a model says of itself. The pointers are valid as long as the model is. */
typedef struct mmbrdf_description {
  const char* name;
  const char* basis;           /* in words: "isotropic, orders 7,4, ..." */
  const char* fitted_range;    /* in words: "theta_i <= 75, theta_r <= 81.87 degrees at 351, 532 nm" */
  const double* wavelength_um; /* at which it was fitted, rising */
  int wavelengths;             /* how many; 0: not known */
  double theta_i_max_rad;      /* largest of the fit; NaN: not known */
  double theta_r_max_rad;
  int has_uncertainty; /* 1: the uncertainties of what it predicts are known */
} mmbrdf_description;

int mmbrdf_describe(const mmbrdf_model* model, mmbrdf_description* description, mmbrdf_error* error);

/* ---- matrices -----------------------------------------------------------------------------------------------------*/

/* How matrices are written. Null stands for all zeros: frame xy, convention of Germer 2017, row by row. */
typedef struct mmbrdf_layout {
  int frame;
  int convention;
  int order;
} mmbrdf_layout;

/* Axes of Stokes vectors, by z, the normal, and k, the way the light goes. xy: (y, x) at the normal, carried along the
 * meridian to the beam. sp: s = z x k / |z x k|, p = k x s; at theta = 0 s follows the phi that was given.
 * scattering_plane: across, k_in x k_out / |k_in x k_out| of both beams (s where that is 0), and along, k x across. */
enum { MMBRDF_XY = 0, MMBRDF_SP = 1, MMBRDF_SCATTERING_PLANE = 2 };

/* Stokes vectors: which axis comes first, and the sign of the fourth component. */
enum {
  MMBRDF_GERMER2017 = 0,                    /* s first, left - right */
  MMBRDF_S_FIRST_RIGHT = 1,                 /* s first, right - left */
  MMBRDF_P_FIRST_LEFT = 2,                  /* axes (p, -s), left - right */
  MMBRDF_P_FIRST_RIGHT = 3,                 /* axes (p, -s), right - left */
  MMBRDF_P_FIRST_LEFT_HANDED_AXES_LEFT = 4, /* axes (p, s), a left-handed pair; avoid */
  MMBRDF_P_FIRST_LEFT_HANDED_AXES_RIGHT = 5 /* axes (p, s), a left-handed pair; avoid */
};

/* Element in row i (scattered) and column j (incident light), from 0, of matrix q is */
enum {
  MMBRDF_ROW_MAJOR = 0,   /* matrices[16 q + 4 i + j]: matrices[q][i][j] in C */
  MMBRDF_COLUMN_MAJOR = 1 /* matrices[16 q + i + 4 j]: matrices(i, j, q) in Fortran, R and Octave */
};

/* A layout from names: "xy", "sp", "scattering_plane"; "germer2017", "s_first_right" ...; and one of the two orders. */
int mmbrdf_layout_from(const char* frame, const char* convention, int order, mmbrdf_layout* layout,
                       mmbrdf_error* error);

/* known[e] is 1, or 0 where element e of such matrices was not measured and is NaN. */
int mmbrdf_known_elements(const mmbrdf_model* model, const mmbrdf_layout* layout, int known[16], mmbrdf_error* error);

/* The Mueller BRDF: 16 n numbers in sr^-1. */
int mmbrdf_evaluate(const mmbrdf_prepared* prepared, int64_t n, const double* geometries_rad,
                    const mmbrdf_layout* layout, int threads, double* matrices, mmbrdf_error* error);

/* Standard uncertainties (k = 1) of these 16 n numbers in sr^-1. */
int mmbrdf_standard_uncertainty(const mmbrdf_prepared* prepared, int64_t n, const double* geometries_rad,
                                const mmbrdf_layout* layout, int threads, double* uncertainties, mmbrdf_error* error);

/* Element 11 alone, the BRDF for unpolarized light: n numbers in sr^-1. */
int mmbrdf_f11(const mmbrdf_prepared* prepared, int64_t n, const double* geometries_rad, int threads, double* f11,
               mmbrdf_error* error);

/* Whether a geometry or the wavelength is outside of what the model was fitted to: for each geometry 0, or a sum of */
enum {
  MMBRDF_OUTSIDE_THETA_I = 1,
  MMBRDF_OUTSIDE_THETA_R = 2,
  MMBRDF_OUTSIDE_WAVELENGTH = 4,
  MMBRDF_UNKNOWN_RANGE = 8,       /* the model does not say */
  MMBRDF_OUTSIDE_DIRECTIONS = 16, /* no samples support these directions together */
  MMBRDF_INTERPOLATED = 32        /* not outside: between two fitted wavelengths */
};
int mmbrdf_outside(const mmbrdf_prepared* prepared, int64_t n, const double* geometries_rad, int* outside,
                   mmbrdf_error* error);

/* ---- derived quantities -------------------------------------------------------------------------------------------*/

/* The table of quantities (docs/formats.md), but for those that take light: number 0 ... mmbrdf_quantity_count() - 1. */
typedef struct mmbrdf_quantity {
  const char* name;    /* "f_ss" */
  const char* unit;    /* "sr^-1"; empty for a ratio */
  const char* meaning; /* a line of words */
} mmbrdf_quantity;

int mmbrdf_quantity_count(void);
int mmbrdf_quantity_at(int number, mmbrdf_quantity* quantity, mmbrdf_error* error);

/* `count` quantities by name, or all of the table if names is null, with their standard uncertainties in first order:
 * count x n numbers each, values[n k + q] of quantity k at geometry q. uncertainties may be null. NaN also where a
 * quantity has no meaning, as a ratio where f11 is not positive. All quantities and their uncertainties are computed whatever
 * is asked for, in about 0.1 ms a geometry, so ask once for all; the first call prepares for seconds. */
int mmbrdf_analyze(const mmbrdf_prepared* prepared, int count, const char* const* names, int64_t n,
                   const double* geometries_rad, int threads, double* values, double* uncertainties,
                   mmbrdf_error* error);

/* Directional-hemispherical reflectance for unpolarized light from n directions, theta_i and phi_i of each: n numbers, and
 * their standard uncertainties, which may be null. */
int mmbrdf_dhr(const mmbrdf_prepared* prepared, int64_t n, const double* directions_rad, double* dhr,
               double* uncertainties, mmbrdf_error* error);

#ifdef __cplusplus
}
#endif
