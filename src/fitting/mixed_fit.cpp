// SPDX-License-Identifier: BSD-3-Clause
#include "fitting/mixed_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

#include "basis/rows.hpp"
#include "basis/spectral.hpp"
#include "fitting/arm_errors.hpp"
#include "mixed/readings.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "numerics/dense.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/threads.hpp"
#include "numerics/typical_size.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::ptrdiff_t least_readings = 30;    // at a wavelength: sixty in random directions are known to do
constexpr double darkest = 0.05, brightest = 4;  // beyond these parts of 1/pi the prior does not hold: u is off by 15 %
constexpr double first_tolerance = 1e-10;        // of the rank of the fits of a first pass: it needs none in full
constexpr double least_relative_f11 = 1e-2;  // of the mean: darker readings are not weighed by what they happen to be

std::vector<Geometry> geometries_of(std::span<const Sample> samples) {
  std::vector<Geometry> result;
  for (const Sample& sample : samples) result.push_back(sample.geometry);
  return result;
}

/// f11 of order first_order, weighed as if the readings were without noise.
std::vector<double> first_f11_fit(std::span<const Sample> samples, DiscMapping mapping, const ReadingLaw& law,
                                  double reflectance) {
  const Rows columns(blocks(Family::isotropic, {first_order, 0}).front().modes, Family::isotropic);
  double mean = 0;
  for (const Sample& sample : samples) mean += sample.f11 / reflectance / static_cast<double>(samples.size());
  const VectorXd weights = reading_weights(law, geometries_of(samples), {});
  LeastSquares rows(static_cast<int>(columns.columns()));
  std::vector<double> row(columns.columns());
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const auto& [i, r] = samples[s].geometry;
    std::ranges::fill(row, 0);
    columns.add(0, functions_at(i, first_order, mapping), functions_at(r, first_order, mapping), row.data());
    const double f = samples[s].f11 / reflectance,
                 w = weights(static_cast<Index>(s)) / (law.relative ? std::max(f, least_relative_f11 * mean) : 1);
    rows.add(row, std::array{f}, std::array{w * w});
  }
  return rows.solve(first_tolerance).x;
}

/// w² of each element.
std::vector<Mueller> squared_weights(std::span<const Sample> samples, DiscMapping mapping, const ReadingLaw& law,
                                     std::span<const double> f11) {
  const std::vector<Geometry> geometries = geometries_of(samples);
  const VectorXd f = law.relative ? first_f11(f11, mapping, geometries) : VectorXd::Ones(index(samples.size()));
  const VectorXd w = reading_weights(law, geometries, {});
  std::vector<Mueller> result(samples.size());
  for (Index s = 0; s < w.size(); ++s) {
    if (!(f(s) > 0))
      throw std::invalid_argument("sample " + std::to_string(s + 1) + ": f11 of the first fit is " + shortest(f(s)));
    Mueller& weights = result[static_cast<std::size_t>(s)];
    weights.elements.fill(w(s) * w(s));
    weights(0, 0) /= f(s) * f(s);
  }
  return result;
}

/// Distinct directions with their counts, in rising order.
std::vector<ReadingDirections> directions_of(std::span<const Sample> samples) {
  std::map<std::array<float, 4>, std::uint32_t> counts;
  for (const Sample& sample : samples) {
    const auto& [i, r] = sample.geometry;
    ++counts[{static_cast<float>(i.theta), static_cast<float>(i.phi), static_cast<float>(r.theta),
              static_cast<float>(r.phi)}];
  }
  std::vector<ReadingDirections> result;
  for (const auto& [angles, count] : counts) result.push_back({angles, count});
  return result;
}

/// What becomes of a series.
struct Fitted {
  const Series* series;
  FirstPass first;
  std::vector<BlockFit> blocks;
};

/// Σ_p λ^p a_p through the coefficients at each wavelength, all with the same weight; power after power.
std::vector<double> through(const std::map<double, Fitted>& wavelengths, std::size_t block, int powers) {
  MatrixXd rows(index(wavelengths.size()), powers + 1),
      values(rows.rows(), index(wavelengths.begin()->second.blocks[block].coefficients.size()));
  Index k = 0;
  for (const auto& [wavelength, at] : wavelengths) {
    const std::vector<double> of_wavelength = powers_of(wavelength, powers);
    rows.row(k) = Eigen::Map<const VectorXd>(of_wavelength.data(), rows.cols());
    values.row(k++) = Eigen::Map<const VectorXd>(at.blocks[block].coefficients.data(), values.cols());
  }
  const MatrixXd line = dense::shortest_least_squares(rows, values).transpose();  // modes × powers
  return {line.data(), line.data() + line.size()};
}

