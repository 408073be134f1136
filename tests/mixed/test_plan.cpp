// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/mixed/plan.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "given/cases.hpp"
#include "given/checkout.hpp"
#include "given/first_pass.hpp"
#include "given/halton.hpp"
#include "given/published_samples.hpp"
#include "mixed/prior.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using nlohmann::json;

constexpr std::array<const char*, 6> block_names{"11", "g", "14", "uv", "h", "44"};

json golden() {
  std::ifstream file(in_checkout("tests/data/mixed_model.json"));
  return json::parse(file);
}

/// Components as the reference rounded them, with the noise and the f11 of the published grid at 532 nm.
VarianceComponents reference_components(const std::vector<Sample>& samples) {
  const json all = golden();
  VarianceComponents result;
  result.f11 = first_pass(samples, {}, {}).f11;
  for (const char* name : block_names) {
    std::vector<double> hyperparameters;
    const json& theirs = all["planning"]["components"][name];
    for (const char* one : {"iso", "slope", "q1", "q2", "q3", "free slope", "odd"})
      hyperparameters.push_back(theirs[one]);
    hyperparameters.push_back(theirs[theirs.contains("cal") ? "cal" : "nonreciprocal"]);
    const double noise = all["estimated"][name]["grid"]["noise"];
    result.blocks.push_back({hyperparameters, noise * noise});
  }
  return result;
}

std::vector<PlanTarget> all_targets() {
  std::vector<PlanTarget> result;
  for (std::size_t b = 0; b < block_names.size(); ++b) result.push_back({PlanTarget::Kind::block, b, {}});
  for (const double theta : {0.0, 45.0, 60.0}) result.push_back({PlanTarget::Kind::dhr, 0, {{radians(theta), 0}, {}}});
  result.push_back({PlanTarget::Kind::f11, 0, {{0, 0}, {radians(45), 0}}});
  return result;
}

/// Reading i of these at the azimuth that the sample is turned by, in degrees.
std::vector<Geometry> turned_by(const std::vector<Sample>& samples, auto degrees, std::size_t step = 1) {
  std::vector<Geometry> result;
  for (std::size_t s = 0; s < samples.size(); s += step) {
    Geometry g = samples[s].geometry;
    const double turn = radians(degrees(result.size(), g));
    g.incident.phi += turn;
    g.reflected.phi += turn;
    result.push_back(g);
  }
  return result;
}

double golden_ratio(std::size_t i, const Geometry&) {
  return 360 * std::fmod(0.6180339887498949 * static_cast<double>(i), 1);
}

std::vector<Geometry> candidates() {
  std::vector<Geometry> result;
  for (const Geometry& g : halton_directions(2000, 0, 78)) {
    const Vector3 i = unit_vector(g.incident), r = unit_vector(g.reflected);
    const double cosine = i[0] * r[0] + i[1] * r[1] + i[2] * r[2];
    if (g.incident.theta <= radians(75.1) && cosine < std::cos(radians(5))) result.push_back(g);
  }
  return result;
}

void expect_golden(const std::string& design, const std::vector<double>& found) {
  const json expected = golden()["planning"]["designs"][design];
  SCOPED_TRACE(design);
  std::vector<double> list;
  for (const char* name : block_names) list.push_back(expected[std::string("u ") + name]);
  for (const json& u : expected["u DHR 0 45 60"]) list.push_back(u);
  list.push_back(expected["u f(0:45)"]);
  ASSERT_EQ(found.size(), list.size());
  for (std::size_t t = 0; t < list.size(); ++t)
    EXPECT_NEAR(found[t], list[t], 0.01 * list[t] + 0.5e-5);  // given to 1e-5
}

