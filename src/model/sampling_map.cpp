// SPDX-License-Identifier: BSD-3-Clause
#include "model/sampling_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "mmbrdf/model/sampling.hpp"
#include "model/kernel/plan.hpp"
#include "numerics/threads.hpp"

namespace mmbrdf {
namespace {

using std::numbers::pi;

// ---- tables ---------------------------------------------------------------------------------------------------------

/// Where a model is asked for a table: steps of theta_r for the marginal density, of the azimuth on each side.
constexpr std::size_t theta_steps = 64, azimuth_steps = 48;

/// The integral of a density that is linear between nodes, up to each of them.
std::vector<double> cumulative(std::span<const double> x, std::span<const double> density) {
  std::vector<double> sums{0};
  for (std::size_t i = 1; i < x.size(); ++i)
    sums.push_back(sums.back() + (x[i] - x[i - 1]) * (density[i - 1] + density[i]) / 2);
  return sums;
}

/// Cuts the axis into parts with equal shares of a positive density that is linear between nodes. x begins and ends them.
template <std::size_t count>
std::array<double, count + 1> equal_shares(std::span<const double> x, std::span<const double> density) {
  const std::vector<double> sums = cumulative(x, density);
  std::array<double, count + 1> cuts;
  std::size_t cell = 0;
  for (std::size_t q = 0; q < count; ++q) {
    const double share = sums.back() * static_cast<double>(q) / static_cast<double>(count);
    while (sums[cell + 1] <= share) ++cell;
    // ∫ of a + slope y is the rest at the smaller root, written without a difference.
    const double rest = share - sums[cell], a = density[cell];
    const double slope = (density[cell + 1] - a) / (x[cell + 1] - x[cell]);
    cuts[q] = x[cell] + 2 * rest / (a + std::sqrt(std::max(0.0, a * a + 2 * slope * rest)));
  }
  cuts[count] = x.back();
  return cuts;
}

double mean(std::span<const double> x, std::span<const double> density) {
  return cumulative(x, density).back() / (x.back() - x.front());
}

/// Adds to a density what keeps every weight finite; a density of 0 becomes even.
void raise(std::span<const double> x, std::vector<double>& density) {
  const double average = mean(x, density);
  for (double& d : density) d = average > 0 ? d / average + sampling_floor : 1;
}

/// f11 at polar angles times azimuths from the incident one.
std::vector<double> f11_of(const PreparedIncidence& model, std::span<const double> theta,
                           std::span<const double> azimuth) {
  std::vector<Direction> directions;
  for (const double t : theta)
    for (const double a : azimuth) directions.push_back({t, model.incident().phi + a});
  std::vector<Mueller> matrices(directions.size());
  model.evaluate(directions, Frame::xy, matrices);
  std::vector<double> values;
  for (const Mueller& m : matrices) values.push_back(m(0, 0));
  return values;
}

void make_positive(std::vector<double>& values) {
  for (double& value : values) value = std::abs(value);
}

/// begin … end in equal steps.
std::vector<double> axis(double begin, double end, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i <= count; ++i)
    values.push_back(begin + (end - begin) * static_cast<double>(i) / static_cast<double>(count));
  return values;
}

double polar_angle(double v) { return std::asin(std::sqrt(v)); }

}  // namespace

SamplingMap::Made SamplingMap::made(const PreparedModel& model, const Direction& incident) const {
  const PreparedIncidence at = model.at(incident);
  const bool one_side = turns_ == 1;
  const std::vector<double> azimuths = axis(one_side ? 0 : -pi, pi, one_side ? azimuth_steps : 2 * azimuth_steps);
  const std::vector<double> shares = axis(0, 1, azimuths.size() - 1);
  const std::vector<double> thetas = axis(0, pi / 2, theta_steps);
  std::vector<double> v, marginal;
  std::vector<double> all = f11_of(at, thetas, azimuths);
  Made result{{}, *std::max_element(all.begin(), all.end())};
  make_positive(all);
  for (std::size_t i = 0; i < thetas.size(); ++i) {
    v.push_back(std::pow(std::sin(thetas[i]), 2));
    marginal.push_back(mean(shares, std::span(all).subspan(i * shares.size(), shares.size())));
  }
  raise(v, marginal);
  const auto cuts = equal_shares<steps>(v, marginal);
  std::vector<double> angles;
  for (const double cut : cuts) angles.push_back(polar_angle(cut));
  std::vector<double> rows = f11_of(at, angles, azimuths);
  make_positive(rows);
  for (std::size_t j = 0; j <= steps; ++j) {
    const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(j * shares.size());
    std::vector<double> conditional(begin, begin + static_cast<std::ptrdiff_t>(shares.size()));
    raise(shares, conditional);
    result.table[j] = {cuts[j], equal_shares<steps>(shares, conditional)};
  }
  return result;
}

SamplingMap::SamplingMap(const PreparedModel& model)
    : turns_(Evaluation::pattern(model).isotropic_f11 ? 1 : incident_azimuths) {
  tables_.resize((incident_steps + 1) * turns_);
  std::vector<double> largest_f11(tables_.size());
  in_any_order(tables_.size(), [&](std::size_t i) {
    const double rho = static_cast<double>(i / turns_) / static_cast<double>(incident_steps);
    const double turn = static_cast<double>(i % turns_) / static_cast<double>(turns_);
    const Made at = made(model, {std::acos(1 - rho * rho), 2 * pi * turn});
    tables_[i] = at.table;
    largest_f11[i] = at.largest_f11;
  });
  if (*std::max_element(largest_f11.begin(), largest_f11.end()) <= 0)
    throw std::invalid_argument("f11 is positive nowhere: no directions can be drawn by it");
}

