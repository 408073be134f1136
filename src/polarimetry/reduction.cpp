// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/reduction.hpp"

// A reading is a row (a ⊗ w)ᵀ of a matrix H, times the sixteen elements; its pseudo-inverse solves. That of a grid of
// states that has rank four in each arm is the product of those of the arms.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mmbrdf/uncertainty/prediction.hpp"
#include "numerics/dense.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/semidefinite.hpp"
#include "polarimetry/columns.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Reduction::Solution {
  Polarimeter polarimeter;
  MatrixXd rows;     ///< H, readings × 16
  MatrixXd inverse;  ///< H⁺
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

MuellerCovariance covariance_of(const MatrixXd& matrix, const Elements& undetermined) {
  MuellerCovariance result;
  Eigen::Map<RowMajor>(result.values.data(), 16, 16) = (matrix + matrix.transpose()) / 2;
  set_unknown(result, undetermined);
  return result;
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
  if (index(readings.size()) != solution_->inverse.cols())
    throw std::invalid_argument(std::to_string(readings.size()) + " readings, the instrument has " +
                                std::to_string(solution_->inverse.cols()));
  const Eigen::Map<const VectorXd> b(readings.data(), index(readings.size()));
  if (!b.allFinite()) throw std::invalid_argument("a reading is not finite");
  Mueller m;
  Eigen::Map<Eigen::Matrix<double, 16, 1>> x(m.elements.data());
  x = solution_->inverse * b;
  x += solution_->inverse * (b - solution_->rows * x);  // what rounding of the inverse left
  return with_unknown(m, solution_->undetermined);
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
