// SPDX-License-Identifier: BSD-3-Clause
/// The columns of the mixed model of a block: isotropic modes of generous order, then free modes (basis/harmonics.hpp),
/// then one constant error for each element, as a calibration leaves it in the scattering plane. Not of element 11.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "basis/harmonics.hpp"
#include "basis/rows.hpp"
#include "mmbrdf/geometry/geometry.hpp"

namespace mmbrdf {

/// Radial orders of the parts of the mixed model.
inline constexpr Orders generous_orders{12, 10};  ///< isotropic; more where the evaluated model has more
inline constexpr Orders free_orders{5, 4};        ///< harmonics and mirror-odd modes
inline constexpr int nonreciprocal_order = 7;     ///< f11 alone

class MixedColumns {
 public:
  /// `isotropic` is a block of the isotropic family, of which readings tell of all elements but those `unread`.
  MixedColumns(const Block& isotropic, DiscMapping mapping, const Elements& unread = {});

  const Block& isotropic() const { return isotropic_; }
  DiscMapping mapping() const { return mapping_; }
  const std::vector<FreeMode>& free() const { return free_; }
  const std::vector<Element>& read() const { return read_; }  ///< elements of which there are readings
  Eigen::Index isotropic_count() const { return static_cast<Eigen::Index>(isotropic_.modes.size()); }
  Eigen::Index calibration_count() const { return calibration_; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(rows_.columns()) + calibration_; }
  Eigen::Index elements() const { return static_cast<Eigen::Index>(isotropic_.elements.size()); }

  /// Rows of all elements at some geometries, element after element, each in the xy frame.
  Eigen::MatrixXd at(std::span<const Geometry> geometries) const;
  /// Rows of those that are read alone.
  Eigen::MatrixXd read_at(std::span<const Geometry> geometries) const;
  /// The first columns of them, the isotropic ones.
  Eigen::MatrixXd isotropic_at(std::span<const Geometry> geometries) const;

 private:
  Eigen::MatrixXd filled(const Rows& rows, Eigen::Index width, std::span<const Geometry> geometries,
                         const std::vector<Element>& elements) const;
  Eigen::MatrixXd all_columns(std::span<const Geometry> geometries, const std::vector<Element>& elements) const;
  void add_calibration(std::span<const Geometry> geometries, const std::vector<Element>& elements,
                       Eigen::MatrixXd& rows) const;

  Block isotropic_;
  DiscMapping mapping_;
  std::vector<Element> read_;
  std::vector<FreeMode> free_;
  Rows isotropic_rows_, rows_;
  Eigen::Index calibration_;
  int order_;
};

}  // namespace mmbrdf
