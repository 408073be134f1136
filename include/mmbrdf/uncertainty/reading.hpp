// SPDX-License-Identifier: BSD-3-Clause
/// What a reading of a sample will be, which is another question than its isotropic mean: a reading has noise, and the
/// sample stands at some azimuth (theory 8.4). Of models with a posterior, at their fitted wavelengths.
#pragma once

#include <memory>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// f11 in sr⁻¹ as element 11, the other elements divided by it, in the xy frame; with standard uncertainties.
struct PredictedReading {
  Mueller value, uncertainty;
};

/// May be used in many threads at once.
class ReadingPrediction {
 public:
  /// A reading of the sample at an azimuth that nobody knows: the value is the isotropic mean, its anisotropy, errors of
  /// the calibration and the noise are in the uncertainty. Throws std::invalid_argument for an invalid geometry, or a
  /// polar angle of 90 degrees.
  PredictedReading at_some_azimuth(const Geometry& geometry) const;

  /// The same with the sample as it stood in the readings of the fit, azimuths as they are: the anisotropy that was seen
  /// is in the value. Throws as that, and for a posterior in its rounded form, which does not know it.
  PredictedReading at_its_azimuth(const Geometry& geometry) const;

 private:
  friend ReadingPrediction predict_readings(const Model& model, double wavelength);
  struct State;
  explicit ReadingPrediction(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

/// Throws std::invalid_argument as prepare_uncertainty() does, for a model without a posterior, or at a wavelength
/// (micrometres) that is not fitted.
ReadingPrediction predict_readings(const Model& model, double wavelength);

}  // namespace mmbrdf
