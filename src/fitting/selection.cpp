// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/selection.hpp"
#include "mmbrdf/fitting/weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fitting/fit_to_predict.hpp"
#include "numerics/threads.hpp"
#include "text/numbers.hpp"

// Every fold is folded into triangles once, at the highest orders. All the rest comes from those: the training set of a
// fold is the merged others, lower orders are some of the columns, and the error of a fold is the norm of its own
// triangle applied to the coefficients.

namespace mmbrdf {
namespace {

constexpr const char* left_unknown = "what was measured leaves all of its elements unknown";
constexpr double rounding = 1e-12;  // errors below are those of exact data, and no reason for anything

using Kind = Partition::Kind;

/// A partition with its samples folded in, all at the same orders.
struct Folded {
  std::vector<FitAccumulator> fold, rest;  // rest: all but the fold
};

/// The noise law of the weights, and the f11 to which noise is relative, are those of a fit at the lowest orders.
std::vector<Mueller> weights_of(std::span<const Sample> samples, const SelectionOptions& options, Weights weights) {
  if (weights == Weights::none) return {};
  const Basis lowest{options.family, {options.orders_f11->first, options.orders_other->first}, options.mapping};
  const FitOptions how{.powers = options.powers->first,
                       .reflectance = options.reflectance,
                       .minimum_norm = true,
                       .rank_tolerance = options.rank_tolerance};
  const FitResult first = fit(samples, lowest, how, weights == Weights::estimated ? weights : Weights::none);
  return fit_weights(samples, lowest, first, weights);
}

Folded folded(std::span<const Sample> samples, std::span<const Mueller> weights, const Partition& partition,
              const Basis& basis) {
  const std::size_t count = partition.names.size();
  std::vector<std::vector<Sample>> members(count);
  std::vector<std::vector<Mueller>> their_weights(count);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    members[partition.fold[s]].push_back(samples[s]);
    if (!weights.empty()) their_weights[partition.fold[s]].push_back(weights[s]);
  }
  Folded result;
  for (std::size_t f = 0; f < count; ++f) {
    result.fold.emplace_back(basis);
    result.fold.back().add(members[f], their_weights[f]);
  }
  std::vector<FitAccumulator> behind(count + 1, FitAccumulator(basis));  // all folds from this one on
  for (std::size_t f = count; f-- > 0;) {
    behind[f] = behind[f + 1];
    behind[f].merge(result.fold[f]);
  }
  FitAccumulator before(basis);
  for (std::size_t f = 0; f < count; ++f) {
    result.rest.push_back(before);
    result.rest.back().merge(behind[f + 1]);
    before.merge(result.fold[f]);
  }
  return result;
}

/// f11 or the others, in the language of FitAccumulator.
struct Part {
  bool is_f11;
  Orders orders(int order) const { return is_f11 ? Orders{order, 0} : Orders{0, order}; }
  std::size_t first() const { return is_f11 ? 0 : 1; }
  std::size_t last() const { return is_f11 ? 1 : 16; }

  FitOptions options(const SelectionOptions& asked, int powers) const {
    FitOptions result{.powers = powers,
                      .reflectance = asked.reflectance,
                      .minimum_norm = true,
                      .rank_tolerance = asked.rank_tolerance};
    if (!is_f11) result.reflectance = ReflectanceTable{};  // is not used, and may be a bad one at order 0
    return result;
  }

  bool holds(const FittedBlock& fitted) const { return feeds_f11(fitted.block) == is_f11; }

  /// Which blocks the data do not determine; families of minimum norm are never asked.
  std::string undetermined(const FitResult& result) const {
    if (traits(result.model.family).minimum_norm) return "";
    std::string text;
    for (const FittedBlock& fitted : result.model.blocks)
      if (holds(fitted) && static_cast<std::size_t>(fitted.rank) < fitted.coefficients.size())
        text += (text.empty() ? "" : "; ") + std::string("block ") + fitted.block.name + " has rank " +
                std::to_string(fitted.rank) + " of " + std::to_string(fitted.coefficients.size());
    return text;
  }

