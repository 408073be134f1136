// SPDX-License-Identifier: BSD-3-Clause
// How far a model, samples and a fit can be trusted.
#include <pybind11/stl.h>

#include <cmath>

#include "fit.hpp"
#include "mmbrdf/fitting/leverage.hpp"
#include "mmbrdf/fitting/symmetry.hpp"
#include "mmbrdf/fitting/weights.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/samples/mirror_pairs.hpp"

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

}  // namespace

void bind_diagnostics(py::module_& m) {
  bind_samples(m);
  bind_model_diagnostics(m);
}

}  // namespace mmbrdf::python
