// SPDX-License-Identifier: BSD-3-Clause
// How samples are folded into the triangles of a fit. Part of fit.hpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "basis/rows.hpp"
#include "fitting/moderate.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "numerics/fold.hpp"
#include "text/numbers.hpp"

// Rows cost the square of their length, values only the length. So what has the same rows is folded together: elements
// with the same modes, and wavelengths that were measured at the same geometries in the same order. Each of them then
// has the triangle of the unknowns, to the last bit, with its own values beside it.

namespace mmbrdf {
namespace {

constexpr std::size_t rows_at_once = 128;   // a block of them, some 50 columns wide, stays in the second-level cache
constexpr std::size_t values_at_once = 64;  // columns of values beside each other, so that it does

void require_weights(std::span<const Mueller> weights, std::size_t samples) {
  if (!weights.empty() && weights.size() != samples)
    throw std::invalid_argument(std::to_string(weights.size()) + " weights for " + std::to_string(samples) +
                                " samples");
  for (std::size_t s = 0; s < weights.size(); ++s)
    for (const double weight : weights[s].elements)
      if (!(weight >= 0) || !std::isfinite(weight))
        throw std::invalid_argument("weight " + shortest(weight) + " of sample " + std::to_string(s + 1) +
                                    ", must be finite and not negative");
}

/// Squares of rows are added up: what is larger than this would leave no finite sum of a million of them.
constexpr double largest_value = 1e150;

/// What of each sample has no row in xy, as it is turned; nothing if all has. What is as_measured has rows of its own.
std::vector<Elements> unknown_of(std::span<const Sample> samples, const Basis& basis) {
  std::vector<Elements> result;
  for (const Sample& sample : samples) {
    const double turn = turns(basis) ? sample.geometry.incident.phi : 0;
    const Elements elements = sample.as_measured && rows_turn(basis.family) ? Elements{}.set() : not_measured(sample);
    result.push_back(turn == 0 || elements.none() ? elements : turned_into(elements, turn, -turn));
  }
  if (std::ranges::none_of(result, [](const Elements& elements) { return elements.any(); })) result.clear();
  return result;
}

/// What each element in xy becomes in the frame in which a sample was measured.
std::array<Mueller, 16> turned_from_xy(const Sample& sample) {
  const FrameAngles angles = angles_to_xy(sample.geometry, sample.as_measured->frame);
  std::array<Mueller, 16> result;
  for (std::size_t e = 0; e < 16; ++e) {
    Mueller unit{};
    unit.elements[e] = 1;
    result[e] = rotated(unit, -angles.scattered, -angles.incident);
  }
  return result;
}

/// The same in the rows that a sample has.
Elements unknown_in_rows(const Sample& sample, const Elements& in_xy) {
  if (!sample.as_measured || !in_xy.all()) return in_xy;
  Elements result = unknown_elements(sample.as_measured->normalized);
  result[0] = std::isnan(sample.f11);
  return result;
}

/// A row of functions that all vanish but for rounding, such as that of f14 in the plane of incidence, tells nothing.
void clear_rounding(RowColumns& rows, std::size_t modes, std::size_t count) {
  constexpr double rounding = 1e-12;  // functions are of the order of 1
  std::array<double, rows_at_once> largest{};
  for (std::size_t j = 0; j < modes; ++j)
    for (std::size_t r = 0; r < count; ++r) largest[r] = std::max(largest[r], std::abs(rows.column(j)[r]));
  for (std::size_t r = 0; r < count; ++r)
    if (largest[r] < rounding)
      for (std::size_t j = 0; j < modes; ++j) rows.column(j)[r] = 0;
}

}  // namespace

void require_moderate(std::span<const Sample> samples, std::span<const Mueller> weights) {
  for (std::size_t s = 0; s < samples.size(); ++s)
    for (std::size_t e = 0; e < 16; ++e) {
      const Mueller& m = samples[s].as_measured ? samples[s].as_measured->normalized : samples[s].normalized;
      const double value = std::abs(e == 0 ? samples[s].f11 : m.elements[e]);
      const double weight = weights.empty() ? 1 : weights[s].elements[e];
      if (std::sqrt(weight) * std::max(value, 1.0) > largest_value)
        throw std::invalid_argument("sample " + std::to_string(s + 1) + ": " + sample_element(e) + " = " +
                                    shortest(value) + " with weight " + shortest(weight) + " is too large");
    }
}

/// Elements whose rows are the same at the same geometry.
struct FitAccumulator::Design {
  std::vector<std::size_t> elements;
  std::size_t modes;
  std::vector<Rows::Term> terms;
};

std::shared_ptr<const std::vector<FitAccumulator::Design>> FitAccumulator::designs(std::span<const Block> blocks,
                                                                                   Family family) {
  std::array<Design, 16> of_elements;
  for (std::size_t e = 0; e < 16; ++e) of_elements[e] = {{e}, 1, {}};  // until a block feeds it
  for (const Block& block : blocks) {
    const Rows rows(block.modes, family);
    for (const Element& element : block.elements)
      of_elements[element.index()] = {{element.index()}, rows.columns(), rows.terms(element.index())};
  }
  auto result = std::make_shared<std::vector<Design>>();
  for (Design& design : of_elements) {
    const auto same = std::find_if(result->begin(), result->end(), [&](const Design& other) {
      return other.modes == design.modes && other.terms == design.terms;
    });
    if (same != result->end())
      same->elements.push_back(design.elements[0]);
    else
      result->push_back(std::move(design));
  }
  return result;
}

/// Samples at wavelengths with the same geometries.
struct FitAccumulator::Folding {
  struct Group {
    AtWavelength* at;
    std::vector<std::size_t> members;
  };
  struct Column {
    std::size_t element, group;
  };
  /// Elements and wavelengths with the same rows and the same weights.
  struct Share {
    const Design* design;
    std::vector<Column> columns;
    LeastSquares rows;
  };

