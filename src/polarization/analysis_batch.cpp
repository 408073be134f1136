// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/analysis_batch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "numerics/threads.hpp"
#include "polarization/kernel/analysis_kernels.hpp"
#include "polarization/refusals.hpp"

namespace mmbrdf {
namespace {

constexpr std::size_t block = 256;  // matrices: they stay in the cache

/// The numbers of a result, as the kernel writes them.
template <class Result>
double* numbers(Result* first) {
  static_assert(sizeof(Result) % sizeof(double) == 0 && std::is_standard_layout_v<Result>);
  return reinterpret_cast<double*>(first);
}

/// Whether the function for one matrix refuses it, as far as that is quickly said: to throw takes microseconds.
template <Analysis analysis>
bool is_plainly_refused(const Mueller& m) {
  if (!std::ranges::all_of(m.elements, [](double element) { return std::isfinite(element); })) return true;
  switch (analysis) {
    case Analysis::realizable:
    case Analysis::coherency_eigenvalues:
    case Analysis::cloude_decomposition:
      return false;
    case Analysis::nearest_realizable:
      return m(0, 0) < 0;
    case Analysis::lu_chipman:
    case Analysis::symmetric_decomposition:
      return !(m(0, 0) > 0) || !realizable(m);
    default:
      return !(m(0, 0) > 0);
  }
}

/// Results of matrices first … first + count − 1; those that the kernel leaves are asked for one by one.
template <Analysis analysis, class Result>
void run_block(std::span<const Mueller> matrices, Result* out, std::size_t first, Result (*one)(const Mueller&),
               Refusals& refusals) {
  static_assert(sizeof(Result) == sizeof(double) * numbers_of[static_cast<std::size_t>(analysis)]);
  unsigned char left[block];
  if (!best_analysis_kernel().run(analysis, matrices[0].elements.data(), matrices.size(), numbers(out), left)) return;
  for (std::size_t q = 0; q < matrices.size(); ++q) {
    if (left[q] == 0) continue;
    bool refused = is_plainly_refused<analysis>(matrices[q]);
    try {
      if (!refused) out[q] = one(matrices[q]);
    } catch (const std::invalid_argument&) {
      refused = true;
    }
    if (!refused) continue;
    refusals.add(first + q);
    std::fill_n(numbers(out + q), sizeof(Result) / sizeof(double), std::numeric_limits<double>::quiet_NaN());
  }
}

/// `store(first, count, run)` gives run(out) room for the results of a block and takes them.
template <Analysis analysis, class Result, class Store>
std::size_t in_blocks(std::span<const Mueller> matrices, std::size_t results, Result (*one)(const Mueller&),
                      const MatricesOptions& options, Store store) {
  if (results != matrices.size())
    throw std::invalid_argument(std::to_string(matrices.size()) + " matrices, " + std::to_string(results) + " results");
  Refusals refusals;
  in_parts(matrices.size(), options.threads, [&](std::size_t begin, std::size_t count) {
    for (std::size_t first = begin; first < begin + count; first += block) {
      const std::size_t here = std::min(block, begin + count - first);
      store(first, here, [&](Result* out) {
        run_block<analysis, Result>(matrices.subspan(first, here), out, first, one, refusals);
      });
    }
  });
  if (refusals.count > 0 && options.refused == Refused::error) {
    const std::size_t first = refusals.first;
    try {
      one(matrices[first]);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(refusals.message("matrix", error.what(), matrices.size()));
    }
  }
  return refusals.count;
}

template <Analysis analysis, class Result>
std::size_t run(std::span<const Mueller> matrices, std::span<Result> out, Result (*one)(const Mueller&),
                const MatricesOptions& options) {
  return in_blocks<analysis, Result>(matrices, out.size(), one, options,
                                     [&](std::size_t first, std::size_t, auto answer) { answer(&out[first]); });
}

}  // namespace

std::size_t realizable(std::span<const Mueller> matrices, std::span<bool> out, const MatricesOptions& options) {
  double (*const one)(const Mueller&) = [](const Mueller& m) { return realizable(m) ? 1.0 : 0.0; };
  return in_blocks<Analysis::realizable, double>(matrices, out.size(), one, options,
                                                 [&](std::size_t first, std::size_t count, auto answer) {
                                                   double is[block];
                                                   answer(is);
                                                   for (std::size_t q = 0; q < count; ++q) out[first + q] = is[q] == 1;
                                                 });
}

std::size_t depolarization(std::span<const Mueller> matrices, std::span<double> out, const MatricesOptions& options) {
  return run<Analysis::depolarization, double>(matrices, out, depolarization, options);
}

std::size_t diattenuation(std::span<const Mueller> matrices, std::span<double> out, const MatricesOptions& options) {
  return run<Analysis::diattenuation, double>(matrices, out, diattenuation, options);
}

std::size_t polarizance(std::span<const Mueller> matrices, std::span<double> out, const MatricesOptions& options) {
  return run<Analysis::polarizance, double>(matrices, out, polarizance, options);
}

std::size_t purity(std::span<const Mueller> matrices, std::span<double> out, const MatricesOptions& options) {
  return run<Analysis::purity, double>(matrices, out, purity, options);
}

std::size_t entropy(std::span<const Mueller> matrices, std::span<double> out, const MatricesOptions& options) {
  return run<Analysis::entropy, double>(matrices, out, entropy, options);
}

std::size_t realizability_margin(std::span<const Mueller> matrices, std::span<double> out,
                                 const MatricesOptions& options) {
  return run<Analysis::realizability_margin, double>(matrices, out, realizability_margin, options);
}

std::size_t ratios(std::span<const Mueller> matrices, std::span<Ratios> out, const MatricesOptions& options) {
  return run<Analysis::ratios, Ratios>(matrices, out, ratios, options);
}

std::size_t coherency_eigenvalues(std::span<const Mueller> matrices, std::span<std::array<double, 4>> out,
                                  const MatricesOptions& options) {
  return run<Analysis::coherency_eigenvalues, std::array<double, 4>>(matrices, out, coherency_eigenvalues, options);
}

std::size_t nearest_realizable(std::span<const Mueller> matrices, std::span<Projection> out,
                               const MatricesOptions& options) {
  return run<Analysis::nearest_realizable, Projection>(matrices, out, nearest_realizable, options);
}

std::size_t cloude_decomposition(std::span<const Mueller> matrices, std::span<CloudeDecomposition> out,
                                 const MatricesOptions& options) {
  return run<Analysis::cloude_decomposition, CloudeDecomposition>(matrices, out, cloude_decomposition, options);
}

std::size_t lu_chipman(std::span<const Mueller> matrices, std::span<LuChipman> out, const MatricesOptions& options) {
  return run<Analysis::lu_chipman, LuChipman>(matrices, out, lu_chipman, options);
}

std::size_t symmetric_decomposition(std::span<const Mueller> matrices, std::span<SymmetricDecomposition> out,
                                    const MatricesOptions& options) {
  return run<Analysis::symmetric_decomposition, SymmetricDecomposition>(matrices, out, symmetric_decomposition,
                                                                        options);
}

}  // namespace mmbrdf
