// SPDX-License-Identifier: BSD-3-Clause
/// The modes of a block at one wavelength, with the covariance of their coefficients: of the evaluated modes, or, where
/// there is a posterior, of those behind them, of which the evaluated ones are some and the others have coefficient 0.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "basis/rows.hpp"
#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// One block at one wavelength.
struct BlockAt {
  std::vector<Element> elements;
  Rows rows;
  Eigen::VectorXd coefficients;  // a(λ)
  Eigen::MatrixXd covariance;    // V(λ), of all parameters
  Eigen::MatrixXd of_fit;        // V(λ) without its parts
  /// Parts of V: effects × effectsᵀ.
  struct Part {
    std::string name;
    Eigen::MatrixXd effects;
  };
  std::vector<Part> parts{};
  Eigen::MatrixXd free;    // combinations that the data leave free, folded at λ: modes × number
  double lengthening = 1;  // of a row over the modes to the row over all powers
  double reflectance = 1;  // R(λ), of block 11
  Eigen::Index first = 0;  // of its parameters among those of all blocks

  Eigen::Index modes() const { return coefficients.size(); }
  bool knows_reflectance() const { return covariance.rows() > modes(); }

  /// g_e
  Eigen::VectorXd row(const Element& element, const KTable& k_i, const KTable& k_r) const {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(modes());
    rows.add(element.index(), k_i, k_r, g.data());
    return g;
  }

  /// Slopes of R g · a over the parameters.
  Eigen::VectorXd slopes(const Eigen::VectorXd& g) const {
    Eigen::VectorXd result(covariance.rows());
    result.head(modes()) = reflectance * g;
    if (knows_reflectance()) result(modes()) = g.dot(coefficients);
    return result;
  }
};

/// Throws std::invalid_argument as prepare_uncertainty() does.
std::vector<BlockAt> blocks_at(const Model& model, double wavelength);

}  // namespace mmbrdf
