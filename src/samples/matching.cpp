// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/matching.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "mmbrdf/text/rounding.hpp"
#include "mmbrdf/text/units.hpp"

namespace mmbrdf {
namespace {

double angle_between(const Direction& a, const Direction& b) {
  const double polar = std::sin((a.theta - b.theta) / 2), turned = std::sin((a.phi - b.phi) / 2);
  const double haversine = polar * polar + std::sin(a.theta) * std::sin(b.theta) * turned * turned;
  return 2 * std::asin(std::sqrt(std::min(haversine, 1.0)));
}

/// Uncertainties of the transposed matrix; signs do not change them.
Mueller transposed(const Mueller& m) {
  Mueller result;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) result(row, column) = m(column, row);
  return result;
}

Sample exchanged_image(const Sample& sample) {
  Sample result = sample;
  result.geometry = exchanged(sample.geometry);
  result.normalized = exchanged(sample.normalized);
  result.uncertainty = transposed(sample.uncertainty);
  result.as_measured.reset();
  return result;
}

/// In the plane of incidence.
Sample mirror_image(const Sample& sample) {
  const double source = sample.geometry.incident.phi;
  Sample result = turned(sample, -source);
  result.geometry.reflected.phi = -result.geometry.reflected.phi;
  result.normalized = mirrored(result.normalized);
  result.as_measured.reset();
  return turned(result, source);
}

/// Finds the nearest of many samples.
class Finder {
 public:
  Finder(std::span<const Sample> samples, double tolerance) : samples_(samples), tolerance_(tolerance) {
    order_.resize(samples.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::ranges::stable_sort(order_, {}, [&](std::size_t s) { return theta(s); });
  }

  std::optional<std::size_t> nearest(const Sample& to) const {
    constexpr double rounding = 1e-9;  // of angles that files give in degrees
    double least = tolerance_ + rounding;
    std::optional<std::size_t> result;
    const double lowest = to.geometry.reflected.theta - least, highest = to.geometry.reflected.theta + least;
    const auto begin = std::ranges::lower_bound(order_, lowest, {}, [&](std::size_t s) { return theta(s); });
    for (auto one = begin; one != order_.end() && theta(*one) <= highest; ++one) {
      const Sample& sample = samples_[*one];
      if (!same_wavelength(sample.wavelength, to.wavelength)) continue;
      const double distance = std::max(angle_between(sample.geometry.incident, to.geometry.incident),
                                       angle_between(sample.geometry.reflected, to.geometry.reflected));
      if (distance > least || (result && distance == least)) continue;
      least = distance;
      result = *one;
    }
    return result;
  }

 private:
  double theta(std::size_t s) const { return samples_[s].geometry.reflected.theta; }

  std::span<const Sample> samples_;
  double tolerance_;
  std::vector<std::size_t> order_;
};

}  // namespace

MatchedSamples matched(std::span<const Sample> first, std::span<const Sample> second, const Matching& matching) {
  if (!(matching.tolerance > 0 && matching.tolerance <= largest_matching))
    throw std::invalid_argument("a tolerance of " + shortest(in_degrees(matching.tolerance)) +
                                " degrees, must be in (0, " + shortest(in_degrees(largest_matching)) + "]");
  require_valid(first);
  require_valid(second);
  const Finder finder(first, matching.tolerance);
  MatchedSamples result;
  for (const Sample& sample : second) {
    std::vector<Sample> images{sample};
    if (matching.mirrored) images.push_back(mirror_image(sample));
    if (matching.exchanged) images.push_back(exchanged_image(sample));
    if (matching.mirrored && matching.exchanged) images.push_back(mirror_image(exchanged_image(sample)));
    for (const Sample& image : images) {
      const std::optional<std::size_t> found = finder.nearest(image);
      if (!found) continue;
      result.first.push_back(first[*found]);
      result.second.push_back(image);
      result.images += &image != &images.front() ? 1 : 0;
      break;
    }
  }
  return result;
}

}  // namespace mmbrdf
