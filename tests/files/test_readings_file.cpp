// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/readings_file.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/polarimetry/measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "given/cases.hpp"
#include "given/files.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarimetry/goniometer.hpp"

namespace mmbrdf {
namespace {

const ReadStates four{4, 4};

/// References of a simulated instrument, one of each kind.
ReferenceFile some_references() { return {0.532, four, Goniometer(GoniometerOptions{}, 1).references(0.532, 2, 3)}; }

std::string references_csv(const std::string& rows) {
  return "wavelength_nm,reference,number,angle_deg,generator_state,analyzer_state,intensity,dark,monitor,gain\n" + rows;
}

ReferenceFile parsed_references(const std::string& text, const ReadingLimits& limits = {}) {
  std::istringstream in(text);
  return read_references(in, "r.csv", limits);
}

std::string raw_csv(const std::string& rows) {
  return "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,number,generator_state,analyzer_state,intensity\n" +
         rows;
}

std::vector<RawMeasurement> parsed_raw(const std::string& text, const ReadStates& states,
                                       const ReadingLimits& limits = {}) {
  std::istringstream in(text);
  RawReader reader(in, "d.csv", states, limits);
  std::vector<RawMeasurement> all;
  for (RawMeasurement one; reader.next(one);) all.push_back(one);
  return all;
}

TEST(Readings, OfReferencesAreReadBackToTheSameBits) {
  ReferenceFile file = some_references();
  file.references.back().s_exceeds_p = 1;
  file.references.back().delta_sign = -1;
  std::ostringstream out;
  write_references(out, file);
  const ReferenceFile back = parsed_references(out.str());
  EXPECT_EQ(back.wavelength, file.wavelength);
  EXPECT_EQ(back.states, file.states);
  ASSERT_EQ(back.references.size(), file.references.size());
  for (std::size_t i = 0; i < file.references.size(); ++i) {
    EXPECT_EQ(back.references[i].kind, file.references[i].kind);
    EXPECT_NEAR(back.references[i].angle, file.references[i].angle, 1e-15);
    EXPECT_EQ(back.references[i].readings, file.references[i].readings);
    EXPECT_EQ(back.references[i].s_exceeds_p, file.references[i].s_exceeds_p);
    EXPECT_EQ(back.references[i].delta_sign, file.references[i].delta_sign);
  }
}

TEST(Readings, OfSamplesAreReadBackToTheSameBits) {
  const ReadStates states{2, 3};
  const std::vector<RawMeasurement> raw = {
      {0.532, {{0.5, 0.1}, {1.0 / 3, 2}}, {0.1, 0.2, 0.3, 1.0 / 3, 0.5, 0.6}},
      {0.532, {{0.5, 0.1}, {0.7, 2}}, {1, 2, 3, 4, 5, 6}},
  };
  std::ostringstream out;
  write_raw(out, states, raw);
  const std::vector<RawMeasurement> back = parsed_raw(out.str(), states);
  ASSERT_EQ(back.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back[i].wavelength, raw[i].wavelength);
    EXPECT_EQ(back[i].readings, raw[i].readings);
    EXPECT_NEAR(back[i].geometry.reflected.theta, raw[i].geometry.reflected.theta, 1e-15);
  }
}

TEST(Readings, AreWhatIsLeftOfAnIntensityAndMayStandInAnyOrder) {
  const ReferenceFile file =
      parsed_references(references_csv("532,empty,7,0,2,1,5,1,2,4\n"
                                       "532,wafer,8,30,1,1,3,0,1,1\n"
                                       "532,empty,7,0,1,1,3,1,2,1\n"
                                       "532,wafer,8,30,2,1,4,0,1,1\n"));
  EXPECT_EQ(file.states, (ReadStates{2, 1}));
  ASSERT_EQ(file.references.size(), 2u);
  EXPECT_EQ(file.references[0].readings, (std::vector<double>{1, 0.5}));  // (3 − 1) / 2, (5 − 1) / (2 · 4)
  EXPECT_EQ(file.references[1].readings, (std::vector<double>{3, 4}));
}

TEST(Readings, OfReferencesThatCannotBeAreRefusedWithTheirLine) {
  const std::string good = "532,empty,1,0,1,1,3,0,1,1\n";
  const auto complains = [&](const std::string& rows) {
    return complaint([&] { parsed_references(references_csv(good + rows), {.saturation = 10}); });
  };
  EXPECT_TRUE(says(complains("532,empty,1,0,1,1,3,0,1,1\n"), {"r.csv:3: measurement 1", "a second", "in line 2"}));
  EXPECT_TRUE(says(
      complains("532,empty,1,0,2,1,3,0,1,1\n532,empty,2,0,1,1,3,0,1,1\n"),
      {"r.csv:4: measurement 2: no reading of generator state 2, analyzer state 1; the highest state is in line 3"}));
  EXPECT_TRUE(says(complains("532,empty,1,0,2,1,10,0,1,1\n"), {"r.csv:3: intensity: 10 is saturated"}));
  EXPECT_TRUE(says(complains("532,empty,1,0,2,1,9,0,1e-200,1e-200\n"), {"r.csv:3: intensity: 9 over its monitor"}));
  EXPECT_TRUE(says(complains("532,empty,1,0,2,1,1,1.5,1,1\n"), {"r.csv:3: intensity: 1 is below dark 1.5"}));
  EXPECT_TRUE(says(complains("532,empty,1,0,2,1,1,0,0,1\n"), {"r.csv:3: monitor: 0 is not positive"}));
  EXPECT_TRUE(says(complains("633,empty,2,0,1,1,1,0,1,1\n"), {"r.csv:3: wavelength_nm: 633, but 532 in line 2"}));
  EXPECT_TRUE(says(complains("532,mirror,2,0,1,1,1,0,1,1\n"), {"r.csv:3: reference: 'mirror'"}));
  EXPECT_TRUE(says(complains("532,wafer,2,90,1,1,1,0,1,1\n"), {"r.csv:3: angle_deg: 90"}));
  EXPECT_TRUE(says(complains("532,wafer,2,-1,1,1,1,0,1,1\n"), {"r.csv:3: angle_deg: -1"}));
  EXPECT_TRUE(says(complains("0,empty,2,0,1,1,1,0,1,1\n"), {"r.csv:3: wavelength_nm: 0", "must be positive"}));
  EXPECT_TRUE(says(complains("532,empty,1.5,0,1,1,1,0,1,1\n"), {"r.csv:3: number: 1.5 is not an integer"}));
  EXPECT_TRUE(says(complains("532,empty,2,0,0,1,1,0,1,1\n"), {"r.csv:3: generator_state: 0"}));
  EXPECT_TRUE(says(complains("532,polarizer,1,0,2,1,1,0,1,1\n"), {"r.csv:3: measurement 1: another reference", "2"}));
  EXPECT_TRUE(says(complains("532,empty,1,5,2,1,1,0,1,1\n"), {"r.csv:3: measurement 1: another angle_deg", "line 2"}));
  EXPECT_TRUE(says(complaint([&] { parsed_references(references_csv("")); }), {"r.csv: no readings"}));
  EXPECT_TRUE(says(complaint([&] { parsed_references("wavelength_nm,reference\n"); }), {"r.csv:1: no column"}));
}

TEST(Readings, OfOneReferenceHaveOneSignOfEachKind) {
  const std::string names = "wavelength_nm,reference,angle_deg,number,generator_state,analyzer_state,intensity,",
                    first = "532,wafer,45,1,1,1,1,1\n", second = "532,wafer,45,1,2,1,1,-1\n";
  for (const std::string sign : {"s_exceeds_p", "delta_sign"})
    EXPECT_TRUE(says(complaint([&] { parsed_references(names + sign + "\n" + first + second); }),
                     {"r.csv:3: measurement 1: another " + sign + " than in line 2"}));
  for (const std::string sign : {"s_exceeds_p", "delta_sign"}) {
    for (const std::string wrong : {"2", "-2", "0.5"})
      EXPECT_TRUE(says(complaint([&] { parsed_references(names + sign + "\n532,wafer,45,1,1,1,1," + wrong + "\n"); }),
                       {"r.csv:2: " + sign + ": " + wrong, "is not one of 1, -1, 0"}));
    const auto kept = [&](const std::string& value) {
      const Reference r = parsed_references(names + sign + "\n532,wafer,45,1,1,1,1," + value + "\n").references.at(0);
      return sign == "s_exceeds_p" ? r.s_exceeds_p : r.delta_sign;
    };
    EXPECT_EQ(kept("-1"), -1);
    EXPECT_EQ(kept("1"), 1);
    EXPECT_EQ(kept("0"), 0);
    EXPECT_EQ(kept(""), 0);
  }
}

TEST(Readings, OfReferencesAreWrittenAtAPositiveWavelengthAlone) {
  std::ostringstream out;
  for (const double wavelength : {0.0, -0.5, std::nan("")})
    EXPECT_TRUE(message_of([&] {
                  write_references(out, {wavelength, {1, 1}, {}});
                }).ends_with(" nm, must be positive"));
  EXPECT_EQ(out.str(), "");
}

TEST(Readings, LackOfColumnsIsSaidOfAllAtOnce) {
  EXPECT_TRUE(says(complaint([&] { parsed_references("wavelength_nm,reference,number\n"); }),
                   {"r.csv:1: no column angle_deg, generator_state, analyzer_state, intensity"}));
  EXPECT_TRUE(says(complaint([&] {
                     parsed_raw("wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,number\n", {2, 1});
                   }),
                   {":1: no column generator_state, analyzer_state, intensity"}));
}

TEST(Readings, OfSamplesThatCannotBeAreRefusedWithTheirLine) {
  const std::string good = "532,45,0,30,180,1,1,1,3\n";
  const auto complains = [&](const std::string& rows) {
    return complaint([&] { parsed_raw(raw_csv(good + rows), {2, 1}); });
  };
  EXPECT_EQ(complains("532,45,0,30,180,1,2,1,3\n"), "");
  EXPECT_TRUE(says(complains("532,45,0,30,180,1,3,1,3\n"), {"d.csv:3: generator state 3", "the instrument has 2"}));
  EXPECT_TRUE(says(complains("532,45,0,30,180,1,2,2,3\n"), {"d.csv:3: ", "analyzer state 2", "and 1 analyzer states"}));
  EXPECT_TRUE(says(complains("532,45,0,31,180,1,2,1,3\n"), {"d.csv:3: measurement 1: another direction", "line 2"}));
  EXPECT_TRUE(says(complains("532,45,0,30,180,1,1,1,3\n"), {"d.csv:3: measurement 1: a second", "in line 2"}));
  EXPECT_TRUE(says(complains("532,45,0,30,180,1,2,1,-3\n"), {"d.csv:3: intensity: -3 is negative"}));
  EXPECT_TRUE(says(complaint([&] { parsed_raw(raw_csv(""), {2, 1}); }), {"d.csv: no readings"}));
}

TEST(Readings, MayBeAnyPairsOfStates) {
  const std::vector<RawMeasurement> raw = parsed_raw(raw_csv("532,45,0,30,180,1,2,2,3\n"
                                                             "532,45,0,30,180,1,1,1,4\n"
                                                             "532,45,0,40,180,2,1,1,5\n"),
                                                     {2, 2});
  ASSERT_EQ(raw.size(), 2u);
  EXPECT_EQ(raw[0].pairs, (std::vector<StatePair>{{0, 0}, {1, 1}}));
  EXPECT_EQ(raw[0].readings, (std::vector<double>{4, 3}));
  EXPECT_EQ(raw[1].pairs, (std::vector<StatePair>{{0, 0}}));
  EXPECT_TRUE(
      says(complaint([] {
             parsed_raw(raw_csv("532,45,0,30,180,1,1,1,3\n532,45,0,40,180,2,1,1,4\n532,45,0,30,180,1,2,2,3\n"), {2, 2});
           }),
           {"d.csv:4: measurement 1: began further up"}));
  // Those of the instrument need not be said.
  const ReadStates pairwise{2, 2, {{0, 0}, {1, 1}}};
  const RawMeasurement own = parsed_raw(raw_csv("532,45,0,30,180,1,2,2,3\n532,45,0,30,180,1,1,1,4\n"), pairwise)[0];
  EXPECT_TRUE(own.pairs.empty());
  EXPECT_EQ(own.readings, (std::vector<double>{4, 3}));
  std::ostringstream out;
  write_raw(out, pairwise, std::vector{own});
  const RawMeasurement back = parsed_raw(out.str(), pairwise)[0];
  EXPECT_EQ(back.readings, own.readings);
  EXPECT_TRUE(back.pairs.empty());
}

TEST(Readings, OfReferencesHaveThePairsThatAnyOfThemHas) {
  const std::string pairwise = "532,empty,1,0,1,1,3,0,1,1\n532,empty,1,0,2,2,4,0,1,1\n";
  const ReferenceFile file =
      parsed_references(references_csv(pairwise + "532,retarder,2,30,2,2,6,0,1,1\n532,retarder,2,30,1,1,5,0,1,1\n"));
  EXPECT_EQ(file.states, (ReadStates{2, 2, {{0, 0}, {1, 1}}}));
  EXPECT_EQ(file.references[1].kind, ReferenceKind::retarder);
  EXPECT_EQ(file.references[1].readings, (std::vector<double>{5, 6}));
  std::stringstream written;
  write_references(written, file);
  const ReferenceFile back = parsed_references(written.str());
  EXPECT_EQ(back.states, file.states);
  EXPECT_EQ(back.references[1].readings, file.references[1].readings);
  EXPECT_TRUE(says(complaint([&] { parsed_references(references_csv(pairwise + "532,empty,2,0,1,1,3,0,1,1\n")); }),
                   {"r.csv:4: measurement 2: no reading of generator state 2, analyzer state 2, which other"}));
}

// As far below zero as the noise of the dark signal reaches, five of its standard deviations, and no further.
TEST(Readings, BelowZeroAreNoiseWithinFiveStandardDeviationsOfTheDarkSignal) {
  const ReadingLimits limits{.dark_noise = 1e-3};
  const auto with = [&](const std::string& intensity) {
    return parsed_raw(raw_csv("532,45,0,30,180,1,1,1," + intensity + "\n"), {1, 1}, limits)[0].readings[0];
  };
  EXPECT_EQ(with("-0.0003"), -0.0003);
  EXPECT_EQ(with("-0.00499"), -0.00499);
  EXPECT_TRUE(says(complaint([&] { with("-0.00501"); }),
                   {"d.csv:2: intensity: -0.00501 is negative, 5.01 times the noise of the dark signal; at most 5"}));
  const auto reference = [&](const std::string& numbers) {
    return parsed_references(references_csv("532,empty,1,0,1,1," + numbers + "\n"), limits).references[0].readings[0];
  };
  EXPECT_EQ(reference("1,1.0078125,2,1"), -0.00390625);  // of the reading, not of the intensity
  EXPECT_TRUE(says(complaint([&] { reference("1,1.0078125,1,1"); }), {"below dark 1.0078125, 7.81 times the noise"}));
}

/// A measurement without noise of some model at some geometry.
RawMeasurement some_measurement(const Polarimeter& polarimeter, double solid_angle) {
  const Geometry g{{0.7, 0.4}, {0.9, 2.5}};
  const Mueller f = prepare(material("ptfe-532"), 0.532).evaluate(g, Frame::scattering_plane);
  return {0.532, g, readings(polarimeter, solid_angle * std::cos(g.reflected.theta) * f)};
}

TEST(Readings, ReduceToTheSampleThatTheyAreOf) {
  const Polarimeter polarimeter = Goniometer({}, 1).polarimeter();
  const RawMeasurement raw = some_measurement(polarimeter, 2e-4);
  const Sample sample = reduced(Reduction(polarimeter), raw, 2e-4, {});
  const Mueller expected = prepare(material("ptfe-532"), 0.532).evaluate(raw.geometry);
  EXPECT_EQ(sample.wavelength, 0.532);
  EXPECT_EQ(sample.geometry, raw.geometry);
  EXPECT_NEAR(sample.f11, expected(0, 0), 1e-13);  // rounding, times condition numbers
  for (std::size_t e = 0; e < 16; ++e) {
    EXPECT_NEAR(sample.normalized.elements[e], normalized(expected).elements[e], 1e-13);
    EXPECT_EQ(sample.uncertainty.elements[e], 0);
  }
}

TEST(Readings, OfFewerPairsLeaveUnknownWhatTheyDoNotDetermine) {
  const std::vector<std::string> linear{"s", "p", "+45", "-45"};
  const Polarimeter polarimeter = ideal_polarimeter(linear, linear);
  const RawMeasurement raw = some_measurement(polarimeter, 2e-4);
  Reducer reducer(polarimeter);
  const Sample sample = reduced(reducer({}), raw, 2e-4, {.relative = 1e-3});
  const Mueller expected = normalized(prepare(material("ptfe-532"), 0.532).evaluate(raw.geometry));
  for (std::size_t e = 0; e < 16; ++e) {
    const bool circular = e / 4 == 3 || e % 4 == 3;
    EXPECT_EQ(std::isnan(sample.normalized.elements[e]), circular) << e;
    EXPECT_EQ(sample.uncertainty.elements[e] > 0, !circular) << e;
    if (circular) continue;
    EXPECT_NEAR(sample.normalized.elements[e], expected.elements[e], 1e-13);
  }
  // Three linear states of each arm say as much.
  RawMeasurement nine = raw;
  nine.readings.clear();
  for (const std::size_t a : {0U, 1U, 2U})
    for (const std::size_t g : {0U, 1U, 2U}) {
      nine.pairs.push_back({g, a});
      nine.readings.push_back(raw.readings[4 * a + g]);
    }
  EXPECT_NEAR(reduced(reducer(nine.pairs), nine, 2e-4, {}).normalized(1, 2), expected(1, 2), 1e-13);
  EXPECT_EQ(reducer.sets(), 2u);
}

TEST(Readings, ThatDoNotDetermineF11AreRefusedWithWhatIsMissing) {
  const Polarimeter polarimeter = Goniometer({}, 1).polarimeter();
  RawMeasurement raw = some_measurement(polarimeter, 2e-4);
  Reducer reducer(polarimeter);
  const auto refusal = [&](std::vector<StatePair> pairs) {
    raw.pairs = std::move(pairs);
    raw.readings.assign(raw.pairs.size(), 1e-5);
    return message_of([&] { reduced(reducer(raw.pairs), raw, 2e-4, {}); });
  };
  std::vector<StatePair> most;
  for (std::size_t j = 0; j < 16; ++j)
    if (j != 5) most.push_back(polarimeter.pair(j));
  EXPECT_EQ(refusal(most),
            "15 readings of rank 15 do not determine M11: more or other states are needed; there is none of generator "
            "state 2, analyzer state 2");
  EXPECT_EQ(refusal({{1, 2}}), "1 readings of rank 1 do not determine M11: more or other states are needed");
  EXPECT_EQ(refusal({{1, 2}, {0, 0}, {1, 2}}), "generator state 2, analyzer state 3 is there twice");
  EXPECT_EQ(refusal({{4, 0}}),
            "generator state 5, analyzer state 1: the instrument has 4 generator and 4 analyzer states");
  const std::vector<DialAngles> dials = dial_angles(5, radians(6), 61);
  Reducer frames(mmbrdf::polarimeter(RotatingRetarders{}, dials));
  EXPECT_EQ(message_of([&] {
              frames(std::vector<StatePair>{{3, 6}});
            }),
            "generator state 4, analyzer state 7: the instrument does not read this pair");
}

TEST(Readings, ReduceToSamplesThatScatterAsTheirUncertaintiesSay) {
  const Polarimeter polarimeter = Goniometer({}, 1).polarimeter();
  const Reduction reduction(polarimeter);
  const RawMeasurement raw = some_measurement(polarimeter, 2e-4);
  const ReadingNoise noise{1e-8, 1e-9, 1e-3};  // each a part of σ: readings are of some 1e-5
  const Sample exact = reduced(reduction, raw, 2e-4, noise);
  constexpr int draws = 4000;
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  Mueller squares{};
  for (int draw = 0; draw < draws; ++draw) {
    RawMeasurement noisy = raw;
    for (double& b : noisy.readings) b += std::sqrt(variance(noise, b)) * normal(engine);
    const Sample sample = reduced(reduction, noisy, 2e-4, noise);
    squares(0, 0) += std::pow(sample.f11 - exact.f11, 2) / draws;
    for (std::size_t e = 1; e < 16; ++e)
      squares.elements[e] += std::pow(sample.normalized.elements[e] - exact.normalized.elements[e], 2) / draws;
  }
  for (std::size_t e = 0; e < 16; ++e)
    EXPECT_NEAR(std::sqrt(squares.elements[e]) / exact.uncertainty.elements[e], 1, 4 / std::sqrt(2. * draws)) << e;
}

TEST(Readings, ThatAreNoneAreNotReduced) {
  const Polarimeter polarimeter = Goniometer({}, 1).polarimeter();
  const Reduction reduction(polarimeter);
  const RawMeasurement raw = some_measurement(polarimeter, 2e-4);
  EXPECT_EQ(message_of([&] { reduced(reduction, raw, 0, {}); }),
            "a solid angle of 0 sr, must be above 0 and at most 2 pi");
  EXPECT_EQ(message_of([&] { reduced(reduction, raw, 2e-4, {.relative = -1}); }),
            "a noise of -1, must be finite and not negative");
  EXPECT_EQ(message_of([&] { reduced(reduction, raw, 2e-4, {.dark = 1e150}); }),
            "the noise leaves no finite uncertainty");
  RawMeasurement short_one = raw;
  short_one.readings.pop_back();
  EXPECT_EQ(message_of([&] { reduced(reduction, short_one, 2e-4, {}); }), "15 readings, the instrument has 16");
}

TEST(Readings, AreNamedInTheFileOfTheirSamples) {
  const std::string text =
      reduction_text("raw\n1.csv", "i.json", 1.114e-4, {.dark = 1e-7, .shot = 0, .relative = 1e-3}, 5);
  EXPECT_EQ(text, "raw\\x0a1.csv by i.json, solid angle 0.0001114 sr, noise dark:1e-07,relative:0.001, saturation 5");
  EXPECT_EQ(reduction_text("-", "x", 1, {}), "- by x, solid angle 1 sr, noise none");
  const std::vector<Sample> samples{{0.532, {{0.5, 0.1}, {0.7, 2}}, 0.3, identity()}};
  std::stringstream file;
  write_samples(file, samples, text);
  SampleReader reader(file, "data.csv");
  EXPECT_EQ(reader.reduction(), text);
  Sample back;
  ASSERT_TRUE(reader.next(back));
  EXPECT_EQ(back.f11, 0.3);
  EXPECT_EQ(reader.understood(), "");
  std::stringstream plain;
  write_samples(plain, samples);
  EXPECT_EQ(SampleReader(plain, "data.csv").reduction(), "");
  EXPECT_THROW(write_samples(plain, samples, "two\nlines"), std::invalid_argument);
}

TEST(Readings, OfAnotherNumberThanTheStatesAreNotWritten) {
  std::ostringstream out;
  ReferenceFile file = some_references();
  file.references[1].readings.pop_back();
  EXPECT_THROW(write_references(out, file), std::invalid_argument);
  const std::vector<RawMeasurement> raw = {{0.532, {}, {1, 2, 3}}};
  EXPECT_THROW(write_raw(out, {2, 1}, raw), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
