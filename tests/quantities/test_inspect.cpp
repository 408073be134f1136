// SPDX-License-Identifier: BSD-3-Clause
// What inspect() finds in simulated measurements of PTFE with noise, with one fault each, and without.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/quantities/fit_warnings.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

using Samples = std::vector<Sample>;

Samples measured(unsigned long seed, const std::string& name = "ptfe-532", double speckle = 0.006) {
  return simulate(material(name), std::vector{0.532}, random_geometries(400, seed), speckle, seed + 1);
}

void each(Samples& samples, const std::function<void(Sample&)>& change) { std::ranges::for_each(samples, change); }

std::string found(const Samples& samples) {
  std::string list;
  for (const Finding& one : inspect(samples).findings) list += (list.empty() ? "" : ", ") + one.fault;
  return list;
}

void read_as(Samples& samples, Frame frame) {
  each(samples, [&](Sample& s) { s.normalized = change_frame(s.normalized, s.geometry, Frame::xy, frame); });
}

/// Signs of the Stokes components of either beam.
void reverse(Samples& samples, std::size_t component, bool scattered, bool incident) {
  each(samples, [&](Sample& s) {
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        if ((scattered && i == component) != (incident && j == component)) s.normalized.elements[4 * i + j] *= -1;
  });
}

TEST(Inspect, FindsNothingInFortyCleanMeasurements) {
  for (unsigned long seed = 0; seed < 40; ++seed)
    EXPECT_EQ(found(measured(100 + 2 * seed, seed % 2 ? "ptfe" : "ptfe-532", seed % 3 ? 0.006 : 0.02)), "") << seed;
}

TEST(Inspect, FindsEachPlantedFault) {
  const std::pair<std::string, std::function<void(Samples&)>> faults[] = {
      {"scale of f11", [](Samples& all) { each(all, [](Sample& s) { s.f11 *= 100; }); }},
      {"scale of f11", [](Samples& all) { each(all, [](Sample& s) { s.f11 *= std::numbers::pi; }); }},
      {"cosine", [](Samples& all) { each(all, [](Sample& s) { s.f11 *= std::cos(s.geometry.reflected.theta); }); }},
      {"cosine", [](Samples& all) { each(all, [](Sample& s) { s.f11 /= std::cos(s.geometry.reflected.theta); }); }},
      {"frame or signs", [](Samples& all) { each(all, [](Sample& s) { s.normalized = transpose(s.normalized); }); }},
      {"azimuths",
       [](Samples& all) {
         each(all, [](Sample& s) {
           const double d = std::remainder(s.geometry.reflected.phi - s.geometry.incident.phi, 2 * std::numbers::pi);
           s = at_zero_azimuth(s);
           s.geometry.reflected.phi = std::abs(d);
         });
       }},
      {"frame or signs", [](Samples& all) { read_as(all, Frame::sp); }},
      {"frame or signs", [](Samples& all) { read_as(all, Frame::scattering_plane); }},
      {"frame or signs", [](Samples& all) { reverse(all, 2, false, true); }},
      {"frame or signs", [](Samples& all) { reverse(all, 1, true, false); }},
      {"fill values",
       [](Samples& all) {
         for (std::size_t i = 0; i < 20; ++i) {
           all[17 * i].f11 = -999;
           all[17 * i].normalized.elements.fill(-999);
         }
       }},
      {"fill values",
       [](Samples& all) {
         for (std::size_t i = 0; i < 20; ++i) all[17 * i].f11 = 0, all[17 * i].normalized = Mueller{};
       }},
      {"fill values", [](Samples& all) { all[40].f11 = -9999; }},
      {"wavelengths", [](Samples& all) { each(all, [](Sample& s) { s.wavelength *= 1000; }); }},
      {"elements not divided",
       [](Samples& all) {
         each(all, [](Sample& s) {
           for (std::size_t e = 1; e < 16; ++e) s.normalized.elements[e] *= 100;
         });
       }},
      {"zeros",
       [](Samples& all) {
         each(all, [](Sample& s) {
           for (const std::size_t e : {3UL, 7UL, 11UL, 12UL, 13UL, 14UL, 15UL}) s.normalized.elements[e] = 0;
         });
       }},
      {"repeated rows", [](Samples& all) { all.push_back(all[5]), all.push_back(all[7]); }},
  };
  for (const auto& [name, plant] : faults)
    for (const unsigned long seed : {1UL, 3UL}) {
      Samples samples = measured(seed);
      plant(samples);
      const std::string list = found(samples);
      EXPECT_NE(list.find(name), std::string::npos) << "fault " << &name - &faults[0].first << ": " << list;
    }
}

TEST(Inspect, FindsMatricesThatCannotExist) {
  Samples samples = measured(1);
  for (Sample& s : samples) s.normalized = diagonal(1, 0.9, -0.9, 0.9);
  EXPECT_NE(found(samples).find("matrices that cannot exist"), std::string::npos);
}

TEST(Inspect, NamesTheSamples) {
  Samples samples = measured(1);
  samples[16].f11 = -999;
  samples[16].normalized.elements.fill(-999);
  EXPECT_EQ(to_string(row_findings(samples).front()), "fill values: f11 = -999 in 1 sample: 17: leave these rows out");
  const std::vector<long> numbers(samples.size(), 3);
  EXPECT_EQ(row_findings(samples, numbers).front().evidence, "f11 = -999 in 1 sample: 3");
}

TEST(Inspect, NamesFillValuesHoweverManyThereAre) {
  Samples samples = measured(1), whole = samples;
  for (std::size_t i = 0; i < samples.size(); i += 3) {
    samples[i].f11 = -999;
    whole[i].f11 = -999;
    whole[i].normalized.elements.fill(-999);
  }
  for (const Samples& one : {samples, whole})
    EXPECT_EQ(row_findings(one).front().evidence, "f11 = -999 in 134 samples: 1, 4, 7, 10, 13, 16, 19, 22, ...");
}

TEST(Inspect, TellsElementsInPercentFromFillValuesAmongThem) {
  Samples samples = measured(1);
  for (Sample& s : samples)
    for (std::size_t e = 1; e < 16; ++e) s.normalized.elements[e] *= 100;
  samples[4].f11 = -999;
  samples[4].normalized.elements.fill(-999);
  const std::vector<Finding> findings = row_findings(samples);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].evidence, "f11 = -999 in 1 sample: 5");
  EXPECT_EQ(findings[1].fault, "elements not divided");
}

TEST(Inspect, OfF11AloneAsksNothingOfTheOthers) {
  Samples samples = measured(1);
  for (Sample& s : samples)
    for (std::size_t e = 1; e < 16; ++e) s.normalized.elements[e] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(found(samples), "");
  for (Sample& s : samples) s.f11 *= std::numbers::pi;
  EXPECT_EQ(found(samples), "scale of f11");
}

}  // namespace
}  // namespace mmbrdf
