// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty/draws.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "basis/spectral.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "numerics/dense.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/gram.hpp"
#include "numerics/random.hpp"
#include "numerics/semidefinite.hpp"
#include "text/numbers.hpp"
#include "uncertainty/block_at.hpp"
#include "uncertainty/joint_covariance.hpp"
#include "uncertainty/variances.hpp"

//   a, V    coefficients of a block (with the reflectance table, for 11) and their covariance = U diag(s) Uᵀ
//   z       independent normal numbers; a + U diag(√s) Uᵀ z has the covariance V
//   v, B    variances of the values of a table, where they are independent, and their covariance with a: the values are
//           drawn as √v z, a as B v^-½ z + (V − B v⁻¹ Bᵀ)^½ z', without a matrix of the square of their number

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// a, and behind it the values of the reflectance table where they are drawn along.
VectorXd means(const FittedBlock& fitted, const ReflectanceTable& table) {
  const Index size = index(fitted.coefficients.size());
  const Eigen::Map<const VectorXd> a(fitted.coefficients.data(), size);
  if (!has_uncertain_reflectance(fitted, table)) return a;
  const Index count = index(table.values.size());
  VectorXd result(size + count);
  result << a, Eigen::Map<const VectorXd>(table.values.data(), count);
  return result;
}

/// U diag(√s) Uᵀ z: unlike U diag(√s) z, the same for each choice of the eigenvectors.
MatrixXd root_times(const MatrixXd& covariance, const MatrixXd& z, const std::string& block) {
  const auto [vectors, s] = dense::eigensystem(covariance);
  require_semidefinite(s, "block " + block, covariance_tolerance);
  const MatrixXd root = product(vectors * s.cwiseMax(0).cwiseSqrt().asDiagonal(), vectors.transpose());
  return symmetric_times(root, z);
}

MatrixXd with_independent_values(const FittedBlock& fitted, const ReflectanceTable& table, const MatrixXd& z) {
  const MatrixXd own = own_covariance(fitted);
  MatrixXd scaled = covariance_with_values(fitted, table), result(z.rows(), z.cols());
  const Index count = scaled.cols();
  for (Index k = 0; k < count; ++k) {
    const double variance = table.covariance[static_cast<std::size_t>(k)],
                 deviation = std::sqrt(std::max(variance, 0.0));
    result.row(own.rows() + k) = deviation * z.row(own.rows() + k);
    if (variance < 0 || (variance == 0 && !scaled.col(k).isZero(0)))
      throw std::invalid_argument("the covariance of block " + fitted.block.name +
                                  " is not positive semidefinite: a reflectance has variance " + shortest(variance));
    if (variance > 0) scaled.col(k) /= deviation;
  }
  const auto [vectors, s] = dense::eigensystem(own - scaled * scaled.transpose());
  require_semidefinite(Eigen::Vector2d(s(0), own.trace()), "block " + fitted.block.name, covariance_tolerance);
  result.topRows(own.rows()) = scaled * z.bottomRows(count) + vectors * s.cwiseMax(0).cwiseSqrt().asDiagonal() *
                                                                  (vectors.transpose() * z.topRows(own.rows()));
  return result;
}

/// Independent normal numbers, a column for each draw, become deviations of the parameters of a block.
MatrixXd correlated(const FittedBlock& fitted, const ReflectanceTable& table, const MatrixXd& z) {
  const MatrixXd own = own_covariance(fitted);
  if (!has_uncertain_reflectance(fitted, table)) return root_times(own, z, fitted.block.name);
  if (has_independent_values(table)) return with_independent_values(fitted, table, z);
  const Eigen::Map<const MatrixXd> with = covariance_with_values(fitted, table),
                                   values(table.covariance.data(), with.cols(), with.cols());
  MatrixXd joint(z.rows(), z.rows());
  joint << own, with, with.transpose(), values;
  return root_times(joint, z, fitted.block.name);
}

/// The model over the modes behind a posterior, with coefficients of 0: its covariance is another at each wavelength.
Model over_modes_behind(const Model& model) {
  Model result;
  result.mapping = model.mapping;
  result.not_measured = model.not_measured;
  result.reflectance = {model.reflectance.wavelengths, model.reflectance.values};
  result.validity = model.validity;
  for (const Block& block : model.posterior->blocks())
    result.blocks.push_back({block, std::vector<double>(block.modes.size()), {}, 0, 0});
  return result;
}

