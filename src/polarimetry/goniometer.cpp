// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/goniometer.hpp"
#include "mmbrdf/model/prepared.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include "numerics/random.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// Draws of one seed for different purposes have nothing in common.
enum Stream : std::uint32_t { imperfections, references_of, readings_of };

void require_valid(const GoniometerOptions& o) {
  const Imperfections& i = o.imperfections;
  const std::array<double, 14> not_negative{
      i.retardance, i.azimuth,     i.diattenuation, i.circular_retardance, i.depolarization, i.stray,   o.extinction,
      o.dial_error, o.gain_change, o.noise.dark,    o.noise.shot,          o.noise.relative, o.speckle, o.solid_angle};
  for (const double value : not_negative)
    if (!(value >= 0 && std::isfinite(value)))
      throw std::invalid_argument(shortest(value) + " where a number that is not negative is needed");
  for (const double relative : {o.noise.relative, o.speckle, o.gain_change})
    if (relative > most_noise)
      throw std::invalid_argument("relative noise of " + shortest(relative) + ", at most " + shortest(most_noise));
  if (!std::isfinite(o.retardance) || !std::isfinite(o.polarizer_offset) || !std::isfinite(o.drift))
    throw std::invalid_argument("an option is not finite");
  if (!(o.solid_angle > 0)) throw std::invalid_argument("a solid angle of 0 sr");
}

/// A lossless element that turns linear polarization, as quartz along its axis does: R(−a/2).
Mueller circular_retarder(double retardance) { return rotator(-retardance / 2); }

/// The plates of one arm, state by state, as they are.
std::vector<Mueller> plates(const GoniometerOptions& o, std::mt19937_64& engine) {
  const Imperfections& i = o.imperfections;
  const double retardance = o.retardance + i.retardance * normal(engine);
  const double diattenuation = i.diattenuation * normal(engine);
  const double circular = i.circular_retardance * normal(engine);
  std::vector<Mueller> result;
  for (const double azimuth : o.azimuths) {
    const double keeps = 1 - std::abs(i.depolarization * normal(engine));
    const double psi = std::numbers::pi / 4 - std::asin(std::clamp(diattenuation, -1., 1.)) / 2;
    const Mueller plate = circular_retarder(circular) * mueller({1, psi, retardance});
    result.push_back(diagonal(1, keeps, keeps, keeps) * rotated(plate, azimuth + i.azimuth * normal(engine)));
  }
  return result;
}

Polarimeter made(const GoniometerOptions& o, std::mt19937_64& engine) {
  Polarimeter result;
  for (const Mueller& plate : plates(o, engine)) result.generator.push_back(plate * Stokes{1, 1, 0, 0});
  const double s2 = 0.5 * o.imperfections.stray * normal(engine), s3 = 0.5 * o.imperfections.stray * normal(engine);
  for (const Mueller& plate : plates(o, engine)) {
    Stokes state = transpose(plate) * Stokes{0.5, 0.5, 0, 0};
    state[0] += std::hypot(s2, s3);  // no state responds to less than nothing
    state[1] += s2;
    state[2] += s3;
    result.analyzer.push_back(state);
  }
  return result;
}

RotatingRetarders made_to_turn(const GoniometerOptions& o, std::mt19937_64& engine) {
  RotatingRetarders result;
  for (RetarderArm* arm : {&result.generator, &result.analyzer}) {
    arm->retardance = o.retardance + o.imperfections.retardance * normal(engine);
    arm->offset = o.imperfections.azimuth * normal(engine);
    arm->diattenuation = std::clamp(o.imperfections.diattenuation * normal(engine), -1., 1.);
  }
  result.analyzer.polarizer = o.imperfections.azimuth * normal(engine);
  result.extinction = o.extinction;
  return result;
}

}  // namespace

Goniometer::Goniometer(const GoniometerOptions& options, unsigned long seed) : options_(options) {
  require_valid(options_);
  std::mt19937_64 engine = stream(seed, imperfections);
  if (!options_.dials.empty()) {
    retarders_ = made_to_turn(options_, engine);
    polarimeter_ = mmbrdf::polarimeter(*retarders_, options_.dials);
    return;
  }
  if (options_.azimuths.empty()) options_.azimuths = optimal_angles(options_.retardance, 4);
  polarimeter_ = made(options_, engine);
}

void Goniometer::disturb(std::vector<double>& readings, double speckle, double gain, std::mt19937_64& engine) const {
  const auto count = static_cast<double>(readings.size());
  double place = 0.5 - count / 2;  // in time, from the middle of the measurement
  const ReadingNoise additive{options_.noise.dark, options_.noise.shot, 0};
  for (double& reading : readings) {
    reading *= gain * (1 + options_.drift * place / count) * factor(speckle, engine);
    const double sigma = std::sqrt(variance(additive, reading));
    reading = reading * factor(options_.noise.relative, engine) + sigma * normal(engine);
    ++place;
  }
}

std::vector<Reference> Goniometer::references(double wavelength, int count, unsigned long seed) const {
  if (count < 1) throw std::invalid_argument(std::to_string(count) + " references of each kind");
  std::mt19937_64 engine = stream(seed, references_of);
  std::vector<Reference> result;
  const auto measure = [&](ReferenceKind kind, double angle, const Mueller& m) {
    Reference reference{kind, angle, mmbrdf::readings(polarimeter_, m)};
    disturb(reference.readings, 0, factor(options_.gain_change, engine), engine);
    result.push_back(std::move(reference));
  };
  for (int k = 0; k < count; ++k) measure(ReferenceKind::empty, 0, identity());
  for (int k = 0; k < count; ++k) {
    const double dial = k * std::numbers::pi / count;
    const double azimuth = options_.polarizer_offset + dial + options_.dial_error * normal(engine);
    measure(ReferenceKind::polarizer, dial, polarizer(azimuth, options_.extinction));
  }
  for (int k = 0; k < count; ++k) {
    const double theta_i = radians(30 + (count > 1 ? 45. * k / (count - 1) : 0));
    measure(ReferenceKind::wafer, theta_i, mueller(reflection(options_.film, wavelength, theta_i)));
  }
  return result;
}

std::vector<double> Goniometer::readings(const Mueller& m, unsigned long seed) const {
  std::mt19937_64 engine = stream(seed, readings_of);
  std::vector<double> result = mmbrdf::readings(polarimeter_, m);
  disturb(result, 0, 1, engine);
  return result;
}

std::vector<std::vector<double>> Goniometer::readings(const PreparedModel& model, std::span<const Geometry> geometries,
                                                      unsigned long seed) const {
  std::mt19937_64 engine = stream(seed, readings_of);
  std::vector<std::vector<double>> result;
  for (const Geometry& geometry : geometries) {
    const double cosine = std::cos(geometry.reflected.theta);
    if (!(cosine > 1e-9)) throw std::invalid_argument("theta_r is 90 degrees");
    const Mueller m = options_.solid_angle * cosine * model.evaluate(geometry, Frame::scattering_plane);
    if (const Elements unknown = unknown_elements(m); unknown.any())
      throw std::invalid_argument("readings are of whole matrices, and the model does not know " +
                                  element_names(unknown));
    std::vector<double> one = mmbrdf::readings(polarimeter_, m);
    disturb(one, options_.speckle * std::sqrt(std::cos(geometry.incident.theta) / cosine), 1, engine);
    result.push_back(std::move(one));
  }
  return result;
}

}  // namespace mmbrdf
