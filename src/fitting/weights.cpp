// SPDX-License-Identifier: BSD-3-Clause
// Fits of samples that are held in memory: what needs them a second time. Part of fit.hpp.

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/model/at_wavelengths.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "text/names.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr Named<Weights> weights_names[] = {
    {Weights::none, "none"}, {Weights::speckle, "speckle"}, {Weights::data, "data"}, {Weights::estimated, "estimated"}};
constexpr Named<Covariance> covariance_names[] = {{Covariance::residuals, "residuals"},
                                                  {Covariance::sandwich, "sandwich"}};

Mueller ones() {
  Mueller result;
  result.elements.fill(1);
  return result;
}

/// Of one sample, whose f11 is relative to that of the model.
Mueller weights_of(const Sample& sample, const NoiseLaw& law, const PreparedModel& prepared, double reflectance) {
  const double f11 = prepared.f11(sample.geometry) / reflectance;
  if (!(f11 > 0)) throw std::invalid_argument("f11 of the unweighted fit is " + shortest(f11));
  Mueller weights;
  weights.elements.fill(weight(law, sample.geometry));
  weights(0, 0) /= f11 * f11;
  return weights;
}

/// `law_at` gives the law at a wavelength.
std::vector<Mueller> weights_of(std::span<const Sample> samples, const Model& model, const auto& law_at) {
  std::vector<Mueller> weights;
  AtWavelengths prepared([&](double wavelength) { return prepare(model, wavelength); });
  for (const auto& sample : samples) {
    const double wavelength = sample.wavelength;
    try {
      weights.push_back(weights_of(sample, law_at(wavelength), prepared(wavelength), model.reflectance.at(wavelength)));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("sample " + std::to_string(weights.size() + 1) + ": " + error.what());
    }
  }
  return weights;
}

Mueller data_weights_of(const Sample& sample, double reflectance) {
  Mueller weights;
  for (std::size_t e = 0; e < 16; ++e) {
    const double u = sample.uncertainty.elements[e] / (e == 0 ? reflectance : 1);
    if (!(u > 0)) throw std::invalid_argument("the uncertainty of " + sample_element(e) + " is not known");
    weights.elements[e] = 1 / (u * u);
  }
  return weights;
}

/// Which of the fitted wavelengths it is.
std::size_t place(const Model& model, double wavelength) {
  const std::vector<double>& list = model.validity.wavelengths;
  const auto near = [=](double other) { return std::abs(wavelength - other) <= wavelength_resolution; };
  return static_cast<std::size_t>(std::find_if(list.begin(), list.end(), near) - list.begin());
}

/// The law at each fitted wavelength, from what a first fit leaves.
std::vector<NoiseEstimate> noise_at_wavelengths(const Model& first, std::span<const Sample> samples,
                                                std::span<const Mueller> left) {
  const std::size_t count = first.validity.wavelengths.size();
  std::vector<std::vector<Sample>> samples_at(count);
  std::vector<std::vector<Mueller>> left_at(count);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const std::size_t at = place(first, samples[s].wavelength);
    samples_at[at].push_back(samples[s]);
    left_at[at].push_back(left[s]);
  }
  std::vector<NoiseEstimate> laws;
  for (std::size_t at = 0; at < count; ++at) laws.push_back(estimate_noise(samples_at[at], left_at[at]));
  return laws;
}

}  // namespace

std::vector<Mueller> noise_weights(std::span<const Sample> samples, const Model& model, const NoiseLaw& law) {
  return weights_of(samples, model, [&](double) { return law; });
}

std::vector<Mueller> speckle_weights(std::span<const Sample> samples, const Model& model) {
  return noise_weights(samples, model, {});
}

std::vector<Mueller> data_weights(std::span<const Sample> samples, const Basis& basis,
                                  const ReflectanceTable& reflectance) {
  std::vector<Mueller> weights;
  for (const Sample& sample : samples) {
    try {
      weights.push_back(
          data_weights_of(turns(basis) ? at_zero_azimuth(sample) : sample, reflectance.at(sample.wavelength)));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("sample " + std::to_string(weights.size() + 1) + ": " + error.what());
    }
  }
  return weights;
}

std::vector<Mueller> fit_weights(std::span<const Sample> samples, const Basis& basis, const FitResult& fitted,
                                 Weights weights) {
  if (weights == Weights::none) return {};
  if (weights == Weights::data) return data_weights(samples, basis, fitted.model.reflectance);
  if (weights == Weights::estimated && fitted.noise.empty())
    throw std::invalid_argument("the fit has estimated no noise");
  return weights_of(samples, fitted.model, [&](double wavelength) {
    return weights == Weights::speckle ? NoiseLaw{} : fitted.noise[place(fitted.model, wavelength)].law;
  });
}

FitResult fit(std::span<const Sample> samples, const Basis& basis, const FitOptions& options, Weights weights) {
  FitAccumulator accumulator(basis);
  accumulator.add(samples);
  FitResult result = accumulator.solved(options);
  if (weights == Weights::estimated)
    result.noise = noise_at_wavelengths(result.model, samples, residuals(result.model, samples));
  std::vector<Mueller> list = fit_weights(samples, basis, result, weights);
  if (weights != Weights::none) {
    std::vector<NoiseEstimate> noise = std::move(result.noise);
    accumulator = FitAccumulator(basis);
    accumulator.add(samples, list);
    result = accumulator.solved(options);
    result.noise = std::move(noise);
  }
  result.residuals = residuals(result.model, samples);
  if (options.covariance == Covariance::sandwich) {
    list.resize(samples.size(), ones());
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const double phi_i = samples[s].geometry.incident.phi;
      Mueller r = accumulator.turns() ? turned(result.residuals[s], -phi_i) : result.residuals[s];
      r(0, 0) /= result.model.reflectance.at(samples[s].wavelength);
      for (std::size_t e = 0; e < 16; ++e) list[s].elements[e] *= list[s].elements[e] * r.elements[e] * r.elements[e];
    }
    FitAccumulator squares(basis);
    squares.add(samples, list);
    accumulator.use_sandwich(result, options, squares);
  }
  return result;
}

std::string to_string(Weights weights) { return name_of(weights_names, weights); }
Weights weights_from(const std::string& name) { return value_of(weights_names, name, "weights"); }
std::string to_string(Covariance covariance) { return name_of(covariance_names, covariance); }
Covariance covariance_from(const std::string& name) { return value_of(covariance_names, name, "covariance"); }

}  // namespace mmbrdf
