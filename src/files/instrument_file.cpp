// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/instrument_file.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "files/json_field.hpp"
#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/files/write_file.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"
#include "text/json_text.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using nlohmann::ordered_json;

constexpr const char* instrument_format_name = "mmbrdf instrument";

ordered_json instrument_conventions() {
  return {{"frame", "scattering_plane"},
          {"axes", "e1 = perpendicular, e2 = parallel to the scattering plane, e1 x e2 = direction of propagation"},
          {"stokes", "germer2017"},
          {"s4", "left - right"},
          {"time_factor", "exp(-i omega t)"},
          {"readings", "row of analyzer . M . row of generator"}};
}
ordered_json instrument_units() { return {{"wavelength", "nm"}, {"angles", "deg"}, {"film_thickness", "um"}}; }

// ---- reading --------------------------------------------------------------------------------------------------------

Stokes read_state(const Field& field) {
  const std::vector<double> values = field.numbers();
  require_count(field, values.size(), 4, "a Stokes vector");
  Stokes state;
  std::copy(values.begin(), values.end(), state.begin());
  return state;
}

std::vector<Stokes> read_states(const Field& field) {
  std::vector<Stokes> states;
  const std::vector<Field> items = field.items();
  if (items.size() > most_states)
    field.refuse(std::to_string(items.size()) + " states, more than " + std::to_string(most_states));
  for (const Field& item : items) states.push_back(read_state(item));
  if (states.size() < 4) field.refuse(std::to_string(states.size()) + " states, at least four are needed");
  return states;
}

double read_positive(const Field& field) {
  if (!(field.number() > 0)) field.refuse(field.shown() + " is not positive");
  return field.number();
}

/// Nanometres: up to a metre, so that no unit overflows.
double read_wavelength(const Field& field) {
  const double value = read_positive(field);
  if (value > 1e9) field.refuse(field.shown() + " is not a wavelength in nm");
  return value / 1000;
}

double read_amount(const Field& field) {
  if (field.number() < 0) field.refuse(field.shown() + " is negative");
  return field.number();
}

FigureOfMerit read_figure_of_merit(const Field& field) {
  field.require_no_other_than({"total", "corrected", "empty", "polarizer", "wafer", "retarder", "elements"});
  FigureOfMerit figure;
  figure.total = read_amount(field["total"]);
  figure.corrected = read_amount(field["corrected"]);
  figure.empty = read_amount(field["empty"]);
  figure.polarizer = read_amount(field["polarizer"]);
  figure.wafer = read_amount(field["wafer"]);
  if (field.has("retarder")) figure.retarder = read_amount(field["retarder"]);
  const std::vector<Field> rows = field["elements"].items();
  require_count(field["elements"], rows.size(), 4, "the rows");
  for (std::size_t row = 0; row < 4; ++row) {
    const std::vector<double> values = rows[row].numbers();
    require_count(rows[row], values.size(), 4, "a row");
    for (const double value : values)
      if (value < 0) rows[row].refuse(shortest(value) + " is negative");
    std::copy(values.begin(), values.end(), &figure.elements.elements[4 * row]);
  }
  return figure;
}

void read_polarizer(const Field& field, Calibration& calibration) {
  field.require_no_other_than({"offset_deg", "extinction", "phase_deg"});
  calibration.polarizer_offset = radians(field["offset_deg"].number());
  calibration.extinction = read_amount(field["extinction"]);
  if (calibration.extinction > 1) field["extinction"].refuse(field["extinction"].shown() + " is more than 1");
  calibration.polarizer_phase = radians(field["phase_deg"].number());
}

/// The states are what counts: a condition number that is not theirs is a mistake of the file.
void require_condition(const Field& field, const std::vector<Stokes>& states) {
  const double own = condition_number(states);
  if (!(std::abs(read_positive(field) / own - 1) < 1e-6))
    field.refuse(field.shown() + ", but the states of the file have " + shortest(own));
}

void read_freedom(const Field& field, Calibration& calibration) {
  calibration.degrees_of_freedom = field.integer();
  if (calibration.degrees_of_freedom < 0) field.refuse(field.shown() + " is negative");
  if (calibration.degrees_of_freedom == 0 && !calibration.covariance.empty())
    field.refuse("0, and there is a covariance");
}

void require_instrument(const Field& root) {
  require_format(root, instrument_format_name, instrument_conventions(), instrument_units(),
                 {"format",
                  "schema_version",
                  "conventions",
                  "units",
                  "wavelength_nm",
                  "generator",
                  "analyzer",
                  "covariance",
                  "retarders",
                  "generator_condition",
                  "analyzer_condition",
                  "polarizer",
                  "film_thickness_um",
                  "film_misfit_deg",
                  "scale_uncertainty",
                  "figure_of_merit",
                  "singular_ratio",
                  "identifiability",
                  "chi_squared",
                  "degrees_of_freedom",
                  "provenance"});
}

