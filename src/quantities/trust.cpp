// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/trust.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <stdexcept>

#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "mmbrdf/text/units.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// Calls `visit` with the places, in order.
void visit_places(double theta_max, int coarser, const auto& visit) {
  const double step = 2.5 * coarser;
  const auto steps = static_cast<int>(degrees(theta_max) / step + 1e-9);
  for (int i = 0; i <= steps; ++i)
    for (int r = 0; r <= steps; ++r)
      for (int d = 0; d <= 24 / coarser; ++d)
        visit(Geometry{{radians(step * i), 0}, {radians(step * r), radians(3 * step * d)}});
}

void find_largest_dhr(F11Diagnostics& result, const Model& model) {
  const auto steps = 5 * static_cast<int>(degrees(result.theta_max) / 2.5 + 1e-9);
  for (int i = 0; i <= steps; ++i) {
    const double theta = radians(0.5 * i);
    const double dhr = directional_hemispherical_reflectance(model, result.wavelength, {theta, 0});
    if (i > 0 && dhr <= result.dhr) continue;
    result.dhr = dhr;
    result.dhr_theta_i = theta;
  }
  if (result.dhr > 1 && knows_uncertainty(model))
    result.u_dhr = standard_uncertainty(
        directional_hemispherical_budget(uncertain(model, result.wavelength), {result.dhr_theta_i, 0}));
}

/// Parts of a whole, by an angle in degrees.
struct Missing {
  double part = 0, whole = 0;
  double share() const { return whole > 0 ? part / whole : 0; }
  void add(double weight, bool missing) {
    whole += weight;
    part += missing ? weight : 0;
  }
};
using MissingAt = std::map<double, Missing>;

/// Calls `visit` with the nodes within the fitted angles, their weights, and whether no samples support them.
void visit_nodes(const Validity& validity, double wavelength, const auto& visit) {
  if (validity.supported.empty()) return;
  const DirectionPairs& grid = validity.supported.front().pairs;
  for (std::size_t node = 0; node < grid.nodes(); ++node) {
    const Geometry g = grid.geometry(node);
    const Outside where = outside(validity, wavelength, g);
    if (where & (outside_theta_i | outside_theta_r)) continue;
    const auto weight = [](const Direction& d) { return std::sin(d.theta) * std::cos(d.theta); };
    visit(g, weight(g.incident) * weight(g.reflected), (where & outside_directions) != 0);
  }
}

/// All that are missing, and by each angle.
struct AllMissing {
  Missing all;
  MissingAt theta_i, theta_r, phi;
};

AllMissing all_missing(const Validity& validity, double wavelength) {
  AllMissing result;
  visit_nodes(validity, wavelength, [&](const Geometry& g, double weight, bool missing) {
    result.all.add(weight, missing);
    result.theta_i[std::round(degrees(g.incident.theta))].add(weight, missing);
    result.theta_r[std::round(degrees(g.reflected.theta))].add(weight, missing);
    result.phi[std::round(std::abs(std::remainder(degrees(g.reflected.phi - g.incident.phi), 360)))].add(weight,
                                                                                                         missing);
  });
  return result;
}

/// The part where more than half is missing; none if that is everywhere or nowhere.
std::optional<Hole::Degrees> missing_part(const MissingAt& at) {
  const auto lacks = [](const auto& one) { return one.second.share() > 0.5; };
  const auto first = std::ranges::find_if(at, lacks);
  if (first == at.end() || std::ranges::all_of(at, lacks)) return {};
  return Hole::Degrees{first->first, std::prev(std::find_if_not(first, at.end(), lacks))->first};
}

Hole hole_of(const AllMissing& missing) {
  if (!(missing.all.share() > much_unsupported)) return {};
  return {missing_part(missing.theta_i), missing_part(missing.theta_r), missing_part(missing.phi)};
}

/// "theta_i 0 to 30"; empty for none.
std::string part_line(const std::string& name, const std::optional<Hole::Degrees>& part) {
  if (!part) return "";
  const std::string from = rounded(part->from, 3), to = rounded(part->to, 3);
  return name + " " + from + (to == from ? "" : " to " + to);
}

