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

// ---- tables ---------------------------------------------------------------------------------------------------------

constexpr std::size_t steps = SamplingTables::steps;

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

/// Writes the table of an incident direction; returns the largest f11, not |f11|, that was met.
double make_table(const PreparedModel& model, const Direction& incident, bool folded, double* out) {
  using std::numbers::pi;
  const PreparedIncidence at = model.at(incident);
  const std::vector<double> azimuths = axis(folded ? 0 : -pi, pi, folded ? azimuth_steps : 2 * azimuth_steps);
  const std::vector<double> shares = axis(0, 1, azimuths.size() - 1);
  const std::vector<double> thetas = axis(0, pi / 2, theta_steps);
  std::vector<double> v, marginal;
  std::vector<double> all = f11_of(at, thetas, azimuths);
  const double largest = *std::max_element(all.begin(), all.end());
  make_positive(all);
  for (std::size_t i = 0; i < thetas.size(); ++i) {
    v.push_back(std::pow(std::sin(thetas[i]), 2));
    marginal.push_back(mean(shares, std::span(all).subspan(i * shares.size(), shares.size())));
  }
  raise(v, marginal);
  const auto cuts = equal_shares<steps>(v, marginal);
  std::ranges::copy(cuts, out);
  std::vector<double> angles;
  for (const double cut : cuts) angles.push_back(polar_angle(cut));
  std::vector<double> rows = f11_of(at, angles, azimuths);
  make_positive(rows);
  for (std::size_t j = 0; j <= steps; ++j) {
    const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(j * shares.size());
    std::vector<double> conditional(begin, begin + static_cast<std::ptrdiff_t>(shares.size()));
    raise(shares, conditional);
    std::ranges::copy(equal_shares<steps>(shares, conditional), out + (j + 1) * SamplingTables::row);
  }
  return largest;
}

}  // namespace

SamplingMap::SamplingMap(const PreparedModel& model) : folded_(Evaluation::pattern(model).isotropic_f11) {
  const std::size_t turns = folded_ ? 1 : SamplingTables::incident_azimuths;
  std::vector<double> largest_f11((SamplingTables::incident_steps + 1) * turns);
  numbers_.resize(largest_f11.size() * SamplingTables::size);
  in_any_order(largest_f11.size(), [&](std::size_t i) {
    const double rho = static_cast<double>(i / turns) / SamplingTables::incident_steps;
    const double turn = static_cast<double>(i % turns) / static_cast<double>(turns);
    largest_f11[i] = make_table(model, {std::acos(1 - rho * rho), 2 * std::numbers::pi * turn}, folded_,
                                &numbers_[i * SamplingTables::size]);
  });
  if (*std::max_element(largest_f11.begin(), largest_f11.end()) <= 0)
    throw std::invalid_argument("f11 is positive nowhere: no directions can be drawn by it");
}

}  // namespace mmbrdf
