// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/prepared.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "mmbrdf/model/batch.hpp"
#include "model/kernel/kernels.hpp"
#include "model/kernel/plan.hpp"
#include "model/unit_vectors.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

namespace {

constexpr double largest_at_a_wavelength = 1e100;  // largest_coefficient × (1 + … + max_wavelength⁹) is less

/// A vector of length 1 to 1e-6 with exactly that length.
Vector3 normalized(const Vector3& v) {
  require_unit_vector(v);
  const double length = std::hypot(v[0], v[1], v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

}  // namespace

PreparedModel prepare(const Model& model, double wavelength) {
  require_valid(model);
  require_wavelength(wavelength);
  auto pattern = std::make_shared<PreparedModel::Pattern>();
  pattern->mapping = model.mapping;
  pattern->family = model.family;
  pattern->plan = plan(model);
  for (int k = 0; k < zernike_count(pattern->plan.order); ++k) pattern->table_norms.push_back(table_norm(k));
  pattern->by_powers = by_powers(model);
  pattern->powers = model.powers;
  pattern->reflectance = model.reflectance;
  pattern->validity = model.validity;
  pattern->unknown = unknown_elements(model);
  pattern->isotropic_f11 = model.family == Family::isotropic || turns(model);
  for (const FittedBlock& fitted : model.blocks)
    for (const Mode& mode : fitted.block.modes) {
      for (const Term& term : terms(mode, model.family)) pattern->terms.push_back(term);
      pattern->terms_end.push_back(pattern->terms.size());
    }
  for (std::size_t first = 0; first < pattern->by_powers.size(); first += pattern->modes()) {
    const auto power = pattern->plan.coefficients(std::span(pattern->by_powers).subspan(first, pattern->modes()));
    pattern->form_by_powers.insert(pattern->form_by_powers.end(), power.begin(), power.end());
  }
  return PreparedModel(std::move(pattern), wavelength);
}

PreparedModel::PreparedModel(std::shared_ptr<const Pattern> pattern, double wavelength)
    : pattern_(std::move(pattern)), reflectance_(pattern_->reflectance.at(wavelength)), wavelength_(wavelength) {
  const std::size_t modes = pattern_->modes();
  of_modes_.resize(modes);
  double power = 1;
  for (std::size_t first = 0; first < pattern_->by_powers.size(); first += modes, power *= wavelength)
    for (std::size_t q = 0; q < modes; ++q) of_modes_[q] += power * pattern_->by_powers[first + q];
  const Plan& plan = pattern_->plan;
  of_form_.resize(static_cast<std::size_t>(plan.count));
  best_kernel().fold(kernel_model<double>(plan, pattern_->form_by_powers, pattern_->powers, 1), wavelength,
                     of_form_.data());
}

PreparedModel PreparedModel::at(double wavelength) const {
  require_wavelength(wavelength);
  return PreparedModel(pattern_, wavelength);
}

PreparedModel PreparedModel::with(std::span<const double> coefficients, double reflectance) const {
  if (coefficients.size() != pattern_->modes())
    throw std::invalid_argument(std::to_string(coefficients.size()) + " coefficients, expected " +
                                std::to_string(pattern_->modes()));
  bool moderate = std::abs(reflectance) <= largest_at_a_wavelength;
  for (const double a : coefficients) moderate = moderate && std::abs(a) <= largest_at_a_wavelength;
  if (!moderate)
    throw std::invalid_argument("a coefficient or the reflectance is not a number up to " +
                                shortest(largest_at_a_wavelength));
  PreparedModel result = *this;
  result.reflectance_ = reflectance;
  result.of_modes_.assign(coefficients.begin(), coefficients.end());
  result.of_form_ = pattern_->plan.coefficients(coefficients);
  return result;
}

PreparedIncidence PreparedModel::at(const Direction& incident) const { return PreparedIncidence(*this, incident); }

Outside PreparedModel::outside(const Geometry& geometry) const {
  return mmbrdf::outside(pattern_->validity, wavelength_, geometry);
}

KernelModel<double> Evaluation::model(const PreparedModel& prepared) {
  return kernel_model<double>(prepared.pattern_->plan, prepared.of_form_, 0, prepared.reflectance_);
}

const PreparedPattern& Evaluation::pattern(const PreparedModel& prepared) { return *prepared.pattern_; }
const PreparedPattern& Evaluation::pattern(const PreparedIncidence& prepared) { return *prepared.pattern_; }
Mueller PreparedModel::evaluate(const Geometry& geometry, Frame frame) const {
  Mueller m;
  evaluate(std::span(&geometry, 1), frame, std::span(&m, 1));
  return m;
}

Mueller PreparedModel::evaluate(const Vector3& incident, const Vector3& reflected, Frame frame) const {
  const Vector3 to_source = normalized(incident), to_detector = normalized(reflected);  // exact, and the messages
  const auto one = [](const double& value) { return std::span(&value, 1); };
  const auto vector = [&](const Vector3& v) { return UnitVectors<double>{one(v[0]), one(v[1]), one(v[2])}; };
  Mueller m;
  mmbrdf::evaluate(*this, {vector(to_source), vector(to_detector)}, std::span(&m, 1), {.frame = frame});
  return m;
}

void PreparedModel::evaluate(std::span<const Geometry> geometries, Frame frame, std::span<Mueller> out) const {
  mmbrdf::evaluate(*this, geometries, out, {.frame = frame});
}

double PreparedModel::f11(const Geometry& geometry) const {
  require_valid(geometry);
  return evaluate(geometry)(0, 0);
}

PreparedIncidence::PreparedIncidence(const PreparedModel& model, const Direction& incident)
    : pattern_(model.pattern_), reflectance_(model.reflectance_), incident_(incident) {
  require_valid(Geometry{incident, {}});
  of_form_ = incidence_coefficients(*pattern_, model.of_modes_, incident);
}

KernelModel<double> Evaluation::model(const PreparedIncidence& prepared) {
  KernelModel<double> result =
      kernel_model<double>(prepared.pattern_->plan, prepared.of_form_, 0, prepared.reflectance_);
  result.form = incidence_form(prepared.pattern_->plan);
  result.count = static_cast<int>(prepared.of_form_.size());
  const auto [theta, phi] = prepared.incident_;
  const double c = std::cos(phi), s = std::sin(phi);
  result.turned_by[0] = c;
  result.turned_by[1] = s;
  const Vector3 v = unit_vector(prepared.incident_);
  const double incident[] = {theta, std::abs(phi) <= max_azimuth ? phi : std::atan2(s, c), v[0], v[1], v[2]};
  std::copy_n(incident, 5, result.incident);
  return result;
}

Mueller PreparedIncidence::evaluate(const Direction& reflected, Frame frame) const {
  Mueller m;
  evaluate(std::span(&reflected, 1), frame, std::span(&m, 1));
  return m;
}

void PreparedIncidence::evaluate(std::span<const Direction> reflected, Frame frame, std::span<Mueller> out) const {
  mmbrdf::evaluate(*this, reflected, out, {.frame = frame});
}

}  // namespace mmbrdf
