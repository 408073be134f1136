// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/subsets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/gradients.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::array every_curve{&PolarizedBrdf::ss, &PolarizedBrdf::sp, &PolarizedBrdf::ps, &PolarizedBrdf::pp};

void require_same_rank(const Model& part, const Model& whole) {
  for (std::size_t b = 0; b < whole.blocks.size(); ++b)
    if (part.blocks[b].rank < whole.blocks[b].rank)
      throw std::invalid_argument("block " + whole.blocks[b].block.name + " has rank " +
                                  std::to_string(part.blocks[b].rank) + ", with all samples " +
                                  std::to_string(whole.blocks[b].rank));
}

bool is_positive(const PolarizedBrdf& f) {
  return std::ranges::all_of(every_curve, [&](const auto part) { return f.*part > 0 && std::isfinite(f.*part); });
}

/// At how many geometries there is something to be relative to.
double count_positive(const PolarizedCurve& reference) {
  if (reference.empty()) throw std::invalid_argument("no geometries");
  const auto count = std::ranges::count_if(reference, is_positive);
  if (count == 0) throw std::invalid_argument("f_ss, f_sp, f_ps and f_pp of the reference are positive at no geometry");
  return static_cast<double>(count);
}

void require_same_length(const PolarizedCurve& curve, const PolarizedCurve& reference) {
  if (curve.size() != reference.size())
    throw std::invalid_argument("a curve of " + std::to_string(curve.size()) + " geometries, the reference has " +
                                std::to_string(reference.size()));
}

SubsetSplit split(std::span<const Sample> samples, const Partition& partition, const SubsetQuestion& question) {
  const SubsetFits fits = fit_parts(parts(samples, partition), question.basis, question.fit, question.weights);
  constexpr unsigned s_and_p = 1U << 0 | 1U << 1 | 1U << 4 | 1U << 5;
  if (const Elements missing = unknown_elements(fits.whole, Frame::sp) & Elements(s_and_p); missing.any())
    throw std::invalid_argument(not_measured_line(missing) +
                                "; subsets are compared by f_ss, f_sp, f_ps and f_pp, which need them");
  SubsetSplit result;
  for (const Model& part : fits.parts)
    result.curves.push_back(polarized_curve(part, question.wavelength, question.geometries));
  result.reference =
      polarized_curve(question.reference ? *question.reference : fits.whole, question.wavelength, question.geometries);
  result.uncertainty = polarized_uncertainty(fits.whole, question.wavelength, question.geometries);
  for (PolarizedBrdf& u : result.uncertainty)
    for (const auto part : every_curve) u.*part *= std::sqrt(static_cast<double>(fits.parts.size()));
  result.statistics = subset_statistics(result.curves, result.reference);
  result.predicted = relative_rms(result.uncertainty, result.reference);
  result.validity = fits.whole.validity;
  return result;
}

}  // namespace

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
      throw std::invalid_argument("part " + std::to_string(&part - parts.data() + 1) + " of " +
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

PolarizedCurve polarized_curve(const Model& model, double wavelength, std::span<const Geometry> geometries) {
  const PreparedModel prepared = prepare(model, wavelength);
  PolarizedCurve curve;
  for (const Geometry& geometry : geometries)
    curve.push_back(co_and_cross_polarized(prepared.evaluate(geometry, Frame::sp)));
  return curve;
}

PolarizedCurve polarized_uncertainty(const Model& model, double wavelength, std::span<const Geometry> geometries,
                                     std::span<const TypeBTerm> terms) {
  const PreparedUncertainty prepared = prepare_uncertainty(model, wavelength);
  const auto [ss, sp, ps, pp] = co_and_cross_polarized_gradients();
  std::vector<MuellerCovariance> covariances(geometries.size());
  if (terms.empty()) {
    prepared.evaluate(geometries, Frame::sp, covariances);
  } else {
    const PreparedModel at = prepare(model, wavelength);
    std::ranges::transform(geometries, covariances.begin(), [&](const Geometry& geometry) {
      return budget(at, prepared, terms, geometry, Frame::sp).total;
    });
  }
  PolarizedCurve curve;
  for (const MuellerCovariance& covariance : covariances)
    curve.push_back({standard_uncertainty(ss, covariance), standard_uncertainty(sp, covariance),
                     standard_uncertainty(ps, covariance), standard_uncertainty(pp, covariance)});
  return curve;
}

SubsetStatistics subset_statistics(std::span<const PolarizedCurve> curves, const PolarizedCurve& reference) {
  if (curves.size() < 2) throw std::invalid_argument("fewer than 2 curves have no spread");
  const double positive = count_positive(reference);
  for (const PolarizedCurve& curve : curves) require_same_length(curve, reference);
  const auto k = static_cast<double>(curves.size()), count = 4 * positive;
  SubsetStatistics result;
  result.left_out = reference.size() - static_cast<std::size_t>(positive);
  for (std::size_t g = 0; g < reference.size(); ++g) {
    PolarizedBrdf mean{}, deviation{};
    for (const auto part : every_curve) {
      for (const PolarizedCurve& curve : curves) mean.*part += curve[g].*part / k;
      double squares = 0;
      for (const PolarizedCurve& curve : curves) squares += std::pow(curve[g].*part - mean.*part, 2);
      deviation.*part = std::sqrt(squares / (k - 1));
      if (!is_positive(reference[g])) continue;
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
  const double positive = count_positive(reference);
  require_same_length(uncertainty, reference);
  double squares = 0;
  for (std::size_t g = 0; g < reference.size(); ++g)
    if (is_positive(reference[g]))
      for (const auto part : every_curve) squares += std::pow(uncertainty[g].*part / reference[g].*part, 2);
  return std::sqrt(squares / (4 * positive));
}

std::vector<SubsetSplit> split_samples(std::span<const Sample> samples, const Division& division,
                                       const SubsetQuestion& question) {
  if (division.splits < 1 || division.splits > max_splits)
    throw std::invalid_argument("splits: " + std::to_string(division.splits) + " is not in 1..." +
                                std::to_string(max_splits));
  std::vector<SubsetSplit> result;
  for (int i = 0; i < division.splits; ++i) {
    const unsigned long seed = division.seed + static_cast<unsigned long>(i);
    result.push_back(split(
        samples, folds_by_direction(samples, division.parts, division.by_lot() ? std::optional(seed) : std::nullopt),
        question));
    if (division.by_lot()) result.back().seed = seed;
  }
  return result;
}

double root_mean_variance(std::span<const SubsetSplit> splits) {
  double squares = 0;
  for (const SubsetSplit& split : splits) squares += std::pow(split.statistics.root_mean_variance, 2);
  return std::sqrt(squares / static_cast<double>(splits.size()));
}

}  // namespace mmbrdf
