// SPDX-License-Identifier: BSD-3-Clause
#include "fitting/mixed_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

#include "basis/spectral.hpp"
#include "fitting/fit_to_predict.hpp"
#include "fitting/undetermined.hpp"
#include "mixed/block_fit.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "numerics/dense.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/svd_cache.hpp"
#include "numerics/threads.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double darkest = 0.05, brightest = 4;  // beyond these parts of 1/pi the prior does not hold: u is off by 15 %

/// Of each wavelength, those of each block.
using BlockFits = std::vector<std::vector<BlockFit>>;

/// Σ_p λ^p a_p through the coefficients at each wavelength, all with the same weight; power after power.
std::vector<double> through(const std::vector<double>& wavelengths, const BlockFits& fits, std::size_t block,
                            int powers) {
  MatrixXd rows(index(wavelengths.size()), powers + 1),
      values(rows.rows(), index(fits.front()[block].coefficients.size()));
  for (Index k = 0; k < rows.rows(); ++k) {
    const std::vector<double> of_wavelength = powers_of(wavelengths[static_cast<std::size_t>(k)], powers);
    rows.row(k) = Eigen::Map<const VectorXd>(of_wavelength.data(), rows.cols());
    values.row(k) =
        Eigen::Map<const VectorXd>(fits[static_cast<std::size_t>(k)][block].coefficients.data(), values.cols());
  }
  const MatrixXd line = dense::shortest_least_squares(rows, values).transpose();  // modes × powers
  return {line.data(), line.data() + line.size()};
}

/// What is thrown within becomes the reason why there is no mixed model.
auto tried(const auto& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    throw MixedFailure(error.what());
  }
}

/// Mean of f11 / reflectance, in parts of 1/π: about the albedo, if f11 is in sr⁻¹.
double brightness(const FirstPass& first, double reflectance) { return std::numbers::pi * first.mean / reflectance; }

/// Variances of the prior are those of an f11 of some parts of 1/π.
bool has_variances(double brightness) { return brightness > darkest && brightness < brightest; }

/// One wavelength in other units than sr⁻¹, such as counts, is divided by what makes an albedo of it.
void divide_other_units(const MixedRounds& rounds, FitOptions& options) {
  const auto& [wavelength, only] = *rounds.first().begin();
  const double found = brightness(only, 1);
  if (rounds.first().size() > 1 || options.reflectance || has_variances(found)) return;
  if (!(found > 0)) throw MixedFailure("the mean of f11 is " + rounded(only.mean, 2));
  options.reflectance = ReflectanceTable{{wavelength}, {found}};
}

/// As if f11, and where it is so what its noise is relative to, had been divided.
void divide_f11(Gram& gram, bool relative, double reflectance) {
  const double weights = relative ? reflectance * reflectance : 1;
  gram.g *= weights;
  gram.z *= weights / reflectance;
  gram.d *= weights / reflectance;
  gram.yy *= weights / (reflectance * reflectance);
}

struct LeastSquaresFit {
  FitAccumulator sums;
  FitResult result;
};

/// Of round 3. The weights of f11 are relative to f11 / reflectance, which may be its own.
LeastSquaresFit least_squares(const MixedRounds& rounds, const FitOptions& options) {
  FitAccumulator sums = rounds.squares({});
  SvdCache known;
  if (rounds.first().size() > 1 || options.reflectance)
    sums = rounds.squares(fit_to_predict(sums, options, known).model.reflectance);
  FitResult result = sums.solve(options);
  return {std::move(sums), std::move(result)};
}

/// Of Weights::estimated, else none.
std::vector<NoiseEstimate> noise_for(std::span<const Sample> samples, const Basis& basis, FitOptions options,
                                     Weights weights) {
  if (weights != Weights::estimated) return {};
  options.uncertainty = Uncertainty::noise;
  return fit(samples, basis, options, weights).noise;
}

/// At each wavelength; nothing without noise.
std::map<double, ReadingLaw> laws_of(const Series& series, const std::vector<NoiseEstimate>& noise) {
  std::map<double, ReadingLaw> result;
  for (std::size_t at = 0; const auto& [wavelength, list] : series) {
    if (noise.empty()) break;
    const NoiseLaw& law = noise[at++].law;
    result[wavelength] = {law.incident_exponent, law.reflected_exponent, true};
  }
  return result;
}

/// Lists by wavelength as one, in the order of the samples.
std::vector<Mueller> in_order_of(std::span<const Sample> samples, const std::map<double, std::vector<Mueller>>& lists) {
  std::vector<double> nodes;
  for (const auto& [wavelength, list] : lists) nodes.push_back(wavelength);
  std::vector<std::size_t> next(nodes.size());
  std::vector<Mueller> result;
  for (const Sample& sample : samples) {
    const std::size_t node = wavelength_index(nodes, sample.wavelength);
    result.push_back(lists.at(nodes[node])[next[node]++]);
  }
  return result;
}

