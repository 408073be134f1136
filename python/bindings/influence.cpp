// SPDX-License-Identifier: BSD-3-Clause
// Many fits at the same geometries; mmbrdf.images has what users see.
#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "bindings.hpp"
#include "fit.hpp"
#include "mmbrdf/fitting/leverage.hpp"

namespace mmbrdf::python {

void bind_influence(py::module_& m);

namespace {

using Floats = py::array_t<float, py::array::c_style>;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

Influence influence_from(double wavelength_nm, const Given& ti, const Given& pi, const Given& tr, const Given& pr,
                         const std::string& family, std::pair<int, int> orders, const std::string& mapping,
                         const std::optional<Numbers>& weights, bool f11_only, bool minimum_norm) {
  const std::vector<Geometry> at = geometries(Broadcast(direction_operands(ti, pi, tr, pr)));
  std::vector<Mueller> of_samples;
  if (weights) {
    if (static_cast<std::size_t>(weights->size()) != 16 * at.size())
      throw std::invalid_argument("weights: expected 16 for each of " + std::to_string(at.size()) + " geometries");
    of_samples.resize(at.size());
    for (std::size_t g = 0; g < of_samples.size(); ++g)
      std::copy_n(weights->data() + 16 * g, 16, of_samples[g].elements.begin());
  }
  FitOptions options;
  options.minimum_norm = minimum_norm;
  const Basis basis = basis_from(family, orders, mapping, false);
  return without_gil([&] { return Influence(at, micrometres(wavelength_nm), basis, of_samples, f11_only, options); });
}

template <class Array>
py::tuple fitted_sets(const Influence& influence, const Array& values, std::size_t each, int threads) {
  const std::size_t sets = static_cast<std::size_t>(values.size()) / (each * influence.geometries());
  const auto count = static_cast<py::ssize_t>(sets);
  py::array_t<double> coefficients({count, static_cast<py::ssize_t>(influence.coefficients())});
  py::array_t<double> variances({count, static_cast<py::ssize_t>(influence.model().blocks.size())});
  const std::span a(coefficients.mutable_data(), static_cast<std::size_t>(coefficients.size()));
  const std::span v(variances.mutable_data(), static_cast<std::size_t>(variances.size()));
  const std::span from(values.data(), static_cast<std::size_t>(values.size()));
  without_gil([&] { influence.fit(from, a, v, threads); });
  return py::make_tuple(coefficients, variances);
}

/// The model of one set: its coefficients, and covariances scaled by its variances; not known where these are NaN.
ModelPointer model_of_set(const Influence& influence, const std::vector<double>& coefficients,
                          const std::vector<double>& variances, const std::string& name) {
  Model model = influence.model();
  if (coefficients.size() != influence.coefficients() || variances.size() != model.blocks.size())
    throw std::invalid_argument("coefficients: not those of this fit");
  auto next = coefficients.begin();
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    FittedBlock& block = model.blocks[b];
    for (double& coefficient : block.coefficients) coefficient = *next++;
    for (double& covariance : block.covariance) covariance *= variances[b];
    if (std::isnan(variances[b])) block.covariance.clear();
  }
  model.name = name;
  return std::make_shared<ModelObject>(std::move(model));
}

}  // namespace

void bind_influence(py::module_& m) {
  py::class_<Influence>(m, "_Influence")
      .def(py::init(&influence_from), py::arg("wavelength_nm"), py::arg("theta_i_deg"), py::arg("phi_i_deg"),
           py::arg("theta_r_deg"), py::arg("phi_r_deg"), py::arg("basis"), py::arg("orders"), py::arg("mapping"),
           py::arg("weights"), py::arg("f11_only"), py::arg("minimum_norm"))
      .def_property_readonly("coefficients", &Influence::coefficients)
      .def_property_readonly("geometries", &Influence::geometries)
      .def_property_readonly("blocks",
                             [](const Influence& i) {
                               return tuple_of(i.model().blocks, [](const FittedBlock& b) {
                                 return py::make_tuple(b.block.name, b.coefficients.size());
                               });
                             })
      .def("fit_float", fitted_sets<Floats>, py::arg("values"), py::arg("each"), py::arg("threads"))
      .def("fit_double", fitted_sets<Numbers>, py::arg("values"), py::arg("each"), py::arg("threads"))
      .def("model", model_of_set, py::arg("coefficients"), py::arg("variances"), py::arg("name"));
}

}  // namespace mmbrdf::python
