// SPDX-License-Identifier: BSD-3-Clause
// The facts of a report as tables. Part of report.hpp.

#include <cctype>
#include <cmath>
#include <map>

#include "mmbrdf/text/rounding.hpp"
#include "quantities/report_blocks.hpp"

namespace mmbrdf {
namespace {

struct FieldTable {
  std::string heading, caption;
  std::vector<DocumentColumn> columns;
};

const DocumentColumn wavelength_column{"wavelength_nm", "λ / nm", Cell::given};
const DocumentColumn block_column{"block", "block", Cell::words};
constexpr const char* place_heading = "at θᵢ, θᵣ, φᵣ − φᵢ";
const DocumentColumn place_column{"at", place_heading, Cell::place};

FieldTable symmetry_table(const std::string& heading, const std::string& symmetry) {
  return {heading,
          "F test of the modes that " + symmetry +
              " forbids: what a fit leaves with the symmetry, and without it; rms of "
              "f11 in sr⁻¹, of others relative to f11.",
          {block_column,
           {"rows", "rows", Cell::count},
           {"more_coefficients", "more coefficients", Cell::count},
           {"rms", "rms", Cell::three},
           {"rms_without", "rms without", Cell::three},
           {"F", "F", Cell::three},
           {"p", "p", Cell::two}}};
}

std::map<std::string, FieldTable> tables_of_the_model() {
  return {
      {"fit",
       {"Fit",
        "Blocks of the fit: elements that were fitted together.",
        {block_column,
         {"coefficients", "coefficients", Cell::count},
         {"rank", "rank", Cell::count},
         {"condition", "condition", Cell::two},
         {"covariance", "covariance known", Cell::yes_no}}}},
      {"sample",
       {"Sample",
        "What the sample is like: rms over directions up to 70 degrees, of f11 in sr⁻¹ after division by the "
        "reflectance, of others relative to f11; the noise is that of a reading at normal directions.",
        {wavelength_column,
         block_column,
         {"noise", "noise", Cell::two},
         {"once_per_turn", "once per turn", Cell::two},
         {"twice_per_turn", "twice per turn", Cell::two},
         {"thrice_per_turn", "thrice per turn", Cell::two},
         {"nonreciprocal", "not reciprocal", Cell::two}}}},
      {"realizability",
       {"Realizability",
        "On a grid of directions up to a largest polar angle: matrices that cannot exist, the smallest eigenvalue of "
        "the coherency matrix over f11, the smallest f11 and the largest DHR.",
        {wavelength_column,
         {"theta_max_deg", "θ up to / °", Cell::angle},
         {"geometries", "directions", Cell::count},
         {"unrealizable", "cannot exist", Cell::count},
         {"smallest_margin", "smallest eigenvalue", Cell::with_u, "u_margin"},
         {"margin_at", place_heading, Cell::place},
         {"f11_not_positive", "f₁₁ ≤ 0", Cell::count},
         {"smallest_f11", "smallest f₁₁ / sr⁻¹", Cell::with_u, "u_smallest_f11"},
         {"largest_dhr", "largest DHR", Cell::with_u, "u_largest_dhr"},
         {"dhr_at_theta_i_deg", "at θᵢ / °", Cell::angle}}}}};
}

std::map<std::string, FieldTable> tables_of_what_is_left() {
  return {{"residuals",
           {"Residuals",
            "Samples less the model, element by element.",
            {{"element", "element", Cell::element},
             {"unit", "relative to", Cell::prose},
             {"rms", "rms", Cell::two},
             {"mean", "mean", Cell::like, "rms"},
             {"largest", "largest", Cell::like, "rms"},
             wavelength_column,
             place_column}}},
          {"chi_squared",
           {"χ² per degree of freedom",
            "χ² per degree of freedom ν of a fit weighted by the uncertainties of the samples, with its standard "
            "deviation √(2/ν) where they are right.",
            {block_column,
             {"degrees_of_freedom", "degrees of freedom", Cell::count},
             {"chi_squared_per_dof", "χ²/ν", Cell::with_u, "u_chi"}}}},
          {"conventions",
           {"Conventions",
            "What is left of the samples as declared, and if they are read in another frame or with other signs.",
            {{"read_as", "read as", Cell::prose}, {"rms", "rms", Cell::three}}}},
          {"reciprocity", symmetry_table("Reciprocity", "reciprocity")},
          {"mirror_symmetry", symmetry_table("Mirror symmetry", "mirror symmetry")},
          {"dependence_on_phi_i", symmetry_table("Dependence on φᵢ", "isotropy")}};
}

std::map<std::string, FieldTable> tables_of_noise() {
  return {
      {"noise",
       {"Noise",
        "Noise of the samples: scale × √(cosᵃ θᵢ / cosᵇ θᵣ), of f11 relative to it.",
        {wavelength_column,
         {"scale", "scale", Cell::with_u, "u_scale"},
         {"exponent_cos_theta_i", "a", Cell::with_u, "u_exponent_i"},
         {"exponent_cos_theta_r", "b", Cell::with_u, "u_exponent_r"}}}},
      {"repeats",
       {"Repeats",
        "What repeated geometries scatter by, against what the model misses them by.",
        {block_column,
         {"repeats", "repeats", Cell::count},
         {"pure_error", "pure error", Cell::two},
         {"misfit", "misfit", Cell::two},
         {"F", "F", Cell::three},
         {"p", "p", Cell::two}}}},
      {"leverage",
       {"Leverage",
        "The sample of each block that decides most alone: 1 is all by itself.",
        {block_column,
         {"rank", "rank", Cell::count},
         {"largest_leverage", "largest leverage", Cell::two},
         {"sample", "sample", Cell::count},
         place_column}}},
      {"outliers",
       {"Outliers",
        "Elements of samples more than " + shortest(outlier_threshold) + " standard deviations off, the largest first.",
        {{"sample", "sample", Cell::count},
         {"element", "element", Cell::element},
         {"studentized", "standard deviations", Cell::two},
         wavelength_column,
         place_column}}}};
}

std::map<std::string, FieldTable> all_tables() {
  std::map<std::string, FieldTable> all = tables_of_the_model();
  all.merge(tables_of_what_is_left());
  all.merge(tables_of_noise());
  return all;
}

/// With the standard deviation of each.
Json with_u_of_chi(Json rows) {
  for (Json& row : rows) {
    const double freedom = row["degrees_of_freedom"];
    row["u_chi"] = freedom > 0 ? Json(std::sqrt(2 / freedom)) : Json(nullptr);
  }
  return rows;
}

/// Units in words that a reader takes for what they are.
Json with_units(Json rows) {
  for (Json& row : rows) row["unit"] = row["unit"] == "sr^-1" ? "1 sr⁻¹" : "f11";
  return rows;
}

/// With a capital and a full stop.
std::string sentence(std::string line) {
  if (!line.empty()) line[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(line[0])));
  return line + ".";
}

}  // namespace

void add_field(Document& document, const std::string& field, const Json& value) {
  static const std::map<std::string, FieldTable> tables = all_tables();
  const FieldTable& table = tables.at(field);
  document.heading(table.heading);
  if (value.is_string()) return document.paragraph(sentence(value.get<std::string>()));
  if (value.empty()) return document.paragraph("None.");
  document.table(table.caption, table.columns,
                 field == "chi_squared" ? with_u_of_chi(value)
                 : field == "residuals" ? with_units(value)
                                        : value);
}

}  // namespace mmbrdf
