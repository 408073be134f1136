// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/variances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "model/kernel/plan.hpp"
#include "numerics/best_kernel.hpp"
#include "numerics/eigen_index.hpp"
#include "uncertainty/variances_some.hpp"

// The row of an element over the parameters is linear in products of functions of both directions. With rows of some
// geometries side by side, h and V, u² = hᵀ V h is a product of matrices of which half is needed, V being symmetric. The
// elements of a block share V and stand side by side too, so that registers are full for a single geometry as well. A
// turn of the axes mixes elements of a group: rows are turned before the product where a block has several of its
// elements, and variances after it where it has one, since blocks are independent.

namespace mmbrdf {

#ifdef MMBRDF_X86
namespace avx512 {
extern const VariancesKernel variances_kernel;
}
namespace avx2 {
extern const VariancesKernel variances_kernel;
}
#endif
namespace baseline {
extern const VariancesKernel variances_kernel;
}

std::span<const VariancesKernel* const> variances_kernels() {
  static constexpr const VariancesKernel* list[] = {
#ifdef MMBRDF_X86
      &avx512::variances_kernel, &avx2::variances_kernel,
#endif
      &baseline::variances_kernel};
  return list;
}

const VariancesKernel& best_variances_kernel() {
  static const VariancesKernel& best = first_that_runs(variances_kernels());
  return best;
}

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool contains(const Group& group, std::size_t element) { return std::ranges::find(group, element) != group.end(); }

MatrixXd scaled(const BlockAt& block) {
  VectorXd scale = VectorXd::Ones(block.covariance.rows());
  scale.head(block.modes()).setConstant(block.reflectance);
  return scale.asDiagonal() * block.covariance * scale.asDiagonal();
}

struct Turn {
  double c, s;
};

void turn(double& x, double& y, const Turn& t) {
  const double a = x, b = y;
  x = t.c * a + t.s * b;
  y = t.c * b - t.s * a;
}

void turn(MuellerCovariance& covariance, const Turn& left, const Turn& right) {
  const auto both_sides = [&](const std::array<std::size_t, 2>& pair, const Turn& t) {
    const auto [x, y] = pair;
    for (std::size_t other = 0; other < 16; ++other) turn(covariance(x, other), covariance(y, other), t);
    for (std::size_t other = 0; other < 16; ++other) turn(covariance(other, x), covariance(other, y), t);
  };
  for (const auto& pair : left_pairs) both_sides(pair, left);
  for (const auto& pair : right_pairs) both_sides(pair, right);
}

}  // namespace

Packed::Packed(const Eigen::Ref<const MatrixXd>& matrix)
    : rows_(rounded_up(matrix.rows(), columns_together)),
      columns_(rounded_up(matrix.cols(), columns_together)),
      values_(size(rows_ * columns_)) {
  for (long j = 0; j < matrix.cols(); ++j)
    for (long k = 0; k < matrix.rows(); ++k)
      values_[size((j / columns_together * rows_ + k) * columns_together + j % columns_together)] = matrix(k, j);
}

MatrixXd symmetric_times(const MatrixXd& v, const MatrixXd& z) {
  const VariancesKernel& kernel = best_variances_kernel();
  const Packed packed(v);
  const Index together = std::min(10 * at_once, rounded_up(z.cols(), kernel.width));
  MatrixXd h = MatrixXd::Zero(together, packed.rows()), out(together, packed.rows()), result(z.rows(), z.cols());
  for (Index first = 0; first < z.cols(); first += together) {
    const Index count = std::min(together, z.cols() - first);
    h.topRows(count).leftCols(z.rows()) = z.middleCols(first, count).transpose();
    kernel.products(out.data(), together, h.data(), packed.view(), rounded_up(count, kernel.width), together);
    result.middleCols(first, count) = out.topRows(count).leftCols(z.rows()).transpose();
  }
  return result;
}

