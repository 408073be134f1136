// SPDX-License-Identifier: BSD-3-Clause
/// What several tests ask: random numbers, and the words of a refusal.
#pragma once

#include <rapidcheck.h>

#include <functional>
#include <stdexcept>
#include <string>

namespace mmbrdf {

/// Any number of the interval. inRange() alone begins with numbers near `low`.
inline double between(double low, double high) {
  return low + (high - low) * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1000001)) * 1e-6;
}

/// What std::invalid_argument says.
inline std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

}  // namespace mmbrdf
