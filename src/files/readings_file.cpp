// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/readings_file.hpp"
#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/files/write_file.hpp"
#include "mmbrdf/polarimetry/measurement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <stdexcept>
#include <unordered_map>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

int column_of(const CsvReader& reader, std::string_view name) { return reader.find({&name, 1}); }

int needed_column(const CsvReader& reader, std::string_view name) {
  const int column = column_of(reader, name);
  if (column < 0) throw reader.error("no column " + std::string(name));
  return column;
}

/// A field and its value, for messages.
std::string shown(const CsvReader& reader, int column) {
  return reader.columns()[static_cast<std::size_t>(column)] + ": " + printable(reader.field(column), 40);
}

/// One row: the reading of one state.
struct Reading {
  long measurement = 0;
  std::size_t generator = 0, analyzer = 0;  ///< from 0
  double value = 0;
};

class ReadingColumns {
 public:
  ReadingColumns(const CsvReader& reader, double saturation)
      : number_(needed_column(reader, "number")),
        generator_(needed_column(reader, "generator_state")),
        analyzer_(needed_column(reader, "analyzer_state")),
        intensity_(needed_column(reader, "intensity")),
        dark_(column_of(reader, "dark")),
        divisors_{column_of(reader, "monitor"), column_of(reader, "gain")},
        saturation_(saturation) {}

  Reading reading(const CsvReader& reader) const {
    return {measurement(reader), state(reader, generator_), state(reader, analyzer_), value(reader)};
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
    if (intensity >= saturation_)
      throw reader.error(shown(reader, intensity_) + " is saturated, at or above " + shortest(saturation_));
    if (intensity < dark)
      throw reader.error(shown(reader, intensity_) + " is " +
                         (dark_ < 0 ? "negative" : "below dark " + shortest(dark)));
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
    return result;
  }

  int number_, generator_, analyzer_, intensity_, dark_;
  std::array<int, 2> divisors_;
  double saturation_;
};

/// The readings of one measurement, in any order.
struct Collected {
  struct Entry {
    Reading reading;
    long line = 0;
  };
  std::vector<Entry> entries;
  std::unordered_map<std::size_t, long> lines;  ///< of each state that has been read

  void add(const CsvReader& reader, const Reading& reading) {
    const auto [there, added] = lines.try_emplace(reading.analyzer * most_states + reading.generator, reader.line());
    if (!added)
      throw reader.error(of(reading.measurement) + "a second reading of " + name(reading) + ", the first is in line " +
                         std::to_string(there->second));
    entries.push_back({reading, reader.line()});
  }

  /// In the order of polarimeter.hpp. The complaint about a missing one is that of `complain`, with its text.
  template <class Complain>
  std::vector<double> ordered(const StateCounts& states, Complain complain) const {
    std::vector<double> values(states.generator * states.analyzer, std::nan(""));
    for (const auto& [reading, line] : entries)
      values[reading.analyzer * states.generator + reading.generator] = reading.value;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (std::isnan(values[i]))
        throw complain(of(entries[0].reading.measurement) + "no reading of " +
                       name({0, i % states.generator, i / states.generator, 0}));
    return values;
  }

  static std::string of(long measurement) { return "measurement " + std::to_string(measurement) + ": "; }
  static std::string name(const Reading& reading) {
    return "generator state " + std::to_string(reading.generator + 1) + ", analyzer state " +
           std::to_string(reading.analyzer + 1);
  }
};

/// Wavelengths and angles of one measurement may not differ between its rows.
void require_same(const CsvReader& reader, long measurement, bool same, const std::string& what, long line) {
  if (!same)
    throw reader.error(Collected::of(measurement) + "another " + what + " than in line " + std::to_string(line));
}

// ---- references -----------------------------------------------------------------------------------------------------

class ReferenceColumns {
 public:
  explicit ReferenceColumns(const CsvReader& reader)
      : wavelength_(needed_column(reader, "wavelength_nm")),
        kind_(needed_column(reader, "reference")),
        angle_(needed_column(reader, "angle_deg")),
        s_exceeds_p_(column_of(reader, "s_exceeds_p")),
        delta_sign_(column_of(reader, "delta_sign")) {}

  double wavelength(const CsvReader& reader) const {
    const double value = reader.number(wavelength_);
    if (!(value > 0)) throw reader.error(shown(reader, wavelength_) + ": a wavelength must be positive");
    return value / 1000;
  }

