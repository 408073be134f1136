// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mmbrdf/radiometry.hpp"

// A prediction is linear in the coefficients of each block: element e is g_e · a(λ), with a(λ) = Σ_p λ^p a_p. So
//
//   cov(e, e') = g_eᵀ V(λ) g_e',     V(λ)_qq' = Σ_pp' λ^{p+p'} V_pq,p'q'
//
// within a block, and 0 between blocks. A change of frame, and the turning of published models, are M → L M R.

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Table = std::array<double, zernike_count(max_order)>;

constexpr double estimability_limit = 1e-8;  // theory 4.2

Index index(std::size_t n) { return static_cast<Index>(n); }

/// One block at one wavelength.
struct BlockAt {
  struct ModeTerm {
    Index mode;
    std::size_t incident, reflected;
    double weight;
  };
  std::vector<std::size_t> elements;
  std::vector<std::vector<ModeTerm>> terms;  // for each of these elements
  VectorXd coefficients;                     // a(λ)
  MatrixXd covariance;                       // V(λ)
  MatrixXd free;                             // combinations that the data leave free, folded at λ: modes × number
  double lengthening = 1;                    // of a row over the modes to the row over all powers

  VectorXd row(std::size_t element, const Table& k_i, const Table& k_r) const {
    VectorXd g = VectorXd::Zero(covariance.rows());
    for (const ModeTerm& t : terms[element]) g(t.mode) += t.weight * k_i[t.incident] * k_r[t.reflected];
    return g;
  }
};

/// Eigenvectors of the covariance with eigenvalue 0: as many as coefficients less rank, for a solution of minimum norm.
MatrixXd free_combinations(const FittedBlock& fitted) {
  const Index size = index(fitted.coefficients.size()), free = size - fitted.rank;
  if (free == 0) return MatrixXd(size, 0);
  const Eigen::Map<const MatrixXd> covariance(fitted.covariance.data(), size, size);
  if (fitted.rank == 0 && !covariance.isZero(0))
    throw std::invalid_argument("the rank of block " + fitted.block.name + " is not known");
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(covariance).eigenvectors().leftCols(free);
}

BlockAt block_at(const FittedBlock& fitted, const Model& model, double wavelength) {
  if (fitted.covariance.empty())
    throw std::invalid_argument("the covariance of block " + fitted.block.name + " is not known");
  const Index modes = index(fitted.block.modes.size()), size = index(fitted.coefficients.size());
  MatrixXd fold = MatrixXd::Zero(size, modes);  // a(λ) = foldᵀ a
  double power = 1, squares = 0;
  for (int p = 0; p <= model.powers; ++p, power *= wavelength) {
    fold.middleRows(p * modes, modes).diagonal().setConstant(power);
    squares += power * power;
  }
  const double scale = fitted.block.name == "11" ? model.reflectance.at(wavelength) : 1;
  BlockAt result;
  result.coefficients = scale * fold.transpose() * Eigen::Map<const VectorXd>(fitted.coefficients.data(), size);
  result.covariance =
      scale * scale * fold.transpose() * Eigen::Map<const MatrixXd>(fitted.covariance.data(), size, size) * fold;
  if (!result.coefficients.allFinite() || !result.covariance.allFinite())
    throw std::invalid_argument("block " + fitted.block.name + " is not finite at this wavelength");
  result.free = fold.transpose() * free_combinations(fitted);
  result.lengthening = std::sqrt(squares);
  result.terms.resize(fitted.block.elements.size());
  for (const auto& [row, column] : fitted.block.elements)
    result.elements.push_back(static_cast<std::size_t>(4 * row + column));
  for (Index q = 0; q < modes; ++q)
    for (const Term& term : terms(fitted.block.modes[static_cast<std::size_t>(q)], model.family))
      for (std::size_t e = 0; e < result.elements.size(); ++e)
        if (result.elements[e] == static_cast<std::size_t>(4 * term.row + term.column))
          result.terms[e].push_back(
              {q, static_cast<std::size_t>(term.incident), static_cast<std::size_t>(term.reflected), term.weight});
  return result;
}

/// The covariance after M → left M right, element by element of either argument.
MuellerCovariance mapped(const MuellerCovariance& c, const Mueller& left, const Mueller& right) {
  const auto map_rows = [&](const MuellerCovariance& from) {  // of the first argument; the result is transposed
    MuellerCovariance to;
    for (std::size_t other = 0; other < 16; ++other) {
      Mueller m;
      for (std::size_t e = 0; e < 16; ++e) m.elements[e] = from(e, other);
      m = left * m * right;
      for (std::size_t e = 0; e < 16; ++e) to(other, e) = m.elements[e];
    }
    return to;
  };
  return map_rows(map_rows(c));
}

}  // namespace

