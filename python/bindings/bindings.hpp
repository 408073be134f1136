// SPDX-License-Identifier: BSD-3-Clause
// What the sources of the module know of each other.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf::python {

/// A model as Python holds it: it never changes, so what has been prepared of it stays right.
class ModelObject : public std::enable_shared_from_this<ModelObject> {
 public:
  explicit ModelObject(Model model);

  const Model& model() const { return model_; }

  /// Largest theta_i, to a step of the grid, up to which samples support all directions that theta_r may have.
  double theta_of_all() const { return theta_of_all_; }

  /// Micrometres: those of the argument, or the model's own for None.
  double wavelength(const std::optional<double>& wavelength_nm) const;

  /// True once: it is said once of each model that its range is not known.
  bool is_first_of_unknown_range() const { return !unknown_range_was_said_.exchange(true); }

  /// The argument wavelength_nm, or the model's own for None.
  Operand wavelength_operand(const std::optional<Given>& wavelength_nm) const;

  /// The model, or the same as printed: no copy but for the first that is asked for.
  const Model& turned(bool as_printed) const;

  /// At a wavelength in micrometres.
  PreparedModel prepared(double wavelength, bool as_printed) const;

 private:
  Model model_;
  double theta_of_all_;
  mutable std::atomic<bool> unknown_range_was_said_ = false;
  mutable std::mutex mutex_;
  mutable std::optional<Model> printed_;
  mutable std::map<bool, PreparedModel> prepared_;  // by as_printed
};

using ModelPointer = std::shared_ptr<ModelObject>;

/// nm → micrometres. Throws std::invalid_argument unless it is positive.
double micrometres(double wavelength_nm);
std::vector<double> micrometres(const std::vector<double>& wavelengths_nm);

/// {nm: reflectance}
ReflectanceTable reflectance_table(const std::map<double, double>& by_nanometres);

/// format.format(value), as Python does it.
inline std::string formatted(const char* format, double value) {
  return py::str(format).attr("format")(value).cast<std::string>();
}

/// Throws as Python's open(): FileNotFoundError and the like.
void require_readable(const std::filesystem::path& path);

/// The same for a file that is to be written: there must be a folder for it, and none in its place.
void require_place(const std::filesystem::path& path);

/// Warns with mmbrdf.<category>, as Python warnings do, at the line of the user that led here. Throws if the filters say
/// so.
void warn(const char* category, const std::string& text);

/// Warns, as Python warnings do, of questions to a model outside its fitted range; `what` they are.
void warn_outside(const ModelObject& model, const RangeCount& range, const char* what = "question");

/// The named tuple mmbrdf.<type> of these values.
template <class... Values>
py::object record(const char* type, Values&&... values) {
  return py::module_::import("mmbrdf").attr(type)(std::forward<Values>(values)...);
}

/// make(one) of each, as a tuple.
template <class Sequence, class Make>
py::tuple tuple_of(const Sequence& all, Make make) {
  py::tuple result(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) result[i] = make(all[i]);
  return result;
}

/// An array that shows memory of `owner` without a copy, and cannot be written to.
template <class T>
py::array_t<T> view(const T* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, py::handle owner) {
  py::array_t<T> array(std::move(shape), std::move(strides), data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

using ModelClass = py::class_<ModelObject, ModelPointer>;

ModelClass bind_model(py::module_& m);
void bind_evaluation(ModelClass& model);
void bind_answer(ModelClass& model);
void bind_export(ModelClass& model);
void bind_transfer(ModelClass& model);
void bind_dataset(py::module_& m);
void bind_geometries(py::module_& m);
void bind_accumulators(py::module_& m);
void bind_fit(py::module_& m);
void bind_selection(py::module_& m);
void bind_plan(py::module_& m);
void bind_comparison(py::module_& m);
void bind_diagnostics(py::module_& m);
void bind_mueller(py::module_& m);
void bind_analysis(py::module_& m);
void bind_apertures(py::module_& m);
void bind_radiometry(py::module_& m);
void bind_polarimeter(py::module_& m);
void bind_measuring(py::module_& m);
void bind_goniometer(py::module_& m);
void bind_report(py::module_& m);
void bind_sampling(py::module_& m);

}  // namespace mmbrdf::python
