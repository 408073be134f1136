// SPDX-License-Identifier: BSD-3-Clause
#include "fitting/measured_kinds.hpp"

#include "fitting/wavelength_slot.hpp"
#include "mixed/columns.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr long least_readings = 30;  // at a wavelength: sixty in random directions are known to do

}  // namespace

Series by_wavelength(std::span<const Sample> samples) {
  Series result;
  const std::vector<double> nodes = wavelengths(samples);
  for (const Sample& sample : samples) result[nodes[wavelength_index(nodes, sample.wavelength)]].push_back(sample);
  return result;
}

void MeasuredKinds::add(const Series& series) {
  for (const auto& [wavelength, list] : series) {
    wavelength_slot(samples, wavelength) += static_cast<long>(list.size());
    for (const Sample& sample : list) {
      const Elements here = not_measured(sample);
      unknown |= here;
      known |= ~here;
      as_measured = as_measured || sample.as_measured != nullptr;
    }
  }
}

void MeasuredKinds::merge(const MeasuredKinds& other) {
  for (const auto& [wavelength, count] : other.samples) wavelength_slot(samples, wavelength) += count;
  known |= other.known;
  unknown |= other.unknown;
  as_measured = as_measured || other.as_measured;
}

std::string no_mixed_model(const MeasuredKinds& kinds, const Basis& basis) {
  if (basis.family != Family::isotropic) return "the " + to_string(basis.family) + " basis has no mixed model";
  if (kinds.as_measured) return "some elements are missing in the frame in which they were measured";
  if (const Elements some = kinds.known & kinds.unknown; some.any())
    return "missing in some samples: " + element_names(some);
  const std::vector<Block> generous_blocks = blocks(basis.family, generous_orders);
  for (const Block& block : generous_blocks)
    for (const Element& element : block.elements)
      if (kinds.unknown[element.index()] != kinds.unknown[block.elements.front().index()])
        return "of the elements " + block.name + ", which belong together, some were not measured";
  if (blocks(basis.family, basis.orders).size() < generous_blocks.size())
    return "orders " + std::to_string(basis.orders.f11) + "," + std::to_string(basis.orders.other) +
           " leave elements without modes";
  for (const auto& [wavelength, count] : kinds.samples)
    if (count < least_readings)
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
