// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/partition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr double widest = 10;  // times the tolerance: more is no angle of a goniometer but a range of random ones

using Kind = Partition::Kind;

void require_folds(std::size_t samples, int folds, const std::string& what = "samples") {
  if (folds < 2 || folds > max_folds)
    throw std::invalid_argument("folds: " + std::to_string(folds) + " is not in 2..." + std::to_string(max_folds));
  if (static_cast<std::size_t>(folds) > samples)
    throw std::invalid_argument("folds: " + std::to_string(folds) + ", more than the " + std::to_string(samples) + " " +
                                what);
}

Partition numbered_folds(Kind kind, std::size_t samples, int folds) {
  require_folds(samples, folds);
  Partition partition{kind, {}, {}};
  for (std::size_t s = 0; s < samples; ++s) partition.fold.push_back(s % static_cast<std::size_t>(folds));
  for (int f = 1; f <= folds; ++f) partition.names.push_back("fold " + std::to_string(f));
  return partition;
}

void require_several(std::size_t folds, const std::string& what) {
  if (folds < 2 || folds > static_cast<std::size_t>(max_folds))
    throw std::invalid_argument("leaving out each of the " + what + ": the data have " + std::to_string(folds) +
                                ", it takes 2 to " + std::to_string(max_folds));
}

}  // namespace

std::string to_string(Partition::Kind kind) {
  switch (kind) {
    case Kind::rows:
      return "rows";
    case Kind::random:
      return "random";
    case Kind::angle:
      return "angle";
    default:
      return "wavelength";
  }
}

Partition folds_by_row(std::size_t samples, int folds) { return numbered_folds(Kind::rows, samples, folds); }

Partition random_folds(std::size_t samples, int folds, unsigned long seed) {
  Partition partition = numbered_folds(Kind::random, samples, folds);
  std::mt19937_64 engine(seed);
  for (std::size_t left = samples; left > 1; --left)  // not std::shuffle, which differs among libraries
    std::swap(partition.fold[left - 1], partition.fold[engine() % left]);
  return partition;
}

std::vector<std::size_t> directions(std::span<const Sample> samples) {
  constexpr double step = radians(0.1);
  std::map<std::array<long, 3>, std::size_t> numbers;
  std::vector<std::size_t> result;
  for (const Sample& sample : samples) {
    const auto& [incident, reflected] = sample.geometry;
    const double delta = std::remainder(reflected.phi - incident.phi, 2 * std::numbers::pi);
    const std::array steps{std::lround(incident.theta / step), std::lround(reflected.theta / step),
                           std::lround(delta / step)};
    const bool back = steps[2] == std::lround(-std::numbers::pi / step);  // −180 is 180 degrees
    result.push_back(
        numbers.try_emplace({steps[0], steps[1], back ? -steps[2] : steps[2]}, numbers.size()).first->second);
  }
  return result;
}

Partition folds_by_direction(std::span<const Sample> samples, int folds, std::optional<unsigned long> seed) {
  std::vector<std::size_t> direction = directions(samples);
  const std::size_t count = direction.empty() ? 0 : *std::ranges::max_element(direction) + 1;
  require_folds(count, folds, count < samples.size() ? "directions of the samples" : "samples");
  Partition partition = seed ? random_folds(count, folds, *seed) : folds_by_row(count, folds);
  for (std::size_t& number : direction) number = partition.fold[number];
  partition.fold = std::move(direction);
  return partition;
}

Partition folds_by_incident_angle(std::span<const Sample> samples, double tolerance) {
  if (!(tolerance >= 0)) throw std::invalid_argument("tolerance " + shortest(tolerance) + " of angles is negative");
  require_valid(samples);
  std::vector<double> angles;
  for (const Sample& sample : samples) angles.push_back(sample.geometry.incident.theta);
  Partition partition{Kind::angle, grouped(angles, tolerance), {}};
  std::map<std::size_t, std::pair<double, double>> range;  // smallest and largest angle of a group
  for (std::size_t s = 0; s < samples.size(); ++s) {
    auto& [low, high] = range.try_emplace(partition.fold[s], angles[s], angles[s]).first->second;
    low = std::min(low, angles[s]);
    high = std::max(high, angles[s]);
  }
  require_several(range.size(), "incident polar angles");
  for (const auto& [fold, ends] : range) {
    if (ends.second - ends.first > widest * tolerance)
      throw std::invalid_argument(
          "leaving out each of the incident polar angles: they lie too close to be told apart, " +
          rounded(degrees(ends.first), 4) + " to " + rounded(degrees(ends.second), 4) + " degrees");
    partition.names.push_back(rounded(degrees((ends.first + ends.second) / 2), 4) + " degrees");
  }
  return partition;
}

Partition folds_by_wavelength(std::span<const Sample> samples) {
  const std::vector<double> distinct = wavelengths(samples);
  require_several(distinct.size(), "wavelengths");
  Partition partition{Kind::wavelength, {}, {}};
  for (const double wavelength : distinct) partition.names.push_back(shortest(in_nanometres(wavelength)) + " nm");
  for (const Sample& sample : samples)
    partition.fold.push_back(static_cast<std::size_t>(
        std::upper_bound(distinct.begin(), distinct.end(), sample.wavelength + wavelength_resolution) -
        distinct.begin() - 1));
  return partition;
}

LeaveOut leave_out_from(const std::string& name) {
  if (name == "angle") return LeaveOut::angle;
  if (name == "wavelength") return LeaveOut::wavelength;
  if (name == "angle,wavelength") return LeaveOut::both;
  if (name == "none") return LeaveOut::none;
  throw std::invalid_argument("\"" + name + "\": expected angle, wavelength, angle,wavelength or none");
}

Folds folds(std::span<const Sample> samples, const FoldOptions& options) {
  Folds result{
      {folds_by_direction(samples, options.folds, options.random ? std::optional(options.seed) : std::nullopt)}, {}};
  std::vector<Partition>& all = result.partitions;
  const LeaveOut what = options.leave_out;
  if (what == LeaveOut::angle || what == LeaveOut::both) all.push_back(folds_by_incident_angle(samples));
  if (what == LeaveOut::what_can_be) {
    try {
      all.push_back(folds_by_incident_angle(samples));
    } catch (const std::invalid_argument& error) {
      result.note = error.what() + std::string("; folds alone decide, and see nothing between the angles measured");
    }
  }
  if (what == LeaveOut::wavelength || what == LeaveOut::both ||
      (what == LeaveOut::what_can_be && wavelengths(samples).size() > 2))
    all.push_back(folds_by_wavelength(samples));
  return result;
}

std::vector<std::vector<Sample>> parts(std::span<const Sample> samples, const Partition& partition) {
  if (partition.fold.size() != samples.size())
    throw std::invalid_argument("a partition of " + std::to_string(partition.fold.size()) + " samples, there are " +
                                std::to_string(samples.size()));
  std::vector<std::vector<Sample>> result(partition.names.size());
  for (std::size_t s = 0; s < samples.size(); ++s) result[partition.fold[s]].push_back(samples[s]);
  return result;
}

}  // namespace mmbrdf
