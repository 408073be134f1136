// SPDX-License-Identifier: BSD-3-Clause
// Models: what they are, where they come from, where they go.
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/prepared.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cerrno>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "arrays.hpp"
#include "bindings.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/formats/projection.hpp"
#include "mmbrdf/text/rounding.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf::python {

namespace {

/// A block of a model, and the model that it belongs to.
struct BlockView {
  ModelPointer owner;
  std::size_t index;
  const FittedBlock& fitted() const { return owner->model().blocks[index]; }
};

std::vector<BlockView> blocks_of(ModelObject& model) {
  std::vector<BlockView> result;
  for (std::size_t b = 0; b < model.model().blocks.size(); ++b) result.push_back({model.shared_from_this(), b});
  return result;
}

py::list modes_of(const BlockView& block) {
  py::list result;
  for (const Mode& mode : block.fitted().block.modes)
    result.append(py::make_tuple(to_string(mode.function), mode.n, mode.m, mode.k, mode.l));
  return result;
}

py::array coefficients_of(const BlockView& block) {
  const auto modes = static_cast<py::ssize_t>(block.fitted().block.modes.size());
  const auto powers = static_cast<py::ssize_t>(block.owner->model().powers) + 1;
  constexpr py::ssize_t size = sizeof(double);
  return view(block.fitted().coefficients.data(), {powers, modes}, {modes * size, size}, py::cast(block.owner));
}

py::object covariance_of(const BlockView& block) {
  if (block.fitted().covariance.empty()) return py::none();
  const auto n = static_cast<py::ssize_t>(block.fitted().coefficients.size());
  constexpr py::ssize_t size = sizeof(double);
  return view(block.fitted().covariance.data(), {n, n}, {n * size, size}, py::cast(block.owner));
}

std::vector<std::string> elements_of(const BlockView& block) {
  std::vector<std::string> result;
  for (const Element& element : block.fitted().block.elements) result.push_back(element_name(element.index()));
  return result;
}

std::vector<double> in_nanometres(const std::vector<double>& wavelengths) {
  std::vector<double> result;
  for (const double wavelength : wavelengths) result.push_back(nanometres(wavelength));
  return result;
}

py::tuple wavelengths_nm(const ModelObject& object) {
  return py::tuple(py::cast(in_nanometres(object.model().validity.wavelengths)));
}

std::map<double, double> reflectance_of(const ModelObject& object) {
  const ReflectanceTable& table = object.model().reflectance;
  std::map<double, double> result;
  for (std::size_t i = 0; i < table.values.size(); ++i) result[nanometres(table.wavelengths[i])] = table.values[i];
  return result;
}

std::optional<double> in_degrees(const std::optional<double>& angle) {
  return angle ? std::optional(degrees(*angle)) : std::nullopt;
}

std::string representation(const ModelObject& object) {
  const Model& model = object.model();
  const Orders order = orders(model);
  std::string shown = "<mmbrdf.Model '" + model.name + "': " + to_string(model.family) +
                      (model.rotation == Rotation::as_printed ? " as printed" : "") + ", orders (" +
                      std::to_string(order.f11) + ", " + std::to_string(order.other) + "), " +
                      std::to_string(coefficient_count(model)) + " coefficients";
  const std::vector<double>& at = model.validity.wavelengths;
  if (!at.empty()) shown += ", " + shortest(nanometres(at.front()));
  if (at.size() > 1) shown += " to " + shortest(nanometres(at.back()));
  return shown + (at.empty() ? ">" : " nm>");
}

ModelPointer pointer(Model model) { return std::make_shared<ModelObject>(std::move(model)); }

ModelPointer model_at(const std::filesystem::path& path) {
  require_readable(path);
  return without_gil([&] { return pointer(load_model(path)); });
}

void bind_block(py::module_& m) {
  py::class_<BlockView>(m, "Block", "Modes that were fitted together, with their coefficients. Belongs to a Model.")
      .def_property_readonly(
          "name", [](const BlockView& b) { return b.fitted().block.name; }, "The elements fed: '11', '12,21', …")
      .def_property_readonly("elements", elements_of, "The elements fed, as a list: ['12', '21']")
      .def_property_readonly("modes", modes_of, "List of (function, n, m, k, l)")
      .def_property_readonly("coefficients", coefficients_of,
                             "Array (powers + 1, modes), a view: row p multiplies the wavelength in micrometres to p")
      .def_property_readonly("covariance", covariance_of,
                             "Of the coefficients, flattened in C order: array (n, n), a view; None: not known")
      .def_property_readonly(
          "rank", [](const BlockView& b) { return b.fitted().rank; }, "Of the fit; 0: not known")
      .def_property_readonly(
          "condition", [](const BlockView& b) { return b.fitted().condition; },
          "Condition number of the fit; 0: not known")
      .def("__repr__",
           [](const BlockView& b) {
             return "<mmbrdf.Block '" + b.fitted().block.name + "': " + std::to_string(b.fitted().coefficients.size()) +
                    " coefficients>";
           })
      .def(py::pickle([](const BlockView& b) { return py::make_tuple(b.owner, b.index); },
                      [](const py::tuple& state) {
                        BlockView block{state[0].cast<ModelPointer>(), state[1].cast<std::size_t>()};
                        static_cast<void>(block.owner->model().blocks.at(block.index));
                        return block;
                      }));
}

void bind_properties(ModelClass& c) {
  c.def_property_readonly("name", [](const ModelObject& o) { return o.model().name; })
      .def(
          "renamed",
          [](const ModelObject& o, const std::string& name) {
            Model model = o.model();
            model.name = name;
            return pointer(std::move(model));
          },
          py::arg("name"), "The same model under another name, which pictures and reports have.")
      .def_property_readonly(
          "family", [](const ModelObject& o) { return to_string(o.model().family); },
          "'isotropic', 'germer2017' or 'anisotropic'")
      .def_property_readonly(
          "mapping", [](const ModelObject& o) { return to_string(o.model().mapping); },
          "'lambert' (Eq. 6) or 'projected' (Eq. 7)")
      .def_property_readonly(
          "as_printed", [](const ModelObject& o) { return o.model().rotation == Rotation::as_printed; },
          "Whether it was fitted, and is evaluated, at the azimuths as they are: fit(..., as_printed=True)")
      .def_property_readonly(
          "powers", [](const ModelObject& o) { return o.model().powers; }, "Highest power of the wavelength")
      .def_property_readonly(
          "orders",
          [](const ModelObject& o) {
            const Orders order = orders(o.model());
            return py::make_tuple(order.f11, order.other);
          },
          "Highest radial orders, of f11 and of the other elements")
      .def_property_readonly("coefficient_count", [](const ModelObject& o) { return coefficient_count(o.model()); })
      .def_property_readonly(
          "degrees_of_freedom", [](const ModelObject& o) { return degrees_of_freedom(o.model()); },
          "Of the fit: rows less rank; inf: not known")
      .def_property_readonly("blocks", blocks_of, "List of Block")
      .def_property_readonly(
          "not_measured",
          [](const ModelObject& o) {
            std::vector<std::string> result;
            for (std::size_t e = 0; e < 16; ++e)
              if (o.model().not_measured[e]) result.push_back(element_name(e));
            return result;
          },
          "Elements of which no sample told, as a list: ['14', '24']. They are nan in every matrix of the model")
      .def_property_readonly("wavelengths_nm", wavelengths_nm, "Those it was fitted to; empty: not known")
      .def_property_readonly(
          "theta_i_max_deg", [](const ModelObject& o) { return in_degrees(o.model().validity.theta_i_max); },
          "Largest fitted polar angle of the source; None: not known")
      .def_property_readonly(
          "theta_r_max_deg", [](const ModelObject& o) { return in_degrees(o.model().validity.theta_r_max); },
          "Largest fitted polar angle of the detector; None: not known")
      .def_property_readonly("reflectance", reflectance_of,
                             "Table that multiplies f11: {wavelength in nm: value}; empty: 1")
      .def_property_readonly(
          "has_covariance", [](const ModelObject& o) { return knows_uncertainty(o.model()); },
          "Whether uncertainties of all elements are known")
      .def_property_readonly(
          "provenance", [](const ModelObject& o) { return o.model().provenance; },
          "From what, with what and how it was made: dict of text");
}

void bind_functions(py::module_& m) {
  m.def("materials", &materials, "Names of the built-in models.");
  m.def(
      "material", [](const std::string& name) { return pointer(material(name)); }, py::arg("name"),
      "A built-in model: material('ptfe'). Raises ValueError, with the names there are, for another name.");
  m.def(
      "load_model", model_at, py::arg("path"),
      "A model from a JSON file or a published coefficient file. Raises OSError for a file that cannot be read, with\n"
      "line and field for one that holds something else.");
  m.def(
      "in_published_form", [](const ModelObject& o) { return pointer(in_published_form(o.model())); }, py::arg("model"),
      "An isotropic model in the modes of germer2017: exact, without the covariance. Raises ValueError for an\n"
      "anisotropic one.");
  m.def(
      "projected_on_isotropic",
      [](const ModelObject& o, std::pair<int, int> order) {
        return without_gil([&] { return pointer(projected_on_isotropic(o.model(), {order.first, order.second})); });
      },
      py::arg("model"), py::arg("orders") = std::pair(7, 4),
      "The isotropic model nearest to another one, over its range of angles; without covariance.");
}

}  // namespace

