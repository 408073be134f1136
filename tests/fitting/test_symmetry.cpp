// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/symmetry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "given/disturbed.hpp"
#include "given/published_samples.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

const FTest& of_block(const std::vector<FTest>& tests, const std::string& block) {
  const auto at = std::find_if(tests.begin(), tests.end(), [&](const FTest& one) { return one.block == block; });
  if (at == tests.end()) throw std::logic_error("no block " + block);
  return *at;
}

/// R_n^k cos kφ or sin kφ, up to a factor.
double c(int n, int k, const Direction& d) { return zernike(n, k, d); }
double s(int n, int k, const Direction& d) { return zernike(n, -k, d); }

/// Exact data with the change: the modes miss it, and the functions of that symmetry, and only those, explain it all.
void expect_explained(std::vector<FTest> SymmetryTests::*tests, const std::string& block, const Change& change) {
  const std::vector<Sample> samples = changed(exact(), change);
  const SymmetryTests found = symmetry_tests(samples, small_orders);
  for (const FTest& test : found.*tests) {
    if (test.block == block) {
      EXPECT_GT(test.rms, 1e-4) << block;
      EXPECT_LT(test.rms_extended, 1e-12) << block;  // rounding
      EXPECT_GT(test.f, 1e10) << block;
      EXPECT_LT(test.p, 1e-20) << block;
    } else {
      EXPECT_LT(test.rms, 1e-12) << test.block;
      EXPECT_LT(test.f, 1) << test.block;  // rounding is no signal
    }
  }
}

constexpr auto reciprocity = &SymmetryTests::reciprocity;
constexpr auto mirror = &SymmetryTests::mirror;
constexpr auto azimuth = &SymmetryTests::azimuth;

}  // namespace

// Quantiles of tables (Abramowitz and Stegun 26.9, to the digits printed there; NIST/SEMATECH handbook 1.3.6.7.3).
TEST(FDistribution, HasTheQuantilesOfTheTables) {
  EXPECT_NEAR(f_probability(3.3258, 5, 10), 0.05, 2e-6);
  EXPECT_NEAR(f_probability(161.45, 1, 1), 0.05, 1e-6);
  EXPECT_NEAR(f_probability(4.9646, 1, 10), 0.05, 2e-6);
  EXPECT_EQ(f_probability(0, 3, 7), 1);
  // P(F > f) with 2 and ν degrees of freedom is (1 + 2 f/ν)^(−ν/2).
  for (const double f : {0.1, 1.0, 5.0, 40.0})
    EXPECT_NEAR(f_probability(f, 2, 9) / std::pow(1 + 2 * f / 9, -4.5), 1, 1e-12) << f;
  EXPECT_EQ(f_probability(INFINITY, 3, 7), 0);
  EXPECT_THROW(f_probability(-1, 1, 1), std::invalid_argument);
  EXPECT_THROW(f_probability(1, 0, 1), std::invalid_argument);
}

TEST(SymmetryTests, FindWhatBreaksReciprocityAndNothingElse) {
  expect_explained(reciprocity, "11",
                   [](Sample& x) { x.f11 += 0.01 * (c(2, 0, x.geometry.incident) - c(2, 0, x.geometry.reflected)); });
  expect_explained(reciprocity, "44", [](Sample& x) {
    const auto& [i, r] = x.geometry;
    x.normalized(3, 3) += 0.01 * (c(3, 1, i) * c(1, 1, r) + s(3, 1, i) * s(1, 1, r));
  });
  expect_explained(reciprocity, "14,41", [](Sample& x) {
    const auto& [i, r] = x.geometry;
    x.normalized(3, 0) += 0.01 * (s(1, 1, i) * c(1, 1, r) - c(1, 1, i) * s(1, 1, r));
  });
  expect_explained(reciprocity, "12,13,21,31", [](Sample& x) {  // in m12 and m13 alone
    const Direction& i = x.geometry.incident;
    x.normalized(0, 1) += 0.01 * c(2, 2, i);
    x.normalized(0, 2) -= 0.01 * s(2, 2, i);
  });
  expect_explained(reciprocity, "24,34,42,43", [](Sample& x) {
    const Direction& r = x.geometry.reflected;
    x.normalized(1, 3) += 0.01 * s(2, 2, r);
    x.normalized(2, 3) -= 0.01 * c(2, 2, r);
  });
  expect_explained(reciprocity, "22,23,32,33", [](Sample& x) {  // v = R_2(i) − R_2(r)
    const double v = 0.01 * (c(2, 0, x.geometry.incident) - c(2, 0, x.geometry.reflected));
    x.normalized(1, 1) += v;
    x.normalized(2, 2) -= v;
  });
}

