// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/mixed/posterior.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "mixed/readings.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/threads.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

void require_count(std::size_t found, std::size_t expected, const std::string& what) {
  require(found == expected, std::to_string(found) + " " + what + ", expected " + std::to_string(expected));
}

bool all_finite(const auto& numbers) {
  return std::ranges::all_of(numbers, [](auto x) { return std::isfinite(x); });
}

void require_valid(const BlockPosterior& p, const Block& block, const MixedColumns& columns, std::size_t errors,
                   bool rounded) {
  const std::string of = "of block " + block.name;
  const std::size_t modes = block.modes.size(), free = static_cast<std::size_t>(columns.size()) - modes;
  require_count(p.hyperparameters.size(), hyperparameter_names(block).size(), "hyperparameters " + of);
  require_count(p.mean.size(), modes, "means " + of);
  require_count(p.free_mean.size(), free, "means of free modes " + of);
  require_count(p.shared.size(), errors * modes, "effects of shared errors " + of);
  require_count(p.deviations.size(), rounded ? modes : 0, "deviations " + of);
  require_count(p.factor.size(), rounded ? modes * (modes + 1) / 2 : 0, "rounded correlations " + of);
  require(std::ranges::all_of(p.deviations, [](float d) { return d >= 0; }), "deviations " + of + " must be 0 or more");
  require(p.noise_variance > 0 && std::isfinite(p.noise_variance),
          "noise variance " + of + ": " + mmbrdf::rounded(p.noise_variance, 6) + ", must be positive");
  require(all_finite(p.hyperparameters) && all_finite(p.mean) && all_finite(p.free_mean) && all_finite(p.shared) &&
              all_finite(p.deviations),
          "numbers " + of + " must be finite");
}

std::size_t first_coefficients() { return blocks(Family::isotropic, {first_order, 0}).front().modes.size(); }

void require_measurable(const std::vector<ReadingDirections>& readings) {
  require(!readings.empty(), "a list of directions is empty");
  for (const auto& [angles, count] : readings)
    require(count > 0 && all_finite(angles) && std::min(angles[0], angles[2]) >= 0 &&
                std::max(angles[0], angles[2]) <= std::numbers::pi / 2,
            "directions must have polar angles of 0 to 90 degrees and be counted");
}

/// Of a block that is there some reading tells, and what is unknown of it is not what was read.
void require_read(const PosteriorData& data, const std::vector<Block>& blocks) {
  Elements there;
  for (const Block& block : blocks) {
    Elements own;
    for (const Element& element : block.elements) own.set(element.index());
    require((own & ~data.unread).any(), "unread are all elements of block " + block.name);
    there |= own;
  }
  const Elements none = data.unread & ~there, read = data.not_measured & there & ~data.unread;
  require(none.none(), "unread, and of no block that is there: " + element_names(none));
  require(read.none(), "not measured, and not among those unread: " + element_names(read));
}

/// C = S R Rᵀ S: S the standard deviations, the rows of R of norm 1 but for rounding.
MatrixXd from_rounded(const BlockPosterior& p) {
  const Index n = index(p.mean.size());
  MatrixXd r = MatrixXd::Zero(n, n);
  std::size_t next = 0;
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j <= i; ++j) r(i, j) = p.factor[next++] / full_scale;
    r.row(i) *= p.deviations[static_cast<std::size_t>(i)] / std::max(r.row(i).norm(), 1e-300);
  }
  return r * r.transpose();
}

}  // namespace

MatrixXd covariance_of_all(const PosteriorData& data, const PosteriorAt& at, const BlockPosterior& block,
                           const MixedColumns& columns) {
  require(block.factor.empty(), "a posterior in its rounded form holds the isotropic modes alone");
  const VectorXd variances = prior_of(columns).variances(
      Eigen::Map<const VectorXd>(block.hyperparameters.data(), index(block.hyperparameters.size())));
  const Gram gram = gram_of(columns, data.readings[at.readings], at.law, at.f11);
  const Parts parts = parts_of(gram.g, columns.calibration_count());
  const auto roots = variances.cwiseSqrt().asDiagonal();
  const Inverse inverse = inverse_of(gram.g, parts, variances, block.noise_variance);
  require(std::isfinite(inverse.log_determinant), "covariances of the posterior are not positive definite");
  return roots * inverse.matrix * roots;
}

std::vector<SharedError> shared_errors(const DeclaredErrors& declared) {
  return {{"declared scale", declared.scale},
          {"declared source arm", declared.source},
          {"declared receiver arm", declared.receiver}};
}

namespace {

/// What comes of the data.
struct Numbers {
  struct Covariances {
    std::once_flag once;
    std::vector<std::vector<double>> of_blocks;
  };