ModelObject::ModelObject(Model model) : model_(std::move(model)), theta_of_all_(radians(90)) {
  const Validity& validity = model_.validity;
  for (const SupportedPairs& one : validity.supported)
    while (theta_of_all_ > 0 && !one.pairs.reach(theta_of_all_, validity.theta_r_max.value_or(radians(90))))
      theta_of_all_ -= radians(5);
}

double ModelObject::wavelength(const std::optional<double>& wavelength_nm) const {
  return wavelength_nm ? micrometres(*wavelength_nm) : only_wavelength(model_);
}

const Model& ModelObject::turned(bool as_printed) const {
  if (!as_printed) return model_;
  const std::lock_guard lock(mutex_);
  if (!printed_) printed_ = mmbrdf::as_printed(model_);
  return *printed_;
}

PreparedModel ModelObject::prepared(double wavelength, bool as_printed) const {
  const Model& model = turned(as_printed);
  const std::lock_guard lock(mutex_);
  auto known = prepared_.find(as_printed);
  if (known == prepared_.end()) known = prepared_.emplace(as_printed, prepare(model, wavelength)).first;
  return known->second.wavelength() == wavelength ? known->second : known->second.at(wavelength);
}

double micrometres(double wavelength_nm) {
  if (!(wavelength_nm > 0) || !std::isfinite(wavelength_nm))
    throw std::invalid_argument("wavelength_nm = " + shortest(wavelength_nm) + ", must be positive and finite");
  return wavelength_nm / 1000;
}

