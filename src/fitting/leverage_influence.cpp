// SPDX-License-Identifier: BSD-3-Clause
// Many fits at the same geometries as products with one matrix. Part of leverage.hpp.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "basis/rows.hpp"
#include "fitting/kernel/influence_kernels.hpp"
#include "mmbrdf/fitting/leverage.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/threads.hpp"

namespace mmbrdf {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// From one element to the next: not a multiple of 4096 bytes, which would be the same lines of the first-level cache.
constexpr std::size_t of_element = influence_geometries * influence_sets + 40;

/// Rows of an element, one for each geometry, over the modes of its block.
MatrixXd rows_at(std::span<const Geometry> geometries, const Rows& rows, std::size_t element, const Basis& basis) {
  MatrixXd result = MatrixXd::Zero(index(geometries.size()), index(rows.columns()));
  FunctionTables tables(std::max(basis.orders.f11, basis.orders.other), basis.mapping, geometries.size());
  for (std::size_t g = 0; g < geometries.size(); ++g) tables.set(g, geometries[g]);
  Rows::add(rows.terms(element), tables.of(geometries.size()), result.data(), geometries.size());
  return result;
}

std::size_t filled_up(std::size_t modes) { return (modes + influence_tile - 1) / influence_tile * influence_tile; }

/// A matrix as the kernel takes it, the columns of some geometries after those of others.
std::vector<double> in_tiles(const MatrixXd& p) {
  const auto modes = static_cast<std::size_t>(p.rows()), columns = static_cast<std::size_t>(p.cols());
  std::vector<double> tiles(filled_up(modes) * columns);
  for (std::size_t first = 0; first < columns; first += influence_geometries) {
    const std::size_t count = std::min(influence_geometries, columns - first);
    double* const to = tiles.data() + filled_up(modes) * first;
    for (std::size_t j = 0; j < modes; ++j)
      for (std::size_t g = 0; g < count; ++g)
        to[(j / influence_tile * count + g) * influence_tile + j % influence_tile] = p(index(j), index(first + g));
  }
  return tiles;
}

void take(const float* const* from, std::size_t each, std::size_t count, const double* weights, double* const* to,
          double* const* squares) {
  best_influence_kernel().take_float(from, each, count, weights, to, squares);
}
void take(const double* const* from, std::size_t each, std::size_t count, const double* weights, double* const* to,
          double* const* squares) {
  best_influence_kernel().take_double(from, each, count, weights, to, squares);
}

}  // namespace

struct Influence::Parts {
  /// Of one element: its part of (Xᵀ W X)⁺ Xᵀ W, in tiles.
  struct OfElement {
    std::size_t element, block, rows;
    std::vector<double> tiles;
  };

  struct OfBlock {
    std::size_t first, modes;  // of its coefficients
    MatrixXd normal;           // Xᵀ W X
    double freedom;
    std::size_t first_row = 0;  // of its sums
  };

  /// Some sets beside each other, and what becomes of them: one for each thread.
  struct Sets {
    std::vector<double> values, sums, squares;  // values of an element after those of another

    Sets(std::size_t elements, std::size_t rows, std::size_t blocks)
        : values(elements * of_element), sums(rows * influence_sets), squares(blocks * influence_sets) {}

    void clear() {
      std::ranges::fill(sums, 0.);
      std::ranges::fill(squares, 0.);
    }
    double* of(std::size_t element) { return values.data() + element * of_element; }
  };

  std::size_t geometries = 0, coefficients = 0;
  bool f11_only = false;
  std::vector<double> weights;  // 16 for each geometry
  Model model;
  std::vector<OfBlock> blocks;
  std::vector<OfElement> elements;  // f11 is the first
  std::size_t sum_rows = 0;         // of all blocks, each filled up

  void add_block(std::size_t b, std::span<const Geometry> where, const Basis& basis, const Solution& solution);
  void order();
  std::size_t each() const { return f11_only ? 1 : 16; }
  template <class Number>
  void sum(const Number* values, std::size_t here, Sets& sets) const;
  void deliver(const Sets& sets, std::size_t set, double* coefficients, double* variances) const;
};

