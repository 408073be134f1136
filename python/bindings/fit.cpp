// SPDX-License-Identifier: BSD-3-Clause
// From samples to a model.
#include "mmbrdf/fitting/fit.hpp"

#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "fit.hpp"
#include "instrument.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/fitting/common_errors.hpp"
#include "mmbrdf/mixed/sample_traits.hpp"
#include "mmbrdf/quantities/conventions.hpp"
#include "mmbrdf/quantities/fit_warnings.hpp"
#include "pickles.hpp"

namespace mmbrdf::python {

namespace {

/// Says from what and how the model was made.
void sign(FitResult& result, const Request& request, std::size_t rows, const Dataset* data) {
  Model& model = result.model;
  model.name = request.name;
  model.provenance["rows"] = std::to_string(rows);
  if (data && !data->read_as.empty()) model.provenance["table"] = data->read_as;
  if (data && !data->reduction.empty()) model.provenance["reduction"] = data->reduction;
  model.provenance["software"] = std::string("mmbrdf ") + MMBRDF_VERSION;
  model.provenance["weights"] = to_string(request.weights);
  model.provenance["uncertainty"] = to_string(model.posterior ? Uncertainty::sample : Uncertainty::noise);
  if (request.options.covariance != Covariance::residuals)
    model.provenance["covariance"] = to_string(request.options.covariance);
  std::string noise;
  for (std::size_t i = 0; i < result.noise.size(); ++i)
    noise += (i > 0 ? "; " : "") + nanometre_list(std::array{model.validity.wavelengths[i]}) + ": " +
             to_string(result.noise[i]);
  if (!noise.empty()) model.provenance["noise"] = noise;
  if (!request.attribution.empty()) model.provenance["attribution"] = request.attribution;
}

/// Those of the first wavelength, evenly spread: what warnings are of.
void keep_some(std::span<const Sample> samples, Fitted& fitted) {
  std::vector<std::size_t> here;
  for (std::size_t s = 0; s < samples.size(); ++s)
    if (same_wavelength(samples[s].wavelength, samples.front().wavelength)) here.push_back(s);
  const std::size_t count = std::min(here.size(), most_tried);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t s = here[i * here.size() / count];
    fitted.some.push_back(samples[s]);
    fitted.numbers.push_back(static_cast<long>(s) + 1);
  }
}

}  // namespace

FittedPointer signed_result(FitResult result, const Request& request, std::size_t rows, const Dataset* data) {
  sign(result, request, rows, data);
  auto model = std::make_shared<ModelObject>(result.model);
  auto fitted = std::make_shared<Fitted>(std::move(result), std::move(model), request.basis, request.weights);
  if (data) keep_some(data->samples, *fitted);
  return fitted;
}

const std::vector<std::string>& Fitted::warnings() {
  std::call_once(asked_, [&] {
    if (warnings_.empty()) warnings_ = fit_warnings(result, some, numbers);
  });
  return warnings_;
}

DeclaredErrors declared_from(const std::map<std::string, double>& named) {
  DeclaredErrors declared;
  for (const auto& [name, value] : named) {
    if (!(value >= 0 && std::isfinite(value)))
      throw py::value_error("declared['" + name + "'] must be 0 or more, not " + formatted("{:.6g}", value));
    if (name == "scale")
      declared.scale = value;
    else if (name == "source_deg" || name == "receiver_deg")
      (name == "source_deg" ? declared.source : declared.receiver) = radians(value);
    else
      throw py::value_error("declared has no '" + name + "', only 'scale', 'source_deg' and 'receiver_deg'");
  }
  return declared;
}