TEST(Plan, AgreesWithTheReferenceForItsDesigns) {
  if (published("PTFE.data.csv").empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  const std::vector<Sample> samples = grid_at(0.532);
  const VarianceComponents components = reference_components(samples);
  const auto expect = [&](const std::string& name, const std::vector<Geometry>& design) {
    expect_golden(name, expected_uncertainties(components, design, all_targets()));
  };
  expect("published grid, fixed azimuth", turned_by(samples, [](auto, auto&) { return 0.0; }));
  expect("turned 60 deg per incidence", turned_by(samples, [](auto, const Geometry& g) {
           return 60 * std::round(in_degrees(g.incident.theta) / 15);
         }));
  expect("every second reading at +180",
         turned_by(samples, [](std::size_t i, auto&) { return i % 2 == 1 ? 180.0 : 0; }));
  expect("golden-ratio azimuth per reading", turned_by(samples, golden_ratio));
  expect("golden-ratio azimuth, every 4th reading", turned_by(samples, golden_ratio, 4));
}

/// V of theory 8.6 of a block, of isotropic modes, by a dense inverse of readings at each geometry and element.
MatrixXd dense_covariance(const VarianceComponents& components, const MixedColumns& columns, std::size_t block,
                          const std::vector<Geometry>& design) {
  const auto& [hyperparameters, noise] = components.blocks[block];
  const VectorXd v = prior_of(columns).variances(Eigen::Map<const VectorXd>(hyperparameters.data(), 8));
  const MatrixXd x = columns.read_at(design);
  VectorXd variances(x.rows());  // of the readings; f11 is 1/pi
  for (Index row = 0; row < x.rows(); ++row) {
    const auto& [i, r] = design[static_cast<std::size_t>(row) % design.size()];
    variances(row) = noise * std::cos(i.theta) / std::cos(r.theta);
    if (block == 0) variances(row) /= std::numbers::pi * std::numbers::pi;
  }
  const MatrixXd vx = v.asDiagonal() * x.transpose();
  const MatrixXd k = x * vx + MatrixXd(variances.asDiagonal());
  const Index n = columns.isotropic_count();
  return (MatrixXd(v.asDiagonal()) - vx * k.llt().solve(vx.transpose())).topLeftCorner(n, n);
}

/// 1e-6: K has a condition of 1e8. The hemisphere is a sum over the midpoints of equal parts: 1e-3.
void expect_dense_uncertainties(const Elements& unread) {
  VarianceComponents components = default_components();
  components.orders = {5, 4};
  components.unread = unread;
  const std::vector<Geometry> design = random_geometries(30, 3), spread = halton_directions(1000, 0, 70);
  const Geometry one{{0.3, 0.4}, {0.9, 2}};
  const std::vector<PlanTarget> targets{{PlanTarget::Kind::block, 0, {}},
                                        {PlanTarget::Kind::f11, 0, one},
                                        {PlanTarget::Kind::dhr, 0, {{0.3, 0}, {}}},
                                        {PlanTarget::Kind::block, 2, {}},
                                        {PlanTarget::Kind::block, 3, {}}};
  const std::vector<double> found = expected_uncertainties(components, design, targets);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const std::size_t b = targets[t].block;
    const MixedColumns columns(blocks(Family::isotropic, components.orders)[b], components.mapping, unread);
    MatrixXd h = columns.isotropic_at(spread);
    if (targets[t].kind == PlanTarget::Kind::f11) h = columns.isotropic_at({&one, 1});
    if (targets[t].kind == PlanTarget::Kind::dhr) {  // the mean of pi f11 over projected cosine
      std::vector<Geometry> all;
      for (int a = 0; a < 200; ++a)
        for (int p = 0; p < 12; ++p)
          all.push_back({{0.3, 0}, {std::asin(std::sqrt((a + 0.5) / 200)), 2 * std::numbers::pi * p / 12}});
      h = std::numbers::pi * columns.isotropic_at(all).colwise().mean();
    }
    const MatrixXd v = dense_covariance(components, columns, b, design);
    const double u = std::sqrt((h * v).cwiseProduct(h).rowwise().sum().mean());
    EXPECT_NEAR(found[t] / u, 1, targets[t].kind == PlanTarget::Kind::dhr ? 1e-3 : 1e-6) << t;
  }
}

TEST(Plan, HasTheUncertaintiesOfTheDenseCovariance) { expect_dense_uncertainties({}); }

// Of the blocks 14 and 22: 41 as 23 and 33 follow from the others by symmetry, and are not read.
TEST(Plan, CountsNoElementsThatReadingsDoNotTellOf) { expect_dense_uncertainties(Elements(0x1440)); }