  ElementFit sum(const std::array<ElementFit, 16>& elements) const {
    ElementFit total;
    for (std::size_t e = first(); e < last(); ++e) {
      total.rows += elements[e].rows;
      total.chi_squared += elements[e].chi_squared;
      total.weight += elements[e].weight;
    }
    total.rms = total.weight > 0 ? std::sqrt(total.chi_squared / total.weight) : 0;
    return total;
  }
};

/// One order of a part: all samples, and each partition, at that order.
struct AtOrder {
  FitAccumulator all;
  std::vector<Folded> partitions;
};

AtOrder at_order(const FitAccumulator& all, const std::vector<Folded>& partitions, const Orders& orders) {
  AtOrder result{all.at_orders(orders), {}};
  for (const Folded& from : partitions) {
    Folded& to = result.partitions.emplace_back();
    for (const FitAccumulator& fold : from.fold) to.fold.push_back(fold.at_orders(orders));
    for (const FitAccumulator& rest : from.rest) to.rest.push_back(rest.at_orders(orders));
  }
  return result;
}

HeldOut held_out(const Folded& folded, const Partition& partition, const Part& part, const FitOptions& options,
                 SvdCache& known) {
  HeldOut result;
  double chi_squared = 0, weight = 0;
  for (std::size_t f = 0; f < folded.fold.size(); ++f) {
    try {
      const FitResult fit = fit_to_predict(folded.rest[f], options, known);
      std::string undetermined = part.undetermined(fit);
      if (!undetermined.empty()) throw std::invalid_argument(undetermined);
      const ElementFit error = part.sum(folded.fold[f].misfit(fit.model));
      chi_squared += error.chi_squared;
      weight += error.weight;
      if (error.rms > result.worst) {
        result.worst = error.rms;
        result.worst_fold = f;
      }
    } catch (const std::invalid_argument& error) {
      result.undetermined = "without " + partition.names[f] + ": " + error.what();
      return result;
    }
  }
  result.rms = weight > 0 ? std::sqrt(chi_squared / weight) : 0;
  return result;
}

Candidate candidate(const AtOrder& at, std::span<const Partition> partitions, const Part& part, int order,
                    const FitOptions& options, SvdCache& known) {
  Candidate result;
  result.order = order;
  result.powers = options.powers.value_or(0);
  try {
    const FitResult fit = fit_to_predict(at.all, options, known);
    for (const FittedBlock& fitted : fit.model.blocks)
      if (part.holds(fitted)) {
        result.coefficients += static_cast<int>(fitted.coefficients.size());
        result.rank += fitted.rank;
        result.condition = std::max(result.condition, fitted.condition);
      }
    const ElementFit total = part.sum(fit.elements);
    const auto n = static_cast<double>(total.rows);
    result.rms = total.rms;
    // The logarithm of a perfect fit would be infinite.
    if (total.rows > 0) {
      const double base = n * std::log(std::max(total.chi_squared / n, std::numeric_limits<double>::min()));
      result.aic = base + 2.0 * result.rank;
      result.bic = base + std::log(n) * result.rank;
    }
    if (const std::string free = part.undetermined(fit); !free.empty())
      result.refusal = "not determined by the data: " + free;
    else if (result.coefficients == 0)
      result.refusal = left_unknown;
  } catch (const std::invalid_argument& error) {
    result.refusal = error.what();
  }
  for (std::size_t p = 0; p < partitions.size(); ++p) {
    result.held_out.push_back(held_out(at.partitions[p], partitions[p], part, options, known));
    if (result.refusal.empty() && !result.held_out.back().undetermined.empty())
      result.refusal = "not determined " + result.held_out.back().undetermined;
  }
  return result;
}

// ---- the rule -------------------------------------------------------------------------------------------------------

/// Positions of the partitions that decide.
struct Deciding {
  std::size_t order = 0, powers = 0;
};

Deciding deciding(std::span<const Partition> partitions) {
  const auto find = [&](auto wanted) {
    const auto at = std::find_if(partitions.begin(), partitions.end(), wanted);
    return at == partitions.end() ? std::optional<std::size_t>{} : static_cast<std::size_t>(at - partitions.begin());
  };
  const auto angle = find([](const Partition& one) { return one.kind == Kind::angle; });
  const auto wavelength = find([](const Partition& one) { return one.kind == Kind::wavelength; });
  const auto other = find([](const Partition& one) { return one.kind != Kind::wavelength; });
  const std::size_t order = angle ? *angle : other ? *other : 0;
  return {order, wavelength.value_or(order)};
}

double error_of(const Candidate& candidate, std::size_t partition) {
  return std::max(candidate.held_out[partition].rms, rounding);
}

std::string named(const Candidate& candidate) {
  return "order " + std::to_string(candidate.order) +
         (candidate.powers > 0 ? " with powers up to " + std::to_string(candidate.powers) : "");
}

/// Positions of what is not refused, with these powers.
std::vector<std::size_t> usable(const PartSelection& part, int powers) {
  std::vector<std::size_t> result;
  for (std::size_t c = 0; c < part.candidates.size(); ++c)
    if (part.candidates[c].refusal.empty() && part.candidates[c].powers == powers) result.push_back(c);
  return result;
}

std::optional<std::size_t> best(const PartSelection& part, int powers, std::size_t by) {
  const std::vector<std::size_t> all = usable(part, powers);
  if (all.empty()) return {};
  return *std::min_element(all.begin(), all.end(), [&](std::size_t a, std::size_t b) {
    return error_of(part.candidates[a], by) < error_of(part.candidates[b], by);
  });
}

void refuse_what_explodes(PartSelection& part, const Range& powers, std::size_t by) {
  for (int p = powers.first; p <= powers.last; ++p) {
    const auto smallest = best(part, p, by);
    if (!smallest) continue;
    const Candidate reference = part.candidates[*smallest];
    for (const std::size_t c : usable(part, p)) {
      Candidate& one = part.candidates[c];
      const double ratio = error_of(one, by) / error_of(reference, by);
      if (one.order > reference.order && ratio > 1 + refusal_excess)
        one.refusal = "its error is " + rounded(ratio, 3) + " times that of order " + std::to_string(reference.order);
    }
  }
}

/// The lowest highest power whose error is next to the smallest; none if all are refused.
std::optional<int> powers_for(const PartSelection& part, const Range& powers, std::size_t by) {
  std::vector<std::pair<double, int>> errors;
  for (int p = powers.first; p <= powers.last; ++p)
    if (const auto at = best(part, p, by)) errors.emplace_back(error_of(part.candidates[*at], by), p);
  if (errors.empty()) return {};
  const double limit = std::min_element(errors.begin(), errors.end())->first * (1 + negligible_excess);
  return std::find_if(errors.begin(), errors.end(), [&](const auto& one) { return one.first <= limit; })->second;
}

std::string what_is_left_out(const Partition& partition) {
  return partition.kind == Kind::angle        ? "each incident angle"
         : partition.kind == Kind::wavelength ? "each wavelength"
                                              : "each of " + std::to_string(partition.names.size()) + " folds";
}

void recommend(PartSelection& part, std::span<const Partition> partitions, int powers, std::size_t by) {
  const auto smallest = best(part, powers, by);
  if (!smallest) {
    part.reason = "every order is refused; " + named(part.candidates.front()) + ": " + part.candidates.front().refusal;
    return;
  }
  const Candidate& least = part.candidates[*smallest];
  const std::vector<std::size_t> all = usable(part, powers);  // by rising order
  part.recommended = *std::find_if(all.begin(), all.end(), [&](std::size_t c) {
    return error_of(part.candidates[c], by) <= error_of(least, by) * (1 + negligible_excess);
  });
  const Candidate& chosen = part.candidates[*part.recommended];
  part.reason = "order " + std::to_string(chosen.order) + ": leaving out " + what_is_left_out(partitions[by]) +
                ", its error " + rounded(chosen.held_out[by].rms, 4) + " is ";
  part.reason += part.recommended == smallest
                     ? "the smallest"
                     : "within " + rounded(100 * negligible_excess, 4) + " % of the smallest, " +
                           rounded(least.held_out[by].rms, 4) + " of order " + std::to_string(least.order);
  for (const Candidate& one : part.candidates)
    if (one.powers == powers && one.order > chosen.order && !one.refusal.empty()) {
      part.reason += "; order " + std::to_string(one.order) + " is refused: " + one.refusal;
      break;
    }
}

// ---- what is asked --------------------------------------------------------------------------------------------------

void require_range(const Range& range, int highest, const std::string& what) {
  if (range.first < 0 || range.last < range.first || range.last > highest)
    throw std::invalid_argument(what + " " + std::to_string(range.first) + " to " + std::to_string(range.last) +
                                ": the first must not exceed the last, both in 0..." + std::to_string(highest));
}

/// With all ranges.
SelectionOptions completed(SelectionOptions options, std::span<const Sample> samples) {
  const bool grows_fast = options.family == Family::anisotropic;
  if (!options.orders_f11) options.orders_f11 = grows_fast ? Range{1, 4} : Range{2, 9};
  if (!options.orders_other) options.orders_other = grows_fast ? Range{1, 3} : Range{2, 6};
  if (!options.powers) options.powers = Range{0, wavelengths(samples).size() > 1 ? 1 : 0};
  return options;
}

void require_valid(std::span<const Sample> samples, std::span<const Partition> partitions,
                   const SelectionOptions& options) {
  require_range(*options.orders_f11, max_order, "orders of f11");
  require_range(*options.orders_other, max_order, "orders of the other elements");
  require_range(*options.powers, max_power, "powers of the wavelength");
  const std::size_t there = wavelengths(samples).size();
  if (static_cast<std::size_t>(options.powers->last) >= std::max<std::size_t>(there, 1))
    throw std::invalid_argument("powers of the wavelength up to " + std::to_string(options.powers->last) + " need " +
                                std::to_string(options.powers->last + 1) + " wavelengths, the data have " +
                                std::to_string(there));
  if (partitions.empty()) throw std::invalid_argument("no partition of the samples");
  for (const Partition& partition : partitions) {
    if (partition.fold.size() != samples.size())
      throw std::invalid_argument("a partition of " + std::to_string(partition.fold.size()) + " of " +
                                  std::to_string(samples.size()) + " samples");
    if (partition.names.size() < 2 || partition.names.size() > static_cast<std::size_t>(max_folds))
      throw std::invalid_argument("a partition of " + std::to_string(partition.names.size()) +
                                  " folds, it takes 2 to " + std::to_string(max_folds));
    for (const std::size_t fold : partition.fold)
      if (fold >= partition.names.size())
        throw std::invalid_argument("fold number " + std::to_string(fold) + " of " +
                                    std::to_string(partition.names.size()));
  }
}

PartSelection try_all(const FitAccumulator& all, const std::vector<Folded>& folded,
                      std::span<const Partition> partitions, const SelectionOptions& options, const Part& part) {
  const Range& orders = part.is_f11 ? *options.orders_f11 : *options.orders_other;
  const auto count = static_cast<std::size_t>(orders.last - orders.first) + 1;
  std::vector<std::vector<Candidate>> of_orders(count);
  in_any_order(count, [&](std::size_t i) {
    const int order = orders.last - static_cast<int>(i);  // what takes longest first
    const AtOrder at = at_order(all, folded, part.orders(order));
    SvdCache known;  // the rows of all powers are the same, and often those of folds and wavelengths
    for (int powers = options.powers->first; powers <= options.powers->last; ++powers)
      of_orders[static_cast<std::size_t>(order - orders.first)].push_back(
          candidate(at, partitions, part, order, part.options(options, powers), known));
  });
  PartSelection result;
  for (std::vector<Candidate>& of_order : of_orders) std::ranges::move(of_order, std::back_inserter(result.candidates));
  std::stable_sort(result.candidates.begin(), result.candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.powers < b.powers; });
  return result;
}

}  // namespace

