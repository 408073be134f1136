// SPDX-License-Identifier: BSD-3-Clause
// How far models and samples are from each other.
#include "mmbrdf/samples/comparison.hpp"

#include <pybind11/stl.h>

#include <variant>

#include "dataset.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/quantities/significance.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf::python {

namespace {

py::object difference(const Difference& d) {
  return record("Difference", d.rms, d.mean, d.largest, nanometres(d.wavelength), degrees(d.geometry.incident.theta),
                degrees(d.geometry.incident.phi), degrees(d.geometry.reflected.theta),
                degrees(d.geometry.reflected.phi));
}

py::object significance_object(const Significance& s) {
  return record("Significance", s.samples, s.mean, s.largest, nanometres(s.wavelength), geometry_object(s.geometry),
                s.within);
}

/// `second`: of what the samples are without noise; null: they were measured.
py::object compared(const Model& model, const std::vector<Sample>& samples, const Model* second) {
  const Comparison found = without_gil([&] { return compare(model, samples); });
  py::object by_element = py::none();
  if (second && knows_uncertainty(model) && knows_uncertainty(*second)) {
    const auto all = without_gil([&] { return significance(model, *second, samples); });
    by_element = py::dict();
    for (std::size_t e = 0; e < 16; ++e)
      if (all[e].samples > 0) by_element[py::str(element_name(e))] = significance_object(all[e]);
  }
  py::dict normalized;
  for (std::size_t e = 1; e < 16; ++e)
    if (found.normalized[e].samples > 0) normalized[py::str(element_name(e))] = difference(found.normalized[e]);
  return record("Comparison", found.samples, found.dark, difference(found.f11), difference(found.f11_relative),
                normalized, polarization_rms(found), difference(largest(found)), by_element);
}

using Other = std::variant<DatasetPointer, ModelPointer>;

/// The model, or the fit to samples that fit() makes by default, where both are samples.
ModelPointer model_of(const Other& one) {
  if (const auto* model = std::get_if<ModelPointer>(&one)) return *model;
  const std::vector<Sample>& samples = std::get<DatasetPointer>(one)->samples;
  return std::make_shared<ModelObject>(without_gil([&] { return fit_sample(samples).model; }));
}

bool is_samples(const Other& one) { return std::holds_alternative<DatasetPointer>(one); }

using Wavelengths = std::optional<std::vector<double>>;

/// The samples to compare with, or what the other model gives in their place.
std::vector<Sample> others(const Model& model, const Other& other, const Wavelengths& nm,
                           const std::optional<py::sequence>& geometry) {
  if (const auto* data = std::get_if<DatasetPointer>(&other)) {
    if (geometry) throw std::invalid_argument("geometry: goes with two models; samples have their own");
    return nm ? at_wavelengths((*data)->samples, micrometres(*nm)) : (*data)->samples;
  }
  const Model& second = std::get<ModelPointer>(other)->model();
  const std::vector<double> wavelengths = nm ? micrometres(*nm) : common_wavelengths(model, second);
  if (wavelengths.empty())
    throw std::invalid_argument(
        "wavelength_nm: needed, since there is none of which both models say that they were fitted to it");
  if (!geometry) return without_gil([&] { return samples_to_compare(model, second, wavelengths, germer2017_grid()); });
  const std::vector<Geometry> geometries = geometries_from(*geometry);
  return without_gil([&] { return simulate(second, wavelengths, geometries); });
}

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
      [](const Other& one, const Other& given, const std::optional<Given>& nm,
         const std::optional<py::sequence>& geometry, bool as_printed) {
        if (is_samples(one) && !is_samples(given))
          throw std::invalid_argument("model: samples; beside a model they are the second argument");
        const ModelPointer model = model_of(one);
        const Other other = is_samples(one) ? Other(model_of(given)) : given;
        const Model& first = model->turned(as_printed);
        const Wavelengths wavelengths = nm ? Wavelengths(numbers("wavelength_nm", *nm)) : std::nullopt;
        const auto* second = std::get_if<ModelPointer>(&other);
        return compared(first, others(first, other, wavelengths, geometry), second ? &(*second)->model() : nullptr);
      },
      py::arg("model").none(false), py::arg("other").none(false), py::arg("wavelength_nm") = py::none(),
      py::arg("geometry") = py::none(), py::kw_only(), py::arg("as_printed") = false,
      "How far a Dataset or a second Model is from a model: their Comparison, other - model in the xy frame. Of two\n"
      "Datasets each is fitted as fit() does it by default, and the fits are compared. Of models whose uncertainties "
      "are\n"
      "known, each difference is set beside its own, that of independent fits: Comparison.significance.\n\n"
      "wavelength_nm  only at these; None: all that samples have, or both models were fitted to\n"
      "geometry       for two models, as in_plane() and the like give it; None: those of germer2017_grid() that are\n"
      "               within the fitted angles of both\n"
      "as_printed     of the first model");
}

}  // namespace mmbrdf::python
