// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/subsets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "mmbrdf/uncertainty.hpp"
#include "numbers.hpp"
#include "random.hpp"

namespace mmbrdf {
namespace {

constexpr std::array every_curve{&PolarizedBrdf::ss, &PolarizedBrdf::sp, &PolarizedBrdf::ps, &PolarizedBrdf::pp};
constexpr std::array<const char*, 4> curve_names{"f_ss", "f_sp", "f_ps", "f_pp"};

/// The samples in this order, dealt out in turn.
std::vector<std::vector<Sample>> dealt(std::span<const Sample> samples, std::span<const std::size_t> order, int k) {
  if (k < 2) throw std::invalid_argument("subsets: k = " + std::to_string(k) + ", must be at least 2");
  const auto count = static_cast<std::size_t>(k);
  if (count > samples.size())
    throw std::invalid_argument("subsets: k = " + std::to_string(k) + ", more than the " +
                                std::to_string(samples.size()) + " samples");
  std::vector<std::vector<Sample>> parts(count);
  for (std::size_t s = 0; s < samples.size(); ++s) parts[s % count].push_back(samples[order[s]]);
  return parts;
}

std::vector<std::size_t> numbers_up_to(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  return order;
}

/// Fisher and Yates. std::shuffle is not the same with every compiler.
std::vector<std::size_t> shuffled(std::size_t count, unsigned long seed) {
  std::mt19937_64 engine(seed);
  std::vector<std::size_t> order = numbers_up_to(count);
  for (std::size_t i = count; i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(uniform(engine) * static_cast<double>(i))]);
  return order;
}

void require_same_rank(const Model& part, const Model& whole) {
  for (std::size_t b = 0; b < whole.blocks.size(); ++b)
    if (part.blocks[b].rank < whole.blocks[b].rank)
      throw std::invalid_argument("block " + whole.blocks[b].block.name + " has rank " +
                                  std::to_string(part.blocks[b].rank) + ", with all samples " +
                                  std::to_string(whole.blocks[b].rank));
}

void require_positive(const PolarizedCurve& reference) {
  if (reference.empty()) throw std::invalid_argument("subsets: no geometries");
  for (std::size_t g = 0; g < reference.size(); ++g)
    for (std::size_t c = 0; c < every_curve.size(); ++c)
      if (const double value = reference[g].*every_curve[c]; !(value > 0) || !std::isfinite(value))
        throw std::invalid_argument(std::string("subsets: ") + curve_names[c] + " of the reference is " +
                                    shortest(value) + " /sr at geometry " + std::to_string(g + 1) +
                                    ", must be positive");
}

void require_same_length(const PolarizedCurve& curve, const PolarizedCurve& reference) {
  if (curve.size() != reference.size())
    throw std::invalid_argument("subsets: a curve of " + std::to_string(curve.size()) +
                                " geometries, the reference has " + std::to_string(reference.size()));
}

}  // namespace

std::vector<std::vector<Sample>> interleaved_parts(std::span<const Sample> samples, int k) {
  return dealt(samples, numbers_up_to(samples.size()), k);
}

std::vector<std::vector<Sample>> random_parts(std::span<const Sample> samples, int k, unsigned long seed) {
  return dealt(samples, shuffled(samples.size(), seed), k);
}

SubsetFits fit_parts(std::span<const std::vector<Sample>> parts, const Basis& basis, const FitOptions& options,
                     Weights weights) {
  std::vector<Sample> all;
  for (const std::vector<Sample>& part : parts) all.insert(all.end(), part.begin(), part.end());
  SubsetFits fits{fit(all, basis, options, weights).model, {}};
  for (const std::vector<Sample>& part : parts) {
    try {
      fits.parts.push_back(fit(part, basis, options, weights).model);
      require_same_rank(fits.parts.back(), fits.whole);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("subsets: part " + std::to_string(&part - parts.data() + 1) + " of " +
                                  std::to_string(parts.size()) + ", " + std::to_string(part.size()) +
                                  " samples: " + error.what());
    }
  }
  return fits;
}

std::vector<Geometry> in_plane(double theta_i, std::span<const double> theta_r) {
  std::vector<Geometry> geometries;
  for (const double theta : theta_r)
    geometries.push_back({{theta_i, 0}, {std::abs(theta), theta < 0 ? 0 : std::numbers::pi}});
  return geometries;
}

PolarizedCurve polarized_curve(const Model& model, double wavelength, std::span<const Geometry> geometries,
                               Rotation rotation) {
  const PreparedModel prepared = prepare(model, wavelength, rotation);
  PolarizedCurve curve;
  for (const Geometry& geometry : geometries)
    curve.push_back(co_and_cross_polarized(prepared.evaluate(geometry, Frame::sp)));
  return curve;
}

PolarizedCurve polarized_uncertainty(const Model& model, double wavelength, std::span<const Geometry> geometries,
                                     Rotation rotation) {
  constexpr std::array<std::size_t, 4> elements{0, 1, 4, 5};  // 11, 12, 21, 22
  const PreparedUncertainty prepared = prepare_uncertainty(model, wavelength, rotation);
  PolarizedCurve curve;
  for (const Geometry& geometry : geometries) {
    const MuellerCovariance covariance = prepared.evaluate(geometry, Frame::sp);
    const auto uncertainty = [&](double a, double b) {
      const std::array<double, 4> factors{0.5, 0.5 * a, 0.5 * b, 0.5 * a * b};
      double variance = 0;
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) variance += factors[i] * factors[j] * covariance(elements[i], elements[j]);
      return std::sqrt(std::max(variance, 0.0));
    };
    curve.push_back({uncertainty(1, 1), uncertainty(1, -1), uncertainty(-1, 1), uncertainty(-1, -1)});
  }
  return curve;
}

SubsetStatistics subset_statistics(std::span<const PolarizedCurve> curves, const PolarizedCurve& reference) {
  if (curves.size() < 2) throw std::invalid_argument("subsets: fewer than 2 curves have no spread");
  require_positive(reference);
  for (const PolarizedCurve& curve : curves) require_same_length(curve, reference);
  const auto k = static_cast<double>(curves.size()), count = 4 * static_cast<double>(reference.size());
  SubsetStatistics result;
  for (std::size_t g = 0; g < reference.size(); ++g) {
    PolarizedBrdf mean{}, deviation{};
    for (const auto part : every_curve) {
      for (const PolarizedCurve& curve : curves) mean.*part += curve[g].*part / k;
      double squares = 0;
      for (const PolarizedCurve& curve : curves) squares += std::pow(curve[g].*part - mean.*part, 2);
      deviation.*part = std::sqrt(squares / (k - 1));
      const double relative = deviation.*part / reference[g].*part;
      const double distance = std::abs(mean.*part / reference[g].*part - 1);
      result.mean_deviation += relative / count;
      result.root_mean_variance += relative * relative / count;
      result.mean_distance += distance / count;
      if (distance > result.largest_distance) result.largest_at = g;
      result.largest_distance = std::max(result.largest_distance, distance);
    }
    result.mean.push_back(mean);
    result.deviation.push_back(deviation);
  }
  result.root_mean_variance = std::sqrt(result.root_mean_variance);
  return result;
}

double relative_rms(const PolarizedCurve& uncertainty, const PolarizedCurve& reference) {
  require_positive(reference);
  require_same_length(uncertainty, reference);
  double squares = 0;
  for (std::size_t g = 0; g < reference.size(); ++g)
    for (const auto part : every_curve) squares += std::pow(uncertainty[g].*part / reference[g].*part, 2);
  return std::sqrt(squares / (4 * static_cast<double>(reference.size())));
}

}  // namespace mmbrdf
