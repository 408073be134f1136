// SPDX-License-Identifier: BSD-3-Clause
#include "basis/support.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "basis/rows.hpp"
#include "numerics/dense.hpp"
#include "numerics/eigen_index.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int anisotropic_order = 3;
constexpr double rounding = 1e-9;
constexpr double ridge = 1e-4;  // of the longest row's square: what no sample tells is not exactly free

/// Rows of the modes of f11 at the nodes, a column each.
MatrixXd columns_at_nodes(const DirectionPairs& pairs, Family family, int order, DiscMapping mapping) {
  const Rows rows(blocks(family, {order, 0}).front().modes, family);
  std::map<std::pair<double, double>, KTable> known;
  const auto functions = [&](const Direction& d) -> const KTable& {
    const auto [at, fresh] = known.try_emplace({d.theta, d.phi});
    if (fresh) at->second = functions_at(d, order, mapping);
    return at->second;
  };
  MatrixXd result = MatrixXd::Zero(index(rows.columns()), index(pairs.nodes()));
  for (std::size_t node = 0; node < pairs.nodes(); ++node) {
    const auto& [incident, reflected] = pairs.geometry(node);
    rows.add(0, functions(incident), functions(reflected), result.col(index(node)).data());
  }
  return result;
}

/// Of all nodes.
VectorXd leverages(const DirectionPairs& measured, Family family, int order, DiscMapping mapping) {
  const MatrixXd x = columns_at_nodes(measured, family, order, mapping);
  std::vector<Index> there;
  for (std::size_t node = 0; node < measured.nodes(); ++node)
    if (measured.contains(node)) there.push_back(index(node));
  MatrixXd rows(index(there.size()) + x.rows(), x.rows());  // the ridge below
  for (Index row = 0; const Index node : there) rows.row(row++) = x.col(node).transpose();
  rows.bottomRows(x.rows()) =
      MatrixXd::Identity(x.rows(), x.rows()) * std::sqrt(ridge * x.colwise().squaredNorm().maxCoeff());
  return (dense::inverse_of_triangle(dense::triangle(rows)).transpose() * x).colwise().squaredNorm();
}

}  // namespace

DirectionPairs supported(const DirectionPairs& measured, int order, DiscMapping mapping) {
  std::vector<VectorXd> asked{leverages(measured, Family::isotropic, order, mapping)};
  if (measured.grid() == DirectionPairs::Grid::anisotropic)
    asked.push_back(leverages(measured, Family::anisotropic, anisotropic_order, mapping));
  std::vector<double> most(asked.size());
  for (std::size_t node = 0; node < measured.nodes(); ++node)
    for (std::size_t k = 0; k < asked.size() && measured.contains(node); ++k)
      most[k] = std::max(most[k], asked[k](index(node)));
  DirectionPairs result = measured;
  for (std::size_t node = 0; node < measured.nodes(); ++node) {
    bool within = true;
    for (std::size_t k = 0; k < asked.size(); ++k) within = within && asked[k](index(node)) <= most[k] * (1 + rounding);
    if (within) result.add(node);
  }
  return result;
}

}  // namespace mmbrdf
