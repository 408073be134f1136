// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/weights.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "mmbrdf/model/at_wavelengths.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

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
  const PreparedModel first = prepare(model, 1);
  AtWavelengths prepared([&](double wavelength) { return first.at(wavelength); });
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
    return weights == Weights::speckle
               ? NoiseLaw{}
               : fitted.noise[wavelength_index(fitted.model.validity.wavelengths, wavelength)].law;
  });
}

}  // namespace mmbrdf
