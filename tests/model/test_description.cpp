// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/description.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"

namespace mmbrdf {
namespace {

TEST(Description, SaysWhatTheModesAre) {
  EXPECT_EQ(basis_line(material("ptfe")),
            "isotropic, orders 7,4, wavelength powers 0 to 1, lambert mapping: 142 modes, 284 coefficients");
  EXPECT_EQ(basis_line(diffuser({1})),
            "isotropic, orders 0,0, wavelength power 0, lambert mapping: 1 mode, 1 coefficient");
  EXPECT_EQ(basis_line(as_printed(random_model(Family::germer2017, {7, 4}, 0, 1))),
            "germer2017 as printed, orders 7,4, wavelength power 0, lambert mapping: 330 modes, 330 coefficients");
}

TEST(Description, SaysOfTheRangeWhatIsKnown) {
  const auto text = [](const Validity& range) { return angles_line(range) + "; " + fitted_range(range); };
  EXPECT_EQ(text({{0.351, 0.532}, radians(75), radians(81.8699)}),
            "theta_i <= 75, theta_r <= 81.87 degrees; theta_i <= 75, theta_r <= 81.87 degrees at 351, 532 nm");
  EXPECT_EQ(text({{0.6328}, {}, {}}), "not known; 632.8 nm");
  EXPECT_EQ(text({{}, {}, radians(60)}),
            "theta_i not known, theta_r <= 60 degrees; theta_i not known, theta_r <= 60 degrees");
  EXPECT_EQ(text({}), "not known; not known");
}

TEST(Description, SaysOfTheRangeWhatIsNot) {
  const auto missing = [](const Validity& range) {
    const std::string text = unknown_range_line("it", range);
    const std::size_t begin = std::string("it does not say to which ").size();
    return text.empty() ? text : text.substr(begin, text.find(" it was fitted") - begin);
  };
  EXPECT_EQ(missing({}), "wavelengths and angles");
  EXPECT_EQ(missing({{0.5}, radians(75), {}}), "angles");
  EXPECT_EQ(missing({{}, radians(75), radians(75)}), "wavelengths");
  EXPECT_EQ(missing({{0.5}, radians(75), radians(75)}), "");
}

TEST(Description, CountsWhatLeavesTheRange) {
  RangeCount one, all;
  EXPECT_EQ(all.line("row"), "");
  for (const Outside where : {inside, unknown_range, outside_theta_i}) one.add(where);
  all.add(one);
  EXPECT_EQ(all.line("row"), "1 of 3 rows lies outside the fitted range");
  all.add(static_cast<Outside>(outside_theta_i | outside_wavelength));
  EXPECT_EQ(all.line("row"), "2 of 4 rows lie outside the fitted range");
  EXPECT_EQ(
      outside_line(all.reasons, {{0.5}, radians(75), {}}),
      "outside the fitted range (theta_i+wavelength+unknown): fitted are theta_i <= 75, theta_r not known degrees "
      "at 500 nm");
}

// 300.6 / 1000 is not the double nearest to 0.3006, and neither is 0.3006 × 1000 that to 300.6.
TEST(Description, HasTheNanometresThatWereMeant) {
  EXPECT_EQ(nanometres(0.3006), 300.6);
  EXPECT_EQ(nanometres(300.6 / 1000), 300.6);
  EXPECT_EQ(nanometre_list(std::array{0.3006, 0.532}), "300.6, 532 nm");
}

TEST(Description, HasAllDigitsOfAReflectance) {
  EXPECT_EQ(reflectance_line({{0.3006, 0.532}, {1.0 / 3, 0.984}}), "300.6:0.3333333333333333,532:0.984");
  EXPECT_EQ(reflectance_line({}), "");
}

TEST(Description, CountsInWords) {
  EXPECT_EQ(counted(1, "mode"), "1 mode");
  EXPECT_EQ(counted(0, "mode"), "0 modes");
}

}  // namespace
}  // namespace mmbrdf
