// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/description.hpp"

#include <cmath>
#include <optional>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// 532, 632.8
std::string nanometre_text(double wavelength) { return rounded(nanometres(wavelength), 10); }

std::string limit(const std::string& name, const std::optional<double>& most) {
  return name + (most ? " <= " + rounded(degrees(*most), 4) : " not known");
}

}  // namespace

std::string basis_line(const Model& model) {
  const Orders order = orders(model);
  return to_string(model.family) + (model.rotation == Rotation::as_printed ? " as printed" : "") + ", orders " +
         std::to_string(order.f11) + "," + std::to_string(order.other) + ", wavelength power" +
         (model.powers == 0 ? " 0" : "s 0 to " + std::to_string(model.powers)) + ", " + to_string(model.mapping) +
         " mapping: " + counted(mode_count(model), "mode") + ", " + counted(coefficient_count(model), "coefficient") +
         (model.not_measured.any() ? "; " + not_measured_line(model.not_measured) : "");
}

std::string not_measured_line(const Elements& elements) {
  return elements.count() == 15 ? "f11 alone was measured" : "not measured: " + element_names(elements);
}

std::string angles_line(const Validity& validity) {
  if (!validity.theta_i_max && !validity.theta_r_max) return "not known";
  return limit("theta_i", validity.theta_i_max) + ", " + limit("theta_r", validity.theta_r_max) + " degrees";
}

std::string fitted_range(const Validity& validity) {
  const bool angles = validity.theta_i_max || validity.theta_r_max;
  if (validity.wavelengths.empty()) return angles_line(validity);
  return (angles ? angles_line(validity) + " at " : "") + nanometre_list(validity.wavelengths);
}

std::string unknown_range_line(const std::string& model, const Validity& validity) {
  const bool angles = validity.theta_i_max && validity.theta_r_max, wavelengths = !validity.wavelengths.empty();
  if (angles && wavelengths) return "";
  const std::string what = angles ? "wavelengths" : wavelengths ? "angles" : "wavelengths and angles";
  return model + " does not say to which " + what + " it was fitted; mmbrdf convert can record them";
}

std::string azimuth_of_source_line(Family family) {
  return std::string("this model depends on the azimuth of the source: ") +
         (family == Family::anisotropic ? "if the sample is isotropic, fit it anew with `--basis isotropic`"
                                        : "`convert --basis isotropic` makes one that does not");
}

std::string outside_line(Outside reasons, const Validity& validity) {
  return "outside the fitted range (" + to_string(reasons) + "): fitted are " + fitted_range(validity) +
         (reasons & outside_directions ? ", and no samples support all of these directions together" : "");
}

void RangeCount::add(Outside where) { add({1, leaves_known_range(where) ? 1 : 0, where}); }

void RangeCount::add(const RangeCount& more) {
  asked += more.asked;
  outside += more.outside;
  reasons = static_cast<Outside>(reasons | more.reasons);
}

std::string RangeCount::line(const std::string& what) const {
  if (outside == 0) return "";
  return std::to_string(outside) + " of " + counted(asked, what) + (outside == 1 ? " lies" : " lie") +
         " outside the fitted range";
}

std::string reflectance_line(const ReflectanceTable& table) {
  std::string text;
  for (std::size_t i = 0; i < table.values.size(); ++i)
    text += (i > 0 ? "," : "") + nanometre_text(table.wavelengths[i]) + ":" + shortest(table.values[i]);
  return text;
}

std::string nanometre_list(std::span<const double> wavelengths) {
  std::string text;
  for (const double wavelength : wavelengths) text += (text.empty() ? "" : ", ") + nanometre_text(wavelength);
  return text + " nm";
}

double nanometres(double wavelength) { return std::round(wavelength * 1e12) / 1e9; }

std::string counted(long count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace mmbrdf