  PosteriorData data;
  std::vector<MixedColumns> columns;
  mutable std::vector<Covariances> known;  // at each wavelength

  Numbers(PosteriorData from, const std::vector<Block>& blocks);
  MatrixXd covariance(const PosteriorAt& at, std::size_t block) const;
  const std::vector<double>& covariance(std::size_t wavelength, std::size_t block) const;
};

Numbers::Numbers(PosteriorData from, const std::vector<Block>& blocks)
    : data(std::move(from)), known(data.wavelengths.size()) {
  require(!data.not_measured[0], "f11 must be measured");
  require(!data.wavelengths.empty(), "no wavelength");
  require(data.errors.size() >= declared_errors, std::to_string(data.errors.size()) + " shared errors, expected " +
                                                     std::to_string(declared_errors) + " or more");
  for (const auto& list : data.readings) require_measurable(list);
  for (const auto& [name, size] : data.errors)
    require(size >= 0 && std::isfinite(size), "size of the error " + name + " must be 0 or more");
  require_read(data, blocks);
  for (const Block& block : blocks) columns.emplace_back(block, data.mapping, data.unread);
  double before = 0;
  for (const PosteriorAt& at : data.wavelengths) {
    require(at.wavelength > before && std::isfinite(at.wavelength), "wavelengths must be positive and rise");
    before = at.wavelength;
    require_count(at.blocks.size(), blocks.size(), "blocks");
    const bool rounded = !at.blocks[0].factor.empty();
    if (!rounded) require(at.f11.size() == first_coefficients() && all_finite(at.f11), "f11 must be 40 finite numbers");
    require(std::abs(at.law.incident_exponent) <= 10 && std::abs(at.law.reflected_exponent) <= 10,
            "exponents of the law must be in -10...10");
    require(rounded || at.readings < data.readings.size(), "list of directions " + std::to_string(at.readings) +
                                                               " is none of the " +
                                                               std::to_string(data.readings.size()));
    for (std::size_t b = 0; b < blocks.size(); ++b)
      require_valid(at.blocks[b], blocks[b], columns[b], data.errors.size(), rounded);
  }
}

MatrixXd Numbers::covariance(const PosteriorAt& at, std::size_t block) const {
  if (!at.blocks[block].factor.empty()) return from_rounded(at.blocks[block]);
  const Index count = columns[block].isotropic_count();
  return covariance_of_all(data, at, at.blocks[block], columns[block]).topLeftCorner(count, count);
}

const std::vector<double>& Numbers::covariance(std::size_t wavelength, std::size_t block) const {
  Covariances& at = known[wavelength];
  std::call_once(at.once, [&] {
    std::vector<std::vector<double>> all(columns.size());
    in_any_order(all.size(), [&](std::size_t b) {
      const MatrixXd matrix = covariance(data.wavelengths[wavelength], b);
      all[b].assign(matrix.data(), matrix.data() + matrix.size());
    });
    at.of_blocks = std::move(all);
  });
  return at.of_blocks[block];
}

}  // namespace

struct Posterior::State {
  Orders orders;
  DiscMapping mapping;
  Elements not_measured;
  std::function<PosteriorData()> data;
  std::vector<Block> blocks = without(not_measured, mmbrdf::blocks(Family::isotropic, orders));
  mutable std::once_flag once{};
  mutable std::optional<Numbers> made{};

  const Numbers& numbers() const {
    std::call_once(once, [this] {
      PosteriorData all = data();
      require(all.orders == orders && all.mapping == mapping && all.not_measured == not_measured,
              "the data of a posterior are those of another");
      made.emplace(std::move(all), blocks);
    });
    return *made;
  }
};

Posterior::Posterior(const Orders& orders, DiscMapping mapping, const Elements& not_measured,
                     std::function<PosteriorData()> data)
    : state_(new State{orders, mapping, not_measured, std::move(data)}) {}

Posterior::Posterior(PosteriorData data)
    : Posterior(data.orders, data.mapping, data.not_measured,
                [once = std::make_shared<PosteriorData>(std::move(data))] { return std::move(*once); }) {
  state_->numbers();
}

const PosteriorData& Posterior::data() const { return state_->numbers().data; }
DiscMapping Posterior::mapping() const { return state_->mapping; }
const Elements& Posterior::not_measured() const { return state_->not_measured; }
const std::vector<Block>& Posterior::blocks() const { return state_->blocks; }
std::span<const double> Posterior::covariance(std::size_t wavelength, std::size_t block) const {
  return state_->numbers().covariance(wavelength, block);
}

}  // namespace mmbrdf
