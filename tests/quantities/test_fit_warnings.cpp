// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/fit_warnings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "given/cases.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

using Warnings = std::vector<std::string>;

constexpr double noise = 0.006;

/// The published measurement of ptfe-532, with speckle and its uncertainties, each sample then changed.
std::vector<Sample> measured(const std::function<void(Sample&)>& change = [](Sample&) {}) {
  std::vector<Sample> samples = simulate(material("ptfe-532"), std::array{0.532}, germer2017_grid(), noise, 1);
  for (Sample& s : samples) {
    const double u = noise * std::sqrt(std::cos(s.geometry.incident.theta) / std::cos(s.geometry.reflected.theta));
    s.uncertainty.elements.fill(u);
    s.uncertainty(0, 0) = u * s.f11;
    change(s);
  }
  return samples;
}

Warnings warnings_of(std::span<const Sample> samples, Weights weights = Weights::none) {
  return fit_warnings(fit(samples, {}, {}, weights));
}

/// The one warning that there is.
std::string warning_of(std::span<const Sample> samples, Weights weights = Weights::none) {
  const Warnings warnings = warnings_of(samples, weights);
  return warnings.size() == 1 ? warnings.front() : std::to_string(warnings.size()) + " warnings";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// δ of the sample is mirrored to the positive side.
void fold_azimuth(Sample& s) {
  const double delta = std::remainder(s.geometry.reflected.phi - s.geometry.incident.phi, 2 * std::numbers::pi);
  s.geometry.reflected.phi = s.geometry.incident.phi + std::abs(delta);
}

std::vector<Sample> scan_in_plane() {
  std::vector<Geometry> scan;
  for (int i = 0; i <= 75; i += 15)
    for (int r = -80; r <= 80; r += 5)
      if (r != -i) scan.push_back({{radians(i), 0}, {radians(std::abs(r)), r < 0 ? 0 : radians(180)}});
  return simulate(material("ptfe-532"), std::array{0.532}, scan, noise, 1);
}

}  // namespace

TEST(FitWarnings, AreNoneForGoodData) {
  EXPECT_EQ(warnings_of(measured()), Warnings{});
  EXPECT_EQ(warnings_of(measured(), Weights::data), Warnings{});
  EXPECT_EQ(warnings_of(simulate(material("ptfe"), material("ptfe").validity.wavelengths, germer2017_grid(), noise, 2)),
            Warnings{});
}

TEST(FitWarnings, NameACosineTooMany) {
  const std::vector<Sample> samples = measured([](Sample& s) { s.f11 *= std::cos(s.geometry.reflected.theta); });
  EXPECT_TRUE(std::ranges::any_of(fit_warnings(fit(samples), samples), [](const std::string& line) {
    return line.starts_with("cosine: a reciprocal f11 leaves ");
  }));
  const std::vector<Sample> fills = measured([](Sample& s) {
    s.f11 = -999;
    s.normalized.elements.fill(-999);
  });
  EXPECT_FALSE(fit_warnings(fit(samples), fills).empty());  // of which no fit is made
}

TEST(FitWarnings, NameTheScaleOfF11) {
  const std::string reaches = "the directional-hemispherical reflectance reaches ";
  const auto times = [](double factor) { return measured([=](Sample& s) { s.f11 *= factor; }); };
  EXPECT_TRUE(has(warning_of(times(100)), "is f11, or a reflectance that was given, in percent?"));
  EXPECT_TRUE(
      has(warning_of(times(std::numbers::pi)), "is f11 multiplied by pi, or are the matrices divided by their"));
  EXPECT_TRUE(has(warning_of(measured([](Sample& s) { s.f11 = 1; })), reaches + "3.1416"));  // a divided matrix
  EXPECT_TRUE(has(warning_of(times(1.05)), "more light comes back than falls in; is the scale of f11 right?"));
}

