// SPDX-License-Identifier: BSD-3-Clause
/// What all functions that index.js calls share: how they fail, and how they hand over facts.
#pragma once

#include <cstddef>
#include <exception>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/polarization/mueller.hpp"

namespace mmbrdf::web {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

inline std::string last_error;  ///< for error_text()

/// What work() returns, or 0 and the message of what it throws.
template <class Work>
auto guarded(Work work) noexcept -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception& e) {
    last_error = e.what();
  } catch (...) {
    last_error = "unknown error";
  }
  return {};
}

/// Good until the next one.
inline const char* text_of(const nlohmann::ordered_json& json) {
  static std::string text;
  text = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return text.c_str();
}

inline StokesConvention convention_numbered(int number) { return static_cast<StokesConvention>(number); }
inline Frame frame_numbered(int number) { return static_cast<Frame>(number); }

}  // namespace mmbrdf::web