  Reference reference(const CsvReader& reader) const {
    Reference result;
    try {
      result.kind = reference_kind_from(std::string(reader.field(kind_)));
    } catch (const std::invalid_argument&) {
      throw reader.error("reference: " + in_quotes(reader.field(kind_)) + " is not one of empty, polarizer, wafer");
    }
    const double angle = reader.number(angle_);
    if (result.kind == ReferenceKind::wafer && !(angle >= 0 && angle < 90))
      throw reader.error(shown(reader, angle_) + " degrees; the angle of incidence is in 0 ... 90, without 90");
    result.angle = radians(angle);
    result.s_exceeds_p = sign(reader, s_exceeds_p_);
    result.delta_sign = sign(reader, delta_sign_);
    return result;
  }

 private:
  static int sign(const CsvReader& reader, int column) {
    if (column < 0 || reader.field(column).empty()) return 0;
    const double value = reader.number(column);
    if (value != 0 && value != 1 && value != -1) throw reader.error(shown(reader, column) + " is not one of 1, -1, 0");
    return static_cast<int>(value);
  }

  int wavelength_, kind_, angle_, s_exceeds_p_, delta_sign_;
};

struct CollectedReference {
  Reference reference;
  Collected readings;
};

/// References in the order in which they begin, and where the one with a number is.
struct CollectedReferences {
  std::vector<CollectedReference> all;
  std::unordered_map<long, std::size_t> places;

  CollectedReference& numbered(long number, const Reference& reference) {
    const auto [there, added] = places.try_emplace(number, all.size());
    return added ? all.emplace_back(CollectedReference{reference, {}}) : all[there->second];
  }
};

void require_same(const CsvReader& reader, const CollectedReference& collected, const Reference& row, long number) {
  if (collected.readings.entries.empty()) return;
  const Reference& first = collected.reference;
  const long line = collected.readings.entries[0].line;
  require_same(reader, number, first.kind == row.kind, "reference", line);
  require_same(reader, number, first.angle == row.angle, "angle_deg", line);
  require_same(reader, number, first.s_exceeds_p == row.s_exceeds_p, "s_exceeds_p", line);
  require_same(reader, number, first.delta_sign == row.delta_sign, "delta_sign", line);
}

std::size_t checked_size(const std::vector<double>& readings, const StateCounts& states) {
  const std::size_t expected = states.generator * states.analyzer;
  if (readings.size() != expected)
    throw std::invalid_argument(std::to_string(readings.size()) + " readings in place of " + std::to_string(expected));
  return expected;
}

/// ",3,1,2,0.25": measurement, states and reading.
void write_reading(std::ostream& out, std::size_t measurement, const StateCounts& states, std::size_t i, double value) {
  out << ',' << measurement << ',' << i % states.generator + 1 << ',' << i / states.generator + 1 << ','
      << shortest(value);
}

}  // namespace

ReferenceFile read_references(std::istream& in, const std::string& name, double saturation) {
  CsvReader reader(in, name);
  const ReferenceColumns columns(reader);
  const ReadingColumns readings(reader, saturation);
  CollectedReferences collection;
  ReferenceFile result{0, {0, 0}, {}};
  long first_line = 0, line_of_highest = 0;
  while (reader.next()) {
    const double wavelength = columns.wavelength(reader);
    if (first_line == 0) {
      result.wavelength = wavelength;
      first_line = reader.line();
    }
    if (!same_wavelength(wavelength, result.wavelength))
      throw reader.error("wavelength_nm: " + shortest(in_nanometres(wavelength)) + ", but " +
                         shortest(in_nanometres(result.wavelength)) + " in line " + std::to_string(first_line) +
                         ": a calibration is of one wavelength");
    const Reference row = columns.reference(reader);
    const Reading reading = readings.reading(reader);
    CollectedReference& collected = collection.numbered(reading.measurement, row);
    require_same(reader, collected, row, reading.measurement);
    collected.readings.add(reader, reading);
    const StateCounts before = result.states;
    result.states.generator = std::max(before.generator, reading.generator + 1);
    result.states.analyzer = std::max(before.analyzer, reading.analyzer + 1);
    if (result.states != before) line_of_highest = reader.line();
  }
  if (collection.all.empty()) throw std::runtime_error(name + ": no readings after the header line");
  for (CollectedReference& collected : collection.all) {
    const long last = collected.readings.entries.back().line;
    collected.reference.readings = collected.readings.ordered(result.states, [&](const std::string& text) {
      return std::runtime_error(name + ":" + std::to_string(last) + ": " + text + "; the highest state is in line " +
                                std::to_string(line_of_highest));
    });
    result.references.push_back(std::move(collected.reference));
  }
  return result;
}