TEST(SymmetryTests, FindHandednessAndNothingElse) {
  expect_explained(mirror, "11", [](Sample& x) {
    const auto& [i, r] = x.geometry;
    x.f11 += 0.01 * (s(3, 1, i) * c(1, 1, r) - c(3, 1, i) * s(1, 1, r));
    x.f11 += 0.01 * (s(3, 1, r) * c(1, 1, i) - c(3, 1, r) * s(1, 1, i));
  });
  expect_explained(mirror, "14,41", [](Sample& x) {  // circular dichroism
    const auto& [i, r] = x.geometry;
    x.normalized(0, 3) += 0.01 + 0.01 * c(2, 0, r);
    x.normalized(3, 0) += 0.01 + 0.01 * c(2, 0, i);
  });
  expect_explained(mirror, "22,23,32,33", [](Sample& x) {  // v = i (R_2(i) − R_2(r))
    const double v = 0.01 * (c(2, 0, x.geometry.incident) - c(2, 0, x.geometry.reflected));
    x.normalized(2, 1) += v;
    x.normalized(1, 2) += v;
  });
}

// R M R is what a sample behind a layer of optical activity has: isotropic, reciprocal, handed. It mixes 12 with 13, 24
// with 34, and turns u; 11, 14, 41 and 44 stay.
TEST(SymmetryTests, FindOpticalActivityInItsThreeBlocks) {
  const std::vector<Sample> samples =
      changed(exact(), [](Sample& x) { x.normalized = rotator(0.05) * x.normalized * rotator(0.05); });
  const SymmetryTests found = symmetry_tests(samples, small_orders);
  for (const std::string block : {"12,13,21,31", "24,34,42,43", "22,23,32,33"}) {
    EXPECT_GT(of_block(found.mirror, block).rms, 1e-4) << block;
    EXPECT_LT(of_block(found.mirror, block).rms_extended, 1e-12) << block;  // rounding
    EXPECT_GT(of_block(found.reciprocity, block).rms_extended, 1e-4) << block;
  }
  for (const std::string block : {"11", "14,41", "44"}) EXPECT_LT(of_block(found.mirror, block).rms, 1e-12) << block;
}

TEST(SymmetryTests, FindWhatDependsOnTheAzimuthOfTheSource) {
  expect_explained(azimuth, "11", [](Sample& x) { x.f11 += 0.01 * std::cos(x.geometry.incident.phi); });
  expect_explained(azimuth, "22,23,32,33", [](Sample& x) {
    Mueller m;
    m(1, 2) = 0.01 * std::sin(2 * x.geometry.incident.phi);  // in axes that turn with φi
    x.normalized = x.normalized + turned(m, x.geometry.incident.phi);
  });
}

TEST(SymmetryTests, SayThatOneAzimuthTellsNothingOfOthers) {
  std::vector<Geometry> grid = germer2017_grid();
  for (std::size_t g = 0; g < grid.size(); g += 2)  // along the normal an azimuth means nothing
    if (grid[g].incident.theta < radians(0.01)) grid[g].incident.phi = 1;
  const std::vector<Sample> samples = simulate(random_model(Family::isotropic, {2, 1}, 0, 5), one_wavelength, grid);
  const SymmetryTests found = symmetry_tests(samples, {2, 1});
  EXPECT_TRUE(found.one_azimuth);
  EXPECT_TRUE(found.azimuth.empty());
  EXPECT_FALSE(symmetry_tests(exact(60), {2, 1}).one_azimuth);
  std::vector<Sample> whole_turn = samples;
  for (std::size_t s = 0; s < samples.size(); s += 2) whole_turn[s].geometry.incident.phi += 2 * std::numbers::pi;
  EXPECT_TRUE(symmetry_tests(whole_turn, {2, 1}).one_azimuth);
}