/// Groups of which there are several elements, and all others.
std::vector<Variances::Together> Variances::in_turns(const std::vector<std::size_t>& elements) {
  std::vector<Together> result;
  Together alone;
  for (const std::size_t element : elements) {
    const auto group = std::ranges::find_if(groups, [&](const Group& g) { return contains(g, element); });
    if (group == groups.end() || std::ranges::count_if(elements, [&](auto e) { return contains(*group, e); }) == 1)
      alone.elements.push_back(element);
    else if (std::ranges::find(result, *group, &Together::elements) == result.end())
      result.push_back({*group, true});
  }
  if (!alone.elements.empty()) result.push_back(alone);
  return result;
}

Variances::Row::Row(const BlockAt& block, std::size_t of_element) : element(of_element) {
  std::vector<std::vector<RowTerm>> columns(static_cast<std::size_t>(block.modes()));
  for (const Rows::Term& t : block.rows.terms(element)) {
    const int incident = static_cast<int>(t.incident), reflected = static_cast<int>(t.reflected);
    columns[t.column].push_back({t.weight * table_norm(incident) * table_norm(reflected), incident, reflected});
  }
  for (const auto& list : columns) with.resize(std::max(with.size(), list.size() + 1));
  for (std::size_t count = 0; count < with.size(); ++count)
    for (std::size_t q = 0; q < columns.size(); ++q) {
      if (columns[q].size() != count) continue;
      ++with[count];
      terms.insert(terms.end(), columns[q].begin(), columns[q].end());
      column.push_back(static_cast<int>(q));
      coefficients.push_back(block.coefficients(index(q)));
    }
}

Variances::Variances(std::span<const BlockAt> blocks, int order, DiscMapping mapping, bool turns)
    : order_(order), mapping_(mapping), turns_(turns), hemispherical_(hemispherical(blocks.front(), order, mapping)) {
  for (const BlockAt& block : blocks) {
    OfBlock& of = blocks_.emplace_back(OfBlock{{},
                                               {},
                                               {},
                                               Packed(block.reflectance == 1 ? block.covariance : scaled(block)),
                                               block.modes(),
                                               block.reflectance,
                                               block.knows_reflectance()});
    for (const Element& element : block.elements) {
      of.rows.emplace_back(block, element.index());
      of.all.elements.push_back(element.index());
    }
    of.in_turns = in_turns(of.all.elements);
  }
}

Variances::Hemispherical Variances::hemispherical(const BlockAt& f11, int order, DiscMapping mapping) {
  const KTable integrals = over_hemisphere(mapping);
  MatrixXd of_functions = MatrixXd::Zero(f11.modes() + 1, zernike_count(order));
  for (const Rows::Term& t : f11.rows.terms(0))
    of_functions(index(t.column), index(t.incident)) +=
        t.weight * integrals[t.reflected] * table_norm(static_cast<int>(t.incident));
  of_functions.bottomRows(1) = f11.coefficients.transpose() * of_functions.topRows(f11.modes());
  std::vector<std::size_t> used;
  for (Index f = 0; f < of_functions.cols(); ++f)
    if (!of_functions.col(f).isZero(0)) used.push_back(static_cast<std::size_t>(f));
  MatrixXd slopes(f11.covariance.rows(), index(used.size()));
  for (std::size_t f = 0; f < used.size(); ++f)
    slopes.col(index(f)) = of_functions.col(index(used[f])).head(slopes.rows());
  const MatrixXd covariance = slopes.transpose() * scaled(f11) * slopes;
  return {std::move(used), Packed(covariance)};
}

void Variances::set_functions(Some& some, std::span<const Geometry> geometries) const {
  some.begin(geometries);
  const auto turn = [&](const Geometry& g) { return turns_ ? g.incident.phi : 0; };
  some.set_functions(
      some.k_incident, order_, mapping_, [](const Geometry& g) { return g.incident; }, turn);
  some.set_functions(
      some.k_reflected, order_, mapping_, [](const Geometry& g) { return g.reflected; }, turn);
}

