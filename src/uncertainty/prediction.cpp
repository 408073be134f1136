// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty/prediction.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "basis/rows.hpp"
#include "numerics/eigen_index.hpp"
#include "text/numbers.hpp"
#include "uncertainty/block_at.hpp"
#include "uncertainty/normalized_at.hpp"
#include "uncertainty/variances.hpp"

// Element e of the normalised matrix is g_e · a(λ) with a(λ) = Σ_p λ^p a_p, and f11 = R(λ) g_11 · a(λ). So
//
//   cov(e, e') = g_eᵀ V(λ) g_e',     V(λ)_qq' = Σ_pp' λ^{p+p'} V_pq,p'q'
//
// within a block, and 0 between blocks. Where R has a covariance it is one more parameter of block 11, with the slope
// g_11 · a(λ). A change of frame, and the turning of published models, are M → L M R.

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double estimability_limit = 1e-8;  // theory 4.7

/// Of F_e = f11 m_e, F_11 = f11, from that of f11 and m: dF_e = m_e df11 + f11 dm_e.
MuellerCovariance of_product(Mueller m, const MuellerCovariance& c) {
  const double f11 = std::exchange(m(0, 0), 1);
  MuellerCovariance result;
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t other = 0; other < 16; ++other) {
      const double direct = e == 0 || other == 0 ? 0 : f11 * f11 * c(e, other);
      result(e, other) = m.elements[e] * m.elements[other] * c(0, 0) + direct;
    }
  return result;
}

void require_room(std::size_t asked, const char* what, std::size_t room) {
  if (asked != room)
    throw std::invalid_argument(std::to_string(asked) + " " + what + ", room for " + std::to_string(room));
}

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Map<const RowMajor> slopes_of(const MuellerGradient& gradient, Index parameters) {
  if (gradient.values.size() != 16 * static_cast<std::size_t>(parameters))
    throw std::invalid_argument("a gradient of " + std::to_string(gradient.values.size()) + " numbers, expected " +
                                std::to_string(16 * parameters));
  return {gradient.values.data(), 16, parameters};
}

}  // namespace

struct PreparedUncertainty::Blocks {
  std::vector<BlockAt> list;
  std::optional<Variances> variances;  // of the list
  Index parameters = 0;
  double freedom = 0;
  int order = 0;  // of the functions of the rows
  DiscMapping mapping = DiscMapping::lambert;
  bool turns = false;
  Elements unknown;  // in the frame xy

  /// The covariance in a frame, from that of what the modes give.
  MuellerCovariance in_frame(const MuellerCovariance& covariance, const Geometry& geometry, Frame frame) const {
    const auto [left, right] = to_frame(geometry, frame);
    MuellerCovariance result = transformed(covariance, left, right);
    set_unknown(result, unknown_in(geometry, frame));
    return result;
  }

  void covariances(Variances::Of what, std::span<const Geometry> geometries, Frame frame,
                   std::span<MuellerCovariance> out) const {
    for (const Geometry& geometry : geometries) require_valid(geometry);
    variances->covariances(what, geometries, frame, out);
    for (std::size_t g = 0; g < out.size() && unknown.any(); ++g) set_unknown(out[g], unknown_in(geometries[g], frame));
  }

  Elements unknown_in(const Geometry& geometry, Frame frame) const {
    if (unknown.none()) return {};
    const FrameAngles angles = angles_to_xy(geometry, frame);
    return turned_into(unknown, -angles.scattered, -angles.incident);
  }

  /// As the modes are asked.
  Geometry turned(const Geometry& geometry) const {
    const auto& [i, r] = geometry;
    const double turn = turns ? i.phi : 0;
    return {{i.theta, i.phi - turn}, {r.theta, r.phi - turn}};
  }

  std::pair<KTable, KTable> tables(const Geometry& geometry) const {
    const auto& [i, r] = turned(geometry);
    return {functions_at(i, order, mapping), functions_at(r, order, mapping)};
  }

  NormalizedAt normalized(const Geometry& geometry) const {
    require_valid(geometry);
    const Geometry asked = turned(geometry);
    return normalized_at(list, order, mapping, {&asked, 1});
  }

  /// L and R of M → L M R that brings what the modes give into a frame.
  std::pair<Mueller, Mueller> to_frame(const Geometry& geometry, Frame frame) const {
    const Mueller turn = rotator(turns ? -geometry.incident.phi : 0);
    const FrameAngles angles = angles_to_xy(geometry, frame);
    return {rotator(-angles.scattered) * turn, turn * rotator(angles.incident)};
  }
};

/// f11 and the normalised elements at a geometry, as the modes give them, with their slopes over the parameters of the
/// block of each.
struct PreparedUncertainty::Slopes {
  Mueller m;
  std::array<VectorXd, 16> slopes;  // empty for elements without modes
  std::array<const BlockAt*, 16> block{};

