// SPDX-License-Identifier: BSD-3-Clause
// The compiled part of the Python package. Arguments are in degrees and nanometres; the library has radians and
// micrometres.
#include "bindings.hpp"

namespace mmbrdf::python {
void bind_images(py::module_& m);
void bind_influence(py::module_& m);
}  // namespace mmbrdf::python

namespace {

namespace py = pybind11;

/// std::invalid_argument is a ValueError already. What the library throws of files becomes an OSError.
void translate(std::exception_ptr error) {
  try {
    if (error) std::rethrow_exception(error);
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const std::runtime_error& e) {
    PyErr_SetString(PyExc_OSError, e.what());
  }
}

}  // namespace

PYBIND11_MODULE(_mmbrdf, m) {
  using namespace mmbrdf::python;
  m.doc() = "Mueller-matrix BRDFs: the compiled part of mmbrdf. Use it as mmbrdf.";
  m.attr("__version__") = MMBRDF_VERSION;
  py::options options;
  options.disable_enum_members_docstring();
  py::register_exception_translator(translate);
  ModelClass model = bind_model(m);
  bind_dataset(m);
  bind_geometries(m);
  bind_evaluation(model);
  bind_answer(model);
  bind_export(model);
  bind_transfer(model);
  bind_mueller(m);
  bind_analysis(m);
  bind_apertures(m);
  bind_radiometry(m);
  bind_polarimeter(m);
  bind_measuring(m);
  bind_goniometer(m);
  bind_fit(m);
  bind_accumulators(m);
  bind_selection(m);
  bind_plan(m);
  bind_comparison(m);
  bind_diagnostics(m);
  bind_report(m);
  bind_sampling(m);
  bind_images(m);
  bind_influence(m);
  m.def(
      "_limit_threads", limit_threads, py::arg("most"),
      "How many threads functions called by this thread take that are not told; 0: one for each core. Returns what it "
      "was.");
}