/// Rows of elements, and their values. What is beyond `count` in a whole register is overwritten by the next row.
void Variances::set_rows(Some& some, const OfBlock& block, const Together& together) const {
  const long modes = block.modes, columns = block.covariance.rows();
  double* h = some.begin_rows(together.elements.size(), columns);
  const auto fill_zero = [&](long first) {
    for (long j = first; j < columns; ++j) std::fill_n(h + j * some.row_stride, some.count, 0.0);
  };
  for (const std::size_t element : together.elements) {
    if (const auto row = std::ranges::find(block.rows, element, &Row::element); row == block.rows.end()) {
      fill_zero(0);
    } else {
      some.kernel.rows(h, some.row_stride, some.value.data(), row->view(), some.k_incident.data(),
                       some.k_reflected.data(), some.stride, some.stride);
      for (long g = 0; g < some.stride; ++g) some.m_of(element)[g] = block.reflectance * some.value[size(g)];
      fill_zero(modes);
      if (block.knows_reflectance) std::copy_n(some.value.data(), some.count, h + modes * some.row_stride);
    }
    h += some.count;
  }
}

void Variances::add_variances(Some& some, const OfBlock& block) const {
  const auto add = [&](const Together& together) {
    set_rows(some, block, together);
    if (together.turned) {
      std::array<double*, 16> elements{};
      double* h = some.rows.data();
      for (const std::size_t element : together.elements) elements[element] = std::exchange(h, h + some.count);
      some.turn(elements, block.covariance.rows(), some.row_stride);
    }
    some.kernel.variances(some.of_rows.data(), some.rows.data(), block.covariance.view(), some.row_count,
                          some.row_stride);
    const double* variance = some.of_rows.data();
    for (const std::size_t element : together.elements) {
      if (some.mixes && !together.turned)
        some.spread(element, variance);
      else
        for (long g = 0; g < some.count; ++g) some.variance_of(element)[g] += variance[g];
      variance += some.count;
    }
  };
  if (some.mixes)
    std::ranges::for_each(block.in_turns, add);
  else
    add(block.all);
}

void Variances::standard_uncertainties(std::span<const Geometry> geometries, Frame frame,
                                       std::span<Mueller> out) const {
  Some some;
  alignas(64) std::array<double, 16 * at_once> deviations;
  for (std::size_t first = 0; first < geometries.size(); first += size(at_once)) {
    set_functions(some, geometries.subspan(first));
    some.set_turn(frame, turns_);
    for (const OfBlock& block : blocks_) add_variances(some, block);
    if (some.mixes) {
      std::array<double*, 16> elements;
      for (std::size_t e = 0; e < 16; ++e) elements[e] = some.m_of(e);
      some.turn(elements, 1, some.stride);
    }
    some.kernel.deviations(deviations.data(), some.m.data(), some.variances.data(), some.stride, some.stride);
    for (long g = 0; g < some.count; ++g)
      std::copy_n(deviations.begin() + 16 * g, 16, out[first + size(g)].elements.begin());
  }
}

void Variances::covariances(Of what, std::span<const Geometry> geometries, Frame frame,
                            std::span<MuellerCovariance> out) const {
  struct Pair {
    std::size_t a, b;
  };
  std::vector<Pair> pairs;  // within a block, in the order of their covariances
  for (const OfBlock& block : blocks_)
    for (std::size_t b = 0; b < block.rows.size(); ++b)
      for (std::size_t a = 0; a <= b; ++a) pairs.push_back({block.rows[a].element, block.rows[b].element});
  Some some;
  for (std::size_t first = 0; first < geometries.size(); first += size(at_once)) {
    set_functions(some, geometries.subspan(first));
    some.set_turn(frame, turns_);
    some.covariances.reserve(pairs.size() * size(some.stride));
    double* next = some.covariances.data();
    for (const OfBlock& block : blocks_) {
      set_rows(some, block, block.all);
      const long columns = block.covariance.rows();
      some.products.reserve(size(columns * some.row_stride));
      const double *const h = some.rows.data(), *const products = some.products.data();
      some.kernel.products(some.products.data(), some.row_stride, h, block.covariance.view(), some.row_count,
                           some.row_stride);
      const auto count = static_cast<long>(block.rows.size());
      for (long b = 0; b < count; ++b)
        for (long a = 0; a <= b; ++a, next += some.stride)
          some.kernel.dots(next, h + a * some.count, products + b * some.count, columns, some.count, some.row_stride);
    }
    for (long g = 0; g < some.count; ++g) {
      MuellerCovariance& result = out[first + size(g)];
      std::array<double, 16> slopes{1};  // over f11
      for (std::size_t e = 1; e < 16; ++e) slopes[e] = what == Of::matrix ? some.m_of(e)[g] : 0;
      const double f11 = what == Of::matrix ? some.m_of(0)[g] : 1, *of_pair = some.covariances.data() + g;
      const double v11 = *of_pair;
      for (std::size_t e = 0; e < 16; ++e)
        for (std::size_t other = 0; other < 16; ++other) result(e, other) = slopes[e] * slopes[other] * v11;
      for (std::size_t p = 1; p < pairs.size(); ++p) {
        const auto [a, b] = pairs[p];
        const double direct = f11 * f11 * of_pair[static_cast<long>(p) * some.stride];
        result(a, b) += direct;
        if (a != b) result(b, a) += direct;
      }
      const auto at = size(g);
      if (some.mixes) turn(result, {some.left_c[at], some.left_s[at]}, {some.right_c[at], some.right_s[at]});
    }
  }
}

