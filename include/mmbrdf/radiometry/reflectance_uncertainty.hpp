// SPDX-License-Identifier: BSD-3-Clause
/// What makes the quantities of reflectance.hpp uncertain, cause by cause: first the fit, by the slopes of the matrix over
/// the coefficients, integrated as the matrix is; then each term of type B. An error of a term is one and the same at all
/// geometries, so its effect on an integral is the integral of its effects. standard_uncertainty() puts the causes
/// together, expanded() makes of them what can be signed. Effects of angles are integrated with the nodes that are exact
/// for the matrix: to some 2 %. All throw std::invalid_argument where the values or effects() do.
#pragma once

#include "mmbrdf/geometry/apertures.hpp"
#include "mmbrdf/uncertainty/expanded.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {

/// A model at one wavelength, with all that is uncertain of it.
struct UncertainModel {
  PreparedModel model;
  PreparedUncertainty fit;
  std::vector<TypeBTerm> terms;
  int hemisphere_nodes;
};

/// At a wavelength in micrometres. Throws as prepare() and prepare_uncertainty() do.
UncertainModel uncertain(const Model& model, double wavelength, std::vector<TypeBTerm> terms = {});

/// For light of any polarization in the sp frame of the incident beam.
std::vector<Contribution> directional_hemispherical_budget(const UncertainModel& model, const Direction& incident,
                                                           const Stokes& light_sp = {1, 0, 0, 0});

/// Through an analyzer in the sp frame of the reflected beam.
std::vector<Contribution> hemispherical_directional_budget(const UncertainModel& model, const Direction& reflected,
                                                           const Stokes& analyzer_sp = {1, 0, 0, 0});

std::vector<Contribution> bihemispherical_budget(const UncertainModel& model);

/// Of the mean matrix over two apertures, in sr⁻¹, frame xy. `nodes` as in mean_rule: those of an Average, or fewer,
/// since an uncertainty needs few digits.
Budget average_budget(const UncertainModel& model, const Aperture& source, const Aperture& receiver, int nodes);

}  // namespace mmbrdf
