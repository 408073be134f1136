// SPDX-License-Identifier: BSD-3-Clause
// Measured samples, for index.js: binding.cpp says how.
#include <emscripten.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
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
  std::string understood;
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

EMSCRIPTEN_KEEPALIVE Samples* samples_read(const char* text, std::size_t length, const char* path) {
  return guarded([&] {
    std::istringstream in(std::string(text, length));
    SampleReader reader(in, path);
    Samples samples;
    for (Sample sample; reader.next(sample);) samples.all.push_back(sample);
    samples.understood = reader.understood();
    return new Samples(std::move(samples));
  });
}

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
EMSCRIPTEN_KEEPALIVE void places_of_samples(const Samples* samples, double* out) {
  for (const Sample& sample : samples->all) {
    const auto& [incident, reflected] = sample.geometry;
    *out++ = in_nanometres(sample.wavelength);
    for (const double angle : {incident.theta, incident.phi, reflected.theta, reflected.phi})
      *out++ = in_degrees(angle);
  }
}

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
