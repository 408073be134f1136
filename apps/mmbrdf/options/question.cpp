// SPDX-License-Identifier: BSD-3-Clause
#include "options/question.hpp"

#include "mmbrdf/model/description.hpp"
#include "options/files.hpp"
#include "pages/describe.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

const char* const place_columns = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg";

QuestionOptions add_question(CLI::App& app, Question& question, const std::string& done) {
  QuestionOptions o{};
  add_model(app, question.model);
  o.wavelength = add_option(app, "-w,--wavelength", question.wavelengths_nm, numbers, "NM[,NM...]",
                            "Wavelengths in nm; not needed for models of one wavelength,\nnor for rows that have their "
                            "own");
  o.incident = add_option(app, "-i,--incident", question.incident, incident_degrees, "THETA[,PHI]",
                          "Direction to the source, in degrees [PHI of isotropic\nmodels: 0]");
  o.reflected = add_option(app, "-r,--reflected", question.reflected, reflected_degrees, "THETA,PHI",
                           "Direction to the detector, in degrees; PHI_I + 180 is\nforward, 0 the normal");
  o.geometries = add_file(app, "-g,--geometries", question.geometries, "FILE.csv",
                          done + " at each row of a file; - is standard input");
  o.geometries.excludes(o.incident).excludes(o.reflected);
  o.output = add_file(app, "-o,--output", question.output, "OUT.csv", "Where the rows go; - is standard output [-]");
  add_option(app, "--frame", question.frame, frame_from, "FRAME", "xy, sp or scattering_plane [xy]");
  return o;
}

void add_as_printed(CLI::App& app, Question& question) {
  add_flag(app, "--as-printed", question.as_printed,
           "Published coefficients: the sum at the azimuths given, not\nat phi_i = 0 and turned. To compare only");
}

Model model_of(const Question& question) {
  Model model = open_model(question.model);
  if (!question.as_printed) return model;
  note_unless_printed(model, base_name(question.model));
  return as_printed(std::move(model));
}

std::vector<std::optional<double>> wavelengths_asked(const Question& question) {
  if (!question.wavelengths_nm) return {std::nullopt};
  return {question.wavelengths_nm->begin(), question.wavelengths_nm->end()};
}

void complete_azimuths(Question& question, const Model& model) {
  std::optional<DirectionDegrees>&i = question.incident, &r = question.reflected;
  if (i && !i->has_phi && (model.family == Family::anisotropic || model.rotation == Rotation::as_printed))
    throw WrongUsage("--incident", brief(i->theta) + ": " + base_name(question.model) +
                                       " depends on the azimuth of the source: expected THETA,PHI");
  if (r && !r->has_phi) r->phi = (i ? i->phi : 0) + 180;
}

void require_directions(const Question& question, const std::string& or_else) {
  for (const auto& [given, name] : {std::pair(question.incident.has_value(), "--incident"),
                                    std::pair(question.reflected.has_value(), "--reflected")}) {
    if (!given) throw missing(std::string(name) + " (or " + or_else + ")");
  }
}

Geometry geometry_of(const Question& question) {
  return {direction_from(*question.incident, "--incident"), direction_from(*question.reflected, "--reflected")};
}

Model model_of_rows(const Question& question) {
  require_model_kept(question.model, question.output);
  require_kept(question.geometries, question.output, "geometries");
  return model_of(question);
}

RowsOfFile rows_of(const Question& question) {
  if (question.wavelengths_nm && question.wavelengths_nm->size() > 1)
    throw WrongUsage("--wavelength", "one at most goes with --geometries: rows have a column wavelength_nm");
  return {.model = base_name(question.model),
          .input = question.geometries,
          .output = question.output,
          .wavelength = question.wavelengths_nm ? micrometres(question.wavelengths_nm->front()) : 0};
}

Place place_of(const Model& model, const Question& question, double wavelength) {
  const bool known = question.wavelength_nm || knows_wavelength(model);
  return {base_name(question.model), known ? std::optional(nanometres(wavelength)) : std::nullopt,
          question.incident.value_or(DirectionDegrees{}), question.reflected.value_or(DirectionDegrees{}),
          model.rotation};
}

std::string heading(const Place& place) {
  const std::string wavelength = place.wavelength_nm ? brief(*place.wavelength_nm) + " nm" : "unknown";
  return place.model + ": wavelength " + wavelength + ", incident " + brief(place.incident.theta) + "," +
         brief(place.incident.phi) + ", reflected " + brief(place.reflected.theta) + "," + brief(place.reflected.phi) +
         " (theta,phi in degrees)\n";
}

std::string fields(const Place& place) {
  std::string text = place.wavelength_nm ? shortest(*place.wavelength_nm) : "";
  for (const double angle : {place.incident.theta, place.incident.phi, place.reflected.theta, place.reflected.phi})
    text += "," + shortest(angle);
  return text;
}

nlohmann::ordered_json to_json(const Place& place) {
  nlohmann::ordered_json json;
  json["model"] = place.model;
  json["wavelength_nm"] = place.wavelength_nm ? nlohmann::ordered_json(*place.wavelength_nm) : nullptr;
  json["theta_i_deg"] = place.incident.theta;
  json["phi_i_deg"] = place.incident.phi;
  json["theta_r_deg"] = place.reflected.theta;
  json["phi_r_deg"] = place.reflected.phi;
  return json;
}

void add_frame(nlohmann::ordered_json& json, Frame frame, Rotation rotation) {
  json["frame"] = to_string(frame);
  json["convention"] = "germer2017";  // see StokesConvention
  json["convention_note"] = convention_note(frame);
  json["rotation"] = to_string(rotation);
}

std::string convention_note(Frame frame) {
  const std::string s2 = frame == Frame::xy ? "y - x" : frame == Frame::sp ? "s - p" : "perpendicular - parallel";
  return "S2 = " + s2 + ", S4 = left - right";
}

void warn_if_outside(const std::string& model, Outside outside, const Validity& validity) {
  if (leaves_known_range(outside)) warn(outside_line(outside, validity));
  if (outside & unknown_range) warn(unknown_range_line(model, validity));
}

}  // namespace mmbrdf::program