// p is uniform in [0, 1] if the errors are normal and independent. Of 40 × 16 tests 5 % are 32, with a standard
// deviation of 5.5; the limits are four of them away.
TEST(SymmetryTests, FindNothingInNoiseTooOften) {
  const std::vector<Sample> samples = exact(100);
  int tests = 0, below = 0;
  double sum = 0;
  for (unsigned long seed = 0; seed < 40; ++seed) {
    const SymmetryTests found = symmetry_tests(noisy(samples, 0.01, seed), small_orders);
    for (const auto& list : {found.reciprocity, found.mirror, found.azimuth})
      for (const FTest& test : list) {
        if (test.extra == 0) continue;
        ++tests;
        below += test.p < 0.05 ? 1 : 0;
        sum += test.p;
      }
  }
  EXPECT_GE(tests, 640);
  EXPECT_NEAR(static_cast<double>(below) / tests, 0.05, 4 * std::sqrt(0.05 * 0.95 / 640));
  EXPECT_NEAR(sum / tests, 0.5, 4 / std::sqrt(12.0 * 640));
}

TEST(SymmetryTests, WeighSamplesAndSumWavelengths) {
  const std::array two{0.4, 0.7};
  std::vector<Sample> samples = noisy(exact(150, two), 0.01, 1);
  const std::size_t count = samples.size();
  Mueller none, one;
  one.elements.fill(1);
  std::vector<Mueller> weights(count, one);
  for (Sample bad : exact(20)) {  // at another wavelength, without weight
    bad.f11 = 7;
    samples.push_back(bad);
    weights.push_back(none);
  }
  const SymmetryTests all = symmetry_tests(samples, small_orders, DiscMapping::lambert, weights);
  samples.resize(count);
  const SymmetryTests good = symmetry_tests(samples, small_orders);
  const std::size_t half = count / 2;
  const SymmetryTests first = symmetry_tests(std::span(samples).first(half), small_orders);
  for (std::size_t b = 0; b < good.mirror.size(); ++b) {
    EXPECT_NEAR(all.mirror[b].f, good.mirror[b].f, 1e-9 * good.mirror[b].f);
    EXPECT_EQ(good.mirror[b].extra, 2 * first.mirror[b].extra);
    EXPECT_EQ(good.mirror[b].freedom, 2 * first.mirror[b].freedom);
  }
  EXPECT_THROW(symmetry_tests(samples, small_orders, DiscMapping::lambert, std::array{one}), std::invalid_argument);
  EXPECT_THROW(symmetry_tests({}, small_orders), std::invalid_argument);
}

// Theory 3.5.
TEST(PublishedData, AreReciprocalButForF11) {
  const std::string random = published("PTFE.data.random.csv");
  if (random.empty()) GTEST_SKIP() << absent("PTFE.data.random.csv");
  const SymmetryTests found = symmetry_tests(read_samples(random), {7, 4});
  const auto expect = [&](const std::string& block, double f, double p) {
    EXPECT_NEAR(of_block(found.reciprocity, block).f, f, 0.005) << block;
    EXPECT_NEAR(of_block(found.reciprocity, block).p, p, 0.005) << block;
  };
  expect("12,13,21,31", 0.97, 0.51);
  expect("24,34,42,43", 1.30, 0.15);
  expect("22,23,32,33", 1.54, 0.09);
  EXPECT_NEAR(of_block(found.reciprocity, "44").p, 0.27, 0.005);
  EXPECT_NEAR(of_block(found.reciprocity, "14,41").p, 0.31, 0.005);
  const FTest& f11 = of_block(found.reciprocity, "11");
  EXPECT_NEAR(f11.f, 2.8, 0.05);
  EXPECT_NEAR(f11.p, 4e-5, 0.5e-5);
  EXPECT_NEAR(f11.rms, 0.00419, 0.5e-5);
  EXPECT_NEAR(f11.rms_extended, 0.00412, 0.5e-5);
  // The sample is not isotropic, as its 22 and 33 tell.
  EXPECT_FALSE(found.one_azimuth);
  EXPECT_LT(of_block(found.azimuth, "22,23,32,33").p, 1e-50);
}

