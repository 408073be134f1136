// SPDX-License-Identifier: BSD-3-Clause
// Measured samples, for index.js: binding.cpp says how.
#include <emscripten.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "binding.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "mmbrdf/text/units.hpp"

using namespace mmbrdf;
using namespace mmbrdf::web;
using nlohmann::ordered_json;

namespace {

struct Samples {
  std::vector<Sample> all;
  std::vector<double> places;  // of each: wavelength in nanometres, four angles in degrees
  std::string understood;

  void add(const Sample& sample) {
    all.push_back(sample);
    const auto& [incident, reflected] = sample.geometry;
    places.push_back(in_nanometres(sample.wavelength));
    for (const double angle : {incident.theta, incident.phi, reflected.theta, reflected.phi})
      places.push_back(in_degrees(angle));
  }
};

/// A table while it is read.
struct Reading {
  std::istringstream in;
  SampleReader reader;
  Samples samples;

  Reading(const std::string& text, const char* path) : in(text), reader(in, path) {}
};

/// Element 11 of f11, the others as they are or divided by it; unknown ones are NaN, not 0.
Mueller uncertainty_of(const Sample& sample, bool divided) {
  Mueller u = divided ? sample.uncertainty : standard_uncertainty(covariance(sample));
  for (double& one : u.elements)
    if (!(one > 0)) one = unknown;
  return u;
}

}  // namespace

extern "C" {

/// Whether a file begins as one of samples; not so of one that there is no memory for, which no reader takes.
EMSCRIPTEN_KEEPALIVE int samples_are_in(const char* text, std::size_t length) {
  return guarded([&] {
    std::istringstream in(std::string(text, length));
    return static_cast<int>(holds_samples(in));
  });
}

EMSCRIPTEN_KEEPALIVE Reading* reading_begun(const char* text, std::size_t length, const char* path) {
  return guarded([&] { return new Reading(std::string(text, length), path); });
}

enum : int { failed, goes_on, at_end };

/// At most so many rows more.
EMSCRIPTEN_KEEPALIVE int reading_continued(Reading* reading, std::size_t rows) {
  return guarded([&]() -> int {
    for (Sample sample; rows > 0; --rows) {
      if (!reading->reader.next(sample)) return at_end;
      reading->samples.add(sample);
    }
    return goes_on;
  });
}

/// Bytes that were read. Asked of the buffer: at the end the stream has none.
EMSCRIPTEN_KEEPALIVE double reading_position(Reading* reading) {
  return static_cast<double>(reading->in.rdbuf()->pubseekoff(0, std::ios::cur, std::ios::in));
}

EMSCRIPTEN_KEEPALIVE std::size_t reading_count(const Reading* reading) { return reading->samples.all.size(); }

/// What was read, which the reading then has no more.
EMSCRIPTEN_KEEPALIVE Samples* reading_ended(Reading* reading) {
  return guarded([&] {
    reading->samples.understood = reading->reader.understood();
    return new Samples(std::move(reading->samples));
  });
}

EMSCRIPTEN_KEEPALIVE void free_reading(Reading* reading) { delete reading; }

EMSCRIPTEN_KEEPALIVE void free_samples(Samples* samples) { delete samples; }

EMSCRIPTEN_KEEPALIVE const char* describe_samples(const Samples* samples) {
  return guarded([&] {
    ordered_json json = {{"count", samples->all.size()}, {"understood", samples->understood}};
    json["hasUncertainty"] = std::ranges::all_of(samples->all, has_uncertainty, in_own_frame);
    json["wavelengths"] = json["measured"] = ordered_json::array();
    for (const double wavelength : wavelengths(samples->all)) json["wavelengths"].push_back(in_nanometres(wavelength));
    const Elements measured = measured_elements(samples->all);
    for (std::size_t e = 0; e < 16; ++e)
      if (measured[e]) json["measured"].push_back(sample_element(e));
    return text_of(json);
  });
}

/// Wavelength in nanometres and four angles in degrees of each.
EMSCRIPTEN_KEEPALIVE const double* places_of_samples(const Samples* samples) { return samples->places.data(); }

/// Of those with these numbers, counted from 0.
EMSCRIPTEN_KEEPALIVE int elements_of_samples(const Samples* samples, const std::uint32_t* which, std::size_t count,
                                             int frame, int convention, int divided, Mueller* values,
                                             Mueller* uncertainties) {
  return guarded([&] {
    for (std::size_t i = 0; i < count; ++i) {
      const Sample sample = in_frame(samples->all.at(which[i]), frame_numbered(frame));
      Mueller m = divided ? sample.normalized : measured_matrix(sample);
      m(0, 0) = sample.f11;
      values[i] = convert(m, StokesConvention::germer2017, convention_numbered(convention));
      uncertainties[i] = uncertainty_of(sample, divided != 0);
    }
    return 1;
  });
}

/// One list of `count` for each quantity of the table.
EMSCRIPTEN_KEEPALIVE int quantities_of_samples(const Samples* samples, const std::uint32_t* which, std::size_t count,
                                               double* values, double* uncertainties) {
  return guarded([&] {
    for (std::size_t i = 0; i < count; ++i) {
      const std::vector<Answered> answers = quantities_of(samples->all.at(which[i]));
      for (std::size_t q = 0; q < answers.size(); ++q) {
        values[q * count + i] = answers[q].value.value_or(unknown);
        uncertainties[q * count + i] = answers[q].uncertainty.value_or(unknown);
      }
    }
    return 1;
  });
}

}  // extern "C"