// Without readings, u² is the prior's; a reading never makes it larger; with many, they are of the noise alone, as 1/√n.
TEST(Plan, GoesFromThePriorToTheNoiseAsReadingsAreAdded) {
  VarianceComponents components = default_components();
  components.orders = {3, 2};
  const std::vector<PlanTarget> targets{{PlanTarget::Kind::block, 2, {}}};
  const MixedColumns columns(blocks(Family::isotropic, components.orders)[2], components.mapping);
  const MatrixXd h = columns.isotropic_at(halton_directions(1000, 0, 70));
  const VectorXd v =
      prior_of(columns).variances(Eigen::Map<const VectorXd>(components.blocks[2].hyperparameters.data(), 8));
  const double prior = std::sqrt((h.cwiseAbs2() * v.head(h.cols())).mean());
  EXPECT_NEAR(expected_uncertainties(components, {}, targets)[0] / prior, 1, 1e-9);
  double before = prior;
  for (const int count : {1, 2, 5, 20, 100}) {
    const double u = expected_uncertainties(components, random_geometries(count, 4), targets)[0];
    EXPECT_LT(u, before);
    before = u;
  }
  for (VarianceComponents::OfBlock& block : components.blocks) block.noise_variance = 1e-14;
  const std::vector<Geometry> many = random_geometries(600, 4);
  const double less = expected_uncertainties(components, many, targets)[0];
  for (VarianceComponents::OfBlock& block : components.blocks) block.noise_variance = 4e-14;
  EXPECT_NEAR(expected_uncertainties(components, many, targets)[0] / less, 2, 0.01);
}

TEST(Plan, ChoosesAsTryingEachCandidateDoes) {
  const VarianceComponents components = default_components();
  const std::vector<Geometry> design = random_geometries(60, 3), some = random_geometries(12, 8);
  const std::vector<PlanTarget> targets{{PlanTarget::Kind::block, 0, {}},
                                        {PlanTarget::Kind::dhr, 0, {{radians(45), 0}, {}}},
                                        {PlanTarget::Kind::block, 2, {}}};
  std::vector<Geometry> so_far = design;
  const std::vector<double> start = expected_uncertainties(components, design, targets);
  for (const std::size_t taken : chosen(components, design, targets, some, 2)) {
    std::size_t best = 0;
    double least = 1e300;
    for (std::size_t c = 0; c < some.size(); ++c) {
      std::vector<Geometry> with = so_far;
      with.push_back(some[c]);
      double sum = 0;
      const std::vector<double> u = expected_uncertainties(components, with, targets);
      for (std::size_t t = 0; t < u.size(); ++t) sum += u[t] * u[t] / (start[t] * start[t]);
      if (sum < least) {
        least = sum;
        best = c;
      }
    }
    EXPECT_EQ(taken, best);
    so_far.push_back(some[taken]);
  }
}

