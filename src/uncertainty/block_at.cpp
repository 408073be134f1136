// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/block_at.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "basis/spectral.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "numerics/dense.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/semidefinite.hpp"
#include "uncertainty/joint_covariance.hpp"

// Between two fitted wavelengths, at part τ of the way, the variances of a posterior are linear in τ; those of what the
// evaluated coefficients a(λ) deviate by from the posterior means μ,
//   (1 − τ) p₀² + τ p₁² + 2 τ (1 − τ) (p₀² + p₁²),     p = gᵀa(λ) − hᵀμ at either end,
// are those of a random walk between both ends and of a step that is not known better than they are (theory 8.5).
// Beyond the fitted wavelengths they are those of the nearest.

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Combinations that the data left free, as columns; every one where they are not known.
MatrixXd free_combinations(const FittedBlock& fitted) {
  const Index size = index(fitted.coefficients.size()), free = size - fitted.rank;
  if (free > 0 && fitted.null_space.empty()) return MatrixXd::Identity(size, size);
  return Eigen::Map<const MatrixXd>(fitted.null_space.data(), size, free);
}

VectorXd weights_at(const ReflectanceTable& table, double wavelength) {
  const std::vector<double> weights = table.weights(wavelength);
  return Eigen::Map<const VectorXd>(weights.data(), index(weights.size()));
}

/// Covariance of a(λ), and of R(λ) behind it where that is block 11 and R has a covariance.
MatrixXd folded_covariance(const FittedBlock& fitted, const MatrixXd& fold, const ReflectanceTable& table,
                           double wavelength) {
  const MatrixXd own = fold.transpose() * own_covariance(fitted) * fold;
  if (!has_uncertain_reflectance(fitted, table)) return own;
  const VectorXd weights = weights_at(table, wavelength),
                 with_own = fold.transpose() * (covariance_with_values(fitted, table) * weights);
  MatrixXd result(own.rows() + 1, own.cols() + 1);
  result << own, with_own, with_own.transpose(), variance_of_values(table, weights);
  return (result + result.transpose()) / 2;
}

/// Variances of products of three such numbers are finite.
void require_moderate(const BlockAt& block, const std::string& name) {
  constexpr double powers = 1e5;  // of moderate wavelengths
  if (!(block.coefficients.array().abs() <= powers * largest_coefficient).all() ||
      !(block.covariance.array().abs() <= powers * powers * largest_variance).all())
    throw std::invalid_argument(name + " is too large at this wavelength");
}

BlockAt block_at(const FittedBlock& fitted, const Model& model, double wavelength) {
  const Index modes = index(fitted.block.modes.size()), size = index(fitted.coefficients.size());
  const std::vector<double> powers = powers_of(wavelength, model.powers);
  const MatrixXd fold = repetition(modes, powers);
  BlockAt result{fitted.block.elements, Rows(fitted.block.modes, model.family), {}, {}, {}, {}, {}};
  if (feeds_f11(fitted.block)) result.reflectance = model.reflectance.at(wavelength);
  result.covariance = folded_covariance(fitted, fold, model.reflectance, wavelength);
  result.coefficients = fold.transpose() * Eigen::Map<const VectorXd>(fitted.coefficients.data(), size);
  require_moderate(result, "block " + fitted.block.name);
  const double terms = Eigen::Map<const VectorXd>(powers.data(), index(powers.size())).squaredNorm() *
                       own_covariance(fitted).trace();  // powers of the wavelength may cancel
  VectorXd eigenvalues = dense::eigenvalues(result.covariance);
  eigenvalues(eigenvalues.size() - 1) = std::max(eigenvalues(eigenvalues.size() - 1), 1e-6 * terms);
  require_semidefinite(eigenvalues, "block " + fitted.block.name, covariance_tolerance);
  result.of_fit = result.covariance;
  result.free = fold.transpose() * free_combinations(fitted);
  result.lengthening = Eigen::Map<const VectorXd>(powers.data(), index(powers.size())).norm();
  return result;
}

/// What counts of a posterior at a wavelength.
struct Node {
  std::size_t index;
  double posterior, deviation;  // factors of variances
};

std::vector<Node> nodes_at(const std::vector<PosteriorAt>& known, double wavelength) {
  const auto above = std::ranges::lower_bound(known, wavelength, {}, &PosteriorAt::wavelength);
  if (above == known.end()) return {{known.size() - 1, 1, 1}};
  const auto high = static_cast<std::size_t>(above - known.begin());
  if (high == 0 || above->wavelength == wavelength) return {{high, 1, 1}};
  const double low = known[high - 1].wavelength, tau = (wavelength - low) / (above->wavelength - low),
               step = 2 * tau * (1 - tau);
  return {{high - 1, 1 - tau, 1 - tau + step}, {high, tau, tau + step}};
}

