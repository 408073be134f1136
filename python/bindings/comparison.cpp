// SPDX-License-Identifier: BSD-3-Clause
// How far models and samples are from each other.
#include "mmbrdf/samples/comparison.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <variant>

#include "dataset.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/quantities/significance.hpp"
#include "mmbrdf/samples/matching.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "question.hpp"

namespace mmbrdf::python {

namespace {

py::object difference(const Difference& d) {
  return record("Difference", d.rms, d.mean, d.largest, nanometres(d.wavelength), degrees(d.geometry.incident.theta),
                degrees(d.geometry.incident.phi), degrees(d.geometry.reflected.theta),
                degrees(d.geometry.reflected.phi));
}

py::object significance_object(const Significance& s) {
  return record("Significance", s.samples, s.u, s.rms, s.mean, s.largest, nanometres(s.wavelength),
                geometry_object(s.geometry), s.within, s.beyond);
}

/// Without what is not known of the difference, or 0.
using Significances = std::optional<std::array<Significance, 16>>;

py::object comparison_object(const Comparison& found, const Significances& over_u, long images = 0) {
  py::object by_element = py::none();
  if (over_u) by_element = py::dict();
  for (std::size_t e = 0; over_u && e < 16; ++e)
    if ((*over_u)[e].samples > 0) by_element[py::str(element_name(e))] = significance_object((*over_u)[e]);
  py::dict normalized;
  for (std::size_t e = 1; e < 16; ++e)
    if (found.normalized[e].samples > 0) normalized[py::str(element_name(e))] = difference(found.normalized[e]);
  return record("Comparison", found.samples, found.dark, difference(found.f11), difference(found.f11_relative),
                normalized, polarization_rms(found), difference(largest(found)), by_element, images);
}

/// How two are to be compared.
struct Asked {
  std::optional<std::vector<double>> wavelengths = {};   // micrometres
  std::optional<std::vector<Geometry>> geometries = {};  // of two models
  std::optional<double> theta_max = {};
  std::vector<TypeBTerm> terms = {};
  bool as_printed = false;
};

std::vector<Sample> samples_of(const Dataset& data, const Asked& asked) {
  return asked.wavelengths ? at_wavelengths(data.samples, *asked.wavelengths) : data.samples;
}

void require_some(const std::vector<Sample>& samples, const Asked& asked) {
  if (!samples.empty()) return;
  throw std::invalid_argument(asked.theta_max ? "theta_max_deg = " + formatted("{:g}", degrees(*asked.theta_max)) +
                                                    ": no geometry is within"
                                              : "no direction is within the fitted ranges of both: give theta_max_deg");
}

void warn_of_extrapolation(const ModelObject& model, const std::vector<Sample>& samples) {
  RangeCount range;
  for (const Sample& s : samples) range.add(outside(model.model().validity, s.wavelength, s.geometry));
  warn_outside(model, range, "sample");
}

bool any_has_uncertainty(const std::vector<Sample>& samples) {
  return std::ranges::any_of(samples, [](const Sample& s) { return has_uncertainty(s); });
}

/// Whether u of both is known. Throws where it is not, and terms were to be added to it.
bool are_known(bool model, bool other, const Asked& asked) {
  if (model && other) return true;
  if (!asked.terms.empty())
    throw std::invalid_argument(std::string("terms: need uncertainties of both, and those of ") +
                                (model ? "other" : "model") + " are not known");
  return false;
}

py::object with_samples(const ModelObject& model, const Dataset& data, const Asked& asked) {
  if (asked.geometries) throw std::invalid_argument("geometry: goes with two models; samples have their own");
  const Model& first = model.turned(asked.as_printed);
  std::vector<Sample> samples = samples_of(data, asked);
  const std::size_t all = samples.size(), left_out = leave_out_beyond(first, samples, asked.theta_max);
  require_some(samples, asked);
  if (left_out > 0 && !asked.theta_max)
    warn("ExtrapolationWarning", std::to_string(left_out) + " of " + counted(static_cast<long>(all), "sample") +
                                     " beyond the fitted range are left out: theta_max_deg=90 takes all");
  warn_of_extrapolation(model, samples);
  const bool known = are_known(knows_uncertainty(first), any_has_uncertainty(samples), asked);
  const Comparison found = without_gil([&] { return compare(first, samples); });
  Significances over_u;
  if (known) over_u = without_gil([&] { return significance(first, samples, asked.terms); });
  return comparison_object(found, over_u);
}

std::vector<double> wavelengths_of(const Model& first, const Model& second, const Asked& asked) {
  const std::vector<double> result = asked.wavelengths ? *asked.wavelengths : common_wavelengths(first, second);
  if (result.empty())
    throw std::invalid_argument(
        "wavelength_nm: needed, since there is none of which both models say that they were fitted to it");
  return result;
}

/// Geometries that are given are taken as they are, but for theta_max.
std::vector<Sample> samples_of(const Model& first, const Model& second, const Asked& asked) {
  const std::vector<double> wavelengths = wavelengths_of(first, second, asked);
  return without_gil([&] {
    return asked.geometries ? samples_to_compare(first, second, wavelengths, *asked.geometries,
                                                 asked.theta_max.value_or(radians(90)))
                            : samples_to_compare(first, second, wavelengths, germer2017_grid(), asked.theta_max);
  });
}

py::object with_model(const ModelObject& model, const ModelObject& other, const Asked& asked) {
  const Model &first = model.turned(asked.as_printed), &second = other.model();
  const std::vector<Sample> samples = samples_of(first, second, asked);
  require_some(samples, asked);
  warn_of_extrapolation(model, samples);
  warn_of_extrapolation(other, samples);
  const bool known = are_known(knows_uncertainty(first), knows_uncertainty(second), asked);
  const Comparison found = without_gil([&] { return compare(first, samples); });
  Significances over_u;
  if (known) over_u = without_gil([&] { return significance(first, second, samples, asked.terms); });
  return comparison_object(found, over_u);
}

void require_common_wavelength(const Dataset& first, const Dataset& second) {
  const std::vector<double> one = wavelengths(first.samples), other = wavelengths(second.samples);
  if (std::ranges::none_of(one, [&](double w) { return wavelength_index(other, w) < other.size(); }))
    throw std::invalid_argument("the samples have no wavelength in common: they are at " + nanometre_list(one) +
                                " and " + nanometre_list(other));
}

/// Of the fits to both that fit() makes by default.
py::object of_fits(const Dataset& first, const Dataset& second, const Asked& asked) {
  const Dataset one(samples_of(first, asked)), other(samples_of(second, asked));
  require_common_wavelength(one, other);
  const auto fitted = [](const Dataset& data) {
    return std::make_shared<ModelObject>(without_gil([&] { return fit_sample(data.samples).model; }));
  };
  return with_model(*fitted(one), *fitted(other), asked);
}

Matching matching_from(double tolerance_deg, const std::vector<std::string>& partners) {
  Matching result{.tolerance = radians(tolerance_deg)};
  for (const std::string& name : partners) {
    if (name != "mirror" && name != "reciprocal")
      throw std::invalid_argument("partners: '" + name + "', expected 'mirror' or 'reciprocal'");
    (name == "mirror" ? result.mirrored : result.exchanged) = true;
  }
  return result;
}

/// Sample beside sample.
py::object of_pairs(const Dataset& first, const Dataset& second, const Asked& asked, const Matching& matching) {
  if (asked.geometries || asked.as_printed || !asked.terms.empty())
    throw std::invalid_argument("match_deg: samples beside samples have no geometry, as_printed or terms");
  std::vector<Sample> one = samples_of(first, asked), other = samples_of(second, asked);
  if (asked.theta_max)
    for (std::vector<Sample>* samples : {&one, &other}) leave_out_beyond(*asked.theta_max, *samples);
  const MatchedSamples pairs = without_gil([&] {
    try {
      return matched(one, other, matching);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(std::string("match_deg: ") + error.what());
    }
  });
  if (pairs.first.empty())
    throw std::invalid_argument("no sample of other is within " + formatted("{:g}", degrees(matching.tolerance)) +
                                " degrees of one of model: without match_deg their fits are compared");
  const Comparison found = without_gil([&] { return compare(pairs.first, pairs.second); });
  Significances over_u;
  if (any_has_uncertainty(pairs.first) && any_has_uncertainty(pairs.second))
    over_u = without_gil([&] { return significance(pairs.first, pairs.second); });
  return comparison_object(found, over_u, pairs.images);
}

using Other = std::variant<DatasetPointer, ModelPointer>;

py::object compared(const Other& one, const Other& other, const Asked& asked, const std::optional<double>& match_deg,
                    const std::vector<std::string>& partners) {
  const auto* first = std::get_if<DatasetPointer>(&one);
  const auto* second = std::get_if<DatasetPointer>(&other);
  if (first && !second) throw std::invalid_argument("model: samples; beside a model they are the second argument");
  if (match_deg) {
    if (!first) throw std::invalid_argument("match_deg: goes with two Datasets");
    return of_pairs(**first, **second, asked, matching_from(*match_deg, partners));
  }
  if (!partners.empty()) throw std::invalid_argument("partners: go with match_deg");
  if (first) return of_fits(**first, **second, asked);
  const ModelObject& model = *std::get<ModelPointer>(one);
  return second ? with_samples(model, **second, asked) : with_model(model, *std::get<ModelPointer>(other), asked);
}

std::optional<double> theta_max_from(const std::optional<double>& degrees) {
  if (!degrees) return std::nullopt;
  if (!(*degrees > 0 && *degrees <= 90))
    throw std::invalid_argument("theta_max_deg = " + formatted("{:g}", *degrees) + ": must be in (0, 90] degrees");
  return radians(*degrees);
}

constexpr const char* compare_doc =
    "How far a Dataset or a second Model is from a model: their Comparison, other - model in the xy frame. Of two\n"
    "Datasets each is fitted as fit() does it by default, and the fits are compared, or sample is set beside sample.\n"
    "Where the uncertainties of both are known each difference d is set beside its own, u, as if both were\n"
    "independent: Comparison.significance. A model and the samples that it was fitted to are not.\n\n"
    "wavelength_nm  only at these; None: all that samples have, or both models were fitted to\n"
    "geometry       for two models, as in_plane() and the like give it; None: those of germer2017_grid() that are\n"
    "               within the fitted angles of both\n"
    "as_printed     of the first model\n"
    "theta_max_deg  only where both polar angles are at most this; None: without what lies beyond the angles to which "
    "a\n"
    "               model was fitted at the wavelength, with an ExtrapolationWarning of samples that are left out. A\n"
    "               geometry that is given is taken as it is. Of what is compared beyond the fit is warned, too\n"
    "terms          of u, as those of evaluate_uncertainty(): errors of the difference that neither knows\n"
    "match_deg      for two Datasets: each sample of other beside the nearest of model whose directions are both\n"
    "               within this angle of its own, at most 5, in the place of fits\n"
    "partners       match also with the image of a sample, 'mirror' in the plane of incidence, 'reciprocal', or both";

}  // namespace

void bind_comparison(py::module_& m) {
  m.def(
      "residuals",
      [](const ModelObject& model, const Dataset& data, bool as_printed) {
        return array_of(without_gil([&] { return residuals(model.turned(as_printed), data.samples); }));
      },
      py::arg("model"), py::arg("data"), py::kw_only(), py::arg("as_printed") = false,
      "Measured - model for each sample, (N, 4, 4) in the xy frame: element 11 of f11 in sr^-1, the others of\n"
      "f_ij / f11.");
  m.def(
      "compare",
      [](const Other& one, const Other& other, const std::optional<Given>& nm,
         const std::optional<py::sequence>& geometry, bool as_printed, const std::optional<double>& theta_max_deg,
         const Terms& terms, const std::optional<double>& match_deg, const std::vector<std::string>& partners) {
        Asked asked{.theta_max = theta_max_from(theta_max_deg), .terms = terms_from(terms), .as_printed = as_printed};
        if (nm) asked.wavelengths = micrometres(numbers("wavelength_nm", *nm));
        if (geometry) asked.geometries = geometries_from(*geometry);
        return compared(one, other, asked, match_deg, partners);
      },
      py::arg("model").none(false), py::arg("other").none(false), py::arg("wavelength_nm") = py::none(),
      py::arg("geometry") = py::none(), py::kw_only(), py::arg("as_printed") = false,
      py::arg("theta_max_deg") = py::none(), py::arg("terms") = py::none(), py::arg("match_deg") = py::none(),
      py::arg("partners") = std::vector<std::string>{}, compare_doc);
}

}  // namespace mmbrdf::python
