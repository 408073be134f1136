// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/readings_file.hpp"
#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/files/write_file.hpp"
#include "mmbrdf/polarimetry/measurement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <ostream>
#include <set>
#include <stdexcept>
#include <unordered_map>

#include "files/reading_columns.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// By analysis state, then by generator state: the order of polarimeter.hpp.
std::size_t place(const StatePair& pair) { return pair.analyzer * most_states + pair.generator; }

std::vector<StatePair> grid(const ReadStates& states) {
  std::vector<StatePair> all;
  for (std::size_t i = 0; i < states.generator * states.analyzer; ++i)
    all.push_back({i % states.generator, i / states.generator});
  return all;
}

std::vector<StatePair> pairs_of(const ReadStates& states) { return states.pairs.empty() ? grid(states) : states.pairs; }

constexpr std::string_view reference_names[] = {"wavelength_nm",   "reference",      "angle_deg", "number",
                                                "generator_state", "analyzer_state", "intensity"};

/// The readings of one measurement, in any order.
struct Collected {
  struct Entry {
    Reading reading;
    long line = 0;
  };
  std::map<std::size_t, Entry> entries;  ///< by place()
  long number = 0, first_line = 0, last_line = 0;

  void add(const CsvReader& reader, const Reading& reading) {
    const auto [there, added] = entries.try_emplace(place(reading.states), Entry{reading, reader.line()});
    if (!added)
      throw reader.error(of(reading.measurement) + "a second reading of " + to_string(reading.states) +
                         ", the first is in line " + std::to_string(there->second.line));
    if (first_line == 0) first_line = reader.line();
    last_line = reader.line();
    number = reading.measurement;
  }

  std::vector<StatePair> pairs() const {
    std::vector<StatePair> result;
    for (const auto& [at, entry] : entries) result.push_back(entry.reading.states);
    return result;
  }

  /// Of these pairs. The complaint about a missing one is that of `complain`, with its text.
  template <class Complain>
  std::vector<double> ordered(const std::vector<StatePair>& pairs, Complain complain) const {
    std::vector<double> values;
    for (const StatePair& pair : pairs) {
      const auto there = entries.find(place(pair));
      if (there == entries.end()) throw complain(of(number) + "no reading of " + to_string(pair));
      values.push_back(there->second.reading.value);
    }
    return values;
  }

  static std::string of(long measurement) { return "measurement " + std::to_string(measurement) + ": "; }
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
      throw reader.error("reference: " + in_quotes(reader.field(kind_)) +
                         " is not one of empty, polarizer, wafer, retarder");
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
  const long line = collected.readings.first_line;
  require_same(reader, number, first.kind == row.kind, "reference", line);
  require_same(reader, number, first.angle == row.angle, "angle_deg", line);
  require_same(reader, number, first.s_exceeds_p == row.s_exceeds_p, "s_exceeds_p", line);
  require_same(reader, number, first.delta_sign == row.delta_sign, "delta_sign", line);
}

void require_count(const std::vector<double>& readings, std::size_t expected) {
  if (readings.size() != expected)
    throw std::invalid_argument(std::to_string(readings.size()) + " readings in place of " + std::to_string(expected));
}

/// ",3,1,2,0.25": measurement, states and reading.
void write_reading(std::ostream& out, std::size_t measurement, const StatePair& states, double value) {
  out << ',' << measurement << ',' << states.generator + 1 << ',' << states.analyzer + 1 << ',' << shortest(value);
}

/// All that any reference has; none if that is a whole grid.
std::vector<StatePair> pairs_of(const CollectedReferences& references, const ReadStates& states) {
  std::map<std::size_t, StatePair> all;
  for (const CollectedReference& reference : references.all)
    for (const StatePair& pair : reference.readings.pairs()) all.emplace(place(pair), pair);
  std::vector<StatePair> result;
  if (all.size() < states.generator * states.analyzer)
    for (const auto& [at, pair] : all) result.push_back(pair);
  return result;
}

}  // namespace

ReadStates read_states(const Polarimeter& polarimeter) {
  return {polarimeter.generator.size(), polarimeter.analyzer.size(), polarimeter.pairs};
}

ReferenceFile read_references(std::istream& in, const std::string& name, const ReadingLimits& limits) {
  CsvReader reader(in, name);
  const ReferenceColumns columns(with_columns(reader, reference_names));
  const ReadingColumns readings(reader, limits);
  CollectedReferences collection;
  ReferenceFile result{0, {0, 0, {}}, {}};
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
    const ReadStates before = result.states;
    result.states.generator = std::max(before.generator, reading.states.generator + 1);
    result.states.analyzer = std::max(before.analyzer, reading.states.analyzer + 1);
    if (result.states != before) line_of_highest = reader.line();
  }
  if (collection.all.empty()) throw std::runtime_error(name + ": no readings after the header line");
  result.states.pairs = pairs_of(collection, result.states);
  const std::vector<StatePair> pairs = pairs_of(result.states);
  for (CollectedReference& collected : collection.all) {
    collected.reference.readings = collected.readings.ordered(pairs, [&](const std::string& text) {
      return std::runtime_error(name + ":" + std::to_string(collected.readings.last_line) + ": " + text +
                                (result.states.pairs.empty()
                                     ? "; the highest state is in line " + std::to_string(line_of_highest)
                                     : ", which other references have"));
    });
    result.references.push_back(std::move(collected.reference));
  }
  return result;
}

