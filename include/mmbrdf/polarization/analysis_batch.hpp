// SPDX-License-Identifier: BSD-3-Clause
/// Many matrices at once, on several threads: what analysis.hpp and decompositions.hpp say of one, with the same bits,
/// some tens of times faster. Result q is that of matrix q; what is asked of it, and what is refused, is told there.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/polarization/decompositions.hpp"

namespace mmbrdf {

/// What becomes of matrices that the function for one of them refuses, such as one with an element that is NaN.
enum class Refused {
  error,  ///< std::invalid_argument for the first of them, with its place and their number; `out` is then undefined
  nan,    ///< their results are NaN; false for realizable()
};

struct MatricesOptions {
  int threads = 1;  ///< 0: one for each core. Results do not depend on it
  Refused refused = Refused::error;
};

// All return how many matrices were refused, and throw std::invalid_argument if the sizes differ.

std::size_t realizable(std::span<const Mueller> matrices, std::span<bool> out, const MatricesOptions& options = {});
std::size_t depolarization(std::span<const Mueller> matrices, std::span<double> out,
                           const MatricesOptions& options = {});
std::size_t diattenuation(std::span<const Mueller> matrices, std::span<double> out,
                          const MatricesOptions& options = {});
std::size_t polarizance(std::span<const Mueller> matrices, std::span<double> out, const MatricesOptions& options = {});
std::size_t purity(std::span<const Mueller> matrices, std::span<double> out, const MatricesOptions& options = {});
std::size_t entropy(std::span<const Mueller> matrices, std::span<double> out, const MatricesOptions& options = {});
std::size_t realizability_margin(std::span<const Mueller> matrices, std::span<double> out,
                                 const MatricesOptions& options = {});
std::size_t ratios(std::span<const Mueller> matrices, std::span<Ratios> out, const MatricesOptions& options = {});
std::size_t coherency_eigenvalues(std::span<const Mueller> matrices, std::span<std::array<double, 4>> out,
                                  const MatricesOptions& options = {});
std::size_t nearest_realizable(std::span<const Mueller> matrices, std::span<Projection> out,
                               const MatricesOptions& options = {});
std::size_t cloude_decomposition(std::span<const Mueller> matrices, std::span<CloudeDecomposition> out,
                                 const MatricesOptions& options = {});
std::size_t lu_chipman(std::span<const Mueller> matrices, std::span<LuChipman> out,
                       const MatricesOptions& options = {});
std::size_t symmetric_decomposition(std::span<const Mueller> matrices, std::span<SymmetricDecomposition> out,
                                    const MatricesOptions& options = {});

}  // namespace mmbrdf
