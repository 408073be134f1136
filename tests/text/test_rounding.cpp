// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/text/rounding.hpp"

#include <gtest/gtest.h>

namespace mmbrdf {
namespace {

TEST(Rounding, KeepsTwoDigitsOfAnUncertaintyAndTheValueToTheirPlace) {
  EXPECT_EQ(to_place_of(0.98415881, 0.00053406), "0.98416");
  EXPECT_EQ(to_place_of(0.00053406, 0.00053406), "0.00053");
  EXPECT_EQ(to_place_of(0.001, 0.001), "0.0010");
  EXPECT_EQ(to_place_of(-3.14159, 0.5), "-3.14");
  EXPECT_EQ(to_place_of(-0.0004, 0.01), "0.000");
  EXPECT_EQ(to_place_of(12.7, 42), "13");
  EXPECT_EQ(to_place_of(98765, 123), "98770");
  EXPECT_EQ(to_place_of(2.34567e-14, 3.2146e-16), "2.346e-14");
  EXPECT_EQ(to_place_of(3.2146e-16, 3.2146e-16), "3.2e-16");
  EXPECT_EQ(to_place_of(2.754e-8, 3.1e-10), "2.754e-08");
  EXPECT_EQ(to_place_of(0.00001234, 0.0000031), "0.0000123");
}

TEST(Rounding, TakesThePlaceOfTheRoundedUncertainty) {
  EXPECT_EQ(to_place_of(0.0996, 0.0996), "0.10");
  EXPECT_EQ(to_place_of(1.23456, 0.0996), "1.23");
  EXPECT_EQ(to_place_of(99.6, 99.6), "100");
}

TEST(Rounding, OfAValueAloneIsToSixDigits) {
  EXPECT_EQ(to_place_of(0.98415881, {}), "0.984159");
  EXPECT_EQ(to_place_of(0.98415881, 0), "0.984159");
  EXPECT_EQ(to_place_of(0, 0), "0");
}

}  // namespace
}  // namespace mmbrdf