ReferenceFile read_references(const std::string& path, double saturation) {
  std::ifstream in = open_input(path);
  return read_references(in, path, saturation);
}

void write_references(std::ostream& out, const ReferenceFile& file) {
  if (!(file.wavelength > 0))
    throw std::invalid_argument("wavelength " + shortest(in_nanometres(file.wavelength)) + " nm, must be positive");
  out << "wavelength_nm,reference,angle_deg,s_exceeds_p,delta_sign,number,generator_state,analyzer_state,intensity\n";
  for (std::size_t r = 0; r < file.references.size(); ++r) {
    const Reference& reference = file.references[r];
    const std::size_t count = checked_size(reference.readings, file.states);
    for (std::size_t i = 0; i < count; ++i) {
      out << shortest(in_nanometres(file.wavelength)) << ',' << to_string(reference.kind) << ','
          << shortest(in_degrees(reference.angle)) << ',' << reference.s_exceeds_p << ',' << reference.delta_sign;
      write_reading(out, r + 1, file.states, i, reference.readings[i]);
      out << '\n';
    }
  }
}

void write_references(const std::string& path, const ReferenceFile& file) {
  write_file(path, [&](std::ostream& out) { write_references(out, file); });
}

// ---- samples --------------------------------------------------------------------------------------------------------

/// A row is read ahead: the one that begins the next measurement.
struct RawReader::State {
  std::string name;
  CsvReader reader;
  GeometryColumns geometry;
  ReadingColumns columns;
  StateCounts states;
  bool begun = false, waiting = false;
  RawMeasurement row;  ///< wavelength and geometry of the row
  Reading reading;
  long last_line = 0;

  State(std::istream& in, const std::string& file, const StateCounts& counts, double saturation)
      : name(file), reader(in, file), geometry(reader), columns(reader, saturation), states(counts) {}

  void read_row() {
    waiting = reader.next();
    if (!waiting) return;
    row.wavelength = geometry.wavelength(reader);
    row.geometry = geometry.geometry(reader);
    reading = columns.reading(reader);
    if (reading.generator >= states.generator || reading.analyzer >= states.analyzer)
      throw reader.error(Collected::name(reading) + ": the instrument has " + std::to_string(states.generator) +
                         " generator and " + std::to_string(states.analyzer) + " analyzer states");
  }

  std::runtime_error error(const std::string& text) const {
    return std::runtime_error(name + ":" + std::to_string(last_line) + ": " + text);
  }
};

RawReader::RawReader(std::istream& in, const std::string& name, const StateCounts& states, double saturation)
    : state_(std::make_unique<State>(in, name, states, saturation)) {}

RawReader::~RawReader() = default;

bool RawReader::next(RawMeasurement& measurement) {
  State& s = *state_;
  if (!s.begun) {
    s.read_row();
    s.begun = true;
    if (!s.waiting) throw std::runtime_error(s.name + ": no readings after the header line");
  }
  if (!s.waiting) return false;
  measurement = s.row;
  const long number = s.reading.measurement, first = s.reader.line();
  Collected collected;
  while (s.waiting && s.reading.measurement == number) {
    require_same(s.reader, number, same_wavelength(s.row.wavelength, measurement.wavelength), "wavelength", first);
    require_same(s.reader, number, s.row.geometry == measurement.geometry, "direction", first);
    collected.add(s.reader, s.reading);
    s.last_line = s.reader.line();
    s.read_row();
  }
  measurement.readings =
      collected.ordered(s.states, [&](const std::string& text) { return s.error(text + " among its adjacent rows"); });
  return true;
}

std::runtime_error RawReader::error(const std::string& text) const { return state_->error(text); }

void write_raw(std::ostream& out, const StateCounts& states, std::span<const RawMeasurement> measurements) {
  out << "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,number,generator_state,analyzer_state,intensity\n";
  for (std::size_t m = 0; m < measurements.size(); ++m) {
    const auto& [wavelength, geometry, readings] = measurements[m];
    std::string begin = shortest(in_nanometres(wavelength));
    for (const Direction& direction : {geometry.incident, geometry.reflected})
      begin += ',' + shortest(in_degrees(direction.theta)) + ',' + shortest(in_degrees(direction.phi));
    for (std::size_t i = 0; i < checked_size(readings, states); ++i) {
      out << begin;
      write_reading(out, m + 1, states, i, readings[i]);
      out << '\n';
    }
  }
}

void write_raw(const std::string& path, const StateCounts& states, std::span<const RawMeasurement> measurements) {
  write_file(path, [&](std::ostream& out) { write_raw(out, states, measurements); });
}

}  // namespace mmbrdf
