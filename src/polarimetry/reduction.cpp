// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/reduction.hpp"

// A reading is a row (a ⊗ w)ᵀ of a matrix H, times the sixteen elements; its pseudo-inverse solves. That of a grid of
// states that has rank four in each arm is the product of those of the arms.
#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "mmbrdf/uncertainty/prediction.hpp"
#include "numerics/dense.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/semidefinite.hpp"
#include "numerics/threads.hpp"
#include "polarimetry/columns.hpp"
#include "polarimetry/kernel/reduction_kernels.hpp"
#include "polarization/refusals.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Reduction::Solution {
  Polarimeter polarimeter;
  MatrixXd rows;     ///< H, readings × 16
  MatrixXd inverse;  ///< H⁺, to the last digit: no step of refinement is needed where it is used
  Elements undetermined;
  int rank = 16;
  double condition = 1;
  MatrixXd covariance;  ///< of the instrument; 0 × 0: none
  MatrixXd errors;      ///< its square root: an independent error in each column
};

namespace {

constexpr double rounding = 1e-10;  // singular values below this part of the largest say nothing

void require_usable(const Polarimeter& polarimeter) {
  for (const std::vector<Stokes>* states : {&polarimeter.generator, &polarimeter.analyzer}) {
    const std::string arm = states == &polarimeter.generator ? "generator: " : "analyzer: ";
    if (states->empty()) throw std::invalid_argument(arm + "no states");
    if (states->size() > most_states)
      throw std::invalid_argument(arm + std::to_string(states->size()) + " states, at most " +
                                  std::to_string(most_states) + " can be used");
    if (!columns(*states).allFinite()) throw std::invalid_argument(arm + "a state is not finite");
  }
  reading(polarimeter, polarimeter.pairs);  // throws for those that are not there
}

/// Of H, as of its rows.
struct Inverse {
  MatrixXd matrix;
  Elements undetermined;
  int rank = 16;
  double condition = 1;
};

Inverse of_arms(const dense::Svd& generator, const dense::Svd& analyzer, double condition) {
  const auto inverse = [](const dense::Svd& svd) {
    return MatrixXd(svd.v * svd.s.cwiseInverse().asDiagonal() * svd.u.transpose());
  };
  const MatrixXd w = inverse(generator), a = inverse(analyzer).transpose();
  Inverse result{MatrixXd(16, w.rows() * a.cols()), {}, 16, condition};
  for (Index q = 0; q < a.cols(); ++q)
    for (Index p = 0; p < w.rows(); ++p)
      for (Index e = 0; e < 16; ++e) result.matrix(e, q * w.rows() + p) = a(e / 4, q) * w(p, e % 4);
  return result;
}

MatrixXd rows_of(const Polarimeter& polarimeter) {
  MatrixXd h(index(polarimeter.readings()), 16);
  for (std::size_t j = 0; j < polarimeter.readings(); ++j) {
    const auto [p, q] = polarimeter.pair(j);
    for (std::size_t e = 0; e < 16; ++e)
      h(index(j), index(e)) = polarimeter.analyzer[q][e / 4] * polarimeter.generator[p][e % 4];
  }
  return h;
}

Inverse of_rows(const MatrixXd& rows) {
  MatrixXd h = MatrixXd::Zero(std::max<Index>(rows.rows(), 16), 16);  // rows of 0 for all of V
  h.topRows(rows.rows()) = rows;
  const auto [u, v, s] = dense::thin_svd(h);
  const Index readings = rows.rows();
  Inverse result{MatrixXd::Zero(16, readings), {}, 0, 1};
  // One state that is brighter than the others takes nothing from what these determine.
  VectorXd norms = h.topRows(readings).rowwise().norm();
  std::nth_element(norms.begin(), norms.begin() + readings / 2, norms.end());
  const double typical = std::min(s(0), norms(readings / 2) * std::sqrt(static_cast<double>(readings)));
  VectorXd amplified = VectorXd::Constant(16, 1 / rounding);
  for (Index k = 0; k < s.size() && s(k) > rounding * s(0); ++k) {
    result.matrix += v.col(k) * (u.col(k).head(readings).transpose() / s(k));
    amplified(k) = typical / s(k);
    result.rank = static_cast<int>(k) + 1;
    result.condition = s(0) / s(k);
  }
  for (Index e = 0; e < 16; ++e)
    result.undetermined[static_cast<std::size_t>(e)] =
        v.row(e).transpose().cwiseProduct(amplified).norm() > most_amplified;
  return result;
}

Inverse inverse_of(const Polarimeter& polarimeter, const MatrixXd& rows) {
  if (polarimeter.pairs.empty() && polarimeter.generator.size() >= 4 && polarimeter.analyzer.size() >= 4) {
    const dense::Svd generator = dense::thin_svd(columns(polarimeter.generator));
    const dense::Svd analyzer = dense::thin_svd(columns(polarimeter.analyzer));
    const double condition = generator.s(0) / generator.s(3) * (analyzer.s(0) / analyzer.s(3));
    if (condition <= most_amplified) return of_arms(generator, analyzer, condition);
  }
  return of_rows(rows);
}

/// What rounding of the decompositions left of X = H⁺ is taken away by one step of Newton's method, (2 I − X H) X, which is
/// what a step of iterative refinement would do to each solution.
void refine(MatrixXd& inverse, const MatrixXd& rows) {
  using Extended = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Extended x = inverse.cast<long double>();
  Extended step = -x.lazyProduct(rows.cast<long double>());
  step.diagonal().array() += 2;
  inverse = step.lazyProduct(x).cast<double>();
}

MuellerCovariance covariance_of(const MatrixXd& matrix, const Elements& undetermined) {
  MuellerCovariance result;
  Eigen::Map<RowMajor>(result.values.data(), 16, 16) = (matrix + matrix.transpose()) / 2;
  set_unknown(result, undetermined);
  return result;
}

constexpr const char* not_finite = "a reading is not finite";

template <class Number>
bool all_finite(std::span<const Number> readings) {
  return std::ranges::all_of(readings, [](Number reading) { return std::isfinite(reading); });
}

bool run(const double* inverse, std::size_t n, const double* from, std::size_t count, double* to, double*) {
  return best_reduction_kernel().run_double(inverse, n, from, count, to);
}
bool run(const double* inverse, std::size_t n, const float* from, std::size_t count, float* to, double* room) {
  return best_reduction_kernel().run_float(inverse, n, from, count, to, room);
}

Mueller with_unknown(Mueller m, const Elements& undetermined) {
  for (std::size_t e = 0; e < 16; ++e)
    if (undetermined[e]) m.elements[e] = std::numeric_limits<double>::quiet_NaN();
  return m;
}

}  // namespace