void read_polarimeter(const Field& root, Calibration& c) {
  c.polarimeter.generator = read_states(root["generator"]);
  c.polarimeter.analyzer = read_states(root["analyzer"]);
  const std::size_t size = 4 * (c.polarimeter.generator.size() + c.polarimeter.analyzer.size());
  if (root.has("covariance")) c.covariance = read_covariance(root["covariance"], size);
}

RetarderArm read_arm(const Field& field) {
  field.require_no_other_than({"retardance_deg", "offset_deg", "polarizer_deg", "diattenuation"});
  return {radians(field["retardance_deg"].number()), radians(field["offset_deg"].number()),
          radians(field["polarizer_deg"].number()), field["diattenuation"].number()};
}

std::vector<DialAngles> read_dials(const Field& field) {
  const std::vector<Field> items = field.items();
  if (items.empty() || items.size() > most_states)
    field.refuse(std::to_string(items.size()) + " frames, must be 1 to " + std::to_string(most_states));
  std::vector<DialAngles> result;
  for (const Field& item : items) {
    const std::vector<double> angles = item.numbers();
    require_count(item, angles.size(), 2, "the dials of generator and analyzer");
    result.push_back({radians(angles[0]), radians(angles[1])});
  }
  return result;
}

/// From which the states and their covariance are made.
void read_retarders(const Field& root, Calibration& c) {
  for (const char* const states : {"generator", "analyzer", "covariance"})
    if (root.has(states)) root[states].refuse("not beside retarders, which say it");
  const Field& field = root["retarders"];
  field.require_no_other_than({"generator", "analyzer", "extinction", "responsivity", "dials_deg", "covariance"});
  CalibratedRetarders retarders;
  retarders.values = {read_arm(field["generator"]), read_arm(field["analyzer"]), read_amount(field["extinction"]),
                      read_positive(field["responsivity"])};
  retarders.dials = read_dials(field["dials_deg"]);
  if (field.has("covariance")) retarders.covariance = read_covariance(field["covariance"], retarder_parameters);
  checked(field, [&] {
    c.polarimeter = polarimeter(retarders.values, retarders.dials);
    if (!retarders.covariance.empty())
      c.covariance = state_covariance(retarders.values, retarders.dials, retarders.covariance);
    return true;
  });
  c.retarders = std::move(retarders);
}

Calibration read_calibration(const Field& root) {
  require_instrument(root);
  Calibration c;
  c.wavelength = read_wavelength(root["wavelength_nm"]);
  if (root.has("retarders"))
    read_retarders(root, c);
  else
    read_polarimeter(root, c);
  checked(root, [&] { return Reduction(c.polarimeter, c.covariance); });
  require_condition(root["generator_condition"], c.polarimeter.generator);
  require_condition(root["analyzer_condition"], c.polarimeter.analyzer);
  c.generator_condition = root["generator_condition"].number();
  c.analyzer_condition = root["analyzer_condition"].number();
  read_polarizer(root["polarizer"], c);
  if (root.has("film_thickness_um")) c.film_thickness = read_positive(root["film_thickness_um"]);
  if (root.has("film_misfit_deg")) c.film_misfit = radians(read_amount(root["film_misfit_deg"]));
  if (root.has("scale_uncertainty")) c.scale_uncertainty = read_amount(root["scale_uncertainty"]);
  c.figure_of_merit = read_figure_of_merit(root["figure_of_merit"]);
  c.singular_ratio = read_amount(root["singular_ratio"]);
  c.identifiability = read_amount(root["identifiability"]);
  c.chi_squared = read_amount(root["chi_squared"]);
  read_freedom(root["degrees_of_freedom"], c);
  c.provenance = root["provenance"].texts();
  return c;
}

// ---- writing --------------------------------------------------------------------------------------------------------

ordered_json states_json(const std::vector<Stokes>& states) {
  ordered_json result = ordered_json::array();
  for (const Stokes& s : states) result.push_back({s[0], s[1], s[2], s[3]});
  return result;
}

ordered_json figure_json(const FigureOfMerit& figure) {
  ordered_json rows = ordered_json::array();
  for (std::size_t row = 0; row < 4; ++row) {
    const double* const m = &figure.elements.elements[4 * row];
    rows.push_back({m[0], m[1], m[2], m[3]});
  }
  ordered_json json = {{"total", figure.total},
                       {"corrected", figure.corrected},
                       {"empty", figure.empty},
                       {"polarizer", figure.polarizer},
                       {"wafer", figure.wafer}};
  if (figure.retarder > 0) json["retarder"] = figure.retarder;
  json["elements"] = rows;
  return json;
}

