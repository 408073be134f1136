// SPDX-License-Identifier: BSD-3-Clause
/// The evaluation kernel: what model.cpp asks of it. Its sources (kernel.cpp and kernel_*.hpp) are compiled once for
/// each instruction set; kernels.cpp lists them and chooses. This header is what both sides see: plain data, nothing
/// inline.
#pragma once

#include <stddef.h>

namespace mmbrdf {

/// How the coefficients of a model are arranged.
enum class Form {
  isotropic,   ///< the isotropic family up to orders 7, 4: kernel_isotropic.hpp
  germer2017,  ///< the published index sets up to orders 7, 4: kernel_germer2017.hpp
  pairs,       ///< any list of products: kernel_pairs.hpp
  // One incident direction, kernel_incidence.hpp:
  plane,      ///< isotropic samples up to orders 7, 4
  functions,  ///< any: coefficient 16 j + e is that of function j in element e
};

/// Frame of geometry.hpp, which no kernel may include; and its parallel_limit.
enum class KernelFrame { xy, sp, scattering_plane };
inline constexpr double kernel_parallel_limit = 1e-8;

/// S, D = K_a(i) K_b(r) ± K_b(i) K_a(r), without the norms of K; positions are those of zernike_index.
struct KernelPair {
  int a, b;
};

/// Pairs begin … end feed the same sums: `sums` over S, then `differences` over D, at most 4 of each. Their
/// coefficients follow each other, pair by pair. The sum over S of element ij, i ≤ j, is number 4i + j, that over D
/// number 4j + i.
struct PairRun {
  int begin, end, coefficients;
  int sums, differences;
  int target[8];
};

inline constexpr int max_table = 861;  // zernike_count(max_order)

struct PairList {
  int order;  ///< of the table of K
  const KernelPair* pairs;
  const PairRun* runs;
  int count;  ///< of runs
};

/// A model at one wavelength, or at all.
template <class T>
struct KernelModel {
  Form form;
  bool projected;         ///< disc mapping
  bool turned;            ///< evaluate at phi_i = 0 and turn the result
  KernelFrame frame;      ///< of the matrices
  T turned_by[2];         ///< cos phi_i and sin phi_i, of the forms for one incident direction
  T incident[5];          ///< theta_i, phi_i and x, y, z of that direction, for frames other than xy
  PairList list;          ///< of Form::pairs
  const T* coefficients;  ///< power after power
  int powers;             ///< highest power of the wavelength; 0 if it is folded in
  int count;              ///< of coefficients for each power
  T scale;                ///< of f11
};

/// Number q of column j is column[j][q × stride].
template <class T>
struct KernelPoints {
  bool angles;  ///< theta_i, phi_i, theta_r, phi_r with |phi| ≤ max_azimuth; else x, y, z of both unit vectors. The
                ///< forms for one incident direction have no columns for it.
  const T* column[6];
  ptrdiff_t stride;
  const T* wavelength;  ///< of each point; null if it is folded in
  const T* scale;       ///< the same for the factor of f11
};

/// Element e of point q goes to element[e][q × stride]. The stride is 1, for one array for each element, or 16, for one
/// matrix after the other.
template <class T>
struct KernelMatrices {
  T* element[16];
  ptrdiff_t stride;
};

/// Azimuths beyond it lose digits: the products of their quarter turns with the first part of π/2 are not exact.
inline constexpr double max_azimuth = 1e6;

/// Tables of the map from the unit square to reflected directions (theory 5.3), one for each incident direction: of all
/// azimuths of the first rho = √(1 − cos theta_i), then of the second … The first row of a table is sin² theta_r at each step
/// of u1; the others, one for each of these, are the azimuths at each step of u2, as shares of their range.
struct SamplingTables {
  /// Powers of two, so that u < 1 stays within the last step.
  static constexpr int steps = 32, incident_steps = 32, incident_azimuths = 32;
  /// Rows follow each other. Where one begins, as many numbers as fill Packs are in the table, which fills Packs, too.
  static constexpr int row = steps + 1, padded_row = (row + 7) / 8 * 8;
  static constexpr int size = ((steps + 1) * row + padded_row + 7) / 8 * 8;

  const double* numbers;
  bool folded;            ///< f11 depends on phi_r − phi_i alone, and not on its sign: one azimuth, half of the range
  bool of_one_incidence;  ///< the one table that Kernel::table() made of an incident direction
};

/// Some of what is drawn, one column after the other.
struct SamplingBlock {
  static constexpr size_t size = 64, multiple = 8;  ///< of more than one all to the next multiple must be valid

  bool angles;
  double incident[3][size];  ///< theta_i, phi_i; or x, y, z
  double u[2][size];
  double reflected[3][size];  ///< theta_r, phi_r − phi_i in [−π, π]; or x, y, z
  double pdf[size];
};

/// The same functions for one instruction set. What they compute for a point does not depend on its neighbours.
struct Kernel {
  const char* name;
  bool (*runs_here)();
  void (*evaluate)(const KernelModel<double>&, const KernelPoints<double>&, const KernelMatrices<double>&,
                   size_t count);
  void (*evaluate_single)(const KernelModel<float>&, const KernelPoints<float>&, const KernelMatrices<float>&,
                          size_t count);
  /// The coefficients of a model of all powers at one wavelength, with the bits that evaluate() finds there.
  void (*fold)(const KernelModel<double>&, double wavelength, double* out);
  /// Of vectors x, y, z: the first that has not length 1 to 1e-6 or not z ≥ 0; count if all have.
  size_t (*first_invalid)(const double* const vectors[3], size_t count);
  size_t (*first_invalid_single)(const float* const vectors[3], size_t count);
  /// Directions of a block, with their pdf per solid angle.
  void (*draw)(const SamplingTables&, SamplingBlock&, size_t count);
  /// The pdf of the first reflected direction of a block, per solid angle.
  void (*pdf)(const SamplingTables&, SamplingBlock&);
  /// The table of the first incident direction of a block, from which draw() has the same bits in less time.
  void (*table)(const SamplingTables&, const SamplingBlock&, double* out);
};

}  // namespace mmbrdf