void Influence::Parts::add_block(std::size_t b, std::span<const Geometry> where, const Basis& basis,
                                 const Solution& solution) {
  const Block& block = model.blocks[b].block;
  const Rows rows(block.modes, basis.family);
  const Index n = index(rows.columns());
  const Eigen::Map<const MatrixXd> inverse(solution.inverse.data(), n, n);
  std::vector<MatrixXd> x, p;
  MatrixXd normal = MatrixXd::Zero(n, n), product = MatrixXd::Zero(n, n);
  for (const Element& element : block.elements) {
    x.push_back(rows_at(where, rows, element.index(), basis));
    MatrixXd weighted = x.back().transpose();
    for (std::size_t g = 0; g < geometries; ++g) weighted.col(index(g)) *= weights[16 * g + element.index()];
    normal.noalias() += weighted * x.back();
    p.emplace_back(inverse * weighted);
    product.noalias() += p.back() * x.back();
  }
  for (std::size_t k = 0; k < p.size(); ++k)  // what rounding left is taken away: (2 − P X) P
    elements.push_back({block.elements[k].index(), b, filled_up(rows.columns()), in_tiles(2 * p[k] - product * p[k])});
  blocks.push_back(
      {coefficients, rows.columns(), std::move(normal), static_cast<double>(solution.degrees_of_freedom()), sum_rows});
  sum_rows += filled_up(rows.columns());
  coefficients += rows.columns();
}

Influence::Influence(std::span<const Geometry> geometries, double wavelength, const Basis& basis,
                     std::span<const Mueller> weights, bool f11_only, const FitOptions& options) {
  if (turns(basis))
    throw std::invalid_argument("a fit of the basis germer2017 turns samples: take isotropic, or fit each set alone");
  std::vector<Sample> samples(geometries.size());
  for (std::size_t g = 0; g < samples.size(); ++g) {
    samples[g].wavelength = wavelength;
    samples[g].geometry = geometries[g];
    samples[g].f11 = 1;
    for (std::size_t e = 0; e < 16; ++e)
      samples[g].normalized.elements[e] = e == 0 ? 1 : f11_only ? std::numeric_limits<double>::quiet_NaN() : 0.;
  }
  FitAccumulator accumulator(basis);
  accumulator.add(samples, weights);
  FitOptions plain = options;
  plain.powers = 0;
  plain.reflectance = ReflectanceTable{};
  FitResult result = accumulator.solve(plain);
  auto parts = std::make_shared<Parts>();
  parts->geometries = geometries.size();
  parts->f11_only = f11_only;
  parts->weights.assign(16 * geometries.size(), 1);
  for (std::size_t g = 0; g < weights.size(); ++g) std::ranges::copy(weights[g].elements, &parts->weights[16 * g]);
  parts->model = std::move(result.model);
  for (std::size_t b = 0; b < result.solutions.size(); ++b) {
    parts->add_block(b, geometries, basis, result.solutions[b]);
    parts->model.blocks[b].covariance = result.solutions[b].inverse;
  }
  parts->order();
  parts_ = std::move(parts);
}

std::size_t Influence::geometries() const { return parts_->geometries; }
std::size_t Influence::coefficients() const { return parts_->coefficients; }
const Model& Influence::model() const { return parts_->model; }

void Influence::fit(std::span<const float> values, std::span<double> coefficients, std::span<double> variances,
                    int threads) const {
  fit_all(values, coefficients, variances, threads);
}
void Influence::fit(std::span<const double> values, std::span<double> coefficients, std::span<double> variances,
                    int threads) const {
  fit_all(values, coefficients, variances, threads);
}

void Influence::Parts::order() {
  std::ranges::stable_sort(elements, {}, &OfElement::element);
  if (elements.empty() || elements[0].element != 0) throw std::invalid_argument("a fit without f11");
}

