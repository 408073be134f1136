// SPDX-License-Identifier: BSD-3-Clause
#include "mixed/columns.hpp"

#include <algorithm>
#include <iterator>

#include "numerics/eigen_index.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

std::vector<std::vector<Term>> terms_of(const Block& isotropic, const std::vector<FreeMode>& free) {
  std::vector<std::vector<Term>> result;
  for (const Mode& mode : isotropic.modes) result.push_back(terms(mode, Family::isotropic));
  for (const FreeMode& mode : free) result.push_back(mode.terms);
  return result;
}

std::vector<FreeMode> free_of(const Block& isotropic) {
  return free_modes(isotropic, feeds_f11(isotropic) ? free_orders.f11 : free_orders.other, nonreciprocal_order);
}

int highest_order(const Block& isotropic) {
  const Orders highest = orders(std::vector{isotropic});
  return std::max({highest.f11, highest.other, free_orders.f11, nonreciprocal_order});
}

}  // namespace

MixedColumns::MixedColumns(const Block& isotropic, DiscMapping mapping, const Elements& unread)
    : isotropic_(isotropic),
      mapping_(mapping),
      free_(free_of(isotropic)),
      isotropic_rows_(isotropic.modes, Family::isotropic),
      rows_(terms_of(isotropic, free_)),
      calibration_(feeds_f11(isotropic) ? 0 : static_cast<Index>(isotropic.elements.size())),
      order_(highest_order(isotropic)) {
  std::ranges::copy_if(isotropic.elements, std::back_inserter(read_),
                       [&](const Element& element) { return !unread[element.index()]; });
}

MatrixXd MixedColumns::filled(const Rows& rows, Index width, std::span<const Geometry> geometries,
                              const std::vector<Element>& elements) const {
  const auto count = static_cast<Index>(geometries.size());
  FunctionTables tables(order_, mapping_, geometries.size());
  for (std::size_t g = 0; g < geometries.size(); ++g) tables.set(g, geometries[g]);
  MatrixXd result = MatrixXd::Zero(static_cast<Index>(elements.size()) * count, width);
  double* out = result.data();
  for (const Element& element : elements) {
    Rows::add(rows.terms(element.index()), tables.of(geometries.size()), out, static_cast<std::size_t>(result.rows()));
    out += count;
  }
  return result;
}

MatrixXd MixedColumns::isotropic_at(std::span<const Geometry> geometries) const {
  return filled(isotropic_rows_, isotropic_count(), geometries, isotropic_.elements);
}

MatrixXd MixedColumns::at(std::span<const Geometry> geometries) const {
  return all_columns(geometries, isotropic_.elements);
}

MatrixXd MixedColumns::read_at(std::span<const Geometry> geometries) const { return all_columns(geometries, read_); }

MatrixXd MixedColumns::all_columns(std::span<const Geometry> geometries, const std::vector<Element>& elements) const {
  MatrixXd result = filled(rows_, size(), geometries, elements);
  if (calibration_ > 0) add_calibration(geometries, elements, result);
  return result;
}

void MixedColumns::add_calibration(std::span<const Geometry> geometries, const std::vector<Element>& elements,
                                   MatrixXd& rows) const {
  const auto count = static_cast<Index>(geometries.size());
  for (Index g = 0; g < count; ++g) {
    const FrameAngles angles = angles_to_xy(geometries[static_cast<std::size_t>(g)], Frame::scattering_plane);
    const Mueller left = rotator(angles.scattered), right = rotator(-angles.incident);
    for (Index c = 0; c < calibration_; ++c) {
      Mueller unit{};
      unit.elements[isotropic_.elements[static_cast<std::size_t>(c)].index()] = 1;
      const Mueller seen = left * unit * right;
      for (std::size_t e = 0; e < elements.size(); ++e)
        rows(index(e) * count + g, size() - calibration_ + c) = seen.elements[elements[e].index()];
    }
  }
}

}  // namespace mmbrdf
