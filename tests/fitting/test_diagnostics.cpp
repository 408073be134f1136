// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/leverage.hpp"
#include "mmbrdf/fitting/symmetry.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/samples/mirror_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "given/cases.hpp"
#include "given/published.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

constexpr std::array one_wavelength{0.5};
constexpr Orders small_orders{4, 3};

std::vector<Sample> exact(int count = 300, std::span<const double> wavelengths = one_wavelength) {
  return simulate(random_model(Family::isotropic, small_orders, 0, 5), wavelengths, random_geometries(count, 3));
}

/// Independent normal errors of one size.
std::vector<Sample> noisy(std::vector<Sample> samples, double deviation, unsigned long seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0, deviation);
  for (Sample& sample : samples) {
    sample.f11 += normal(engine);
    for (std::size_t e = 1; e < 16; ++e) sample.normalized.elements[e] += normal(engine);
  }
  return samples;
}

const FTest& of_block(const std::vector<FTest>& tests, const std::string& block) {
  const auto at = std::find_if(tests.begin(), tests.end(), [&](const FTest& one) { return one.block == block; });
  if (at == tests.end()) throw std::logic_error("no block " + block);
  return *at;
}

/// Something that breaks a symmetry, added to a sample.
using Change = std::function<void(Sample&)>;

