// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/mixed/plan.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "mixed/directions.hpp"
#include "mixed/readings.hpp"
#include "text/numbers.hpp"

// V = (diag 1/v + Σ w² x xᵀ/s²)⁻¹ of the readings at the geometries. One more reading with row x, divided by its noise,
// makes of it V − V x xᵀV/(1 + xᵀV x). With targets Σ hᵀV h = tr(M V), M = Σ h hᵀ, it lowers them by
// xᵀ V M V x/(1 + xᵀV x). Kept for each candidate are the two numbers of that fraction; V is kept as it was, with the
// vectors V x and the numbers 1 + xᵀV x of what was chosen since.

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t spread = 1000;  // directions over which blocks are meant

std::vector<Block> blocks_of(const VarianceComponents& components) {
  std::vector<Block> result = blocks(Family::isotropic, components.orders);
  if (components.blocks.size() != result.size())
    throw std::invalid_argument("variance components of " + std::to_string(components.blocks.size()) +
                                " blocks, expected " + std::to_string(result.size()));
  return result;
}

/// One block of a plan.
class PlannedBlock {
 public:
  PlannedBlock(const VarianceComponents& components, std::size_t block, std::span<const Geometry> design)
      : components_(components), columns_(blocks_of(components)[block], components.mapping, components.unread) {
    const auto& [hyperparameters, noise] = components.blocks[block];
    if (hyperparameters.empty())
      throw std::invalid_argument("elements " + columns_.isotropic().name +
                                  " were not measured: nothing is known of their variances");
    const Prior prior = prior_of(columns_);
    if (static_cast<Index>(hyperparameters.size()) != prior.mean.size())
      throw std::invalid_argument("block " + columns_.isotropic().name + ": " + std::to_string(hyperparameters.size()) +
                                  " hyperparameters, expected " + std::to_string(prior.mean.size()));
    noise_ = noise;
    const VectorXd v = prior.variances(Eigen::Map<const VectorXd>(hyperparameters.data(), prior.mean.size()));
    Gram gram(columns_.size(), 0);
    for (std::size_t first = 0; first < design.size(); first += readings_at_once) {
      const MatrixXd x = rows(design.subspan(first, std::min(readings_at_once, design.size() - first)));
      gram.add(x, VectorXd::Zero(x.rows()), MatrixXd(x.rows(), 0));
    }
    const VectorXd roots = v.cwiseSqrt();
    const MatrixXd inverse = inverse_of(gram.g, parts_of(gram.g, columns_.calibration_count()), v, 1).matrix;
    covariance_ = roots.asDiagonal() * inverse * roots.asDiagonal();
    targets_ = MatrixXd::Zero(columns_.isotropic_count(), columns_.isotropic_count());
  }

  const MixedColumns& columns() const { return columns_; }
  const MatrixXd& covariance() const { return covariance_; }

  /// Rows of readings over their noise.
  MatrixXd rows(std::span<const Geometry> geometries) const {
    const bool relative = components_.law.relative && feeds_f11(columns_.isotropic());
    VectorXd f11;
    if (relative && components_.f11.empty())
      f11 = VectorXd::Constant(static_cast<Index>(geometries.size()), 1 / std::numbers::pi);
    else if (relative)
      f11 = first_f11(components_.f11, components_.mapping, geometries);
    const VectorXd w = reading_weights(components_.law, geometries, f11) / std::sqrt(noise_);
    return w.replicate(elements(), 1).asDiagonal() * columns_.read_at(geometries);
  }

  /// Counts these rows h, one target, in units of their variance now.
  void want(const MatrixXd& h) { targets_ += h.transpose() * h / (variances(h).sum()); }
  bool is_wanted() const { return targets_.trace() > 0; }
  VectorXd variances(const MatrixXd& h) const {
    const Index n = columns_.isotropic_count();
    return (h * covariance_.topLeftCorner(n, n)).cwiseProduct(h).rowwise().sum();
  }

  // ---- choosing ----

  void consider(std::span<const Geometry> candidates) {
    candidates_ = rows(candidates);
    const MatrixXd vx = covariance_ * candidates_.transpose();
    q_ = candidates_.cwiseProduct(vx.transpose()).rowwise().sum();
    const MatrixXd top = vx.topRows(targets_.rows());
    lowered_ = (targets_ * top).cwiseProduct(top).colwise().sum();
  }
  /// By how much each candidate lowers the targets.
  void add_gains(VectorXd& gains) const {
    const VectorXd of_rows = lowered_.cwiseQuotient((1 + q_.array()).matrix());
    for (Index e = 0; e < elements(); ++e) gains += of_rows.segment(e * gains.size(), gains.size());
  }
  void take(Index candidate, Index count) {
    for (Index e = 0; e < elements(); ++e) take_row(e * count + candidate);
  }