  Slopes(const Blocks& blocks, const Geometry& geometry) {
    require_valid(geometry);
    const auto [k_i, k_r] = blocks.tables(geometry);
    for (const BlockAt& b : blocks.list)
      for (const Element& element : b.elements) {
        const VectorXd g = b.row(element, k_i, k_r);
        m.elements[element.index()] = b.reflectance * g.dot(b.coefficients);
        slopes[element.index()] = b.slopes(g);
        block[element.index()] = &b;
      }
  }

  /// Adds weight × the slopes of F = f11 m, F_11 = f11: dF_e = m_e df11 + f11 dm_e.
  void add_to(MatrixXd& gradient, double weight) const {
    const Index first = block[0]->first, size = slopes[0].size();
    for (std::size_t e = 0; e < 16; ++e) {
      auto row = gradient.row(index(e));
      row.segment(first, size) += weight * (e == 0 ? 1 : m.elements[e]) * slopes[0].transpose();
      if (e > 0 && block[e])
        row.segment(block[e]->first, slopes[e].size()) += weight * m.elements[0] * slopes[e].transpose();
    }
  }
};

PreparedUncertainty::PreparedUncertainty(std::shared_ptr<const Blocks> blocks) : blocks_(std::move(blocks)) {}

PreparedUncertainty prepare_uncertainty(const Model& model, double wavelength) {
  require_valid(model);
  require_wavelength(wavelength);
  auto blocks = std::make_shared<PreparedUncertainty::Blocks>();
  const Orders highest = model.posterior ? model.posterior->data().orders : orders(model);
  blocks->order = std::max(highest.f11, highest.other);
  blocks->mapping = model.mapping;
  blocks->turns = mmbrdf::turns(model);
  blocks->unknown = unknown_elements(model);
  blocks->freedom = degrees_of_freedom(model);
  blocks->list = blocks_at(model, wavelength);
  for (BlockAt& block : blocks->list) {
    block.first = blocks->parameters;
    blocks->parameters += block.covariance.rows();
  }
  blocks->variances.emplace(blocks->list, blocks->order, blocks->mapping, blocks->turns);
  return PreparedUncertainty(std::move(blocks));
}

MuellerCovariance PreparedUncertainty::normalized(const Geometry& geometry, Frame frame) const {
  MuellerCovariance result;
  blocks_->covariances(Variances::Of::normalized, {&geometry, 1}, frame, {&result, 1});
  return result;
}

MuellerCovariance PreparedUncertainty::evaluate(const Geometry& geometry, Frame frame) const {
  MuellerCovariance result;
  evaluate({&geometry, 1}, frame, {&result, 1});
  return result;
}

void PreparedUncertainty::evaluate(std::span<const Geometry> geometries, Frame frame,
                                   std::span<MuellerCovariance> out) const {
  require_room(geometries.size(), "geometries", out.size());
  blocks_->covariances(Variances::Of::matrix, geometries, frame, out);
}

Mueller PreparedUncertainty::standard_uncertainty(const Geometry& geometry, Frame frame) const {
  Mueller result;
  standard_uncertainty({&geometry, 1}, frame, {&result, 1});
  return result;
}

void PreparedUncertainty::standard_uncertainty(std::span<const Geometry> geometries, Frame frame,
                                               std::span<Mueller> out) const {
  require_room(geometries.size(), "geometries", out.size());
  for (const Geometry& geometry : geometries) require_valid(geometry);
  blocks_->variances->standard_uncertainties(geometries, frame, out);
  if (blocks_->unknown.none()) return;
  for (std::size_t g = 0; g < out.size(); ++g) {
    const Elements unknown = blocks_->unknown_in(geometries[g], frame);
    for (std::size_t e = 0; e < 16; ++e)
      if (unknown[e]) out[g].elements[e] = std::numeric_limits<double>::quiet_NaN();
  }
}

std::vector<BudgetTerm> PreparedUncertainty::parts(const Geometry& geometry, Frame frame) const {
  const NormalizedAt at = blocks_->normalized(geometry);
  std::vector<BudgetTerm> result;
  for (const NormalizedAt::Part& part : at.parts)
    result.push_back({part.name, blocks_->in_frame(of_product(at.m[0], part.covariances[0]), geometry, frame)});
  result.front().freedom = freedom();
  return result;
}

std::size_t PreparedUncertainty::parameters() const { return static_cast<std::size_t>(blocks_->parameters); }

double PreparedUncertainty::freedom() const { return blocks_->freedom; }

MuellerGradient PreparedUncertainty::gradient(const Geometry& geometry, Frame frame) const {
  const WeightedGeometry one{geometry, 1};
  return gradient({&one, 1}, frame);
}

