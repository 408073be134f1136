// SPDX-License-Identifier: BSD-3-Clause
// What all tables for other programs say: where the model is extrapolated, what helps.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "given/foreign.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/formats/export.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/text/units.hpp"

namespace mmbrdf {
namespace {

/// Fitted in the plane of incidence at 500 and 600 nm, where samples support no other pairs.
Model fitted_in_plane() {
  Model model = diffuser({0.3, 0.1});
  model.validity = {{0.5, 0.6}, radians(60), radians(70), {{0.5, DirectionPairs(DirectionPairs::Grid::isotropic)}}};
  for (int i = 0; i <= 60; i += 5)
    for (int r = 0; r <= 70; r += 5)
      for (const double phi : {0.0, 180.0}) model.validity.supported[0].pairs.add(in_degrees(i, 0, r, phi));
  return model;
}

TEST(ExportNote, SaysHowManyDirectionsNoSamplesSupport) {
  const Model model = fitted_in_plane();
  const std::string text = Export(model, export_format("astm")).understood();
  EXPECT_TRUE(says(text, {"beyond its fitted range, theta_i <= 60, theta_r <= 70 degrees at 500, 600 nm"}));
  EXPECT_NE(text.find("; " + unsupported_line(model.validity, 0.5)), std::string::npos) << text;
  EXPECT_TRUE(says(text, {"; no samples support 8", " % of the pairs of directions within the fitted angles"}));
  Model all = model;
  all.validity.supported.clear();
  EXPECT_EQ(Export(all, export_format("astm")).understood().find("no samples"), std::string::npos);
}

TEST(ExportNote, SaysWhichWavelengthsWereNotFitted) {
  Model model = fitted_in_plane();
  const auto text = [&](std::vector<double> wavelengths) {
    return Export(model, export_format("astm"), {.wavelengths = std::move(wavelengths)}).understood();
  };
  EXPECT_TRUE(says(text({0.1}), {"; 100 nm lies beyond the fitted wavelengths"}));
  EXPECT_TRUE(says(text({0.1, 0.5, 0.55, 0.7}),
                   {"; 100 and 700 nm lie beyond the fitted wavelengths; 550 nm lies between fitted wavelengths"}));
  EXPECT_EQ(text({0.5, 0.6}).find(" lie"), std::string::npos);
  model.validity = {};  // nothing is known of it
  EXPECT_EQ(text({0.1}).find(" lie"), std::string::npos);
}

TEST(ExportError, IsThatWhereTheModelWasFittedHoweverLittleThatIs) {
  Model model = fitted_in_plane();
  const auto compared = [&](double theta_i) {
    model.validity.theta_i_max = radians(theta_i);
    return degrees(Export(model, export_format("astm")).error().theta_max);
  };
  EXPECT_NEAR(compared(60), 60, 1e-9);
  EXPECT_NEAR(compared(3), 3, 1e-9);
  EXPECT_NEAR(compared(0), 30, 1e-9);  // along the normal there would be nothing to compare
}

TEST(ExportRefusal, SaysWhatHelpsAgainstAnAzimuthOfTheSource) {
  EXPECT_TRUE(says(export_refusal(random_model(Family::anisotropic, {2, 1}, 0, 1), "astm", {.wavelengths = {0.5}}),
                   {"an ASTM file is of an isotropic sample", "fit it anew with `--basis isotropic`"}));
  Model printed = random_model(Family::germer2017, {2, 1}, 0, 1);
  printed.rotation = Rotation::as_printed;
  EXPECT_TRUE(says(export_refusal(printed, "astm", {.wavelengths = {0.5}}), {"`convert --basis isotropic` makes one"}));
}

}  // namespace
}  // namespace mmbrdf