ordered_json arm_json(const RetarderArm& arm) {
  return {{"retardance_deg", in_degrees(arm.retardance)},
          {"offset_deg", in_degrees(arm.offset)},
          {"polarizer_deg", in_degrees(arm.polarizer)},
          {"diattenuation", arm.diattenuation}};
}

ordered_json retarders_json(const CalibratedRetarders& retarders) {
  ordered_json dials = ordered_json::array();
  for (const DialAngles& dial : retarders.dials)
    dials.push_back({in_degrees(dial.generator), in_degrees(dial.analyzer)});
  ordered_json json = {{"generator", arm_json(retarders.values.generator)},
                       {"analyzer", arm_json(retarders.values.analyzer)},
                       {"extinction", retarders.values.extinction},
                       {"responsivity", retarders.values.responsivity},
                       {"dials_deg", dials}};
  if (!retarders.covariance.empty()) json["covariance"] = lower_triangle(retarders.covariance, retarder_parameters);
  return json;
}

ordered_json calibration_json(const Calibration& c) {
  const std::size_t size = 4 * (c.polarimeter.generator.size() + c.polarimeter.analyzer.size());
  ordered_json root = {{"format", instrument_format_name},
                       {"schema_version", schema_version},
                       {"conventions", instrument_conventions()},
                       {"units", instrument_units()},
                       {"wavelength_nm", in_nanometres(c.wavelength)}};
  if (c.retarders) {
    root["retarders"] = retarders_json(*c.retarders);
  } else {
    root["generator"] = states_json(c.polarimeter.generator);
    root["analyzer"] = states_json(c.polarimeter.analyzer);
  }
  root["generator_condition"] = c.generator_condition;
  root["analyzer_condition"] = c.analyzer_condition;
  root["polarizer"] = {{"offset_deg", in_degrees(c.polarizer_offset)},
                       {"extinction", c.extinction},
                       {"phase_deg", in_degrees(c.polarizer_phase)}};
  if (c.film_thickness > 0) root["film_thickness_um"] = c.film_thickness;
  if (c.film_misfit > 0) root["film_misfit_deg"] = in_degrees(c.film_misfit);
  if (c.scale_uncertainty > 0) root["scale_uncertainty"] = c.scale_uncertainty;
  root["figure_of_merit"] = figure_json(c.figure_of_merit);
  root["singular_ratio"] = c.singular_ratio;
  root["identifiability"] = c.identifiability;
  root["chi_squared"] = c.chi_squared;
  root["degrees_of_freedom"] = c.degrees_of_freedom;
  root["provenance"] = c.provenance;
  if (!c.covariance.empty() && !c.retarders) root["covariance"] = lower_triangle(c.covariance, size);
  return root;
}

/// What is not finite would be written as null.
void require_finite_numbers(const ordered_json& value, const std::string& name) {
  if (value.is_number() && !std::isfinite(value.get<double>()))
    throw std::invalid_argument(name + " of the instrument must be finite");
  if (!value.is_structured()) return;
  for (const auto& [key, child] : value.items()) require_finite_numbers(child, value.is_object() ? key : name);
}

}  // namespace

Calibration calibration_from_json(std::string_view text, const std::string& name) {
  const nlohmann::json root = parsed_json(text, name);
  return read_calibration(Field(root, name));
}

std::string to_json(const Calibration& calibration) {
  if (!(calibration.wavelength > 0)) throw std::invalid_argument("the wavelength must be positive");
  if (!calibration.polarimeter.pairs.empty() && !calibration.retarders)
    throw std::invalid_argument("an instrument file has pairs of states of turning retarders only");
  Reduction(calibration.polarimeter, calibration.covariance);  // throws for what could not be used
  const ordered_json root = calibration_json(calibration);
  require_finite_numbers(root, "a number");
  std::string text;
  try {
    text = json_text(root);
  } catch (const nlohmann::json::exception& e) {  // text that is not UTF-8
    throw std::invalid_argument("provenance of the instrument: " + std::string(e.what()));
  }
  try {
    calibration_from_json(text, "instrument");
  } catch (const std::runtime_error& e) {
    throw std::invalid_argument(std::string(e.what()));
  }
  return text;
}

Calibration load_instrument(const std::string& path) {
  std::ifstream in = open_input(path);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) throw std::runtime_error(path + ": read error");
  return calibration_from_json(text, path);
}

void save_instrument(const std::string& path, const Calibration& calibration) {
  const std::string text = to_json(calibration);
  require_readable([&] { calibration_from_json(text, path); });
  write_file(path, [&](std::ostream& out) { out << text; });
}

}  // namespace mmbrdf
