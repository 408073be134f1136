// SPDX-License-Identifier: BSD-3-Clause
/// Standard uncertainties and covariances at many geometries: rows of modes side by side, and products with the
/// covariances of the blocks that stay in the cache.
#pragma once

#include <span>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"
#include "uncertainty/block_at.hpp"
#include "uncertainty/variances_kernel.hpp"

namespace mmbrdf {

/// Every one of this build, the fastest first; not all of them need run here. For tests.
std::span<const VariancesKernel* const> variances_kernels();

/// The first that runs here.
const VariancesKernel& best_variances_kernel();

/// A matrix as the kernel reads it.
class Packed {
 public:
  explicit Packed(const Eigen::Ref<const Eigen::MatrixXd>& matrix);
  PackedColumns view() const { return {values_.data(), rows_, columns_}; }
  long rows() const { return rows_; }

 private:
  long rows_, columns_;
  std::vector<double> values_;
};

/// V z of a symmetric V. A column of z has the same bits whatever the others are.
Eigen::MatrixXd symmetric_times(const Eigen::MatrixXd& v, const Eigen::MatrixXd& z);

/// What all blocks at one wavelength say. May be used in many threads at once; unknown elements are 0.
class Variances {
 public:
  /// `turns`: the modes are asked at phi_i = 0, and what they give is turned.
  Variances(std::span<const BlockAt> blocks, int order, DiscMapping mapping, bool turns);

  /// Of valid geometries.
  void standard_uncertainties(std::span<const Geometry> geometries, Frame frame, std::span<Mueller> out) const;
  enum class Of { matrix, normalized };  // the latter: f11, and the other elements divided by it
  void covariances(Of what, std::span<const Geometry> geometries, Frame frame, std::span<MuellerCovariance> out) const;
  void directional_hemispherical(std::span<const Direction> incident, std::span<double> out) const;

  /// Of draws: the coefficients of each block, a column for each draw, as many rows as its covariance has; and R.
  struct Drawn {
    std::vector<Packed> blocks;
    std::vector<double> reflectances;
  };
  /// The matrix of draw d at geometry g goes to out[g × draws + d].
  void matrices(const Drawn& drawn, std::span<const Geometry> geometries, Frame frame, std::span<Mueller> out) const;

 private:
  struct Row {
    std::size_t element;
    std::vector<RowTerm> terms;
    std::vector<int> column, with;  // as in TermColumns
    std::vector<double> coefficients;
    Row(const BlockAt& block, std::size_t of_element);
    TermColumns view() const {
      return {terms.data(), column.data(), coefficients.data(), with.data(), static_cast<int>(with.size()) - 1};
    }
  };
  /// Elements whose rows are worked on together.
  struct Together {
    std::vector<std::size_t> elements;
    bool turned = false;  ///< rows, not variances
  };
  struct OfBlock {
    std::vector<Row> rows;
    Together all;                    // where axes do not turn
    std::vector<Together> in_turns;  // where they do
    Packed covariance;               // of what stands in a row
    long modes;
    double reflectance;
    bool knows_reflectance;
  };
  /// Of the integral of f11 over the hemisphere: the functions of the incident direction that it has, and the covariance
  /// of their coefficients.
  struct Hemispherical {
    std::vector<std::size_t> functions;
    Packed covariance;
  };
  struct Some;

  static std::vector<Together> in_turns(const std::vector<std::size_t>& elements);
  static Hemispherical hemispherical(const BlockAt& f11, int order, DiscMapping mapping);
  void set_functions(Some& some, std::span<const Geometry> geometries) const;
  void set_rows(Some& some, const OfBlock& block, const Together& together) const;
  void add_variances(Some& some, const OfBlock& block) const;
  void set_drawn(Some& some, const Drawn& drawn) const;

  int order_;
  DiscMapping mapping_;
  bool turns_;
  std::vector<OfBlock> blocks_;
  Hemispherical hemispherical_;
};

}  // namespace mmbrdf
