// SPDX-License-Identifier: BSD-3-Clause
// What evaluate and analyze ask of a model: where, in which frame, and of a geometry or of a file of them.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mmbrdf/model/model.hpp"
#include "options/arguments.hpp"
#include "streams/evaluate_file.hpp"

namespace mmbrdf::program {

struct Question {
  std::string model, geometries, output;
  std::optional<std::vector<double>> wavelengths_nm;  ///< as typed
  std::optional<double> wavelength_nm;                ///< of one answer
  std::optional<DirectionDegrees> incident, reflected;
  Frame frame = Frame::xy;
  bool as_printed = false;
};

/// Options as `add_question` declares them, for others to be tied to.
struct QuestionOptions {
  Option wavelength, incident, reflected, geometries, output;
};

/// MODEL, -w, -i, -r, -g, -o and --frame. `done` says what happens at each row of a file: "Evaluate".
QuestionOptions add_question(CLI::App& app, Question& question, const std::string& done);
void add_as_printed(CLI::App& app, Question& question);

/// Opens the model, as printed if --as-printed says so; notes where that changes nothing.
Model model_of(const Question& question);

/// What is asked of each answer, in nm: what was typed, or one that is the model's own.
std::vector<std::optional<double>> wavelengths_asked(const Question& question);

/// Azimuths that were not typed: 0 of the source, which an isotropic model does not see, and forward of a detector at the
/// normal. Throws WrongUsage for a source of a model that depends on it.
void complete_azimuths(Question& question, const Model& model);

/// A direction that was not given is wrong usage. `or_else` names what could be given instead of it.
void require_directions(const Question& question, const std::string& or_else);

/// Once both directions are there.
Geometry geometry_of(const Question& question);

/// The model for a file of rows, after it is clear that the output overwrites neither it nor the geometries.
Model model_of_rows(const Question& question);
RowsOfFile rows_of(const Question& question);

/// Where the model was asked.
struct Place {
  std::string model;
  std::optional<double> wavelength_nm;  ///< none: the model does not depend on it, nor say to which it was fitted
  DirectionDegrees incident, reflected;
  Rotation rotation;
};
Place place_of(const Model& model, const Question& question, double wavelength);

/// "ptfe: wavelength 532 nm, incident 45,0, reflected 30,180 (theta,phi in degrees)"
std::string heading(const Place& place);

/// "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg", and the fields below it.
extern const char* const place_columns;
std::string fields(const Place& place);

/// Model, wavelength and angles under the names of the columns; the frame, and what it means.
nlohmann::ordered_json to_json(const Place& place);
void add_frame(nlohmann::ordered_json& json, Frame frame, Rotation rotation);

/// What S2 and S4 are, for people: "S2 = s - p, S4 = left - right"
std::string convention_note(Frame frame);

void warn_if_outside(const std::string& model, Outside outside, const Validity& validity);

}  // namespace mmbrdf::program
