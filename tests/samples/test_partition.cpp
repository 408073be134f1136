// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/samples/partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <set>
#include <vector>

#include "given/cases.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

void expect_all_used(const Partition& partition, std::size_t samples) {
  ASSERT_EQ(partition.fold.size(), samples);
  const std::set<std::size_t> used(partition.fold.begin(), partition.fold.end());
  EXPECT_EQ(used.size(), partition.names.size());
  EXPECT_EQ(*used.rbegin(), partition.names.size() - 1);
}

std::vector<Sample> in_random_directions(int count) {
  return simulate(random_model(Family::isotropic, {2, 1}, 0, 1), std::array{0.5}, random_geometries(count, 11));
}

}  // namespace

TEST(Partition, ByRowIsTheRowNumberModuloTheFolds) {
  const Partition partition = folds_by_row(8, 3);
  EXPECT_EQ(partition.fold, (std::vector<std::size_t>{0, 1, 2, 0, 1, 2, 0, 1}));
  EXPECT_EQ(partition.names.size(), 3U);
}

TEST(Partition, AtRandomIsEvenAndFollowsTheSeed) {
  const Partition one = random_folds(100, 3, 1), again = random_folds(100, 3, 1), other = random_folds(100, 3, 2);
  EXPECT_EQ(one.fold, again.fold);
  EXPECT_NE(one.fold, other.fold);
  EXPECT_NE(one.fold, folds_by_row(100, 3).fold);
  expect_all_used(one, 100);
  for (std::size_t f = 0; f < 3; ++f)
    EXPECT_NEAR(static_cast<double>(std::count(one.fold.begin(), one.fold.end(), f)), 100 / 3., 1) << f;
}

// Three rows of each of seven directions: at another wavelength, and of the sample turned about its normal.
TEST(Partition, ByDirectionKeepsRepeatsTogether) {
  const std::vector<Sample> once = in_random_directions(7);
  std::vector<Sample> samples = once;
  for (const Sample& s : once) {
    samples.push_back(s);
    samples.back().wavelength += 0.1;
  }
  for (const Sample& s : once) {
    samples.push_back(s);
    samples.back().geometry.incident.phi += 1;
    samples.back().geometry.reflected.phi += 1 - 2 * std::numbers::pi;
  }
  EXPECT_EQ(folds_by_direction(once, 3).fold, folds_by_row(7, 3).fold);
  EXPECT_EQ(folds_by_direction(once, 3, 5).fold, random_folds(7, 3, 5).fold);
  for (const Partition& partition : {folds_by_direction(samples, 3), folds_by_direction(samples, 3, 5)}) {
    expect_all_used(partition, 21);
    for (std::size_t s = 0; s < 7; ++s) {
      EXPECT_EQ(partition.fold[s + 7], partition.fold[s]) << s;
      EXPECT_EQ(partition.fold[s + 14], partition.fold[s]) << s;
    }
  }
  EXPECT_EQ(message_of([&] { folds_by_direction(std::vector<Sample>(5, once.front()), 2); }),
            "folds: 2, more than the 1 directions of the samples");
}

// The circle of azimuths is closed at 180 degrees, however these are written.
TEST(Partition, ByDirectionKnowsThatMinus180DegreesAre180) {
  std::vector<Sample> samples = in_random_directions(6);
  samples[1].geometry = samples[0].geometry = {{0.5, 0}, {0.7, std::numbers::pi}};
  samples[1].geometry.reflected.phi = -std::numbers::pi;
  const Partition partition = folds_by_direction(samples, 5);
  EXPECT_EQ(partition.fold[1], partition.fold[0]);
  expect_all_used(partition, 6);
}

TEST(Partition, PartsAreTheSamplesOfEachFoldInTheirOrder) {
  std::vector<Sample> samples(5);
  for (std::size_t s = 0; s < 5; ++s) samples[s].f11 = static_cast<double>(s);
  const auto list = parts(samples, folds_by_row(5, 2));
  ASSERT_EQ(list.size(), 2U);
  ASSERT_EQ(list[0].size(), 3U);
  ASSERT_EQ(list[1].size(), 2U);
  EXPECT_EQ(list[0][2].f11, 4);
  EXPECT_EQ(list[1][0].f11, 1);
  EXPECT_THROW(parts(samples, folds_by_row(4, 2)), std::invalid_argument);
}

