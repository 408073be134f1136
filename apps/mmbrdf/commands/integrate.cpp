// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf integrate

#include "pages/integrate.hpp"
#include "pages/describe.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "command.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "options/question.hpp"
#include "options/sides.hpp"
#include "options/terms.hpp"
#include "pages/describe.hpp"

namespace mmbrdf::program {

namespace {

constexpr double source_phi_deg = 0, receiver_phi_deg = 180;

/// Incident light, or what an analyzer passes, in the sp frame.
struct Polarization {
  std::string text = "unpolarized";
  Stokes light{1, 0, 0, 0};
};

Polarization polarization_from(const std::string& text) {
  if (text == "unpolarized") return {};
  if (text == "s" || text == "p") return {text, {1, text == "s" ? 1.0 : -1.0, 0, 0}};
  std::vector<double> s;
  try {
    s = numbers(text);
  } catch (const std::invalid_argument&) {
    s.clear();
  }
  if (s.size() != 4) throw std::invalid_argument("\"" + text + "\": expected unpolarized, s, p or S1,S2,S3,S4");
  return {text, {s[0], s[1], s[2], s[3]}};
}

struct Options {
  std::string model, output;
  std::optional<Integral> quantity;
  std::optional<std::vector<double>> wavelengths_nm, thetas_deg;
  std::optional<Polarization> polarization;
  std::optional<Sides> geometry;
  std::optional<double> tolerance;
  Terms terms;
  Format format = Format::text;
  bool strict = false;
};

constexpr int few_nodes = 2;        // of a rule whose nodes lie all over the apertures
constexpr int nodes_of_shares = 6;  // of one that tells a twentieth

/// What belongs to one wavelength.
struct AtWavelength {
  const Model& model;
  double wavelength;
  std::optional<UncertainModel> uncertain;  // none: not known
};

std::optional<UncertainModel> prepared_of(const Model& model, double wavelength, const Terms& terms) {
  return knows_uncertainty(model) ? std::optional(uncertain(model, wavelength, terms_from(terms))) : std::nullopt;
}

/// Without a budget where something that was not measured has a part in it.
void add_uncertainty(IntegratedRow& row, std::vector<Contribution> parts) {
  const double u = standard_uncertainty(parts);
  row.uncertainties.push_back(u);
  row.budgets.push_back(std::isnan(u) ? ExpandedUncertainty{{}, u} : expanded(std::move(parts)));
}

/// Of two apertures, whose largest polar angles make up `extreme`: much of them must be supported, as far as they are
/// within the fitted angles.
Outside outside_apertures(const Validity& validity, double wavelength, const Aperture& source, const Aperture& receiver,
                          const Geometry& extreme) {
  unsigned result = outside(validity, wavelength, extreme) & ~static_cast<unsigned>(outside_directions);
  if (validity.supported.empty()) return static_cast<Outside>(result);
  double all = 0, missing = 0;
  for (const auto& [geometry, weight] : mean_rule(source, receiver, nodes_of_shares)) {
    const Outside where = outside(validity, wavelength, geometry);
    if (!(where & (outside_theta_i | outside_theta_r))) all += std::abs(weight);
    if (where & outside_directions) missing += std::abs(weight);
  }
  if (missing > much_unsupported * all) result |= outside_directions;
  return static_cast<Outside>(result);
}

/// Of dhr and hdr.
IntegratedRow hemispherical_row(const AtWavelength& at, Integral quantity, double theta_deg, const Polarization& p) {
  const Direction beam = direction_from({theta_deg, 0}, "--theta");
  const bool dhr = quantity == Integral::dhr, unpolarized = p.light == Stokes{1, 0, 0, 0};
  IntegratedRow row;
  row.theta_deg = theta_deg;
  const Aperture one = Aperture::direction(beam), hemisphere = Aperture::hemisphere();
  row.outside = dhr ? outside_apertures(at.model.validity, at.wavelength, one, hemisphere, {beam, {}})
                    : outside_apertures(at.model.validity, at.wavelength, hemisphere, one, {{}, beam});
  if (unpolarized) {  // the closed forms
    row.values = {directional_hemispherical_reflectance(at.model, at.wavelength, beam)};
  } else {
    row.values = {dhr ? directional_hemispherical_reflectance(at.model, at.wavelength, beam, p.light)
                      : hemispherical_directional_reflectance(at.model, at.wavelength, beam, p.light)};
  }
  if (at.uncertain)
    add_uncertainty(row, dhr ? directional_hemispherical_budget(*at.uncertain, beam, p.light)
                             : hemispherical_directional_budget(*at.uncertain, beam, p.light));
  return row;
}

IntegratedRow bihemispherical_row(const AtWavelength& at) {
  IntegratedRow row;
  row.outside = outside(at.model.validity, at.wavelength);
  if (unsupported_share(at.model.validity, at.wavelength) > much_unsupported)
    row.outside = static_cast<Outside>(row.outside | outside_directions);
  row.values = {bihemispherical_reflectance(at.model, at.wavelength)};
  if (at.uncertain) add_uncertainty(row, bihemispherical_budget(*at.uncertain));
  return row;
}

/// What the mean of f11 is multiplied by.
double factor_of(Integral quantity, const Aperture& receiver) {
  switch (quantity) {
    case Integral::reflectance_factor:
    case Integral::radiance_factor:
      return std::numbers::pi;
    case Integral::reflectance:
      if (receiver.projected_solid_angle() == 0)
        throw std::invalid_argument("reflectance: the receiver has no solid angle");
      return receiver.projected_solid_angle();
    default:
      return 1;
  }
}

IntegratedRow average_row(const AtWavelength& at, Integral quantity, const Sides& sides, const Options& options) {
  const Aperture source = aperture_of(sides.source, source_phi_deg);
  const Aperture receiver = aperture_of(sides.receiver, receiver_phi_deg);
  const double factor = factor_of(quantity, receiver);
  const double theta_i = is_hemisphere(sides.source) ? 0 : source.largest_theta();
  const double theta_r = is_hemisphere(sides.receiver) ? 0 : receiver.largest_theta();
  AverageOptions rule;
  rule.tolerance = options.tolerance.value_or(rule.tolerance);
  const PreparedModel model = prepare(at.model, at.wavelength);
  const Average mean = average(model, source, receiver, rule);
  if (!mean.converged) {
    const std::string message =
        format("the quadrature stopped at an error of %.1e of f11", mean.error / mean.mueller(0, 0));
    if (options.strict) throw std::runtime_error(message);
    warn(message);
  }
  IntegratedRow row;
  row.outside = outside_apertures(at.model.validity, at.wavelength, source, receiver, {{theta_i, 0}, {theta_r, 0}});
  row.quadrature_error = factor * mean.error;
  row.geometries = mean.geometries;
  const std::size_t elements = quantity == Integral::mueller ? 16 : 1;
  for (std::size_t e = 0; e < elements; ++e) row.values.push_back(factor * mean.mueller.elements[e]);
  if (at.uncertain) {
    const int few = average(model, source, receiver, {.tolerance = 1e-3}).nodes;  // digits that u needs
    const Budget budget = average_budget(*at.uncertain, source, receiver, few);
    for (std::size_t e = 0; e < elements; ++e) {
      Mueller slope;
      slope.elements[e] = factor;
      add_uncertainty(row, contributions(budget, slope));
    }
  }
  return row;
}

/// Share of the projected solid angle of the hemispheres beyond the fitted angles; none if that is unknown, or there is
/// no hemisphere.
std::optional<double> extrapolated_share(const Validity& validity, bool source, bool receiver) {
  double within = 1;
  for (const auto& [used, limit] :
       {std::pair(source, validity.theta_i_max), std::pair(receiver, validity.theta_r_max)}) {
    if (used && !limit) return {};
    within *= used ? std::pow(std::sin(*limit), 2) : 1;
  }
  return source || receiver ? std::optional(1 - within) : std::nullopt;
}

std::vector<IntegratedRow> rows_of(const AtWavelength& at, Integral quantity, const Options& options) {
  if (needs_geometry(quantity)) return {average_row(at, quantity, *options.geometry, options)};
  if (quantity == Integral::bhr) return {bihemispherical_row(at)};
  std::vector<IntegratedRow> rows;
  for (const double theta_deg : options.thetas_deg.value_or(std::vector<double>{0}))
    rows.push_back(hemispherical_row(at, quantity, theta_deg, options.polarization.value_or(Polarization{})));
  return rows;
}

/// Throws where an option does not belong to the quantity.
Integral checked_quantity(const Options& options) {
  if (!options.quantity && !options.geometry) throw missing("--quantity (or --geometry)");
  const Integral quantity = options.quantity.value_or(Integral::reflectance_factor);
  const std::string name = "of --quantity " + to_string(quantity);
  const bool of_beam = quantity == Integral::dhr || quantity == Integral::hdr;
  const auto forbid = [&](bool given, const std::string& option) {
    if (given) throw WrongUsage(option, "is no option " + name);
  };
  if (needs_geometry(quantity) && !options.geometry) throw missing("--geometry " + name);
  forbid(!needs_geometry(quantity) && options.geometry, "--geometry");
  forbid(!needs_geometry(quantity) && options.tolerance, "--tolerance");
  forbid(!of_beam && options.thetas_deg, "--theta");
  forbid(!of_beam && options.polarization, "--polarization");
  return quantity;
}

std::vector<double> wavelengths_of(const Model& model, const Options& options) {
  return options.wavelengths_nm ? micrometres(*options.wavelengths_nm) : std::vector{wavelength_from({}, model)};
}

/// Warns of rows outside the fitted range, or refuses them.
void check_range(const Integrated& result, const Validity& validity, bool strict) {
  RangeCount range;
  for (const IntegratedRow& row : result.rows) range.add(row.outside);
  if (strict && range.outside > 0) throw std::runtime_error(outside_line(range.reasons, validity));
  warn_if_outside(result.model, range.reasons, validity);
}

Integrated integrated(const Model& model, Integral quantity, const Options& options) {
  Integrated result;
  result.model = base_name(options.model);
  result.quantity = quantity;
  result.uncertain = uncertain_of(model);
  result.not_in_it = missing_from_uncertainty(model);
  for (const TypeBTerm& term : terms_from(options.terms)) result.terms.push_back(term.name);
  result.coverage = options.terms.coverage;
  result.polarization = options.polarization.value_or(Polarization{}).text;
  if (options.geometry) {
    result.source = description(options.geometry->source, source_phi_deg);
    result.receiver = description(options.geometry->receiver, receiver_phi_deg);
  }
  const bool hemisphere_i = options.geometry ? is_hemisphere(options.geometry->source) : quantity != Integral::dhr;
  const bool hemisphere_r = options.geometry ? is_hemisphere(options.geometry->receiver) : quantity != Integral::hdr;
  result.extrapolated = extrapolated_share(model.validity, hemisphere_i, hemisphere_r);
  const std::vector<double> wavelengths = wavelengths_of(model, options);
  result.several_wavelengths = wavelengths.size() > 1;
  for (const double wavelength : wavelengths) {
    for (IntegratedRow& row :
         rows_of({model, wavelength, prepared_of(model, wavelength, options.terms)}, quantity, options)) {
      if (!options.terms.budget) row.budgets.clear();
      if (options.wavelengths_nm || knows_wavelength(model)) row.wavelength_nm = nanometres(wavelength);
      result.rows.push_back(std::move(row));
    }
  }
  return result;
}

/// Whether the data of the fit determine the model all over the directions of a quantity, as far as that is known.
bool determined(const Model& model, Integral quantity, const Options& options) {
  std::vector<std::pair<Aperture, Aperture>> pairs;
  if (options.geometry) {
    pairs.emplace_back(aperture_of(options.geometry->source, source_phi_deg),
                       aperture_of(options.geometry->receiver, receiver_phi_deg));
  } else if (quantity == Integral::bhr) {
    pairs.emplace_back(Aperture::hemisphere(), Aperture::hemisphere());
  } else {
    for (const double theta_deg : options.thetas_deg.value_or(std::vector<double>{0}))
      pairs.emplace_back(Aperture::direction({radians(std::abs(theta_deg)), 0}), Aperture::hemisphere());
  }
  const double wavelength = wavelengths_of(model, options).front();  // the rank of a fit is one for all
  if (!knows_uncertainty(model)) return true;
  const PreparedUncertainty prepared = prepare_uncertainty(model, wavelength);
  return std::all_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
    const std::vector<WeightedGeometry> nodes = mean_rule(pair.first, pair.second, few_nodes);
    return std::all_of(nodes.begin(), nodes.end(),
                       [&](const WeightedGeometry& node) { return prepared.estimable(node.geometry); });
  });
}

