// SPDX-License-Identifier: BSD-3-Clause
// What was measured, and where. Part of fit.hpp.

#include <algorithm>

#include "basis/support.hpp"
#include "mmbrdf/fitting/fit.hpp"

// Rows may lack elements. A block is measured where any of its elements is; a model knows of directions where all of its
// blocks were.

namespace mmbrdf {
namespace {

constexpr std::size_t most_supports = 32;  // sets of directions in a model: of more, only what all of them have

}  // namespace

/// Without a row, and without a block that has one.
Elements FitAccumulator::not_measured() const {
  const auto has_rows = [&](std::size_t e) {
    return std::ranges::any_of(wavelengths_, [e](const auto& at) { return at.second.elements[e].rows() > 0; });
  };
  Elements result;
  for (std::size_t e = 0; e < 16; ++e) {
    const int block = block_of_[e];
    result[e] = block < 0 ? !has_rows(e)
                          : std::ranges::none_of(blocks_[static_cast<std::size_t>(block)].elements,
                                                 [&](const Element& one) { return has_rows(one.index()); });
  }
  return result;
}

DirectionPairs::Grid FitAccumulator::grid() const {
  return basis_.family == Family::anisotropic ? DirectionPairs::Grid::anisotropic : DirectionPairs::Grid::isotropic;
}

FitAccumulator::Measured& FitAccumulator::measured_of(AtWavelength& at, unsigned long elements) const {
  const auto found = at.measured.find(elements);
  if (found != at.measured.end()) return found->second;
  return at.measured.emplace(elements, Measured{DirectionPairs(grid())}).first->second;
}

Elements FitAccumulator::with_their_blocks(const Elements& elements) const {
  Elements result = elements;
  for (const Block& block : blocks_)
    if (std::ranges::any_of(block.elements, [&](const Element& one) { return elements[one.index()]; }))
      for (const Element& one : block.elements) result.set(one.index());
  return result;
}

/// Of each block that was measured; those that were at the same places stand for one.
std::vector<FitAccumulator::Measured> FitAccumulator::measured_at(const AtWavelength& at,
                                                                  const Elements& not_measured) const {
  std::vector<Measured> result;
  for (const Block& block : without(not_measured, blocks_)) {
    Measured all{DirectionPairs(grid())};
    for (const auto& [elements, where] : at.measured) {
      if (!Elements(elements)[block.elements.front().index()]) continue;
      all.pairs.merge(where.pairs);
      all.theta_i_max = std::max(all.theta_i_max, where.theta_i_max);
      all.theta_r_max = std::max(all.theta_r_max, where.theta_r_max);
    }
    if (std::ranges::find(result, all) == result.end()) result.push_back(std::move(all));
  }
  return result;
}

/// The least of the largest angles of the blocks.
void FitAccumulator::set_angles(Validity& validity, const Elements& not_measured) const {
  for (const Block& block : without(not_measured, blocks_)) {
    double theta_i = 0, theta_r = 0;
    for (const auto& [wavelength, at] : wavelengths_)
      for (const auto& [elements, where] : at.measured) {
        if (!Elements(elements)[block.elements.front().index()]) continue;
        theta_i = std::max(theta_i, where.theta_i_max);
        theta_r = std::max(theta_r, where.theta_r_max);
      }
    validity.theta_i_max = std::min(validity.theta_i_max.value_or(theta_i), theta_i);
    validity.theta_r_max = std::min(validity.theta_r_max.value_or(theta_r), theta_r);
  }
}

std::vector<SupportedPairs> FitAccumulator::support(const Model& model) const {
  using Pairs = std::vector<DirectionPairs>;       // of blocks
  std::vector<std::pair<double, Pairs>> measured;  // where it changes: the last before and the first behind
  std::vector<std::pair<double, Pairs>> all;
  for (const auto& [wavelength, at] : wavelengths_) {
    all.emplace_back(wavelength, Pairs{});
    for (Measured& where : measured_at(at, model.not_measured)) all.back().second.push_back(std::move(where.pairs));
  }
  for (std::size_t w = 0; w < all.size(); ++w) {
    const bool as_before = w > 0 && all[w - 1].second == all[w].second;
    const bool as_behind = w + 1 < all.size() && all[w + 1].second == all[w].second;
    if (!as_before || !as_behind) measured.push_back(all[w]);
  }
  if (measured.size() == 2 && measured[0].second == measured[1].second) measured.pop_back();
  if (measured.size() > most_supports) {
    DirectionPairs common = measured.front().second.front();
    for (const auto& [wavelength, list] : measured)
      for (const DirectionPairs& pairs : list) common.keep(pairs);
    measured = {{measured.front().first, {common}}};
  }
  const int order = std::max({support_order, basis_.orders.f11, basis_.orders.other});
  std::vector<SupportedPairs> result;
  for (const auto& [wavelength, list] : measured) {
    result.push_back({wavelength, supported(list.front(), order, basis_.mapping)});
    for (std::size_t i = 1; i < list.size(); ++i) result.back().pairs.keep(supported(list[i], order, basis_.mapping));
  }
  const double theta_i = model.validity.theta_i_max.value_or(0), theta_r = model.validity.theta_r_max.value_or(0);
  const auto complete = [&](const SupportedPairs& one) { return one.pairs.reach(theta_i, theta_r); };
  return std::ranges::all_of(result, complete) ? std::vector<SupportedPairs>{} : result;
}

}  // namespace mmbrdf
