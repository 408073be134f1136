// SPDX-License-Identifier: BSD-3-Clause
// What inspect() finds in simulated measurements of PTFE with noise, with one fault each, and without.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

TEST(Inspect, NamesTheOptionThatMendsAFrame) {
  for (const Frame frame : {Frame::sp, Frame::scattering_plane}) {
    Samples samples = measured(1);
    read_as(samples, frame);
    EXPECT_EQ(inspect(samples).findings.at(0).option, "--frame " + to_string(frame));
  }
  Samples samples = measured(1);
  each(samples, [](Sample& s) { s.f11 *= 100; });
  EXPECT_EQ(inspect(samples).findings.at(0).option, "");
}

using Change = std::function<void(Sample&)>;

/// As a table gives them whose matrices are in a frame, with a fault in its numbers.
Samples given_in(
    Frame frame, Samples samples, const Change& fault = [](Sample&) {}) {
  each(samples, [&](Sample& s) {
    s = in_frame(s, frame);
    fault(s);
    s = from_frame(s, frame);
  });
  return samples;
}

/// Intensities of s and p alone.
void keep_s_and_p(Sample& s) {
  for (const std::size_t e : {2UL, 3UL, 6UL, 7UL, 8UL, 9UL, 10UL, 11UL, 12UL, 13UL, 14UL, 15UL})
    s.normalized.elements[e] = std::numeric_limits<double>::quiet_NaN();
}

TEST(Inspect, FindsNothingInCleanMeasurementsOfOtherFrames) {
  for (unsigned long seed = 0; seed < 12; ++seed) {
    const Samples samples = measured(300 + 2 * seed, seed % 2 ? "ptfe" : "ptfe-532", seed % 3 ? 0.006 : 0.02);
    for (const Frame frame : {Frame::sp, Frame::scattering_plane})
      EXPECT_EQ(found(given_in(frame, samples)), "") << seed << to_string(frame);
    EXPECT_EQ(found(given_in(Frame::sp, samples, keep_s_and_p)), "") << seed;
  }
}

void reverse_in(Sample& s, std::initializer_list<std::size_t> components, bool scattered, bool incident) {
  Samples one{s};
  for (const std::size_t component : components) reverse(one, component, scattered, incident);
  s = one.front();
}

void turn_azimuths(Sample& s) {
  for (Direction* d : {&s.geometry.incident, &s.geometry.reflected}) d->phi = -d->phi;
}

struct PlantedInFrame {
  const char *evidence, *remedy;
  Change plant;
};

const PlantedInFrame faults_of_frames[] = {
    {"read as S3 of the source reversed", "Change the signs of 13, 23, 33 and 43",
     [](Sample& s) { reverse_in(s, {2}, false, true); }},
    {"read as S3 and S4 of the receiver reversed", "does a dial there turn the other way?",
     [](Sample& s) {
       reverse_in(s, {2, 3}, true, false);
     }},
    {"read as S2 of the receiver reversed", "were s and p exchanged there?",
     [](Sample& s) { reverse_in(s, {1}, true, false); }},
    {"azimuths counted the other way", "multiply phi_i and phi_r by -1", turn_azimuths},
    {"read as arms exchanged", "--columns theta_i_deg=", [](Sample& s) { s.geometry = exchanged(s.geometry); }},
};

TEST(Inspect, FindsEachFaultOfSignsInTheFrameOfTheTable) {
  for (const auto& [evidence, remedy, plant] : faults_of_frames)
    for (const unsigned long seed : {1UL, 3UL}) {
      const std::vector<Finding> findings = inspect(given_in(Frame::sp, measured(seed), plant)).findings;
      const std::string text = findings.empty() ? "" : to_string(findings.back());
      EXPECT_NE(text.find(evidence), std::string::npos) << evidence << ": " << text;
      EXPECT_NE(text.find(remedy), std::string::npos) << text;
    }
}

TEST(Inspect, FindsThatATableIsReadInAnotherFrameThanItsOwn) {
  const std::array frames{Frame::xy, Frame::sp, Frame::scattering_plane};
  for (const Frame own : frames)
    for (const Frame read : frames) {
      if (own == read) continue;
      Samples samples = measured(1, "ptfe-532", 0.003);
      each(samples, [&](Sample& s) { s = from_frame(in_frame(s, own), read); });
      const std::vector<Finding> findings = inspect(samples).findings;
      ASSERT_FALSE(findings.empty()) << to_string(own) << " as " << to_string(read);
      EXPECT_EQ(findings.back().remedy, "--frame " + to_string(own)) << to_string(read);
    }
}

TEST(Inspect, FindsMatricesThatCannotExist) {
  Samples samples = measured(1);
  for (Sample& s : samples) s.normalized = diagonal(1, 0.9, -0.9, 0.9);
  EXPECT_NE(found(samples).find("matrices that cannot exist"), std::string::npos);
}

