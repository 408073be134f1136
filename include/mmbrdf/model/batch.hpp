// SPDX-License-Identifier: BSD-3-Clause
/// Many geometries at once: on several threads, from angles or unit vectors, in double or single precision, at one
/// wavelength or at one for each geometry.
///
/// All functions throw std::invalid_argument if sizes differ, or for the first invalid geometry, before anything is
/// written. They agree with PreparedModel::evaluate to evaluation_error × f11, in single precision to
/// single_precision_error × f11; results do not depend on the number of threads or on which geometries are evaluated
/// together. In double precision those at a wavelength of their own have the bits of PreparedModel::at() it.
#pragma once

#include <array>
#include <span>

#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf {

/// Directions as unit vectors, one array for each component: z ≥ 0, length 1 to 1e-6. A vector along the normal has
/// azimuth 0. No trigonometry is needed for them. Real is double or float.
template <class Real>
struct UnitVectors {
  std::span<const Real> x, y, z;
};

template <class Real>
struct VectorGeometries {
  UnitVectors<Real> incident, reflected;
};

/// One array for each element of the matrices, row by row: f11, f12, … f44.
template <class Real>
struct MuellerColumns {
  std::array<std::span<Real>, 16> elements;
};

struct BatchOptions {
  Frame frame = Frame::xy;                   ///< another than xy costs a few ns for each matrix
  int threads = 1;                           ///< 0: one for each core
  std::span<const double> wavelengths = {};  ///< of each geometry, micrometres; empty: that of the prepared model
};

/// Matrices in sr⁻¹, from angles.
void evaluate(const PreparedModel& model, std::span<const Geometry> geometries, std::span<Mueller> out,
              const BatchOptions& options = {});

/// Matrices in sr⁻¹, from unit vectors, one matrix after the other: 16 numbers each, row by row.
void evaluate(const PreparedModel& model, const VectorGeometries<double>& geometries, std::span<Mueller> out,
              const BatchOptions& options = {});
void evaluate(const PreparedModel& model, const VectorGeometries<double>& geometries, std::span<double> out,
              const BatchOptions& options = {});
void evaluate(const PreparedModel& model, const VectorGeometries<float>& geometries, std::span<float> out,
              const BatchOptions& options = {});

/// Matrices in sr⁻¹, from unit vectors, one array for each element.
void evaluate(const PreparedModel& model, const VectorGeometries<double>& geometries, const MuellerColumns<double>& out,
              const BatchOptions& options = {});
void evaluate(const PreparedModel& model, const VectorGeometries<float>& geometries, const MuellerColumns<float>& out,
              const BatchOptions& options = {});

/// Matrices in sr⁻¹ at one incident direction. Throws std::invalid_argument if wavelengths are given.
void evaluate(const PreparedIncidence& model, std::span<const Direction> reflected, std::span<Mueller> out,
              const BatchOptions& options = {});
void evaluate(const PreparedIncidence& model, const UnitVectors<double>& reflected, std::span<Mueller> out,
              const BatchOptions& options = {});
void evaluate(const PreparedIncidence& model, const UnitVectors<double>& reflected, const MuellerColumns<double>& out,
              const BatchOptions& options = {});
void evaluate(const PreparedIncidence& model, const UnitVectors<float>& reflected, std::span<float> out,
              const BatchOptions& options = {});
void evaluate(const PreparedIncidence& model, const UnitVectors<float>& reflected, const MuellerColumns<float>& out,
              const BatchOptions& options = {});

/// Bound on |error| / |f11| of matrices in single precision, for fitted models up to orders 7, 4, away from zeros of
/// f11.
inline constexpr double single_precision_error = 2e-5;

}  // namespace mmbrdf