/// What is thrown within becomes the reason why there is no mixed model.
auto tried(const auto& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    throw MixedFailure(error.what());
  }
}

/// Mean of f11 / reflectance, in parts of 1/π: about the albedo, if f11 is in sr⁻¹.
double brightness(const Series& series) {
  double sum = 0;
  for (const Sample& sample : series.samples) sum += sample.f11 / series.reflectance;
  return std::numbers::pi * sum / static_cast<double>(series.samples.size());
}

/// Variances of the prior are those of an f11 of some parts of 1/π.
bool has_variances(double brightness) { return brightness > darkest && brightness < brightest; }

/// One wavelength in other units than sr⁻¹, such as counts, is divided by what makes an albedo of it.
void divide_other_units(const std::map<double, Series>& series, FitOptions& options) {
  const auto& [wavelength, only] = *series.begin();
  const double found = brightness(only);
  if (series.size() > 1 || options.reflectance || has_variances(found)) return;
  if (!(found > 0)) throw std::invalid_argument("the mean of f11 is " + shortest(found / std::numbers::pi));
  options.reflectance = ReflectanceTable{{wavelength}, {found}};
}

/// Of Weights::estimated, else none.
std::vector<NoiseEstimate> noise_for(std::span<const Sample> samples, const Basis& basis, FitOptions options,
                                     Weights weights) {
  if (weights != Weights::estimated) return {};
  options.uncertainty = Uncertainty::noise;
  return fit(samples, basis, options, weights).noise;
}

/// Noise is relative to f11 only where f11 stands above it.
bool stands_above_noise(const Series& series, DiscMapping mapping) {
  ReadingLaw law = series.law;
  law.relative = false;
  const VectorXd f11 =
      first_f11(first_f11_fit(series.samples, mapping, law, 1), mapping, geometries_of(series.samples));
  std::vector<double> left;
  for (std::size_t s = 0; s < series.samples.size(); ++s) left.push_back(series.samples[s].f11 - f11(index(s)));
  return f11.minCoeff() > typical_size(std::move(left));
}

/// The samples by wavelength, with the laws that the weights stand for.
std::map<double, Series> series_of(std::span<const Sample> samples, Weights weights,
                                   const std::vector<NoiseEstimate>& noise, DiscMapping mapping) {
  std::map<double, Series> result;
  const std::vector<double> nodes = wavelengths(samples);
  for (const Sample& sample : samples)
    result[nodes[wavelength_index(nodes, sample.wavelength)]].samples.push_back(sample);
  for (auto& [wavelength, one] : result) {
    if (weights == Weights::none) one.law = {0, 0, false};
    if (weights == Weights::estimated) {
      const NoiseLaw& law = noise[wavelength_index(nodes, wavelength)].law;
      one.law = {law.incident_exponent, law.reflected_exponent, true};
    }
    one.law.relative = one.law.relative && stands_above_noise(one, mapping);
  }
  return result;
}

/// Lists by wavelength as one, in the order of the samples.
std::vector<Mueller> in_order_of(std::span<const Sample> samples, const std::map<double, std::vector<Mueller>>& lists) {
  std::vector<double> nodes;
  for (const auto& [wavelength, list] : lists) nodes.push_back(wavelength);
  std::vector<std::size_t> next(nodes.size());
  std::vector<Mueller> result;
  for (const Sample& sample : samples) {
    const std::size_t node = wavelength_index(nodes, sample.wavelength);
    result.push_back(lists.at(nodes[node])[next[node]++]);
  }
  return result;
}

}  // namespace

Orders generous(const Orders& evaluated) {
  return {std::max(evaluated.f11, generous_orders.f11), std::max(evaluated.other, generous_orders.other)};
}

FirstPass first_pass(std::span<const Sample> samples, const Basis& basis, const ReadingLaw& law, double reflectance) {
  FirstPass result{reflectance, first_f11_fit(samples, basis.mapping, law, reflectance), {}};
  FitAccumulator evaluated(basis);
  evaluated.add(samples, squared_weights(samples, basis.mapping, law, result.f11));
  FitOptions options;
  options.powers = 0;
  options.reflectance = ReflectanceTable{};
  options.minimum_norm = true;
  options.rank_tolerance = first_tolerance;
  result.model = evaluated.solve(options).model;
  return result;
}

