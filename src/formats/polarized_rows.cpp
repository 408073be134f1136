// SPDX-License-Identifier: BSD-3-Clause
#include "formats/polarized_rows.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace mmbrdf {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double smallest = 1e-2;      // of the largest singular value: below it errors grow more than a hundredfold
constexpr double undetermined = 1e-2;  // the part of an element of which states tell nothing

}  // namespace

const PolarizedRows::Solution& PolarizedRows::solution(std::span<const PolarizedValue> values) {
  std::vector<double> key;
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(values.size()), 16);
  for (std::size_t v = 0; v < values.size(); ++v) {
    const auto& [incident, analyzed, brdf, uncertainty] = values[v];
    key.insert(key.end(), incident.begin(), incident.end());
    key.insert(key.end(), analyzed.begin(), analyzed.end());
    const bool open = analyzed[1] == 0 && analyzed[2] == 0 && analyzed[3] == 0;
    for (std::size_t e = 0; e < 16; ++e)
      rows(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(e)) =
          (open ? 1 : 0.5) * analyzed[e / 4] * incident[e % 4];
  }
  const auto known = solutions_.find(key);
  if (known != solutions_.end()) return known->second;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::Index rank = (svd.singularValues().array() >= smallest * svd.singularValues()(0)).count();
  const Eigen::MatrixXd v = svd.matrixV().leftCols(rank);
  const Eigen::MatrixXd inverse =
      v * svd.singularValues().head(rank).cwiseInverse().asDiagonal() * svd.matrixU().leftCols(rank).transpose();
  Solution result;
  for (Eigen::Index e = 0; e < 16; ++e) {
    result.determined[static_cast<std::size_t>(e)] = v.row(e).squaredNorm() > 1 - undetermined * undetermined;
    for (Eigen::Index n = 0; n < inverse.cols(); ++n) result.inverse.push_back(inverse(e, n));
  }
  return solutions_.emplace(std::move(key), std::move(result)).first->second;
}

void PolarizedRows::solve(std::span<const PolarizedValue> values, Sample& sample) {
  const Solution& known = solution(values);
  const std::vector<double>& inverse = known.inverse;
  const Elements& determined = known.determined;
  const std::size_t count = values.size();
  const auto element = [&](std::size_t e) {
    double result = 0;
    for (std::size_t n = 0; n < count; ++n) result += inverse[e * count + n] * values[n].brdf;
    return result;
  };
  sample.f11 = determined[0] ? element(0) : nothing;
  sample.normalized.elements.fill(nothing);
  sample.normalized(0, 0) = 1;
  sample.uncertainty = {};
  if (!determined[0]) return;
  const bool uncertain = std::ranges::all_of(values, [](const PolarizedValue& one) { return one.uncertainty > 0; });
  for (std::size_t e = 0; e < 16; ++e) {
    if (!determined[e]) continue;
    const double m = e == 0 ? 0 : element(e) / sample.f11;
    double variance = 0;  // of f11, or of element / f11
    for (std::size_t n = 0; n < count; ++n) {
      const double slope = e == 0 ? inverse[n] : (inverse[e * count + n] - m * inverse[n]) / sample.f11;
      variance += slope * slope * values[n].uncertainty * values[n].uncertainty;
    }
    if (uncertain) sample.uncertainty.elements[e] = std::sqrt(variance);
    if (e > 0) sample.normalized.elements[e] = m;
  }
}

}  // namespace mmbrdf
