// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/model/prepared.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "model/batch_question.hpp"
#include "model/kernel/kernels.hpp"
#include "numerics/threads.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

// ---- what is asked --------------------------------------------------------------------------------------------------

void require_size(std::size_t asked, const char* what, std::size_t room) {
  if (asked != room)
    throw std::invalid_argument(std::to_string(asked) + " " + what + ", room for " + std::to_string(room));
}

bool is_valid(const Direction& d) {
  return d.theta >= 0 && d.theta <= radians(90) && std::abs(d.phi) <= std::numeric_limits<double>::max();
}

bool is_valid(const Geometry& g) { return is_valid(g.incident) && is_valid(g.reflected); }

void require_valid(const Direction& d) { require_valid(Geometry{{}, d}); }

/// Angles are Direction or Geometry.
template <class Angles>
void require_valid(std::span<const Angles> angles, int threads) {
  const std::size_t bad = first_found(angles.size(), threads, [&](std::size_t first, std::size_t count) {
    std::size_t q = first;
    while (q < first + count && is_valid(angles[q])) ++q;
    return q;
  });
  if (bad < angles.size()) require_valid(angles[bad]);  // throws
}

template <class T>
void require_valid(const UnitVectors<T>& vectors, const char* side, int threads) {
  const std::size_t count = vectors.x.size();
  if (vectors.y.size() != count || vectors.z.size() != count)
    throw std::invalid_argument(std::string(side) + " vectors with " + std::to_string(count) + " x, " +
                                std::to_string(vectors.y.size()) + " y and " + std::to_string(vectors.z.size()) + " z");
  const std::size_t bad = first_found(count, threads, [&](std::size_t first, std::size_t part) {
    const T* const columns[3] = {vectors.x.data() + first, vectors.y.data() + first, vectors.z.data() + first};
    if constexpr (std::is_same_v<T, double>)
      return first + best_kernel().first_invalid(columns, part);
    else
      return first + best_kernel().first_invalid_single(columns, part);
  });
  if (bad < count)
    throw std::invalid_argument(std::string(side) + " vector " + std::to_string(bad + 1) + ": (" +
                                shortest(vectors.x[bad]) + ", " + shortest(vectors.y[bad]) + ", " +
                                shortest(vectors.z[bad]) + ") is not a unit vector with z >= 0");
}

template <class T>
Vector3 vector(const UnitVectors<T>& vectors, std::size_t q) {
  return {vectors.x[q], vectors.y[q], vectors.z[q]};
}

// ---- evaluation -----------------------------------------------------------------------------------------------------

template <class T>
void run_kernel(const BatchQuestion<T>& question, const KernelPoints<T>& points, const KernelMatrices<T>& out,
                std::size_t count) {
  if constexpr (std::is_same_v<T, double>)
    best_kernel().evaluate(question.model, points, out, count);
  else
    best_kernel().evaluate_single(question.model, points, out, count);
}

/// What was not measured, and what the frame mixes it with. Axes that are turned by a multiple of a right angle mix nothing,
/// so where not all of a group is unknown it takes the geometry to tell.
template <class T, class GeometryOf>
void set_unknown(const BatchQuestion<T>& question, const KernelMatrices<T>& out, std::size_t first, std::size_t count,
                 GeometryOf geometry) {
  if (question.unknown.none()) return;
  const bool same_for_all = question.frame == Frame::xy || turned_into(question.unknown) == question.unknown;
  for (std::size_t q = first; q < first + count; ++q) {
    Elements unknown = question.unknown;
    if (!same_for_all) {
      const FrameAngles angles = angles_to_xy(geometry(q), question.frame);
      unknown = turned_into(unknown, -angles.scattered, -angles.incident);
    }
    for (std::size_t e = 0; e < 16; ++e)
      if (unknown[e]) out.element[e][static_cast<std::ptrdiff_t>(q) * out.stride] = std::numeric_limits<T>::quiet_NaN();
  }
}

template <class T>
KernelPoints<T> from(KernelPoints<T> points, std::size_t first) {
  for (const T*& column : points.column)
    if (column) column += static_cast<std::ptrdiff_t>(first) * points.stride;
  return points;
}
template <class T>
KernelMatrices<T> from(KernelMatrices<T> out, std::size_t first) {
  for (T*& element : out.element) element += static_cast<std::ptrdiff_t>(first) * out.stride;
  return out;
}

template <class T>
KernelMatrices<T> rows(T* values) {
  KernelMatrices<T> out{{}, 16};
  for (std::size_t e = 0; e < 16 && values; ++e) out.element[e] = values + e;  // of nothing, nothing
  return out;
}