Gram sums_of(const MixedColumns& columns, std::span<const Sample> samples, const FirstPass& first,
             const ReadingLaw& law) {
  Gram result(columns.size(), static_cast<Index>(declared_errors));
  const bool is_f11 = feeds_f11(columns.isotropic());
  const double divisor = is_f11 ? first.reflectance : 1;
  const PreparedModel model = prepare(first.model, samples.front().wavelength);
  for (std::size_t begin = 0; begin < samples.size(); begin += readings_at_once) {
    const auto some = samples.subspan(begin, std::min(readings_at_once, samples.size() - begin));
    const std::vector<Geometry> geometries = geometries_of(some);
    const Index count = index(some.size());
    const bool relative = is_f11 && law.relative;
    const VectorXd weights =
        reading_weights(law, geometries, relative ? first_f11(first.f11, columns.mapping(), geometries) : VectorXd());
    const ArmErrors arms = arm_errors(model, geometries);
    MatrixXd rows = columns.at(geometries), errors = MatrixXd::Zero(rows.rows(), result.d.cols());
    VectorXd values(rows.rows());
    for (Index at = 0; const Element& element : columns.isotropic().elements) {
      const std::size_t e = element.index();
      for (Index s = 0; s < count; ++s, ++at) {
        const auto sample = static_cast<std::size_t>(s);
        values(at) = (is_f11 ? some[sample].f11 : some[sample].normalized.elements[e]) / divisor;
        if (is_f11) errors(at, 0) = model.f11(geometries[sample]) / divisor;
        errors(at, 1) = arms.source[sample].elements[e] / divisor;
        errors(at, 2) = arms.receiver[sample].elements[e] / divisor;
      }
    }
    const VectorXd w = weights.replicate(columns.elements(), 1);
    rows.array().colwise() *= w.array();
    errors.array().colwise() *= w.array();
    values.array() *= w.array();
    result.add(rows, values, errors);
  }
  return result;
}

std::vector<Mueller> series_weights(const Series& series, const Basis& basis) {
  const auto& [samples, law, reflectance] = series;
  return squared_weights(samples, basis.mapping, law, first_f11_fit(samples, basis.mapping, law, reflectance));
}

std::string no_mixed_model(std::span<const Sample> samples, const Basis& basis, Covariance covariance,
                           Weights weights) {
  if (basis.family != Family::isotropic) return "the " + to_string(basis.family) + " basis has no mixed model";
  const Elements unknown = not_measured(samples);
  if (std::ranges::any_of(samples, [](const Sample& sample) { return sample.as_measured != nullptr; }))
    return "some elements are missing in the frame in which they were measured";
  for (const Sample& sample : samples)
    if (const Elements here = not_measured(sample); here != unknown)
      return "missing in some samples: " + element_names(here & ~unknown);
  const std::vector<Block> generous_blocks = blocks(basis.family, generous_orders);
  for (const Block& block : generous_blocks)
    for (const Element& element : block.elements)
      if (unknown[element.index()] != unknown[block.elements.front().index()])
        return "of the elements " + block.name + ", which belong together, some were not measured";
  if (blocks(basis.family, basis.orders).size() < generous_blocks.size())
    return "orders " + std::to_string(basis.orders.f11) + "," + std::to_string(basis.orders.other) +
           " leave elements without modes";
  if (covariance != Covariance::residuals) return "the covariance " + to_string(covariance) + " is one of them";
  if (weights == Weights::data) return "weights of the data have no law";
  const std::vector<double> nodes = wavelengths(samples);
  std::vector<std::ptrdiff_t> counts(nodes.size());
  for (const Sample& sample : samples) ++counts[wavelength_index(nodes, sample.wavelength)];
  for (std::size_t node = 0; node < nodes.size(); ++node)
    if (counts[node] < least_readings)
      return std::to_string(counts[node]) + " samples at " + shortest(in_nanometres(nodes[node])) + " nm, at least " +
             std::to_string(least_readings) + " are needed";
  return "";
}

