// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/inspection.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "given/not_measured.hpp"

namespace mmbrdf {
namespace {

// Element 12 alone: what a frame leaves unknown is not turned, and its numbers are those of the table.
TEST(RowFindings, TakeTheSameNumbersOfTwoFramesForTwoReadings) {
  Elements others = all_but_f11;
  others.reset(1);
  const Sample xy = without(others, of_ptfe()).front(), sp = from_frame(xy, Frame::sp);
  const auto repeated = [](const std::vector<Sample>& samples) {
    const std::vector<Finding> findings = row_findings(samples);
    return std::ranges::count(findings, "repeated rows", &Finding::fault);
  };
  EXPECT_EQ(repeated({xy, sp}), 0);
  EXPECT_EQ(repeated({sp, sp}), 1);
}

}  // namespace
}  // namespace mmbrdf