std::vector<Sample> changed(std::vector<Sample> samples, const Change& change) {
  std::for_each(samples.begin(), samples.end(), change);
  return samples;
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

TEST(MirrorPairs, DifferByTheNoiseAlone) {
  const std::vector<Sample> samples =
      simulate(random_model(Family::isotropic, small_orders, 0, 5), std::array{0.4, 0.7}, germer2017_grid());
  const MirrorPairs pairs = mirror_pairs(samples);
  EXPECT_EQ(pairs.pairs, 2 * 715);
  for (std::size_t e = 0; e < 16; ++e) EXPECT_LT(pairs.rms.elements[e], 1e-13) << e;  // rounding
  const MirrorPairs with_noise = mirror_pairs(noisy(samples, 0.01, 1));
  for (std::size_t e = 1; e < 16; ++e) {
    EXPECT_NEAR(with_noise.rms.elements[e], 0.01, 4 * 0.01 / std::sqrt(2. * 1430)) << e;
    EXPECT_NEAR(with_noise.mean.elements[e], 0, 4 * 0.01 / std::sqrt(2. * 1430)) << e;
  }
  const MirrorPairs handed = mirror_pairs(changed(samples, [](Sample& x) { x.normalized(3, 1) += 0.01; }));
  EXPECT_NEAR(handed.mean(3, 1), 0.01, 1e-12);
  EXPECT_NEAR(handed.rms(3, 1), 0.01 * std::numbers::sqrt2, 1e-12);
  EXPECT_EQ(mirror_pairs(exact()).pairs, 0);
}

// φ = π and −π is one azimuth, and pairs are found in whatever order they stand.
TEST(MirrorPairs, AreFoundAtTheEndOfTheCircleAndInAnyOrder) {
  std::vector<Sample> samples;
  for (int i = 0; i < 201; ++i)
    samples.push_back({0.5, {{0.6, radians(180)}, {0.7, radians(180 + 40 + 0.005 * i)}}, 1, identity()});
  for (int i = 200; i >= 0; --i)
    samples.push_back({0.5, {{0.6, radians(-180)}, {0.7, radians(-180 - 40 - 0.005 * i)}}, 1, identity()});
  EXPECT_EQ(mirror_pairs(samples).pairs, 201);
}

TEST(SampleDiagnostics, HaveLeveragesThatAddUpToTheRank) {
  const std::array two{0.4, 0.7};
  const std::vector<Sample> samples = noisy(exact(200, two), 0.01, 1);
  std::vector<Mueller> weights(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s)
    for (std::size_t e = 0; e < 16; ++e) weights[s].elements[e] = static_cast<double>((s + 3 * e) % 5);  // also 0
  for (const auto& [family, rotation] : {std::pair(Family::isotropic, Rotation::covariant),
                                         {Family::germer2017, Rotation::covariant},
                                         {Family::germer2017, Rotation::as_printed}}) {
    FitAccumulator all({family, small_orders, DiscMapping::lambert, rotation});
    all.add(samples, weights);
    const SampleDiagnostics found = sample_diagnostics(samples, all.solve(), weights);
    ASSERT_EQ(found.leverage.size(), family == Family::isotropic ? 6U : 10U);
    for (const auto& block : found.leverage) {
      const double sum = std::accumulate(block.values.begin(), block.values.end(), 0.0);
      EXPECT_NEAR(sum, block.rank, 1e-8) << block.block;  // condition numbers squared, times rounding
      EXPECT_EQ(block.values[block.largest], *std::max_element(block.values.begin(), block.values.end()));
    }
  }
  EXPECT_THROW(sample_diagnostics(std::span(samples).first(10), fit(samples)), std::invalid_argument);
}

TEST(SampleDiagnostics, HaveResidualsOfVarianceOneAndFindTheOneThatIsOff) {
  std::vector<Sample> samples = noisy(exact(400), 0.01, 2);
  samples[123].normalized(1, 3) += 0.2;
  samples[17].f11 -= 0.1;
  const SampleDiagnostics found = sample_diagnostics(samples, fit(samples, {Family::isotropic, small_orders}));
  const std::vector<Outlier> off = outliers(found);
  ASSERT_EQ(off.size(), 2U);
  EXPECT_EQ(off[0].sample, 123U);
  EXPECT_EQ(off[0].element, 7U);
  EXPECT_GT(off[0].studentized, 15);  // 20, less what it adds to s
  EXPECT_EQ(off[1].sample, 17U);
  EXPECT_EQ(off[1].element, 0U);
  EXPECT_LT(off[1].studentized, -8);
  double squares = 0;
  for (const Mueller& m : found.studentized)
    for (const double t : m.elements) squares += t * t;
  EXPECT_NEAR(squares / (400 * 16), 1, 4 * std::sqrt(2 / 6400.0));
  EXPECT_TRUE(outliers(found, 30).empty());
  EXPECT_THROW(outliers(found, -1), std::invalid_argument);
}

namespace {

std::vector<Sample> grid_at(double wavelength) {
  return at_wavelengths(read_samples(published("PTFE.data.csv")), std::array{wavelength});
}

}  // namespace

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

// Theory 3.1.
TEST(PublishedData, DifferFromTheirMirrorImagesByTheNoiseAndIn42ByMore) {
  if (published("PTFE.data.csv").empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  const std::map<double, double> f11{{0.351, 0.009}, {0.532, 0.011}, {0.633, 0.012}, {1.064, 0.018}};
  for (const auto& [wavelength, rms] : f11) {
    const MirrorPairs pairs = mirror_pairs(grid_at(wavelength));
    EXPECT_EQ(pairs.pairs, 715);
    EXPECT_NEAR(pairs.rms(0, 0), rms, 0.5e-3) << wavelength;
  }
  const MirrorPairs pairs = mirror_pairs(grid_at(0.532));
  EXPECT_NEAR(pairs.rms(3, 1), 0.0153, 0.5e-4);
  EXPECT_NEAR(pairs.mean(3, 1), 0.0054, 0.5e-4);
  for (const auto& [row, column] : {std::pair{1, 2}, {1, 3}, {2, 3}})
    EXPECT_NEAR(pairs.rms(row, column), 0.011, 0.5e-3) << row << column;
}

namespace {

struct Expected {
  double wavelength;
  const char* file;
  std::array<double, 5> smallest;  // up to 45, 60, 75, 80, 85 degrees
  int negative_single, negative_multiple;
};

// Theory 6.2.
constexpr std::array expected_of_models{
    Expected{0.351, "PTFE.351.coeff.csv", {0.233, 0.204, 0.140, 0.106, 0.063}, 0, 0},
    Expected{0.532, "PTFE.532.coeff.csv", {0.230, 0.196, 0.120, 0.082, 0.035}, 7, 2},
    Expected{0.633, "PTFE.633.coeff.csv", {0.228, 0.197, 0.120, 0.082, 0.036}, 7, 5},
    Expected{1.064, "PTFE.1064.coeff.csv", {0.220, 0.195, 0.121, 0.079, 0.025}, 24, 27}};

void expect_realizable_up_to_85(const Model& model, double wavelength, int unrealizable) {
  EXPECT_EQ(model_diagnostics(model, wavelength, radians(85)).geometries, 30625);
  EXPECT_EQ(model_diagnostics(model, wavelength, radians(85)).unrealizable, 0) << model.name;
  const ModelDiagnostics all = model_diagnostics(model, wavelength);
  EXPECT_EQ(all.geometries, 34225);
  EXPECT_EQ(all.unrealizable, unrealizable) << model.name;
  EXPECT_EQ(all.margin.value<0, unrealizable> 0) << model.name;
}

}  // namespace

TEST(PublishedModels, AreRealizableUpTo85DegreesAndNotEverywhereBeyond) {
  for (const Expected& expected : expected_of_models) {
    const std::string path = published(expected.file);
    if (path.empty()) GTEST_SKIP() << absent(expected.file);
    const Model model = load_model(path);
    std::size_t place = 0;
    for (const double limit : {45, 60, 75, 80, 85})
      EXPECT_NEAR(model_diagnostics(model, expected.wavelength, radians(limit)).margin.value,
                  expected.smallest[place++], 0.5e-3)
          << expected.file << " up to " << limit << " degrees";
    expect_realizable_up_to_85(model, expected.wavelength, expected.negative_single);
    EXPECT_EQ(model_diagnostics(model, expected.wavelength).not_positive_f11 > 0, expected.wavelength == 1.064);
  }
}

TEST(PublishedModels, OfAllWavelengthsAreRealizableUpTo85DegreesToo) {
  const std::string path = published("PTFE.coeff.csv");
  if (path.empty()) GTEST_SKIP() << absent("PTFE.coeff.csv");
  const Model model = load_model(path);
  for (const Expected& expected : expected_of_models)
    expect_realizable_up_to_85(model, expected.wavelength, expected.negative_multiple);
}

// Theory 6.2.
TEST(BuiltInModels, AreRealizableButForAFewGrazingGeometries) {
  const std::map<std::string, int> expected{{"ptfe-351", 0}, {"ptfe-532", 0}, {"ptfe-633", 1}, {"ptfe-1064", 3}};
  for (const auto& [name, negative] : expected)
    expect_realizable_up_to_85(material(name), only_wavelength(material(name)), negative);
}

TEST(ModelDiagnostics, SayWhereTheWorstPlacesAre) {
  const Model model = material("ptfe-1064");
  const ModelDiagnostics found = model_diagnostics(model, 1.064);
  const PreparedModel prepared = prepare(model, 1.064);
  EXPECT_NEAR(realizability_margin(normalized(prepared.evaluate(found.margin.geometry))), found.margin.value, 1e-14);
  EXPECT_EQ(prepared.f11(found.f11.geometry), found.f11.value);
  EXPECT_LT(found.f11.value, -0.32);  // theory 6.2: −0.330 at 90/90 degrees, retro-reflection
  EXPECT_EQ(found.f11.geometry.incident.theta, radians(90));
  EXPECT_EQ(found.f11.geometry.reflected, (Direction{radians(90), 0}));
  EXPECT_NEAR(found.dhr, 0.9869, 1e-4);
  EXPECT_NEAR(degrees(found.dhr_theta_i), 58, 0.51);
  EXPECT_THROW(model_diagnostics(model, 1.064, radians(91)), std::invalid_argument);
  EXPECT_EQ(model_diagnostics(model, 1.064, 0).geometries, 25);
}

}  // namespace mmbrdf
