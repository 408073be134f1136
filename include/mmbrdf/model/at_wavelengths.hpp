// SPDX-License-Identifier: BSD-3-Clause
/// What is prepared for one wavelength, kept for those that were asked for.
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <utility>

namespace mmbrdf {

/// AtWavelengths prepared([&](double wavelength) { return prepare(model, wavelength); });   prepared(0.532) …
/// Prepares once for each wavelength (micrometres); throws what that throws. References stay valid until one more than
/// `most` is asked for, which makes it forget all before. Not for several threads at once.
template <class Prepare>
class AtWavelengths {
 public:
  explicit AtWavelengths(Prepare prepare, std::size_t most = std::numeric_limits<std::size_t>::max())
      : prepare_(std::move(prepare)), most_(most) {}

  const auto& operator()(double wavelength) {
    const auto at = prepared_.find(wavelength);
    if (at != prepared_.end()) return at->second;
    if (prepared_.size() >= most_) prepared_.clear();
    return prepared_.emplace(wavelength, prepare_(wavelength)).first->second;
  }

 private:
  Prepare prepare_;
  std::size_t most_;
  std::map<double, decltype(std::declval<Prepare&>()(0.0))> prepared_;
};

}  // namespace mmbrdf
