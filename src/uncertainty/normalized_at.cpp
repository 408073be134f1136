// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/normalized_at.hpp"

#include <algorithm>

#include "numerics/eigen_index.hpp"
#include "numerics/gram.hpp"

// The rows of a block stand element after element, of each all geometries, so that everything is a product of matrices.

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Slopes of R g · a over the parameters, and the values.
struct RowsOfBlock {
  MatrixXd slopes;
  VectorXd values;
};

RowsOfBlock rows_of(const BlockAt& block, const FunctionTables& tables, std::size_t count) {
  const Index modes = block.modes(), rows = index(count * block.elements.size());
  RowsOfBlock result{MatrixXd::Zero(rows, block.covariance.rows()), {}};
  double* out = result.slopes.data();
  for (const Element& element : block.elements) {
    Rows::add(block.rows.terms(element.index()), tables.of(count), out, static_cast<std::size_t>(rows));
    out += count;
  }
  const VectorXd unscaled = result.slopes.leftCols(modes) * block.coefficients;
  result.values = block.reflectance * unscaled;
  result.slopes.leftCols(modes) *= block.reflectance;
  if (block.knows_reflectance()) result.slopes.col(modes) = unscaled;
  return result;
}

/// Adds aᵀ b of the rows of each two elements at each geometry.
void add_products(std::vector<MuellerCovariance>& sum, const std::vector<Element>& elements, const MatrixXd& a,
                  const MatrixXd& b) {
  const Index count = index(sum.size());
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const std::size_t e = elements[i].index(), other = elements[j].index();
      const VectorXd products =
          a.middleRows(index(i) * count, count).cwiseProduct(b.middleRows(index(j) * count, count)).rowwise().sum();
      for (Index g = 0; g < count; ++g) {
        MuellerCovariance& c = sum[static_cast<std::size_t>(g)];
        c(e, other) += products(g);
        if (e != other) c(other, e) += products(g);
      }
    }
}

}  // namespace

std::string name_of_fit(std::span<const BlockAt> blocks) { return blocks.front().parts.empty() ? "fit" : "posterior"; }

NormalizedAt normalized_at(std::span<const BlockAt> blocks, int order, DiscMapping mapping,
                           std::span<const Geometry> geometries) {
  const std::size_t count = geometries.size();
  FunctionTables tables(order, mapping, count);
  for (std::size_t g = 0; g < count; ++g) tables.set(g, geometries[g]);
  NormalizedAt result{std::vector<Mueller>(count), {{name_of_fit(blocks), std::vector<MuellerCovariance>(count)}}};
  const auto covariances_of = [&](const std::string& name) -> std::vector<MuellerCovariance>& {
    auto found = std::ranges::find(result.parts, name, &NormalizedAt::Part::name);
    if (found == result.parts.end()) found = result.parts.insert(found, {name, std::vector<MuellerCovariance>(count)});
    return found->covariances;
  };
  for (const BlockAt& block : blocks) {
    const RowsOfBlock rows = rows_of(block, tables, count);
    for (std::size_t i = 0; i < block.elements.size(); ++i)
      for (std::size_t g = 0; g < count; ++g)
        result.m[g].elements[block.elements[i].index()] = rows.values(index(i * count + g));
    add_products(result.parts.front().covariances, block.elements, rows.slopes, product(rows.slopes, block.of_fit));
    for (const BlockAt::Part& part : block.parts) {
      const MatrixXd effects = rows.slopes * part.effects;
      add_products(covariances_of(part.name), block.elements, effects, effects);
    }
  }
  return result;
}

}  // namespace mmbrdf
