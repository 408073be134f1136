// SPDX-License-Identifier: BSD-3-Clause
// What matrices say, over arrays of them.
#include "mmbrdf/polarization/analysis.hpp"

#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include <cctype>

#include "bindings.hpp"
#include "matrices.hpp"
#include "mmbrdf/polarization/decompositions.hpp"
#include "mmbrdf/polarization/gradients.hpp"
#include "mmbrdf/quantities/quantities.hpp"

namespace mmbrdf::python {

namespace {

/// A function of an array (..., 4, 4).
template <class F>
void define_over(py::module_& m, const char* name, F over, const std::string& doc) {
  m.def(
      name, [over](const Given& mueller, const std::string& invalid) { return over(mueller, refused_from(invalid)); },
      py::arg("mueller"), py::kw_only(), py::arg("invalid") = "raise", (doc + invalid_doc).c_str());
}

/// A quantity of a matrix as such a function.
template <class Result>
void define(py::module_& m, const char* name, Result (*quantity)(const Mueller&), const char* doc) {
  define_over(
      m, name, [quantity](const Given& mueller, Refused refused) { return over_matrices(mueller, refused, quantity); },
      doc);
}

/// The same where there is a function for many.
template <class Result>
void define(py::module_& m, const char* name, Result (*one)(const Mueller&), Many<Result> many,
            const std::vector<py::ssize_t>& core, const char* doc) {
  define_over(
      m, name,
      [=](const Given& mueller, Refused refused) { return over_matrices<Result>(mueller, refused, one, many, core); },
      doc);
}

/// (..., 16 n) → n arrays (..., 4, 4).
py::tuple split_matrices(const py::object& values, py::ssize_t n) {
  const py::array array = values.cast<py::array>();
  std::vector<py::ssize_t> shape(array.shape(), array.shape() + array.ndim() - 1);
  shape.insert(shape.end(), {n, 4, 4});
  const py::object parts = array.attr("reshape")(py::cast(shape));
  py::tuple result(static_cast<std::size_t>(n));
  for (py::ssize_t i = 0; i < n; ++i)
    result[static_cast<std::size_t>(i)] =
        parts[py::make_tuple(py::ellipsis(), i, py::slice(std::nullopt, std::nullopt, std::nullopt),
                             py::slice(std::nullopt, std::nullopt, std::nullopt))];
  return result;
}

py::object named(const char* name, const py::tuple& values) {
  return py::module_::import("mmbrdf").attr(name)(*values);
}

/// A decomposition into matrices alone, which come as the named tuple of that name.
template <class Factors>
void define_factors(py::module_& m, const char* name, const char* tuple, Factors (*one)(const Mueller&),
                    Many<Factors> many, const char* doc) {
  constexpr py::ssize_t numbers = sizeof(Factors) / sizeof(double);
  define_over(
      m, name,
      [=](const Given& mueller, Refused refused) {
        return named(tuple,
                     split_matrices(over_matrices<Factors>(mueller, refused, one, many, {numbers}), numbers / 16));
      },
      doc);
}

py::object standard_uncertainties(const Given& gradient, const Given& covariance) {
  const Broadcast broadcast({{"gradient", gradient, {4, 4}}, {"covariance", covariance, {16, 16}}});
  const Broadcast covariances({{"covariance", covariance, {16, 16}}});
  for (std::size_t i = 0; i < covariances.size(); ++i) {
    MuellerCovariance of_elements;
    covariances.gather(0, i, i + 1, of_elements.values.data());
    try {
      require_valid(of_elements);
    } catch (const std::invalid_argument& error) {
      throw covariances.at_place(error, i);
    }
  }
  return map(broadcast, [&](std::size_t i) {
    MuellerCovariance of_elements;
    broadcast.gather(1, i, i + 1, of_elements.values.data());
    return standard_uncertainty(broadcast.mueller(0, i), of_elements);
  });
}

/// "Length of (M12, M13, M14) / M11."
std::string documentation(const Quantity& q) {
  std::string text = std::string(q.meaning) + ".";
  text.front() = static_cast<char>(std::toupper(text.front()));
  if (!q.unit.empty()) text += "\nOf matrices in the frame sp";
  if (q.unit == "sr^-1") text += ", in their units";
  if (!q.unit.empty()) text += ".";
  return q.takes_light ? text + "\nstokes (..., 4) is the incident light, in the frame of the matrices." : text;
}

/// A function of an array (..., 4, 4), and of one (..., 4) if it takes light; with one for many matrices, where there is.
template <class Result>
void define(py::module_& m, const std::string& name, Result (*function)(const Mueller&, const Stokes&),
            bool takes_light, const std::string& doc, Many<double> many = nullptr) {
  if (!takes_light) {
    const auto one = [=](const Mueller& matrix) { return function(matrix, {}); };
    define_over(
        m, name.c_str(),
        [=](const Given& mueller, Refused refused) {
          if constexpr (std::is_same_v<Result, double>)
            if (many) return over_matrices<double>(mueller, refused, one, many, {});
          return over_matrices(mueller, refused, one);
        },
        doc);
    return;
  }
  m.def(
      name.c_str(),
      [=](const Given& mueller, const Given& stokes, const std::string& invalid) {
        const Broadcast broadcast({{"mueller", mueller, {4, 4}}, {"stokes", stokes, {4}}});
        return map(broadcast, refused_from(invalid),
                   [&](std::size_t i) { return function(broadcast.mueller(0, i), broadcast.at<4>(1, i)); });
      },
      py::arg("mueller"), py::arg("stokes"), py::kw_only(), py::arg("invalid") = "raise", (doc + invalid_doc).c_str());
}

void bind_quantities(py::module_& m) {
  for (const Quantity& q : quantities()) {
    const std::string name(q.name), slopes = "Derivatives of " + name + " with respect to M_ij: array (..., 4, 4).";
    define(m, name, q.value, q.takes_light, documentation(q), q.values);
    define(m, name + "_gradient", q.gradient, q.takes_light, slopes);
  }
  for (const std::string suffix : {"", "_gradient"})  // as C++ has it
    m.attr(("realizability_margin" + suffix).c_str()) = m.attr(("eigenvalue_min" + suffix).c_str());
  m.def(
      "quantities",
      [] {
        return tuple_of(quantities(),
                        [](const Quantity& q) { return record("Quantity", q.name, q.unit, q.meaning, q.takes_light); });
      },
      "The Quantity of each number that is derived from a matrix: what Model.analyze() gives, and the program.");
}

void bind_properties(py::module_& m) {
  define(m, "diattenuation_vector", diattenuation_vector, "(M12, M13, M14) / M11: array (..., 3).");
  define(m, "polarizance_vector", polarizance_vector, "(M21, M31, M41) / M11: array (..., 3).");
  define<std::array<double, 4>>(m, "coherency_eigenvalues", coherency_eigenvalues, coherency_eigenvalues, {4},
                                "Of Cloude's coherency matrix, rising, in units of M: array (..., 4).");
  define(m, "coherency", coherency, "Cloude's coherency matrix, row-major: complex array (..., 16), in units of M.");
  define<bool>(m, "realizable", realizable, realizable, {}, "Whether a medium can have this matrix: array of bool.");
  define_over(
      m, "retardance",
      [](const Given& mueller, Refused refused) {
        return over_matrices(mueller, refused, [](const Mueller& retarder) { return degrees(retardance(retarder)); });
      },
      "Angle in degrees, 0 to 180, by which a retarder turns the Poincare sphere.");
  define(m, "depolarization_power", depolarization_power, "1 - |tr m| / 3 of a depolarizer (Lu & Chipman).");
}

void bind_gradients(py::module_& m) {
  define(m, "smallest_eigenvalue_gradient", smallest_eigenvalue_gradient,
         "Derivatives with respect to M_ij: array (..., 4, 4).");
  m.def(
      "co_and_cross_polarized_gradients",
      [] {
        const PolarizedBrdfGradients g = co_and_cross_polarized_gradients();
        return record("PolarizedBrdf", array_of(g.ss), array_of(g.sp), array_of(g.ps), array_of(g.pp));
      },
      "PolarizedBrdf of the derivatives of f_ss, f_sp, f_ps, f_pp with respect to M_ij in the sp frame: (4, 4) each.");
  m.def(
      "standard_uncertainty", standard_uncertainties, py::arg("gradient"), py::arg("covariance"),
      "sqrt(g V g) of a quantity with this gradient (..., 4, 4), from the covariance (..., 16, 16) of the elements in\n"
      "the same frame, as Model.covariance() gives it. Raises ValueError for one that is not finite, symmetric and\n"
      "positive semidefinite.");
}

std::size_t nearest_matrices(std::span<const Mueller> matrices, std::span<Mueller> out,
                             const MatricesOptions& options) {
  std::vector<Projection> projections(matrices.size());
  const std::size_t refused = nearest_realizable(matrices, projections, options);
  std::ranges::transform(projections, out.begin(), &Projection::matrix);
  return refused;
}

void bind_sums(py::module_& m) {
  m.def(
      "co_and_cross_polarized",
      [=](const Given& f) {
        return record("PolarizedBrdf", m.attr("f_ss")(f), m.attr("f_sp")(f), m.attr("f_ps")(f), m.attr("f_pp")(f));
      },
      py::arg("mueller_sp"),
      "PolarizedBrdf(ss, sp, ps, pp) of matrices in the sp frame, in their units; the first letter is the incident\n"
      "polarization.");
  define_over(
      m, "cloude_decomposition",
      [](const Given& mueller, Refused refused) {
        const py::object all = over_matrices<CloudeDecomposition>(
            mueller, refused, [](const Mueller& f) { return cloude_decomposition(f); }, cloude_decomposition, {68});
        const py::slice weights(0, 4, 1), components(4, 68, 1);
        const py::array matrices = all[py::make_tuple(py::ellipsis(), components)].cast<py::array>();
        std::vector<py::ssize_t> shape(matrices.shape(), matrices.shape() + matrices.ndim() - 1);
        shape.insert(shape.end(), {4, 4, 4});
        return named("CloudeDecomposition", py::make_tuple(all[py::make_tuple(py::ellipsis(), weights)],
                                                           matrices.attr("reshape")(py::cast(shape))));
      },
      "CloudeDecomposition(weights (..., 4), components (..., 4, 4, 4)): M = sum of weight x component, falling.");
  define<Mueller>(
      m, "nearest_realizable", [](const Mueller& f) { return nearest_realizable(f).matrix; }, nearest_matrices, {4, 4},
      "The realizable matrices closest in the sum of squares, with the same M11.");
}

void bind_factors(py::module_& m) {
  define_factors<LuChipman>(m, "lu_chipman", "LuChipman", lu_chipman, lu_chipman,
                            "LuChipman(depolarizer, retarder, diattenuator): M is their product. Each (..., 4, 4).");
  define_factors<SymmetricDecomposition>(
      m, "symmetric_decomposition", "SymmetricDecomposition", symmetric_decomposition, symmetric_decomposition,
      "SymmetricDecomposition(diattenuator2, retarder2, depolarizer, retarder1, diattenuator1): M is the product\n"
      "diattenuator2 retarder2 depolarizer retarder1^T diattenuator1. Each (..., 4, 4).");
}

}  // namespace

void bind_analysis(py::module_& m) {
  bind_quantities(m);
  bind_properties(m);
  bind_gradients(m);
  bind_sums(m);
  bind_factors(m);
}

}  // namespace mmbrdf::python
