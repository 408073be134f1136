// SPDX-License-Identifier: BSD-3-Clause
// What samples support (theory 4.7), and what becomes of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "given/halton.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/quantities/fit_warnings.hpp"
#include "mmbrdf/quantities/report.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {
namespace {

Geometry at_degrees(double theta_i, double theta_r, double phi) {
  return {{radians(theta_i), 0}, {radians(theta_r), radians(phi)}};
}

/// Degrees from the direction of retroreflection.
double azimuth(const Geometry& g) {
  return std::abs(degrees(std::remainder(g.reflected.phi - g.incident.phi, 2 * std::numbers::pi)));
}

using Part = std::function<bool(const Geometry&)>;
bool forward(const Geometry& g) { return azimuth(g) >= 90 - 1e-9 || g.reflected.theta == 0; }
bool low(const Geometry& g) { return g.reflected.theta < radians(41); }

/// Where the published grid has a part.
std::vector<Geometry> grid(const Part& part) {
  std::vector<Geometry> result;
  std::ranges::copy_if(germer2017_grid(), std::back_inserter(result), part);
  return result;
}

std::vector<Sample> measured(const std::vector<Geometry>& geometries, double wavelength = 0.532) {
  return simulate(material("ptfe"), std::array{wavelength}, geometries, 0.006, 1);
}

FitResult least_squares(const std::vector<Sample>& samples, Basis basis = {}) {
  FitOptions options;
  options.minimum_norm = true;
  return fit(samples, basis, options, Weights::speckle);
}

bool unsupported(const Model& model, const Geometry& g, double wavelength = 0.532) {
  return (outside(model.validity, wavelength, g) & outside_directions) != 0;
}

const std::vector<std::pair<const char*, Part>> parts = {
    {"forward half", forward},
    {"backward half", [](const Geometry& g) { return azimuth(g) <= 90 + 1e-9; }},
    {"60 degrees of azimuth", [](const Geometry& g) { return azimuth(g) >= 150; }},
    {"30 degrees of azimuth", [](const Geometry& g) { return azimuth(g) >= 165; }},
    {"cap", low},
    {"two caps", [](const Geometry& g) { return low(g) && g.incident.theta < radians(46); }},
    {"ring", [](const Geometry& g) { return g.reflected.theta > radians(35) && g.reflected.theta < radians(62); }},
    {"one incidence", [](const Geometry& g) { return std::abs(degrees(g.incident.theta) - 45) < 1; }},
};

// One azimuth of the source says nothing of others, unless all are alike.
TEST(Support, OfAnAnisotropicModelEndsAtTheAzimuthsOfTheSource) {
  const auto at_azimuths = [](const std::vector<double>& azimuths_deg) {
    std::vector<Geometry> result;
    for (const double azimuth_deg : azimuths_deg)
      for (Geometry g : grid([](const Geometry&) { return true; })) {
        g.incident.phi += radians(azimuth_deg);
        g.reflected.phi += radians(azimuth_deg);
        result.push_back(g);
      }
    return result;
  };
  const Geometry turned{{radians(45), radians(90)}, {radians(30), radians(270)}};
  for (const auto& [family, azimuths_deg, expected] :
       {std::tuple{Family::isotropic, std::vector{0.0}, true},
        {Family::anisotropic, {0.0}, false},
        {Family::anisotropic, {0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0}, true}}) {
    const Model model = least_squares(measured(at_azimuths(azimuths_deg)), {family, {1, 0}}).model;
    EXPECT_EQ(unsupported(model, turned), !expected) << azimuths_deg.size();
    EXPECT_FALSE(unsupported(model, {{radians(45), 0}, {radians(30), radians(180)}}));
  }
}

TEST(Support, WhereverWasMeasuredIsSupported) {
  for (const auto& [name, part] : parts)
    for (const Family family : {Family::isotropic, Family::germer2017, Family::anisotropic}) {
      if (family == Family::anisotropic && std::string(name) != "forward half") continue;  // takes a second
      const std::vector<Geometry> geometries = grid(part);
      const Model model = least_squares(measured(geometries), {family, {3, 2}}).model;
      EXPECT_TRUE(std::ranges::none_of(geometries, [&](const Geometry& g) { return unsupported(model, g); })) << name;
      const bool one_sided = part(at_degrees(60, 60, 180)) != part(at_degrees(60, 60, 0));
      EXPECT_TRUE(!one_sided || unsupported_share(model.validity, 0.532) > 0.1) << name << " " << to_string(family);
    }
}

/// Elements of a fit of the sample to a part of the grid, and those that are beyond 3 u of the truth and not flagged.
void expect_flagged(const char* name, const Part& part, const Orders& orders) {
  const PreparedModel truth = prepare(material("ptfe"), 0.532);
  const Model model = fit_sample(measured(grid(part)), {.orders = orders}).model;
  ASSERT_TRUE(model.posterior) << name;
  const PreparedModel prepared = prepare(model, 0.532);
  const PreparedUncertainty uncertainty = prepare_uncertainty(model, 0.532);
  int all = 0, beyond = 0;
  for (const Geometry& g : halton_directions(200, 0, 82)) {
    if (leaves_known_range(prepared.outside(g))) continue;
    const Mueller found = prepared.evaluate(g), right = truth.evaluate(g),
                  u = standard_uncertainty(uncertainty.evaluate(g));
    for (std::size_t e = 0; e < 16; ++e, ++all) {
      const double error = std::abs(found.elements[e] - right.elements[e]);
      beyond += error > 3 * u.elements[e] ? 1 : 0;
      EXPECT_LE(error, 4 * u.elements[e] + 1e-12) << name << " element " << e << " at " << place_line(g);
    }
  }
  EXPECT_GT(all, 16 * 5) << name;
  EXPECT_LE(beyond, 2 + 0.003 * all) << name;  // the chance of a normal distribution is .0027
}

TEST(Support, ErrorsBeyondThreeUncertaintiesAreFlaggedButForChance) {
  for (const auto& [name, part] : parts) expect_flagged(name, part, {7, 4});
  expect_flagged(parts[0].first, parts[0].second, {5, 4});
}

TEST(Support, SourceAndReceiverAreInterchangeable) {
  const Model model = least_squares(measured(grid([](const Geometry& g) { return low(g) || forward(g); }))).model;
  int differ = 0;
  for (const Geometry& g : halton_directions(500, 0, 70)) {
    // nodes of measured pairs are supported without their exchange
    differ += unsupported(model, g) != unsupported(model, {g.reflected, g.incident}) ? 1 : 0;
  }
  EXPECT_LT(differ, 10);
}

TEST(Support, ACompleteHemisphereNeedsNoList) {
  std::vector<Geometry> all;
  for (int i = 0; i <= 75; i += 15)
    for (int r = 0; r <= 75; r += 5)
      for (int phi = 0; phi < 360; phi += 15) all.push_back(at_degrees(i, r, phi));
  EXPECT_TRUE(least_squares(measured(all)).model.validity.supported.empty());
  EXPECT_EQ(outside(least_squares(measured(all)).model.validity, 0.532, at_degrees(40, 60, 95)), inside);
}

TEST(Support, ACornerOfTheWavelengthsIsNotSupported) {
  std::vector<Sample> samples = measured(grid([](const Geometry&) { return true; }), 0.351);
  for (const double wavelength : {0.532, 0.633}) {
    const std::vector<Sample> more = measured(grid(low), wavelength);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  const Model model = least_squares(samples).model;
  ASSERT_EQ(model.validity.supported.size(), 3);
  const Geometry high = at_degrees(60, 65, 90), deep = at_degrees(30, 30, 90);
  EXPECT_EQ(outside(model.validity, 0.351, high), inside);
  EXPECT_EQ(outside(model.validity, 0.532, high), outside_directions);
  EXPECT_EQ(outside(model.validity, 0.4, high), outside_directions | interpolated);
  EXPECT_EQ(outside(model.validity, 0.4, deep), interpolated);
  EXPECT_EQ(outside(model.validity, 0.7, deep), outside_wavelength);
  EXPECT_EQ(to_string(outside(model.validity, 0.4, high)), "directions+interpolated");
  EXPECT_FALSE(leaves_known_range(outside(model.validity, 0.4, deep)));
}

TEST(Support, WhatOneOfManyWavelengthsLacksIsNotSupportedThere) {
  std::vector<Sample> samples;
  for (int k = 0; k < 20; ++k) {
    const std::vector<Sample> more =
        measured(grid(k < 19 ? Part([](const Geometry&) { return true; }) : forward), 0.4 + 0.01 * k);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  const Model model = least_squares(samples, {.orders = {3, 2}}).model;
  EXPECT_EQ(model.validity.supported.size(), 3U);  // the first, the last of the same, and the other
  EXPECT_EQ(outside(model.validity, 0.5, at_degrees(60, 60, 0)), inside);
  EXPECT_EQ(outside(model.validity, 0.58, at_degrees(60, 60, 0)), inside);
  EXPECT_EQ(outside(model.validity, 0.59, at_degrees(60, 60, 0)), outside_directions);
  EXPECT_EQ(outside(model.validity, 0.585, at_degrees(60, 60, 0)), outside_directions | interpolated);
}

TEST(Support, OfMoreSetsThanAModelKeepsIsWhatAllHave) {
  std::vector<Sample> samples;
  for (int k = 0; k < 40; ++k) {
    const std::vector<Sample> more = measured(grid(k % 2 == 0 ? Part(low) : forward), 0.4 + 0.01 * k);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  const Model model = least_squares(samples, {.orders = {3, 2}}).model;
  EXPECT_EQ(model.validity.supported.size(), 1U);
  for (const double wavelength : {0.4, 0.41}) {
    EXPECT_TRUE(unsupported(model, at_degrees(60, 60, 0), wavelength));
    EXPECT_FALSE(unsupported(model, at_degrees(30, 30, 180), wavelength));
  }
}

TEST(Support, PartsOfTheSamplesMakeTheSameAsTheWhole) {
  const std::vector<Sample> samples = measured(grid(forward));
  const std::span<const Sample> all(samples);
  FitAccumulator whole({}), first({}), second({});
  whole.add(all);
  first.add(all.first(300));
  second.add(all.subspan(300));
  first.merge(FitAccumulator::from_state({}, second.state()));
  FitOptions options;
  options.minimum_norm = true;
  EXPECT_FALSE(whole.solve(options).model.validity.supported.empty());
  EXPECT_EQ(first.solve(options).model.validity.supported, whole.solve(options).model.validity.supported);
  EXPECT_EQ(whole.at_orders({3, 2}).solve().model.validity.supported, whole.solve(options).model.validity.supported);
}

TEST(Support, GoesThroughAFile) {
  const Model model = least_squares(measured(grid(forward)), {.orders = {3, 2}}).model;
  EXPECT_EQ(model_from_json(to_json(model), "m").validity.supported, model.validity.supported);
}

TEST(Support, OnAnotherGridIsRefused) {
  Model model = least_squares(measured(grid(forward)), {.orders = {3, 2}}).model;
  model.validity.supported.front().wavelength = -1;
  EXPECT_THROW(require_valid(model), std::invalid_argument);
  model.validity.supported = {{0.532, DirectionPairs(DirectionPairs::Grid::anisotropic)}};
  EXPECT_THROW(require_valid(model), std::invalid_argument);
  model.validity.supported = {{0.5, DirectionPairs()}, {0.6, DirectionPairs(DirectionPairs::Grid::anisotropic)}};
  EXPECT_THROW(require_valid(model), std::invalid_argument);
}

TEST(Support, OfNothingIsWarnedOfInReports) {
  const Model model = least_squares(measured(grid(forward)), {.orders = {3, 2}}).model;
  EXPECT_NE(report_json(model, "m", std::array{0.532}, {}).find("532 nm: no samples support"), std::string::npos);
}

TEST(Support, NothingOutsideIsEstimable) {
  const Model model = least_squares(measured(grid(forward)), {.orders = {3, 2}}).model;
  const Answers answers(model);
  EXPECT_TRUE(answers.at(0.532).at(at_degrees(60, 60, 180)).estimable.value());
  EXPECT_FALSE(answers.at(0.532).at(at_degrees(60, 60, 0)).estimable.value());
  EXPECT_FALSE(answers.at(0.532).at(at_degrees(80, 60, 180)).estimable.value());
  EXPECT_FALSE(answers.at(0.6).at(at_degrees(60, 60, 180)).estimable.value());
}

TEST(Support, FitsNameThePartThatIsMissing) {
  const auto warned = [](const FitResult& result, const std::string& words) {
    return std::ranges::any_of(fit_warnings(result), [&](const std::string& line) {
      return line.starts_with("no samples support ") && line.find(words) != std::string::npos;
    });
  };
  EXPECT_TRUE(warned(least_squares(measured(grid(forward))), "most at phi_r - phi_i 0 to 60"));
  EXPECT_TRUE(warned(least_squares(measured(grid(parts.back().second))), "within the fitted angles"));
  EXPECT_FALSE(warned(least_squares(measured(germer2017_grid())), ""));
}

}  // namespace
}  // namespace mmbrdf