/// Independent normal numbers, a column for each draw, over all blocks of it in turn.
void fill_normal(std::vector<MatrixXd>& blocks, unsigned long seed) {
  std::mt19937_64 engine(seed);
  for (Index draw = 0; draw < blocks.front().cols(); ++draw)
    for (MatrixXd& z : blocks)
      for (Index i = 0; i < z.rows(); i += 2) {
        const auto [first, second] = two_normal(engine);
        z(i, draw) = first;
        if (i + 1 < z.rows()) z(i + 1, draw) = second;
      }
}

}  // namespace

struct Draws::Coefficients {
  Model model;
  PreparedModel prepared;  // over the modes that are drawn
  int powers = 0;
  ReflectanceTable reflectance;
  std::vector<Index> sizes;      // powers × modes of each block
  std::vector<MatrixXd> blocks;  // coefficients by count; below those of block 11 the drawn values of the table;
                                 // of a posterior normal numbers, which become coefficients at a wavelength

  /// At a wavelength, of all modes by count: Σ_p λ^p a_p, and the factor of f11 of each.
  struct At {
    MatrixXd coefficients;
    VectorXd reflectances;
  };
  At at(double wavelength) const {
    return model.posterior ? of_posterior(blocks_at(model, wavelength)) : of_fit(wavelength);
  }
  At of_posterior(const std::vector<BlockAt>& list) const;
  At of_fit(double wavelength) const;
};

Draws::Coefficients::At Draws::Coefficients::of_posterior(const std::vector<BlockAt>& list) const {
  const Index count = blocks.front().cols();
  Index modes = 0, begin = 0;
  for (const BlockAt& block : list) modes += block.modes();
  At result{MatrixXd(modes, count), VectorXd::Constant(count, list.front().reflectance)};
  for (std::size_t b = 0; b < list.size(); ++b) {
    const BlockAt& block = list[b];
    const MatrixXd drawn = root_times(block.covariance, blocks[b], model.blocks[b].block.name);
    result.coefficients.middleRows(begin, block.modes()) = drawn.topRows(block.modes()).colwise() + block.coefficients;
    if (block.knows_reflectance()) result.reflectances += drawn.bottomRows(1).transpose();
    begin += block.modes();
  }
  return result;
}

Draws::Coefficients::At Draws::Coefficients::of_fit(double wavelength) const {
  Index modes = 0, begin = 0;
  for (const Index size : sizes) modes += size / (powers + 1);
  const Index count = blocks.front().cols();
  At result{MatrixXd::Zero(modes, count), VectorXd::Constant(count, reflectance.at(wavelength))};
  const std::vector<double> of_wavelength = powers_of(wavelength, powers);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Index size = sizes[b] / (powers + 1);
    for (Index p = 0; p <= powers; ++p)
      result.coefficients.middleRows(begin, size) +=
          of_wavelength[static_cast<std::size_t>(p)] * blocks[b].middleRows(p * size, size);
    begin += size;
  }
  if (reflectance.covariance.empty()) return result;
  const std::vector<double> weights = reflectance.weights(wavelength);
  const Index nodes = index(weights.size());
  result.reflectances = blocks[0].bottomRows(nodes).transpose() * Eigen::Map<const VectorXd>(weights.data(), nodes);
  return result;
}

void require_semidefinite(const Model& model) {
  require_valid(model);
  for (const FittedBlock& fitted : model.blocks)
    if (!fitted.covariance.empty())
      correlated(fitted, model.reflectance, MatrixXd::Zero(means(fitted, model.reflectance).size(), 1));
}