/// Each block at each wavelength.
BlockFits block_fits(const MixedRounds& rounds, const Model& evaluated, const std::vector<MixedColumns>& columns,
                     const BlockSums& sums) {
  std::vector<std::pair<double, const FirstPass*>> list;
  for (const auto& [wavelength, first] : rounds.first()) list.emplace_back(wavelength, &first);
  BlockFits result(list.size(), std::vector<BlockFit>(columns.size()));
  in_any_order(list.size() * columns.size(), [&](std::size_t i) {  // the largest first
    const std::size_t at = i / columns.size(), b = columns.size() - 1 - i % columns.size();
    const auto& [wavelength, first] = list[at];
    Gram gram = sums.gram(wavelength, b);
    if (gram.yy == 0) throw MixedFailure("some elements are exactly 0 in all samples of a wavelength, without noise");
    if (feeds_f11(columns[b].isotropic())) divide_f11(gram, first->law.relative, evaluated.reflectance.at(wavelength));
    result[at][b] = fit_block(columns[b], gram, evaluated.blocks[b].block);
  });
  return result;
}

/// That rounds did without samples that are not complete, in the model and its warnings.
void say_left_out(const MixedRounds& rounds, FitResult& result) {
  if (!rounds.leaves_out()) return;
  long all = 0, incomplete = 0;
  for (const double wavelength : rounds.kinds().wavelengths()) {
    all += rounds.kinds().samples(wavelength);
    incomplete += rounds.kinds().incomplete(wavelength);
  }
  const std::string few =
      std::to_string(incomplete) + " of " + std::to_string(all) + " samples, in which elements are missing";
  result.model.provenance["left_out"] = few;
  result.warnings.push_back("left out of the fit: " + few);
}

/// Of blocks that have readings, the elements that have none.
Elements unread(const std::vector<MixedColumns>& columns, const Elements& known) {
  Elements result;
  for (const MixedColumns& block : columns)
    for (const Element& element : block.isotropic().elements) result[element.index()] = !known[element.index()];
  return result;
}

/// Not lower than those that a fit has by default.
Basis at_default_orders(Basis basis) {
  basis.orders = {std::max(basis.orders.f11, Orders{}.f11), std::max(basis.orders.other, Orders{}.other)};
  return basis;
}

/// Elements without readings that those of the others leave open at these orders. In few modes they may be determined, and what
/// the others are then is taken for knowledge that no reading gave.
Elements left_open(const MixedColumns& columns, const Gram& gram, const Basis& basis) {
  constexpr double least = 1e-12;  // of the largest eigenvalue: squares of singular values
  const std::vector<Block> all = blocks(Family::isotropic, basis.orders);
  const Block& block = *std::ranges::find(all, columns.isotropic().name, &Block::name);
  const std::vector<Index> kept = columns_of(block, columns.isotropic());
  const MatrixXd whole = gram.g.selfadjointView<Eigen::Lower>();
  const auto [vectors, values] = dense::eigensystem(whole(kept, kept));
  const Index free = (values.array() < least * values(values.size() - 1)).count();
  Solution solution;
  solution.x.resize(kept.size());
  solution.rank = static_cast<int>(values.size() - free);
  solution.null_space.assign(vectors.data(), vectors.data() + free * vectors.rows());  // values rise
  Elements result;
  for (const Element& element : columns.isotropic().elements)
    if (std::ranges::find(columns.read(), element) == columns.read().end())
      result[element.index()] = !determines(solution, block, basis, element.index());
  return result;
}

/// At one of the wavelengths at least.
Elements left_open(const MixedRounds& rounds, const std::vector<MixedColumns>& columns, const BlockSums& sums) {
  Elements result;
  for (std::size_t b = 0; b < columns.size(); ++b)
    if (columns[b].read().size() < columns[b].isotropic().elements.size())
      for (const auto& [wavelength, first] : rounds.first())
        result |= left_open(columns[b], sums.gram(wavelength, b), at_default_orders(rounds.basis()));
  return result;
}

/// What is kept of them.
Posterior posterior_of(const MixedRounds& rounds, const Model& evaluated, const DeclaredErrors& declared,
                       BlockFits fits, const BlockSums& sums) {
  const Basis& basis = rounds.basis();
  PosteriorData data{generous(basis.orders), basis.mapping, evaluated.not_measured, shared_errors(declared), {}, {}};
  data.unread = unread(mixed_columns(basis, ~rounds.kinds().known()), rounds.kinds().known());
  for (std::size_t at = 0; const auto& [wavelength, first] : rounds.first()) {
    PosteriorAt known{wavelength, first.law, first.f11, 0, {}};
    for (double& coefficient : known.f11) coefficient /= evaluated.reflectance.at(wavelength);
    const DirectionCounts directions = sums.directions(wavelength);
    for (BlockFit& block : fits[at++]) {
      known.blocks.push_back(std::move(block.posterior));
      if (directions.too_many()) round_covariance(known.blocks.back(), block.covariance);
    }
    if (!directions.too_many()) {
      const std::vector<ReadingDirections> list = directions.rising();
      known.readings = static_cast<std::size_t>(std::ranges::find(data.readings, list) - data.readings.begin());
      if (known.readings == data.readings.size()) data.readings.push_back(list);
    }
    data.wavelengths.push_back(std::move(known));
  }
  return Posterior(std::move(data));
}

}  // namespace

