// SPDX-License-Identifier: BSD-3-Clause
#include "fitting/mixed_rounds.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "basis/rows.hpp"
#include "fitting/arm_errors.hpp"
#include "fitting/wavelength_slot.hpp"
#include "mixed/readings.hpp"
#include "numerics/eigen_index.hpp"
#include "numerics/threads.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double first_tolerance = 1e-10;    // of the rank of the fits of a first pass: it needs none in full
constexpr double least_relative_f11 = 1e-2;  // of the mean: darker readings are not weighed by what they happen to be

std::vector<Geometry> geometries_of(std::span<const Sample> samples) {
  std::vector<Geometry> result;
  for (const Sample& sample : samples) result.push_back(sample.geometry);
  return result;
}

/// Samples of which f11 was measured: those that the fits of f11 are of.
std::vector<Sample> with_f11(std::span<const Sample> samples) {
  std::vector<Sample> result;
  std::ranges::copy_if(samples, std::back_inserter(result), [](const Sample& s) { return !std::isnan(s.f11); });
  return result;
}

/// Of f11 of first_order.
const Rows& first_rows() {
  static const Rows rows(blocks(Family::isotropic, {first_order, 0}).front().modes, Family::isotropic);
  return rows;
}

/// Adds f11 of samples to a fit of first_order, each with a weight w.
void add_f11(LeastSquares& fit, std::span<const Sample> samples, DiscMapping mapping, const VectorXd& w) {
  const std::size_t columns = first_rows().columns();
  std::vector<double> rows(samples.size() * columns), values, squares;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const auto& [i, r] = samples[s].geometry;
    first_rows().add(0, functions_at(i, first_order, mapping), functions_at(r, first_order, mapping),
                     rows.data() + s * columns);
    values.push_back(samples[s].f11);
    squares.push_back(w(index(s)) * w(index(s)));
  }
  fit.add(rows, values, squares);
}

/// The same number for samples in any order, and hardly for others: a sum of what is mixed of each.
std::uint64_t digest_of(const Sample& sample) {
  std::uint64_t result = 0;
  const auto mix = [&result](double number) {
    result += std::isnan(number) ? 1 : std::bit_cast<std::uint64_t>(number == 0 ? 0.0 : number);
    result = (result ^ (result >> 30)) * 0xbf58476d1ce4e5b9;  // Steele, Lea and Flood 2014
    result = (result ^ (result >> 27)) * 0x94d049bb133111eb;
    result ^= result >> 31;
  };
  for (const double number : {sample.wavelength, sample.geometry.incident.theta, sample.geometry.incident.phi,
                              sample.geometry.reflected.theta, sample.geometry.reflected.phi, sample.f11})
    mix(number);
  for (const double number : sample.normalized.elements) mix(number);
  if (!sample.as_measured) return result;
  mix(static_cast<double>(sample.as_measured->frame) + 1);
  for (const double number : sample.as_measured->normalized.elements) mix(number);
  return result;
}

}  // namespace

// ---- sums of blocks ----

Orders generous(const Orders& evaluated) {
  return {std::max(evaluated.f11, generous_orders.f11), std::max(evaluated.other, generous_orders.other)};
}

std::vector<MixedColumns> mixed_columns(const Basis& basis, const Elements& not_measured) {
  std::vector<MixedColumns> result;
  for (const Block& block : without(not_measured, blocks(Family::isotropic, generous(basis.orders))))
    result.emplace_back(block, basis.mapping, not_measured);
  return result;
}

