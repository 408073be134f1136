// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/materials.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "given/published.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf {
namespace {

TEST(Materials, ArePtfeAtAllWavelengthsAndAtEach) {
  EXPECT_EQ(materials(), (std::vector<std::string>{"ptfe", "ptfe-351", "ptfe-532", "ptfe-633", "ptfe-1064"}));
}

TEST(Materials, AreIsotropicAndSayWhereTheyAreFrom) {
  for (const std::string& name : materials()) {
    const Model model = material(name);
    EXPECT_EQ(model.name, name);
    EXPECT_EQ(model.family, Family::isotropic);
    EXPECT_EQ(coefficient_count(model), name == "ptfe" ? 284 : 142);
    EXPECT_EQ(model.validity.wavelengths.size(), name == "ptfe" ? 4U : 1U);
    std::string provenance;
    for (const auto& [key, text] : model.provenance) provenance += key + ": " + text + "\n";
    EXPECT_NE(provenance.find("10.6084/m9.figshare.5417410"), std::string::npos) << name << "\n" << provenance;
    EXPECT_NE(provenance.find("CC BY 4.0"), std::string::npos) << name << "\n" << provenance;
    EXPECT_NE(provenance.find("mmbrdf fit"), std::string::npos) << name << "\n" << provenance;
  }
}

// Sintered PTFE is nearly Lambertian and reflects nearly all: f11 at 45 degrees in, normal out, is close to 1/π.
TEST(Materials, ReflectAsPtfeDoes) {
  for (const std::string& name : materials()) {
    const Model model = material(name);
    const Geometry geometry{{radians(45), 0}, {0, 0}};
    for (const double wavelength : model.validity.wavelengths) {
      const PreparedModel prepared = prepare(model, wavelength);
      EXPECT_NEAR(prepared.f11(geometry) * std::numbers::pi, 1, 0.05) << name << " at " << wavelength;
      EXPECT_EQ(prepared.outside(geometry), inside);
    }
  }
}

TEST(Materials, OfOtherNamesAreRefusedWithTheNamesThereAre) {
  try {
    material("spectralon");
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "material 'spectralon' is not one of ptfe, ptfe-351, ptfe-532, ptfe-633, ptfe-1064");
  }
}

// What `./dev materials` does. Another compiler or processor may round otherwise: 1e-11 is a thousand times that, for
// coefficients of order 1 and a condition of 1e3.
TEST(Materials, AreTheFitsOfThePublishedDataThatTheyClaimToBe) {
  if (published("PTFE.data.csv").empty()) GTEST_SKIP() << absent("PTFE.data.csv");
  const std::vector<Sample> samples = read_samples(published("PTFE.data.csv"));
  for (const std::string& name : materials()) {
    const Model there = material(name), refitted = fit(at_wavelengths(samples, there.validity.wavelengths)).model;
    EXPECT_EQ(there.validity.wavelengths, refitted.validity.wavelengths);
    ASSERT_EQ(there.blocks.size(), refitted.blocks.size());
    for (std::size_t b = 0; b < there.blocks.size(); ++b) {
      const FittedBlock &ours = there.blocks[b], &theirs = refitted.blocks[b];
      EXPECT_EQ(ours.block.modes, theirs.block.modes);
      for (std::size_t i = 0; i < ours.coefficients.size(); ++i)
        EXPECT_NEAR(ours.coefficients[i], theirs.coefficients[i], 1e-11) << name;
      ASSERT_EQ(ours.covariance.size(), theirs.covariance.size());
      for (std::size_t i = 0; i < ours.covariance.size(); ++i)
        EXPECT_NEAR(ours.covariance[i], theirs.covariance[i], 1e-9 * ours.covariance[0]) << name;
    }
  }
}

}  // namespace
}  // namespace mmbrdf
