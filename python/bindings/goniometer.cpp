// SPDX-License-Identifier: BSD-3-Clause
// A simulated goniometer.
#include "mmbrdf/polarimetry/goniometer.hpp"

#include <pybind11/complex.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "dataset.hpp"
#include "instrument.hpp"
#include "mmbrdf/files/readings_file.hpp"
#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf::python {

namespace {

/// A simulated instrument as Python holds it, and what it was made of.
struct GoniometerObject : Goniometer {
  GoniometerObject(const GoniometerOptions& options, unsigned long seed, py::tuple its_arguments)
      : Goniometer(options, seed), arguments(std::move(its_arguments)) {}
  py::tuple arguments;
};

GoniometerObject goniometer(unsigned long seed, double relative_noise, double speckle, const Given& dials,
                            double retardance) {
  GoniometerOptions options;
  py::object kept = py::none();
  if (!dials.is_none()) {
    options.dials = dials_from(dials);
    options.retardance = radians(retardance);
    options.imperfections.azimuth = radians(2);
    kept = py::module_::import("numpy").attr("array")(dials, py::arg("dtype") = "float64");
  }
  options.noise.relative = relative_noise;
  options.speckle = speckle;
  return {options, seed, py::make_tuple(seed, relative_noise, speckle, kept, retardance)};
}

void bind_writing(py::class_<GoniometerObject>& c) {
  c.def(
       "write_references",
       [](const GoniometerObject& g, const std::filesystem::path& path, double nm, int count, unsigned long seed) {
         const double wavelength = micrometres(nm);
         require_place(path);
         write_references(path, {wavelength, read_states(g.polarimeter()), g.references(wavelength, count, seed)});
       },
       py::arg("path"), py::arg("wavelength_nm"), py::arg("count") = 18, py::arg("seed") = 0,
       "Measures `count` references of each kind: the file that calibrate() reads")
      .def(
          "write_raw",
          [](const GoniometerObject& g, const std::filesystem::path& path, const ModelObject& model, double nm,
             const py::sequence& angles, unsigned long seed) {
            require_place(path);
            const std::vector<Geometry> geometries = geometries_from(angles);
            const double wavelength = micrometres(nm);
            const auto all = g.readings(prepare(model.model(), wavelength), geometries, seed);
            std::vector<RawMeasurement> raw;
            for (std::size_t i = 0; i < all.size(); ++i) raw.push_back({wavelength, geometries[i], all[i]});
            write_raw(path, read_states(g.polarimeter()), raw);
          },
          py::arg("path"), py::arg("model"), py::arg("wavelength_nm"), py::arg("geometry"), py::arg("seed") = 0,
          "Measures a sample that has this model: the file that reduce() reads");
}

}  // namespace

void bind_goniometer(py::module_& m) {
  py::class_<GoniometerObject> c(
      m, "Goniometer",
      "A simulated instrument with the imperfections of a real one. Each seed is another "
      "instrument.\nrelative_noise is that of the readings, speckle that of a sample at normal "
      "incidence. With dials_deg\n(frames, 2) it is one of two turning retarders.");
  c.def(py::init(&goniometer), py::arg("seed") = 0, py::kw_only(), py::arg("relative_noise") = 1e-3,
        py::arg("speckle") = 0.0, py::arg("dials_deg") = py::none(), py::arg("retardance_deg") = 90.0)
      .def_property_readonly(
          "polarimeter", [](const GoniometerObject& g) { return g.polarimeter(); }, "The true states")
      .def_property_readonly(
          "solid_angle", [](const GoniometerObject& g) { return g.options().solid_angle; }, "In sr")
      .def_property_readonly(
          "film",
          [](const GoniometerObject& g) {
            const Film& film = g.options().film;
            return FilmTuple{film.film_index, film.thickness, film.substrate_index};
          },
          "Of its wafer, as calibrate() takes it")
      .def(py::pickle([](const GoniometerObject& g) { return g.arguments; },
                      [](const py::tuple& s) {
                        return goniometer(s[0].cast<unsigned long>(), s[1].cast<double>(), s[2].cast<double>(), s[3],
                                          s[4].cast<double>());
                      }));
  bind_writing(c);
}

}  // namespace mmbrdf::python