TEST(Inspect, TakesNoNoiseOfDarkSamplesForMatricesThatCannotExist) {
  Samples samples = measured(1);
  for (std::size_t i = 0; i < samples.size(); i += 4) {
    samples[i].f11 *= 0.01;
    samples[i].normalized = diagonal(1, 0.9, -0.9, 0.9);
  }
  EXPECT_EQ(found(samples).find("matrices that cannot exist"), std::string::npos);
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

TEST(Inspect, NamesFillValuesOfF11AloneByTheirStandingAlone) {
  for (const bool scalar : {false, true})
    for (const double fill : {-1.0, 0.0, -0.01, 9.0}) {
      Samples samples = measured(1);
      if (scalar)
        each(samples, [](Sample& s) { s.normalized.elements.fill(std::numeric_limits<double>::quiet_NaN()); });
      for (std::size_t i = 0; i < 5; ++i) samples[17 * i].f11 = fill;
      const Inspection seen = inspect(samples);
      ASSERT_EQ(found(samples), "fill values") << scalar << fill;
      EXPECT_EQ(seen.findings[0].samples.size(), 5U);
      EXPECT_LT(seen.f11_residual, 0.02);
    }
  Samples two = measured(1), noise = measured(1), dark = measured(1);
  two[0].f11 = two[1].f11 = 0;  // chance
  noise[0].f11 = noise[1].f11 = noise[2].f11 = 0, noise[3].f11 = -0.001;
  EXPECT_EQ(found(two).find("fill"), std::string::npos);
  EXPECT_EQ(found(noise).find("fill"), std::string::npos);
  for (std::size_t i = 0; i < dark.size(); ++i)
    dark[i].f11 = std::round(static_cast<double>(i % 40)) * 1e-4;  // counted
  EXPECT_EQ(found(dark).find("fill"), std::string::npos);
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

/// As if angles in radians were called degrees.
void in_radians(Samples& samples) {
  each(samples, [](Sample& s) {
    for (Direction* d : {&s.geometry.incident, &s.geometry.reflected})
      *d = {radians(d->theta), radians(std::remainder(d->phi, 2 * std::numbers::pi))};
  });
}

Samples in_plane_of(Samples samples) {
  std::erase_if(samples, [](const Sample& s) { return side(s.geometry) != plane_of_incidence; });
  return samples;
}

Samples on_grid() { return simulate(material("ptfe-532"), std::vector{0.532}, germer2017_grid(), 0.006, 1); }

TEST(Inspect, TellsAnglesInRadiansFromDegreesAndNothingElseThen) {
  for (Samples samples : {measured(1), measured(3, "ptfe"), on_grid(), in_plane_of(on_grid())}) {
    EXPECT_EQ(found(samples), "");
    in_radians(samples);
    EXPECT_EQ(found(samples), "angles in radians") << samples.size();
    EXPECT_EQ(inspect(samples).untested.size(), 4U);
  }
}

/// Of a cone around the normal and azimuths close to the plane of incidence, with a peak of `width` degrees.
Samples narrow(double width, double phi_max, double speckle, unsigned long seed) {
  Samples samples =
      simulate(material("ptfe-532"), std::vector{0.532}, random_geometries(200, seed, radians(1.5)), speckle, seed);
  double phase = 0;
  for (Sample& s : samples) {
    s.geometry.incident.phi = 0;
    s.geometry.reflected.phi = radians(phi_max) * std::sin(phase += 2.4);
    const double x = degrees(s.geometry.incident.theta - s.geometry.reflected.theta);
    s.f11 *= 0.01 + std::exp(-x * x / (width * width));
  }
  return samples;
}

TEST(Inspect, TakesNoNarrowConeForRadians) {
  for (const double width : {0.2, 1.0, 5.0})
    for (const double phi_max : {0.0, 6.2})
      for (const double speckle : {0.0, 0.03})
        EXPECT_EQ(found(narrow(width, phi_max, speckle, 5)), "") << width << " " << phi_max << " " << speckle;
  Mueller unknown;
  unknown.elements.fill(std::numeric_limits<double>::quiet_NaN());
  unknown(0, 0) = 1;
  Samples scan;  // in the plane of incidence, in steps of 0.05 degrees
  for (int i = -30; i <= 30; ++i)
    for (const double theta_i : {0.0, 0.25, 0.5, 0.75, 1.0})
      scan.push_back({.wavelength = 0.532,
                      .geometry = {direction_from_degrees(theta_i, 0), direction_from_degrees(0.05 * i, 0)},
                      .f11 = 0.3 + std::exp(-0.1 * (i - 20 * theta_i) * (i - 20 * theta_i)),
                      .normalized = unknown});
  EXPECT_EQ(found(scan), "");
}

std::string untested(const Samples& samples) {
  std::string list;
  for (const Untested& one : inspect(samples).untested) list += (list.empty() ? "" : ", ") + one.fault;
  return list;
}

TEST(Inspect, SaysWhatFewSamplesCannotTell) {
  Samples few = measured(1);
  few.resize(3);
  EXPECT_EQ(found(few), "");
  const Inspection seen = inspect(few);
  EXPECT_EQ(to_string(seen.untested.front()),
            "cannot be told: scale of f11: 3 samples, of 60 that it takes to know a reflectance");
  EXPECT_NE(untested(few).find("cosine"), std::string::npos);
  EXPECT_NE(untested(few).find("frame or signs"), std::string::npos);
  EXPECT_EQ(verdict_line(seen), "nothing seems to be wrong, as far as can be told");
}

TEST(Inspect, SaysThatACosineCannotBeToldFromOneAngleOfIncidence) {
  EXPECT_EQ(untested(on_grid()).find("cosine"), std::string::npos);
  Samples samples = on_grid();
  std::erase_if(samples, [](const Sample& s) { return std::abs(degrees(s.geometry.incident.theta) - 45) > 1; });
  EXPECT_NE(untested(samples).find("cosine"), std::string::npos);
}

// 0.1 + 20 exp(-(angle of the half direction / 2 degrees)^2) / (4 cos cos) reflects 0.4, and up to 0.8 at 80 degrees. A fit
// of low order leaves 87 % of it, and makes up to 1.4 of it on other grids.
TEST(Inspect, TakesNoReflectanceFromANarrowPeak) {
  Samples peak = on_grid();
  each(peak, [](Sample& s) {
    const auto [i, r] = s.geometry;
    const double across = std::cos(r.phi - i.phi), ci = std::cos(i.theta), cr = std::cos(r.theta),
                 both = ci * cr + std::sin(i.theta) * std::sin(r.theta) * across,
                 half = std::acos(std::min(1.0, (ci + cr) / std::sqrt(2 + 2 * both)));
    s.f11 = 0.1 + 20 * std::exp(-std::pow(half / radians(2), 2)) / (4 * ci * cr);
    s.normalized.elements.fill(std::numeric_limits<double>::quiet_NaN());
  });
  EXPECT_EQ(found(peak), "");
  EXPECT_NE(untested(peak).find("scale of f11"), std::string::npos);
}

TEST(Inspect, TakesNoReflectanceFromHalfAHemisphere) {
  Samples half = on_grid();
  std::erase_if(half,
                [](const Sample& s) { return std::cos(s.geometry.reflected.phi - s.geometry.incident.phi) <= 0; });
  EXPECT_EQ(found(half), "");
  EXPECT_NE(untested(half).find("scale of f11"), std::string::npos);
}

TEST(Inspect, SaysThatNoiseHidesTheFrame) {
  const Inspection noisy = inspect(measured(1, "ptfe-532", 0.05));
  ASSERT_EQ(noisy.untested.size(), 1U);
  EXPECT_EQ(noisy.untested.front().reason, "residuals would be less than 1.5 times as large however it is read");
}

TEST(Inspect, GivesTheHoleInNumbersAndTheResidualOfEachSample) {
  Samples samples = on_grid();
  EXPECT_FALSE(inspect(samples).hole_at.phi);
  std::erase_if(samples, [](const Sample& s) {
    return std::abs(std::remainder(s.geometry.reflected.phi - s.geometry.incident.phi, 2 * std::numbers::pi)) <
           radians(90.0 - 1e-6);
  });
  samples[7].f11 = -999;
  const Inspection seen = inspect(samples);
  ASSERT_TRUE(seen.hole_at.phi);
  EXPECT_EQ(seen.hole_at.phi->from, 0);
  EXPECT_NEAR(seen.hole_at.phi->to, 70, 10);  // samples count as far as the next nodes, 10 degrees apart
  EXPECT_NE(seen.hole.find("phi_r - phi_i 0 to " + std::to_string(std::lround(seen.hole_at.phi->to))),
            std::string::npos);
  EXPECT_EQ(seen.findings.front().samples, std::vector<std::size_t>{7});
  ASSERT_EQ(seen.residuals.size(), samples.size());
  double squares = 0, all = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(std::isnan(seen.residuals[i]), i == 7);
    if (i == 7) continue;
    squares += seen.residuals[i] * seen.residuals[i];
    all += samples[i].f11 * samples[i].f11;
  }
  // The fit is to 1500 samples at most: here to all.
  EXPECT_NEAR(std::sqrt(squares / all), seen.f11_residual, 1e-9);
}

}  // namespace
}  // namespace mmbrdf
