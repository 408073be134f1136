// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "text/numbers.hpp"

namespace mmbrdf {

namespace {

using Numbers = std::pair<std::size_t, std::size_t>;  // analyzer, generator: as readings are ordered

std::vector<Numbers> sorted(std::span<const StatePair> pairs) {
  std::vector<Numbers> result;
  for (const auto& [generator, analyzer] : pairs) result.emplace_back(analyzer, generator);
  std::sort(result.begin(), result.end());
  return result;
}

void require_readable(const Polarimeter& polarimeter, std::span<const StatePair> pairs) {
  const std::vector<Numbers> all = sorted(polarimeter.pairs), asked = sorted(pairs);
  if (const auto twice = std::adjacent_find(asked.begin(), asked.end()); twice != asked.end())
    throw std::invalid_argument(to_string(StatePair{twice->second, twice->first}) + " is there twice");
  if (all.empty()) return;
  for (const Numbers& numbers : asked)
    if (!std::binary_search(all.begin(), all.end(), numbers))
      throw std::invalid_argument(to_string(StatePair{numbers.second, numbers.first}) +
                                  ": the instrument does not read this pair");
}

/// "; there is no reading of …" where few of all pairs of these states are missing.
std::string missing_of_grid(std::span<const StatePair> pairs) {
  std::set<std::size_t> generator, analyzer;
  for (const StatePair& pair : pairs) {
    generator.insert(pair.generator);
    analyzer.insert(pair.analyzer);
  }
  if (pairs.size() <= generator.size() * analyzer.size() / 2) return "";
  for (const std::size_t a : analyzer)
    for (const std::size_t g : generator)
      if (std::find(pairs.begin(), pairs.end(), StatePair{g, a}) == pairs.end())
        return "; there is none of " + to_string(StatePair{g, a});
  return "";
}

}  // namespace

struct Reducer::State {
  Polarimeter polarimeter;
  Reduction whole;
  std::map<std::vector<Numbers>, Reduction> others;  ///< by their pairs, in the order of the readings
  bool asked_for_whole = false;
};

Reducer::Reducer(const Polarimeter& polarimeter) : state_(new State{polarimeter, Reduction(polarimeter), {}}) {}

Reducer::~Reducer() = default;

const Reduction& Reducer::operator()(std::span<const StatePair> pairs) {
  if (pairs.empty()) {
    state_->asked_for_whole = true;
    return state_->whole;
  }
  std::vector<Numbers> key;
  for (const auto& [generator, analyzer] : pairs) key.emplace_back(analyzer, generator);
  const auto there = state_->others.find(key);
  if (there != state_->others.end()) return there->second;
  require_readable(state_->polarimeter, pairs);
  const Polarimeter part = reading(state_->polarimeter, {pairs.begin(), pairs.end()});
  return state_->others.emplace(std::move(key), Reduction(part)).first->second;
}

std::size_t Reducer::sets() const { return state_->others.size() + (state_->asked_for_whole ? 1 : 0); }

Sample reduced(const Reduction& reduction, const RawMeasurement& measurement, double solid_angle,
               const ReadingNoise& noise) {
  for (const double part : {noise.dark, noise.shot, noise.relative})
    if (!(part >= 0) || !std::isfinite(part))
      throw std::invalid_argument("a noise of " + shortest(part) + ", must be finite and not negative");
  const auto& [wavelength, geometry, readings, pairs] = measurement;
  const Mueller m = reduction.mueller(readings);
  if (std::isnan(m(0, 0)))
    throw std::invalid_argument(std::to_string(readings.size()) + " readings of rank " +
                                std::to_string(reduction.rank()) +
                                " do not determine M11: more or other states are needed" + missing_of_grid(pairs));
  Sample result = sample(m, wavelength, geometry, solid_angle);
  std::vector<double> variances;
  for (const double reading : readings) variances.push_back(variance(noise, reading));
  MuellerCovariance c = normalized(reduction.from_readings(variances), m);
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t other = 0; other < 16 && reduction.undetermined()[e]; ++other) c(e, other) = c(other, e) = 0;
  result.uncertainty = standard_uncertainty(change_frame(c, geometry, Frame::scattering_plane, Frame::xy));
  result.uncertainty(0, 0) /= solid_angle * std::cos(geometry.reflected.theta);
  for (std::size_t e = 0; e < 16; ++e) {
    double& u = result.uncertainty.elements[e];
    if (std::isnan(result.normalized.elements[e])) u = 0;
    if (!std::isfinite(u)) throw std::invalid_argument("the noise leaves no finite uncertainty");
  }
  return result;
}

}  // namespace mmbrdf
