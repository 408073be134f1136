// SPDX-License-Identifier: BSD-3-Clause
/// What is prepared for one wavelength, kept for all that were asked for.
#pragma once

#include <map>
#include <utility>

namespace mmbrdf {

/// AtWavelengths prepared([&](double wavelength) { return prepare(model, wavelength); });   prepared(0.532) …
/// Prepares at most once for each wavelength (micrometres); throws what that throws. References stay valid. Not for
/// several threads at once.
template <class Prepare>
class AtWavelengths {
 public:
  explicit AtWavelengths(Prepare prepare) : prepare_(std::move(prepare)) {}

  const auto& operator()(double wavelength) {
    const auto at = prepared_.find(wavelength);
    return at != prepared_.end() ? at->second : prepared_.emplace(wavelength, prepare_(wavelength)).first->second;
  }

 private:
  Prepare prepare_;
  std::map<double, decltype(std::declval<Prepare&>()(0.0))> prepared_;
};

}  // namespace mmbrdf
