// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/reduction.hpp"

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>

#include "mmbrdf/uncertainty/prediction.hpp"
#include "numerics/dense.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/semidefinite.hpp"
#include "polarimetry/columns.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

struct Reduction::Inverses {
  MatrixXd generator;   ///< W⁺, states × 4
  MatrixXd analyzer;    ///< A⁺, 4 × states
  MatrixXd covariance;  ///< of the instrument; 0 × 0: none
  MatrixXd errors;      ///< its square root: an independent error in each column
};

namespace {

/// Of a 4 × states matrix.
MatrixXd pseudo_inverse(const MatrixXd& states, const char* of) {
  const auto refusal = [&](const std::string& what) { return std::invalid_argument(of + (": " + what)); };
  if (states.cols() > index(most_states))
    throw refusal(std::to_string(states.cols()) + " states, at most " + std::to_string(most_states) + " can be used");
  const std::string too_few = std::to_string(states.cols()) + " states, not four independent ones";
  if (!states.allFinite()) throw refusal("a state is not finite");
  if (states.cols() < 4) throw refusal(too_few);
  const auto [u, v, s] = dense::thin_svd(states);
  if (!has_rank_four(s)) throw refusal(too_few);
  return v * s.cwiseInverse().asDiagonal() * u.transpose();
}

MuellerCovariance covariance_of(const MatrixXd& matrix) {
  MuellerCovariance result;
  Eigen::Map<RowMajor>(result.values.data(), 16, 16) = (matrix + matrix.transpose()) / 2;
  return result;
}

}  // namespace

Reduction::Reduction(const Polarimeter& polarimeter, std::span<const double> covariance) {
  auto inverses = std::make_shared<Inverses>();
  inverses->generator = pseudo_inverse(columns(polarimeter.generator), "generator");
  inverses->analyzer = pseudo_inverse(columns(polarimeter.analyzer), "analyzer").transpose();
  const Index size = 4 * index(polarimeter.generator.size() + polarimeter.analyzer.size());
  if (!covariance.empty()) {
    if (index(covariance.size()) != size * size)
      throw std::invalid_argument("the covariance of the instrument has " + std::to_string(covariance.size()) +
                                  " numbers, expected " + std::to_string(size * size));
    inverses->covariance = Eigen::Map<const MatrixXd>(covariance.data(), size, size);
    if (!inverses->covariance.allFinite() || inverses->covariance != inverses->covariance.transpose())
      throw std::invalid_argument("the covariance of the instrument is not symmetric and finite");
    const auto [vectors, values] = dense::eigensystem(inverses->covariance);
    require_semidefinite(values, "the instrument", covariance_tolerance);
    const Index none = (values.array() <= 1e-14 * values(size - 1)).count();
    inverses->errors = vectors.rightCols(size - none) * values.tail(size - none).cwiseSqrt().asDiagonal();
  }
  inverses_ = std::move(inverses);
}

Mueller Reduction::mueller(std::span<const double> readings) const {
  const Index analyzers = inverses_->analyzer.cols(), generators = inverses_->generator.rows();
  if (index(readings.size()) != analyzers * generators)
    throw std::invalid_argument(std::to_string(readings.size()) + " readings, the instrument has " +
                                std::to_string(analyzers * generators));
  const Eigen::Map<const RowMajor> b(readings.data(), analyzers, generators);
  if (!b.allFinite()) throw std::invalid_argument("a reading is not finite");
  Mueller m;
  Eigen::Map<RowMajor>(m.elements.data(), 4, 4) = inverses_->analyzer * b * inverses_->generator;
  return m;
}

MuellerCovariance Reduction::from_readings(std::span<const double> variances) const {
  const Index analyzers = inverses_->analyzer.cols(), generators = inverses_->generator.rows();
  if (index(variances.size()) != analyzers * generators)
    throw std::invalid_argument(std::to_string(variances.size()) + " variances, the instrument has " +
                                std::to_string(analyzers * generators) + " readings");
  MatrixXd sum = MatrixXd::Zero(16, 16);
  for (Index q = 0; q < analyzers; ++q)
    for (Index p = 0; p < generators; ++p) {
      const double variance = variances[static_cast<std::size_t>(q * generators + p)];
      if (!(variance >= 0) || !std::isfinite(variance))
        throw std::invalid_argument("variance " + shortest(variance) + ", must be finite and not negative");
      VectorXd slope(16);
      for (Index e = 0; e < 16; ++e) slope(e) = inverses_->analyzer(e / 4, q) * inverses_->generator(p, e % 4);
      sum += variance * slope * slope.transpose();
    }
  return covariance_of(sum);
}

std::vector<double> Reduction::slopes(const Mueller& m) const {
  const Index analyzers = inverses_->analyzer.cols(), generators = inverses_->generator.rows();
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(m.elements.data());
  std::vector<double> result(static_cast<std::size_t>(16 * 4 * (analyzers + generators)));
  Eigen::Map<RowMajor> at(result.data(), 16, 4 * (analyzers + generators));
  for (Index e = 0; e < 16; ++e)
    for (Index k = 0; k < 4; ++k) {
      for (Index p = 0; p < generators; ++p) at(e, 4 * p + k) = -matrix(e / 4, k) * inverses_->generator(p, e % 4);
      for (Index q = 0; q < analyzers; ++q)
        at(e, 4 * (generators + q) + k) = -inverses_->analyzer(e / 4, q) * matrix(k, e % 4);
    }
  return result;
}

MuellerCovariance Reduction::from_instrument(const Mueller& m) const {
  if (inverses_->covariance.size() == 0) return {};
  const std::vector<double> slope = slopes(m);
  const Eigen::Map<const RowMajor> at(slope.data(), 16, inverses_->covariance.rows());
  return covariance_of(at * inverses_->covariance * at.transpose());
}

std::vector<Mueller> Reduction::errors(const Mueller& m) const {
  std::vector<Mueller> result(static_cast<std::size_t>(inverses_->errors.cols()));
  if (result.empty()) return result;
  const std::vector<double> slope = slopes(m);
  const MatrixXd all = Eigen::Map<const RowMajor>(slope.data(), 16, inverses_->errors.rows()) * inverses_->errors;
  for (std::size_t k = 0; k < result.size(); ++k)
    Eigen::Map<Eigen::Matrix<double, 16, 1>>(result[k].elements.data()) = all.col(index(k));
  return result;
}

}  // namespace mmbrdf