TEST(Plan, ChoosesWhatTheReferenceChooses) {
  if (published("PTFE.data.csv").empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  const std::vector<Sample> samples = grid_at(0.532);
  const VarianceComponents components = reference_components(samples);
  const std::vector<Geometry> some = candidates();
  ASSERT_EQ(some.size(), 1945);
  const json expected = golden()["planning"]["200 further readings"]["start from published grid, fixed azimuth"];
  const std::vector<Geometry> design = turned_by(samples, [](auto, auto&) { return 0.0; });
  const std::vector<PlanTarget> f11{{PlanTarget::Kind::block, 0, {}}};
  const auto picks = chosen(components, design, f11, some, 200);
  const json& after = expected["greedy for mean u(f11)"];
  EXPECT_EQ(std::vector(picks.begin(), picks.begin() + 5), after["first_picks"].get<std::vector<std::size_t>>());
  std::vector<Geometry> with = design;
  for (const std::size_t c : picks) with.push_back(some[c]);
  EXPECT_NEAR(expected_uncertainties(components, with, f11)[0], after["u 11"].get<double>(), 1e-5);
  std::vector<PlanTarget> every;
  for (std::size_t b = 0; b < block_names.size(); ++b) every.push_back({PlanTarget::Kind::block, b, {}});
  EXPECT_EQ(chosen(components, design, every, some, 5),
            expected["greedy for all blocks"]["first_picks"].get<std::vector<std::size_t>>());
}

TEST(Plan, RefusesWhatCannotBeMeasured) {
  const Geometry grazing{{0, 0}, {std::numbers::pi / 2, 0}};
  const std::string why = "geometry 1: nothing is measured at 90 degrees";
  EXPECT_EQ(message_of([&] { expected_uncertainties(default_components(), {&grazing, 1}, all_targets()); }), why);
  EXPECT_EQ(message_of([&] { chosen(default_components(), {}, all_targets(), {&grazing, 1}, 1); }), why);
  EXPECT_EQ(message_of([&] { chosen(default_components(), {}, all_targets(), {}, 1); }), "no candidates");
}

TEST(Plan, RefusesToChooseForNothingOrTooMuch) {
  const VarianceComponents components = default_components();
  const std::vector<PlanTarget> reflectance{{PlanTarget::Kind::dhr, 0, {{0.5, 0}, {}}}};
  const std::vector<Geometry> few{{{0, 0}, {0.5, 0}}};
  EXPECT_EQ(message_of([&] { chosen(components, {}, {}, few, 1); }), "no targets");
  EXPECT_EQ(message_of([&] { chosen(components, {}, reflectance, std::vector<Geometry>(20001, few[0]), 1); }),
            "20001 candidates, more than 20000");
  EXPECT_EQ(message_of([&] { chosen(components, {}, reflectance, few, 1001); }),
            "1001 of the candidates are asked for, more than 1000");
  const std::vector<PlanTarget> none{{PlanTarget::Kind::block, 6, {}}};
  EXPECT_EQ(message_of([&] { chosen(components, {}, none, few, 1); }), "there is no block 6");
  EXPECT_EQ(message_of([&] { expected_uncertainties(components, few, none); }), "there is no block 6");
}

TEST(Plan, RefusesComponentsThatDoNotAgreeWithTheBlocks) {
  const std::vector<Geometry> few{{{0, 0}, {0.5, 0}}};
  const auto refusal = [&](auto spoil) {
    VarianceComponents components = default_components();
    spoil(components.blocks);
    return message_of([&] { expected_uncertainties(components, few, {all_targets().data(), 1}); });
  };
  EXPECT_EQ(refusal([](auto& blocks) { blocks.pop_back(); }), "variance components of 5 blocks, expected 6");
  EXPECT_EQ(refusal([](auto& blocks) { blocks[0].hyperparameters.clear(); }),
            "elements 11 were not measured: nothing is known of their variances");
  EXPECT_EQ(refusal([](auto& blocks) { blocks[0].hyperparameters.pop_back(); }),
            "block 11: 7 hyperparameters, expected 8");
}

TEST(Plan, TakesTargetsByTheirNames) {
  const auto only = [](const std::string& text) {
    const std::vector<NamedTarget> found = targets_from(text);
    EXPECT_EQ(found.size(), 1u) << text;
    return found.at(0);
  };
  const NamedTarget in_plane = only("f:0:45"), beside = only("f:0:45:90"), reflectance = only("dhr:45");
  EXPECT_EQ(in_plane.name, "f_0_45");
  EXPECT_EQ(beside.name, "f_0_45_90");
  EXPECT_EQ(reflectance.name, "dhr_45");
  EXPECT_EQ(in_plane.target.kind, PlanTarget::Kind::f11);
  EXPECT_EQ(in_plane.target.geometry, (Geometry{{0, 0}, direction_from_degrees(45, 180)}));
  EXPECT_EQ(beside.target.geometry, (Geometry{{0, 0}, direction_from_degrees(45, 90)}));
  EXPECT_EQ(reflectance.target.kind, PlanTarget::Kind::dhr);
  EXPECT_EQ(reflectance.target.geometry.incident, direction_from_degrees(45, 0));
  EXPECT_EQ(targets_from("dhr:0,45").size(), 2u);
  for (const char* wrong : {"", "f11", "dhr", "dhr:0:45", "f:0", "f:0:45:90:0", "g:0:45", "dhr:0,"})
    EXPECT_THROW(targets_from(wrong), std::invalid_argument) << wrong;
  EXPECT_EQ(message_of([] { targets_from("dhr:0:45"); }),
            "target 'dhr:0:45': expected dhr:THETA[,THETA...] or f:THETA_I:THETA_R[:PHI_R], in degrees");
}

}  // namespace
}  // namespace mmbrdf
