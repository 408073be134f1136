// SPDX-License-Identifier: BSD-3-Clause
#include "hemisphere.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "mmbrdf/model/batch.hpp"

namespace mmbrdf::web {
namespace {

constexpr std::size_t cell_pixels = 3;      // of a side of what the range is asked for at once
constexpr std::size_t stripe_distance = 8;  // pixels along a row
constexpr std::size_t stripe_width = 3;
constexpr int shades = 256;                // of f11, and of the others
constexpr int stripe = 2 * shades;         // between the colours and those of stripes
constexpr int unknown_color = 2 * stripe;  // behind them all

/// z ≥ 0 and of length 1; none outside of the disc.
bool direction_of_pixel(double u, double v, bool lambert, Vector3& to) {
  const double r2 = u * u + v * v;
  if (r2 > 1) return false;
  const double z = lambert ? 1 - r2 : std::sqrt(1 - r2);
  const double stretched = lambert ? std::sqrt(2 - r2) : 1;
  to = {u * stretched, v * stretched, z};
  return true;
}

}  // namespace

Hemisphere::Hemisphere(int pixels, bool lambert) : pixels_(static_cast<std::size_t>(pixels)), lambert_(lambert) {
  if (pixels < 8 || pixels > 2048)
    throw std::invalid_argument("pixels = " + std::to_string(pixels) + ", must be in 8...2048");
  std::map<std::size_t, std::uint32_t> known;
  for (std::size_t row = 0; row < pixels_; ++row) {
    const std::size_t first = count();
    for (std::size_t column = 0; column < pixels_; ++column) {
      const auto middle = [&](std::size_t i) { return (2 * static_cast<double>(i) + 1) / pixels - 1; };
      Vector3 to;
      if (!direction_of_pixel(middle(column), -middle(row), lambert, to)) continue;
      const auto [cell, is_new] = known.emplace(row / cell_pixels * pixels_ + column / cell_pixels, cells_.size());
      if (is_new) cells_.push_back(direction(to));
      x_.push_back(static_cast<float>(to[0]));
      y_.push_back(static_cast<float>(to[1]));
      z_.push_back(static_cast<float>(to[2]));
      at_.push_back(static_cast<std::uint32_t>(row * 4 * pixels_ + column));
      cell_.push_back(cell->second);
      stripes_.push_back((row + column) % stripe_distance < stripe_width ? stripe : 0);
    }
    rows_.push_back({first, count() - first});
  }
  values_.resize(16 * count());
  outside_.resize(cells_.size());
  image_.resize(16 * pixels_ * pixels_);
}

void Hemisphere::evaluate(const PreparedModel& model, const Direction& incident, Frame frame,
                          StokesConvention convention, bool divided) {
  evaluate_elements(model.at(incident), frame, convention, divided);
  for (std::size_t c = 0; c < cells_.size(); ++c)
    outside_[c] = leaves_known_range(model.outside({incident, cells_[c]})) ? 0xffff : 0;
}

void Hemisphere::evaluate_elements(const PreparedIncidence& at, Frame frame, StokesConvention convention,
                                   bool divided) {
  constexpr std::size_t most = 2048;  // directions at a time: their values stay in the cache
  Mueller sign;
  sign.elements.fill(1);
  sign = convert(sign, StokesConvention::germer2017, convention);
  for (std::size_t first = 0; first < count(); first += most) {
    const std::size_t length = std::min(most, count() - first);
    MuellerColumns<float> columns;
    for (std::size_t e = 0; e < 16; ++e) columns.elements[e] = {values_.data() + e * count() + first, length};
    const auto part = [&](const std::vector<float>& all) { return std::span(all).subspan(first, length); };
    mmbrdf::evaluate(at, UnitVectors<float>{part(x_), part(y_), part(z_)}, columns, {.frame = frame});
    std::array<float, most> by_f11;
    for (std::size_t i = 0; i < length; ++i) by_f11[i] = 1 / columns.elements[0][i];
    for (std::size_t e = 1; e < 16; ++e) {
      const auto s = static_cast<float>(sign.elements[e]);
      float* const column = columns.elements[e].data();
      if (divided)
        for (std::size_t i = 0; i < length; ++i) column[i] *= s * by_f11[i];
      else if (s < 0)
        for (std::size_t i = 0; i < length; ++i) column[i] = -column[i];
    }
  }
}

void Hemisphere::subtract(const Hemisphere& first) {
  if (pixels_ != first.pixels_ || lambert_ != first.lambert_)
    throw std::invalid_argument("hemispheres to subtract must have as many pixels, and the same projection");
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] -= first.values_[i];
  for (std::size_t c = 0; c < outside_.size(); ++c) outside_[c] |= first.outside_[c];
}

void Hemisphere::extremes(float* out) const {
  constexpr std::size_t lanes = 16;  // side by side, as vectors do it
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (std::size_t e = 0; e < 16; ++e) {
    const float* const column = values_.data() + e * count();
    std::array<float, lanes> low, high;
    low.fill(infinity), high.fill(-infinity);
    const auto add = [&](std::size_t i, std::size_t lane) {
      low[lane] = column[i] < low[lane] ? column[i] : low[lane];
      high[lane] = high[lane] < column[i] ? column[i] : high[lane];
    };
    const std::size_t whole = count() / lanes * lanes;
    for (std::size_t i = 0; i < whole; i += lanes)
      for (std::size_t lane = 0; lane < lanes; ++lane) add(i + lane, lane);
    for (std::size_t i = whole; i < count(); ++i) add(i, 0);
    out[2 * e] = *std::min_element(low.begin(), low.end());
    out[2 * e + 1] = *std::max_element(high.begin(), high.end());
  }
}

void Hemisphere::paint() {
  std::vector<int> color(pixels_);  // numbers of a row: found in vectors, looked up one by one
  std::vector<std::uint16_t> stripes(count());
  for (std::size_t i = 0; i < count(); ++i) stripes[i] = stripes_[i] & outside_[cell_[i]];
  for (std::size_t e = 0; e < 16; ++e) {
    std::uint32_t* const tile = image_.data() + (e / 4 * 4 * pixels_ + e % 4) * pixels_;
    const int first = e == 0 ? 0 : shades;
    const float low = limits_[2 * e], scale = 255.999F / (limits_[2 * e + 1] - low);
    for (const auto& [begin, length] : rows_) {
      const float* const value = values_.data() + e * count() + begin;
      for (std::size_t i = 0; i < length; ++i) {
        const float t = (value[i] - low) * scale;
        const int known = first + static_cast<int>(std::min(255.0F, std::max(0.0F, t))) + stripes[begin + i];
        color[i] = t == t ? known : unknown_color;
      }
      std::uint32_t* const to = tile + at_[begin];
      for (std::size_t i = 0; i < length; ++i) to[i] = colors_[static_cast<std::size_t>(color[i])];
    }
  }
}

}  // namespace mmbrdf::web
