// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "given/cases.hpp"
#include "given/least_squares.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {
namespace {

MuellerCovariance diagonal(double value) {
  MuellerCovariance v;
  for (std::size_t e = 0; e < 16; ++e) v(e, e) = value;
  return v;
}

TEST(MuellerCovariance, OfAModelIsValidAndSoAreThoseOfRankOneAndNone) {
  const PreparedUncertainty fit = prepare_uncertainty(least_squares("ptfe-532"), 0.532);
  for (const Frame frame : {Frame::xy, Frame::sp}) require_valid(fit.evaluate({{0.7, 0.2}, {0.4, 1}}, frame));
  require_valid(fit.evaluate({}));
  require_valid(diagonal(0));
  MuellerCovariance one;
  one.values.fill(1e-7);
  require_valid(one);
}

TEST(MuellerCovariance, ThatNothingCanHaveIsRefused) {
  const auto what = [](const MuellerCovariance& v) { return message_of([&] { require_valid(v); }); };
  EXPECT_EQ(what(diagonal(-1)),
            "the covariance of the elements is not positive semidefinite: its eigenvalues are -1 to 0");
  MuellerCovariance v = diagonal(1);
  v(0, 1) = v(1, 0) = 2;
  EXPECT_NE(what(v).find("not positive semidefinite"), std::string::npos);
  v(1, 0) = 0;
  EXPECT_EQ(what(v), "the covariance is not symmetric: 2 and 0 at 0, 1, counted from 0");
  v(1, 0) = 1.0 / 0.0;
  EXPECT_EQ(what(v), "the covariance is not finite");
}

TEST(MuellerCovariance, OfAnUnknownElementIsUnknownWithEachOther) {
  MuellerCovariance v = diagonal(1);
  set_unknown(v, Elements(1U << 5U));
  for (std::size_t e = 0; e < 16; ++e)
    for (std::size_t other = 0; other < 16; ++other)
      EXPECT_EQ(std::isnan(v(e, other)), e == 5 || other == 5) << e << ' ' << other;
}

}  // namespace
}  // namespace mmbrdf