TEST(Partition, ByAngleJoinsWhatAFileHasRounded) {
  std::vector<Sample> samples(5);
  const double angles[] = {45, 0.001, -0.001, 44.998, 30};
  for (std::size_t s = 0; s < 5; ++s) {
    samples[s].wavelength = 0.5;
    samples[s].geometry.incident = unfolded({radians(angles[s]), 0});
  }
  const Partition partition = folds_by_incident_angle(samples);
  EXPECT_EQ(partition.fold, (std::vector<std::size_t>{2, 0, 0, 2, 1}));
  EXPECT_EQ(partition.names[1], "30 degrees");
  EXPECT_EQ(partition.names[2], "45 degrees");  // the middle of the group, to four digits
  samples[3].geometry.incident.theta = radians(44.96);
  EXPECT_EQ(folds_by_incident_angle(samples, radians(0.05)).names[2], "44.98 degrees");
  EXPECT_EQ(folds_by_incident_angle(samples, radians(1e-4)).names.size(), 4U);
}

TEST(Partition, ByWavelengthNamesThem) {
  std::vector<Sample> samples(3);
  samples[0].wavelength = samples[2].wavelength = 0.633;
  samples[1].wavelength = 0.351;
  const Partition partition = folds_by_wavelength(samples);
  EXPECT_EQ(partition.fold, (std::vector<std::size_t>{1, 0, 1}));
  EXPECT_EQ(partition.names, (std::vector<std::string>{"351 nm", "633 nm"}));
  for (const double rounding : {-0.5, 0.5}) {  // one wavelength
    samples[2].wavelength = 0.633 + rounding * wavelength_resolution;
    EXPECT_EQ(folds_by_wavelength(samples).fold, partition.fold);
  }
}

TEST(Partition, LeavesOutWhatTheDataAllow) {
  const auto kinds = [](std::span<const Sample> samples, const FoldOptions& options) {
    std::vector<std::string> result;
    for (const Partition& one : folds(samples, options).partitions) result.push_back(to_string(one.kind));
    return result;
  };
  using Kinds = std::vector<std::string>;
  std::vector<Sample> samples(30);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    samples[s].wavelength = 0.4 + 0.1 * static_cast<double>(s % 2);
    samples[s].geometry.reflected.theta = 0.01 * static_cast<double>(s);
  }
  const Folds one_angle = folds(samples, {});
  EXPECT_EQ(one_angle.partitions.size(), 1U);
  EXPECT_NE(one_angle.note.find("the data have 1, it takes 2 to 100; folds alone decide"), std::string::npos);
  for (std::size_t s = 0; s < samples.size(); ++s) samples[s].geometry.incident.theta = s % 3 == 0 ? 0.1 : 0.5;
  EXPECT_EQ(kinds(samples, {}), (Kinds{"rows", "angle"}));
  EXPECT_EQ(kinds(samples, {.random = true, .leave_out = leave_out_from("angle,wavelength")}),
            (Kinds{"random", "angle", "wavelength"}));
  EXPECT_EQ(kinds(samples, {.leave_out = leave_out_from("none")}), Kinds{"rows"});
  samples[0].wavelength = 0.7;
  EXPECT_EQ(kinds(samples, {}), (Kinds{"rows", "angle", "wavelength"}));
}

TEST(Partition, RefusesWhatCannotBeLeftOut) {
  const auto says = [](auto action, const std::string& part) {
    EXPECT_NE(message_of(action).find(part), std::string::npos) << message_of(action);
  };
  says([] { folds_by_row(5, 6); }, "folds: 6, more than the 5 samples");
  says([] { folds_by_row(5, 1); }, "folds: 1 is not in 2...100");
  says([] { random_folds(1000, 101, 0); }, "folds: 101");
  const std::vector<Sample> random = in_random_directions(3000), few = in_random_directions(300);
  says([&] { folds_by_incident_angle(random); }, "too close to be told apart");
  says([&] { folds_by_incident_angle(few); }, "it takes 2 to 100");
  says([&] { folds_by_wavelength(few); }, "wavelengths: the data have 1,");
  says([&] { folds_by_incident_angle(few, -1); }, "tolerance -1");
}

}  // namespace mmbrdf