Gram sums_of(const MixedColumns& columns, std::span<const Sample> samples, const FirstPass& first) {
  Gram result(columns.size(), static_cast<Index>(declared_errors));
  const bool is_f11 = feeds_f11(columns.isotropic()), relative = is_f11 && first.law.relative;
  const PreparedModel model = prepare(first.model, samples.front().wavelength);
  for (std::size_t begin = 0; begin < samples.size(); begin += readings_at_once) {
    const auto some = samples.subspan(begin, std::min(readings_at_once, samples.size() - begin));
    const std::vector<Geometry> geometries = geometries_of(some);
    const Index count = index(some.size());
    const VectorXd weights = reading_weights(
        first.law, geometries, relative ? first_f11(first.f11, columns.mapping(), geometries) : VectorXd());
    const ArmErrors arms = arm_errors(model, geometries);
    MatrixXd rows = columns.read_at(geometries), errors = MatrixXd::Zero(rows.rows(), result.d.cols());
    VectorXd values(rows.rows());
    for (Index at = 0; const Element& element : columns.read()) {
      const std::size_t e = element.index();
      for (Index s = 0; s < count; ++s, ++at) {
        const auto sample = static_cast<std::size_t>(s);
        values(at) = is_f11 ? some[sample].f11 : some[sample].normalized.elements[e];
        if (is_f11) errors(at, 0) = model.f11(geometries[sample]);
        errors(at, 1) = arms.source[sample].elements[e];
        errors(at, 2) = arms.receiver[sample].elements[e];
      }
    }
    const VectorXd w = weights.replicate(index(columns.read().size()), 1);
    rows.array().colwise() *= w.array();
    errors.array().colwise() *= w.array();
    values.array() *= w.array();
    result.add(rows, values, errors);
  }
  return result;
}

// ---- the rounds ----

MixedRounds::MixedRounds(const Basis& basis, const ReadingLaw& law, std::map<double, ReadingLaw> laws)
    : basis_(basis), law_(law), laws_(std::move(laws)) {
  FitAccumulator{basis};  // refuses what makes no sense before anything is added
}

const ReadingLaw& MixedRounds::law_at(double wavelength) const {
  const auto found = find_wavelength(laws_, wavelength);
  return found != laws_.end() ? found->second : law_;
}

MixedRounds::Sums& MixedRounds::sums_at(double wavelength) {
  Sums& sums = wavelength_slot(sums_, round_ > 1 ? known(wavelength) : wavelength);
  if (sums.fit.unknowns() == 1) sums.fit = LeastSquares(static_cast<int>(first_rows().columns()));
  return sums;
}

/// As round 1 found it.
double MixedRounds::known(double wavelength) const {
  const auto found = find_wavelength(first_, wavelength);
  if (found == first_.end())
    throw std::invalid_argument("samples at " + shortest(in_nanometres(wavelength)) + " nm, of which round 1 had none");
  return found->first;
}

void MixedRounds::add(const Series& series, int threads) {
  if (finished_) throw std::invalid_argument("all rounds over the samples have ended");
  for (const auto& [wavelength, list] : series)
    if (round_ > 1) known(wavelength);  // or nothing is added
  const Series whole = leaves_out() ? complete(series, kinds_) : Series();
  const Series& used = leaves_out() ? whole : series;
  for (const auto& [wavelength, list] : used) {
    Sums& sums = sums_at(wavelength);
    for (std::size_t begin = 0; begin < list.size() && round_ < 3; begin += readings_at_once) {
      const auto some = std::span(list).subspan(begin, std::min(readings_at_once, list.size() - begin));
      if (round_ == 1) add_first(some, law_at(wavelength), sums);
      if (round_ == 2) add_second(some, first_.at(known(wavelength)), sums);
    }
    if (round_ == 3) add_third(list, known(wavelength), sums);
  }
  for (const auto& [wavelength, list] : series) {
    samples_ += static_cast<long>(list.size());
    for (const Sample& sample : list) digest_ += digest_of(sample);
  }
  if (round_ == 1) kinds_.add(series);
  if (round_ == 4) add_fourth(used, threads);
}

void MixedRounds::add_first(std::span<const Sample> samples, const ReadingLaw& law, Sums& sums) const {
  const std::vector<Sample> some = with_f11(samples);
  for (const Sample& sample : some) sums.f11 += sample.f11;
  sums.count += static_cast<long>(some.size());
  if (!some.empty()) add_f11(sums.fit, some, basis_.mapping, reading_weights(law, geometries_of(some), {}));
}