Selection select_model(std::span<const Sample> samples, std::span<const Partition> partitions,
                       const SelectionOptions& asked, Weights weights) {
  const SelectionOptions options = completed(asked, samples);
  require_valid(samples, partitions, options);
  const Basis basis{options.family, {options.orders_f11->last, options.orders_other->last}, options.mapping};
  const std::vector<Mueller> used = weights_of(samples, options, weights);
  FitAccumulator all(basis);
  all.add(samples, used);
  std::vector<Folded> folds;
  for (const Partition& partition : partitions) folds.push_back(folded(samples, used, partition, basis));
  Selection result;
  const Deciding by = deciding(partitions);
  result.powers = options.powers->first;
  const bool f11_alone = (~not_measured(samples)).count() == 1;
  for (const bool is_f11 : {true, false}) {
    if (!is_f11 && f11_alone) break;
    PartSelection& part = is_f11 ? result.f11 : result.other;
    part = try_all(all, folds, partitions, options, {is_f11});
    refuse_what_explodes(part, *options.powers, by.order);
    result.powers = std::max(result.powers, powers_for(part, *options.powers, by.powers).value_or(0));
  }
  recommend(result.f11, partitions, result.powers, by.order);
  const bool others_known =
      std::ranges::any_of(result.other.candidates, [](const Candidate& one) { return one.refusal != left_unknown; });
  if (others_known)
    recommend(result.other, partitions, result.powers, by.order);
  else
    result.other.reason = f11_alone ? "not measured" : "unknown at every order";
  if (result.f11.recommended && (!others_known || result.other.recommended))
    result.orders = Orders{result.f11.candidates[*result.f11.recommended].order,
                           others_known ? result.other.candidates[*result.other.recommended].order : 0};
  return result;
}

}  // namespace mmbrdf
