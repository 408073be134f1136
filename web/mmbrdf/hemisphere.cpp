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
  for (std::size_t row = 0; row < pixels_; ++row)
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
      striped_.push_back((row + column) % stripe_distance < stripe_width);
    }
  values_.resize(16 * count());
  outside_.resize(cells_.size());
  image_.resize(16 * pixels_ * pixels_);
}

void Hemisphere::evaluate(const PreparedModel& model, const Direction& incident, Frame frame,
                          StokesConvention convention, bool divided) {
  MuellerColumns<float> columns;
  for (std::size_t e = 0; e < 16; ++e) columns.elements[e] = {values_.data() + e * count(), count()};
  mmbrdf::evaluate(model.at(incident), UnitVectors<float>{x_, y_, z_}, columns, {.frame = frame});

  Mueller ones;
  ones.elements.fill(1);
  const Mueller sign = convert(ones, StokesConvention::germer2017, convention);
  const std::span<const float> f11 = columns.elements[0];
  for (std::size_t e = 1; e < 16; ++e) {
    const std::span<float> column = columns.elements[e];
    const auto s = static_cast<float>(sign.elements[e]);
    if (divided)
      for (std::size_t i = 0; i < column.size(); ++i) column[i] *= s / f11[i];
    else if (s < 0)
      for (float& value : column) value = -value;
  }
  for (std::size_t c = 0; c < cells_.size(); ++c)
    outside_[c] = leaves_known_range(model.outside({incident, cells_[c]}));
}

void Hemisphere::subtract(const Hemisphere& first) {
  if (pixels_ != first.pixels_ || lambert_ != first.lambert_)
    throw std::invalid_argument("hemispheres to subtract must have as many pixels, and the same projection");
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] -= first.values_[i];
  for (std::size_t c = 0; c < outside_.size(); ++c) outside_[c] |= first.outside_[c];
}

void Hemisphere::extremes(float* out) const {
  for (std::size_t e = 0; e < 16; ++e) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (const float value : std::span(values_).subspan(e * count(), count())) {
      low = value < low ? value : low;
      high = value > high ? value : high;
    }
    out[2 * e] = low;
    out[2 * e + 1] = high;
  }
}

void Hemisphere::paint() {
  for (std::size_t e = 0; e < 16; ++e) {
    const float* const value = values_.data() + e * count();
    std::uint32_t* const tile = image_.data() + (e / 4 * 4 * pixels_ + e % 4) * pixels_;
    const std::uint32_t* const plain = colors_.data() + (e == 0 ? 0 : 256);
    const float low = limits_[2 * e], scale = 255.999F / (limits_[2 * e + 1] - low);
    for (std::size_t i = 0; i < count(); ++i) {
      const float t = (value[i] - low) * scale;
      const bool stripe = (striped_[i] & outside_[cell_[i]]) != 0;
      if (t == t)
        tile[at_[i]] = plain[static_cast<int>(std::min(255.0F, std::max(0.0F, t))) + (stripe ? 512 : 0)];
      else
        tile[at_[i]] = colors_[1024];
    }
  }
}

}  // namespace mmbrdf::web
