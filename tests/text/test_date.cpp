// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/text/date.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

namespace mmbrdf {
namespace {

TEST(Date, IsThatOfTheSourceWhereOneIsSet) {
  ::setenv("SOURCE_DATE_EPOCH", "1764460800", 1);
  EXPECT_EQ(utc_timestamp(), "2025-11-30T00:00:00+00:00");
  ::setenv("SOURCE_DATE_EPOCH", "253402300799", 1);
  EXPECT_EQ(utc_timestamp(), "9999-12-31T23:59:59+00:00");
  for (const char* wrong : {"yesterday", "", "-1", "0.5", "nan", "253402300800"}) {
    ::setenv("SOURCE_DATE_EPOCH", wrong, 1);
    EXPECT_THROW(utc_timestamp(), std::invalid_argument) << wrong;
  }
  ::unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_EQ(utc_timestamp().size(), std::string("2025-11-30T00:00:00+00:00").size());
}

}  // namespace
}  // namespace mmbrdf