  std::span<const Sample> samples;
  std::span<const Mueller> weights;
  std::span<const Elements> unknown;  // of each sample, as it is turned: of weight 0; or none
  std::vector<Group> groups{};

  bool has_geometries_of(const std::vector<std::size_t>& members) const {
    return std::equal(members.begin(), members.end(), groups[0].members.begin(), groups[0].members.end(),
                      [&](std::size_t a, std::size_t b) { return samples[a].geometry == samples[b].geometry; });
  }
  void fold(const FitAccumulator& into) const;

 private:
  struct Some;

  std::size_t rows() const { return groups[0].members.size(); }
  bool is_weighted() const { return !weights.empty() || !unknown.empty(); }
  double weight(const Column& c, std::size_t row) const {
    const std::size_t s = groups[c.group].members[row];
    if (!unknown.empty() && unknown[s][c.element]) return 0;
    return weights.empty() ? 1 : weights[s].elements[c.element];
  }
  bool have_same_weights(const Column& a, const Column& b) const {
    for (std::size_t row = 0; row < rows() && is_weighted(); ++row)
      if (weight(a, row) != weight(b, row)) return false;
    return true;
  }
  std::vector<Share> shares(std::span<const Design> designs) const;
  void deliver(const Share& share) const;
};

/// Some samples of one wavelength as they were measured in another frame: each row is a sum of the rows in xy of the
/// elements that are mixed there, which are of one block.
struct FitAccumulator::Turned {
  const FitAccumulator& into;
  std::span<const Sample> samples;
  std::span<const Mueller> weights;
  std::span<const std::size_t> members;

  void fold(AtWavelength& at) const {
    FunctionTables tables(std::max(into.basis_.orders.f11, into.basis_.orders.other), into.basis_.mapping,
                          members.size());
    std::vector<std::array<Mueller, 16>> turns;
    for (std::size_t r = 0; r < members.size(); ++r) {
      tables.set(r, samples[members[r]].geometry);
      turns.push_back(turned_from_xy(samples[members[r]]));
    }
    const std::array<const Design*, 16> designs = design_of_each();
    std::vector<RowColumns> in_xy;
    for (const Design* design : designs) {
      in_xy.emplace_back(design->modes, members.size());
      Rows::add(design->terms, tables.of(members.size()), in_xy.back().column(0), in_xy.back().stride());
    }
    for (std::size_t e = 0; e < 16; ++e) add_element(e, turns, in_xy, at);
  }

