// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/text/notation.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace mmbrdf {
namespace {

TEST(Notation, HasTwoDigitsOfTheUncertaintyInBracketsOrBehindASign) {
  EXPECT_EQ(in_print(0.98412345, 0.00032), "0.98412(32)");
  EXPECT_EQ(in_print(0.98412345, 0.00032, Notation::plus_minus), "0.98412 ± 0.00032");
  EXPECT_EQ(in_print(0.984, 0.0996), "0.98(10)");
  EXPECT_EQ(in_print(98765, 123), "98770(120)");
  EXPECT_EQ(in_print(0.983242887953118, 9.2e-17), "0.983242887953118 ± 9.2 × 10⁻¹⁷");  // of data without noise
  EXPECT_EQ(in_print(1234.5, 1e-10, Notation::plus_minus), "1234.5 ± 1.0 × 10⁻¹⁰");
  EXPECT_EQ(in_print(12.34, 1.23), "12.3(1.2)");
}

TEST(Notation, OfSmallAndLargeNumbersHasAPowerOfTen) {
  EXPECT_EQ(in_print(2.34567e-14, 3.21e-16), "2.346(32) × 10⁻¹⁴");
  EXPECT_EQ(in_print(2.34567e-14, 3.21e-16, Notation::plus_minus), "(2.346 ± 0.032) × 10⁻¹⁴");
  EXPECT_EQ(in_print(-1.23456e20, 3e17), "−1.2346(30) × 10²⁰");
  EXPECT_EQ(significant(-9.52941e-17, 2), "−9.5 × 10⁻¹⁷");
}

TEST(Notation, HasAMinusSignAndNoNegativeZero) {
  EXPECT_EQ(in_print(-0.25, 0.013), "−0.250(13)");
  EXPECT_EQ(in_print(-0.0004, 0.12), "0.00(12)");
}

TEST(Notation, OfAValueAloneHasThreeDigits) {
  EXPECT_EQ(in_print(0.98412, {}), "0.984");
  EXPECT_EQ(in_print(0.98412, 0.0), "0.984");
  EXPECT_EQ(in_print(std::numeric_limits<double>::quiet_NaN(), 0.1), "not known");
}

TEST(Notation, KeepsZerosThatAreSignificant) {
  EXPECT_EQ(significant(0.005, 2), "0.0050");
  EXPECT_EQ(significant(0.99996, 3), "1.00");
  EXPECT_EQ(significant(282.122, 2), "280");
  EXPECT_EQ(significant(12345678, 3), "1.23 × 10⁷");
  EXPECT_EQ(significant(0, 3), "0");
}

TEST(Notation, HasNames) {
  EXPECT_EQ(notation_from("brackets"), Notation::brackets);
  EXPECT_EQ(notation_from("plus-minus"), Notation::plus_minus);
  EXPECT_THROW(notation_from("both"), std::invalid_argument);
}

TEST(SymbolsInPrint, AreThoseOfTheField) {
  EXPECT_EQ(symbols_in_print("f11 is -0.1 at theta_i 80, theta_r 80.5, phi_r - phi_i 180 degrees"),
            "f₁₁ is −0.1 at θᵢ = 80°, θᵣ = 80.5°, φᵣ − φᵢ = 180°");
  EXPECT_EQ(symbols_in_print("theta_i <= 75, theta_r <= 81.87 degrees at 532 nm"), "θᵢ ≤ 75°, θᵣ ≤ 81.87° at 532 nm");
  EXPECT_EQ(symbols_in_print("chi^2 is 2.1 +- 0.1, in sr^-1, times pi"), "χ² is 2.1 ± 0.1, in sr⁻¹, times π");
  EXPECT_EQ(symbols_in_print("theta_i 45, phi_r - phi_i -66.04 degrees"), "θᵢ = 45°, φᵣ − φᵢ = −66.04°");
  EXPECT_EQ(symbols_in_print("missing: theta_i 0 to 30"), "missing: θᵢ 0 to 30");
}

TEST(SymbolsInPrint, AreNotMadeOfNamesThatHoldTheirLetters) {
  for (const char* name : {"theta_i.csv", "data_theta_i", "theta_i_deg", "pipe", "sum", "a.pi.csv"})
    EXPECT_EQ(symbols_in_print(name), name);
}

}  // namespace
}  // namespace mmbrdf
