// SPDX-License-Identifier: BSD-3-Clause
/// Singular values of the triangles that were asked for so far, as elements and wavelengths with the same rows have the
/// same one.
#pragma once

#include <map>

#include "numerics/dense.hpp"

namespace mmbrdf {

class SvdCache {
 public:
  const dense::Svd& of(const Eigen::MatrixXd& triangle) {
    const double sum = triangle.sum();
    const auto [begin, end] = known_.equal_range(sum);
    for (auto at = begin; at != end; ++at)
      if (const auto& [of, svd] = at->second; of.rows() == triangle.rows() && of == triangle) return svd;
    return known_.emplace(sum, Known{triangle, dense::full_svd(triangle)})->second.svd;
  }

 private:
  struct Known {
    Eigen::MatrixXd triangle;
    dense::Svd svd;
  };
  std::multimap<double, Known> known_;  // by the sum of the triangle
};

}  // namespace mmbrdf