 private:
  std::array<const Design*, 16> design_of_each() const {
    std::array<const Design*, 16> result{};
    for (const Design& design : *into.designs_)
      for (const std::size_t e : design.elements) result[e] = &design;
    return result;
  }

  double value(std::size_t e, std::size_t row) const {
    const Sample& sample = samples[members[row]];
    return e == 0 ? sample.f11 : sample.as_measured->normalized.elements[e];
  }

  void add_element(std::size_t e, std::span<const std::array<Mueller, 16>> turns, std::vector<RowColumns>& in_xy,
                   AtWavelength& at) const {
    std::vector<std::size_t> known;
    for (std::size_t r = 0; r < members.size(); ++r)
      if (!std::isnan(value(e, r))) known.push_back(r);
    if (known.empty()) return;
    const std::size_t modes = in_xy[e].columns();
    RowColumns rows(modes + 1, known.size());
    for (std::size_t from = 0; from < 16; ++from)
      for (std::size_t k = 0; k < known.size(); ++k)
        if (const double part = turns[known[k]][from].elements[e]; part != 0)
          for (std::size_t j = 0; j < modes; ++j) rows.column(j)[k] += part * in_xy[from].column(j)[known[k]];
    clear_rounding(rows, modes, known.size());
    long counted = 0;
    for (std::size_t k = 0; k < known.size(); ++k) {
      rows.column(modes)[k] = value(e, known[k]);
      const double weight = weights.empty() ? 1 : weights[members[known[k]]].elements[e];
      for (std::size_t j = 0; j <= modes; ++j) rows.column(j)[k] *= std::sqrt(weight);
      at.weight[e] += weight;
      counted += weight != 0 ? 1 : 0;
    }
    LeastSquares triangle(static_cast<int>(modes));
    triangle.add(rows, counted);
    at.elements[e].merge(triangle);
  }
};

void FitAccumulator::add_as_measured(std::span<const Sample> samples, std::span<const Mueller> weights) {
  std::map<AtWavelength*, std::vector<std::size_t>> members;
  for (std::size_t s = 0; s < samples.size(); ++s)
    if (samples[s].as_measured) members[&slot(samples[s].wavelength)].push_back(s);
  has_turned_rows_ = has_turned_rows_ || !members.empty();
  for (auto& [at, list] : members)
    for (std::size_t first = 0; first < list.size(); first += rows_at_once)
      Turned{*this, samples, weights, std::span(list).subspan(first, std::min(rows_at_once, list.size() - first))}.fold(
          *at);
}

void FitAccumulator::add(std::span<const Sample> samples, std::span<const Mueller> weights) {
  require_valid(samples);
  require_weights(weights, samples.size());
  require_moderate(samples, weights);
  const std::vector<Elements> unknown = unknown_of(samples, basis_);
  std::map<AtWavelength*, std::vector<std::size_t>> members;
  for (std::size_t s = 0; s < samples.size(); ++s) members[&slot(samples[s].wavelength)].push_back(s);
  std::vector<Folding> all;
  for (auto& [at, list] : members) {
    const auto same = [&here = list](const Folding& folding) { return folding.has_geometries_of(here); };
    auto found = std::find_if(all.begin(), all.end(), same);
    if (found == all.end()) found = all.insert(found, {samples, weights, unknown});
    found->groups.push_back({at, std::move(list)});
  }
  for (const Folding& folding : all) folding.fold(*this);
  if (rows_turn(basis_.family)) add_as_measured(samples, weights);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const Geometry& geometry = samples[s].geometry;
    sides_ = static_cast<Sides>(sides_ | side(geometry));
    const Elements elements =
        unknown.empty() ? ~Elements{} : with_their_blocks(~unknown_in_rows(samples[s], unknown[s]));
    Measured& measured = measured_of(slot(samples[s].wavelength), elements.to_ulong());
    measured.pairs.add(geometry);
    measured.theta_i_max = std::max(measured.theta_i_max, geometry.incident.theta);
    measured.theta_r_max = std::max(measured.theta_r_max, geometry.reflected.theta);
  }
  samples_ += static_cast<long>(samples.size());
}

