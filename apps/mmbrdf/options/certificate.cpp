// SPDX-License-Identifier: BSD-3-Clause
#include "options/certificate.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/text/rounding.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"

namespace mmbrdf::program {

namespace {

/// "8:443:0.990+-0.004"
CertifiedReflectance typed(const std::string& text) {
  try {
    const std::size_t first = text.find(':'), second = text.find(':', first + 1), u = text.find("+-");
    if (second == std::string::npos) throw std::invalid_argument("two colons are needed");
    return {.wavelength = micrometres(number(text.substr(first + 1, second - first - 1))),
            .value = number(text.substr(second + 1, u == std::string::npos ? u : u - second - 1)),
            .uncertainty = u == std::string::npos ? 0 : number(text.substr(u + 2)),
            .theta = radians(number(text.substr(0, first)))};
  } catch (const std::invalid_argument&) {
    throw WrongUsage("--certificate", "\"" + text + "\": expected THETA:NM:R+-U, as in 8:443:0.990+-0.004, or a file");
  }
}

}  // namespace

std::vector<CertifiedReflectance> read_certificate(std::istream& in, const std::string& name) {
  using namespace std::string_view_literals;
  CsvReader reader(in, name);
  const int wavelength = reader.find(std::array{"wavelength_nm"sv}), value = reader.find(std::array{"reflectance"sv}),
            u = reader.find(std::array{"u_reflectance"sv, "u"sv}), theta = reader.find(std::array{"theta_i_deg"sv});
  for (const auto& [column, missing] :
       {std::pair(wavelength, "wavelength_nm"), {value, "reflectance"}, {u, "u_reflectance (nor u)"}})
    if (column < 0) throw reader.error(std::string("no column ") + missing);
  std::vector<CertifiedReflectance> result;
  while (reader.next())
    result.push_back({micrometres(reader.number(wavelength)), reader.number(value), reader.number(u),
                      radians(theta < 0 ? 8 : reader.number(theta))});
  return result;
}

namespace {

constexpr double no_reflectance = 2;  // not even with errors
constexpr const char* in_percent = ": is it in percent? It is a part of 1";

ReflectanceTable reflectance(const std::string& text, bool of_fit) {
  if (text.find(':') != std::string::npos || !std::filesystem::exists(text)) {
    ReflectanceTable typed = typed_reflectance(text);
    for (const double value : typed.values)
      if (value > no_reflectance) throw std::invalid_argument(shortest(value) + in_percent);
    return typed;
  }
  std::map<double, double> nodes;
  read_input(text, [&](std::istream& in, const std::string& name) {
    using namespace std::string_view_literals;
    CsvReader reader(in, name, ColumnNames{}, {"wavelength_nm", "reflectance", "u_reflectance"});
    const int wavelength = reader.find("wavelength_nm"sv), value = reader.find("reflectance"sv);
    if (wavelength < 0 || value < 0)
      throw reader.error(std::string("no column ") + (wavelength < 0 ? "wavelength_nm" : "reflectance"));
    if (const int u = std::max(reader.find("u_reflectance"sv), reader.find("u"sv)); u >= 0 && of_fit)
      note(name + ": " + reader.columns()[static_cast<std::size_t>(u)] +
           " does not count: f11 is divided by these reflectances, and multiplied by them again");
    else if (u >= 0)
      throw reader.error(
          "mmbrdf convert --certificate counts the uncertainty of a reflectance, --reflectance does not");
    while (reader.next()) {
      if (reader.number(value) > no_reflectance)
        throw reader.error("reflectance " + printable(reader.field(value), 40) + in_percent);
      if (!nodes.emplace(micrometres(reader.number(wavelength)), reader.number(value)).second)
        throw reader.error("this wavelength is given twice");
    }
  });
  ReflectanceTable table;
  for (const auto& [at, value] : nodes) table.wavelengths.push_back(at), table.values.push_back(value);
  require_valid(table);
  return table;
}

}  // namespace

ReflectanceTable reflectance_from(const std::string& text) { return reflectance(text, false); }
ReflectanceTable reflectance_of_fit(const std::string& text) { return reflectance(text, true); }

std::vector<CertifiedReflectance> certificate_from(const std::string& text, const Validity& validity) {
  std::vector<CertifiedReflectance> result;
  if (text.find(':') != std::string::npos) {
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) result.push_back(typed(part));
    return result;
  }
  read_input(text, [&](std::istream& in, const std::string& name) { result = read_certificate(in, name); });
  const auto left_out = std::erase_if(
      result, [&](const CertifiedReflectance& one) { return leaves_known_range(outside(validity, one.wavelength)); });
  if (left_out > 0)
    note(std::to_string(left_out) + " of " + std::to_string(result.size() + left_out) + " values of " +
         data_name(text) + " are left out: the model was fitted at " + nanometre_list(validity.wavelengths));
  return result;
}

}  // namespace mmbrdf::program
