// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/weights.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "mmbrdf/model/at_wavelengths.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "numerics/typical_size.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// f11 over the reflectance of samples as a model has it, but no less than what the model leaves of the samples: noise
/// that is relative to f11 does not vanish with it.
std::vector<double> f11_above_noise(std::span<const Sample> samples, const Model& model) {
  const PreparedModel first = prepare(model, 1);
  AtWavelengths prepared([&](double wavelength) { return first.at(wavelength); });
  std::vector<double> result, left;
  for (const Sample& sample : samples) {
    const double reflectance = model.reflectance.at(sample.wavelength);
    result.push_back(prepared(sample.wavelength).f11(sample.geometry) / reflectance);
    if (!std::isnan(sample.f11)) left.push_back(sample.f11 / reflectance - result.back());
  }
  const double noise = typical_size(left);
  for (double& f11 : result) f11 = std::max(f11, noise);
  return result;
}

/// `law_at` gives the law at a wavelength.
std::vector<Mueller> weights_of(std::span<const Sample> samples, const Model& model, const auto& law_at) {
  std::vector<Mueller> result;
  const std::vector<double> f11 = f11_above_noise(samples, model);
  for (std::size_t s = 0; s < samples.size(); ++s) try {
      if (!(f11[s] > 0)) throw std::invalid_argument("f11 of the unweighted fit is " + shortest(f11[s]));
      Mueller weights;
      weights.elements.fill(weight(law_at(samples[s].wavelength), samples[s].geometry));
      weights(0, 0) /= f11[s] * f11[s];
      result.push_back(weights);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("sample " + std::to_string(s + 1) + ": " + error.what());
    }
  return result;
}

/// Of the rows that a fit makes of a sample.
Mueller data_weights_of(const Sample& sample, const Basis& basis, double reflectance) {
  const bool rows_are_turned = sample.as_measured && rows_turn(basis.family);
  const Sample in_xy = turns(basis) ? at_zero_azimuth(sample) : sample;
  Elements unknown = rows_are_turned ? unknown_elements(sample.as_measured->normalized) : not_measured(in_xy);
  unknown[0] = std::isnan(sample.f11);
  const Mueller& uncertainty = rows_are_turned ? sample.as_measured->uncertainty : in_xy.uncertainty;
  Mueller weights;
  for (std::size_t e = 0; e < 16; ++e) {
    if (unknown[e]) continue;
    const double u = uncertainty.elements[e] / (e == 0 ? reflectance : 1);
    if (!(u > 0)) throw std::invalid_argument("the uncertainty of " + sample_element(e) + " is not known");
    weights.elements[e] = 1 / (u * u);
  }
  return weights;
}

/// Refuses a weight beside which the others of its element are nothing, so that one sample would be the fit.
void require_comparable(std::span<const Mueller> weights) {
  constexpr double all_others = 1e9;
  for (std::size_t e = 0; e < 16; ++e) {
    std::size_t heaviest = 0;
    for (std::size_t s = 0; s < weights.size(); ++s)
      if (weights[s].elements[e] > weights[heaviest].elements[e]) heaviest = s;
    double others = 0;
    for (std::size_t s = 0; s < weights.size(); ++s)
      if (s != heaviest) others += weights[s].elements[e];
    if (others > 0 && weights[heaviest].elements[e] > all_others * others)
      throw std::invalid_argument("sample " + std::to_string(heaviest + 1) + ": u_" + sample_element(e) + " = " +
                                  shortest(1 / std::sqrt(weights[heaviest].elements[e])) +
                                  " outweighs all other samples together; is it a fill value?");
  }
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
  if (!samples.empty() && std::ranges::none_of(samples, has_uncertainty))
    throw std::invalid_argument(
        "no sample has uncertainties, by which they are to be weighted: columns u_f11, u_m12 ... u_m44");
  std::vector<Mueller> weights;
  for (const Sample& sample : samples) {
    try {
      weights.push_back(data_weights_of(sample, basis, reflectance.at(sample.wavelength)));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("sample " + std::to_string(weights.size() + 1) + ": " + error.what());
    }
  }
  require_comparable(weights);
  return weights;
}

std::vector<Mueller> fit_weights(std::span<const Sample> samples, const Basis& basis, const FitResult& fitted,
                                 Weights weights) {
  if (weights == Weights::none) return {};
  if (weights == Weights::data) return data_weights(samples, basis, fitted.model.reflectance);
  if (weights == Weights::estimated && fitted.noise.empty())
    throw std::invalid_argument("the fit has estimated no noise");
  return weights_of(samples, fitted.model, [&](double wavelength) {
    return weights == Weights::speckle
               ? NoiseLaw{}
               : fitted.noise[wavelength_index(fitted.model.validity.wavelengths, wavelength)].law;
  });
}

}  // namespace mmbrdf
