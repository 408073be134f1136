// SPDX-License-Identifier: BSD-3-Clause
// All there is in the rounds of a mixed model as numbers. Part of mixed_rounds.hpp.

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fitting/mixed_rounds.hpp"
#include "fitting/wavelength_slot.hpp"
#include "numerics/eigen_index.hpp"
#include "text/numbers.hpp"

//   settled: the basis, the law, round, whether all have ended, samples and digest of round 1;
//   after round 1: of each wavelength, rising, λ and the kinds of its samples: bits of what they do not know, number;
//     of each wavelength: mean, least, law, f11; after round 3 the state of its least squares
//   sums: samples and digest of this round; in round 1 the kinds of samples, as above;
//     for each wavelength: λ, count, Σ f11, fit, least; in round 2 the counts of sizes; in round 3 least squares; in round 4
//     of each block n, yy, z, d and the lower triangle of g, then the directions

namespace mmbrdf {
namespace {

using Eigen::Index;

constexpr double largest = std::numeric_limits<double>::max();

void append(std::vector<double>& state, std::initializer_list<double> numbers) { state.insert(state.end(), numbers); }
void append(std::vector<double>& state, std::span<const double> numbers) {
  state.insert(state.end(), numbers.begin(), numbers.end());
}
void append_sized(std::vector<double>& state, std::span<const double> numbers) {
  append(state, {static_cast<double>(numbers.size())});
  append(state, numbers);
}
std::span<const double> next_sized(StateReader& reader) {
  return reader.next(static_cast<std::size_t>(reader.whole("a length")));
}

/// Two halves of 32 bits.
void append(std::vector<double>& state, std::uint64_t digest) {
  append(state, {static_cast<double>(digest >> 32), static_cast<double>(digest & 0xffffffff)});
}
std::uint64_t next_digest(StateReader& reader) {
  const auto half = [&] { return static_cast<std::uint64_t>(reader.whole("a digest", 4294967295.0)); };
  const std::uint64_t high = half();
  return high << 32 | half();
}

void append(std::vector<double>& state, const ReadingLaw& law) {
  append(state, {law.incident_exponent, law.reflected_exponent, law.relative ? 1.0 : 0.0});
}
ReadingLaw next_law(StateReader& reader) {
  const std::span<const double> exponents = reader.next(2);
  return {exponents[0], exponents[1], reader.whole("a law that is relative", 1) == 1};
}

double next_wavelength(StateReader& reader) {
  const double wavelength = reader.next(1).front();
  require_wavelength(wavelength);
  return wavelength;
}
void append(std::vector<double>& state, const Gram& gram) {
  append(state, {static_cast<double>(gram.n), gram.yy});
  append(state, std::span(gram.z.data(), static_cast<std::size_t>(gram.z.size())));
  append(state, std::span(gram.d.data(), static_cast<std::size_t>(gram.d.size())));
  for (Index column = 0; column < gram.g.cols(); ++column)
    append(state, std::span(&gram.g(column, column), static_cast<std::size_t>(gram.g.rows() - column)));
}
Gram next_gram(StateReader& reader, Index columns) {
  Gram result(columns, static_cast<Index>(declared_errors));
  result.n = reader.whole("a number of readings");
  result.yy = reader.next("a sum of squares", largest);
  const auto fill = [&](double* to, Index count) {
    const std::span<const double> numbers = reader.next(static_cast<std::size_t>(count));
    if (const auto odd = std::ranges::find_if(numbers, [](double x) { return !std::isfinite(x); });
        odd != numbers.end())
      throw std::invalid_argument("a state of a fit with a sum " + shortest(*odd));
    std::ranges::copy(numbers, to);
  };
  fill(result.z.data(), columns);
  fill(result.d.data(), result.d.size());
  for (Index column = 0; column < columns; ++column) fill(&result.g(column, column), columns - column);
  return result;
}

}  // namespace

void MeasuredKinds::append(std::vector<double>& state) const {
  mmbrdf::append(state, {static_cast<double>(at_.size())});
  for (const auto& [wavelength, counts] : at_) {
    mmbrdf::append(state, {wavelength, static_cast<double>(counts.size())});
    for (const auto& [kind, count] : counts)
      mmbrdf::append(state, {static_cast<double>(kind), static_cast<double>(count)});
  }
}

MeasuredKinds MeasuredKinds::from_state(StateReader& reader) {
  MeasuredKinds result;
  for (long rest = reader.whole("a number of wavelengths"); rest > 0; --rest) {
    const double wavelength = next_wavelength(reader);
    if (!result.at_.empty() && wavelength <= result.at_.rbegin()->first + wavelength_resolution)
      throw std::invalid_argument("a state of a fit whose wavelengths do not rise");
    Counts& counts = result.at_[wavelength];
    for (long kinds = reader.whole("a number of kinds of samples", 131072); kinds > 0; --kinds) {
      const auto kind = static_cast<unsigned long>(reader.whole("elements", 131071));
      counts[kind] = reader.whole("a number of samples");
    }
    if (counts.empty()) throw std::invalid_argument("a state of a fit with a wavelength without samples");
  }
  return result;
}

void DirectionCounts::append(std::vector<double>& state) const {
  mmbrdf::append(state, {too_many_ ? 1.0 : 0.0, static_cast<double>(counts_.size())});
  for (const auto& [angles, count] : counts_)
    mmbrdf::append(state, {angles[0], angles[1], angles[2], angles[3], static_cast<double>(count)});
}

DirectionCounts DirectionCounts::from_state(StateReader& reader) {
  DirectionCounts result;
  result.too_many_ = reader.whole("directions that are too many", 1) == 1;
  for (long rest = reader.whole("a number of directions", most_directions); rest > 0; --rest) {
    std::array<float, 4> angles;
    for (float& angle : angles) angle = static_cast<float>(reader.next(1).front());
    result.counts_[angles] = static_cast<std::uint32_t>(reader.whole("a number of readings", 4294967295.0));
  }
  return result;
}

std::vector<double> MixedRounds::settled() const {
  std::vector<double> result = numbers_of(basis_);
  append(result, law_);
  append(result, {static_cast<double>(round_), finished_ ? 1.0 : 0.0, static_cast<double>(first_samples_)});
  append(result, first_digest_);
  if (round_ == 1) return result;
  kinds_.append(result);
  for (const auto& [wavelength, first] : first_) {
    append(result, {first.mean, first.least});
    append(result, first.law);
    append_sized(result, first.f11);
    if (round_ > 3 || finished_) append_sized(result, squares_.at(wavelength).state());
  }
  return result;
}

std::vector<double> MixedRounds::state() const {
  std::vector<double> result = settled();
  append(result, {static_cast<double>(samples_)});
  append(result, digest_);
  if (round_ == 1) kinds_.append(result);
  for (const auto& [wavelength, sums] : sums_) {
    append(result, {wavelength, static_cast<double>(sums.count), sums.f11, sums.least});
    append(result, sums.fit.state());
    if (round_ == 2)
      for (const long count : sums.sizes.counts()) append(result, {static_cast<double>(count)});
    if (round_ == 3 && !finished_) append_sized(result, squares_.at(wavelength).state());
    for (const Gram& gram : sums.grams) append(result, gram);
    if (round_ == 4) sums.directions.append(result);
  }
  return result;
}

void MixedRounds::read_settled(StateReader& reader) {
  require_next(reader, basis_);
  if (!(next_law(reader) == law_)) throw std::invalid_argument("a state of a fit with other weights");
  round_ = static_cast<int>(reader.whole("a round", 4));
  finished_ = reader.whole("an end of rounds", 1) == 1;
  first_samples_ = reader.whole("a number of samples");
  first_digest_ = next_digest(reader);
  if (round_ < 1 || (finished_ && round_ < 3)) throw std::invalid_argument("a state of a fit of no round");
  if (round_ == 1) return;
  kinds_ = MeasuredKinds::from_state(reader);
  for (const double wavelength : kinds_.wavelengths()) {
    FirstPass& first = first_[wavelength];
    const std::span<const double> numbers = reader.next(2);
    first.mean = numbers[0];
    first.least = numbers[1];
    first.law = next_law(reader);
    const std::span<const double> f11 = next_sized(reader);
    first.f11.assign(f11.begin(), f11.end());
    if (first.f11.size() != blocks(Family::isotropic, {first_order, 0}).front().modes.size())
      throw std::invalid_argument("a state of a fit with " + std::to_string(f11.size()) + " coefficients of f11");
    if (round_ > 3 || finished_) squares_.emplace(wavelength, FitAccumulator::from_state(basis_, next_sized(reader)));
  }
  if (round_ == 4) begin_fourth();
}

void MixedRounds::read_sums(StateReader& reader) {
  samples_ = reader.whole("a number of samples");
  digest_ = next_digest(reader);
  if (round_ == 1) kinds_ = MeasuredKinds::from_state(reader);
  while (!reader.at_end()) {
    const double wavelength = next_wavelength(reader);
    Sums& sums = sums_at(wavelength);
    sums.count = reader.whole("a number of samples");
    const std::span<const double> numbers = reader.next(2);
    sums.f11 = numbers[0];
    sums.least = numbers[1];
    sums.fit =
        LeastSquares::from_state(sums.fit.unknowns(), reader.next(LeastSquares::state_size(sums.fit.unknowns())));
    if (round_ == 2)
      for (long& count : sums.sizes.counts()) count = reader.whole("a number of sizes");
    if (round_ == 3 && !finished_)
      squares_.emplace(known(wavelength), FitAccumulator::from_state(basis_, next_sized(reader)));
    if (round_ != 4) continue;
    for (const MixedColumns& columns : *columns_) sums.grams.push_back(next_gram(reader, columns.size()));
    sums.directions = DirectionCounts::from_state(reader);
  }
}

MixedRounds MixedRounds::from_state(const Basis& basis, const ReadingLaw& law, std::span<const double> state) {
  MixedRounds result(basis, law);
  StateReader reader(state);
  result.read_settled(reader);
  result.read_sums(reader);
  return result;
}

}  // namespace mmbrdf
