// SPDX-License-Identifier: BSD-3-Clause
/// Singular values of the triangles that were asked for so far, as elements and wavelengths with the same rows have the
/// same one.
#pragma once

#include <deque>

#include "numerics/dense.hpp"

namespace mmbrdf {

class SvdCache {
 public:
  const dense::Svd& of(const Eigen::MatrixXd& triangle) {
    for (const auto& [of, svd] : known_)
      if (of.rows() == triangle.rows() && of == triangle) return svd;
    return known_.emplace_back(Known{triangle, dense::full_svd(triangle)}).svd;
  }

 private:
  struct Known {
    Eigen::MatrixXd triangle;
    dense::Svd svd;
  };
  std::deque<Known> known_;
};

}  // namespace mmbrdf