/// `here` sets, at most as many as stand beside each other; lanes that are not used repeat the last of them.
template <class Number>
void Influence::Parts::sum(const Number* values, std::size_t here, Sets& sets) const {
  sets.clear();
  std::array<double*, 16> to{}, squares{};
  for (std::size_t k = 0; k < elements.size(); ++k) {
    to[elements[k].element] = sets.of(k);
    squares[elements[k].element] = sets.squares.data() + elements[k].block * influence_sets;
  }
  const InfluenceKernel& kernel = best_influence_kernel();
  for (std::size_t g = 0; g < geometries; g += influence_geometries) {
    const std::size_t count = std::min(influence_geometries, geometries - g);
    std::array<const Number*, influence_sets> from;
    for (std::size_t s = 0; s < influence_sets; ++s)
      from[s] = values + (std::min(s, here - 1) * geometries + g) * each();
    take(from.data(), each(), count, weights.data() + 16 * g, to.data(), squares.data());
    for (std::size_t k = 0; k < elements.size(); ++k)
      kernel.multiply(elements[k].tiles.data() + elements[k].rows * g, elements[k].rows, count, sets.of(k),
                      sets.sums.data() + blocks[elements[k].block].first_row * influence_sets);
  }
}

void Influence::Parts::deliver(const Sets& sets, std::size_t set, double* to, double* variances) const {
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const OfBlock& block = blocks[b];
    double* const out = to + block.first;
    for (std::size_t j = 0; j < block.modes; ++j) out[j] = sets.sums[(block.first_row + j) * influence_sets + set];
    const Eigen::Map<const Eigen::VectorXd> a(out, index(block.modes));
    const double rest = sets.squares[b * influence_sets + set] - a.dot(block.normal * a);
    variances[b] = block.freedom > 0 ? std::max(rest, 0.) / block.freedom : std::numeric_limits<double>::quiet_NaN();
    if (std::isfinite(rest)) continue;
    std::fill_n(out, block.modes, std::numeric_limits<double>::quiet_NaN());
    variances[b] = std::numeric_limits<double>::quiet_NaN();
  }
}

template <class Number>
void Influence::fit_all(std::span<const Number> values, std::span<double> coefficients, std::span<double> variances,
                        int threads) const {
  const Parts& parts = *parts_;
  const std::size_t size = parts.each() * parts.geometries, count = values.size() / size;
  if (values.size() != count * size || coefficients.size() != count * parts.coefficients ||
      variances.size() != count * parts.blocks.size())
    throw std::invalid_argument(std::to_string(values.size()) + " values, " + std::to_string(coefficients.size()) +
                                " coefficients and " + std::to_string(variances.size()) +
                                " variances are not those of as many sets of " + std::to_string(size) + ", " +
                                std::to_string(parts.coefficients) + " and " + std::to_string(parts.blocks.size()));
  if (threads < 0) throw std::invalid_argument("threads = " + std::to_string(threads) + ", must be 0 or more");
  const std::size_t most = threads == 0 ? std::thread::hardware_concurrency() : static_cast<std::size_t>(threads);
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> no_memory = false;
  const auto work = [&] {
    try {
      Parts::Sets sets(parts.elements.size(), parts.sum_rows, parts.blocks.size());
      for (std::size_t i = next.fetch_add(influence_sets); i < count; i = next.fetch_add(influence_sets)) {
        const std::size_t here = std::min(influence_sets, count - i);
        parts.sum(values.data() + i * size, here, sets);
        for (std::size_t s = 0; s < here; ++s)
          parts.deliver(sets, s, coefficients.data() + (i + s) * parts.coefficients,
                        variances.data() + (i + s) * parts.blocks.size());
      }
    } catch (const std::bad_alloc&) {
      no_memory = true;
    }
  };
  std::vector<std::jthread> others;
  for (std::size_t t = 1; t < std::min(most, count / influence_sets + 1) && started(others, work);) ++t;
  work();
  others.clear();
  if (no_memory) throw std::bad_alloc();
}

}  // namespace mmbrdf
