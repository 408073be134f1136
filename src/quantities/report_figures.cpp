// SPDX-License-Identifier: BSD-3-Clause
// Which pictures stand in a report. Part of report.hpp.

#include <algorithm>

#include "mmbrdf/text/rounding.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "quantities/report_blocks.hpp"

namespace mmbrdf {
namespace {

constexpr std::size_t most_columns = 4;
constexpr double half_page = 8, page = 17, large = 13;  // cm

/// All of them, or so many from the first to the last.
std::vector<double> some_of(const std::vector<double>& all, std::size_t most) {
  if (all.size() <= most) return all;
  std::vector<double> result;
  for (std::size_t i = 0; i < most; ++i) result.push_back(all[i * (all.size() - 1) / (most - 1)]);
  return result;
}

/// The wavelength for pictures that show one.
std::vector<double> middle_of(const std::vector<double>& all) {
  if (all.empty()) return {};
  return {all[(all.size() - 1) / 2]};
}

Json wavelength_argument(const std::vector<double>& nm, bool list) {
  return nm.empty() ? Json(nullptr) : list ? Json(nm) : Json(nm.front());
}

std::string listed(const std::vector<double>& nm) {
  std::string text;
  for (const double one : nm) text += (text.empty() ? "" : ", ") + shortest(one);
  return text.empty() ? "" : text + " nm";
}

/// ", 532 nm, theta_i 45 degrees, phi_i 180 degrees"
std::string place_of(const Drawn& drawn, const std::vector<double>& nm, double theta_i_deg) {
  return (nm.empty() ? "" : ", " + listed(nm)) + ", theta_i " + shortest(theta_i_deg) + " degrees, phi_i " +
         shortest(drawn.phi_i_deg) + " degrees";
}

/// As one would type it in a shell.
std::string plot_command(const Drawn& drawn, const std::string& kind, const Json& arguments, bool of_data) {
  std::string text = "mmbrdf plot " + kind + " " + drawn.origin.model + (of_data ? " " + drawn.origin.data : "");
  const auto values = [](const Json& value) {
    std::string words;
    for (const Json& one : value.is_array() ? value : Json::array({value})) words += " " + shortest(one.get<double>());
    return words;
  };
  for (const auto& [name, value] : arguments.items()) {
    if (value.is_null()) continue;
    if (name == "terms") {
      for (const auto& [error, u] : value.items()) text += " --term " + error + "=" + shortest(u.get<double>());
      continue;
    }
    text += (name == "wavelength_nm" ? " -w"
             : name == "theta_i_deg" ? " -i"
             : name == "phi_i_deg"   ? " --phi-i"
                                     : " --" + name) +
            values(value);
  }
  return text;
}

struct Picture {
  std::string kind, caption;
  Json arguments;
  double width_cm;
  bool of_data = false;
};

void add_picture(Document& document, const Drawn& drawn, const Picture& one) {
  document.figure(one.caption, one.kind, one.arguments, plot_command(drawn, one.kind, one.arguments, one.of_data),
                  one.of_data, one.width_cm);
}

Json at_source(const Drawn& drawn, const Json& wavelength, double theta_i_deg) {
  return {{"wavelength_nm", wavelength}, {"theta_i_deg", theta_i_deg}, {"phi_i_deg", drawn.phi_i_deg}};
}

bool measures(const Model& model, std::initializer_list<int> elements) {
  return std::ranges::none_of(elements, [&](int e) { return model.not_measured[static_cast<std::size_t>(e)]; });
}

}  // namespace

void add_reflectance_figures(Document& document, const Drawn& drawn) {
  const std::vector<double> nm = some_of(drawn.wavelengths, most_columns);
  const std::string at = nm.empty() ? "" : ", " + listed(nm),
                    bands = knows_uncertainty(drawn.model) ? ", bands k = 2" : "";
  Json arguments{{"wavelength_nm", wavelength_argument(nm, nm.size() > 1)}};
  if (!drawn.terms.empty()) arguments["terms"] = drawn.terms;
  add_picture(
      document, drawn,
      {"reflectance-against-angle", "DHR against the angle of incidence" + at + bands + ".", arguments, half_page});
  add_picture(document, drawn,
              {"reflectance-factor", "Reflectance factor towards the normal, R(theta_i:0°)" + at + bands + ".",
               arguments, half_page});
}

void add_model_figures(Document& document, const Drawn& drawn) {
  const std::vector<double> one = middle_of(drawn.wavelengths), some = some_of(drawn.wavelengths, most_columns);
  const double theta = drawn.theta_i_deg;
  const std::string bands = !knows_uncertainty(drawn.model) ? ""
                            : drawn.terms.empty()           ? ", bands k = 2"
                                                            : ", bands k = 2 without terms";
  const bool curves = measures(drawn.model, {1, 4, 5}), all = drawn.model.not_measured.none();
  if (some.size() > 1) {
    const bool few = some.size() < drawn.wavelengths.size();
    const std::string rows = "f11" + std::string(all ? ", depolarization parameter" : "") +
                             (curves ? " and BRDF between linear polarizations in the plane of incidence" : "");
    add_picture(document, drawn,
                {"by-wavelength",
                 "The model from wavelength to wavelength" + std::string(few ? ", some of them: " : ": ") + rows +
                     bands + place_of(drawn, some, theta) + ".",
                 at_source(drawn, some, theta), page});
  }
  const Json where = at_source(drawn, wavelength_argument(one, false), theta);
  add_picture(document, drawn,
              {"hemisphere",
               "The model over the hemisphere of reflected directions: f11, and the other elements divided by it" +
                   place_of(drawn, one, theta) + ".",
               where, large});
  if (curves && some.size() < 2)
    add_picture(
        document, drawn,
        {"in-plane-curves",
         "BRDF between linear polarizations in the plane of incidence" + bands + place_of(drawn, one, theta) + ".",
         where, half_page});
  if (all)
    add_picture(document, drawn,
                {"realizability-map",
                 "Smallest coherency eigenvalue over f11: a matrix where it is negative cannot exist" +
                     place_of(drawn, one, theta) + ".",
                 where, half_page});
}

void add_residual_figures(Document& document, const Drawn& drawn, const Json& directions) {
  const std::vector<double> measured = directions["wavelengths_nm"];
  const std::vector<double> some = some_of(measured, most_columns), one = middle_of(measured);
  add_picture(document, drawn,
              {"residuals",
               "Residuals of all samples" + (measured.size() > 1 ? ", " + listed(some) : std::string()) +
                   " against the polar angle of detection, forward positive: f11 relative to the model, and rms of the "
                   "other elements.",
               {{"wavelength_nm", some}},
               page,
               true});
  if (!directions["grid"].get<bool>()) return;
  for (const Json& theta : directions["theta_i_deg"])
    add_picture(document, drawn,
                {"residual-map", "Samples less the model, element by element" + place_of(drawn, one, theta) + ".",
                 at_source(drawn, wavelength_argument(one, false), theta), large, true});
}

void add_coefficient_figures(Document& document, const Drawn& drawn) {
  document.heading("Coefficients");
  const int powers = drawn.model.powers;
  for (int power = 0; power <= powers; ++power)
    add_picture(
        document, drawn,
        {"coefficient-spectrum",
         "Coefficients" +
             (powers > 0 ? " that multiply the wavelength in µm to the power " + std::to_string(power) : "") + ".",
         powers > 0 ? Json{{"power", power}} : Json::object(), page});
}

}  // namespace mmbrdf
