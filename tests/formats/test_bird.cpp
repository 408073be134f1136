// SPDX-License-Identifier: BSD-3-Clause
// BiRD JSON v1.0: a list of values for each variable; polarization states as letters or Stokes vectors.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "given/foreign.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf {
namespace {

std::string number(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

std::string list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
  return "[" + text + "]";
}

struct Columns {
  std::vector<std::string> theta_i, phi_i, theta_r, phi_r, brdf, u, nm, pol_i, pol_r;
  void directions(double ti, double pi, double tr, double pr) {
    theta_i.push_back(number(ti));
    phi_i.push_back(number(pi));
    theta_r.push_back(number(tr));
    phi_r.push_back(number(pr));
  }
};

std::string file(const Columns& c, const std::string& notation = "sp") {
  const auto variable = [](const char* name, const char* unit, const std::vector<std::string>& values) {
    return ",\n\"" + std::string(name) + "\": {\"unit\": \"" + unit + "\", \"values\": " + list(values) + "}";
  };
  std::string text =
      R"({"metadata": {"schema": "https://example.org/brdf_json_schema_v1.0.json", "type": "measurement"},
"data": {"theta_i": {"unit": "deg", "values": )" +
      list(c.theta_i) + "}" + variable("phi_i", "°", c.phi_i) + variable("theta_r", "deg", c.theta_r) +
      variable("phi_r", "deg", c.phi_r) + variable("BRDF", "sr^-1", c.brdf);
  if (!c.u.empty()) text += variable("uBRDF", "%", c.u);
  if (!c.nm.empty()) text += variable("wavelength_i", "nm", c.nm);
  for (const auto& [name, values] : {std::pair{"polarization_i", &c.pol_i}, std::pair{"polarization_r", &c.pol_r}})
    if (!values->empty())
      text +=
          ",\n\"" + std::string(name) + "\": {\"notation\": \"" + notation + "\", \"values\": " + list(*values) + "}";
  return text + "}}\n";
}

Columns unpolarized() {
  Columns c;
  for (const double ti : {0.0, 30.0, 60.0})
    for (const double tr : {10.0, 45.0, 89.99995})
      for (const double pr : {0.0, 100.0, 200.0, 359.0}) {
        c.directions(ti, 20, tr, pr);
        c.brdf.push_back(number(oriented(at(ti * degree, 20 * degree), at(tr * degree, pr * degree))));
        c.u.push_back("2");
        c.nm.push_back("550");
      }
  return c;
}

TEST(Bird, GivesTheBrdfOfUnpolarizedLightWithItsUncertainty) {
  const Folder folder;
  put(folder / "x", file(unpolarized()));
  const ForeignRead read = read_foreign_file(folder / "x");
  ASSERT_EQ(read.samples.size(), 24U);
  expect_values(read.samples, oriented, 1e-15);
  for (const Sample& s : read.samples) {
    EXPECT_NEAR(s.uncertainty(0, 0), 0.02 * s.f11, 1e-15);
    EXPECT_EQ(not_measured(s).count(), 15U);
  }
  EXPECT_EQ(read.understood,
            "a BiRD JSON file: uBRDF in % is its standard uncertainty, f11 in sr^-1; 12 of 36 geometries "
            "at or below the horizon passed over");
}

/// Of the states with these Stokes vectors: w M a, half of it behind an analyzer, with M in the frame sp and S4 > 0
/// right-handed.
Columns polarized(const PreparedModel& model, const std::vector<Stokes>& incident,
                  const std::vector<Stokes>& analyzed) {
  Columns c;
  const auto vector = [](const Stokes& s) { return list({number(s[0]), number(s[1]), number(s[2]), number(s[3])}); };
  for (const Stokes& w : analyzed)
    for (const double ti : {15.0, 50.0})
      for (const double tr : {20.0, 65.0})
        for (const double pr : {0.0, 75.0, 180.0, 300.0})
          for (const Stokes& a : incident) {
            c.directions(ti, 0, tr, pr);
            const Geometry g = in_degrees(ti, 0, tr, pr);
            Mueller m = change_frame(model.evaluate(g), g, Frame::xy, Frame::sp);
            for (int k = 0; k < 3; ++k) m(3, k) = -m(3, k), m(k, 3) = -m(k, 3);
            double value = 0;
            for (int i = 0; i < 4; ++i)
              for (int k = 0; k < 4; ++k)
                value += w[static_cast<std::size_t>(i)] * m(i, k) * a[static_cast<std::size_t>(k)];
            c.brdf.push_back(number(value * (std::abs(w[1]) + std::abs(w[2]) + std::abs(w[3]) > 0 ? 0.5 : 1)));
            c.nm.push_back("532");
            c.pol_i.push_back(vector(a));
            c.pol_r.push_back(vector(w));
          }
  return c;
}

const Stokes u{1, 0, 0, 0}, s{1, 1, 0, 0}, p{1, -1, 0, 0}, diagonal_state{1, 0, 1, 0}, right{1, 0, 0, 1};

TEST(Bird, GivesAllElementsOfSixteenPairsOfStates) {
  const Folder folder;
  const Model model = random_model(Family::isotropic, {5, 4}, 0, 2);
  const PreparedModel prepared = prepare(model, 0.532);
  put(folder / "x",
      file(polarized(prepared, {s, p, diagonal_state, right}, {s, p, diagonal_state, right}), "inStokes"));
  const ForeignRead read = read_foreign_file(folder / "x");
  ASSERT_EQ(read.samples.size(), 16U);
  for (const Sample& sample : read.samples) {
    const Mueller expected = prepared.evaluate(sample.geometry);
    for (std::size_t e = 0; e < 16; ++e)
      ASSERT_NEAR(sample.f11 * sample.normalized.elements[e], expected.elements[e], 1e-13) << element_name(e);
  }
}

TEST(Bird, LeavesUnknownWhatStatesDoNotDetermine) {
  const Folder folder;
  const PreparedModel prepared = prepare(random_model(Family::isotropic, {5, 4}, 0, 2), 0.532);
  put(folder / "x", file(polarized(prepared, {s, p}, {u}), "inStokes"));
  const ForeignRead read = read_foreign_file(folder / "x");
  ASSERT_EQ(read.samples.size(), 16U);
  for (const Sample& sample : read.samples) {
    const Mueller expected = prepared.evaluate(sample.geometry);
    EXPECT_NEAR(sample.f11, expected(0, 0), 1e-14);
    EXPECT_EQ(not_measured(sample).count(), 14U);  // at phi_i = 0 the axes of incident light stay as they are
    EXPECT_NEAR(sample.f11 * sample.normalized(0, 1), expected(0, 1), 1e-14);
  }
  put(folder / "one", file(polarized(prepared, {s}, {u}), "inStokes"));
  EXPECT_TRUE(says(foreign_refusal(folder / "one"), {"one: data.polarization_i: the states determine f11 nowhere"}));
}

std::vector<std::string> repeated(const std::string& one, std::size_t times) {
  return std::vector<std::string>(times, one);
}

/// One geometry in the plane of incidence, where the frames sp and xy differ by signs alone.
std::vector<Sample> from_states(const Folder& folder, const std::vector<std::string>& incident,
                                const std::vector<std::string>& brdf, const std::vector<std::string>& percent = {}) {
  Columns c;
  for (std::size_t n = 0; n < brdf.size(); ++n) c.directions(30, 0, 40, 180);
  c.brdf = brdf;
  c.u = percent;
  c.nm = repeated("550", brdf.size());
  c.pol_i = incident;
  put(folder / "x", file(c, "inStokes"));
  return read_foreign_file(folder / "x").samples;
}

TEST(Bird, LeavesUnknownWhatNearlyDependentStatesWouldTellByTheirErrors) {
  const Folder folder;
  const std::vector<Sample> samples =
      from_states(folder, {"[1, 0, 1, 0]", "[1, 1e-4, 1, 0]", "[1, 0, -1, 0]"}, {"0.31", "0.313", "0.29"});
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_NEAR(samples[0].f11, 0.3, 0.002);
  EXPECT_TRUE(std::isnan(samples[0].normalized(0, 1)));
  EXPECT_FALSE(std::isnan(samples[0].normalized(0, 2)));
}

TEST(Bird, TakesStatesThatAreNotQuiteSAndP) {
  const Folder folder;
  const std::vector<Sample> samples =
      from_states(folder, {"[1, 0.9998, 0.003, 0.001]", "[1, -0.9995, 0.004, -0.002]"}, {"0.36", "0.24"});
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_NEAR(samples[0].f11, 0.3, 0.001);
  EXPECT_NEAR(std::abs(samples[0].normalized(0, 1)), 0.2, 0.001);
  EXPECT_EQ(not_measured(samples[0]).count(), 14U);
}

TEST(Bird, KnowsNoUncertaintyWhereThatOfOneStateIsNotKnown) {
  const Folder folder;
  const std::vector<std::string> states{"[1, 1, 0, 0]", "[1, -1, 0, 0]"};
  EXPECT_GT(from_states(folder, states, {"0.36", "0.24"}, {"1", "1"}).at(0).uncertainty(0, 1), 0);
  const Sample unknown = from_states(folder, states, {"0.36", "0.24"}, {"1", "0"}).at(0);
  for (const double one : unknown.uncertainty.elements) EXPECT_EQ(one, 0);
}

TEST(Bird, IsRefusedInOneLineIfItIsCutOffOrWrong) {
  const Folder folder;
  const std::string path = folder / "x";
  put(path, file(unpolarized()));
  expect_refused_where_cut(path);
  const auto refusal = [&](const std::function<void(Columns&)>& change) {
    Columns c = unpolarized();
    change(c);
    put(path, file(c));
    return foreign_refusal(path);
  };
  EXPECT_TRUE(says(refusal([](Columns& c) { c.nm.clear(); }), {"x: does not say the wavelength of its values"}));
  EXPECT_TRUE(says(refusal([](Columns& c) { c.nm[3] = "0.55"; }), {"x: data.wavelength_i: 0.55 nm is no wavelength"}));
  EXPECT_TRUE(says(refusal([](Columns& c) { c.theta_r[1] = "95"; }),
                   {"data.theta_r: value 2: 95 degrees, must be in [0, 90]"}));
  EXPECT_TRUE(says(refusal([](Columns& c) { c.brdf.pop_back(); }), {"data.BRDF: 35 values, but theta_i has 36"}));
  EXPECT_TRUE(says(refusal([](Columns& c) { c.brdf[0] = "null"; }), {"data.BRDF: value 1: null is no finite number"}));
  EXPECT_TRUE(says(refusal([](Columns& c) { c.u[0] = "-1"; }), {"data.uBRDF: value 1 is negative"}));
  EXPECT_TRUE(says(refusal([](Columns& c) { c.pol_i.assign(36, "\"x\""); }),
                   {"data.polarization_i: value 1: \"x\" is none of s, p, u"}));
  put(path, R"({"metadata": {"schema": "brdf_json_schema"}, "data": {"theta_i": {"unit": "deg", "values": [[]]}}})");
  EXPECT_TRUE(says(foreign_refusal(path), {"data.theta_i: value 1: [] is no finite number"}));
  put(path, R"({"metadata": {"schema": "brdf_json_schema"}})");
  EXPECT_TRUE(says(foreign_refusal(path), {"no object data"}));
}

TEST(Bird, IsToldByItsFirstKeyAndAVariableHoweverLongItsListsAre) {
  const std::string list = R"(": {"unit": "deg", "values": [)" + std::string(2 * foreign_head, '1') + "]}";
  for (const std::string first : {"theta_r", "BRDF", "wavelength_i"}) {
    const std::string text = "{ \"data\" : {\"" + first + list + "}, \"metadata\": {}}";
    EXPECT_EQ(foreign_format(text, text.size()), "a BiRD JSON file") << first;
  }
  for (const std::string said : {R"("description": "simulated by \"mmbrdf simulate\"")", R"("tool": "mmbrdf 1")"}) {
    const std::string text = "{\"metadata\": {" + said + "}, \"data\": {\"theta_i" + list + "}}";
    EXPECT_EQ(foreign_format(text, text.size()), "a BiRD JSON file") << said;
  }
  const std::string other = R"({"data": {"x": [1, 2]}})";
  EXPECT_EQ(foreign_format(other, other.size()), "");
}

TEST(Bird, IsNoModelThatNamesOne) {
  const std::string model = R"({"format": "mmbrdf model", "provenance": {"data": "brdf_json_schema"}})";
  EXPECT_EQ(foreign_format(model, model.size()), "");
}

}  // namespace
}  // namespace mmbrdf