void check_determined(const Model& model, Integral quantity, const Options& options) {
  if (determined(model, quantity, options)) return;
  const std::string message =
      "the data of the fit do not determine the model in these directions: values are those of its smallest solution, "
      "and uncertainties are too small";
  if (options.strict) throw std::runtime_error(message);
  warn(message);
}

void integrate(const Options& options) {
  const Integral quantity = checked_quantity(options);
  if (options.terms.budget && options.format == Format::csv) throw WrongUsage("--budget", "goes with text or json");
  require_model_kept(options.model, options.output);
  const Model model = open_model(options.model);
  const Integrated result = integrated(model, quantity, options);
  check_range(result, model.validity, options.strict);
  check_determined(model, quantity, options);
  warn_if_above_one(model, wavelengths_of(model, options));
  if (!knows_uncertainty(model)) warn(result.model + " has no covariance: uncertainties are not known");
  write_text(options.output, written(result, options.format));
}

const std::string footer =
    std::string(
        "Reflectances of the whole hemisphere: dhr (directional-hemispherical), hdr (hemispherical-directional, the\n"
        "source uniform and unpolarized), bhr (bihemispherical). Of a source and a receiver, means weighted with\n"
        "projected solid angle on both sides: brdf (f11, sr^-1), reflectance_factor and radiance_factor (pi f11),\n"
        "reflectance (flux into the receiver per incident flux), mueller (all elements, frame xy).\n"
        "\n") +
    sides_help +
    "\n"
    "u_ columns are standard uncertainties of the model and of the terms, empty where the model has no covariance. "
    "The\n"
    "effect of a term on an integral is the integral of its effect: one error for all directions. A hemisphere\n"
    "always reaches beyond the fitted angles: it is not flagged for that, the share beyond is told. The CSV of dhr, "
    "hdr\n"
    "and bhr has no column validity: use --strict.\n"
    "\n" +
    terms_help +
    "\n"
    "Examples:\n"
    "  mmbrdf integrate ptfe --quantity dhr --wavelength 532 --theta 0,8,45,60,75 --format csv\n"
    "  mmbrdf integrate ptfe --wavelength 532 --geometry 0:45\n"
    "  mmbrdf integrate ptfe -q dhr -w 532 --theta 8 --term scale=0.3% --budget\n"
    "  mmbrdf integrate ptfe --wavelength 532 --geometry 'cone(8,0,1):d-cone(8,180,4)' --quantity reflectance";

}  // namespace

