// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf evaluate: one geometry from the command line; a file of geometries is evaluate_file.cpp.

#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "arguments.hpp"
#include "command.hpp"
#include "describe.hpp"
#include "evaluate_file.hpp"
#include "files.hpp"
#include "mmbrdf/model.hpp"
#include "output.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string model, geometries, output;
  std::optional<double> wavelength_nm;
  std::optional<DirectionDegrees> incident, reflected;
  std::optional<Format> format;
  Frame frame = Frame::xy;
  bool normalized = false;
  bool as_printed = false;

  Rotation rotation() const { return as_printed ? Rotation::as_printed : Rotation::covariant; }
};

/// One evaluated geometry, with what is printed about it.
struct Answer {
  std::string model;
  std::optional<double> wavelength_nm;  // none: the model does not depend on it, nor say to which it was fitted
  DirectionDegrees incident, reflected;
  Frame frame;
  bool normalized, as_printed;
  Mueller mueller;  // element 11 is f11 even if normalized
  Outside outside;
};

constexpr const char* convention = "germer2017";  // see StokesConvention

/// What S2 and S4 are, for people.
std::string convention_note(Frame frame) {
  const std::string s2 = frame == Frame::xy ? "y - x" : frame == Frame::sp ? "s - p" : "perpendicular - parallel";
  return "S2 = " + s2 + ", S4 = left - right";
}

std::string heading(const Answer& a) {
  const std::string wavelength = a.wavelength_nm ? brief(*a.wavelength_nm) + " nm" : "unknown";
  std::string text = a.model + ": wavelength " + wavelength + ", incident " + brief(a.incident.theta) + "," +
                     brief(a.incident.phi) + ", reflected " + brief(a.reflected.theta) + "," + brief(a.reflected.phi) +
                     " (theta,phi in degrees)\n";
  text += a.normalized ? "f11 in sr^-1, the other elements divided by it" : "Mueller BRDF in sr^-1";
  text += ", frame " + to_string(a.frame) + " (" + convention_note(a.frame) + ")" +
          (a.as_printed ? ", as printed" : "") + "\n";
  return text + "validity: " + to_string(a.outside) + "\n";
}

void print_text(const Answer& a) {
  std::cout << heading(a);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const double value = a.mueller(row, column);
      std::cout << format("%16.10f", std::abs(value) < 5e-11 ? 0 : value);  // no -0.0000000000
    }
    std::cout << '\n';
  }
}

void print_csv(const Answer& a) {
  std::string text = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg" + element_columns(a.normalized) +
                     ",validity\n" + (a.wavelength_nm ? shortest(*a.wavelength_nm) : "");
  for (const double angle : {a.incident.theta, a.incident.phi, a.reflected.theta, a.reflected.phi}) {
    text += "," + shortest(angle);
  }
  append_elements(text, a.mueller);
  std::cout << text << ',' << to_string(a.outside) << '\n';
}

void print_json(const Answer& a) {
  nlohmann::ordered_json json;
  json["model"] = a.model;
  json["wavelength_nm"] = a.wavelength_nm ? nlohmann::ordered_json(*a.wavelength_nm) : nullptr;
  json["theta_i_deg"] = a.incident.theta;
  json["phi_i_deg"] = a.incident.phi;
  json["theta_r_deg"] = a.reflected.theta;
  json["phi_r_deg"] = a.reflected.phi;
  json["frame"] = to_string(a.frame);
  json["convention"] = convention;
  json["convention_note"] = convention_note(a.frame);
  json["rotation"] = a.as_printed ? "as_printed" : "covariant";
  json["unit"] = a.normalized ? "1" : "sr^-1";
  if (a.normalized) {
    json["f11"] = a.mueller(0, 0);
    json["f11_unit"] = "sr^-1";
  }
  Mueller m = a.mueller;
  m(0, 0) = a.normalized ? 1 : m(0, 0);
  for (std::size_t row = 0; row < 4; ++row) {
    json["mueller"].push_back(std::vector<double>(&m.elements[4 * row], &m.elements[4 * row] + 4));
  }
  json["validity"] = to_string(a.outside);
  print(json);
}

void warn_if_outside(const Answer& answer, const Validity& validity) {
  if (leaves_known_range(answer.outside)) {
    warn("outside the fitted range (" + to_string(answer.outside) + "): fitted are " + fitted_range(validity));
  }
  if (answer.outside & unknown_range) {
    warn(unknown_range_line(answer.model, validity));
  }
}

Model model_of(const Options& options) {
  Model model = open_model(options.model);
  if (options.as_printed) {
    note_unless_printed(model, base_name(options.model));
  }
  return model;
}

