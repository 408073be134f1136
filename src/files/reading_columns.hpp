// SPDX-License-Identifier: BSD-3-Clause
/// The columns of one reading, in files of references and of samples.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/files/readings_file.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

inline int column_of(const CsvReader& reader, std::string_view name) { return reader.find({&name, 1}); }

inline int needed_column(const CsvReader& reader, std::string_view name) {
  const int column = column_of(reader, name);
  if (column < 0) throw reader.error("no column " + std::string(name));
  return column;
}

/// The reader, if it has all these columns. Throws std::runtime_error with the names of those it lacks.
inline const CsvReader& with_columns(const CsvReader& reader, std::span<const std::string_view> names) {
  std::string missing;
  for (const std::string_view name : names)
    if (column_of(reader, name) < 0) missing += (missing.empty() ? "" : ", ") + std::string(name);
  if (!missing.empty()) throw reader.error("no column " + missing);
  return reader;
}

inline constexpr std::string_view reading_names[] = {"number", "generator_state", "analyzer_state", "intensity"};

/// A field and its value, for messages.
inline std::string shown(const CsvReader& reader, int column) {
  return reader.columns()[static_cast<std::size_t>(column)] + ": " + printable(reader.field(column), 40);
}

/// One row: the reading of one state.
struct Reading {
  long measurement = 0;
  StatePair states;
  double value = 0;
};

class ReadingColumns {
 public:
  ReadingColumns(const CsvReader& reader, const ReadingLimits& limits)
      : number_(needed_column(reader, "number")),
        generator_(needed_column(reader, "generator_state")),
        analyzer_(needed_column(reader, "analyzer_state")),
        intensity_(needed_column(reader, "intensity")),
        dark_(column_of(reader, "dark")),
        divisors_{column_of(reader, "monitor"), column_of(reader, "gain")},
        limits_(limits) {}

  Reading reading(const CsvReader& reader) const {
    return {measurement(reader), {state(reader, generator_), state(reader, analyzer_)}, value(reader)};
  }

 private:
  long measurement(const CsvReader& reader) const {
    const double value = reader.number(number_);
    if (value != std::floor(value) || std::abs(value) > 1e15)
      throw reader.error(shown(reader, number_) + " is not an integer");
    return static_cast<long>(value);
  }

  static std::size_t state(const CsvReader& reader, int column) {
    const double value = reader.number(column);
    if (value != std::floor(value) || value < 1 || value > double(most_states))
      throw reader.error(shown(reader, column) + ": states are numbered from 1 to at most " +
                         std::to_string(most_states));
    return static_cast<std::size_t>(value) - 1;
  }

  double value(const CsvReader& reader) const {
    const double intensity = reader.number(intensity_), dark = dark_ < 0 ? 0 : reader.number(dark_);
    if (intensity >= limits_.saturation)
      throw reader.error(shown(reader, intensity_) + " is saturated, at or above " + shortest(limits_.saturation));
    double divisor = 1;
    for (const int column : divisors_) {
      if (column < 0) continue;
      const double factor = reader.number(column);
      if (!(factor > 0)) throw reader.error(shown(reader, column) + " is not positive");
      divisor *= factor;
    }
    const double result = (intensity - dark) / divisor;
    if (!std::isfinite(result))
      throw reader.error(shown(reader, intensity_) + " over its monitor and gain is not a finite number");
    if (result < -most_below_zero * limits_.dark_noise)
      throw reader.error(shown(reader, intensity_) + " is " +
                         (dark_ < 0 ? "negative" : "below dark " + shortest(dark)) + below_noise(result));
    return result;
  }

  /// Behind what is wrong with a reading below zero: by how much, or the way on.
  std::string below_noise(double reading) const {
    if (limits_.dark_noise == 0)
      return ": with --noise dark:X readings down to -" + shortest(most_below_zero) + " X pass";
    return ", " + rounded(-reading / limits_.dark_noise, 3) + " times the noise of the dark signal; at most " +
           shortest(most_below_zero);
  }

  int number_, generator_, analyzer_, intensity_, dark_;
  std::array<int, 2> divisors_;
  ReadingLimits limits_;
};

}  // namespace mmbrdf
