// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"

#include <numbers>
#include <utility>

#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"

namespace mmbrdf {
namespace {

Budget budget_of_mean(const UncertainModel& at, const Aperture& source, const Aperture& receiver, int nodes,
                      Frame frame) {
  return budget(at.model, at.fit, at.terms, mean_rule(source, receiver, nodes), frame);
}

/// Of π aᵀ M s / (a1 s1), M the mean: an integral over the hemisphere is π times that.
std::vector<Contribution> of_hemisphere(const Budget& mean, const Stokes& analyzer, const Stokes& light) {
  degree_of_polarization(analyzer);
  degree_of_polarization(light);
  Mueller slope;
  for (std::size_t e = 0; e < 16; ++e)
    slope.elements[e] = std::numbers::pi * (analyzer[e / 4] / analyzer[0]) * (light[e % 4] / light[0]);
  return contributions(mean, slope);
}

}  // namespace

UncertainModel uncertain(const Model& model, double wavelength, std::vector<TypeBTerm> terms) {
  const Orders highest = model.posterior ? model.posterior->data().orders : orders(model);
  return {prepare(model, wavelength), prepare_uncertainty(model, wavelength), std::move(terms),
          hemisphere_nodes(highest, model.mapping)};
}

// In the sp frame the axes of the beam that stays are fixed; those of the other do not matter to the first row, or
// column.

std::vector<Contribution> directional_hemispherical_budget(const UncertainModel& model, const Direction& incident,
                                                           const Stokes& light_sp) {
  return of_hemisphere(
      budget_of_mean(model, Aperture::direction(incident), Aperture::hemisphere(), model.hemisphere_nodes, Frame::sp),
      {1, 0, 0, 0}, light_sp);
}

std::vector<Contribution> hemispherical_directional_budget(const UncertainModel& model, const Direction& reflected,
                                                           const Stokes& analyzer_sp) {
  return of_hemisphere(
      budget_of_mean(model, Aperture::hemisphere(), Aperture::direction(reflected), model.hemisphere_nodes, Frame::sp),
      analyzer_sp, {1, 0, 0, 0});
}

std::vector<Contribution> bihemispherical_budget(const UncertainModel& model) {
  const Aperture all = Aperture::hemisphere();
  const auto geometries =
      model.terms.empty() ? std::vector<WeightedGeometry>{} : mean_rule(all, all, model.hemisphere_nodes);
  return of_hemisphere(budget(model.model, model.fit, model.fit.bihemispherical_gradient(), model.terms, geometries),
                       {1, 0, 0, 0}, {1, 0, 0, 0});
}

Budget average_budget(const UncertainModel& model, const Aperture& source, const Aperture& receiver, int nodes) {
  return budget_of_mean(model, source, receiver, nodes, Frame::xy);
}

}  // namespace mmbrdf