void evaluate_one(const Options& options) {
  const Model model = model_of(options);
  const double wavelength = wavelength_from(options.wavelength_nm, model);
  const bool known = options.wavelength_nm || knows_wavelength(model);
  const Geometry geometry{direction_from(*options.incident, "--incident"),
                          direction_from(*options.reflected, "--reflected")};
  const PreparedModel prepared = prepare(model, wavelength, options.rotation());
  const Mueller f = prepared.evaluate(geometry, options.frame);
  const Answer answer{.model = base_name(options.model),
                      .wavelength_nm = known ? std::optional(nanometres(wavelength)) : std::nullopt,
                      .incident = *options.incident,
                      .reflected = *options.reflected,
                      .frame = options.frame,
                      .normalized = options.normalized,
                      .as_printed = options.as_printed,
                      .mueller = options.normalized ? normalized_beside_f11(f) : f,
                      .outside = prepared.outside(geometry)};
  warn_if_outside(answer, model.validity);
  const Format form = options.format.value_or(Format::text);
  (form == Format::text ? print_text : form == Format::csv ? print_csv : print_json)(answer);
}

void evaluate(const Options& options) {
  if (options.geometries.empty()) {
    for (const auto& [given, name] : {std::pair(options.incident.has_value(), "--incident"),
                                      std::pair(options.reflected.has_value(), "--reflected")}) {
      if (!given) {
        throw CLI::RequiredError(std::string(name) + " (or --geometries)");
      }
    }
    return evaluate_one(options);
  }
  if (options.format && *options.format != Format::csv) {
    throw CLI::ValidationError("--format", "only csv goes with --geometries");
  }
  require_model_kept(options.model, options.output);
  require_kept(options.geometries, options.output, "geometries");
  const Model model = model_of(options);
  double wavelength = 0;
  if (options.wavelength_nm) {
    wavelength = micrometres(*options.wavelength_nm);
  }
  evaluate_file(model, {.model = base_name(options.model),
                        .input = options.geometries,
                        .output = options.output,
                        .wavelength = wavelength,
                        .frame = options.frame,
                        .rotation = options.rotation(),
                        .normalized = options.normalized});
}

constexpr const char* footer =
    "The frame names the axes of the Stokes components: xy (those at the surface normal, carried along the meridian),\n"
    "sp (s and p of each beam), scattering_plane (perpendicular and parallel to the plane of both beams). S2 is\n"
    "y - x, s - p or perpendicular - parallel, S4 is left - right. A negative polar angle means the opposite azimuth:\n"
    "-45,0 is 45,180. The validity is ok, what lies outside the fitted range, or unknown.\n"
    "\n"
    "FILE.csv has a header line with wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg or the names of the\n"
    "published data; other columns are kept, those named as one of the output as input_NAME, lines that begin with\n"
    "# are not. Any number of rows takes the same memory.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf evaluate ptfe --wavelength 532 --incident 45,0 --reflected 30,180 --frame sp\n"
    "  mmbrdf evaluate ptfe --geometries directions.csv -o values.csv";

}  // namespace

Run evaluate_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_model(app, o->model);
  add_option(app, "-w,--wavelength", o->wavelength_nm, number, "NM",
             "Wavelength in nm; not needed for models of one wavelength,\nnor for rows that have their own");
  auto* incident = add_option(app, "-i,--incident", o->incident, direction_degrees, "THETA,PHI",
                              "Direction to the source, in degrees");
  auto* reflected = add_option(app, "-r,--reflected", o->reflected, direction_degrees, "THETA,PHI",
                               "Direction to the detector, in degrees");
  auto* geometries = add_file(app, "-g,--geometries", o->geometries, "FILE.csv",
                              "Evaluate at each row of a file; - is standard input");
  geometries->excludes(incident)->excludes(reflected);
  add_file(app, "-o,--output", o->output, "OUT.csv", "Where the rows go; - is standard output [-]")->needs(geometries);
  add_option(app, "--frame", o->frame, frame_from, "FRAME", "xy, sp or scattering_plane [xy]");
  app.add_flag("--normalized", o->normalized, "f11 in sr^-1, and all others divided by it (m12 ... m44)");
  app.add_flag("--as-printed", o->as_printed,
               "Published coefficients: the sum at the azimuths given, not\nat phi_i = 0 and turned. To compare only");
  add_option(app, "--format", o->format, format_from, "FORMAT", "text, csv or json [text; csv for files]");
  app.footer(footer);
  return [o] { evaluate(*o); };
}

}  // namespace mmbrdf::program
