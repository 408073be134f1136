// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/answer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/polarization/analysis_batch.hpp"
#include "mmbrdf/polarization/gradients.hpp"
#include "mmbrdf/uncertainty/draws.hpp"

namespace mmbrdf {

struct Answers::Asked {
  Model model;
  AnswerOptions options;
  std::string unknown_uncertainty;
  std::optional<Draws> draws;
};

struct PreparedAnswers::Prepared {
  std::shared_ptr<const Answers::Asked> asked;
  PreparedModel model;
  std::optional<PreparedUncertainty> uncertainty;
  std::vector<PreparedModel> draws;
};

namespace {

std::string why_uncertainty_is_unknown(const Model& model) {
  try {
    prepare_uncertainty(model, 1);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

/// In the s and p axes of the incident beam; unpolarized if there is none.
Stokes light_sp(const AnswerOptions& options, const Geometry& geometry) {
  const double turn = angles_to_xy(geometry, options.frame).incident - angles_to_xy(geometry, Frame::sp).incident;
  return rotator(turn) * options.light.value_or(Stokes{1, 0, 0, 0});
}

bool has_limit(const std::vector<TypeBTerm>& terms, const Geometry& geometry) {
  return std::cos(geometry.reflected.theta) >= grazing_limit ||
         std::ranges::find(terms, ErrorOf::theta_r, &TypeBTerm::what) == terms.end();
}

std::vector<double> parts(const Mueller& gradient, const Budget& budget) {
  constexpr double rounding = 1e-6;
  const double total = standard_uncertainty(gradient, budget.total);
  std::vector<double> result;
  for (const BudgetTerm& term : budget.terms) {
    const double u = standard_uncertainty(gradient, term.covariance);
    result.push_back(u > rounding * total ? u : 0);
  }
  result.push_back(total);
  return result;
}

/// With 0 for what was not measured, where that has no part.
Mueller without_unknown(Mueller m) {
  for (double& element : m.elements)
    if (std::isnan(element)) element = 0;
  return m;
}

Answered in_first_order(const Quantity& quantity, const Mueller& m_sp, const Stokes& light,
                        const std::optional<Budget>& budget) {
  Answered answered{.quantity = &quantity};
  answered.known = is_known(quantity, m_sp, light);
  if (!answered.known) return answered;
  try {
    const Mueller m = without_unknown(m_sp);
    const double value = quantity.value(m, light);
    if (budget) answered.parts = parts(quantity.gradient(m, light), *budget);
    answered.value = value;
  } catch (const std::invalid_argument&) {
    return answered;  // it has no meaning here
  }
  if (budget) answered.uncertainty = answered.parts.back();
  return answered;
}

/// Instead of the uncertainty in first order that of draws, or none, where the quantity has no meaning in one of them.
void set_distribution(Answered& answered, const std::vector<Mueller>& drawn, const Stokes& light) {
  const Quantity& quantity = *answered.quantity;
  std::vector<Mueller> matrices(drawn.size());
  std::ranges::transform(drawn, matrices.begin(), without_unknown);
  std::vector<double> values(drawn.size());
  answered.uncertainty.reset();
  try {
    if (quantity.values)
      quantity.values(matrices, values, {});
    else
      std::ranges::transform(matrices, values.begin(), [&](const Mueller& m) { return quantity.value(m, light); });
  } catch (const std::invalid_argument&) {
    return;
  }
  const Distribution d = distribution(values);
  answered.uncertainty = d.standard_deviation;
  answered.low = d.low;
  answered.high = d.high;
}

}  // namespace

Answers::Answers(const Model& model, AnswerOptions options) {
  require_semidefinite(model);
  if (options.draws < 0) throw std::invalid_argument("draws = " + std::to_string(options.draws) + " is negative");
  if (options.light) degree_of_polarization(*options.light);  // refuses
  auto asked = std::make_shared<Asked>(Asked{model, std::move(options), why_uncertainty_is_unknown(model), {}});
  if (asked->options.draws > 0 && asked->unknown_uncertainty.empty())
    asked->draws.emplace(model, asked->options.draws, asked->options.seed);
  asked_ = std::move(asked);
}

std::vector<std::string> Answers::names_of_parts() const {
  std::vector<std::string> names{"fit"};
  if (unknown_uncertainty().empty()) names = mmbrdf::names_of_parts(model());
  for (const TypeBTerm& term : options().terms) names.push_back(term.name);
  return names;
}

const std::string& Answers::unknown_uncertainty() const { return asked_->unknown_uncertainty; }
const AnswerOptions& Answers::options() const { return asked_->options; }
const Model& Answers::model() const { return asked_->model; }

PreparedAnswers Answers::at(double wavelength) const {
  PreparedAnswers::Prepared p{asked_, prepare(asked_->model, wavelength), {}, {}};
  if (asked_->unknown_uncertainty.empty()) p.uncertainty = prepare_uncertainty(asked_->model, wavelength);
  if (asked_->draws) p.draws = asked_->draws->at(wavelength);
  return PreparedAnswers(std::make_shared<const PreparedAnswers::Prepared>(std::move(p)));
}

Answer PreparedAnswers::at(const Geometry& geometry) const {
  const auto& [asked, model, uncertainty, draws] = *prepared_;
  const AnswerOptions& options = asked->options;
  const Mueller m_sp = model.evaluate(geometry, Frame::sp);
  const Stokes light = light_sp(options, geometry);
  Answer a;
  a.elements = model.evaluate(geometry, options.frame);
  a.outside = model.outside(geometry);
  if (!(a.elements(0, 0) > 0))
    a.realizable = false;
  else if (unknown_elements(a.elements).none())
    a.realizable = realizable(a.elements);
  std::vector<Mueller> drawn_sp;
  if (uncertainty) {
    a.estimable = !leaves_known_range(a.outside) && uncertainty->estimable(geometry);
    if (has_limit(options.terms, geometry)) {
      a.budget = budget(model, *uncertainty, options.terms, geometry, Frame::sp);
      a.uncertainties = standard_uncertainty(
          unknown_elements(m_sp).none()
              ? change_frame(a.budget->total, geometry, Frame::sp, options.frame)
              : budget(model, *uncertainty, options.terms, geometry, options.frame).total);  // sp mixes more
      if (!draws.empty()) drawn_sp = drawn(draws, model, options.terms, geometry, Frame::sp, options.seed);
    }
  }
  for (const Quantity& quantity : quantities(options.light.has_value())) {
    Answered& answered = a.quantities.emplace_back(in_first_order(quantity, m_sp, light, a.budget));
    if (answered.value && !quantity.first_order && !drawn_sp.empty()) set_distribution(answered, drawn_sp, light);
  }
  return a;
}

}  // namespace mmbrdf