// 1.5 mm of a DHR of 0.985 is no reason to warn where it is not known to a percent.
TEST(FitWarnings, AllowAReflectanceAboveOneByItsUncertainty) {
  const Model model = material("ptfe-532");
  const double dhr = f11_diagnostics(model, 0.532, radians(80)).dhr;
  const auto scaled = [&](double reflectance, double speckle) {
    std::vector<Sample> samples = simulate(model, std::array{0.532}, random_geometries(300, 3), speckle, 4);
    for (Sample& s : samples) s.f11 *= reflectance / dhr;
    const FitResult result = fit(samples, {Family::isotropic, {4, 2}});
    return f11_diagnostics(result.model, 0.532, fitted_theta_max(result.model.validity));
  };
  for (const double speckle : {0.002, 0.05})
    for (const double reflectance : {0.99, 1.005, 1.1}) {
      const F11Diagnostics found = scaled(reflectance, speckle);
      EXPECT_EQ(energy_line(found, "here").empty(), found.dhr <= 1 + 5 * found.u_dhr) << reflectance << " " << speckle;
      EXPECT_EQ(found.u_dhr > 0, found.dhr > 1);
    }
  EXPECT_FALSE(energy_line(scaled(1.1, 0.002), "here").empty());
  EXPECT_TRUE(energy_line(scaled(0.97, 0.002), "here").empty());
}

// Half a diffuser under a lobe of 17 degrees, which orders of 7 miss: at grazing incidence fits to few samples may be above 1 by
// one or two u, and the sample is none the less honest.
TEST(FitWarnings, DoNotAskAShinySampleForAFactorOfPi) {
  const auto f11 = [](const Geometry& g) {
    const auto vector = [](const Direction& d) {
      return std::array{std::sin(d.theta) * std::cos(d.phi), std::sin(d.theta) * std::sin(d.phi), std::cos(d.theta)};
    };
    const auto i = vector(g.incident), r = vector(g.reflected);
    const double x = i[0] + r[0], y = i[1] + r[1], z = i[2] + r[2], slope = (x * x + y * y) / (z * z);
    return (0.5 + 0.3 * std::exp(-slope / 0.09) / (0.09 * std::pow(z, 4) / (x * x + y * y + z * z))) / std::numbers::pi;
  };
  double above = 0;  // the most, in u
  for (unsigned long seed = 1; seed <= 6; ++seed) {
    std::vector<Sample> samples =
        simulate(material("ptfe-532"), std::array{0.532}, random_geometries(100, seed), 0.01, seed);
    for (Sample& s : samples) {
      s.f11 *= f11(s.geometry) / prepare(material("ptfe-532"), 0.532).f11(s.geometry);
      s.normalized.elements.fill(std::numeric_limits<double>::quiet_NaN());
      s.normalized(0, 0) = 1;
    }
    FitOptions options;
    options.minimum_norm = true;
    const FitResult result = fit(samples, {}, options);
    const F11Diagnostics found = f11_diagnostics(result.model, 0.532, fitted_theta_max(result.model.validity));
    if (found.u_dhr > 0) above = std::max(above, (found.dhr - 1) / found.u_dhr);
    EXPECT_EQ(energy_line(found, "here"), "") << seed;
  }
  EXPECT_GT(above, 1);  // of the fit that comes nearest
}

TEST(FitWarnings, SayWhereF11IsNotPositive) {
  const std::string line = warning_of(measured([](Sample& s) { s.f11 -= 0.3; }));  // a dark reading, subtracted twice
  EXPECT_TRUE(line.starts_with("f11 is not positive at ")) << line;
  EXPECT_TRUE(has(line, " within the fitted angles at 532 nm, down to -")) << line;
}