struct PreparedUncertainty::Blocks {
  std::vector<BlockAt> list;
  int order = 0;
  DiscMapping mapping = DiscMapping::lambert;
  bool turns = false;

  std::pair<Table, Table> tables(const Geometry& geometry) const {
    const auto& [i, r] = geometry;
    const double turn = turns ? i.phi : 0;
    std::pair<Table, Table> result;
    zernike_table(order, disc_point(Direction{i.theta, i.phi - turn}, mapping), result.first.data());
    zernike_table(order, disc_point(Direction{r.theta, r.phi - turn}, mapping), result.second.data());
    return result;
  }
};

Mueller standard_uncertainty(const MuellerCovariance& covariance) {
  Mueller result;
  for (std::size_t e = 0; e < 16; ++e) result.elements[e] = std::sqrt(std::max(covariance(e, e), 0.0));
  return result;
}

PreparedUncertainty::PreparedUncertainty(std::shared_ptr<const Blocks> blocks) : blocks_(std::move(blocks)) {}

PreparedUncertainty prepare_uncertainty(const Model& model, double wavelength, Rotation rotation) {
  require_valid(model);
  require_wavelength(wavelength);
  auto blocks = std::make_shared<PreparedUncertainty::Blocks>();
  const Orders highest = orders(model);
  blocks->order = std::max(highest.f11, highest.other);
  blocks->mapping = model.mapping;
  blocks->turns = model.family == Family::germer2017 && rotation == Rotation::covariant;
  for (const FittedBlock& fitted : model.blocks) blocks->list.push_back(block_at(fitted, model, wavelength));
  return PreparedUncertainty(std::move(blocks));
}

PreparedUncertainty::Estimate PreparedUncertainty::estimate(const Geometry& geometry, Frame frame) const {
  require_valid(geometry, "uncertainty");
  const auto [k_i, k_r] = blocks_->tables(geometry);
  Mueller m;
  MuellerCovariance c;
  for (const BlockAt& block : blocks_->list) {
    std::vector<VectorXd> rows;
    for (std::size_t e = 0; e < block.elements.size(); ++e) rows.push_back(block.row(e, k_i, k_r));
    for (std::size_t e = 0; e < rows.size(); ++e) {
      m.elements[block.elements[e]] = rows[e].dot(block.coefficients);
      const VectorXd product = block.covariance * rows[e];
      for (std::size_t other = 0; other <= e; ++other)
        c(block.elements[e], block.elements[other]) = c(block.elements[other], block.elements[e]) =
            rows[other].dot(product);
    }
  }
  const Mueller turn = rotator(blocks_->turns ? -geometry.incident.phi : 0);
  const FrameAngles angles = angles_to_xy(geometry, frame);
  const Mueller left = rotator(-angles.scattered) * turn, right = turn * rotator(angles.incident);
  return {left * m * right, mapped(c, left, right)};
}

MuellerCovariance PreparedUncertainty::normalized(const Geometry& geometry, Frame frame) const {
  return estimate(geometry, frame).covariance;
}

MuellerCovariance PreparedUncertainty::evaluate(const Geometry& geometry, Frame frame) const {
  auto [m, c] = estimate(geometry, frame);
  const double f11 = m(0, 0);
  m(0, 0) = 1;
  MuellerCovariance result;  // F_e = f11 m_e, and F_11 = f11: dF_e = m_e df11 + f11 dm_e
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t other = 0; other < 16; ++other) {
      const double direct = e == 0 || other == 0 ? 0 : f11 * f11 * c(e, other);
      result(e, other) = m.elements[e] * m.elements[other] * c(0, 0) + direct;
    }
  return result;
}

bool PreparedUncertainty::estimable(const Geometry& geometry) const {
  require_valid(geometry, "uncertainty");
  const auto [k_i, k_r] = blocks_->tables(geometry);
  for (const BlockAt& block : blocks_->list)
    for (std::size_t e = 0; e < block.elements.size(); ++e) {
      const VectorXd g = block.row(e, k_i, k_r);
      if ((block.free.transpose() * g).norm() > estimability_limit * block.lengthening * g.norm()) return false;
    }
  return true;
}

double PreparedUncertainty::directional_hemispherical_reflectance(const Direction& incident) const {
  require_valid(Geometry{incident, {}}, "uncertainty");
  const auto [k_i, unused] = blocks_->tables({incident, incident});
  Table integrals{};
  for (const int n : {0, 2})
    integrals[static_cast<std::size_t>(zernike_index(n, 0))] = projected_integral(n, blocks_->mapping);
  const BlockAt& f11 = blocks_->list.front();
  const VectorXd g = f11.row(0, k_i, integrals);
  return std::sqrt(std::max(g.dot(f11.covariance * g), 0.0));
}

}  // namespace mmbrdf
