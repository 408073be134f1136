// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/text/date.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "text/numbers.hpp"

namespace mmbrdf {

std::string utc_timestamp() {
  namespace chrono = std::chrono;
  auto at = chrono::floor<chrono::seconds>(chrono::system_clock::now());
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH")) {
    double seconds = -1;
    try {
      seconds = parse_number(epoch);
    } catch (const std::invalid_argument&) {  // said below
    }
    if (!(seconds >= 0 && seconds < 253402300800.0) || seconds != std::floor(seconds))
      throw std::invalid_argument("SOURCE_DATE_EPOCH = " + in_quotes(epoch) + ": must be whole seconds since 1970");
    at = chrono::sys_seconds(chrono::seconds(static_cast<long>(seconds)));
  }
  const auto day = chrono::floor<chrono::days>(at);
  const chrono::year_month_day date(day);
  const chrono::hh_mm_ss time(at - day);
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02ld:%02ld:%02ld+00:00", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                static_cast<long>(time.hours().count()), static_cast<long>(time.minutes().count()),
                static_cast<long>(time.seconds().count()));
  return text.data();
}

}  // namespace mmbrdf