MuellerGradient PreparedUncertainty::gradient(std::span<const WeightedGeometry> geometries, Frame frame) const {
  const bool mixes = blocks_->turns || frame != Frame::xy;
  MatrixXd sum = MatrixXd::Zero(16, blocks_->parameters), one = sum;
  for (const auto& [geometry, weight] : geometries) {
    if (!std::isfinite(weight)) throw std::invalid_argument("weight " + shortest(weight) + " is not finite");
    const Slopes at(*blocks_, geometry);
    if (!mixes) {
      at.add_to(sum, weight);
      continue;
    }
    one.setZero();
    at.add_to(one, weight);
    const auto [left, right] = blocks_->to_frame(geometry, frame);
    for (Index q = 0; q < one.cols(); ++q) {
      Mueller column;
      std::copy_n(one.col(q).data(), 16, column.elements.begin());
      column = left * column * right;
      for (Index e = 0; e < 16; ++e) sum(e, q) += column.elements[static_cast<std::size_t>(e)];
    }
  }
  Elements unknown;
  for (const auto& [geometry, weight] : geometries) unknown |= blocks_->unknown_in(geometry, frame);
  MuellerGradient result;
  for (Index e = 0; e < 16; ++e)
    for (Index q = 0; q < sum.cols(); ++q)
      result.values.push_back(unknown[static_cast<std::size_t>(e)] ? std::numeric_limits<double>::quiet_NaN()
                                                                   : sum(e, q));
  return result;
}

MuellerCovariance PreparedUncertainty::covariance(const MuellerGradient& a, const MuellerGradient& b) const {
  const auto slopes_a = slopes_of(a, blocks_->parameters), slopes_b = slopes_of(b, blocks_->parameters);
  MuellerCovariance result;
  Eigen::Map<RowMajor> sum(result.values.data(), 16, 16);
  for (const BlockAt& block : blocks_->list) {
    const Index size = block.covariance.rows();
    sum +=
        slopes_a.middleCols(block.first, size) * block.covariance * slopes_b.middleCols(block.first, size).transpose();
  }
  return result;
}

std::vector<BudgetTerm> PreparedUncertainty::parts(const MuellerGradient& gradient) const {
  const auto slopes = slopes_of(gradient, blocks_->parameters);
  std::vector<BudgetTerm> result{{name_of_fit(blocks_->list), {}, freedom()}};
  const auto add = [&](const std::string& name, const MatrixXd& covariance) {
    auto found = std::ranges::find(result, name, &BudgetTerm::name);
    if (found == result.end()) found = result.insert(found, {name, {}});
    Eigen::Map<RowMajor>(found->covariance.values.data(), 16, 16) += covariance;
  };
  for (const BlockAt& block : blocks_->list) {
    const MatrixXd of_block = slopes.middleCols(block.first, block.covariance.rows());
    add(result.front().name, of_block * block.of_fit * of_block.transpose());
    for (const BlockAt::Part& part : block.parts) {
      const MatrixXd effects = of_block * part.effects;
      add(part.name, effects * effects.transpose());
    }
  }
  return result;
}

bool PreparedUncertainty::estimable(const Geometry& geometry) const {
  require_valid(geometry);
  const auto leaves_none = [](const BlockAt& block) { return block.free.cols() == 0; };
  if (std::ranges::all_of(blocks_->list, leaves_none)) return true;
  const auto [k_i, k_r] = blocks_->tables(geometry);
  for (const BlockAt& block : blocks_->list)
    for (const Element& element : block.elements) {
      if (blocks_->unknown[element.index()]) continue;
      const VectorXd g = block.row(element, k_i, k_r);
      if ((block.free.transpose() * g).norm() > estimability_limit * block.lengthening * g.norm()) return false;
    }
  return true;
}

double PreparedUncertainty::directional_hemispherical_reflectance(const Direction& incident) const {
  double result = 0;
  directional_hemispherical_reflectance({&incident, 1}, {&result, 1});
  return result;
}

void PreparedUncertainty::directional_hemispherical_reflectance(std::span<const Direction> incident,
                                                                std::span<double> out) const {
  require_room(incident.size(), "directions", out.size());
  for (const Direction& direction : incident) require_valid(Geometry{direction, {}});
  blocks_->variances->directional_hemispherical(incident, out);
}

MuellerGradient PreparedUncertainty::bihemispherical_gradient() const {
  const KTable integrals = over_hemisphere(blocks_->mapping);
  const BlockAt& f11 = blocks_->list.front();
  const VectorXd slopes = f11.slopes(f11.row({}, integrals, integrals)) / (std::numbers::pi * std::numbers::pi);
  MuellerGradient result{std::vector<double>(16 * parameters())};
  std::copy_n(slopes.data(), slopes.size(), result.values.begin() + f11.first);
  return result;
}

std::vector<std::string> names_of_parts(const Model& model) {
  if (!knows_uncertainty(model)) return {"fit"};
  const std::vector<double> known = known_wavelengths(model);
  std::vector<std::string> names;
  for (const BudgetTerm& part : prepare_uncertainty(model, known.empty() ? 1 : known.front()).parts(Geometry{}))
    names.push_back(part.name);
  return names;
}

bool knows_uncertainty(const Model& model) {
  return model.posterior ||
         std::ranges::none_of(model.blocks, [](const FittedBlock& fitted) { return fitted.covariance.empty(); });
}

}  // namespace mmbrdf
