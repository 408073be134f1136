// SPDX-License-Identifier: BSD-3-Clause
#include "model/kernel/plan.hpp"

// How the coefficients of a model become those of a form of the kernel: the choice of the form, and Form::pairs.
#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "model/kernel/plan_parts.hpp"

namespace mmbrdf {

double table_norm(int index) {
  int n = 0;
  while (zernike_count(n) <= index) ++n;
  return radial_norm(n) * (2 * index == n * (n + 2) ? std::sqrt(0.5) : 1);  // k = 0
}

namespace {

/// What feeds one sum: a pair, its coefficient and the number of the sum.
struct PairUse {
  int target;  // 4i + j over S, i ≤ j; 4j + i over D
  std::size_t mode;
  double weight;
};

std::map<std::pair<int, int>, std::vector<PairUse>> pair_uses(const Model& model) {
  std::map<std::pair<int, int>, std::vector<PairUse>> uses;
  std::size_t q = 0;
  for (const FittedBlock& fitted : model.blocks)
    for (const Mode& mode : fitted.block.modes) {
      for (const Term& term : terms(mode, model.family)) {
        if (term.row > term.column) continue;  // follows by reciprocity
        const auto pair = std::minmax(term.incident, term.reflected);
        const double half = 0.5 * term.weight * table_norm(term.incident) * table_norm(term.reflected);
        auto& list = uses[{pair.first, pair.second}];
        list.push_back({4 * term.row + term.column, q, half});
        if (term.row < term.column && term.incident != term.reflected)
          list.push_back({4 * term.column + term.row, q, term.incident < term.reflected ? half : -half});
      }
      ++q;
    }
  return uses;
}

/// Sums that a pair feeds, those over S before those over D.
std::vector<int> targets_of(const std::vector<PairUse>& uses) {
  std::vector<int> targets;
  for (const PairUse& use : uses) targets.push_back(use.target);
  const auto key = [](int target) { return std::pair(target % 4 < target / 4, target); };
  std::sort(targets.begin(), targets.end(), [&](int a, int b) { return key(a) < key(b); });
  targets.erase(std::unique(targets.begin(), targets.end()), targets.end());
  return targets;
}

/// Lists of at most four sums over S and four over D.
std::vector<std::vector<int>> lists_of_eight(const std::vector<int>& targets) {
  const auto middle = std::partition_point(targets.begin(), targets.end(), [](int t) { return t % 4 >= t / 4; });
  std::vector<std::vector<int>> parts;
  for (auto s = targets.begin(), d = middle; s != middle || d != targets.end();) {
    std::vector<int> part;
    for (int i = 0; i < 4 && s != middle; ++i) part.push_back(*s++);
    for (int i = 0; i < 4 && d != targets.end(); ++i) part.push_back(*d++);
    parts.push_back(std::move(part));
  }
  return parts;
}

void arrange_pairs(const Model& model, Plan& result, std::vector<Shares>& shares) {
  const auto uses = pair_uses(model);
  std::map<std::vector<int>, std::vector<std::pair<int, int>>> classes;  // pairs that feed the same sums
  for (const auto& [pair, list] : uses)
    for (const std::vector<int>& part : lists_of_eight(targets_of(list))) classes[part].push_back(pair);
  for (const auto& [targets, pairs] : classes) {
    PairRun run{static_cast<int>(result.pairs.size()), 0, result.count, 0, 0, {}};
    for (std::size_t e = 0; e < targets.size(); ++e) {
      run.target[e] = targets[e];
      ++(targets[e] % 4 >= targets[e] / 4 ? run.sums : run.differences);
    }
    for (const auto& pair : pairs) {
      result.pairs.push_back({pair.first, pair.second});
      for (std::size_t e = 0; e < targets.size(); ++e, ++result.count)
        for (const PairUse& use : uses.at(pair))
          if (use.target == targets[e]) shares[use.mode].push_back({result.count, use.weight});
    }
    run.end = static_cast<int>(result.pairs.size());
    result.runs.push_back(run);
  }
}

/// For models of one of the straight-line forms; else nothing.
std::vector<Shares> straight_shares(const Model& model, Plan& result) {
  std::vector<Shares> shares;
  const bool isotropic = model.family == Family::isotropic;
  if (!isotropic && model.family != Family::germer2017) return shares;
  for (const FittedBlock& fitted : model.blocks)
    for (const Mode& mode : fitted.block.modes) {
      std::optional<Shares> of_mode = isotropic ? isotropic_shares(mode) : germer2017_shares(mode);
      if (!of_mode) return {};
      shares.push_back(std::move(*of_mode));
    }
  result.form = isotropic ? Form::isotropic : Form::germer2017;
  result.count = isotropic ? IsotropicLayout::count : Germer2017Layout::count;
  return shares;
}

}  // namespace

Plan plan(const Model& model) {
  Plan result;
  const Orders highest = orders(model);
  result.order = std::max(highest.f11, highest.other);
  result.projected = model.mapping == DiscMapping::projected;
  result.turned = turns(model);
  std::vector<Shares> shares;
  if (highest.f11 <= 7 && highest.other <= 4) shares = straight_shares(model, result);
  if (shares.empty()) {
    shares.resize(size(coefficient_count(model) / (model.powers + 1)));
    arrange_pairs(model, result, shares);
  }
  for (const Shares& of_mode : shares) {
    result.shares.insert(result.shares.end(), of_mode.begin(), of_mode.end());
    result.shares_end.push_back(result.shares.size());
  }
  return result;
}

std::vector<double> Plan::coefficients(std::span<const double> of_modes) const {
  std::vector<double> result(size(count));
  for (std::size_t q = 0; q < of_modes.size(); ++q)
    for (std::size_t i = shares_end[q]; i < shares_end[q + 1]; ++i)
      result[size(shares[i].coefficient)] += shares[i].weight * of_modes[q];
  return result;
}

std::vector<double> by_powers(const Model& model) {
  std::vector<double> result;
  for (int p = 0; p <= model.powers; ++p)
    for (const FittedBlock& fitted : model.blocks) {
      const std::size_t count = fitted.block.modes.size();
      const auto first = fitted.coefficients.begin() + static_cast<std::ptrdiff_t>(size(p) * count);
      result.insert(result.end(), first, first + static_cast<std::ptrdiff_t>(count));
    }
  return result;
}

static_assert(kernel_parallel_limit == parallel_limit);

KernelFrame kernel_frame(Frame frame) {
  switch (frame) {
    case Frame::xy:
      return KernelFrame::xy;
    case Frame::sp:
      return KernelFrame::sp;
    case Frame::scattering_plane:
      return KernelFrame::scattering_plane;
  }
  throw std::invalid_argument("frame " + std::to_string(static_cast<int>(frame)) + " is none");
}

}  // namespace mmbrdf
