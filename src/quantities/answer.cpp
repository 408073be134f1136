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
#include "uncertainty/drawn_errors.hpp"

namespace mmbrdf {

struct Answers::Asked {
  Model model;
  AnswerOptions options;
  std::string unknown_uncertainty;
  std::optional<Draws> draws;
  std::vector<double> errors = {};  // of the terms in the draws
};

struct PreparedAnswers::Prepared {
  std::shared_ptr<const Answers::Asked> asked;
  PreparedModel model;
  std::optional<PreparedUncertainty> uncertainty;
  std::optional<DrawnMatrices> draws;
};

namespace {

std::string why_uncertainty_is_unknown(const Model& model) {
  try {
    if (model.posterior)
      model.posterior->data();  // is read; covariances are worked out for wavelengths that are asked
    else
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

/// What is known of the error of a matrix in the frame sp.
struct Error {
  MuellerCovariance total;
  std::optional<Budget> budget;
  std::vector<Mueller> effects;  // of the terms, in turn
};

void add(MuellerCovariance& sum, const Mueller& effect) {
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t other = 0; other < 16; ++other) sum(e, other) += effect.elements[e] * effect.elements[other];
}

Answered in_first_order(const Quantity& quantity, const Mueller& m_sp, const Stokes& light, const Error* error) {
  Answered answered{.quantity = &quantity};
  answered.known = is_known(quantity, m_sp, light);
  if (!answered.known) return answered;
  try {
    const Mueller m = without_unknown(m_sp);
    const double value = quantity.value(m, light);
    if (error) {
      const Mueller gradient = quantity.gradient(m, light);
      answered.uncertainty = standard_uncertainty(gradient, error->total);
      if (error->budget) answered.parts = parts(gradient, *error->budget);
    }
    answered.value = value;
  } catch (const std::invalid_argument&) {
    answered.uncertainty.reset();  // it has no meaning here
  }
  return answered;
}

std::optional<bool> realizable_unless_unknown(const Mueller& m) {
  if (!(m(0, 0) > 0)) return false;
  return unknown_elements(m).none() ? std::optional(realizable(m)) : std::nullopt;
}

/// Takes the values of a quantity in all draws, or finds that it has no meaning in one of them.
struct Distributed {
  Answered* answered;
  std::vector<double> values;
  bool has_meaning = true;

  /// `ratios` of each, none if there is a matrix without.
  void add(std::size_t first, std::span<const Mueller> matrices, std::span<const Ratios> ratios, const Stokes& light) {
    has_meaning = has_meaning && !(answered->quantity->ratio && ratios.empty());
    if (!has_meaning) return;
    const Quantity& quantity = *answered->quantity;
    const std::span out = std::span(values).subspan(first, matrices.size());
    try {
      if (quantity.ratio)
        std::ranges::transform(ratios, out.begin(), quantity.ratio);
      else
        std::ranges::transform(matrices, out.begin(), [&](const Mueller& m) { return quantity.value(m, light); });
    } catch (const std::invalid_argument&) {
      has_meaning = false;
    }
  }

  /// Instead of the uncertainty in first order that of the draws, or none.
  void finish() const {
    answered->uncertainty.reset();
    if (!has_meaning) return;
    const Distribution d = distribution(values);
    answered->uncertainty = d.standard_deviation;
    answered->low = d.low;
    answered->high = d.high;
  }
};

/// A geometry that is drawn at.
struct DrawnAt {
  Geometry geometry;
  Stokes light;
  const std::vector<Mueller>* effects;  // of the terms
  std::vector<Distributed> quantities;
};

/// The values of all quantities, of some draws after others.
void draw(const DrawnMatrices& draws, std::span<const double> errors, std::span<DrawnAt> places) {
  std::vector<Geometry> geometries;
  for (const DrawnAt& place : places) geometries.push_back(place.geometry);
  const std::size_t most = std::min(draws.together, draws.count());
  std::vector<Mueller> matrices(places.size() * most);
  std::vector<Ratios> of_matrices(most);
  for (std::size_t first = 0; first < draws.count(); first += draws.together) {
    const std::size_t count = std::min(draws.together, draws.count() - first);
    draws.evaluate(first, geometries, Frame::sp, std::span(matrices).first(places.size() * count));
    for (std::size_t g = 0; g < places.size(); ++g) {
      const std::span here = std::span(matrices).subspan(g * count, count);
      const std::vector<Mueller>& effects = *places[g].effects;
      const double* error = errors.data() + first * effects.size();
      for (Mueller& m : here)
        for (const Mueller& effect : effects) m = m + *error++ * effect;
      if (unknown_elements(here.front()).any()) std::ranges::transform(here, here.begin(), without_unknown);
      const std::size_t refused = ratios(here, std::span(of_matrices).first(count), {.refused = Refused::nan});
      for (Distributed& quantity : places[g].quantities)
        quantity.add(first, here, std::span(of_matrices).first(refused > 0 ? 0 : count), places[g].light);
    }
  }
}

}  // namespace

/// Answers of some geometries at once.
class PreparedAnswers::Block {
 public:
  Block(const Prepared& prepared, std::span<const Geometry> geometries)
      : prepared_(prepared), geometries_(geometries), errors_(geometries.size()) {}