Reduction::Reduction(const Polarimeter& polarimeter, std::span<const double> covariance) {
  require_usable(polarimeter);
  auto solution = std::make_shared<Solution>();
  solution->polarimeter = polarimeter;
  solution->rows = rows_of(polarimeter);
  Inverse inverse = inverse_of(polarimeter, solution->rows);
  if (!inverse.matrix.allFinite())
    throw std::invalid_argument("states so large or so small that no finite numbers are left");
  refine(inverse.matrix, solution->rows);
  if (!inverse.matrix.allFinite())
    throw std::invalid_argument("states so large or so small that no finite numbers are left");
  solution->inverse = std::move(inverse.matrix);
  solution->undetermined = inverse.undetermined;
  solution->rank = inverse.rank;
  solution->condition = inverse.condition;
  const Index size = 4 * index(polarimeter.generator.size() + polarimeter.analyzer.size());
  if (!covariance.empty()) {
    if (index(covariance.size()) != size * size)
      throw std::invalid_argument("the covariance of the instrument has " + std::to_string(covariance.size()) +
                                  " numbers, expected " + std::to_string(size * size));
    solution->covariance = Eigen::Map<const MatrixXd>(covariance.data(), size, size);
    if (!solution->covariance.allFinite() || solution->covariance != solution->covariance.transpose())
      throw std::invalid_argument("the covariance of the instrument is not symmetric and finite");
    const auto [vectors, values] = dense::eigensystem(solution->covariance);
    require_semidefinite(values, "the instrument", covariance_tolerance);
    const Index none = (values.array() <= 1e-14 * values(size - 1)).count();
    solution->errors = vectors.rightCols(size - none) * values.tail(size - none).cwiseSqrt().asDiagonal();
  }
  solution_ = std::move(solution);
}

const Elements& Reduction::undetermined() const { return solution_->undetermined; }
int Reduction::rank() const { return solution_->rank; }
double Reduction::condition() const { return solution_->condition; }

Mueller Reduction::mueller(std::span<const double> readings) const {
  const MatrixXd& inverse = solution_->inverse;
  if (index(readings.size()) != inverse.cols())
    throw std::invalid_argument(std::to_string(readings.size()) + " readings, the instrument has " +
                                std::to_string(inverse.cols()));
  Mueller m;
  if (!best_reduction_kernel().run_double(inverse.data(), readings.size(), readings.data(), 1, m.elements.data()))
    if (!all_finite(readings)) throw std::invalid_argument(not_finite);
  return with_unknown(m, solution_->undetermined);
}

std::size_t Reduction::muellers(std::span<const double> readings, std::span<double> elements,
                                const MatricesOptions& options) const {
  return solve(readings, elements, options);
}

std::size_t Reduction::muellers(std::span<const float> readings, std::span<float> elements,
                                const MatricesOptions& options) const {
  return solve(readings, elements, options);
}

