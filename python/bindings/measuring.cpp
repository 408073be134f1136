// SPDX-License-Identifier: BSD-3-Clause
// Calibrations, and what is made of readings.
#include "mmbrdf/polarimetry/calibration.hpp"

#include <pybind11/complex.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <variant>

#include "dataset.hpp"
#include "instrument.hpp"
#include "mmbrdf/files/instrument_file.hpp"
#include "mmbrdf/files/readings_file.hpp"
#include "mmbrdf/polarimetry/judgement.hpp"
#include "mmbrdf/polarimetry/measurement.hpp"
#include "mmbrdf/polarization/elements.hpp"
#include "pickles.hpp"
#include "reading_source.hpp"

namespace mmbrdf::python {

namespace {

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

Film film_from(const FilmTuple& film) { return {std::get<0>(film), std::get<1>(film), std::get<2>(film)}; }

using Noise = std::map<std::string, double>;

/// Warns, as Python warnings do, of the doubts about what is called `name`; throws std::invalid_argument if it is
/// refused.
void heed(const Verdict& verdict, const std::string& name) {
  for (const std::string& doubt : verdict.doubts) warn("InstrumentWarning", name + ": " + doubt);
  if (!verdict.refusal.empty()) throw std::invalid_argument(name + ": " + verdict.refusal);
}

/// Frames of turning retarders: state 1 with 1, 2 with 2, and so on, as many as dials.
void require_frames(const ReadStates& states, std::size_t dials, const std::string& name) {
  bool pairwise = states.pairs.size() == dials || (dials == 1 && states.pairs.empty());
  for (std::size_t j = 0; j < states.pairs.size(); ++j) pairwise = pairwise && states.pairs[j] == StatePair{j, j};
  if (!pairwise)
    throw std::invalid_argument(name +
                                ": must have one reading of generator state j with analyzer state j for each of " +
                                std::to_string(dials) + " rows of dials_deg");
}

InstrumentPointer calibrated(const Given& references, const ColumnNames& columns, const std::optional<FilmTuple>& film,
                             int dial_sense, double extinction, bool refine, bool phase, const Noise& noise,
                             double saturation, const Given& dials, double retardance,
                             const std::optional<double>& polarizer_near) {
  const ReadingSource source(references, columns, "references");
  require_limit(saturation);
  CalibrationOptions options;
  options.dial_sense = dial_sense;
  options.extinction = extinction;
  options.refine = refine;
  options.fit_polarizer_phase = phase;
  options.noise = noise_from(noise);
  if (film) options.film = film_from(*film);
  if (polarizer_near) options.polarizer_near = radians(*polarizer_near);
  if (!dials.is_none()) {
    if (!refine || polarizer_near)
      throw std::invalid_argument(
          "dials_deg: refine=False and polarizer_near_deg are of instruments whose states stand still");
    options.retarders.emplace();
    options.retarders->dials = dials_from(dials);
    RotatingRetarders& nominal = options.retarders->nominal;
    nominal.generator.retardance = nominal.analyzer.retardance = radians(retardance);
  }
  auto instrument = without_gil([&] {
    const ReferenceFile file = source.read([&](std::istream& in, const std::string& where) {
      return read_references(in, where, {saturation, options.noise.dark});
    });
    const std::string& name = source.name();
    if (options.retarders)
      require_frames(file.states, options.retarders->dials.size(), name);
    else if (!file.states.pairs.empty())
      throw std::invalid_argument(name + ": pairs of states, not all: turning retarders need dials_deg");
    options.generator_states = file.states.generator;
    options.analyzer_states = file.states.analyzer;
    options.wavelength = file.wavelength;
    auto result = std::make_shared<Instrument>(calibrate(file.references, options), name);
    result->provenance["data"] = name;
    result->provenance["references"] = std::to_string(file.references.size());
    result->provenance["software"] = std::string("mmbrdf ") + MMBRDF_VERSION;
    return result;
  });
  heed(judged(*instrument, options.film, options.retarders), instrument->name);
  return instrument;
}

/// Wavelength 0: any.
std::vector<Sample> reduced_rows(std::istream& in, const std::string& name, const Polarimeter& polarimeter,
                                 double wavelength, double solid_angle, const ReadingNoise& noise, double saturation) {
  Reducer reducer(polarimeter);
  RawReader reader(in, name, read_states(polarimeter), {saturation, noise.dark});
  std::vector<Sample> samples;
  for (RawMeasurement raw; reader.next(raw);) {
    if (wavelength > 0 && !same_wavelength(raw.wavelength, wavelength))
      throw std::invalid_argument(reader.error("another wavelength than that of the instrument").what());
    samples.push_back(reduced(reducer(raw.pairs), raw, solid_angle, noise));
  }
  return samples;
}

/// {"generator_retardance_deg": (value, standard uncertainty or None), …}
py::object retarders_of(const Instrument& c) {
  if (!c.retarders) return py::none();
  constexpr std::array<const char*, 4> names{"retardance_deg", "offset_deg", "polarizer_deg", "diattenuation"};
  const auto values = parameters(c.retarders->values);
  py::dict result;
  for (std::size_t k = 0; k < retarder_parameters; ++k) {
    const std::string name = k < 8    ? (k < 4 ? "generator_" : "analyzer_") + std::string(names[k % 4])
                             : k == 8 ? "extinction"
                                      : "responsivity";
    const double unit = name.ends_with("_deg") ? degrees(1) : 1;
    const double variance =
        c.retarders->covariance.empty() ? 0 : c.retarders->covariance[k * (retarder_parameters + 1)];
    const py::object u = variance > 0 ? py::object(py::float_(unit * std::sqrt(variance))) : py::none();
    result[py::str(name)] = py::make_tuple(unit * values[k], u);
  }
  return result;
}

py::object covariance_view(const py::object& self) {
  const auto& c = self.cast<const Instrument&>();
  if (c.covariance.empty()) return py::none();
  const auto n = static_cast<py::ssize_t>(4 * (c.polarimeter.generator.size() + c.polarimeter.analyzer.size()));
  constexpr py::ssize_t size = sizeof(double);
  return view(c.covariance.data(), {n, n}, {n * size, size}, self);
}

/// Standard uncertainties of one arm's states, those from `first` on; None: not known.
py::object state_uncertainty(const Instrument& c, std::size_t first, std::size_t count) {
  if (c.covariance.empty()) return py::none();
  const std::size_t n = 4 * (c.polarimeter.generator.size() + c.polarimeter.analyzer.size());
  py::array_t<double> result({static_cast<py::ssize_t>(count), py::ssize_t{4}});
  for (std::size_t i = 0; i < 4 * count; ++i)
    result.mutable_data()[i] = std::sqrt(std::max(c.covariance[(4 * first + i) * (n + 1)], 0.0));
  return result;
}

py::tuple references_of(const Instrument& c) {
  return tuple_of(c.references, [](const FittedReference& one) {
    double squares = 0;
    for (std::size_t e = 1; e < 16; ++e)
      squares += std::pow(normalized(one.measured).elements[e] - normalized(one.expected).elements[e], 2) / 15;
    return record("CalibrationReference", to_string(one.kind), degrees(one.angle), one.gain, array_of(one.measured),
                  array_of(one.expected), std::sqrt(squares));
  });
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
      .def_property_readonly(
          "figure_of_merit_by_kind",
          [](const Instrument& c) {
            const FigureOfMerit& f = c.figure_of_merit;
            std::map<std::string, double> result;
            for (const auto& [kind, value] : {std::pair("empty", f.empty),
                                              {"polarizer", f.polarizer},
                                              {"wafer", f.wafer},
                                              {"retarder", f.retarder}})
              if (value > 0) result[kind] = value;
            return result;
          },
          "The same over the references of each kind: {'empty': ..., 'polarizer': ...}")
      .def_property_readonly(
          "figure_of_merit_by_element", [](const Instrument& c) { return array_of(c.figure_of_merit.elements); },
          "The same of each element: (4, 4)")
      .def_property_readonly("references", references_of,
                             "CalibrationReference of each, as calibrate() found it; (): of a file, which does not say")
      .def_readonly("generator_condition", &Calibration::generator_condition)
      .def_readonly("analyzer_condition", &Calibration::analyzer_condition)
      .def_readonly("singular_ratio", &Calibration::singular_ratio, "s16/s15: misfit of the linear solution")
      .def_readonly("identifiability", &Calibration::identifiability,
                    "s15/s1: how far the references are from leaving a second solution")
      .def_readonly("chi_squared", &Calibration::chi_squared,
                    "Of the readings, in units of the given noise: near degrees_of_freedom if that is right. 0: no "
                    "refinement")
      .def_readonly("degrees_of_freedom", &Calibration::degrees_of_freedom);
}

void bind_calibration(py::module_& m) {
  CalibrationClass calibration(m, "Calibration", "A calibrated instrument at one wavelength.");
  bind_quality(calibration);
  calibration.def_property_readonly("wavelength_nm", [](const Instrument& c) { return nanometres(c.wavelength); })
      .def_property_readonly("polarimeter", [](const Instrument& c) { return c.polarimeter; })
      .def_property_readonly("covariance", covariance_view,
                             "Of the components of all generator, then all analyzer states: a view; None: not known")
      .def_property_readonly(
          "generator_uncertainty",
          [](const Instrument& c) { return state_uncertainty(c, 0, c.polarimeter.generator.size()); },
          "Standard uncertainties (n, 4) of polarimeter.generator, from the covariance; None: not known")
      .def_property_readonly(
          "analyzer_uncertainty",
          [](const Instrument& c) {
            return state_uncertainty(c, c.polarimeter.generator.size(), c.polarimeter.analyzer.size());
          },
          "The same of polarimeter.analyzer")
      .def_readonly("scale_uncertainty", &Calibration::scale_uncertainty, "Relative")
      .def_property_readonly(
          "polarizer_offset_deg", [](const Instrument& c) { return degrees(c.polarizer_offset); },
          "Azimuth of the reference polarizer at dial 0")
      .def_readonly("extinction", &Calibration::extinction, "Of the reference polarizer")
      .def_property_readonly("retarders", retarders_of,
                             "Of turning retarders, else None: each number with its standard uncertainty, None: given")
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
      .def(py::pickle(
          [](const Instrument& c) {
            return py::make_tuple(to_json(c), c.name, bits<FittedReference>("Calibration", c.references));
          },
          [](const py::tuple& state) {
            auto c = std::make_shared<Instrument>(calibration_from_json(state[0].cast<std::string>(), "pickle"),
                                                  state[1].cast<std::string>());
            c->references = from_bits<FittedReference>("Calibration", state[2]);
            return c;
          }));
}

void bind_files(py::module_& m) {
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
      "calibrate", calibrated, py::arg("references"), py::kw_only(), py::arg("columns") = ColumnNames{},
      py::arg("film") = py::none(), py::arg("dial_sense") = 1, py::arg("extinction") = 0.0, py::arg("refine") = true,
      py::arg("fit_polarizer_phase") = false, py::arg("noise") = Noise{{"relative", 1e-3}},
      py::arg("saturation") = never_saturated, py::arg("dials_deg") = py::none(), py::arg("retardance_deg") = 90.0,
      py::arg("polarizer_near_deg") = py::none(),
      "The instrument that measured these references, with its covariance.\n\n"
      "references is a file (docs/formats.md), or a table of arrays by the same names: a dict, a pandas.DataFrame, a\n"
      "structured array; numbers broadcast. Its states are numbered from 1 or 0. columns has other names, as in\n"
      "{'intensity': 'V'}, of either.\n"
      "film is (index, thickness in micrometres, index of the substrate) of the wafer, n + ik; noise has the keys\n"
      "dark, shot and relative. With dials_deg (frames, 2), positive from s towards p, it is one of two turning "
      "retarders, of nearly this\n"
      "retardance, for which empty references are enough. polarizer_near_deg is roughly the polarizer's azimuth at "
      "dial\n"
      "0, needed where there is no wafer. Raises ValueError, saying what is missing, where they do not determine it, "
      "and for an\n"
      "instrument with a figure of merit above 0.5 or a condition number above 100; warns (InstrumentWarning) above\n"
      "0.05 and 10, and of a film that is more than 10 % from the given thickness.");
  m.def(
      "reduce",
      [](const Given& raw, const std::variant<InstrumentPointer, Polarimeter>& instrument, double solid_angle,
         const ColumnNames& columns, const Noise& noise, double saturation) {
        const ReadingSource source(raw, columns, "raw");
        require_limit(saturation);
        const ReadingNoise law = noise_from(noise);
        const auto* const calibrated = std::get_if<InstrumentPointer>(&instrument);
        if (calibrated && !*calibrated)
          throw py::type_error("instrument: must be a Calibration or a Polarimeter, not None");
        const Polarimeter p = calibrated ? (*calibrated)->polarimeter : std::get<Polarimeter>(instrument);
        const double wavelength = calibrated ? (*calibrated)->wavelength : 0;
        std::vector<Sample> samples = without_gil([&] {
          return source.read([&](std::istream& in, const std::string& name) {
            return reduced_rows(in, name, p, wavelength, solid_angle, law, saturation);
          });
        });
        heed(judged(samples), source.name());
        const std::string by = calibrated ? (*calibrated)->name : "an ideal instrument";
        return dataset_object(std::move(samples), reduction_text(source.name(), by, solid_angle, law, saturation));
      },
      py::arg("raw"), py::arg("instrument"), py::kw_only(), py::arg("solid_angle"), py::arg("columns") = ColumnNames{},
      py::arg("noise") = Noise{{"relative", 1e-3}}, py::arg("saturation") = never_saturated,
      "A Dataset from readings, a file or a table as calibrate() takes them, with uncertainties from their noise; "
      "solid_angle in sr. The instrument is a\n"
      "Calibration, or a Polarimeter that is taken as exact. Elements that the pairs of states of a measurement do "
      "not\n"
      "determine are NaN. Readings below zero pass down to -5 times noise[\"dark\"]. What the instrument\n"
      "is uncertain by is the same in all samples: fit(..., instrument=...) adds it. Warns (InstrumentWarning) of "
      "matrices\n"
      "that cannot be physical.");
}

}  // namespace

void bind_measuring(py::module_& m) {
  bind_calibration(m);
  bind_files(m);
}

}  // namespace mmbrdf::python
