// SPDX-License-Identifier: BSD-3-Clause
#include "fitting/measured_kinds.hpp"

#include <algorithm>
#include <iterator>

#include "fitting/wavelength_slot.hpp"
#include "mixed/columns.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr long least_readings = 30;      // at a wavelength: sixty in random directions are known to do
constexpr long most_incomplete = 10;     // one of so many samples may be left out
constexpr std::size_t as_measured = 16;  // its bit

unsigned long kind_of(const Sample& sample) {
  return not_measured(sample).to_ulong() | (sample.as_measured != nullptr ? 1ul << as_measured : 0);
}

}  // namespace

Series by_wavelength(std::span<const Sample> samples) {
  Series result;
  const std::vector<double> nodes = wavelengths(samples);
  for (const Sample& sample : samples) result[nodes[wavelength_index(nodes, sample.wavelength)]].push_back(sample);
  return result;
}

void MeasuredKinds::add(const Series& series) {
  for (const auto& [wavelength, list] : series) {
    Counts& counts = wavelength_slot(at_, wavelength);
    for (const Sample& sample : list) ++counts[kind_of(sample)];
  }
}

void MeasuredKinds::merge(const MeasuredKinds& other) {
  for (const auto& [wavelength, theirs] : other.at_)
    for (Counts& ours = wavelength_slot(at_, wavelength); const auto& [kind, count] : theirs) ours[kind] += count;
}

std::vector<double> MeasuredKinds::wavelengths() const {
  std::vector<double> result;
  for (const auto& [wavelength, counts] : at_) result.push_back(wavelength);
  return result;
}

Elements MeasuredKinds::known() const {
  Elements result;
  for (const auto& [wavelength, counts] : at_)
    for (const auto& [kind, count] : counts) result |= ~Elements(kind & 0xffff);
  return result;
}

Elements MeasuredKinds::missing() const {
  Elements result;
  for (const auto& [wavelength, counts] : at_)
    for (const auto& [kind, count] : counts) result |= Elements(kind & 0xffff);
  return result;
}

long MeasuredKinds::samples(double wavelength) const {
  long result = 0;
  for (const auto& [kind, count] : at_.at(wavelength)) result += count;
  return result;
}

long MeasuredKinds::incomplete(double wavelength) const {
  long result = 0;
  for (const unsigned long of_known = known().to_ulong(); const auto& [kind, count] : at_.at(wavelength))
    if ((kind & (of_known | 1ul << as_measured)) != 0) result += count;
  return result;
}

bool MeasuredKinds::any_as_measured() const {
  const auto any = [](const Counts& counts) { return counts.rbegin()->first >> as_measured != 0; };
  return std::ranges::any_of(at_, [&](const auto& one) { return any(one.second); });
}

bool is_complete(const Sample& sample, const Elements& known) {
  return sample.as_measured == nullptr && (not_measured(sample) & known).none();
}

Series complete(const Series& series, const MeasuredKinds& kinds) {
  Series result;
  for (const Elements known = kinds.known(); const auto& [wavelength, list] : series)
    std::ranges::copy_if(list, std::back_inserter(result[wavelength]),
                         [&](const Sample& sample) { return is_complete(sample, known); });
  return result;
}

std::string no_mixed_model(const MeasuredKinds& kinds, const Basis& basis) {
  if (basis.family != Family::isotropic) return "the " + to_string(basis.family) + " basis has no mixed model";
  const Elements known = kinds.known();
  for (const double wavelength : kinds.wavelengths())
    if (kinds.incomplete(wavelength) * most_incomplete > kinds.samples(wavelength))
      return kinds.any_as_measured() ? "some elements are missing in the frame in which they were measured"
                                     : "missing in some samples: " + element_names(known & kinds.missing());
  if (blocks(basis.family, basis.orders).size() < blocks(basis.family, generous_orders).size())
    return "orders " + std::to_string(basis.orders.f11) + "," + std::to_string(basis.orders.other) +
           " leave elements without modes";
  for (const double wavelength : kinds.wavelengths())
    if (const long count = kinds.samples(wavelength) - kinds.incomplete(wavelength); count < least_readings)
      return std::to_string(count) + " samples at " + shortest(in_nanometres(wavelength)) + " nm, at least " +
             std::to_string(least_readings) + " are needed";
  return "";
}

void DirectionCounts::limit() {
  too_many_ = too_many_ || counts_.size() > most_directions;
  if (too_many_) counts_.clear();
}

void DirectionCounts::add(std::span<const Sample> samples) {
  for (const Sample& sample : samples) {
    if (too_many_) return;
    const auto& [i, r] = sample.geometry;
    ++counts_[{static_cast<float>(i.theta), static_cast<float>(i.phi), static_cast<float>(r.theta),
               static_cast<float>(r.phi)}];
    limit();
  }
}

void DirectionCounts::merge(const DirectionCounts& other) {
  for (const auto& [angles, count] : other.counts_) counts_[angles] += count;
  too_many_ = too_many_ || other.too_many_;
  limit();
}

std::vector<ReadingDirections> DirectionCounts::rising() const {
  std::vector<ReadingDirections> result;
  for (const auto& [angles, count] : counts_) result.push_back({angles, count});
  return result;
}

}  // namespace mmbrdf