std::vector<FitAccumulator::Folding::Share> FitAccumulator::Folding::shares(std::span<const Design> designs) const {
  std::vector<Share> result;
  for (const Design& design : designs) {
    std::multimap<double, std::size_t> open;  // shares by the weight of the first row
    for (std::size_t g = 0; g < groups.size(); ++g)
      for (const std::size_t e : design.elements) {
        const double key = weight({e, g}, 0);
        const auto [begin, end] = open.equal_range(key);
        const auto found = std::find_if(begin, end, [&](const auto& one) {
          return have_same_weights(result[one.second].columns[0], {e, g});
        });
        if (found == end) {
          open.emplace(key, result.size());
          result.push_back({&design, {{e, g}}, LeastSquares(1)});
        } else if (result[found->second].columns.push_back({e, g});
                   result[found->second].columns.size() == values_at_once) {
          open.erase(found);
        }
      }
  }
  for (Share& share : result)
    share.rows = LeastSquares(static_cast<int>(share.design->modes), static_cast<int>(share.columns.size()));
  return result;
}

/// Some of the rows: functions of their directions, and values of the elements.
struct FitAccumulator::Folding::Some {
  const Folding& all;
  std::size_t first, count;
  FunctionTables tables;
  std::vector<Mueller> values;  // rows_at_once for each group

  void set(bool turns) {
    for (std::size_t g = 0; g < all.groups.size(); ++g)
      for (std::size_t r = 0; r < count; ++r) {
        const Sample& sample = all.samples[all.groups[g].members[first + r]];
        const auto& [incident, reflected] = sample.geometry;
        const double turn = turns ? incident.phi : 0;
        if (g == 0) tables.set(r, {{incident.theta, incident.phi - turn}, {reflected.theta, reflected.phi - turn}});
        Mueller& value = values[g * rows_at_once + r];
        value = turn == 0 ? sample.normalized : turned(sample.normalized, -turn);
        value(0, 0) = sample.f11;
      }
  }

  /// Rows with a weight other than 0.
  long counted(const Share& share) const {
    long result = 0;
    for (std::size_t r = 0; r < count; ++r) result += all.weight(share.columns[0], first + r) != 0 ? 1 : 0;
    return result;
  }

  RowColumns rows(const Share& share) const {
    const std::size_t modes = share.design->modes;
    RowColumns result(modes + share.columns.size(), count);
    Rows::add(share.design->terms, tables.of(count), result.column(0), result.stride());
    clear_rounding(result, modes, count);
    for (std::size_t c = 0; c < share.columns.size(); ++c) {
      const auto [element, group] = share.columns[c];
      for (std::size_t r = 0; r < count; ++r) {
        const double value = values[group * rows_at_once + r].elements[element];
        result.column(modes + c)[r] = std::isnan(value) ? 0 : value;
      }
    }
    if (!all.is_weighted()) return result;
    std::array<double, rows_at_once> roots;
    for (std::size_t r = 0; r < count; ++r) roots[r] = std::sqrt(all.weight(share.columns[0], first + r));
    for (std::size_t j = 0; j < result.columns(); ++j)
      for (std::size_t r = 0; r < count; ++r) result.column(j)[r] *= roots[r];
    return result;
  }
};

void FitAccumulator::Folding::fold(const FitAccumulator& into) const {
  std::vector<Share> together = shares(*into.designs_);
  Some some{
      *this, 0, 0,
      FunctionTables(std::max(into.basis_.orders.f11, into.basis_.orders.other), into.basis_.mapping, rows_at_once),
      std::vector<Mueller>(groups.size() * rows_at_once)};
  for (; some.first < rows(); some.first += rows_at_once) {
    some.count = std::min(rows_at_once, rows() - some.first);
    some.set(into.turns());
    for (Share& share : together) {
      RowColumns block = some.rows(share);
      share.rows.add(block, some.counted(share));
    }
  }
  for (const Share& share : together) deliver(share);
}

/// To the triangle of each element and wavelength.
void FitAccumulator::Folding::deliver(const Share& share) const {
  for (std::size_t c = 0; c < share.columns.size(); ++c) {
    const Column& column = share.columns[c];
    AtWavelength& at = *groups[column.group].at;
    for (std::size_t row = 0; row < rows(); ++row) at.weight[column.element] += weight(column, row);
    at.elements[column.element].merge(share.rows.of(static_cast<int>(c)));
  }
}

}  // namespace mmbrdf