Run integrate_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_model(app, o->model);
  add_option(app, "-q,--quantity", o->quantity, quantity_from, "QUANTITY",
             "dhr, hdr, bhr, brdf, reflectance_factor, radiance_factor,\nreflectance or mueller [reflectance_factor]");
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]",
             "Wavelengths in nm; not needed for models of one wavelength");
  add_option(app, "-g,--geometry", o->geometry, sides_from, "SOURCE:RECEIVER", "As in 0:45, 45a:0 or 8:d; see below");
  add_option(app, "--theta", o->thetas_deg, numbers, "T[,T...]",
             "Of dhr and hdr: polar angles of the beam, in degrees [0]");
  add_option(app, "--polarization", o->polarization, polarization_from, "P",
             "Of dhr the incident light, of hdr what an analyzer passes:\nunpolarized, s, p or S1,S2,S3,S4, frame sp "
             "[unpolarized]");
  add_option(app, "--tolerance", o->tolerance, number, "T", "Of the quadrature, relative [1e-10]");
  add_terms(app, o->terms);
  add_flag(app, "--strict", o->strict, "Refuse what lies outside the fitted range");
  add_option(app, "--format", o->format, format_from, "FORMAT", "text, csv, json or html [text]");
  add_file(app, "-o,--output", o->output, "OUT", "Where the result goes; - is standard output [-]");
  set_footer(app, footer);
  return [o] { integrate(*o); };
}

}  // namespace mmbrdf::program