/// Coefficients of the modes behind a block: those that are evaluated, at a wavelength, and 0.
VectorXd among(const Block& behind, const FittedBlock& fitted, double wavelength) {
  VectorXd result = VectorXd::Zero(index(behind.modes.size()));
  const std::vector<double> a = at_wavelength(fitted.coefficients, fitted.block.modes.size(), wavelength);
  for (std::size_t q = 0; q < a.size(); ++q)
    result(std::ranges::find(behind.modes, fitted.block.modes[q]) - behind.modes.begin()) = a[q];
  return result;
}

/// Of the reflectance at a wavelength, from the certificate alone.
double table_uncertainty(const ReflectanceTable& table, double wavelength) {
  return std::sqrt(std::max(variance_of_values(table, weights_at(table, wavelength)), 0.0));
}

/// dR/da of a reflectance R that makes the DHR R D, D = s·a, a certified one: −R s/D. None: 0.
VectorXd of_certified(const BlockAt& block, const ReflectanceTable& table, const PosteriorData& data,
                      double wavelength) {
  const auto count = index(table.certified_theta.size());
  if (count == 0) return VectorXd::Zero(block.modes());
  const double theta =
      weights_at(table, wavelength).dot(Eigen::Map<const VectorXd>(table.certified_theta.data(), count));
  const KTable incident = functions_at({theta, 0}, std::max(data.orders.f11, data.orders.other), data.mapping);
  const VectorXd s = block.row({}, incident, over_hemisphere(data.mapping));
  return -block.reflectance / s.dot(block.coefficients) * s;
}

BlockAt block_at(const Posterior& posterior, const Model& model, std::size_t b, double wavelength) {
  const PosteriorData& data = posterior.data();
  const Block& behind = posterior.blocks()[b];
  const Index modes = index(behind.modes.size());
  const bool uncertain = has_uncertain_reflectance(model.blocks[b], model.reflectance);
  const Index size = uncertain ? modes + 1 : modes;
  BlockAt result{behind.elements,
                 Rows(behind.modes, Family::isotropic),
                 among(behind, model.blocks[b], wavelength),
                 MatrixXd::Zero(size, size),
                 {},
                 {},
                 MatrixXd(modes, 0)};
  if (feeds_f11(behind)) result.reflectance = model.reflectance.at(wavelength);
  // From errors of the modes to those of all parameters, and back to their covariances.
  MatrixXd all = MatrixXd::Identity(size, modes);
  if (uncertain) all.bottomRows(1) = of_certified(result, model.reflectance, data, wavelength).transpose();
  const auto add = [&](const std::string& name, const VectorXd& effect) {
    result.parts.push_back({name, effect});
    result.covariance += effect * effect.transpose();
  };
  MatrixXd of_modes = MatrixXd::Zero(modes, modes);
  if (uncertain) add("certificate", table_uncertainty(model.reflectance, wavelength) * VectorXd::Unit(size, modes));
  for (const auto& [k, factor, deviation] : nodes_at(data.wavelengths, wavelength)) {
    const PosteriorAt& at = data.wavelengths[k];
    const BlockPosterior& here = at.blocks[b];
    of_modes += factor * Eigen::Map<const MatrixXd>(posterior.covariance(k, b).data(), modes, modes);
    const Eigen::Map<const Eigen::MatrixXf> shared(here.shared.data(), modes, index(data.errors.size()));
    for (std::size_t e = 0; e < data.errors.size(); ++e)
      if (data.errors[e].size > 0)
        add(data.errors[e].name, std::sqrt(factor) * data.errors[e].size * all * shared.col(index(e)).cast<double>());
    add("projection",
        std::sqrt(deviation) * all *
            (among(behind, model.blocks[b], at.wavelength) - Eigen::Map<const VectorXd>(here.mean.data(), modes)));
  }
  result.of_fit = uncertain ? MatrixXd(all * of_modes * all.transpose()) : of_modes;
  result.covariance += result.of_fit;
  require_moderate(result, "block " + behind.name + " of the posterior");
  return result;
}

}  // namespace

std::vector<BlockAt> blocks_at(const Model& model, double wavelength) {
  std::vector<BlockAt> result;
  for (std::size_t b = 0; b < model.blocks.size(); ++b)
    result.push_back(model.posterior ? block_at(*model.posterior, model, b, wavelength)
                                     : block_at(model.blocks[b], model, wavelength));
  return result;
}

}  // namespace mmbrdf