 private:
  Index elements() const { return static_cast<Index>(columns_.read().size()); }  // in a reading
  VectorXd times_covariance(const VectorXd& x) const {
    VectorXd result = covariance_.selfadjointView<Eigen::Lower>() * x;
    for (const auto& [v, d] : taken_) result -= v * (v.dot(x) / d);
    return result;
  }
  void take_row(Index row) {
    const Index n = targets_.rows();
    const VectorXd v = times_covariance(candidates_.row(row));
    VectorXd of_targets = VectorXd::Zero(v.size());
    of_targets.head(n) = targets_ * v.head(n);
    const double d = 1 + q_(row), squared = v.dot(of_targets);
    MatrixXd both(v.size(), 2);
    both << v, times_covariance(of_targets);
    const MatrixXd products = candidates_ * both;
    const auto a = products.col(0).array(), b = products.col(1).array();
    q_.array() -= a.square() / d;
    lowered_.array() += a.square() * (squared / (d * d)) - 2 / d * a * b;
    taken_.emplace_back(v, d);
  }

  const VarianceComponents& components_;
  MixedColumns columns_;
  double noise_ = 0;
  MatrixXd covariance_, targets_;
  MatrixXd candidates_;
  VectorXd q_, lowered_;  // xᵀV x and xᵀV M V x of each row
  std::vector<std::pair<VectorXd, double>> taken_;
};

/// ∫ f11 cos θr dΩr as a row over the isotropic modes.
MatrixXd hemispherical_row(const MixedColumns& columns, double theta) {
  const Block& block = columns.isotropic();
  const Rows rows(block.modes, Family::isotropic);
  const Orders highest = orders(std::vector{block});
  MatrixXd result = MatrixXd::Zero(1, columns.isotropic_count());
  std::vector<double> row(rows.columns());
  rows.add(0, functions_at({theta, 0}, std::max(highest.f11, highest.other), columns.mapping()),
           over_hemisphere(columns.mapping()), row.data());
  result.row(0) = Eigen::Map<const VectorXd>(row.data(), result.cols());
  return result;
}

MatrixXd rows_of(const PlanTarget& target, const MixedColumns& columns) {
  switch (target.kind) {
    case PlanTarget::Kind::block:
      return columns.isotropic_at(spread_directions(spread));
    case PlanTarget::Kind::dhr:
      return hemispherical_row(columns, target.geometry.incident.theta);
    case PlanTarget::Kind::f11:
      return columns.isotropic_at({&target.geometry, 1});
  }
  throw std::invalid_argument("there is no such target");
}

std::size_t block_of(const PlanTarget& target, std::size_t count) {
  const std::size_t block = target.kind == PlanTarget::Kind::block ? target.block : 0;
  if (block >= count) throw std::invalid_argument("there is no block " + std::to_string(block));
  return block;
}

void require_measurable(std::span<const Geometry> geometries) {
  for (std::size_t g = 0; g < geometries.size(); ++g) {
    require_valid(geometries[g], ("geometry " + std::to_string(g + 1)).c_str());
    if (std::max(geometries[g].incident.theta, geometries[g].reflected.theta) > std::numbers::pi / 2 - 1e-9)
      throw std::invalid_argument("geometry " + std::to_string(g + 1) + ": nothing is measured at 90 degrees");
  }
}

/// The blocks that targets ask for.
std::map<std::size_t, PlannedBlock> planned(const VarianceComponents& components, std::span<const Geometry> design,
                                            std::span<const PlanTarget> targets) {
  require_measurable(design);
  std::map<std::size_t, PlannedBlock> result;
  for (const PlanTarget& target : targets) {
    const std::size_t block = block_of(target, components.blocks.size());
    if (!result.contains(block)) result.try_emplace(block, components, block, design);
  }
  return result;
}

}  // namespace

VarianceComponents components_of(const Posterior& posterior, double wavelength) {
  const PosteriorData& data = posterior.data();
  const PosteriorAt& at = *std::ranges::min_element(
      data.wavelengths, {}, [&](const PosteriorAt& one) { return std::abs(one.wavelength - wavelength); });
  VarianceComponents result{data.orders, data.mapping, at.law, at.f11, {}, data.unread};
  for (const Block& block : blocks(Family::isotropic, data.orders)) {
    const auto known = std::ranges::find(posterior.blocks(), block.name, &Block::name);
    const auto b = static_cast<std::size_t>(known - posterior.blocks().begin());
    result.blocks.push_back(
        known == posterior.blocks().end()
            ? VarianceComponents::OfBlock{}
            : VarianceComponents::OfBlock{at.blocks[b].hyperparameters, at.blocks[b].noise_variance});
  }
  return result;
}

VarianceComponents default_components(double noise) {
  VarianceComponents result;
  for (const std::vector<double>& of_block :  // 11, g, 14, uv, h, 44
       {std::vector{-5.2, 4.8, -9.8, -14.5, -13.6, 2.0, -12.5, -12.2},
        std::vector{-10.5, 3.6, -10.9, -14.9, -14.8, 2.2, -13.8, -13.5},
        std::vector{-14.4, 3.0, -12.8, -14.0, -12.6, 2.1, -13.9, -13.1},
        std::vector{-7.3, 5.2, -9.8, -13.3, -14.2, 1.8, -14.2, -14.8},
        std::vector{-9.9, 4.4, -7.7, -14.4, -14.7, 3.1, -13.3, -15.0},
        std::vector{-7.4, 4.5, -9.3, -13.4, -13.1, 1.8, -13.1, -13.0}})
    result.blocks.push_back({of_block, noise * noise});
  return result;
}