void MixedRounds::add_second(std::span<const Sample> samples, const FirstPass& first, Sums& sums) const {
  const std::vector<Sample> some = with_f11(samples);
  if (!first.law.relative || some.empty()) return;
  const std::vector<Geometry> geometries = geometries_of(some);
  const VectorXd f11 = first_f11(first.f11, basis_.mapping, geometries);
  VectorXd relative_to(f11.size());
  for (Index s = 0; s < f11.size(); ++s) {
    const double found = some[static_cast<std::size_t>(s)].f11;
    sums.least = std::min(sums.least, f11(s));
    sums.sizes.add((found - f11(s)) / first.mean);
    relative_to(s) = std::max(found, least_relative_f11 * first.mean);
  }
  sums.count += static_cast<long>(some.size());
  add_f11(sums.fit, some, basis_.mapping, reading_weights(first.law, geometries, relative_to));
}

std::vector<Mueller> MixedRounds::weights(std::span<const Sample> samples, const FirstPass& first,
                                          double reflectance) const {
  const std::vector<Geometry> geometries = geometries_of(samples);
  const VectorXd w = reading_weights(first.law, geometries, {});
  VectorXd f11 = VectorXd::Ones(w.size());
  if (first.law.relative)
    f11 = first_f11(first.f11, basis_.mapping, geometries).cwiseMax(least_relative_f11 * first.mean) / reflectance;
  std::vector<Mueller> result(samples.size());
  for (Index s = 0; s < w.size(); ++s) {
    Mueller& weights = result[static_cast<std::size_t>(s)];
    weights.elements.fill(w(s) * w(s));
    weights(0, 0) /= f11(s) * f11(s);
  }
  return result;
}

void MixedRounds::add_third(std::vector<Sample> samples, double wavelength, Sums& sums) {
  const FirstPass& first = first_.at(wavelength);
  if (first.law.relative && !samples.empty())
    sums.least = std::min(sums.least, first_f11(first.f11, basis_.mapping, geometries_of(samples)).minCoeff());
  for (Sample& sample : samples) sample.wavelength = wavelength;
  squares_.try_emplace(wavelength, basis_).first->second.add(samples, weights(samples, first, 1));
}

void MixedRounds::add_fourth(const Series& series, int threads) {
  std::vector<std::pair<const std::vector<Sample>*, const FirstPass*>> list;
  std::vector<Sums*> sums;
  for (const auto& [wavelength, samples] : series) {
    Sums& here = sums_at(wavelength);
    if (here.grams.empty())
      for (const MixedColumns& columns : *columns_)
        here.grams.emplace_back(columns.size(), static_cast<Index>(declared_errors));
    if (samples.empty()) continue;  // none of them was complete
    list.emplace_back(&samples, &first_.at(known(wavelength)));
    sums.push_back(&here);
    here.directions.add(samples);
  }
  const std::size_t blocks = columns_->size();
  const auto add_block = [&](std::size_t i) {  // the largest first
    const std::size_t at = i / blocks, b = blocks - 1 - i % blocks;
    sums[at]->grams[b].merge(sums_of((*columns_)[b], *list[at].first, *list[at].second));
  };
  in_any_order(list.size() * blocks, add_block, threads);
}

void MixedRounds::merge(const MixedRounds& other) {
  if (!(basis_ == other.basis_)) throw std::invalid_argument("cannot merge fits of different bases");
  if (finished_ || other.finished_) throw std::invalid_argument("cannot merge fits whose rounds have ended");
  if (round_ != other.round_)
    throw std::invalid_argument("cannot merge round " + std::to_string(other.round_) + " of a fit with round " +
                                std::to_string(round_));
  if (settled() != other.settled())
    throw std::invalid_argument("cannot merge fits with other weights, or of other samples in the rounds before");
  for (const auto& [wavelength, theirs] : other.sums_) {
    Sums& ours = sums_at(wavelength);
    ours.count += theirs.count;
    ours.f11 += theirs.f11;
    ours.fit.merge(theirs.fit);
    ours.least = std::min(ours.least, theirs.least);
    ours.sizes.merge(theirs.sizes);
    ours.directions.merge(theirs.directions);
    if (ours.grams.empty())
      ours.grams = theirs.grams;
    else
      for (std::size_t b = 0; b < theirs.grams.size(); ++b) ours.grams[b].merge(theirs.grams[b]);
  }
  if (round_ == 3)
    for (const auto& [wavelength, theirs] : other.squares_)
      squares_.try_emplace(wavelength, basis_).first->second.merge(theirs);
  if (round_ == 1) kinds_.merge(other.kinds_);
  samples_ += other.samples_;
  digest_ += other.digest_;
}

