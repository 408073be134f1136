// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/judgement.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/samples/simulation.hpp"

using namespace mmbrdf;

namespace {

using Doubts = std::vector<std::string>;

Calibration good() {
  Calibration c;
  c.generator_condition = c.analyzer_condition = 1.85;
  c.figure_of_merit.total = 7.6e-4;
  c.film_thickness = 1;
  return c;
}

Film film(double thickness) { return {1.4607, thickness, {4.15, 0.044}}; }

}  // namespace

TEST(Judgement, OfAGoodInstrumentHasNothingToSay) {
  const Verdict verdict = judged(good(), film(0.95));
  EXPECT_EQ(verdict.doubts, Doubts{});
  EXPECT_EQ(verdict.refusal, "");
}

TEST(Judgement, AtALimitIsStillMild) {
  Calibration c = good();
  c.generator_condition = doubtful_condition;
  c.analyzer_condition = worst_condition;
  c.figure_of_merit.total = doubtful_merit;
  EXPECT_EQ(judged(c).doubts,
            Doubts{"the condition number of the analyzer is 100, more than 10: noise of the readings grows by it"});
  EXPECT_EQ(judged(c).refusal, "");
}

TEST(Judgement, RefusesStatesThatLeaveOnlyNoise) {
  Calibration c = good();
  c.generator_condition = 16.1612;
  c.analyzer_condition = 123.456;
  c.figure_of_merit.total = 0.3;
  EXPECT_EQ(judged(c).refusal, "the condition number of the analyzer is 123.5, more than 100");
  EXPECT_EQ(judged(c).doubts,  // what was doubtful before, and nothing behind it
            Doubts{"the condition number of the generator is 16.16, more than 10: noise of the readings grows by it"});
  c.analyzer_condition = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(judged(c).refusal, "");
}

TEST(Judgement, RefusesReferencesThatAreNotThoseOfTheInstrument) {
  Calibration c = good();
  c.figure_of_merit.total = 0.0512;
  EXPECT_EQ(judged(c).doubts,
            Doubts{"figure of merit 0.051, more than 0.05: are states or references mixed up, or angles wrong?"});
  EXPECT_EQ(judged(c).refusal, "");
  c.figure_of_merit.total = 0.6;
  EXPECT_EQ(judged(c).doubts, Doubts{});
  EXPECT_EQ(judged(c).refusal,
            "figure of merit 0.6, more than 0.5: are states or references mixed up, or angles wrong?");
}

TEST(Judgement, DoubtsAFilmThatIsFarFromTheGivenOne) {
  EXPECT_EQ(judged(good(), film(0.87)).doubts,
            Doubts{"the film is 1.0000 um thick, +15 % from the given 0.87 um: is it the right one?"});
  EXPECT_EQ(judged(good(), film(1.13)).doubts,
            Doubts{"the film is 1.0000 um thick, -12 % from the given 1.13 um: is it the right one?"});
}

TEST(Judgement, CountsMatricesThatNothingCanHave) {
  const std::array at{0.532};
  std::vector<Sample> samples = simulate(material("ptfe-532"), at, random_geometries(5, 1), 0, 1);
  EXPECT_EQ(judged(samples).doubts, Doubts{});
  samples[3].normalized(3, 3) = samples[4].normalized(1, 1) = -2;
  const Verdict verdict = judged(samples);
  EXPECT_EQ(verdict.doubts,
            Doubts{"2 of 5 matrices cannot be physical: are generator and analyzer states exchanged, or is it another "
                   "instrument?"});
  EXPECT_EQ(verdict.refusal, "");
  samples[3].normalized(0, 3) = std::numeric_limits<double>::quiet_NaN();  // of a part of a matrix nothing can be said
  EXPECT_EQ(judged(samples).doubts.at(0).substr(0, 6), "1 of 5");
}