std::vector<double> expected_uncertainties(const VarianceComponents& components, std::span<const Geometry> design,
                                           std::span<const PlanTarget> targets) {
  const auto blocks = planned(components, design, targets);
  std::vector<double> result;
  for (const PlanTarget& target : targets) {
    const PlannedBlock& block = blocks.at(block_of(target, components.blocks.size()));
    result.push_back(std::sqrt(block.variances(rows_of(target, block.columns())).mean()));
  }
  return result;
}

namespace {

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> result;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    result.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return result;
}

std::string in_words(double degrees) { return rounded(degrees, 6); }

/// The same readings, reading i of them with the sample turned by this part of a turn.
NamedDesign turned(const NamedDesign& design, const std::string& how, double (*part)(std::size_t)) {
  NamedDesign result{design.name + ", " + how, design.geometries};
  for (std::size_t i = 0; i < result.geometries.size(); ++i) {
    const double turn = 2 * std::numbers::pi * part(i);
    result.geometries[i].incident.phi += turn;
    result.geometries[i].reflected.phi += turn;
  }
  return result;
}

}  // namespace

std::vector<NamedTarget> block_targets(const VarianceComponents& components) {
  std::vector<NamedTarget> result;
  const std::vector<Block> list = blocks_of(components);
  for (std::size_t b = 0; b < list.size(); ++b) {
    if (components.blocks[b].hyperparameters.empty()) continue;
    std::string name = list[b].name;
    std::ranges::replace(name, ',', '_');
    result.push_back({name, {PlanTarget::Kind::block, b, {}}});
  }
  return result;
}

std::vector<NamedTarget> targets_from(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text, ':');
  std::vector<NamedTarget> result;
  if (parts[0] == "dhr" && parts.size() == 2) {
    for (const std::string& one : parts_of(parts[1], ',')) {
      const double theta = parse_number(one);
      result.push_back({"dhr_" + in_words(theta), {PlanTarget::Kind::dhr, 0, {direction_from_degrees(theta, 0), {}}}});
    }
  } else if (parts[0] == "f" && (parts.size() == 3 || parts.size() == 4)) {
    const double theta_i = parse_number(parts[1]), theta_r = parse_number(parts[2]),
                 phi = parts.size() == 4 ? parse_number(parts[3]) : 180;
    result.push_back(
        {"f_" + in_words(theta_i) + "_" + in_words(theta_r) + (parts.size() == 4 ? "_" + in_words(phi) : ""),
         {PlanTarget::Kind::f11, 0, {direction_from_degrees(theta_i, 0), direction_from_degrees(theta_r, phi)}}});
  }
  if (result.empty())
    throw std::invalid_argument("target " + in_quotes(text) +
                                ": expected dhr:THETA[,THETA...] or f:THETA_I:THETA_R[:PHI_R], in degrees");
  return result;
}

std::vector<NamedDesign> with_turns(const NamedDesign& design) {
  return {design,
          turned(design, "every second one with the sample turned by 180 degrees",
                 [](std::size_t i) { return i % 2 == 0 ? 0 : 0.5; }),
          turned(design, "sample turned by 222.5 degrees from each to the next",
                 [](std::size_t i) { return std::fmod(static_cast<double>(i) / std::numbers::phi, 1); })};
}

std::vector<std::size_t> chosen(const VarianceComponents& components, std::span<const Geometry> design,
                                std::span<const PlanTarget> targets, std::span<const Geometry> candidates,
                                std::size_t count) {
  if (candidates.empty()) throw std::invalid_argument("no candidates");
  if (targets.empty()) throw std::invalid_argument("no targets");
  if (candidates.size() > most_candidates)
    throw std::invalid_argument(std::to_string(candidates.size()) + " candidates, more than " +
                                std::to_string(most_candidates));
  if (count > most_picks)
    throw std::invalid_argument(std::to_string(count) + " of the candidates are asked for, more than " +
                                std::to_string(most_picks));
  require_measurable(candidates);
  auto blocks = planned(components, design, targets);
  for (const PlanTarget& target : targets) {
    PlannedBlock& block = blocks.at(block_of(target, components.blocks.size()));
    block.want(rows_of(target, block.columns()));
  }
  for (auto& [unused, block] : blocks) block.consider(candidates);
  std::vector<std::size_t> result;
  VectorXd gains(static_cast<Index>(candidates.size()));
  while (result.size() < count) {
    gains.setZero();
    for (const auto& [unused, block] : blocks) block.add_gains(gains);
    Index best = 0;
    gains.maxCoeff(&best);
    for (auto& [unused, block] : blocks) block.take(best, gains.size());
    result.push_back(static_cast<std::size_t>(best));
  }
  return result;
}

}  // namespace mmbrdf
