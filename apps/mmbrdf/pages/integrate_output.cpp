// SPDX-License-Identifier: BSD-3-Clause
// What `mmbrdf integrate` prints.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pages/describe.hpp"
#include "pages/integrate.hpp"

namespace mmbrdf::program {

namespace {

struct Named {
  Integral quantity;
  const char* name;
  const char* meaning;
  const char* unit;
};

constexpr Named quantities[] = {
    {Integral::dhr, "dhr", "directional-hemispherical reflectance", "1"},
    {Integral::hdr, "hdr", "hemispherical-directional reflectance", "1"},
    {Integral::bhr, "bhr", "bihemispherical reflectance", "1"},
    {Integral::brdf, "brdf", "BRDF f11, mean over source and receiver", "sr^-1"},
    {Integral::reflectance_factor, "reflectance_factor", "reflectance factor, pi x mean of f11", "1"},
    {Integral::radiance_factor, "radiance_factor", "radiance factor, pi x mean of f11", "1"},
    {Integral::reflectance, "reflectance", "reflected flux into the receiver per incident flux", "1"},
    {Integral::mueller, "mueller", "Mueller BRDF, mean over source and receiver, frame xy", "sr^-1"},
};

const Named& named(Integral quantity) {
  return *std::find_if(std::begin(quantities), std::end(quantities),
                       [&](const Named& q) { return q.quantity == quantity; });
}

/// The column of the polar angle; empty if there is none.
std::string theta_column(Integral quantity) {
  return quantity == Integral::dhr ? "theta_i_deg" : quantity == Integral::hdr ? "theta_r_deg" : "";
}

std::vector<std::string> value_columns(Integral quantity) {
  if (quantity != Integral::mueller) return {to_string(quantity)};
  std::vector<std::string> names;
  for (std::size_t element = 0; element < 16; ++element) names.push_back("f" + element_name(element));
  return names;
}

std::string csv(const Integrated& result) {
  std::string text = result.several_wavelengths ? "wavelength_nm," : "";
  const std::string theta = theta_column(result.quantity);
  text += theta.empty() ? "" : theta + ",";
  std::string names, u_names;
  for (const std::string& name : value_columns(result.quantity)) {
    names += (names.empty() ? "" : ",") + name;
    u_names += ",u_" + name;
  }
  const bool geometry = needs_geometry(result.quantity);
  text += names + u_names + (geometry ? ",quadrature_error,validity\n" : "\n");
  for (const IntegratedRow& row : result.rows) {
    text += result.several_wavelengths ? shortest(*row.wavelength_nm) + "," : "";
    text += row.theta_deg ? shortest(*row.theta_deg) + "," : "";
    for (std::size_t i = 0; i < row.values.size(); ++i) text += (i > 0 ? "," : "") + exact(row.values[i]);
    for (std::size_t i = 0; i < row.values.size(); ++i)
      text += "," + (row.uncertainties.empty() ? "" : exact(row.uncertainties[i]));
    text += geometry ? "," + format("%.1e", row.quadrature_error) + "," + to_string(row.outside) + "\n" : "\n";
  }
  return text;
}

// ---- JSON

nlohmann::ordered_json square(const std::vector<double>& elements) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (std::size_t row = 0; row < 4 && !elements.empty(); ++row)
    json.push_back(std::vector<double>(&elements[4 * row], &elements[4 * row] + 4));
  return elements.empty() ? nullptr : json;
}

nlohmann::ordered_json row_json(const Integrated& result, const IntegratedRow& row) {
  const std::string name = to_string(result.quantity), theta = theta_column(result.quantity);
  nlohmann::ordered_json json;
  json["wavelength_nm"] = row.wavelength_nm ? nlohmann::ordered_json(*row.wavelength_nm) : nullptr;
  if (row.theta_deg) json[theta] = *row.theta_deg;
  if (result.quantity == Integral::mueller) {
    json[name] = square(row.values);
    json["u_" + name] = square(row.uncertainties);
  } else {
    json[name] = row.values.front();
    json["u_" + name] = row.uncertainties.empty() ? nullptr : nlohmann::ordered_json(row.uncertainties.front());
  }
  if (needs_geometry(result.quantity)) {
    json["quadrature_error"] = row.quadrature_error;
    json["geometries"] = row.geometries;
  }
  json["validity"] = to_string(row.outside);
  return json;
}

nlohmann::ordered_json json_of(const Integrated& result) {
  nlohmann::ordered_json json;
  json["model"] = result.model;
  json["quantity"] = to_string(result.quantity);
  json["meaning"] = named(result.quantity).meaning;
  json["unit"] = named(result.quantity).unit;
  if (needs_geometry(result.quantity)) {
    json["source"] = result.source;
    json["receiver"] = result.receiver;
  } else if (result.quantity != Integral::bhr) {
    json["polarization"] = result.polarization;
  }
  if (result.extrapolated) json["extrapolated_share_of_hemisphere"] = *result.extrapolated;
  for (const IntegratedRow& row : result.rows) json["rows"].push_back(row_json(result, row));
  return json;
}

// ---- text

std::string uncertainty_text(const IntegratedRow& row, std::size_t i) {
  if (row.uncertainties.empty()) return "not known";
  const double u = row.uncertainties[i];
  return format("%.2g", u < 1e-15 ? 0 : u);  // of elements that are 0 by symmetry, rounding is left
}

std::string table(const Integrated& result) {
  const std::string name = to_string(result.quantity), theta = theta_column(result.quantity);
  const int width = std::max(12, static_cast<int>(name.size()) + 2);
  std::string text = "wavelength_nm" + (theta.empty() ? "" : format("%13s", theta.c_str())) +
                     format("%*s%*s  validity\n", width, name.c_str(), width + 2, ("u_" + name).c_str());
  for (const IntegratedRow& row : result.rows) {
    text += format("%13s", row.wavelength_nm ? brief(*row.wavelength_nm).c_str() : "unknown");
    text += row.theta_deg ? format("%13s", brief(*row.theta_deg).c_str()) : "";
    text += format("%*.6f%*s  ", width, row.values.front(), width + 2, uncertainty_text(row, 0).c_str()) +
            to_string(row.outside) + "\n";
  }
  return text;
}

std::string matrices(const Integrated& result) {
  std::string text;
  for (const IntegratedRow& row : result.rows) {
    text += "wavelength " + (row.wavelength_nm ? brief(*row.wavelength_nm) + " nm" : "unknown") +
            ", validity: " + to_string(row.outside) + "\n";
    for (std::size_t e = 0; e < 16; ++e) {
      const double value = std::abs(row.values[e]) < 5e-9 ? 0 : row.values[e];  // no -0.00000000
      text += format("%14.8f", value) + (e % 4 == 3 ? "\n" : "");
    }
    text += "standard uncertainties";
    for (std::size_t e = 0; e < 16 && !row.uncertainties.empty(); ++e)
      text += (e % 4 == 0 ? "\n" : "") + format("%14s", uncertainty_text(row, e).c_str());
    text += row.uncertainties.empty() ? " not known\n" : "\n";
  }
  return text;
}

std::string text_of(const Integrated& result) {
  const bool geometry = needs_geometry(result.quantity);
  std::string text = result.model + ": " + named(result.quantity).meaning;
  const std::string unit = named(result.quantity).unit;
  text += unit == "1" ? "" : " in " + unit;
  if (geometry)
    text += "\nsource      " + result.source + "\nreceiver    " + result.receiver + "\n";
  else
    text += (result.quantity == Integral::bhr ? "" : ", polarization " + result.polarization) + "\n";
  text += result.quantity == Integral::mueller ? matrices(result) : table(result);
  if (geometry) {
    double error = 0;
    long geometries = 0;
    for (const IntegratedRow& row : result.rows) {
      error = std::max(error, row.quadrature_error);
      geometries = std::max(geometries, row.geometries);
    }
    text += "quadrature: " + (geometries == 1 ? "1 geometry" : std::to_string(geometries) + " geometries") +
            format(", error below %.1e\n", error);
  }
  if (std::any_of(result.rows.begin(), result.rows.end(), [](const auto& row) { return !row.uncertainties.empty(); }))
    text += std::string("u: standard uncertainty of the fit ") +
            (result.has_instrument ? "and its instrument" : "alone") + "; scale, angles and sample are not in it\n";
  if (result.extrapolated) {
    text += format("extrapolated: %.1f %% of the hemisphere's projected solid angle lies beyond the fitted angles\n",
                   100 * *result.extrapolated);
  }
  return text;
}

}  // namespace

Integral quantity_from(const std::string& name) {
  std::vector<std::string> names;
  for (const Named& q : quantities) {
    if (q.name == name) return q.quantity;
    names.emplace_back(q.name);
  }
  throw std::invalid_argument("\"" + name + "\": expected one of " + joined(names));
}

std::string to_string(Integral quantity) { return named(quantity).name; }

bool needs_geometry(Integral quantity) {
  return quantity != Integral::dhr && quantity != Integral::hdr && quantity != Integral::bhr;
}

std::string written(const Integrated& result, Format format) {
  return format == Format::text ? text_of(result) : format == Format::csv ? csv(result) : printed(json_of(result));
}

}  // namespace mmbrdf::program
