// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/simulation.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/noise.hpp"
#include "numerics/random.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

void require_no_grazing_detector(std::span<const Geometry> geometries) {
  for (const Geometry& g : geometries)
    if (std::cos(g.reflected.theta) < 1e-9)
      throw std::invalid_argument("theta_r = " + shortest(in_degrees(g.reflected.theta)) +
                                  " degrees, where the speckle noise is infinite");
}

Sample exact_sample(const PreparedModel& model, const Geometry& geometry) {
  const Mueller m = model.evaluate(geometry);
  if (!(m(0, 0) > 0))
    throw std::invalid_argument(
        "f11 = " + shortest(m(0, 0)) + " /sr at theta_i = " + shortest(in_degrees(geometry.incident.theta)) +
        ", theta_r = " + shortest(in_degrees(geometry.reflected.theta)) + " degrees, must be positive");
  return {model.wavelength(), geometry, m(0, 0), normalized(m)};
}

void add_noise(Sample& sample, double sigma, std::mt19937_64& engine) {
  sample.f11 *= 1 + sigma * normal(engine);
  for (std::size_t e = 1; e < 16; ++e) sample.normalized.elements[e] += sigma * normal(engine);
}

}  // namespace

std::vector<Sample> simulate(const Model& model, std::span<const double> wavelengths,
                             std::span<const Geometry> geometries, double speckle, unsigned long seed) {
  if (!(speckle >= 0 && std::isfinite(speckle)))
    throw std::invalid_argument("speckle = " + shortest(speckle) + ", must be finite and not negative");
  require_valid(model);
  for (const Geometry& geometry : geometries) require_valid(geometry);
  if (speckle > 0) require_no_grazing_detector(geometries);

  const NoiseLaw law{.scale = speckle, .incident_exponent = 1, .reflected_exponent = 1};
  std::mt19937_64 engine(~seed);  // not the stream from which random_geometries() makes directions with the same seed
  std::vector<Sample> samples;
  samples.reserve(wavelengths.size() * geometries.size());
  for (double wavelength : wavelengths) {
    const PreparedModel prepared = prepare(model, wavelength);
    for (const Geometry& geometry : geometries) {
      samples.push_back(exact_sample(prepared, geometry));
      if (speckle > 0) add_noise(samples.back(), standard_deviation(law, geometry), engine);
    }
  }
  return samples;
}

}  // namespace mmbrdf