namespace {

FittedPointer fitted(const Dataset& data, const Request& request) {
  return without_gil([&] {
    FitResult result = fit(data.samples, request.basis, request.options, request.weights);
    if (request.instrument) add_instrument(result, data.samples, *request.instrument, request.instrument->name);
    return signed_result(std::move(result), request, data.samples.size(), &data);
  });
}

py::array matrices_of(const std::vector<Mueller>& matrices, const py::object& owner) {
  constexpr auto size = static_cast<py::ssize_t>(sizeof(double));
  return view(matrices.empty() ? nullptr : matrices.front().elements.data(),
              {static_cast<py::ssize_t>(matrices.size()), 4, 4}, {16 * size, 4 * size, size}, owner);
}

py::array_t<double> rms_of(const Fitted& fitted) {
  Mueller rms;
  for (std::size_t e = 0; e < 16; ++e) rms.elements[e] = fitted.result.elements[e].rms;
  return array_of(rms);
}

py::list noise_of(const Fitted& fitted) {
  py::list result;
  for (std::size_t i = 0; i < fitted.result.noise.size(); ++i) {
    const NoiseEstimate& noise = fitted.result.noise[i];
    py::dict entry;
    entry["wavelength_nm"] = nanometres(fitted.result.model.validity.wavelengths[i]);
    entry["scale"] = noise.law.scale;
    entry["incident_exponent"] = noise.law.incident_exponent;
    entry["reflected_exponent"] = noise.law.reflected_exponent;
    result.append(entry);
  }
  return result;
}

py::dict reduced_chi_squared(const Fitted& fitted) {
  const auto [f11, others] = chi_squared_per_dof(fitted.result);
  py::dict result;
  result["f11"] = f11;
  result["others"] = others;
  for (std::size_t b = 0; b < fitted.result.solutions.size(); ++b)
    result[fitted.result.model.blocks[b].block.name.c_str()] = fitted.result.solutions[b].variance();
  return result;
}

std::string representation(const Fitted& fitted) {
  return "<mmbrdf.FitResult: " + std::to_string(fitted.result.elements[0].rows) + " samples, rms of f11 " +
         formatted("{:.3g}", fitted.result.elements[0].rms) + ", of the other elements " +
         formatted("{:.3g}", polarization_rms(fitted.result)) + ">";
}

using Elements = std::array<ElementFit, 16>;

py::tuple pickled(Fitted& fitted) {
  const FitResult& r = fitted.result;
  const auto solution = [](const Solution& s) {
    return py::make_tuple(s.x, s.singular_values, s.rank, s.residual_norm, s.rows, s.inverse, s.null_space);
  };
  return py::make_tuple(py::bytes(to_json(r.model)), tuple_of(r.solutions, solution),
                        bits<Elements>("FitResult", {&r.elements, 1}), bits<Mueller>("FitResult", r.residuals),
                        bits<NoiseEstimate>("FitResult", r.noise), bits<Basis>("FitResult", {&fitted.basis, 1}),
                        to_string(fitted.weights), r.warnings, static_cast<unsigned>(r.sides),
                        bits<Mueller>("FitResult", r.sample_weights),
                        fitted.some.empty() ? std::vector<std::string>{} : fitted.warnings());
}

FittedPointer unpickled(const py::tuple& state) {
  using Values = std::vector<double>;
  FitResult r{.model = model_from_json(state[0].cast<std::string>(), "pickle"),
              .solutions = {},
              .elements = from_bits<Elements>("FitResult", state[2]).at(0),
              .residuals = from_bits<Mueller>("FitResult", state[3]),
              .noise = from_bits<NoiseEstimate>("FitResult", state[4]),
              .warnings = state[7].cast<std::vector<std::string>>(),
              .sides = static_cast<Sides>(state[8].cast<unsigned>()),
              .weights = weights_from(state[6].cast<std::string>()),
              .sample_weights = from_bits<Mueller>("FitResult", state[9])};
  for (const py::handle one : state[1]) {
    const auto s = one.cast<py::tuple>();
    r.solutions.push_back({s[0].cast<Values>(), s[1].cast<Values>(), s[2].cast<int>(), s[3].cast<double>(),
                           s[4].cast<long>(), s[5].cast<Values>(), s[6].cast<Values>()});
  }
  const Basis basis = from_bits<Basis>("FitResult", state[5]).at(0);
  auto model = std::make_shared<ModelObject>(r.model);
  return std::make_shared<Fitted>(std::move(r), std::move(model), basis, weights_from(state[6].cast<std::string>()),
                                  state[10].cast<std::vector<std::string>>());
}

void bind_result(py::module_& m) {
  py::class_<Fitted, FittedPointer>(m, "FitResult", "What fit() found: the model, and how well it fits.")
      .def_property_readonly("model", [](const Fitted& f) { return f.model; })
      .def_property_readonly(
          "residuals", [](Fitted& f) { return matrices_of(f.result.residuals, py::cast(f.shared_from_this())); },
          "(N, 4, 4), measured - model in the xy frame: element 11 of f11 in sr^-1, the others of "
          "f_ij / f11: a view")
      .def_property_readonly("rms", rms_of,
                             "(4, 4), weighted: element 11 of f11 / reflectance, the others of f_ij / f11")
      .def_property_readonly(
          "polarization_rms", [](const Fitted& f) { return polarization_rms(f.result); },
          "Root mean square over the 15 normalised elements")
      .def_property_readonly("chi_squared_per_dof", reduced_chi_squared,
                             "Of 'f11', of 'others', the 15 other elements together, and of each block by its name: "
                             "near 1 if\nweights='data' and the uncertainties are right. 0 without degrees of freedom")
      .def_property_readonly(
          "warnings", [](Fitted& f) { return without_gil([&] { return f.warnings(); }); },
          "What there is to be wary of, a sentence each: one plane or side only, chi^2, condition, reflectances above "
          "1,\n"
          "f11 that is not positive, and what the samples show: fill values, radians, a cosine, frame and signs. "
          "Computed when\n"
          "first asked for")
      .def(
          "summary",
          [](Fitted& f) {
            std::string text = representation(f);
            if (f.result.model.posterior)
              for (const std::string& line : described_sample(*f.result.model.posterior)) text += "\n" + line;
            for (const std::string& line : without_gil([&] { return f.warnings(); })) text += "\nwarning: " + line;
            return text;
          },
          "What was found, in words: of the fit, of the sample, and what there is to heed.")
      .def_property_readonly("noise", noise_of, "With weights='estimated': the law found at each wavelength, as dicts")
      .def("__repr__", representation)
      .def(py::pickle(&pickled, &unpickled));
}

constexpr const char* fit_doc =
    "Fits a model to samples by linear least squares.\n\n"
    "basis        'isotropic', 'germer2017' or 'anisotropic'\n"
    "orders       highest radial orders, of f11 and of the other elements\n"
    "powers       highest power of the wavelength; None: 0 for one wavelength, 1 for several\n"
    "reflectance  {wavelength in nm: value} that f11 is divided by; {}: by nothing. None: for several wavelengths "
    "each\n"
    "             one's own normal-incidence reflectance, for one nothing\n"
    "uncertainty  'sample': holds for a real sample, its anisotropy and what the basis misses included; the samples\n"
    "             need not determine every coefficient. 'noise': of the noise alone, by least squares. Where 'sample' "
    "cannot\n"
    "             be had, as for other bases than 'isotropic', it is 'noise', and FitResult.warnings says why\n"
    "declared     {'scale': relative, 'source_deg': ..., 'receiver_deg': ...}: standard uncertainties of errors that "
    "all\n"
    "             samples share, with 'sample'; none by default\n"
    "weights      'none', 'speckle', 'data' (1/u^2 of the samples) or 'estimated'; None: 'speckle' with 'sample' "
    "and\n"
    "             the isotropic basis, else 'none'\n"
    "covariance   'residuals'; 'sandwich', for noise that is not as the weights say; or 'given', with weights='data':\n"
    "             the uncertainties of the samples as they are, where 'residuals' takes from them relative sizes only\n"
    "minimum_norm accept data that do not determine every coefficient (germer2017: always)\n"
    "as_printed   germer2017 at the azimuths the samples have, to compare only; the model keeps it\n"
    "instrument   Calibration that measured all samples: its uncertainty is added to the covariance, its file to the "
    "provenance\n\n"
    "Raises ValueError for data that do not determine the model: the message says what is free.";

}  // namespace

