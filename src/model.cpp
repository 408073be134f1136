// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "numbers.hpp"

namespace mmbrdf {

/// All that does not depend on the wavelength. Products of Zernike functions are listed element by element; the weight
/// of a product is a polynomial of the wavelength.
struct PreparedModel::Pattern {
  struct Product {
    int incident, reflected;
  };
  DiscPoint point(const Direction& direction, double turn) const {
    return disc_point(Direction{direction.theta, direction.phi - turn}, mapping);
  }

  int order = 0;       // largest radial order
  bool turns = false;  // evaluate at phi_i = 0 and turn the result
  DiscMapping mapping = DiscMapping::lambert;
  std::array<std::size_t, 17> begin{};  // products of element e: begin[e] … begin[e + 1]
  std::vector<Product> products;
  std::vector<std::vector<double>> powers;  // for each power of the wavelength, a weight for each product
  struct Share {
    int product;
    double weight;
  };
  std::vector<Share> shares;               // what coefficients give to the weights of products, mode after mode
  std::vector<std::size_t> shares_end{0};  // shares of mode q: shares_end[q] … shares_end[q + 1]
  ReflectanceTable reflectance;
  Validity validity;
};

namespace {

using Table = std::array<double, zernike_count(max_order)>;

std::size_t size(int n) { return static_cast<std::size_t>(n); }

/// A vector of length 1 to 1e-6 with exactly that length.
Vector3 normalized(const Vector3& v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  if (!(std::abs(length - 1) < 1e-6) || v[2] < 0)
    throw std::invalid_argument("evaluate: (" + shortest(v[0]) + ", " + shortest(v[1]) + ", " + shortest(v[2]) +
                                ") is not a unit vector with z >= 0");
  return {v[0] / length, v[1] / length, v[2] / length};
}

/// f11 and the normalised elements → sr⁻¹.
Mueller scaled(Mueller m, double reflectance) {
  m.elements[0] *= reflectance;
  for (std::size_t e = 1; e < 16; ++e) m.elements[e] *= m.elements[0];
  return m;
}

/// A product of Zernike functions of one element, as the key of its weight.
struct ProductKey {
  int element, incident, reflected;
  auto operator<=>(const ProductKey&) const = default;
};

ProductKey key_of(const Term& term) { return {4 * term.row + term.column, term.incident, term.reflected}; }

std::map<ProductKey, std::vector<double>> collected_products(const Model& model) {
  std::map<ProductKey, std::vector<double>> result;
  const std::size_t powers = size(model.powers) + 1;
  for (const FittedBlock& fitted : model.blocks) {
    const std::size_t count = fitted.block.modes.size();
    for (std::size_t q = 0; q < count; ++q)
      for (const Term& term : terms(fitted.block.modes[q], model.family)) {
        auto& weights = result[key_of(term)];
        weights.resize(powers);
        for (std::size_t p = 0; p < powers; ++p) weights[p] += term.weight * fitted.coefficients[p * count + q];
      }
  }
  return result;
}

}  // namespace

PreparedModel prepare(const Model& model, double wavelength, Rotation rotation) {
  require_valid(model);
  require_wavelength(wavelength);
  auto pattern = std::make_shared<PreparedModel::Pattern>();
  const Orders highest = orders(model);
  pattern->order = std::max(highest.f11, highest.other);
  pattern->turns = model.family == Family::germer2017 && rotation == Rotation::covariant;
  pattern->mapping = model.mapping;
  pattern->reflectance = model.reflectance;
  pattern->validity = model.validity;
  pattern->powers.resize(size(model.powers) + 1);
  std::map<ProductKey, int> positions;
  for (const auto& [key, weights] : collected_products(model)) {
    positions.emplace_hint(positions.end(), key, static_cast<int>(pattern->products.size()));
    ++pattern->begin[size(key.element) + 1];
    pattern->products.push_back({key.incident, key.reflected});
    for (std::size_t p = 0; p < weights.size(); ++p) pattern->powers[p].push_back(weights[p]);
  }
  for (std::size_t e = 0; e < 16; ++e) pattern->begin[e + 1] += pattern->begin[e];
  for (const FittedBlock& fitted : model.blocks)
    for (const Mode& mode : fitted.block.modes) {
      for (const Term& term : terms(mode, model.family))
        pattern->shares.push_back({positions.at(key_of(term)), term.weight});
      pattern->shares_end.push_back(pattern->shares.size());
    }
  return PreparedModel(std::move(pattern), wavelength);
}

PreparedModel::PreparedModel(std::shared_ptr<const Pattern> pattern, double wavelength)
    : pattern_(std::move(pattern)),
      weights_(pattern_->powers[0]),
      reflectance_(pattern_->reflectance.at(wavelength)),
      wavelength_(wavelength) {
  double power = 1;
  for (std::size_t p = 1; p < pattern_->powers.size(); ++p) {
    power *= wavelength;
    for (std::size_t t = 0; t < weights_.size(); ++t) weights_[t] += power * pattern_->powers[p][t];
  }
  for (const double weight : weights_)
    if (!std::isfinite(weight))
      throw std::invalid_argument("wavelength " + shortest(in_nanometres(wavelength)) +
                                  " nm: its powers are too large");
}

PreparedModel PreparedModel::at(double wavelength) const {
  require_wavelength(wavelength);
  return PreparedModel(pattern_, wavelength);
}

PreparedModel PreparedModel::with(std::span<const double> coefficients, double reflectance) const {
  const Pattern& p = *pattern_;
  if (coefficients.size() + 1 != p.shares_end.size())
    throw std::invalid_argument("with: " + std::to_string(coefficients.size()) + " coefficients, expected " +
                                std::to_string(p.shares_end.size() - 1));
  PreparedModel result = *this;
  result.reflectance_ = reflectance;
  std::fill(result.weights_.begin(), result.weights_.end(), 0.0);
  double* const weights = result.weights_.data();
  bool finite = std::isfinite(reflectance);
  for (std::size_t q = 0; q < coefficients.size(); ++q) {
    const double a = coefficients[q];
    finite = finite && std::isfinite(a);
    for (std::size_t s = p.shares_end[q]; s < p.shares_end[q + 1]; ++s)
      weights[p.shares[s].product] += p.shares[s].weight * a;
  }
  if (!finite) throw std::invalid_argument("with: a number is not finite");
  return result;
}

PreparedIncidence PreparedModel::at(const Direction& incident) const { return PreparedIncidence(*this, incident); }

Outside PreparedModel::outside(const Geometry& geometry) const {
  return mmbrdf::outside(pattern_->validity, wavelength_, geometry);
}

/// The weighted sums of products for the first `elements` elements, in the xy frame and sr⁻¹.
Mueller PreparedModel::sum(const DiscPoint& incident, const DiscPoint& reflected, std::size_t elements) const {
  Table k_i, k_r;
  zernike_table(pattern_->order, incident, k_i.data());
  zernike_table(pattern_->order, reflected, k_r.data());
  Mueller result;
  for (std::size_t e = 0; e < elements; ++e) {
    double sum = 0;
    for (std::size_t t = pattern_->begin[e]; t < pattern_->begin[e + 1]; ++t) {
      const auto [i, r] = pattern_->products[t];
      sum += weights_[t] * (k_i[size(i)] * k_r[size(r)]);
    }
    result.elements[e] = sum;
  }
  return scaled(result, reflectance_);
}

Mueller PreparedModel::evaluate(const Geometry& geometry, Frame frame) const {
  require_valid(geometry, "evaluate");
  const double turn = pattern_->turns ? geometry.incident.phi : 0;
  Mueller m = sum(pattern_->point(geometry.incident, turn), pattern_->point(geometry.reflected, turn), 16);
  if (pattern_->turns) m = turned(m, turn);
  return frame == Frame::xy ? m : change_frame(m, geometry, Frame::xy, frame);
}

Mueller PreparedModel::evaluate(const Vector3& incident, const Vector3& reflected, Frame frame) const {
  const Vector3 to_source = normalized(incident), to_detector = normalized(reflected);
  if (pattern_->turns || frame != Frame::xy) return evaluate({direction(to_source), direction(to_detector)}, frame);
  return sum(disc_point(to_source, pattern_->mapping), disc_point(to_detector, pattern_->mapping), 16);
}

void PreparedModel::evaluate(std::span<const Geometry> geometries, Frame frame, std::span<Mueller> out) const {
  if (geometries.size() != out.size())
    throw std::invalid_argument("evaluate: " + std::to_string(geometries.size()) + " geometries, room for " +
                                std::to_string(out.size()));
  for (std::size_t q = 0; q < out.size(); ++q) out[q] = evaluate(geometries[q], frame);
}

double PreparedModel::f11(const Geometry& geometry) const {
  require_valid(geometry, "f11");
  return sum(pattern_->point(geometry.incident, 0), pattern_->point(geometry.reflected, 0), 1)(0, 0);
}

PreparedIncidence::PreparedIncidence(const PreparedModel& model, const Direction& incident)
    : pattern_(model.pattern_), reflectance_(model.reflectance_), incident_(incident) {
  require_valid(Geometry{incident, {}}, "at");
  Table k_i;
  zernike_table(pattern_->order, pattern_->point(incident, pattern_->turns ? incident.phi : 0), k_i.data());
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t t = pattern_->begin[e]; t < pattern_->begin[e + 1]; ++t) {
      const auto [i, r] = pattern_->products[t];
      if (weights_[e].size() <= size(r)) weights_[e].resize(size(r) + 1);
      weights_[e][size(r)] += model.weights_[t] * k_i[size(i)];
    }
}

Mueller PreparedIncidence::evaluate(const Direction& reflected, Frame frame) const {
  const Geometry geometry{incident_, reflected};
  require_valid(geometry, "evaluate");
  const double turn = pattern_->turns ? incident_.phi : 0;
  Table k_r;
  zernike_table(pattern_->order, pattern_->point(reflected, turn), k_r.data());
  Mueller m;
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t r = 0; r < weights_[e].size(); ++r) m.elements[e] += weights_[e][r] * k_r[r];
  m = scaled(m, reflectance_);
  if (pattern_->turns) m = turned(m, turn);
  return frame == Frame::xy ? m : change_frame(m, geometry, Frame::xy, frame);
}

void PreparedIncidence::evaluate(std::span<const Direction> reflected, Frame frame, std::span<Mueller> out) const {
  if (reflected.size() != out.size())
    throw std::invalid_argument("evaluate: " + std::to_string(reflected.size()) + " directions, room for " +
                                std::to_string(out.size()));
  for (std::size_t q = 0; q < out.size(); ++q) out[q] = evaluate(reflected[q], frame);
}

}  // namespace mmbrdf