/// What so large a reflectance usually comes from.
std::string usual_causes(double dhr) {
  if (dhr > 10) return "is f11, or a reflectance that was given, in percent?";
  if (dhr > 2) return "is f11 multiplied by pi, or are the matrices divided by their element 11?";
  return "is the scale of f11 right?";
}

/// Whether one of the errors of a posterior from `first` to `end` has a size.
bool declares(const Model& model, std::size_t first, std::size_t end) {
  if (!model.posterior) return false;
  const std::span<const SharedError> errors(model.posterior->data().errors);
  return std::ranges::any_of(errors.subspan(first, end - first), [](const SharedError& e) { return e.size > 0; });
}

}  // namespace

F11Diagnostics f11_diagnostics(const Model& model, double wavelength, double theta_max, int coarser) {
  if (!(theta_max >= 0 && theta_max <= radians(90) * (1 + 1e-12)))
    throw std::invalid_argument("largest polar angle " + shortest(degrees(theta_max)) + " degrees is not in [0, 90]");
  const PreparedModel prepared = prepare(model, wavelength);
  F11Diagnostics result;
  result.wavelength = wavelength;
  result.theta_max = theta_max;
  result.f11.value = std::numeric_limits<double>::max();
  visit_places(theta_max, coarser, [&](const Geometry& geometry) {
    const double f11 = prepared.f11(geometry);
    ++result.geometries;
    if (!(f11 > 0)) ++result.not_positive_f11;
    if (f11 < result.f11.value) result.f11 = {f11, geometry};
  });
  find_largest_dhr(result, model);
  return result;
}

ModelDiagnostics model_diagnostics(const Model& model, double wavelength, double theta_max) {
  ModelDiagnostics result{f11_diagnostics(model, wavelength, theta_max), {}, 0, unknown_elements(model).none()};
  if (!result.whole) return result;
  const PreparedModel prepared = prepare(model, wavelength);
  bool first = true;
  visit_places(theta_max, 1, [&](const Geometry& geometry) {
    const Mueller f = prepared.evaluate(geometry);
    if (f(0, 0) == 0) return;
    const double margin = realizability_margin(normalized(f));
    if (margin < 0) ++result.unrealizable;
    if (first || margin < result.margin.value) result.margin = {margin, geometry};
    first = false;
  });
  return result;
}

double fitted_theta_max(const Validity& validity) {
  if (!validity.theta_i_max || !validity.theta_r_max) return radians(90);
  return std::max(*validity.theta_i_max, *validity.theta_r_max);
}

double unsupported_share(const Validity& validity, double wavelength) {
  return all_missing(validity, wavelength).all.share();
}

Hole unsupported_part(const Validity& validity, double wavelength) {
  return hole_of(all_missing(validity, wavelength));
}

std::string unsupported_line(const Validity& validity, double wavelength) {
  const AllMissing missing = all_missing(validity, wavelength);
  const Missing& all = missing.all;
  if (!(all.share() > much_unsupported)) return "";
  const Hole hole = hole_of(missing);
  std::string parts;
  for (const std::string& part :
       {part_line("phi_r - phi_i", hole.phi), part_line("theta_i", hole.theta_i), part_line("theta_r", hole.theta_r)})
    if (!part.empty()) parts += (parts.empty() ? ", most at " : ", at ") + part;
  return "no samples support " + (all.share() < 0.995 ? rounded(100 * all.share(), 2) : "100") +
         " % of the pairs of directions within the fitted angles" + parts + (parts.empty() ? "" : " degrees") +
         ": what is said there is an extrapolation";
}

