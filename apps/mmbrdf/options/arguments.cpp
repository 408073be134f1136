// SPDX-License-Identifier: BSD-3-Clause
#include "options/arguments.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

namespace mmbrdf::program {

namespace {

template <class T>
bool read(const std::string& text, T& value) {
  const char* const end = text.data() + text.size();
  const char* const begin = text.data() + (text.starts_with('+') && !text.starts_with("+-") ? 1 : 0);
  const auto result = std::from_chars(begin, end, value);
  return result.ec == std::errc() && result.ptr == end;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return parts;
}

std::invalid_argument wrong(const std::string& text, const std::string& expected) {
  return std::invalid_argument("\"" + text + "\": expected " + expected);
}

/// A,B, both finite.
std::optional<std::pair<double, double>> two_numbers(const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  std::pair<double, double> values;
  if (parts.size() != 2 || !read(parts[0], values.first) || !read(parts[1], values.second) ||
      !std::isfinite(values.first) || !std::isfinite(values.second)) {
    return {};
  }
  return values;
}

}  // namespace

double number(const std::string& text) {
  double value = 0;
  if (!read(text, value) || !std::isfinite(value)) throw wrong(text, "a number");
  return value;
}

double positive_number(const std::string& text) {
  const double value = number(text);
  if (!(value > 0)) throw wrong(text, "a positive number");
  return value;
}

int whole_number(const std::string& text) {
  int value = 0;
  if (!read(text, value) || value < 0) throw wrong(text, "a whole number of 0 or more");
  return value;
}

int thread_count(const std::string& text) {
  constexpr int most = 1024;
  int value = 0;
  if (!read(text, value) || value < 0 || value > most)
    throw wrong(text, "a whole number from 0 to " + std::to_string(most));
  return value;
}

unsigned long seed(const std::string& text) {
  unsigned long value = 0;
  if (!read(text, value)) throw wrong(text, "a whole number of 0 or more");
  return value;
}

DirectionDegrees incident_degrees(const std::string& text) {
  const auto values = two_numbers(text);
  double theta = 0;
  if (!values && read(text, theta) && std::isfinite(theta)) return {theta, 0, false};
  if (!values) throw wrong(text, "THETA or THETA,PHI in degrees");
  return {values->first, values->second};
}

DirectionDegrees reflected_degrees(const std::string& text) {
  const auto values = two_numbers(text);
  double theta = 1;
  if (!values && read(text, theta) && theta == 0) return {0, 0, false};
  if (!values) throw wrong(text, "THETA,PHI in degrees, where PHI = phi_i + 180 is forward, or 0");
  return {values->first, values->second};
}

AnglesDegrees angles_degrees(const std::string& text) {
  const auto values = two_numbers(text);
  if (!values) throw wrong(text, "THETA_I,THETA_R in degrees");
  return {values->first, values->second};
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  for (const std::string& part : split(text, ',')) values.push_back(number(part));
  return values;
}

std::vector<double> range_from(const std::string& text) {
  const std::vector<std::string> parts = split(text, ':');
  std::array<double, 3> bounds{};
  bool good = parts.size() == bounds.size();
  for (std::size_t i = 0; good && i < bounds.size(); ++i) good = read(parts[i], bounds[i]) && std::isfinite(bounds[i]);
  const auto [from, to, step] = bounds;
  if (!good || !(step > 0) || to < from) throw wrong(text, "FROM:TO:STEP with a positive step, as in -60:60:1");
  constexpr double most = 100000, rounding = 1e-9;  // 0:1:0.1 has 11 values
  const double steps = std::floor((to - from) / step + rounding);
  if (!(steps < most)) throw wrong(text, "at most 100000 values");
  std::vector<double> values;
  for (double i = 0; i <= steps; ++i) values.push_back(from + i * step);
  return values;
}

Orders orders_from(const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  Orders orders;
  if (parts.size() != 2 || !read(parts[0], orders.f11) || !read(parts[1], orders.other))
    throw wrong(text, "two whole numbers, of f11 and of the other elements, as in 7,4");
  return orders;
}

ReflectanceTable typed_reflectance(const std::string& text) {
  std::map<double, double> nodes;
  for (const std::string& part : split(text, ',')) {
    const std::vector<std::string> pair = split(part, ':');
    double wavelength_nm = 0;
    double value = 0;
    if (pair.size() != 2 || !read(pair[0], wavelength_nm) || !read(pair[1], value) || !std::isfinite(wavelength_nm) ||
        !std::isfinite(value)) {
      throw wrong(part, "NM:REFLECTANCE, as in 532:0.984, or a file");
    }
    if (!nodes.emplace(wavelength_nm, value).second)
      throw std::invalid_argument("\"" + part + "\": this wavelength is given twice");
  }
  ReflectanceTable table;
  for (const auto& [wavelength_nm, value] : nodes) {
    table.wavelengths.push_back(wavelength_nm / 1000);
    table.values.push_back(value);
  }
  return table;
}

namespace {

/// A number followed by a unit.
double measured(const std::string& text, std::string_view unit, const std::string& whole) {
  double value = 0;
  if (!text.ends_with(unit) || !read(text.substr(0, text.size() - unit.size()), value) ||
      !(value >= 0 && std::isfinite(value)))
    throw wrong(whole, "scale=0.3%, source=0.5deg or receiver=0.5deg");
  return value;
}

}  // namespace

DeclaredErrors declared_from(const std::string& text) {
  DeclaredErrors declared;
  std::set<std::string> given;
  for (const std::string& part : split(text, ',')) {
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string name = part.substr(0, equals), value = part.substr(std::min(equals + 1, part.size()));
    if (!given.insert(name).second) throw std::invalid_argument("\"" + part + "\": this error is given twice");
    if (name == "scale")
      declared.scale = value.ends_with('%') ? measured(value, "%", part) / 100 : measured(value, "", part);
    else if (name == "source" || name == "receiver")
      (name == "source" ? declared.source : declared.receiver) = radians(measured(value, "deg", part));
    else
      throw wrong(part, "scale=0.3%, source=0.5deg or receiver=0.5deg");
  }
  if (declared.scale > 1) throw std::invalid_argument("scale=" + shortest(declared.scale) + " is above 1, or 100 %");
  if (std::max(declared.source, declared.receiver) > radians(10))
    throw std::invalid_argument("an arm that is out by more than 10 degrees measures something else");
  return declared;
}

Grid grid_from(const std::string& text) {
  if (text == "germer2017") return {};
  const std::string prefix = "random:";
  if (!text.starts_with(prefix)) throw std::invalid_argument("\"" + text + "\": expected germer2017 or random:N");
  const int count = whole_number(text.substr(prefix.size()));
  if (count == 0) throw std::invalid_argument("\"" + text + "\": expected at least 1");
  return {count};
}

Format format_from(const std::string& name) {
  if (name == "text") return Format::text;
  if (name == "csv") return Format::csv;
  if (name == "json") return Format::json;
  if (name == "html") return Format::html;
  throw wrong(name, "text, csv, json or html");
}

Format format_without_csv(const std::string& name) {
  if (name != "text" && name != "json" && name != "html") throw wrong(name, "text, json or html");
  return format_from(name);
}

double micrometres(double wavelength_nm) {
  if (!(wavelength_nm > 0))
    throw std::invalid_argument("wavelength " + shortest(wavelength_nm) + " nm: must be positive");
  return wavelength_nm / 1000;
}

std::vector<double> micrometres(const std::vector<double>& wavelengths_nm) {
  std::vector<double> result;
  result.reserve(wavelengths_nm.size());
  for (const double wavelength_nm : wavelengths_nm) result.push_back(micrometres(wavelength_nm));
  return result;
}

double wavelength_from(const std::optional<double>& wavelength_nm, const Model& model) {
  if (wavelength_nm) return micrometres(*wavelength_nm);
  try {
    return only_wavelength(model);
  } catch (const std::invalid_argument& error) {
    throw WrongUsage("--wavelength is required", error.what());
  }
}

std::vector<Geometry> geometries(const Grid& grid, unsigned long seed) {
  return grid.random > 0 ? random_geometries(grid.random, seed) : germer2017_grid();
}

Direction direction_from(const DirectionDegrees& degrees, const std::string& option) {
  try {
    return direction_from_degrees(degrees.theta, degrees.phi);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(option + " " + error.what());
  }
}

void add_basis_option(CLI::App& app, Basis& basis) {
  add_option(app, "--basis", basis.family, family_from, "NAME", "isotropic, germer2017 or anisotropic [isotropic]");
  add_option(app, "--orders", basis.orders, orders_from, "N,M",
             "Highest radial order of f11 and of the other elements [7,4]");
}

}  // namespace mmbrdf::program
