// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace mmbrdf::program {

/// What was made for the wavelengths that were asked for lately.
template <class T>
class RecentWavelengths {
 public:
  /// At most `most` are kept.
  explicit RecentWavelengths(std::function<T(double)> make, std::size_t most = 16)
      : make_{std::move(make)}, most_{most} {}

  /// Valid until the next call.
  T& at(double wavelength) {
    if (last_ == entries_.size() || entries_[last_].first != wavelength) {
      const auto known =
          std::find_if(entries_.begin(), entries_.end(), [=](const auto& entry) { return entry.first == wavelength; });
      last_ = static_cast<std::size_t>(known - entries_.begin());
      if (known == entries_.end()) add(wavelength);
    }
    return entries_[last_].second;
  }

 private:
  void add(double wavelength) {
    if (entries_.size() < most_) {
      entries_.emplace_back(wavelength, make_(wavelength));
      last_ = entries_.size() - 1;
    } else {
      entries_[oldest_] = {wavelength, make_(wavelength)};
      last_ = oldest_;
      oldest_ = (oldest_ + 1) % most_;
    }
  }

  std::function<T(double)> make_;
  std::size_t most_;
  std::vector<std::pair<double, T>> entries_;
  std::size_t last_ = 0, oldest_ = 0;
};

}  // namespace mmbrdf::program
