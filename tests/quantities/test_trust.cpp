// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/trust.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>

#include "given/published.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"

namespace mmbrdf {
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
  EXPECT_EQ((all.margin.value < 0), (unrealizable > 0)) << model.name;
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
  const std::map<std::string, int> expected{{"ptfe-351", 0}, {"ptfe-532", 0}, {"ptfe-633", 2}, {"ptfe-1064", 7}};
  for (const auto& [name, negative] : expected)
    expect_realizable_up_to_85(material(name), only_wavelength(material(name)), negative);
}

TEST(ModelDiagnostics, SayWhereTheWorstPlacesAre) {
  const Model model = material("ptfe-1064");
  const ModelDiagnostics found = model_diagnostics(model, 1.064);
  const PreparedModel prepared = prepare(model, 1.064);
  EXPECT_NEAR(realizability_margin(normalized(prepared.evaluate(found.margin.geometry))), found.margin.value, 1e-14);
  EXPECT_EQ(prepared.f11(found.f11.geometry), found.f11.value);
  const auto dhr = [&](double theta) { return directional_hemispherical_reflectance(model, 1.064, {theta, 0}); };
  EXPECT_EQ(found.dhr, dhr(found.dhr_theta_i));
  for (int step = 0; step <= 36; ++step) {
    const Direction at{radians(2.5 * step), 0};
    EXPECT_LE(found.f11.value, prepared.f11({at, at}));
    EXPECT_GE(found.dhr, dhr(at.theta));
  }
  EXPECT_THROW(model_diagnostics(model, 1.064, radians(91)), std::invalid_argument);
  EXPECT_EQ(model_diagnostics(model, 1.064, 0).geometries, 25);
}

// It rises with the angle up to 60 degrees, so that the largest of each of these ranges is at its end.
TEST(F11Diagnostics, OfARisingReflectanceFindTheEndOfTheRange) {
  for (const double theta_max : {20., 40., 55.}) {
    const F11Diagnostics found = f11_diagnostics(material("ptfe-351"), 0.351, radians(theta_max));
    EXPECT_NEAR(degrees(found.dhr_theta_i), theta_max, 1e-12);  // rounding of radians
  }
}

}  // namespace mmbrdf
