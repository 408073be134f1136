// SPDX-License-Identifier: BSD-3-Clause
// Polarimeters: states, calibration, reduction, and a simulated goniometer.
#include "mmbrdf/polarimetry/polarimeter.hpp"

#include <pybind11/complex.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <stdexcept>

#include "dataset.hpp"
#include "instrument.hpp"
#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/files/instrument_file.hpp"
#include "mmbrdf/files/readings_file.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarimetry/goniometer.hpp"
#include "mmbrdf/polarimetry/judgement.hpp"
#include "mmbrdf/polarimetry/measurement.hpp"
#include "mmbrdf/polarization/elements.hpp"

namespace mmbrdf::python {

namespace {

std::vector<Stokes> states_from(const Given& states, const char* name) {
  const Broadcast broadcast({{name, states, {4}}});
  if (broadcast.shape().size() != 1) throw std::invalid_argument(std::string(name) + ": expected an array (states, 4)");
  std::vector<Stokes> result;
  for (std::size_t i = 0; i < broadcast.size(); ++i) result.push_back(broadcast.at<4>(0, i));
  return result;
}

py::array_t<double> array_of(const std::vector<Stokes>& states) {
  py::array_t<double> result({static_cast<py::ssize_t>(states.size()), py::ssize_t{4}});
  for (std::size_t i = 0; i < states.size(); ++i)
    std::copy(states[i].begin(), states[i].end(), result.mutable_data() + 4 * i);
  return result;
}

Operand readings_operand(const Polarimeter& p, const Given& readings, const char* name) {
  return {name, readings, {static_cast<py::ssize_t>(p.analyzer.size()), static_cast<py::ssize_t>(p.generator.size())}};
}

py::object reduced(const Polarimeter& p, const Given& readings) {
  const Reduction reduction(p);
  const Broadcast broadcast({readings_operand(p, readings, "readings")});
  return map(broadcast, [&](std::size_t i) {
    std::vector<double> all(p.readings());
    broadcast.gather(0, i, i + 1, all.data());
    return reduction.mueller(all);
  });
}

py::object reduced_covariance(const Polarimeter& p, const Given& variances) {
  const Reduction reduction(p);
  const Broadcast broadcast({readings_operand(p, variances, "variances")});
  auto result = new_array<double>(broadcast, {16, 16});
  for (std::size_t i = 0; i < broadcast.size(); ++i) {
    std::vector<double> all(p.readings());
    broadcast.gather(0, i, i + 1, all.data());
    const MuellerCovariance covariance = reduction.from_readings(all);
    std::copy(covariance.values.begin(), covariance.values.end(), result.mutable_data() + 256 * i);
  }
  return result;
}

py::object readings_of(const Polarimeter& p, const Given& mueller) {
  const Broadcast broadcast({{"mueller", mueller, {4, 4}}});
  auto result = new_array<double>(
      broadcast, {static_cast<py::ssize_t>(p.analyzer.size()), static_cast<py::ssize_t>(p.generator.size())});
  for (std::size_t i = 0; i < broadcast.size(); ++i) {
    const std::vector<double> all = readings(p, broadcast.mueller(0, i));
    std::copy(all.begin(), all.end(), result.mutable_data() + all.size() * i);
  }
  return result;
}

/// {"dark": 0, "shot": 0, "relative": 1e-3}; what is not named is 0.
ReadingNoise noise_from(const std::map<std::string, double>& named) {
  ReadingNoise noise;
  for (const auto& [name, value] : named) {
    double& place = name == "dark" ? noise.dark : name == "shot" ? noise.shot : noise.relative;
    if (name != "dark" && name != "shot" && name != "relative")
      throw std::invalid_argument("noise: " + name + ": expected dark, shot or relative");
    if (!(value >= 0)) throw std::invalid_argument("noise: " + name + ": must be 0 or more");
    place = value;
  }
  return noise;
}

void require_limit(double saturation) {
  if (!(saturation > 0)) throw std::invalid_argument("saturation: must be positive");
}

/// (index of the film, thickness in micrometres, complex index of the substrate)
Film film_from(const std::tuple<std::complex<double>, double, std::complex<double>>& film) {
  return {std::get<0>(film), std::get<1>(film), std::get<2>(film)};
}

using FilmTuple = std::tuple<std::complex<double>, double, std::complex<double>>;
using Noise = std::map<std::string, double>;

/// Warns, as Python warnings do, of the doubts about what is called `name`; throws std::invalid_argument if it is
/// refused.
void heed(const Verdict& verdict, const std::string& name) {
  const py::object category = py::module_::import("mmbrdf").attr("InstrumentWarning");
  for (const std::string& doubt : verdict.doubts)
    if (PyErr_WarnEx(category.ptr(), (name + ": " + doubt).c_str(), 1) != 0) throw py::error_already_set();
  if (!verdict.refusal.empty()) throw std::invalid_argument(name + ": " + verdict.refusal);
}

InstrumentPointer calibrated(const std::filesystem::path& path, const std::optional<FilmTuple>& film, int dial_sense,
                             double extinction, bool refine, bool phase, const Noise& noise, double saturation) {
  require_readable(path);
  require_limit(saturation);
  CalibrationOptions options;
  options.dial_sense = dial_sense;
  options.extinction = extinction;
  options.refine = refine;
  options.fit_polarizer_phase = phase;
  options.noise = noise_from(noise);
  if (film) options.film = film_from(*film);
  auto instrument = without_gil([&] {
    const ReferenceFile file = read_references(path, saturation);
    options.generator_states = file.states.generator;
    options.analyzer_states = file.states.analyzer;
    options.wavelength = file.wavelength;
    auto result = std::make_shared<Instrument>(calibrate(file.references, options), path.filename().string());
    result->provenance["data"] = path.filename().string();
    result->provenance["references"] = std::to_string(file.references.size());
    result->provenance["software"] = std::string("mmbrdf ") + MMBRDF_VERSION;
    return result;
  });
  heed(judged(*instrument, options.film), instrument->name);
  return instrument;
}

std::vector<Sample> reduced_file(const std::filesystem::path& path, const Calibration& instrument, double solid_angle,
                                 const ReadingNoise& noise, double saturation) {
  const Polarimeter& p = instrument.polarimeter;
  const Reduction reduction(p);
  std::ifstream in = open_input(path);
  RawReader reader(in, path.string(), {p.generator.size(), p.analyzer.size()}, saturation);
  std::vector<Sample> samples;
  for (RawMeasurement raw; reader.next(raw);) {
    if (!same_wavelength(raw.wavelength, instrument.wavelength))
      throw std::invalid_argument(reader.error("another wavelength than that of the instrument").what());
    samples.push_back(reduced(reduction, raw, solid_angle, noise));
  }
  return samples;
}

void bind_states(py::module_& m) {
  m.def(
      "condition_number", [](const Given& states) { return condition_number(states_from(states, "states")); },
      py::arg("states"), "Of states (n, 4): 3^0.5 at best, inf for fewer than four independent ones.");
  m.def(
      "optimal_angles",
      [](double retardance, int states) {
        std::vector<double> angles = optimal_angles(radians(retardance), states);
        for (double& angle : angles) angle = degrees(angle);
        return py::array_t<double>(static_cast<py::ssize_t>(angles.size()), angles.data());
      },
      py::arg("retardance_deg"), py::arg("states"),
      "Azimuths in degrees of a retarder behind a polarizer that make the condition number smallest: (states,).");
  m.def(
      "film_reflection",
      [](const FilmTuple& film, double nm, const Given& theta_i) {
        const Film layer = film_from(film);
        const Broadcast broadcast({{"theta_i_deg", theta_i}});
        return map(broadcast, [&](std::size_t i) {
          return mueller(reflection(layer, micrometres(nm), radians(broadcast.number(0, i))));
        });
      },
      py::arg("film"), py::arg("wavelength_nm"), py::arg("theta_i_deg"),
      "Specular reflection of a film (index, thickness in micrometres, index of the substrate), n + ik, in the s, p\n"
      "axes of each beam: (..., 4, 4).");
}

void bind_instrument(py::module_& m) {
  py::class_<Polarimeter>(m, "Polarimeter",
                          "What states a polarimeter makes (generator (n, 4)) and responds to (analyzer (n, 4)). A "
                          "reading is\nanalyzer @ M @ generator.")
      .def(py::init([](const Given& generator, const Given& analyzer) {
             return Polarimeter{states_from(generator, "generator"), states_from(analyzer, "analyzer")};
           }),
           py::arg("generator"), py::arg("analyzer"))
      .def_property_readonly(
          "generator", [](const Polarimeter& p) { return array_of(p.generator); }, "(n, 4)")
      .def_property_readonly(
          "analyzer", [](const Polarimeter& p) { return array_of(p.analyzer); }, "(n, 4)")
      .def("readings", readings_of, py::arg("mueller"),
           "Of matrices (..., 4, 4): array (..., analyzer states, generator states)")
      .def("reduce", reduced, py::arg("readings"),
           "Matrices (..., 4, 4) that readings (..., analyzer states, generator states) stand for, by least squares, "
           "in\n"
           "the frame scattering_plane. Readings are dark-subtracted and divided by monitor and gain.")
      .def("covariance", reduced_covariance, py::arg("variances"),
           "Of the sixteen elements, from independent readings with these variances: array (..., 16, 16)")
      .def("__repr__", [](const Polarimeter& p) {
        return "<mmbrdf.Polarimeter: " + std::to_string(p.generator.size()) + " generator states, " +
               std::to_string(p.analyzer.size()) + " analyzer states>";
      });
  m.def(
      "ideal_polarimeter",
      [](double retardance, const Given& azimuths) {
        std::vector<double> angles = numbers("azimuths_deg", azimuths);
        for (double& angle : angles) angle *= radians(1);
        return ideal_polarimeter(radians(retardance), angles);
      },
      py::arg("retardance_deg"), py::arg("azimuths_deg"),
      "A polarizer and behind it a retarder at each of these azimuths; the analyzer mirrors it.");
}

py::object covariance_view(const py::object& self) {
  const auto& c = self.cast<const Instrument&>();
  if (c.covariance.empty()) return py::none();
  const auto n = static_cast<py::ssize_t>(4 * (c.polarimeter.generator.size() + c.polarimeter.analyzer.size()));
  constexpr py::ssize_t size = sizeof(double);
  return view(c.covariance.data(), {n, n}, {n * size, size}, self);
}

using CalibrationClass = py::class_<Instrument, InstrumentPointer>;

void bind_quality(CalibrationClass& calibration) {
  calibration
      .def_property_readonly(
          "figure_of_merit", [](const Instrument& c) { return c.figure_of_merit.total; },
          "Rms of measured - expected matrices of the references, each divided by element 11")
      .def_property_readonly(
          "film_misfit_deg", [](const Instrument& c) { return degrees(c.film_misfit); },
          "Rms of the wafers' psi and delta from those of the film; 0: no film was given")
      .def_readonly("generator_condition", &Calibration::generator_condition)
      .def_readonly("analyzer_condition", &Calibration::analyzer_condition)
      .def_readonly("singular_ratio", &Calibration::singular_ratio, "s16/s15: misfit of the linear solution")
      .def_readonly("identifiability", &Calibration::identifiability,
                    "s15/s1: how far the references are from leaving a second solution")
      .def_readonly("chi_squared", &Calibration::chi_squared)
      .def_readonly("degrees_of_freedom", &Calibration::degrees_of_freedom);
}

void bind_calibration(py::module_& m) {
  CalibrationClass calibration(m, "Calibration", "A calibrated instrument at one wavelength.");
  bind_quality(calibration);
  calibration.def_property_readonly("wavelength_nm", [](const Instrument& c) { return nanometres(c.wavelength); })
      .def_property_readonly("polarimeter", [](const Instrument& c) { return c.polarimeter; })
      .def_property_readonly("covariance", covariance_view,
                             "Of the components of all generator, then all analyzer states: a view; None: not known")
      .def_readonly("scale_uncertainty", &Calibration::scale_uncertainty, "Relative")
      .def_property_readonly(
          "polarizer_offset_deg", [](const Instrument& c) { return degrees(c.polarizer_offset); },
          "Azimuth of the reference polarizer at dial 0")
      .def_readonly("extinction", &Calibration::extinction, "Of the reference polarizer")
      .def_readonly("film_thickness_um", &Calibration::film_thickness, "0: no film was given")
      .def_readonly("provenance", &Calibration::provenance)
      .def(
          "save",
          [](const Instrument& c, const std::filesystem::path& path) {
            require_place(path);
            save_instrument(path, c);
          },
          py::arg("path"), "Writes an instrument file")
      .def("__repr__",
           [](const Instrument& c) {
             return "<mmbrdf.Calibration: " + formatted("{:g}", nanometres(c.wavelength)) + " nm, figure of merit " +
                    formatted("{:.3g}", c.figure_of_merit.total) + ">";
           })
      .def(py::pickle([](const Instrument& c) { return py::make_tuple(to_json(c), c.name); },
                      [](const py::tuple& state) {
                        return std::make_shared<Instrument>(
                            calibration_from_json(state[0].cast<std::string>(), "pickle"),
                            state[1].cast<std::string>());
                      }));
}

void bind_measuring(py::module_& m) {
  m.def(
      "load_instrument",
      [](const std::filesystem::path& path) {
        require_readable(path);
        auto instrument = std::make_shared<Instrument>(load_instrument(path), path.filename().string());
        heed(judged(*instrument), instrument->name);
        return instrument;
      },
      py::arg("path"),
      "A Calibration from a file of `mmbrdf calibrate` or Calibration.save(). Warns and raises as calibrate().");
  m.def(
      "calibrate", calibrated, py::arg("references"), py::kw_only(), py::arg("film") = py::none(),
      py::arg("dial_sense") = 1, py::arg("extinction") = 0.0, py::arg("refine") = true,
      py::arg("fit_polarizer_phase") = false, py::arg("noise") = Noise{{"relative", 1e-3}},
      py::arg("saturation") = never_saturated,
      "The instrument that measured the references of a file (docs/formats.md), with its covariance.\n\n"
      "film is (index, thickness in micrometres, index of the substrate) of the wafer, n + ik; noise has the keys\n"
      "dark, shot and relative. Raises ValueError, saying what is missing, where they do not determine it, and for an\n"
      "instrument with a figure of merit above 0.5 or a condition number above 100; warns (InstrumentWarning) above\n"
      "0.05 and 10, and of a film that is more than 10 % from the given thickness.");
  m.def(
      "reduce",
      [](const std::filesystem::path& path, const Instrument& instrument, double solid_angle, const Noise& noise,
         double saturation) {
        require_readable(path);
        require_limit(saturation);
        const ReadingNoise law = noise_from(noise);
        std::vector<Sample> samples =
            without_gil([&] { return reduced_file(path, instrument, solid_angle, law, saturation); });
        heed(judged(samples), path.filename().string());
        return dataset_object(std::move(samples));
      },
      py::arg("raw"), py::arg("instrument"), py::kw_only(), py::arg("solid_angle"),
      py::arg("noise") = Noise{{"relative", 1e-3}}, py::arg("saturation") = never_saturated,
      "A Dataset from a file of readings, with uncertainties from their noise; solid_angle in sr. What the instrument\n"
      "is uncertain by is the same in all samples: fit(..., instrument=...) adds it. Warns (InstrumentWarning) of "
      "matrices\n"
      "that cannot be physical.");
}

void bind_writing(py::class_<Goniometer>& c) {
  c.def(
       "write_references",
       [](const Goniometer& g, const std::filesystem::path& path, double nm, int count, unsigned long seed) {
         const Polarimeter& p = g.polarimeter();
         const double wavelength = micrometres(nm);
         require_place(path);
         write_references(path,
                          {wavelength, {p.generator.size(), p.analyzer.size()}, g.references(wavelength, count, seed)});
       },
       py::arg("path"), py::arg("wavelength_nm"), py::arg("count") = 18, py::arg("seed") = 0,
       "Measures `count` references of each kind: the file that calibrate() reads")
      .def(
          "write_raw",
          [](const Goniometer& g, const std::filesystem::path& path, const ModelObject& model, double nm,
             const py::sequence& angles, unsigned long seed) {
            require_place(path);
            const std::vector<Geometry> geometries = geometries_from(angles);
            const Polarimeter& p = g.polarimeter();
            const double wavelength = micrometres(nm);
            const auto all = g.readings(prepare(model.model(), wavelength), geometries, seed);
            std::vector<RawMeasurement> raw;
            for (std::size_t i = 0; i < all.size(); ++i) raw.push_back({wavelength, geometries[i], all[i]});
            write_raw(path, {p.generator.size(), p.analyzer.size()}, raw);
          },
          py::arg("path"), py::arg("model"), py::arg("wavelength_nm"), py::arg("geometry"), py::arg("seed") = 0,
          "Measures a sample that has this model: the file that reduce() reads");
}

void bind_goniometer(py::module_& m) {
  py::class_<Goniometer> c(m, "Goniometer",
                           "A simulated instrument with the imperfections of a real one. Each seed is another "
                           "instrument.\nrelative_noise is that of the readings, speckle that of a sample at normal "
                           "incidence.");
  c.def(py::init([](unsigned long seed, double relative_noise, double speckle) {
          GoniometerOptions options;
          options.noise.relative = relative_noise;
          options.speckle = speckle;
          return Goniometer(options, seed);
        }),
        py::arg("seed") = 0, py::kw_only(), py::arg("relative_noise") = 1e-3, py::arg("speckle") = 0.0)
      .def_property_readonly(
          "polarimeter", [](const Goniometer& g) { return g.polarimeter(); }, "The true states")
      .def_property_readonly(
          "solid_angle", [](const Goniometer& g) { return g.options().solid_angle; }, "In sr")
      .def_property_readonly(
          "film",
          [](const Goniometer& g) {
            const Film& film = g.options().film;
            return FilmTuple{film.film_index, film.thickness, film.substrate_index};
          },
          "Of its wafer, as calibrate() takes it");
  bind_writing(c);
}

}  // namespace

void bind_polarimeter(py::module_& m) {
  bind_states(m);
  bind_instrument(m);
  bind_calibration(m);
  bind_measuring(m);
  bind_goniometer(m);
}

}  // namespace mmbrdf::python
