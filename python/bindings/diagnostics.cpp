// SPDX-License-Identifier: BSD-3-Clause
// How far a model, samples and a fit can be trusted, and how far they are from each other.
#include <pybind11/stl.h>

#include <cmath>
#include <variant>

#include "fit.hpp"
#include "mmbrdf/fitting/leverage.hpp"
#include "mmbrdf/fitting/symmetry.hpp"
#include "mmbrdf/fitting/weights.hpp"
#include "mmbrdf/quantities/significance.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "mmbrdf/samples/mirror_pairs.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf::python {

namespace {

py::object symmetries(const Dataset& data, std::pair<int, int> orders, const std::string& mapping) {
  const DiscMapping disc = disc_mapping_from(mapping);
  const SymmetryTests tests = without_gil([&] {
    return symmetry_tests(data.samples, {orders.first, orders.second}, disc);
  });
  const auto all = [](const std::vector<FTest>& of_blocks) {
    return tuple_of(of_blocks, [](const FTest& t) {
      return record("FTest", t.block, t.rows, t.extra, t.freedom, t.rms, t.rms_extended, t.f, t.p);
    });
  };
  return record("SymmetryTests", all(tests.reciprocity), all(tests.mirror), all(tests.azimuth), tests.one_azimuth);
}

py::object diagnosed(const Fitted& fitted, const Dataset& data) {
  const SampleDiagnostics found =
      without_gil([&] { return sample_diagnostics(data.samples, fitted.result, fitted.result.sample_weights); });
  const auto leverage = [](const SampleDiagnostics::Leverage& block) {
    return record("Leverage", block.block, block.rank,
                  py::array_t<double>(static_cast<py::ssize_t>(block.values.size()), block.values.data()),
                  block.largest);
  };
  return record("SampleDiagnostics", tuple_of(found.leverage, leverage), array_of(found.studentized));
}

py::tuple outliers_of(const py::object& diagnostics, double threshold) {
  const Broadcast studentized({{"studentized", diagnostics.attr("studentized"), {4, 4}}});
  SampleDiagnostics found;
  for (std::size_t i = 0; i < studentized.size(); ++i) found.studentized.push_back(studentized.mueller(0, i));
  return tuple_of(outliers(found, threshold), [](const Outlier& one) {
    return record("Outlier", one.sample, element_name(one.element), one.studentized);
  });
}

void bind_samples(py::module_& m) {
  m.def(
      "symmetry_tests", symmetries, py::arg("data"), py::arg("orders") = std::pair(7, 4), py::kw_only(),
      py::arg("mapping") = "lambert",
      "Whether samples break reciprocity, mirror symmetry or isotropy: SymmetryTests, an F test of each block of the\n"
      "isotropic family. With thousands of rows the least misfit is significant: compare the rms, not only p.");
  m.def("sample_diagnostics", diagnosed, py::arg("result"), py::arg("data"),
        "How much each sample of a fit determines, and how far it lies off: SampleDiagnostics of a FitResult and the\n"
        "samples that it was fitted to.");
  m.def("outliers", outliers_of, py::arg("diagnostics"), py::arg("threshold") = 5.0,
        "Outlier of each sample and element beyond this many standard deviations, the largest first, from\n"
        "SampleDiagnostics. Of 100 000 normal residuals 6 exceed 4, none 5.");
  m.def(
      "mirror_pairs",
      [](const Dataset& data) {
        const MirrorPairs found = without_gil([&] { return mirror_pairs(data.samples); });
        return record("MirrorPairs", found.pairs, array_of(found.rms), array_of(found.mean));
      },
      py::arg("data"), "What samples that are each other's mirror image say of noise and handedness: MirrorPairs.");
}

void bind_model_diagnostics(py::module_& m) {
  m.def(
      "model_diagnostics",
      [](const ModelObject& model, const std::optional<double>& nm, double theta_max) {
        const double wavelength = model.wavelength(nm);
        const ModelDiagnostics d =
            without_gil([&] { return model_diagnostics(model.model(), wavelength, radians(theta_max)); });
        const double nan = std::nan("");
        const ModelDiagnostics::Extreme margin =
            d.whole ? d.margin : ModelDiagnostics::Extreme{nan, {{nan, nan}, {nan, nan}}};
        return record("ModelDiagnostics", nanometres(d.wavelength), degrees(d.theta_max), d.geometries, margin.value,
                      geometry_object(margin.geometry),
                      d.whole ? py::object(py::cast(d.unrealizable)) : py::object(py::none()), d.f11.value,
                      geometry_object(d.f11.geometry), d.not_positive_f11, d.dhr, degrees(d.dhr_theta_i));
      },
      py::arg("model"), py::arg("wavelength_nm") = py::none(), py::arg("theta_max_deg") = 90.0,
      "Where a model is not physical, in steps of 2.5 and 7.5 degrees up to theta_max_deg: ModelDiagnostics.");
}

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

}  // namespace

void bind_diagnostics(py::module_& m) {
  bind_samples(m);
  bind_model_diagnostics(m);
  bind_comparison(m);
}

}  // namespace mmbrdf::python