bool MixedRounds::next() {
  if (finished_) return false;
  if (samples_ == 0) throw std::invalid_argument("no samples in round " + std::to_string(round_));
  if (round_ > 1 && (samples_ != first_samples_ || digest_ != first_digest_))
    throw std::invalid_argument("round " + std::to_string(round_) + " was of other samples than round 1, " +
                                (samples_ != first_samples_ ? std::to_string(samples_) + " of them in place of " +
                                                                  std::to_string(first_samples_)
                                                            : "as many of them"));
  if (round_ == 1) settle_first();
  if (round_ == 2) settle_second();
  if (round_ == 3) settle_third();
  const bool relative = std::ranges::any_of(first_, [](const auto& one) { return one.second.law.relative; });
  finished_ = round_ == 4 || (round_ == 3 && !reason().empty());
  if (finished_) return false;
  round_ += round_ == 1 && !relative ? 2 : 1;
  first_samples_ = samples_;
  first_digest_ = digest_;
  samples_ = 0;
  digest_ = 0;
  sums_.clear();
  if (round_ == 4) begin_fourth();
  return true;
}

void MixedRounds::settle_first() {
  if (!kinds_.known()[0]) throw std::invalid_argument("f11 is not measured in any sample");
  for (const double wavelength : kinds_.wavelengths()) {
    const Sums& sums = wavelength_slot(sums_, wavelength);
    FirstPass& first = first_[wavelength];
    first.mean = sums.count > 0 ? sums.f11 / static_cast<double>(sums.count) : 0;
    first.law = law_at(wavelength);
    first.law.relative = first.law.relative && first.mean > 0;
    first.f11 = sums.fit.solve(first_tolerance).x;
  }
}

/// Noise is relative to f11 only where f11 stands above it.
void MixedRounds::settle_second() {
  for (auto& [wavelength, first] : first_) {
    const Sums& sums = wavelength_slot(sums_, wavelength);
    first.law.relative = first.law.relative && sums.least > first.mean * sums.sizes.typical_size();
    if (first.law.relative) first.f11 = sums.fit.solve(first_tolerance).x;
  }
}

void MixedRounds::settle_third() {
  for (auto& [wavelength, first] : first_) first.least = wavelength_slot(sums_, wavelength).least;
}

void MixedRounds::begin_fourth() {
  columns_ = std::make_shared<const std::vector<MixedColumns>>(mixed_columns(basis_, ~kinds_.known()));
  FitOptions options;
  options.powers = 0;
  options.reflectance = ReflectanceTable{};
  options.minimum_norm = true;
  options.rank_tolerance = first_tolerance;
  for (auto& [wavelength, first] : first_) {
    first.model = squares_.at(wavelength).solve(options).model;
    first.model.not_measured = {};  // arms mix what rows leave open into others: the shortest solution is a number
  }
}

bool MixedRounds::leaves_out() const {
  if (round_ < 3 && !finished_) return false;
  const auto incomplete = [&](double wavelength) { return kinds_.incomplete(wavelength) > 0; };
  return std::ranges::any_of(kinds_.wavelengths(), incomplete) && no_mixed_model(kinds_, basis_).empty();
}

std::string MixedRounds::reason() const {
  if (round_ == 1 && !finished_) return "";
  if (std::string without = no_mixed_model(kinds_, basis_); !without.empty()) return without;
  for (const auto& [wavelength, first] : first_)
    if (first.law.relative && round_ >= 3 && !(first.least > 0))
      return "f11 of the first fit is " + shortest(first.least) + " at some sample of " +
             shortest(in_nanometres(wavelength)) + " nm";
  return "";
}

FitAccumulator MixedRounds::squares(const ReflectanceTable& reflectance) const {
  FitAccumulator result(basis_);
  for (const auto& [wavelength, of_wavelength] : squares_) {
    if (!first_.at(wavelength).law.relative || reflectance.values.empty()) {
      result.merge(of_wavelength);
      continue;
    }
    FitAccumulator scaled = of_wavelength;
    scaled.weigh_f11(reflectance.at(wavelength));
    result.merge(scaled);
  }
  return result;
}

}  // namespace mmbrdf