MissingShares missing_shares(const Validity& validity, double wavelength) {
  if (validity.supported.empty() || validity.supported.front().pairs.grid() != DirectionPairs::Grid::isotropic)
    return {};
  std::map<double, std::size_t> thetas, phis;  // places of the nodes' angles
  const auto angles_of = [](const Geometry& g) {
    return std::array{std::round(degrees(g.incident.theta)), std::round(degrees(g.reflected.theta)),
                      std::round(degrees(g.reflected.phi))};
  };
  const DirectionPairs& grid = validity.supported.front().pairs;
  for (std::size_t node = 0; node < grid.nodes(); ++node)
    thetas[angles_of(grid.geometry(node))[0]] = phis[angles_of(grid.geometry(node))[2]] = 0;
  MissingShares result;
  for (auto& [theta, place] : thetas) place = result.theta_deg.size(), result.theta_deg.push_back(theta);
  for (auto& [phi, place] : phis) place = result.phi_deg.size(), result.phi_deg.push_back(phi);
  std::vector<Missing> sources(thetas.size()), detectors(thetas.size() * phis.size());
  visit_nodes(validity, wavelength, [&](const Geometry& g, double, bool missing) {
    const auto [theta_i, theta_r, phi] = angles_of(g);
    const auto weight = [](const Direction& d) { return std::sin(d.theta) * std::cos(d.theta) + 1e-6; };
    sources[thetas[theta_i]].add(weight(g.reflected), missing);
    detectors[thetas[theta_r] * phis.size() + phis[phi]].add(weight(g.incident), missing);
  });
  const auto share = [](const Missing& one) { return one.whole > 0 ? one.share() : std::nan(""); };
  std::ranges::transform(sources, std::back_inserter(result.theta_i), share);
  std::ranges::transform(detectors, std::back_inserter(result.detector), share);
  return result;
}

std::string not_positive_line(const F11Diagnostics& found, const std::string& where) {
  if (found.not_positive_f11 == 0) return "";
  return "f11 is not positive at " + std::to_string(found.not_positive_f11) + " of " +
         counted(found.geometries, "direction") + " " + where + ", down to " + rounded(found.f11.value, 3) +
         " sr^-1 at " + place_line(found.f11.geometry);
}

std::string energy_line(const F11Diagnostics& found, const std::string& where) {
  if (!(found.dhr > impossible || found.dhr - 1 > surely * found.u_dhr)) return "";
  return "the directional-hemispherical reflectance reaches " + fixed(found.dhr, 4) +
         (found.u_dhr > 0 ? " +- " + rounded(found.u_dhr, 2) : "") + " at theta_i " +
         rounded(degrees(found.dhr_theta_i), 4) + " degrees, " + where + ": more light comes back than falls in; " +
         usual_causes(found.dhr);
}

std::string place_line(const Geometry& g) {
  return "theta_i " + rounded(degrees(g.incident.theta), 4) + ", theta_r " + rounded(degrees(g.reflected.theta), 4) +
         ", phi_r - phi_i " + rounded(std::remainder(degrees(g.reflected.phi - g.incident.phi), 360), 4) + " degrees";
}

std::string uncertain_of(const Model& model) {
  const bool instrument = model.provenance.contains("instrument"),
             certificate = model.provenance.contains("certificate");
  return std::string(model.posterior
                         ? declares(model, 0, declared_errors) ? "the sample with declared errors" : "the sample"
                         : "the fit") +
         (instrument ? certificate ? ", its instrument" : " and its instrument" : "") +
         (certificate ? " and its certificate" : "");
}

std::string missing_from_uncertainty(const Model& model) {
  std::vector<std::string> missing;
  if (!model.provenance.contains("certificate") && !declares(model, 0, 1))  // that of an instrument is its own
    missing.emplace_back(model.provenance.contains("instrument") ? "solid angle" : "scale");
  if (!declares(model, 1, declared_errors)) missing.emplace_back("angles");
  if (!model.posterior) missing.emplace_back("sample");
  std::string text;
  for (std::size_t i = 0; i < missing.size(); ++i)
    text += (i == 0 ? "" : i + 1 < missing.size() ? ", " : " and ") + missing[i];
  return text + (missing.empty() ? "" : missing.size() == 1 ? " is not in it" : " are not in it");
}

}  // namespace mmbrdf