  void append_to(std::vector<Answer>& out) {
    const AnswerOptions& options = prepared_.asked->options;
    const std::vector<Mueller> elements = matrices(options.frame), matrices_sp = matrices(Frame::sp);
    find_errors();
    const std::size_t first = out.size();
    for (std::size_t g = 0; g < geometries_.size(); ++g) {
      const Geometry& geometry = geometries_[g];
      Answer& a = out.emplace_back();
      a.elements = elements[g];
      a.outside = prepared_.model.outside(geometry);
      a.realizable = realizable_unless_unknown(a.elements);
      if (prepared_.uncertainty)
        a.estimable = !leaves_known_range(a.outside) && prepared_.uncertainty->estimable(geometry);
      const Error* error = errors_[g] ? &*errors_[g] : nullptr;
      const Stokes light = light_sp(options, geometry);
      for (const Quantity& quantity : quantities(options.light.has_value()))
        a.quantities.push_back(in_first_order(quantity, matrices_sp[g], light, error));
      if (!error) continue;
      a.budget = error->budget;
      a.uncertainties = standard_uncertainty(unknown_elements(matrices_sp[g]).none()
                                                 ? change_frame(error->total, geometry, Frame::sp, options.frame)
                                                 : total_of_one(geometry, options.frame));  // sp mixes more
    }
    if (prepared_.draws) find_distributions(std::span(out).subspan(first));
  }

 private:
  std::vector<Mueller> matrices(Frame frame) const {
    std::vector<Mueller> result(geometries_.size());
    prepared_.model.evaluate(geometries_, frame, result);
    return result;
  }

  std::vector<MuellerCovariance> covariances(std::span<const Geometry> geometries, Frame frame) const {
    std::vector<MuellerCovariance> result(geometries.size());
    prepared_.uncertainty->evaluate(geometries, frame, result);
    return result;
  }

  std::vector<Mueller> effects_of_terms(const Geometry& geometry, Frame frame) const {
    std::vector<Mueller> result;
    for (const TypeBTerm& term : prepared_.asked->options.terms)
      for (const Mueller& effect : effects(term, prepared_.model, geometry, frame)) result.push_back(effect);
    return result;
  }

  MuellerCovariance total_of_one(const Geometry& geometry, Frame frame) const {
    MuellerCovariance result = covariances({&geometry, 1}, frame).front();
    for (const Mueller& effect : effects_of_terms(geometry, frame)) add(result, effect);
    return result;
  }

