// SPDX-License-Identifier: BSD-3-Clause
#include "mixed/readings.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mmbrdf {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd first_f11(std::span<const double> coefficients, DiscMapping mapping, std::span<const Geometry> geometries) {
  static const Rows rows(blocks(Family::isotropic, {first_order, 0}).front().modes, Family::isotropic);
  VectorXd result(static_cast<Index>(geometries.size()));
  std::vector<double> row(rows.columns());
  for (Index g = 0; g < result.size(); ++g) {
    const auto& [i, r] = geometries[static_cast<std::size_t>(g)];
    std::ranges::fill(row, 0);
    rows.add(0, functions_at(i, first_order, mapping), functions_at(r, first_order, mapping), row.data());
    result(g) = Eigen::Map<const VectorXd>(row.data(), static_cast<Index>(row.size()))
                    .dot(Eigen::Map<const VectorXd>(coefficients.data(), static_cast<Index>(coefficients.size())));
  }
  return result;
}

VectorXd reading_weights(const ReadingLaw& law, std::span<const Geometry> geometries, const VectorXd& f11) {
  VectorXd result(static_cast<Index>(geometries.size()));
  for (Index g = 0; g < result.size(); ++g) {
    const auto& [i, r] = geometries[static_cast<std::size_t>(g)];
    result(g) = std::sqrt(std::pow(std::cos(r.theta), law.reflected_exponent) /
                          std::pow(std::cos(i.theta), law.incident_exponent));
  }
  return f11.size() > 0 ? VectorXd(result.cwiseQuotient(f11)) : result;
}

Gram gram_of(const MixedColumns& columns, std::span<const ReadingDirections> readings, const ReadingLaw& law,
             std::span<const double> f11) {
  Gram result(columns.size(), 0);
  std::vector<Geometry> geometries;
  for (std::size_t first = 0; first < readings.size(); first += readings_at_once) {
    const auto some = readings.subspan(first, std::min(readings_at_once, readings.size() - first));
    const auto count = static_cast<Index>(some.size());
    geometries.clear();
    VectorXd times(count);
    for (const auto& [angles, often] : some) {
      times(static_cast<Index>(geometries.size())) = std::sqrt(static_cast<double>(often));
      geometries.push_back({{angles[0], angles[1]}, {angles[2], angles[3]}});
    }
    const bool relative = law.relative && feeds_f11(columns.isotropic());
    const VectorXd f = relative ? first_f11(f11, columns.mapping(), geometries) : VectorXd();
    const VectorXd weights = reading_weights(law, geometries, f).cwiseProduct(times);
    Eigen::MatrixXd rows = columns.read_at(geometries);
    const VectorXd of_rows = weights.replicate(rows.rows() / count, 1);
    rows.array().colwise() *= of_rows.array();
    result.add(rows, VectorXd::Zero(rows.rows()), Eigen::MatrixXd(rows.rows(), 0));
  }
  return result;
}

}  // namespace mmbrdf