/// The normalised matrices, turned: f11 over R, and the other elements. What is beyond the last of a block in a whole
/// register is overwritten by the next.
void Variances::set_drawn(Some& some, const Drawn& drawn) const {
  const auto draws = static_cast<long>(drawn.reflectances.size());
  double* next = some.begin_drawn(rounded_up(draws, columns_together));
  some.drawn_of.fill(nullptr);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Together& all = blocks_[b].all;
    set_rows(some, blocks_[b], all);
    some.kernel.products(next, some.drawn_stride, some.rows.data(), drawn.blocks[b].view(), some.row_count,
                         some.row_stride);
    for (const std::size_t element : all.elements) some.drawn_of[element] = std::exchange(next, next + some.count);
  }
  for (double*& absent : some.drawn_of) {
    if (absent) continue;
    absent = std::exchange(next, next + some.count);
    for (long d = 0; d < draws; ++d) std::fill_n(absent + d * some.drawn_stride, some.count, 0.0);
  }
  if (some.mixes) some.turn(some.drawn_of, draws, some.drawn_stride);
}

void Variances::matrices(const Drawn& drawn, std::span<const Geometry> geometries, Frame frame,
                         std::span<Mueller> out) const {
  Some some;
  const std::size_t draws = drawn.reflectances.size();
  for (std::size_t first = 0; first < geometries.size(); first += size(at_once)) {
    set_functions(some, geometries.subspan(first));
    some.set_turn(frame, turns_);
    set_drawn(some, drawn);
    for (std::size_t d = 0; d < draws; ++d)
      for (long g = 0; g < some.count; ++g) {
        const long at = static_cast<long>(d) * some.drawn_stride + g;
        Mueller& m = out[(first + size(g)) * draws + d];
        const double f11 = drawn.reflectances[d] * some.drawn_of[0][at];
        for (std::size_t e = 0; e < 16; ++e) m.elements[e] = f11 * some.drawn_of[e][at];
        m.elements[0] = f11;
      }
  }
}

void Variances::directional_hemispherical(std::span<const Direction> incident, std::span<double> out) const {
  Some some;
  std::array<Geometry, size(at_once)> asked;
  const Packed& covariance = hemispherical_.covariance;
  for (std::size_t first = 0; first < incident.size(); first += size(at_once)) {
    const std::size_t count = std::min(incident.size() - first, size(at_once));
    for (std::size_t g = 0; g < count; ++g) asked[g] = {incident[first + g], {}};
    some.begin({asked.data(), count});
    some.set_functions(
        some.k_incident, order_, mapping_, [](const Geometry& g) { return g.incident; },
        [&](const Geometry& g) { return turns_ ? g.incident.phi : 0; });
    some.rows.reserve(size(covariance.rows() * some.stride));
    double* to = some.rows.data();
    for (const std::size_t f : hemispherical_.functions)
      to = std::copy_n(some.k_incident.data() + static_cast<long>(f) * some.stride, some.stride, to);
    std::fill(to, some.rows.data() + covariance.rows() * some.stride, 0.0);
    some.kernel.variances(some.value.data(), some.rows.data(), covariance.view(), some.stride, some.stride);
    for (std::size_t g = 0; g < count; ++g) out[first + g] = std::sqrt(std::max(some.value[g], 0.0));
  }
}

}  // namespace mmbrdf
