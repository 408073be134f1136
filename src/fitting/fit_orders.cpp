// SPDX-License-Identifier: BSD-3-Clause
// The same samples at other orders, and under another model: what cross-validation is made of.

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"
#include "numerics/svd_cache.hpp"

namespace mmbrdf {

std::array<ElementFit, 16> FitAccumulator::misfit(const Model& model) const {
  const auto same = [](const Block& ours, const FittedBlock& theirs) { return ours.modes == theirs.block.modes; };
  const std::vector<Block> measured = without(model.not_measured, blocks_);
  if (model.family != basis_.family || model.mapping != basis_.mapping || mmbrdf::turns(model) != turns() ||
      !std::equal(measured.begin(), measured.end(), model.blocks.begin(), model.blocks.end(), same))
    throw std::invalid_argument("the model has another basis");
  std::array<ElementFit, 16> result;
  for (std::size_t e = 0; e < 16 && samples_ > 0; ++e) {
    if (model.not_measured[e]) continue;
    const auto feeds = [e](const FittedBlock& fitted) {
      return std::ranges::any_of(fitted.block.elements, [e](const Element& one) { return one.index() == e; });
    };
    const auto fed = std::ranges::find_if(model.blocks, feeds);
    result[e] =
        element_fit(e, fed != model.blocks.end() ? fed->coefficients : std::vector<double>{0}, model.reflectance);
  }
  return result;
}

/// As if each weight of f11 had been multiplied by the square of a factor.
void FitAccumulator::weigh_f11(double factor) {
  for (auto& [wavelength, at] : wavelengths_) {
    at.elements[0] = at.elements[0].repeated(std::array{factor}, factor);
    at.weight[0] *= factor * factor;
  }
}

FitAccumulator FitAccumulator::at_orders(const Orders& orders) const {
  if (orders.f11 > basis_.orders.f11 || orders.other > basis_.orders.other)
    throw std::invalid_argument("orders " + std::to_string(orders.f11) + "," + std::to_string(orders.other) +
                                " are higher than those of the samples added");
  Basis basis = basis_;
  basis.orders = orders;
  FitAccumulator result(basis);
  result.sides_ = sides_;
  result.has_turned_rows_ = has_turned_rows_;
  result.samples_ = samples_;
  for (const auto& [wavelength, at] : wavelengths_) {
    AtWavelength& to = result.slot(wavelength);
    to.measured = at.measured;
    to.weight = at.weight;
  }
  struct Parts {
    std::vector<const LeastSquares*> from;
    std::vector<LeastSquares*> to;
  };
  std::map<std::vector<std::size_t>, Parts> lower;  // by which modes of the element's block are kept
  for (std::size_t e = 0; e < 16; ++e) {
    std::vector<std::size_t> kept;
    if (result.block_of_[e] >= 0) {
      const std::vector<Mode>& all = blocks_[static_cast<std::size_t>(block_of_[e])].modes;
      for (const Mode& mode : result.blocks_[static_cast<std::size_t>(result.block_of_[e])].modes)
        kept.push_back(static_cast<std::size_t>(std::find(all.begin(), all.end(), mode) - all.begin()));
    }
    Parts& parts = lower[kept];
    for (const auto& [wavelength, at] : wavelengths_) {
      parts.from.push_back(&at.elements[e]);
      parts.to.push_back(&result.slot(wavelength).elements[e]);
    }
  }
  for (const auto& [kept, parts] : lower) {
    const std::vector<LeastSquares> restricted =
        LeastSquares::restricted(parts.from, kept.empty() ? std::vector<std::size_t>{0} : kept);
    for (std::size_t i = 0; i < restricted.size(); ++i)
      *parts.to[i] = kept.empty() ? restricted[i].repeated(std::array{0.0}) : restricted[i];
  }
  return result;
}

/// "5,4": the highest of f11 and of the others, each apart, or "" if order 0 is too much.
std::string FitAccumulator::determined_orders(const FitOptions& options) const {
  const int powers = chosen_powers(options);
  SvdCache known;
  const Elements unknown = not_measured();
  const auto determines = [&](const Orders& orders, bool f11) {
    const FitAccumulator lower = at_orders(orders);
    const auto full = [](const Solution& s) { return static_cast<std::size_t>(s.rank) == s.x.size(); };
    for (std::size_t b = f11 ? 0 : 1; b < (f11 ? 1 : lower.blocks_.size()); ++b)
      if (!unknown[lower.blocks_[b].elements.front().index()] &&
          !full(lower.block_solution(b, powers, {}, options.rank_tolerance, known)))
        return false;
    return !f11 || !takes_own_reflectance(options) || std::ranges::all_of(lower.wavelengths_, [&](const auto& at) {
      return full(at.second.elements[0].solve(options.rank_tolerance, &known));
    });
  };
  Orders orders = basis_.orders;
  while (orders.f11 >= 0 && !determines({orders.f11, 0}, true)) --orders.f11;
  while (orders.other >= 0 && !determines({0, orders.other}, false)) --orders.other;
  if (orders.f11 < 0 || orders.other < 0) return "";
  return std::to_string(orders.f11) + "," + std::to_string(orders.other);
}

void FitAccumulator::require_determined(const std::string& refusal, const std::string& free,
                                        const FitOptions& options) const {
  if (free.empty()) return;
  const std::string up_to = determined_orders(options);
  const std::string lower = "choose lower orders" + (up_to.empty() ? "" : " (up to " + up_to + " they do)"),
                    minimum_norm = "ask for the solution of minimum norm";
  if (sides_ == plane_of_incidence)
    throw std::invalid_argument("measured in one plane only, that of incidence: " + refusal + free + "; " +
                                minimum_norm + ", which holds in that plane, or " + lower);
  throw std::invalid_argument(refusal + free + "; " + lower + ", or " + minimum_norm);
}

}  // namespace mmbrdf