/// With wavelengths of their own: some points at a time.
template <class T>
void run_in_blocks(const BatchQuestion<T>& question, const KernelPoints<T>& points, const KernelMatrices<T>& out,
                   std::size_t first, std::size_t count) {
  constexpr std::size_t size = 64;
  T wavelengths[size], scales[size];
  for (std::size_t begin = first; begin < first + count; begin += size) {
    const std::size_t here = std::min(size, first + count - begin);
    for (std::size_t q = 0; q < here; ++q) {
      wavelengths[q] = static_cast<T>(question.wavelengths[begin + q]);
      scales[q] = static_cast<T>(question.reflectance->at(question.wavelengths[begin + q]));
    }
    KernelPoints<T> block = from(points, begin);
    block.wavelength = wavelengths;
    block.scale = scales;
    run_kernel(question, block, from(out, begin), here);
  }
}

template <class T>
void run(const BatchQuestion<T>& question, const KernelPoints<T>& points, const KernelMatrices<T>& out,
         std::size_t first, std::size_t count) {
  if (question.reflectance)
    run_in_blocks(question, points, out, first, count);
  else
    run_kernel(question, from(points, first), from(out, first), count);
}

/// again(first, count) does some of the points again; geometry(q) is asked for where elements are unknown only.
template <class T, class Again, class GeometryOf>
void run(const BatchQuestion<T>& question, const KernelPoints<T>& points, const KernelMatrices<T>& out,
         std::size_t count, int threads, Again again, GeometryOf geometry) {
  in_parts(count, threads, [&](std::size_t first, std::size_t part) {
    run(question, points, out, first, part);
    again(first, part);
    set_unknown(question, out, first, part, geometry);
  });
}

// ---- angles ---------------------------------------------------------------------------------------------------------

/// The azimuth within a turn where there are too many for the kernel.
double reduced(double phi) { return std::abs(phi) <= max_azimuth ? phi : std::atan2(std::sin(phi), std::cos(phi)); }
Direction reduced(const Direction& d) { return {d.theta, reduced(d.phi)}; }
Geometry reduced(const Geometry& g) { return {reduced(g.incident), reduced(g.reflected)}; }

KernelPoints<double> points_of(const Direction& first) {
  return {true, {&first.theta, &first.phi}, sizeof(Direction) / sizeof(double), nullptr, nullptr};
}
KernelPoints<double> points_of(const Geometry& first) {
  return {true,
          {&first.incident.theta, &first.incident.phi, &first.reflected.theta, &first.reflected.phi},
          sizeof(Geometry) / sizeof(double),
          nullptr,
          nullptr};
}

/// Those with large azimuths are done again, one by one.
template <class Angles, class GeometryOf>
void run_angles(const BatchQuestion<double>& question, std::span<const Angles> angles, std::span<Mueller> out,
                int threads, GeometryOf geometry) {
  if (angles.empty()) return;
  const KernelMatrices<double> matrices = rows(out[0].elements.data());
  const auto again = [&](std::size_t first, std::size_t count) {
    for (std::size_t q = first; q < first + count; ++q) {
      const Angles near = reduced(angles[q]);
      if (near == angles[q]) continue;
      run(BatchQuestion<double>(question, q), points_of(near), from(matrices, q), 0, 1);
    }
  };
  run(question, points_of(angles[0]), matrices, out.size(), threads, again, geometry);
}

// ---- vectors --------------------------------------------------------------------------------------------------------

template <class T>
KernelMatrices<T> columns(const MuellerColumns<T>& out, std::size_t count) {
  KernelMatrices<T> result{{}, 1};
  for (std::size_t e = 0; e < 16; ++e) {
    require_size(count, "geometries", out.elements[e].size());
    result.element[e] = out.elements[e].data();
  }
  return result;
}

template <class T>
void run_vectors(const PreparedModel& model, const VectorGeometries<T>& geometries, const KernelMatrices<T>& out,
                 const BatchOptions& options) {
  const UnitVectors<T>&i = geometries.incident, &r = geometries.reflected;
  const std::size_t count = i.x.size();
  require_valid(i, "incident", options.threads);
  require_valid(r, "reflected", options.threads);
  if (r.x.size() != count)
    throw std::invalid_argument(std::to_string(count) + " incident and " + std::to_string(r.x.size()) +
                                " reflected vectors");
  const BatchQuestion<T> question(model, count, options);
  const KernelPoints<T> points{
      false, {i.x.data(), i.y.data(), i.z.data(), r.x.data(), r.y.data(), r.z.data()}, 1, nullptr, nullptr};
  run(
      question, points, out, count, options.threads, [](std::size_t, std::size_t) {},
      [&](std::size_t q) {
        return Geometry{direction(vector(i, q)), direction(vector(r, q))};
      });
}