// ---- between tables -------------------------------------------------------------------------------------------------

/// The map of an incident direction: the mean of those of the nearest tables. Each grows with u1, and at a given u1 with u2;
/// so does their mean, whose density is the reciprocal of its Jacobian.
template <std::size_t corners>
class SamplingMap::Blend {
 public:
  std::array<const Table*, corners> tables;
  std::array<double, corners> weights;

  double v(std::size_t j) const {
    return mean([j](const Table& table) { return table[j].v; });
  }

  double share(std::size_t j, std::size_t k) const {
    return mean([j, k](const Table& table) { return table[j].share[k]; });
  }

  /// Between rows j and j + 1, at a step of u2.
  double share(std::size_t j, double between, std::size_t k) const {
    const double low = share(j, k);
    return low + between * (share(j + 1, k) - low);
  }

 private:
  template <class Of>
  double mean(Of of) const {
    double sum = 0;
    for (std::size_t c = 0; c < corners; ++c) sum += weights[c] * of(*tables[c]);
    return sum;
  }
};

namespace {

/// A place on an axis of steps: the step, and how far into it.
struct Step {
  std::size_t index;
  double within;
};

Step step(double x, std::size_t count) {
  const double scaled = x * static_cast<double>(count);
  const auto index = std::min(static_cast<std::ptrdiff_t>(scaled), static_cast<std::ptrdiff_t>(count) - 1);
  return {static_cast<std::size_t>(index), scaled - static_cast<double>(index)};
}

/// The step of a rising function of 0 … count that holds a value.
template <class Rising>
Step step_of(double value, std::size_t count, Rising rising) {
  std::size_t low = 0, high = count;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (rising(middle) <= value ? low : high) = middle;
  }
  const double begin = rising(low), end = rising(low + 1);
  return {low, std::clamp((value - begin) / (end - begin), 0.0, 1.0)};
}

constexpr double reciprocal_area = 1 / static_cast<double>(SamplingMap::steps * SamplingMap::steps);

}  // namespace

template <class Ask>
auto SamplingMap::with_blend(const Incidence& incidence, Ask ask) const {
  const auto [i, r] = step(incidence.rho, incident_steps);
  const Table* const first = tables_.data() + i * turns_;
  if (turns_ == 1) return ask(Blend<2>{{first, first + 1}, {1 - r, r}});
  const double turn = incidence.phi / (2 * pi);
  const auto [a, t] = step(turn - std::floor(turn), turns_);
  const std::size_t next = (a + 1) % turns_;
  return ask(Blend<4>{{first + a, first + next, first + turns_ + a, first + turns_ + next},
                      {(1 - r) * (1 - t), (1 - r) * t, r * (1 - t), r * t}});
}

template <std::size_t corners>
SamplingMap::Mapped SamplingMap::mapped(const Blend<corners>& blend, const UnitPoint& u) const {
  const auto [j, s] = step(u[0], steps);
  const auto [k, t] = step(turns_ == 1 ? std::abs(2 * u[1] - 1) : u[1], steps);
  const double v = blend.v(j), dv = blend.v(j + 1) - v;
  const double share = blend.share(j, s, k), dshare = blend.share(j, s, k + 1) - share;
  const double reached = share + t * dshare;
  const double azimuth = turns_ == 1 ? std::copysign(pi * reached, u[1] - 0.5) : pi * (2 * reached - 1);
  return {{v + s * dv, azimuth}, reciprocal_area / (dv * dshare)};
}

SamplingMap::Mapped SamplingMap::map(const Incidence& incidence, const UnitPoint& u) const {
  return with_blend(incidence, [&](const auto& blend) { return mapped(blend, u); });
}

SamplingMap::Table SamplingMap::table(const Incidence& incidence) const {
  return with_blend(incidence, [](const auto& blend) {
    Table result;
    for (std::size_t j = 0; j <= steps; ++j) {
      result[j].v = blend.v(j);
      for (std::size_t k = 0; k <= steps; ++k) result[j].share[k] = blend.share(j, k);
    }
    return result;
  });
}

SamplingMap::Mapped SamplingMap::map(const Table& table, const UnitPoint& u) const {
  return mapped(Blend<1>{{&table}, {1}}, u);
}

double SamplingMap::density(const Incidence& incidence, const ProjectedPlace& place) const {
  const double share = turns_ == 1 ? std::abs(place.azimuth) / pi : (place.azimuth + pi) / (2 * pi);
  return with_blend(incidence, [&](const auto& blend) {
    const auto v = [&](std::size_t j) { return blend.v(j); };
    const auto [j, s] = step_of(place.v, steps, v);
    const auto row = [&, j = j, s = s](std::size_t k) { return blend.share(j, s, k); };
    const std::size_t k = step_of(share, steps, row).index;
    return reciprocal_area / ((v(j + 1) - v(j)) * (row(k + 1) - row(k)));
  });
}

}  // namespace mmbrdf
