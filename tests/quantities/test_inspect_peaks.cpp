// SPDX-License-Identifier: BSD-3-Clause
// What inspect() says of f11 alone: it leaves peaks of shiny samples alone, and light from one direction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "mmbrdf/quantities/fit_warnings.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/text/units.hpp"

namespace mmbrdf {
namespace {

using Samples = std::vector<Sample>;

/// f11 alone, without noise, at all directions of a grid of 10 and 30 degrees.
Samples of_f11(const std::vector<double>& theta_i, const std::function<double(const Geometry&)>& f11) {
  Mueller unknown;
  unknown.elements.fill(std::numeric_limits<double>::quiet_NaN());
  unknown(0, 0) = 1;
  Samples samples;
  for (const double from : theta_i)
    for (int to = 0; to <= 80; to += 10)
      for (int phi = 0; phi < 360; phi += 30) {
        const Geometry g{direction_from_degrees(from, 180), direction_from_degrees(to, phi)};
        samples.push_back({.wavelength = 0.532, .geometry = g, .f11 = f11(g), .normalized = unknown});
      }
  return samples;
}

const std::vector<double> many{0, 15, 30, 45, 60, 75};

std::string found(const Samples& samples) {
  std::string list;
  for (const Finding& one : inspect(samples).findings) list += (list.empty() ? "" : ", ") + to_string(one);
  return list;
}

double cosine_between(const Geometry& g, int sign) {
  const auto& [i, r] = g;
  return std::cos(i.theta) * std::cos(r.theta) + sign * std::sin(i.theta) * std::sin(r.theta) * std::cos(r.phi - i.phi);
}

/// A peak of `width` degrees in the direction of a mirror, or back to the source.
std::function<double(const Geometry&)> peak(double height, double width, int sign, double decimals) {
  return [=](const Geometry& g) {
    const double away = degrees(std::acos(std::min(1.0, cosine_between(g, sign)))),
                 value = 0.01 + height * std::exp(-away * away / (width * width));
    return std::round(value * decimals) / decimals;
  };
}

constexpr int of_mirror = -1, of_source = 1;

TEST(Inspect, TakesNoPeakForFillValues) {
  for (const int sign : {of_mirror, of_source})
    for (const double height : {20.0, 1e4})
      EXPECT_EQ(found(of_f11(many, peak(height, 3, sign, 1e3))).find("fill"), std::string::npos) << sign << height;
  Samples overload = of_f11(many, peak(20, 3, of_mirror, 1e3));
  for (std::size_t i = 0; i < overload.size(); i += 10) overload[i].f11 = 9999;  // wherever
  EXPECT_EQ(inspect(overload).findings.at(0).samples.size(), (overload.size() + 9) / 10);
}

// A table of two decimals has as many zeros of a dark sample as it has 0.01 and 0.02.
TEST(Inspect, TakesNoRoundedDarkSampleForFillValues) {
  std::size_t number = 0;
  const Samples dark = of_f11(many, [&](const Geometry&) { return static_cast<double>(++number % 4) * 0.01; });
  EXPECT_EQ(found(dark).find("fill"), std::string::npos) << found(dark);
}

// A half direction within 9 degrees of the normal. A fit of low order makes a reflectance of it that is not there.
TEST(Inspect, TakesNoReflectanceFromAShinySample) {
  const auto shiny = [](const Geometry& g) {
    const auto& [i, r] = g;
    const double cosine = (std::cos(i.theta) + std::cos(r.theta)) / std::sqrt(2 + 2 * cosine_between(g, 1)),
                 a2 = 0.05 * 0.05, slope = cosine * cosine * (a2 - 1) + 1;
    return 0.02 + a2 / (std::numbers::pi * slope * slope) / (4 * std::max(std::cos(i.theta), std::cos(r.theta)));
  };
  EXPECT_EQ(found(of_f11(many, shiny)), "");
  EXPECT_TRUE(inspect(of_f11(many, shiny)).untested.at(0).reason.ends_with(" % of f11, noise or a peak"));
  EXPECT_NE(found(of_f11(many, [&](const Geometry& g) { return 1000 * shiny(g); })).find("scale of f11"),
            std::string::npos);
}

// It fits better after it is divided by cos theta_r, which says nothing.
TEST(Inspect, DoesNotAskReciprocityForACosineWhereThetaIHardlyVaries) {
  const auto glossy = [](const Geometry& g) {
    return 0.02 + 0.2 * std::exp(-12 * std::pow(std::sin(g.reflected.theta), 2));
  };
  for (const std::vector<double>& theta_i : {std::vector<double>{0}, {40, 45, 50}}) {
    const Inspection seen = inspect(of_f11(theta_i, glossy));
    EXPECT_TRUE(seen.findings.empty());
    const auto of_cosine = [](const Untested& one) { return one.fault == "cosine"; };
    EXPECT_TRUE(std::ranges::any_of(seen.untested, of_cosine));
  }
}

TEST(Inspect, NamesF11ThatIsNotPositive) {
  for (const double f11 : {-0.1, 0.0})
    EXPECT_EQ(found(of_f11(many, [&](const Geometry&) { return f11; })).substr(0, 44),
              "f11 not positive: in 648 samples: 1, 2, 3, 4");
  std::size_t number = 0;  // of four, one is below 0
  EXPECT_EQ(
      found(of_f11(many,
                   [&](const Geometry&) { return ++number % 4 == 0 ? -1e-6 * static_cast<double>(number) : 0.001; })),
      "");
}

}  // namespace
}  // namespace mmbrdf