template <class T>
void run_vectors(const PreparedIncidence& model, const UnitVectors<T>& reflected, const KernelMatrices<T>& out,
                 const BatchOptions& options) {
  if (!options.wavelengths.empty()) throw std::invalid_argument("wavelengths for one incident direction");
  require_valid(reflected, "reflected", options.threads);
  const BatchQuestion<T> question(model, options.frame);
  const KernelPoints<T> points{
      false, {reflected.x.data(), reflected.y.data(), reflected.z.data()}, 1, nullptr, nullptr};
  run(
      question, points, out, reflected.x.size(), options.threads, [](std::size_t, std::size_t) {},
      [&](std::size_t q) {
        return Geometry{model.incident(), direction(vector(reflected, q))};
      });
}

double* first_number(std::span<Mueller> out) { return out.empty() ? nullptr : out[0].elements.data(); }

}  // namespace

void evaluate(const PreparedModel& model, std::span<const Geometry> geometries, std::span<Mueller> out,
              const BatchOptions& options) {
  require_size(geometries.size(), "geometries", out.size());
  require_valid(geometries, options.threads);
  run_angles(BatchQuestion<double>(model, out.size(), options), geometries, out, options.threads,
             [&](std::size_t q) { return geometries[q]; });
}

void evaluate(const PreparedModel& model, const VectorGeometries<double>& geometries, std::span<Mueller> out,
              const BatchOptions& options) {
  require_size(geometries.incident.x.size(), "geometries", out.size());
  run_vectors(model, geometries, rows(first_number(out)), options);
}

void evaluate(const PreparedModel& model, const VectorGeometries<double>& geometries, std::span<double> out,
              const BatchOptions& options) {
  require_size(16 * geometries.incident.x.size(), "elements", out.size());
  run_vectors(model, geometries, rows(out.data()), options);
}

void evaluate(const PreparedModel& model, const VectorGeometries<float>& geometries, std::span<float> out,
              const BatchOptions& options) {
  require_size(16 * geometries.incident.x.size(), "elements", out.size());
  run_vectors(model, geometries, rows(out.data()), options);
}

void evaluate(const PreparedModel& model, const VectorGeometries<double>& geometries, const MuellerColumns<double>& out,
              const BatchOptions& options) {
  run_vectors(model, geometries, columns(out, geometries.incident.x.size()), options);
}

void evaluate(const PreparedModel& model, const VectorGeometries<float>& geometries, const MuellerColumns<float>& out,
              const BatchOptions& options) {
  run_vectors(model, geometries, columns(out, geometries.incident.x.size()), options);
}

void evaluate(const PreparedIncidence& model, std::span<const Direction> reflected, std::span<Mueller> out,
              const BatchOptions& options) {
  require_size(reflected.size(), "directions", out.size());
  if (!options.wavelengths.empty()) throw std::invalid_argument("wavelengths for one incident direction");
  require_valid(reflected, options.threads);
  run_angles(BatchQuestion<double>(model, options.frame), reflected, out, options.threads, [&](std::size_t q) {
    return Geometry{model.incident(), reflected[q]};
  });
}

void evaluate(const PreparedIncidence& model, const UnitVectors<double>& reflected, std::span<Mueller> out,
              const BatchOptions& options) {
  require_size(reflected.x.size(), "directions", out.size());
  run_vectors(model, reflected, rows(first_number(out)), options);
}

void evaluate(const PreparedIncidence& model, const UnitVectors<double>& reflected, const MuellerColumns<double>& out,
              const BatchOptions& options) {
  run_vectors(model, reflected, columns(out, reflected.x.size()), options);
}

void evaluate(const PreparedIncidence& model, const UnitVectors<float>& reflected, std::span<float> out,
              const BatchOptions& options) {
  require_size(16 * reflected.x.size(), "elements", out.size());
  run_vectors(model, reflected, rows(out.data()), options);
}

void evaluate(const PreparedIncidence& model, const UnitVectors<float>& reflected, const MuellerColumns<float>& out,
              const BatchOptions& options) {
  run_vectors(model, reflected, columns(out, reflected.x.size()), options);
}

}  // namespace mmbrdf