template <class Number>
std::size_t Reduction::solve(std::span<const Number> readings, std::span<Number> elements,
                             const MatricesOptions& options) const {
  const auto n = static_cast<std::size_t>(solution_->inverse.cols());
  const std::size_t pixels = elements.size() / 16;
  if (elements.size() % 16 != 0 || readings.size() % n != 0 || readings.size() / n != pixels)
    throw std::invalid_argument(std::to_string(readings.size()) + " readings and " + std::to_string(elements.size()) +
                                " elements, the instrument has " + std::to_string(n) + " readings of 16 elements");
  Refusals refusals;
  std::atomic<bool> no_memory = false;
  in_parts(pixels, options.threads, [&](std::size_t begin, std::size_t count) {
    const std::size_t block = 24 * std::max<std::size_t>(1, 48 / n);  // pixels: they stay in the nearest cache
    std::vector<double> room;
    try {
      if constexpr (std::is_same_v<Number, float>) room.resize(std::min(block, count) * n);
    } catch (const std::bad_alloc&) {
      no_memory = true;
      return;
    }
    for (std::size_t first = begin; first < begin + count; first += block) {
      const std::size_t here = std::min(block, begin + count - first);
      const auto from = readings.subspan(first * n, here * n);
      const auto to = elements.subspan(first * 16, here * 16);
      if (!run(solution_->inverse.data(), n, from.data(), here, to.data(), room.data()))
        for (std::size_t q = 0; q < here; ++q) {
          if (all_finite(from.subspan(q * n, n))) continue;
          std::ranges::fill(to.subspan(q * 16, 16), std::numeric_limits<Number>::quiet_NaN());
          refusals.add(first + q);
        }
      if (solution_->undetermined.any())
        for (std::size_t i = 0; i < to.size(); ++i)
          if (solution_->undetermined[i % 16]) to[i] = std::numeric_limits<Number>::quiet_NaN();
    }
  });
  if (no_memory) throw std::bad_alloc();
  if (refusals.count > 0 && options.refused == Refused::error)
    throw std::invalid_argument(refusals.message("pixel", not_finite, pixels));
  return refusals.count;
}

MuellerCovariance Reduction::from_readings(std::span<const double> variances) const {
  if (index(variances.size()) != solution_->inverse.cols())
    throw std::invalid_argument(std::to_string(variances.size()) + " variances, the instrument has " +
                                std::to_string(solution_->inverse.cols()) + " readings");
  for (const double variance : variances)
    if (!(variance >= 0) || !std::isfinite(variance))
      throw std::invalid_argument("variance " + shortest(variance) + ", must be finite and not negative");
  const Eigen::Map<const VectorXd> v(variances.data(), index(variances.size()));
  const MatrixXd& inverse = solution_->inverse;
  return covariance_of(inverse * v.asDiagonal() * inverse.transpose(), solution_->undetermined);
}

std::vector<double> Reduction::slopes(const Mueller& m) const {
  const Polarimeter& p = solution_->polarimeter;
  const Index generators = index(p.generator.size()), states = generators + index(p.analyzer.size());
  Mueller known = m;
  for (double& element : known.elements)
    if (std::isnan(element)) element = 0;
  std::vector<double> result(static_cast<std::size_t>(16 * 4 * states));
  Eigen::Map<RowMajor> at(result.data(), 16, 4 * states);
  at.setZero();
  for (std::size_t j = 0; j < p.readings(); ++j) {
    const auto [generator, analyzer] = p.pair(j);
    const Stokes seen = transpose(known) * p.analyzer[analyzer], scattered = known * p.generator[generator];
    const auto solution = solution_->inverse.col(index(j));
    at.middleCols<4>(4 * index(generator)) -= solution * Eigen::Map<const Eigen::RowVector4d>(seen.data());
    at.middleCols<4>(4 * (generators + index(analyzer))) -=
        solution * Eigen::Map<const Eigen::RowVector4d>(scattered.data());
  }
  return result;
}

MuellerCovariance Reduction::from_instrument(const Mueller& m) const {
  if (solution_->covariance.size() == 0) return {};
  const std::vector<double> slope = slopes(m);
  const Eigen::Map<const RowMajor> at(slope.data(), 16, solution_->covariance.rows());
  return covariance_of(at * solution_->covariance * at.transpose(), solution_->undetermined);
}

std::vector<Mueller> Reduction::errors(const Mueller& m) const {
  std::vector<Mueller> result(static_cast<std::size_t>(solution_->errors.cols()));
  if (result.empty()) return result;
  const std::vector<double> slope = slopes(m);
  const MatrixXd all = Eigen::Map<const RowMajor>(slope.data(), 16, solution_->errors.rows()) * solution_->errors;
  for (std::size_t k = 0; k < result.size(); ++k) {
    Eigen::Map<Eigen::Matrix<double, 16, 1>>(result[k].elements.data()) = all.col(index(k));
    result[k] = with_unknown(result[k], solution_->undetermined);
  }
  return result;
}

}  // namespace mmbrdf