Draws::Draws(const Model& model, int count, unsigned long seed) : count_(count) {
  if (count < 2 || count > max_draws)
    throw std::invalid_argument("count = " + std::to_string(count) + ", must be in 2..." + std::to_string(max_draws));
  require_valid(model);
  const bool has_posterior = model.posterior.has_value();
  const Model over = has_posterior ? over_modes_behind(model) : model;
  Coefficients drawn{model, prepare(over, 1), over.powers, over.reflectance, {}, {}};
  for (const FittedBlock& fitted : over.blocks) {
    drawn.sizes.push_back(index(fitted.coefficients.size()));
    const bool certified = has_posterior && has_uncertain_reflectance(fitted, model.reflectance);
    drawn.blocks.emplace_back(means(fitted, over.reflectance).size() + (certified ? 1 : 0), count);
  }
  fill_normal(drawn.blocks, seed);
  for (std::size_t b = 0; b < drawn.blocks.size() && !has_posterior; ++b) {
    drawn.blocks[b] = correlated(model.blocks[b], model.reflectance, drawn.blocks[b]);
    drawn.blocks[b].colwise() += means(model.blocks[b], model.reflectance);
  }
  coefficients_ = std::make_shared<const Coefficients>(std::move(drawn));
}

std::vector<PreparedModel> Draws::at(double wavelength) const {
  const Coefficients& drawn = *coefficients_;
  const PreparedModel model = drawn.prepared.at(wavelength);
  const auto [coefficients, reflectances] = drawn.at(wavelength);
  std::vector<PreparedModel> result;
  result.reserve(static_cast<std::size_t>(count_));
  for (Index draw = 0; draw < count_; ++draw)
    result.push_back(
        model.with({coefficients.col(draw).data(), static_cast<std::size_t>(coefficients.rows())}, reflectances(draw)));
  return result;
}

struct DrawnMatrices::Prepared {
  Variances rows;
  std::vector<Variances::Drawn> parts{};  // of `together` draws
  std::size_t count = 0;
  Elements unknown{};
};

DrawnMatrices Draws::matrices_at(double wavelength) const {
  const Coefficients& drawn = *coefficients_;
  const std::vector<BlockAt> blocks = blocks_at(drawn.model, wavelength);
  const auto [coefficients, reflectances] =
      drawn.model.posterior ? drawn.of_posterior(blocks) : drawn.of_fit(wavelength);
  const Orders highest = drawn.model.posterior ? drawn.model.posterior->data().orders : orders(drawn.model);
  DrawnMatrices::Prepared result{
      Variances(blocks, std::max(highest.f11, highest.other), drawn.model.mapping, turns(drawn.model))};
  result.count = static_cast<std::size_t>(count_);
  result.unknown = unknown_elements(drawn.model);
  constexpr auto most = static_cast<Index>(DrawnMatrices::together);
  for (Index first = 0; first < count_; first += most) {
    const Index here = std::min(most, count_ - first);
    Variances::Drawn& part = result.parts.emplace_back();
    Index begin = 0;
    for (const BlockAt& block : blocks) {
      MatrixXd columns = MatrixXd::Zero(block.covariance.rows(), here);
      columns.topRows(block.modes()) = coefficients.block(begin, first, block.modes(), here);
      part.blocks.emplace_back(columns);
      begin += block.modes();
    }
    part.reflectances.assign(reflectances.data() + first, reflectances.data() + first + here);
  }
  return DrawnMatrices(std::make_shared<const DrawnMatrices::Prepared>(std::move(result)));
}

std::size_t DrawnMatrices::count() const { return prepared_->count; }

void DrawnMatrices::evaluate(std::size_t first, std::span<const Geometry> geometries, Frame frame,
                             std::span<Mueller> out) const {
  const Variances::Drawn& part = prepared_->parts.at(first / together);
  const std::size_t count = part.reflectances.size();
  if (first % together != 0 || out.size() != geometries.size() * count)
    throw std::invalid_argument("draws from " + std::to_string(first) + " at " + std::to_string(geometries.size()) +
                                " geometries, room for " + std::to_string(out.size()));
  for (const Geometry& geometry : geometries) require_valid(geometry);
  prepared_->rows.matrices(part, geometries, frame, out);
  if (prepared_->unknown.none()) return;
  for (std::size_t g = 0; g < geometries.size(); ++g) {
    const FrameAngles angles = angles_to_xy(geometries[g], frame);
    const Elements unknown = turned_into(prepared_->unknown, -angles.scattered, -angles.incident);
    for (Mueller& m : out.subspan(g * count, count))
      for (std::size_t e = 0; e < 16; ++e)
        if (unknown[e]) m.elements[e] = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace mmbrdf