Basis basis_from(const std::string& family, std::pair<int, int> orders, const std::string& mapping, bool as_printed) {
  const Basis basis{family_from(family),
                    {orders.first, orders.second},
                    disc_mapping_from(mapping),
                    as_printed ? Rotation::as_printed : Rotation::covariant};
  require_valid(basis.family, basis.rotation);
  return basis;
}

Weights weights_or_default(const std::optional<std::string>& name, const Basis& basis, Uncertainty uncertainty) {
  if (name) return weights_from(*name);
  return uncertainty == Uncertainty::sample && basis.family == Family::isotropic ? Weights::speckle : Weights::none;
}

void bind_fit(py::module_& m) {
  bind_result(m);
  m.def(
      "fit",
      [](const Dataset& data, const std::string& family, std::pair<int, int> orders, const std::string& mapping,
         std::optional<int> powers, const std::optional<std::map<double, double>>& reflectance,
         const std::string& uncertainty, const std::map<std::string, double>& declared,
         const std::optional<std::string>& weights, const std::string& covariance, bool minimum_norm, bool as_printed,
         const InstrumentPointer& instrument, const std::string& name, const std::string& attribution) {
        Request request{
            basis_from(family, orders, mapping, as_printed), {}, Weights::none, instrument, name, attribution};
        request.options.uncertainty = uncertainty_from(uncertainty);
        request.options.declared = declared_from(declared);
        request.weights = weights_or_default(weights, request.basis, request.options.uncertainty);
        request.options.powers = powers;
        if (reflectance) request.options.reflectance = reflectance_table(*reflectance);
        request.options.minimum_norm = minimum_norm;
        request.options.covariance = covariance_from(covariance);
        return fitted(data, request);
      },
      py::arg("data"), py::arg("basis") = "isotropic", py::arg("orders") = std::pair(7, 4), py::kw_only(),
      py::arg("mapping") = "lambert", py::arg("powers") = py::none(), py::arg("reflectance") = py::none(),
      py::arg("uncertainty") = "sample", py::arg("declared") = std::map<std::string, double>{},
      py::arg("weights") = py::none(), py::arg("covariance") = "residuals", py::arg("minimum_norm") = false,
      py::arg("as_printed") = false, py::arg("instrument") = py::none(), py::arg("name") = "",
      py::arg("attribution") = "", fit_doc);
}

}  // namespace mmbrdf::python