ReferenceFile read_references(const std::string& path, const ReadingLimits& limits) {
  std::ifstream in = open_input(path);
  return read_references(in, path, limits);
}

void write_references(std::ostream& out, const ReferenceFile& file) {
  if (!(file.wavelength > 0))
    throw std::invalid_argument("wavelength " + shortest(in_nanometres(file.wavelength)) + " nm, must be positive");
  out << "wavelength_nm,reference,angle_deg,s_exceeds_p,delta_sign,number,generator_state,analyzer_state,intensity\n";
  const std::vector<StatePair> pairs = pairs_of(file.states);
  for (std::size_t r = 0; r < file.references.size(); ++r) {
    const Reference& reference = file.references[r];
    require_count(reference.readings, pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      out << shortest(in_nanometres(file.wavelength)) << ',' << to_string(reference.kind) << ','
          << shortest(in_degrees(reference.angle)) << ',' << reference.s_exceeds_p << ',' << reference.delta_sign;
      write_reading(out, r + 1, pairs[i], reference.readings[i]);
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
  ReadStates states;
  std::vector<StatePair> all;
  std::set<long> incomplete;  ///< numbers of measurements that have not all pairs
  bool begun = false, waiting = false;
  RawMeasurement row;  ///< wavelength and geometry of the row
  Reading reading;
  long last_line = 0;

  State(std::istream& in, const std::string& file, const ReadStates& read, const ReadingLimits& limits)
      : name(file),
        reader(in, file),
        geometry(reader),
        columns(with_columns(reader, reading_names), limits),
        states(read),
        all(pairs_of(read)) {}

  void read_row() {
    waiting = reader.next();
    if (!waiting) return;
    row.wavelength = geometry.wavelength(reader);
    row.geometry = geometry.geometry(reader);
    reading = columns.reading(reader);
    if (reading.states.generator >= states.generator || reading.states.analyzer >= states.analyzer)
      throw reader.error(to_string(reading.states) + ": the instrument has " + std::to_string(states.generator) +
                         " generator and " + std::to_string(states.analyzer) + " analyzer states");
  }

  std::runtime_error error(const std::string& text) const {
    return std::runtime_error(name + ":" + std::to_string(last_line) + ": " + text);
  }
};

RawReader::RawReader(std::istream& in, const std::string& name, const ReadStates& states, const ReadingLimits& limits)
    : state_(std::make_unique<State>(in, name, states, limits)) {}

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
  measurement.pairs = collected.pairs();
  measurement.readings = collected.ordered(measurement.pairs, [&](const std::string& text) { return s.error(text); });
  if (measurement.pairs == s.all)
    measurement.pairs.clear();
  else if (!s.incomplete.insert(number).second)
    throw s.error(Collected::of(number) + "began further up: its rows must be adjacent");
  return true;
}

std::runtime_error RawReader::error(const std::string& text) const { return state_->error(text); }

void write_raw(std::ostream& out, const ReadStates& states, std::span<const RawMeasurement> measurements) {
  out << "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,number,generator_state,analyzer_state,intensity\n";
  const std::vector<StatePair> all = pairs_of(states);
  for (std::size_t m = 0; m < measurements.size(); ++m) {
    const auto& [wavelength, geometry, readings, own] = measurements[m];
    const std::vector<StatePair>& pairs = own.empty() ? all : own;
    require_count(readings, pairs.size());
    std::string begin = shortest(in_nanometres(wavelength));
    for (const Direction& direction : {geometry.incident, geometry.reflected})
      begin += ',' + shortest(in_degrees(direction.theta)) + ',' + shortest(in_degrees(direction.phi));
    for (std::size_t i = 0; i < readings.size(); ++i) {
      out << begin;
      write_reading(out, m + 1, pairs[i], readings[i]);
      out << '\n';
    }
  }
}

std::string reduction_text(const std::string& readings, const std::string& instrument, double solid_angle,
                           const ReadingNoise& noise, double saturation) {
  constexpr std::size_t longest_name = 200;
  std::string law;
  for (const auto& [name, value] : {std::pair("dark", noise.dark), {"shot", noise.shot}, {"relative", noise.relative}})
    if (value > 0) law += (law.empty() ? "" : ",") + std::string(name) + ":" + shortest(value);
  std::string text = printable(readings, longest_name) + " by " + printable(instrument, longest_name) +
                     ", solid angle " + shortest(solid_angle) + " sr, noise " + (law.empty() ? "none" : law);
  if (saturation < never_saturated) text += ", saturation " + shortest(saturation);
  return text;
}

void write_raw(const std::string& path, const ReadStates& states, std::span<const RawMeasurement> measurements) {
  write_file(path, [&](std::ostream& out) { write_raw(out, states, measurements); });
}

}  // namespace mmbrdf
