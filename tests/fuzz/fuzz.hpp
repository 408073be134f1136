// SPDX-License-Identifier: BSD-3-Clause
/// What the targets share. What is read may be refused by an exception; what is accepted must be usable, and whatever is
/// thrown then, or is not a number, is a finding.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>

#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/model/model.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf::fuzz {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// What `read` gives, or nothing where it refuses with one of the library's two exceptions.
template <class Read>
auto unless_refused(Read read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const std::invalid_argument&) {
  } catch (const std::runtime_error&) {
  }
  return {};
}

inline bool all_finite(std::span<const double> numbers) {
  for (const double number : numbers)
    if (!std::isfinite(number)) return false;
  return true;
}

/// But for elements that were not measured, which are NaN.
inline bool all_finite(const Mueller& m, const Elements& unknown) {
  for (std::size_t e = 0; e < 16; ++e)
    if (unknown[e] ? !std::isnan(m.elements[e]) : !std::isfinite(m.elements[e])) return false;
  return true;
}

/// Evaluates it at one of its wavelengths, with uncertainties where it knows them.
inline void require_usable(const Model& model) {
  const std::vector<double> wavelengths = known_wavelengths(model);
  const double wavelength = wavelengths.empty() ? 0.532 : wavelengths.front();
  const auto prepared = unless_refused([&] { return prepare(model, wavelength); });  // its powers may be too large
  if (!prepared) return;
  for (const Geometry& g : {Geometry{}, Geometry{{0.5, 0}, {1, 2}}, Geometry{{1.5, 1}, {1.5, -2}}})
    require(all_finite(prepared->evaluate(g), unknown_elements(model)), "a finite model has finite matrices");
  if (!knows_uncertainty(model)) return;
  const auto uncertainty = unless_refused([&] { return prepare_uncertainty(model, wavelength); });  // not semidefinite
  if (uncertainty)
    require(all_finite(standard_uncertainty(uncertainty->evaluate({{0.5, 0}, {1, 2}})), unknown_elements(model)),
            "and finite uncertainties");
}

}  // namespace mmbrdf::fuzz
