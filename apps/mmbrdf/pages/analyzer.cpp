// SPDX-License-Identifier: BSD-3-Clause
#include "pages/analyzer.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <stdexcept>
#include <utility>

#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

/// Draws of several wavelengths are kept while they are not more than some 160 MB.
std::size_t wavelengths_to_keep(int draws) {
  return draws > 0 ? static_cast<std::size_t>(std::clamp(20000 / draws, 1, 16)) : 16;
}

std::string why_uncertainty_is_unknown(const Model& model) {
  try {
    prepare_uncertainty(model, 1);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

void require_inside(Outside outside, const Validity& validity) {
  if (leaves_known_range(outside)) {
    throw std::invalid_argument("outside the fitted range (" + to_string(outside) +
                                "), refused by --strict: fitted are " + fitted_range(validity));
  }
  if (outside != inside) throw std::invalid_argument("the fitted range is not known, refused by --strict");
}

void append(std::string& text, const std::optional<double>& value) {
  text += ',';
  if (value) append_exact(text, *value);
}

/// A quantity of a matrix in the sp frame; of incident light, too.
struct Definition {
  const char* name;
  double (*value)(const Mueller& m, const Stokes& light);
  Mueller (*gradient)(const Mueller& m, const Stokes& light);
  bool linear = false;
};
using M = const Mueller&;
using S = const Stokes&;

/// In the order of the columns; the last one only with light.
constexpr Definition definitions[] = {
    {"depolarization", [](M m, S) { return depolarization(m); }, [](M m, S) { return depolarization_gradient(m); }},
    {"f_ss", [](M m, S) { return co_and_cross_polarized(m).ss; },
     [](M, S) { return co_and_cross_polarized_gradients().ss; }, true},
    {"f_sp", [](M m, S) { return co_and_cross_polarized(m).sp; },
     [](M, S) { return co_and_cross_polarized_gradients().sp; }, true},
    {"f_ps", [](M m, S) { return co_and_cross_polarized(m).ps; },
     [](M, S) { return co_and_cross_polarized_gradients().ps; }, true},
    {"f_pp", [](M m, S) { return co_and_cross_polarized(m).pp; },
     [](M, S) { return co_and_cross_polarized_gradients().pp; }, true},
    {"diattenuation", [](M m, S) { return diattenuation(m); }, [](M m, S) { return diattenuation_gradient(m); }},
    {"polarizance", [](M m, S) { return polarizance(m); }, [](M m, S) { return polarizance_gradient(m); }},
    {"eigenvalue_min", [](M m, S) { return realizability_margin(m); },
     [](M m, S) { return realizability_margin_gradient(m); }},
    {"purity", [](M m, S) { return purity(m); }, [](M m, S) { return purity_gradient(m); }},
    {"entropy", [](M m, S) { return entropy(m); }, [](M m, S) { return entropy_gradient(m); }},
    {"degree_of_polarization", [](M m, S s) { return degree_of_polarization(m, s); },
     [](M m, S s) { return degree_of_polarization_gradient(m, s); }}};

std::span<const Definition> definitions_for(const AnalysisOptions& options) {
  return std::span(definitions).first(std::size(definitions) - (options.light ? 0 : 1));
}

bool has_interval(const Definition& definition, const AnalysisOptions& options) {
  return options.draws > 0 && !definition.linear;
}

/// Value and uncertainty in first order; neither where f11 is not positive.
Quantity in_first_order(const Definition& definition, const Mueller& m, const Stokes& light,
                        const std::optional<Budget>& budget) {
  Quantity quantity{.name = definition.name};
  try {
    quantity.value = definition.value(m, light);
    if (budget) quantity.uncertainty = standard_uncertainty(definition.gradient(m, light), budget->total);
  } catch (const std::invalid_argument&) {
    return {.name = definition.name};
  }
  return quantity;
}

/// Instead of the uncertainty in first order that of draws, or none, where the quantity has no meaning in one of them.
void set_distribution(Quantity& quantity, const Definition& definition, const std::vector<Mueller>& drawn,
                      const Stokes& light) {
  std::vector<double> values;
  values.reserve(drawn.size());
  quantity.uncertainty.reset();
  try {
    for (const Mueller& m : drawn) values.push_back(definition.value(m, light));
  } catch (const std::invalid_argument&) {
    return;
  }
  const Distribution d = distribution(values);
  quantity.uncertainty = d.standard_deviation;
  quantity.low = d.low;
  quantity.high = d.high;
}

}  // namespace

Analyzer::Analyzer(const Model& model, AnalysisOptions options)
    : model_(model),
      options_(std::move(options)),
      unknown_uncertainty_(why_uncertainty_is_unknown(model)),
      wavelengths_([this](double wavelength) { return prepared(wavelength); }, wavelengths_to_keep(options_.draws)) {
  require_semidefinite(model);
  if (options_.draws > 0 && unknown_uncertainty_.empty()) draws_.emplace(model, options_.draws, options_.seed);
}

Analyzer::AtWavelength Analyzer::prepared(double wavelength) const {
  AtWavelength result{prepare(model_, wavelength), std::nullopt, {}};
  if (unknown_uncertainty_.empty()) result.uncertainty = prepare_uncertainty(model_, wavelength);
  if (draws_) result.draws = draws_->at(wavelength);
  return result;
}

/// The Stokes vector of the light in the s and p axes of the incident beam.
Stokes Analyzer::light_sp(const Geometry& geometry) const {
  const double turn = angles_to_xy(geometry, options_.frame).incident - angles_to_xy(geometry, Frame::sp).incident;
  return rotator(turn) * options_.light.value_or(Stokes{1, 0, 0, 0});
}

std::optional<Budget> Analyzer::budget_of(const AtWavelength& at, const Geometry& geometry) const {
  const bool grazing = std::cos(geometry.reflected.theta) < grazing_limit;
  for (const TypeBTerm& term : options_.terms)
    if (term.what == ErrorOf::theta_r && grazing) return std::nullopt;  // it has no limit there
  return at.uncertainty ? std::optional(budget(at.model, *at.uncertainty, options_.terms, geometry, Frame::sp))
                        : std::nullopt;
}

std::vector<Quantity> Analyzer::quantities(const AtWavelength& at, const Geometry& geometry,
                                           const Analysis& analysis) const {
  const Stokes light = light_sp(geometry);
  std::vector<Mueller> matrices;
  if (draws_ && analysis.budget)
    matrices = drawn(at.draws, at.model, options_.terms, geometry, Frame::sp, options_.seed);
  std::vector<Quantity> result;
  for (const Definition& definition : definitions_for(options_)) {
    Quantity& quantity = result.emplace_back(in_first_order(definition, analysis.elements_sp, light, analysis.budget));
    quantity.has_interval = has_interval(definition, options_);
    if (quantity.value && quantity.has_interval && !matrices.empty())
      set_distribution(quantity, definition, matrices, light);
  }
  return result;
}

Analysis Analyzer::at(double wavelength, const Geometry& geometry) {
  const AtWavelength& at = wavelengths_.at(wavelength);
  Analysis a;
  a.elements = at.model.evaluate(geometry, options_.frame);
  a.elements_sp = at.model.evaluate(geometry, Frame::sp);
  a.outside = at.model.outside(geometry);
  if (options_.strict) require_inside(a.outside, model_.validity);
  a.budget = budget_of(at, geometry);
  if (a.budget)
    a.uncertainties = standard_uncertainty(change_frame(a.budget->total, geometry, Frame::sp, options_.frame));
  if (at.uncertainty) a.estimable = at.uncertainty->estimable(geometry);
  a.realizable = a.elements(0, 0) > 0 && realizable(a.elements);
  a.quantities = quantities(at, geometry, a);
  return a;
}

std::string Analyzer::columns() const {
  std::string text = element_columns(false) + ",validity";
  for (std::size_t element = 0; element < 16; ++element) text += ",u_f" + element_name(element);
  for (const Definition& definition : definitions_for(options_)) {
    const std::string name = definition.name;
    text += "," + name + ",u_" + name;
    text += has_interval(definition, options_) ? "," + name + "_low," + name + "_high" : "";
    text += name == "eigenvalue_min" ? ",realizable" : "";
  }
  return text + ",estimable";
}

AddedColumns analyzed_columns(Analyzer& analyzer) {
  return {analyzer.columns(), [&analyzer](std::string& text, double wavelength, const Geometry& geometry) {
            const Analysis a = analyzer.at(wavelength, geometry);
            append_elements(text, a.elements);
            text += ',' + to_string(a.outside);
            for (std::size_t element = 0; element < 16; ++element)
              append(text, a.uncertainties ? std::optional(a.uncertainties->elements[element]) : std::nullopt);
            for (const Quantity& quantity : a.quantities) {
              append(text, quantity.value);
              append(text, quantity.uncertainty);
              if (quantity.has_interval) {
                append(text, quantity.low);
                append(text, quantity.high);
              }
              text += quantity.name != "eigenvalue_min" ? "" : a.realizable ? ",1" : ",0";
            }
            text += ',' + (a.estimable ? std::string(*a.estimable ? "1" : "0") : "");
            return a.outside;
          }};
}

}  // namespace mmbrdf::program