FitResult noise_fit(const MixedRounds& rounds, const FitOptions& options, const std::string& reason) {
  FitResult result = least_squares(rounds, options).result;
  say_left_out(rounds, result);
  result.warnings.push_back(only_noise(reason, options.declared));
  return result;
}

FitResult mixed_fit(const MixedRounds& rounds, FitOptions options, const BlockSums& sums) {
  options.minimum_norm = true;
  divide_other_units(rounds, options);
  auto [squares, result] = least_squares(rounds, options);
  Model& model = result.model;
  for (const auto& [wavelength, first] : rounds.first())
    if (const double found = brightness(first, model.reflectance.at(wavelength)); !has_variances(found))
      throw MixedFailure("f11 at " + shortest(in_nanometres(wavelength)) + " nm is that of an albedo of " +
                         rounded(found, 2) + ": is it in sr^-1, and the reflectance a part of 1?");
  tried([&] {
    const std::vector<MixedColumns> columns = mixed_columns(rounds.basis(), ~rounds.kinds().known());
    model.not_measured |= left_open(rounds, columns, sums);
    BlockFits fits = block_fits(rounds, model, columns, sums);
    for (std::size_t b = 0; b < model.blocks.size(); ++b) {
      model.blocks[b].coefficients = through(model.validity.wavelengths, fits, b, model.powers);
      model.blocks[b].covariance.clear();
      model.blocks[b].null_space.clear();  // of least squares: what the data leave open is in the posterior
    }
    model.posterior = posterior_of(rounds, model, options.declared, std::move(fits), sums);
  });
  say_left_out(rounds, result);
  result.elements = squares.misfit(model);
  model.reflectance.covariance.clear();
  model.reflectance.covariance_with_f11.clear();
  return std::move(result);
}

std::string only_noise(const std::string& reason, const DeclaredErrors& declared) {
  return "uncertainties are those of the noise alone: " + reason +
         (declared == DeclaredErrors{} ? "" : "; what was declared is not in them: give it with --term later");
}

std::string only_residuals(Covariance covariance) {
  return "the covariance " + to_string(covariance) + " is one of them";
}

FitResult sample_fit(std::span<const Sample> samples, const Basis& basis, const FitOptions& options, Weights weights) {
  const Series series = by_wavelength(samples);
  MeasuredKinds kinds;
  kinds.add(series);
  if (const std::string reason = no_mixed_model(kinds, basis); !reason.empty()) throw MixedFailure(reason);
  const std::vector<NoiseEstimate> noise = noise_for(samples, basis, options, weights);
  MixedRounds rounds(basis, law_of(weights), laws_of(series, noise));
  tried([&] {
    do rounds.add(series);
    while (rounds.next() && rounds.round() < 4);
  });
  if (rounds.finished()) throw MixedFailure(rounds.reason());
  const std::vector<MixedColumns> columns = mixed_columns(basis, ~rounds.kinds().known());
  const Series whole = rounds.leaves_out() ? complete(series, rounds.kinds()) : Series();
  const Series& used = rounds.leaves_out() ? whole : series;
  const auto gram = [&](double wavelength, std::size_t block) {
    return sums_of(columns[block], used.at(wavelength), rounds.first().at(wavelength));
  };
  const auto directions = [&](double wavelength) {
    DirectionCounts result;
    result.add(used.at(wavelength));
    return result;
  };
  FitResult result = mixed_fit(rounds, options, {gram, directions});
  result.noise = noise;
  result.weights = weights;
  std::map<double, std::vector<Mueller>> lists;
  for (const auto& [wavelength, list] : series)
    lists[wavelength] = rounds.weights(list, rounds.first().at(wavelength), result.model.reflectance.at(wavelength));
  if (rounds.leaves_out())
    for (const Elements known = rounds.kinds().known(); const auto& [wavelength, list] : series)
      for (std::size_t s = 0; s < list.size(); ++s)
        if (!is_complete(list[s], known)) lists[wavelength][s].elements.fill(0);
  result.sample_weights = in_order_of(samples, lists);
  result.residuals = residuals(result.model, samples);
  return result;
}

ReadingLaw law_of(Weights weights) { return weights == Weights::none ? ReadingLaw{0, 0, false} : ReadingLaw{}; }

}  // namespace mmbrdf
