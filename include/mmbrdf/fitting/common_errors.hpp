// SPDX-License-Identifier: BSD-3-Clause
/// Errors that all samples of a fit share, such as those of the instrument's calibration: more samples do not average
/// them out, and no residual shows them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/model/model.hpp"
#include "mmbrdf/polarimetry/calibration.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// How samples change with one error of one standard deviation: one matrix for each sample in the xy frame, the change
/// of f11 in sr⁻¹ as element 11, those of the normalised elements as the others.
using SampleChanges = std::vector<Mueller>;

/// The independent errors of a polarimeter, and what each does to these samples, all of which it measured. Empty if the
/// reduction has no covariance.
std::vector<SampleChanges> instrument_errors(const Reduction& reduction, std::span<const Sample> samples);

/// Adds to the covariance of a fitted model what common errors do to its coefficients: with X and W the rows and
/// weights of the fit, da = (XᵀWX)⁺ XᵀW dy and Σ da daᵀ. Weights are those of the fit, as FitAccumulator::add takes
/// them; empty means 1. What such an error correlates between blocks is not kept. A reflectance table that was given is
/// exact. Throws std::invalid_argument for a model with powers of the wavelength or a reflectance of its own samples
/// (an instrument is calibrated for one wavelength), one whose covariance is not known, samples of another wavelength
/// than the first, or sizes that do not agree.
void add_common_errors(Model& model, std::span<const Sample> samples, std::span<const SampleChanges> errors,
                       std::span<const Mueller> weights = {});

/// Throws std::invalid_argument, beginning with `name`, for a linear calibration, which has no covariance, and for
/// samples of another wavelength than that of the instrument.
void require_measured_by(std::span<const Sample> samples, const Calibration& instrument, const std::string& name);

/// Adds to the covariance of a fit what the instrument that measured all its samples is uncertain by, and records it in
/// the model: provenance["instrument"] is `name`, what the instrument is called. The samples are those of the fit. Throws
/// as require_measured_by() and add_common_errors(), and std::invalid_argument for a block without degrees of freedom;
/// the fit is then as it was.
void add_instrument(FitResult& fitted, std::span<const Sample> samples, const Calibration& instrument,
                    const std::string& name);

}  // namespace mmbrdf
