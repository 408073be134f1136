// SPDX-License-Identifier: BSD-3-Clause
// Which columns of a table are wavelength and angles.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "files/table_layout.hpp"
#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Names = std::span<const std::string_view>;

// Own names first, then those of the published data and of its README, then others in use.
constexpr std::string_view nanometre_names[] = {"wavelength_nm", "lambda_nm"};
constexpr std::string_view micrometre_names[] = {"wavelength_um", "lambda", "lambda_um"};
constexpr std::string_view theta_i_names[] = {"theta_i_deg", "thetai", "thetai_deg"};
constexpr std::string_view phi_i_names[] = {"phi_i_deg", "phi", "phii", "phii_deg"};
constexpr std::string_view theta_r_names[] = {"theta_r_deg", "thetar", "thetar_deg"};
constexpr std::string_view phi_r_names[] = {"phi_r_deg", "phir", "phir_deg"};
constexpr std::array<Names, 4> angle_names = {theta_i_names, phi_i_names, theta_r_names, phi_r_names};
constexpr std::array<std::string_view, 4> radian_names = {"theta_i_rad", "phi_i_rad", "theta_r_rad", "phi_r_rad"};

// Micrometres. What is called nanometres and is shorter is taken for micrometres; what is called lambda and is longer,
// for nanometres.
constexpr double shortest_in_nanometres = 0.01, longest_lambda = 20;

/// Degrees.
double angle(const CsvReader& reader, int column, bool in_radians) {
  if (column < 0) return 0;
  const double value = reader.number(column);
  return in_radians ? degrees(value) : value;
}

void require_polar(const CsvReader& reader, int column, double theta) {
  if (std::abs(theta) > 90)
    throw reader.error(reader.columns()[static_cast<std::size_t>(column)] + ": " + printable(reader.field(column), 40) +
                       (reader.keys()[static_cast<std::size_t>(column)].ends_with("_rad")
                            ? " radians; a polar angle is at most pi/2"
                            : " degrees; a polar angle is at most 90"));
}

/// Where a column is missing: whether its name lacks a unit, or how to name another.
std::string unit_hint(const CsvReader& reader, const std::string& bare, const std::string& own) {
  const int column = reader.find(std::string_view(bare));
  if (column < 0 && reader.may_be_title()) return "; is this line a title? Leave it out, or begin it with #";
  if (column < 0 && !reader.layout().foreign) return "";
  if (column < 0)
    return std::string(own.starts_with("phi_") ? "; in the plane of incidence it is 0, or 180 on the other side" : "") +
           other_name_hint(own, reader.columns());
  const std::string name = shown_name(reader.columns()[static_cast<std::size_t>(column)]);
  return own == "wavelength_nm"
             ? "; is " + name + " in nanometres or micrometres? Call it wavelength_nm or wavelength_um"
             : "; is " + name + " in degrees or radians? Call it " + bare + "_deg or " + bare + "_rad";
}

/// ", nor theta_r_deg, nor phi_r_deg": angles behind one that is missing that are missing, too.
std::string also_missing(const CsvReader& reader, std::size_t after, bool relative_azimuth) {
  std::string text;
  for (std::size_t a = after + 1; a < angle_names.size(); ++a)
    if (reader.find(angle_names[a]) < 0 && reader.find(radian_names[a]) < 0 && !(a % 2 == 1 && relative_azimuth))
      text.append(", nor ").append(angle_names[a][0]);
  return text;
}

}  // namespace

GeometryColumns::GeometryColumns(const CsvReader& reader, double wavelength) : wavelength_(wavelength) {
  const int nanometres = reader.find(nanometre_names), micrometres = reader.find(micrometre_names);
  if (nanometres >= 0 && micrometres >= 0)
    throw reader.error("the wavelength is given twice, in nanometres and in micrometres");
  wavelength_column_ = std::max(nanometres, micrometres);
  units_per_micrometre_ = nanometres >= 0 ? 1000 : 1;
  if (wavelength_column_ < 0 && !(wavelength > 0))
    throw reader.error("no column wavelength_nm (nanometres), nor lambda or wavelength_um (micrometres)" +
                       unit_hint(reader, "wavelength", "wavelength_nm"));
  constexpr std::string_view relative_names[] = {"delta_phi_deg", "delta_phi_rad"};
  const int relative = reader.find(relative_names);
  relative_azimuth_ = relative >= 0;
  for (std::size_t a = 0; a < angles_.size(); ++a) {
    const std::string own(angle_names[a][0]);
    const int in_degrees = reader.find(angle_names[a]), in_radians = reader.find(radian_names[a]);
    if (in_degrees >= 0 && in_radians >= 0) throw reader.error(own + " is given twice, in degrees and in radians");
    angles_[a] = std::max(in_degrees, in_radians);
    in_radians_[a] = in_radians >= 0;
    if (a == 3 && relative_azimuth_) {
      if (angles_[a] >= 0)
        throw reader.error("columns phi_r and delta_phi = phi_r - phi_i: one of them is needed, not both");
      angles_[a] = relative;
      in_radians_[a] = reader.keys()[static_cast<std::size_t>(relative)].ends_with("_rad");
    }
    if (angles_[a] < 0 && !(a == 1 && relative_azimuth_))
      throw reader.error("no column " + own + " (nor " + std::string(angle_names[a][1]) + ")" +
                         also_missing(reader, a, relative_azimuth_) +
                         unit_hint(reader, own.substr(0, own.size() - 4), own));
  }
}

std::vector<int> GeometryColumns::columns() const {
  std::vector<int> result;
  for (const int column : {wavelength_column_, angles_[0], angles_[1], angles_[2], angles_[3]})
    if (column >= 0) result.push_back(column);
  return result;
}

Geometry GeometryColumns::geometry(const CsvReader& reader) const {
  std::array<double, 4> degrees;
  for (std::size_t a = 0; a < 4; ++a) degrees[a] = angle(reader, angles_[a], in_radians_[a]);
  require_polar(reader, angles_[0], degrees[0]);
  require_polar(reader, angles_[2], degrees[2]);
  if (relative_azimuth_) degrees[3] += degrees[1];
  return {direction_from_degrees(degrees[0], degrees[1]), direction_from_degrees(degrees[2], degrees[3])};
}

double GeometryColumns::wavelength(const CsvReader& reader) const {
  if (wavelength_column_ < 0) return wavelength_;
  const std::string& column = reader.columns()[static_cast<std::size_t>(wavelength_column_)];
  const double value = reader.number(wavelength_column_) / units_per_micrometre_;
  if (!(value > 0))
    throw reader.error(column + ": " + printable(reader.field(wavelength_column_), 40) +
                       ": a wavelength must be positive");
  const bool stated = reader.keys()[static_cast<std::size_t>(wavelength_column_)].ends_with("_um");
  if (!stated && (units_per_micrometre_ == 1 ? value > longest_lambda : value < shortest_in_nanometres))
    throw reader.error(column + ": " + shortest(in_nanometres(value)) + " nm: is " + shown_name(column) + " in " +
                       (units_per_micrometre_ == 1 ? "nanometres? Then call it wavelength_nm"
                                                   : "micrometres? Then call it wavelength_um"));
  return value;
}

}  // namespace mmbrdf