TEST(PublishedData, OfF11At351NanometresAreNotReciprocal) {
  if (published("PTFE.data.csv").empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  const SymmetryTests found = symmetry_tests(grid_at(0.351), {7, 4});
  const FTest& f11 = of_block(found.reciprocity, "11");
  EXPECT_NEAR(f11.f, 88, 0.5);
  EXPECT_NEAR(f11.rms, 0.00322, 0.5e-5);
  EXPECT_NEAR(f11.rms_extended, 0.00227, 0.5e-5);
  EXPECT_TRUE(found.one_azimuth);
}

// Speckle of a known size, three times in each of 200 directions, of a model that the right basis fits and a lower does not.
TEST(LackOfFit, TellsMisfitFromNoise) {
  const Basis right{Family::isotropic, {4, 2}}, low{Family::isotropic, {1, 0}};
  const std::vector<Geometry> places = random_geometries(200, 9, radians(40));
  const Model model = fit(simulate(material("ptfe-532"), std::array{0.532}, germer2017_grid()), right).model;
  std::vector<Sample> samples;
  for (const unsigned long seed : {1UL, 2UL, 3UL})
    std::ranges::move(simulate(model, std::array{0.532}, places, 0.01, seed), std::back_inserter(samples));
  for (const LackOfFit& test : lack_of_fit(samples, fit(samples, right))) {
    EXPECT_GT(test.p, 1e-3) << test.block;
    EXPECT_TRUE(test.block == "11" || std::abs(test.pure_error - 0.01) < 1e-3) << test.block;
  }
  const LackOfFit f11 = lack_of_fit(samples, fit(samples, low)).front();
  EXPECT_EQ(f11.repeats, 400);
  EXPECT_LT(f11.p, 1e-6);
  EXPECT_GT(f11.misfit, 1.2 * f11.pure_error);
}

// f11 is fitted divided by the reflectance, and so are the residuals that repeats are compared by.
TEST(LackOfFit, IsTheSameWhateverF11IsDividedBy) {
  const Basis basis{Family::isotropic, {2, 1}};
  std::vector<Sample> samples;
  for (const unsigned long seed : {1UL, 2UL})
    std::ranges::move(
        simulate(material("ptfe-532"), std::array{0.532}, random_geometries(200, 9, radians(40)), 0.01, seed),
        std::back_inserter(samples));
  FitOptions options;
  options.reflectance = ReflectanceTable{{0.532}, {1}};
  const LackOfFit one = lack_of_fit(samples, fit(samples, basis, options)).front();
  options.reflectance = ReflectanceTable{{0.532}, {0.25}};
  const LackOfFit other = lack_of_fit(samples, fit(samples, basis, options)).front();
  EXPECT_NEAR(other.f, one.f, 1e-9 * one.f);
  EXPECT_NEAR(other.pure_error, 4 * one.pure_error, 1e-9);
  EXPECT_NEAR(other.misfit, 4 * one.misfit, 1e-9);
}

TEST(LackOfFit, IsNotTestedByCopies) {
  std::vector<Sample> samples =
      simulate(material("ptfe-532"), std::array{0.532}, random_geometries(200, 9, radians(40)), 0.01, 1);
  samples.insert(samples.end(), samples.begin(), samples.begin() + 100);
  for (const LackOfFit& test : lack_of_fit(samples, fit(samples, Basis{Family::isotropic, {2, 1}}))) {
    EXPECT_GE(test.repeats, 100) << test.block;
    EXPECT_EQ(test.pure_error, 0);
    EXPECT_EQ(test.f, 0);
    EXPECT_EQ(test.p, 1);
  }
}

TEST(LackOfFit, IsNotTestedWithoutRepeats) {
  const std::vector<Sample> samples =
      simulate(material("ptfe-532"), std::array{0.532}, random_geometries(200, 9), 0.01, 1);
  for (const LackOfFit& test : lack_of_fit(samples, fit(samples))) {
    EXPECT_EQ(test.repeats, 0);
    EXPECT_EQ(test.p, 1);
  }
  EXPECT_THROW(lack_of_fit(samples, FitResult{}), std::invalid_argument);
}

}  // namespace mmbrdf