  void find_errors() {
    if (!prepared_.uncertainty) return;
    const AnswerOptions& options = prepared_.asked->options;
    const std::vector<MuellerCovariance> of_fit = covariances(geometries_, Frame::sp);
    for (std::size_t g = 0; g < geometries_.size(); ++g) {
      const Geometry& geometry = geometries_[g];
      if (!has_limit(options.terms, geometry)) continue;
      Error& error = errors_[g].emplace();
      error.effects = effects_of_terms(geometry, Frame::sp);
      error.total = of_fit[g];
      for (const Mueller& effect : error.effects) add(error.total, effect);
      if (!options.parts) continue;
      error.budget = budget(prepared_.model, *prepared_.uncertainty, options.terms, geometry, Frame::sp);
      error.budget->total = error.total;  // the bits of an answer without parts
    }
  }

  void find_distributions(std::span<Answer> answers) const {
    const AnswerOptions& options = prepared_.asked->options;
    std::vector<DrawnAt> places;
    for (std::size_t g = 0; g < answers.size(); ++g) {
      if (!errors_[g]) continue;
      places.push_back({geometries_[g], light_sp(options, geometries_[g]), &errors_[g]->effects, {}});
      for (Answered& answered : answers[g].quantities)
        if (answered.value && !answered.quantity->first_order)
          places.back().quantities.push_back({&answered, std::vector<double>(prepared_.draws->count())});
    }
    draw(*prepared_.draws, prepared_.asked->errors, places);
    for (const DrawnAt& place : places)
      for (const Distributed& quantity : place.quantities) quantity.finish();
  }

  const Prepared& prepared_;
  std::span<const Geometry> geometries_;
  std::vector<std::optional<Error>> errors_;  // none: not known
};

Answers::Answers(const Model& model, AnswerOptions options) {
  require_semidefinite(model);
  if (options.draws < 0) throw std::invalid_argument("draws = " + std::to_string(options.draws) + " is negative");
  if (options.light) degree_of_polarization(*options.light);  // refuses
  auto asked = std::make_shared<Asked>(Asked{model, std::move(options), why_uncertainty_is_unknown(model), {}});
  if (const auto& o = asked->options; o.draws > 0 && asked->unknown_uncertainty.empty()) {
    asked->draws.emplace(model, o.draws, o.seed);
    asked->errors = drawn_errors(o.terms, static_cast<std::size_t>(o.draws), o.seed);
  }
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
  if (asked_->draws) p.draws = asked_->draws->matrices_at(wavelength);
  return PreparedAnswers(std::make_shared<const PreparedAnswers::Prepared>(std::move(p)));
}

std::vector<Answered> quantities_of(const Sample& sample) {
  const Sample measured = in_frame(sample, Frame::sp);
  Error error{not_measured(sample).none() ? change_frame(covariance(sample), sample.geometry, Frame::xy, Frame::sp)
                                          : covariance(measured),
              {},
              {}};
  Elements uncertain;
  for (std::size_t e = 0; e < 16; ++e) uncertain[e] = std::isnan(error.total(e, e));
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t other = 0; other < 16; ++other)
      if (uncertain[e] || uncertain[other]) error.total(e, other) = 0;
  std::vector<Answered> result;
  for (const Quantity& quantity : quantities(false))
    result.push_back(in_first_order(quantity, measured_matrix(measured), {1, 0, 0, 0},
                                    (quantity.needs & uncertain).any() ? nullptr : &error));
  return result;
}

Answer PreparedAnswers::at(const Geometry& geometry) const { return std::move(at({&geometry, 1}).front()); }

std::vector<Answer> PreparedAnswers::at(std::span<const Geometry> geometries) const {
  for (const Geometry& geometry : geometries) require_valid(geometry);
  constexpr std::size_t most = 24, values = 1 << 16;  // of a quantity in all draws, for each of some
  const std::size_t draws = prepared_->draws ? prepared_->draws->count() : 1;
  const std::size_t block = std::clamp<std::size_t>(values / draws, 1, most);
  std::vector<Answer> result;
  result.reserve(geometries.size());
  for (std::size_t first = 0; first < geometries.size(); first += block)
    Block(*prepared_, geometries.subspan(first, std::min(block, geometries.size() - first))).append_to(result);
  return result;
}

}  // namespace mmbrdf