TEST(FitWarnings, SetChiSquaredAgainstItsDegreesOfFreedom) {
  const auto too_small = measured([](Sample& s) { s.uncertainty = (1.0 / 3) * s.uncertainty; });
  EXPECT_TRUE(has(warning_of(too_small, Weights::data), "chi^2 per degree of freedom is "));
  EXPECT_EQ(warnings_of(too_small), Warnings{});     // without weights chi^2 has no scale
  const auto other_sense = measured([](Sample& s) {  // a retarder of the receiver turned the other way
    for (int column = 0; column < 4; ++column) s.normalized(2, column) *= -1;
  });
  const std::string line = warning_of(other_sense, Weights::data);
  EXPECT_TRUE(has(line, "most in block 22,23,32,33 (")) << line;
  EXPECT_TRUE(has(line, "a dial that turns the other way, exchanged arms")) << line;
}

TEST(FitWarnings, SayThatAScanIsOfOnePlane) {
  const std::vector<Sample> scan = scan_in_plane();
  const std::string refusal = message_of([&] { fit(scan); });
  EXPECT_EQ(
      refusal.find("measured in one plane only, that of incidence: the data do not determine the model; block 11: "
                   "rank 20 of 40; block "),
      0u)
      << refusal;
  EXPECT_TRUE(has(
      refusal,
      "; ask for the solution of minimum norm, which holds in that plane, or choose lower orders (up to 1,0 they do)"))
      << refusal;
  EXPECT_NO_THROW(fit(scan, {Family::isotropic, {1, 0}}));
  FitOptions options;
  options.minimum_norm = true;
  EXPECT_TRUE(has(fit_warnings(fit(scan, {}, options)).front(), "measured in one plane only"));
}

// Where the data lie apart from each other, what is said to be determined is, and one order more is not.
TEST(FitWarnings, SayWhichOrdersTheDataDetermine) {
  const std::vector<Sample> few = simulate(material("ptfe-532"), std::array{0.532}, random_geometries(25, 3), noise, 1);
  const std::string refusal = message_of([&] { fit(few); });
  const std::size_t at = refusal.find("(up to ");
  ASSERT_NE(at, std::string::npos) << refusal;
  const Orders orders{refusal[at + 7] - '0', refusal[at + 9] - '0'};
  EXPECT_LT(orders.f11, 7);
  EXPECT_NO_THROW(fit(few, {Family::isotropic, orders}));
  EXPECT_NE(message_of([&] { fit(few, {Family::isotropic, {orders.f11 + 1, orders.other}}); }), "nothing was thrown");
}

TEST(FitWarnings, SayThatAllAzimuthsLieOnOneSide) {
  std::vector<Sample> half = measured();
  std::erase_if(half, [](const Sample& s) { return side(s.geometry) == negative_side; });
  const std::string one_side = warning_of(half);
  EXPECT_TRUE(one_side.starts_with("all samples lie on one side of the plane of incidence (phi_r - phi_i 0 to 180"));
  EXPECT_FALSE(has(one_side, "folded"));
  EXPECT_TRUE(has(warning_of(measured(fold_azimuth)), "were azimuths of the other side folded onto it?"));
}

TEST(FitWarnings, OfSamplesThatWereMergedAreThoseOfAll) {
  const std::vector<Sample> all = measured();
  std::vector<FitAccumulator> sides(2, FitAccumulator(Basis{}));
  for (const Sample& s : all) sides[side(s.geometry) == negative_side].add(std::span(&s, 1));
  EXPECT_FALSE(data_warnings(sides[0].solve()).empty());
  sides[0].merge(FitAccumulator::from_state(Basis{}, sides[1].state()));
  EXPECT_EQ(data_warnings(sides[0].solve()), Warnings{});
}

TEST(FitWarnings, NameBlocksOfLargeCondition) {
  std::vector<Sample> samples = simulate(material("ptfe"), std::array{0.532, 0.5321}, germer2017_grid(), noise, 1);
  const std::string line = warning_of(samples);  // a slope over a tenth of a nanometre
  EXPECT_TRUE(has(line, "the condition is large in block 11 (")) << line;
}

}  // namespace mmbrdf