std::vector<double> micrometres(const std::vector<double>& wavelengths_nm) {
  std::vector<double> result;
  for (const double wavelength_nm : wavelengths_nm) result.push_back(micrometres(wavelength_nm));
  return result;
}

ReflectanceTable reflectance_table(const std::map<double, double>& by_nanometres) {
  ReflectanceTable table;
  for (const auto& [wavelength_nm, value] : by_nanometres) {
    table.wavelengths.push_back(micrometres(wavelength_nm));
    table.values.push_back(value);
  }
  return table;
}

Operand ModelObject::wavelength_operand(const std::optional<Given>& wavelength_nm) const {
  return {"wavelength_nm", wavelength_nm ? *wavelength_nm : py::float_(1000 * only_wavelength(model_))};
}

void require_readable(const std::filesystem::path& path) {
  py::module_::import("builtins").attr("open")(path, "rb").attr("close")();
}

void require_place(const std::filesystem::path& path) {
  const auto refuse = [&](PyObject* type, int number) {
    errno = number;
    PyErr_SetFromErrnoWithFilename(type, path.c_str());
    throw py::error_already_set();
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) refuse(PyExc_IsADirectoryError, EISDIR);
  if (!std::filesystem::is_directory(path.has_parent_path() ? path.parent_path() : ".", ignored))
    refuse(PyExc_FileNotFoundError, ENOENT);
}

void warn(const char* category, const std::string& text) {
  py::module_::import("mmbrdf._warnings").attr("warn")(text, category);
}

void warn_outside(const ModelObject& model, const RangeCount& range, const char* what) {
  constexpr const char* category = "ExtrapolationWarning";
  const std::string unknown = unknown_range_line(model.model().name, model.model().validity);
  if (!unknown.empty() && model.is_first_of_unknown_range()) warn(category, unknown);
  if (range.outside == 0) return;
  const std::string text = model.model().name + ": " + range.line(what) + " (" + to_string(range.reasons) +
                           "): fitted are " + fitted_range(model.model().validity);
  warn(category, text);
}

ModelClass bind_model(py::module_& m) {
  bind_block(m);
  ModelClass c(m, "Model",
               "A Mueller-matrix BRDF: f11 in sr^-1 and the other elements divided by it, as sums over modes.\n\n"
               "From material(), load() or fit(). It does not change; it can be pickled and compared.");
  bind_properties(c);
  c.def(
       "save",
       [](const ModelObject& o, const std::filesystem::path& path) {
         require_place(path);
         save_model(path, o.model());
       },
       py::arg("path"),
       "Writes JSON, or the published coefficient layout if the path ends in .csv, which has no place for\n"
       "covariance, range, provenance and as_printed. Raises OSError if it cannot be written; nothing is half-written.")
      .def(
          "to_json", [](const ModelObject& o) { return to_json(o.model()); }, "The text of a model file")
      .def_static(
          "from_json", [](const std::string& text) { return pointer(model_from_json(text, "text")); }, py::arg("text"),
          "The model of such a text. Raises OSError, naming the field, for another one.")
      .def("__repr__", representation)
      .def("__eq__",
           [](const ModelObject& a, const py::object& b) {
             return py::isinstance<ModelObject>(b) && to_json(a.model()) == to_json(b.cast<ModelPointer>()->model());
           })
      .def(py::pickle([](const ModelObject& o) { return py::bytes(to_json(o.model())); },
                      [](const py::bytes& text) { return pointer(model_from_json(std::string(text), "pickle")); }));
  c.attr("__hash__") = py::none();
  bind_functions(m);
  return c;
}

}  // namespace mmbrdf::python
