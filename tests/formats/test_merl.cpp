// SPDX-License-Identifier: BSD-3-Clause
// MERL binary: three counts and three planes, theta_h spaced as squares, phi_d from 0 to 180 degrees.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "given/foreign.hpp"

namespace mmbrdf {
namespace {

constexpr std::array<double, 3> stored_per_unit{1500, 1500 / 1.15, 1500 / 1.66};

/// Values of the middles of the intervals; every tenth is −1, not measured.
std::string file(std::int32_t n_h, std::int32_t n_d, std::int32_t n_p, int* missing = nullptr) {
  std::string bytes;
  for (const std::int32_t count : {n_h, n_d, n_p}) append(bytes, count);
  for (std::size_t colour = 0; colour < 3; ++colour)
    for (int h = 0; h < n_h; ++h)
      for (int d = 0; d < n_d; ++d)
        for (int p = 0; p < n_p; ++p) {
          const double theta_h = 90 * std::pow((h + 0.5) / n_h, 2) * degree;
          const double theta_d = 90 * (d + 0.5) / n_d * degree, phi_d = 180 * (p + 0.5) / n_p * degree;
          const Vector half = at(theta_h, 0), up = {0, 1, 0}, t = cross(up, half);
          const Vector away = sum(std::cos(phi_d), t, std::sin(phi_d), up);
          const Vector i = sum(std::sin(theta_d), away, std::cos(theta_d), half);
          const Vector o = sum(-std::sin(theta_d), away, std::cos(theta_d), half);
          const bool none = (h + d + p) % 10 == 9;
          if (none && i[2] > 0 && o[2] > 0 && missing != nullptr) ++*missing;
          append(bytes, none ? -1.0 : stored_per_unit[colour] * isotropic(i, o));
        }
  return bytes;
}

TEST(Merl, GivesThreeColoursAtTheWavelengthsThatAreTold) {
  const Folder folder;
  int missing = 0;
  put(folder / "x", file(7, 6, 8, &missing));
  const ForeignRead read = read_foreign_file(folder / "x", {0.61, 0.55, 0.465});
  EXPECT_GE(read.samples.size(), 300U);
  expect_values(read.samples, isotropic, 1e-12);  // doubles, scaled and back
  EXPECT_EQ(read.samples[1].wavelength, 0.55);
  EXPECT_TRUE(says(read.understood,
                   {"a MERL binary file: 7 x 6 x 8", "at 610, 550 and 465 nm as told",
                    std::to_string(missing) + " of 1008 values not measured, passed over", "at or below the horizon"}));
}

TEST(Merl, IsRefusedInOneLineIfItIsCutOffOrWrong) {
  const Folder folder;
  const std::string path = folder / "x";
  put(path, file(90, 90, 180).substr(0, 1600000));
  EXPECT_TRUE(
      says(foreign_refusal(path, {0.6, 0.5, 0.4}), {"x: has 1600000 bytes, but 90 x 90 x 180 nodes take 34992012"}));
  put(path, file(3, 3, 3));
  EXPECT_TRUE(says(foreign_refusal(path), {"does not say the wavelength of its 3 colours", "--wavelength NM,NM"}));
  EXPECT_TRUE(says(foreign_refusal(path, {0.5}), {"has 3 colours", "not 500 nm"}));
  const std::string whole = contents(path);
  for (std::size_t part = 1; part < 16; ++part) {  // of unusual counts, the size says that it is one
    put(path, whole.substr(0, whole.size() * part / 16));
    EXPECT_TRUE(says(foreign_refusal(path, {0.6, 0.5, 0.4}), {"x: "}));
  }
  std::string infinite = whole;
  const double inf = HUGE_VAL;
  infinite.replace(12, 8, std::string(reinterpret_cast<const char*>(&inf), 8));
  put(path, infinite);
  EXPECT_TRUE(says(foreign_refusal(path, {0.6, 0.5, 0.4}), {"x: value 1 of colour 1: inf, must be finite"}));
  std::string huge(12, '\x7f');
  put(path, huge + std::string(100, 'x'));
  EXPECT_TRUE(says(foreign_refusal(path, {0.6, 0.5, 0.4}), {"x: in no format"}));
}

}  // namespace
}  // namespace mmbrdf
