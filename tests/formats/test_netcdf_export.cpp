// SPDX-License-Identifier: BSD-3-Clause
// NetCDF that is written, read by the project's own reader; tests/python/test_transfer.py reads it as the field does.
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <sstream>
#include <string>

#include "given/foreign.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {
namespace {

#ifndef MMBRDF_NETCDF
TEST(NetcdfExport, IsRefusedByABuildWithoutIt) {
  for (const std::string format : {"netcdf", "mqdiffuse"})
    EXPECT_TRUE(says(export_refusal(material("ptfe-532"), format, {.error = 1}), {"has no NetCDF"}));
}
#else

Export made(const Model& model, const std::string& format, const ExportOptions& options, const std::string& path) {
  Export result(model, export_format(format), options);
  std::ostringstream out;
  result.write(out);
  put(path, out.str());
  return result;
}

TEST(NetcdfExport, IsReadBackAsTheModelWithItsUncertainty) {
  const Folder folder;
  const Model model = material("ptfe");
  const Export table = made(model, "netcdf", {.wavelengths = {0.532}, .error = 1}, folder / "x.nc");
  EXPECT_TRUE(says(table.understood(), {"at 532 nm", "in steps of 10", "with standard uncertainties", "frame sp"}));
  const ForeignRead read = read_foreign_file(folder / "x.nc");
  EXPECT_EQ(read.samples.size(), 9U * 9 * 37);  // those at 90 degrees are passed over
  const PreparedModel prepared = prepare(model, 0.532);
  for (const Sample& s : read.samples) {
    const Mueller expected = prepared.evaluate(s.geometry);
    for (std::size_t e = 0; e < 16; ++e)
      ASSERT_NEAR(s.normalized.elements[e] * s.f11, e == 0 ? s.f11 : expected.elements[e], 1e-14);
    ASSERT_NEAR(s.f11, expected(0, 0), 1e-14);
  }
  const PreparedUncertainty u = prepare_uncertainty(model, 0.532);
  for (const Sample& s : std::span(read.samples).subspan((4 * 9 + 6) * 37, 37))  // all around, at 40 and 60 degrees
    EXPECT_NEAR(s.uncertainty(0, 0), u.standard_uncertainty(s.geometry)(0, 0), 1e-12) << s.geometry.reflected.phi;
}

TEST(NetcdfExport, HasTheUncertaintyOfBothSidesOfAHandedModel) {
  const Folder folder;
  Model model = handed();
  model.blocks[0].covariance = model.blocks[2].covariance = {1e-20};  // f11 is as good as exact
  made(model, "netcdf", {.wavelengths = {0.5}, .error = 1}, folder / "x.nc");
  const PreparedUncertainty prepared = prepare_uncertainty(model, 0.5);
  long compared = 0;
  for (const Sample& s : read_foreign_file(folder / "x.nc").samples) {
    if (s.geometry.incident.theta < 0.5 || s.geometry.reflected.theta < 0.5) continue;
    const Mueller expected = prepared.standard_uncertainty(s.geometry);
    // The first row has no turned axes; what is read is u of f12 / f11.
    ASSERT_NEAR(s.uncertainty(0, 1) * s.f11, expected(0, 1), 1e-12) << s.geometry.reflected.phi;
    Geometry mirrored = s.geometry;
    mirrored.reflected.phi = -mirrored.reflected.phi;
    compared += std::abs(prepared.standard_uncertainty(mirrored)(0, 1) / expected(0, 1) - 1) > 0.1;
  }
  EXPECT_GT(compared, 100);
}

TEST(NetcdfExport, LeavesUnknownWhatWasNotMeasured) {
  const Folder folder;
  Model model = random_model(Family::isotropic, {3, 2}, 0, 1);
  std::erase_if(model.blocks, [](const FittedBlock& fitted) { return fitted.block.name.ends_with("34,42,43"); });
  for (const int index : {7, 11, 13, 14}) model.not_measured.set(static_cast<std::size_t>(index));
  const Export table = made(model, "netcdf", {.wavelengths = {0.5}, .error = 1}, folder / "x.nc");
  EXPECT_TRUE(says(table.understood(), {", with flags of what is extrapolated, without uncertainties, which",
                                        "not measured: 24, 34, 42 and 43"}));
  for (const Sample& s : read_foreign_file(folder / "x.nc").samples)
    ASSERT_EQ(not_measured(s), unknown_elements(model, Frame::sp));
}

TEST(NetcdfExport, SaysAtHowManyNodesF11IsNegative) {
  const auto text = [](const Model& model) {
    return Export(model, export_format("netcdf"), {.wavelengths = {0.5, 0.6}, .error = 1}).understood();
  };
  // In steps of 10 degrees, at one of two wavelengths: 0.55 − λ.
  const std::string nodes = std::to_string(10 * 10 * 37), all = std::to_string(2 * 10 * 10 * 37);
  EXPECT_TRUE(says(text(diffuser({0.55, -1})), {"; f11 is negative at " + nodes + " of " + all + " nodes"}));
  EXPECT_EQ(text(diffuser({0.3})).find("negative"), std::string::npos);
}

TEST(NetcdfExport, TakesTheCoarsestGridThatHasTheErrorAskedFor) {
  const Folder folder;
  Model model = material("ptfe-532");
  model.posterior.reset();  // u takes long
  for (const auto& [error, step] : {std::pair{5e-3, "10"}, std::pair{3e-4, "5"}, std::pair{9e-5, "2.5"}}) {
    const Export table(model, export_format("netcdf"), {.error = error});
    EXPECT_TRUE(says(table.understood(), {std::string("steps of ") + step + ", phi_i"}));
    EXPECT_LE(table.error().rms, error);
  }
  EXPECT_TRUE(says(export_refusal(model, "netcdf", {.error = 1e-7}), {"the finest table, of steps of 2.5 degrees"}));
}

TEST(NetcdfExport, RefusesWhatItCannotHold) {
  Model diffuse = diffuser({0.3, 0.1});
  std::vector<double> many;
  for (int nm = 400; nm < 2400; ++nm) many.push_back(nm * 1e-3);
  EXPECT_TRUE(says(export_refusal(diffuse, "netcdf", {.wavelengths = many, .error = 1}),
                   {"steps of 10 degrees at 2000 wavelengths are 118 million"}));
  Model anisotropic = random_model(Family::anisotropic, {2, 1}, 0, 1);
  for (const std::string format : {"netcdf", "mqdiffuse"})
    EXPECT_TRUE(says(export_refusal(anisotropic, format, {.wavelengths = {0.5}}), {"azimuth of the source"}));
  EXPECT_TRUE(says(export_refusal(material("ptfe"), "mqdiffuse"),
                   {"351, 532, 633 and 1064 nm", "has one wavelength: choose it"}));
  EXPECT_TRUE(says(export_refusal(material("ptfe"), "netcdf", {.channel = "f_ss"}), {"holds whole matrices"}));
  EXPECT_TRUE(
      says(export_refusal(material("ptfe-532"), "mqdiffuse", {.error = 1e-7}), {"the finest table, of 201 cosines"}));
}
#endif

}  // namespace
}  // namespace mmbrdf
