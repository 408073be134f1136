// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "basis/rows.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "mmbrdf/uncertainty/draws.hpp"

namespace mmbrdf {
namespace {

/// A few samples of a noisy diffuser at one to three wavelengths, in any directions or hardly apart.
std::vector<Sample> few_samples(std::mt19937_64& engine) {
  std::uniform_real_distribution<double> part;
  std::normal_distribution<double> noise(0, 0.02);
  const int wavelengths = 1 + static_cast<int>(engine() % 3), rows = 2 + static_cast<int>(engine() % 10);
  const bool apart = engine() % 2;
  const auto near = [&](double angle) { return angle + radians(static_cast<double>(engine() % 4)); };
  const double theta_i = part(engine), theta_r = part(engine), phi_r = 6 * part(engine);
  std::vector<Sample> samples;
  for (int w = 0; w < wavelengths; ++w)
    for (int r = 0; r < rows; ++r) {
      Sample sample{};
      sample.wavelength = 0.4 + 0.2 * w;
      sample.geometry = apart ? Geometry{{1.4 * part(engine), 0}, {1.4 * part(engine), 6 * part(engine)}}
                              : Geometry{{near(theta_i), 0}, {near(theta_r), near(phi_r)}};
      sample.f11 = 0.3 * (1 + noise(engine));
      for (double& element : sample.normalized.elements) element = noise(engine);
      sample.normalized(0, 0) = 1;
      samples.push_back(sample);
    }
  return samples;
}

FitResult fitted(std::span<const Sample> samples, const Basis& basis, Covariance covariance) {
  FitOptions options;
  options.minimum_norm = true;
  options.covariance = covariance;
  return fit(samples, basis, options);
}

std::vector<Sample> turned_about_the_normal(std::vector<Sample> samples, double angle) {
  for (Sample& sample : samples) {
    sample.geometry.incident.phi += angle;
    sample.geometry.reflected.phi += angle;
    sample.normalized = turned(sample.normalized, angle);
  }
  return samples;
}

}  // namespace

// Of 378 such data sets 3 of several wavelengths with the residuals, and 20 with the sandwich, failed when covariances
// were not formed as products S Sᵀ.
TEST(FitCovariance, CanBeSavedAndUsedHoweverLittleTheDataDetermine) {
  for (unsigned seed = 1; seed <= 250; ++seed) {
    std::mt19937_64 engine(seed);
    const std::vector<Sample> samples = few_samples(engine);
    const int order = static_cast<int>(engine() % 4);
    for (const Covariance covariance : {Covariance::residuals, Covariance::sandwich}) {
      Model model;
      try {
        model = fitted(samples, {Family::isotropic, {order, order}}, covariance).model;
      } catch (const std::invalid_argument&) {
        continue;  // the reflectance of a wavelength may come out negative
      }
      EXPECT_NO_THROW(require_semidefinite(model_from_json(to_json(model), "model"))) << seed;
    }
  }
}

// White's, with n / (n − p): a diffuser, so that p = 1, with two directions of other residuals.
TEST(FitCovariance, RowByRowCountsTheCoefficientsThatWereFitted) {
  const std::vector<Sample> samples = turned_about_the_normal(
      simulate(random_model(Family::isotropic, {3, 2}, 0, 1), std::array{0.5}, random_geometries(12, 5), 0.01, 3), 0.2);
  const FitResult found = fitted(samples, {Family::isotropic, {2, 0}}, Covariance::sandwich);
  const std::vector<double>& inverse = found.solutions[0].inverse;
  const auto p = found.solutions[0].x.size(), n = samples.size();
  const Rows rows(found.model.blocks[0].block.modes, Family::isotropic);
  std::vector<double> expected(p * p);
  for (std::size_t s = 0; s < n; ++s) {
    const auto& [i, r] = samples[s].geometry;
    std::vector<double> x(p), gx(p);
    rows.add(0, functions_at(i, 2, DiscMapping::lambert), functions_at(r, 2, DiscMapping::lambert), x.data());
    for (std::size_t a = 0; a < p; ++a)
      for (std::size_t b = 0; b < p; ++b) gx[a] += inverse[a * p + b] * x[b];
    const double squared = std::pow(found.residuals[s](0, 0), 2) * static_cast<double>(n) / static_cast<double>(n - p);
    for (std::size_t a = 0; a < p; ++a)
      for (std::size_t b = 0; b < p; ++b) expected[a * p + b] += squared * gx[a] * gx[b];
  }
  for (std::size_t i = 0; i < p * p; ++i)
    EXPECT_NEAR(found.model.blocks[0].covariance[i], expected[i], 1e-9 * expected[0]);
}

// Rows x all alike, with residuals r: (n / (n − 1)) Σ r² / (n xᵀx)² × x xᵀ, and so is s² (XᵀX)⁺.
TEST(FitCovariance, OfSamplesOfOneGeometryIsTheSameFromTheResidualsRowByRowAndTogether) {
  const Model model = random_model(Family::isotropic, {3, 2}, 0, 1);
  for (const int count : {2, 3, 24}) {
    const std::vector<Geometry> geometries(static_cast<std::size_t>(count), in_degrees(30, 0, 40, 130));
    const std::vector<Sample> samples = simulate(model, std::array{0.5}, geometries, 0.01, 3);
    const auto f11 = [&](Covariance covariance) {
      return fitted(samples, {Family::isotropic, {3, 2}}, covariance).model.blocks.front().covariance;
    };
    const std::vector<double> together = f11(Covariance::residuals), row_by_row = f11(Covariance::sandwich);
    ASSERT_FALSE(together.empty());
    for (std::size_t i = 0; i < together.size(); ++i)
      EXPECT_NEAR(row_by_row[i], together[i], 1e-12 * together[0]) << count;
  }
}

// The sandwich takes errors of different elements as independent: in the frame that the basis has, xy or, of samples that
// are turned to phi_i = 0, the one that turns with the sample.
TEST(FitCovariance, IsTheSameOfASampleThatIsTurnedAboutItsNormal) {
  const std::vector<Sample> samples =
      simulate(random_model(Family::isotropic, {3, 2}, 0, 2), std::array{0.5}, random_geometries(150, 5), 0.05, 6);
  const std::vector<Sample> elsewhere = turned_about_the_normal(samples, 0.7);
  for (const Family family : {Family::isotropic, Family::germer2017})
    for (const Covariance covariance : {Covariance::residuals, Covariance::sandwich}) {
      if (family == Family::isotropic && covariance == Covariance::sandwich) continue;
      const Model a = fitted(samples, {family, {3, 2}}, covariance).model,
                  b = fitted(elsewhere, {family, {3, 2}}, covariance).model;
      for (std::size_t block = 0; block < a.blocks.size(); ++block) {
        const std::vector<double>&v = a.blocks[block].covariance, &w = b.blocks[block].covariance;
        const double size = *std::ranges::max_element(v);
        for (std::size_t i = 0; i < v.size(); ++i)
          EXPECT_NEAR(v[i], w[i], 1e-9 * size) << to_string(family) << ' ' << to_string(covariance);
      }
    }
}

}  // namespace mmbrdf