MixedFit mixed_fit(const std::map<double, Series>& series, const Basis& basis, int powers,
                   const DeclaredErrors& declared) {
  const Elements unknown = not_measured(series.begin()->second.samples);  // and in all others
  PosteriorData data{generous(basis.orders), basis.mapping, unknown, shared_errors(declared), {}, {}};
  const std::vector<Block> evaluated = without(unknown, blocks(basis.family, basis.orders));
  std::vector<MixedColumns> columns;
  for (const Block& block : without(unknown, blocks(Family::isotropic, data.orders)))
    columns.emplace_back(block, basis.mapping);
  std::map<double, Fitted> wavelengths;
  std::vector<Fitted*> list;
  for (const auto& [wavelength, one] : series) {
    Fitted& at = wavelengths[wavelength];
    at = {&one, first_pass(one.samples, basis, one.law, one.reflectance), std::vector<BlockFit>(columns.size())};
    list.push_back(&at);
  }
  in_any_order(list.size() * columns.size(), [&](std::size_t i) {
    Fitted& at = *list[i / columns.size()];
    const std::size_t b = columns.size() - 1 - i % columns.size();
    at.blocks[b] =
        fit_block(columns[b], sums_of(columns[b], at.series->samples, at.first, at.series->law), evaluated[b]);
  });
  for (auto& [wavelength, at] : wavelengths) {
    PosteriorAt known{wavelength, at.series->law, at.first.f11, 0, {}};
    for (BlockFit& block : at.blocks) known.blocks.push_back(std::move(block.posterior));
    const std::vector<ReadingDirections> directions = directions_of(at.series->samples);
    if (directions.size() > most_directions) {
      for (std::size_t b = 0; b < columns.size(); ++b) round_covariance(known.blocks[b], at.blocks[b].covariance);
    } else {
      known.readings = static_cast<std::size_t>(std::ranges::find(data.readings, directions) - data.readings.begin());
      if (known.readings == data.readings.size()) data.readings.push_back(directions);
    }
    data.wavelengths.push_back(std::move(known));
  }
  std::vector<std::vector<double>> coefficients;
  for (std::size_t b = 0; b < columns.size(); ++b) coefficients.push_back(through(wavelengths, b, powers));
  return {Posterior(std::move(data)), std::move(coefficients)};
}

// ---- a fit of the sample ----

/// Least squares with the weights of the mixed model says how well the data fit; the coefficients are those of the mixed
/// model.
FitResult FitAccumulator::of_sample(std::span<const Sample> samples, const Basis& basis, FitOptions options,
                                    Weights weights) {
  options.minimum_norm = true;
  const std::vector<NoiseEstimate> noise = noise_for(samples, basis, options, weights);
  std::map<double, Series> series = series_of(samples, weights, noise, basis.mapping);
  tried([&] { divide_other_units(series, options); });
  std::map<double, std::vector<Mueller>> weights_of_series;
  FitResult result;
  for (const bool scaled : {false, true}) {  // f11 is divided by a reflectance that may be its own
    FitAccumulator accumulator(basis);
    for (auto& [wavelength, one] : series) {
      if (scaled) one.reflectance = result.model.reflectance.at(wavelength);
      weights_of_series[wavelength] = tried([&, &one = one] { return series_weights(one, basis); });
      accumulator.add(one.samples, weights_of_series[wavelength]);
    }
    result = accumulator.solved(options);
    if (!scaled && !result.model.reflectance.values.empty()) continue;
    for (const auto& [wavelength, one] : series)
      if (!has_variances(brightness(one)))
        throw MixedFailure("f11 at " + shortest(in_nanometres(wavelength)) + " nm is that of an albedo of " +
                           rounded(brightness(one), 2) + ": is it in sr^-1, and the reflectance a part of 1?");
    const MixedFit mixed = tried([&] { return mixed_fit(series, basis, result.model.powers, options.declared); });
    for (std::size_t b = 0; b < result.model.blocks.size(); ++b) {
      FittedBlock& fitted = result.model.blocks[b];
      fitted.coefficients = mixed.coefficients[b];
      fitted.covariance.clear();
      fitted.null_space.clear();  // of least squares: what the data leave open is in the posterior
      for (const Element& element : fitted.block.elements)
        result.elements[element.index()] =
            accumulator.element_fit(element.index(), fitted.coefficients, result.model.reflectance);
    }
    result.model.posterior = mixed.posterior;
    result.model.validity.supported = accumulator.support(result.model);
    result.model.reflectance.covariance.clear();
    result.model.reflectance.covariance_with_f11.clear();
    break;
  }
  result.noise = noise;
  result.weights = weights;
  result.sample_weights = in_order_of(samples, weights_of_series);
  result.residuals = residuals(result.model, samples);
  return result;
}

}  // namespace mmbrdf
