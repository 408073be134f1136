// SPDX-License-Identifier: BSD-3-Clause
// BiRD JSON v1.0: a list of values for each variable; polarization states as letters or Stokes vectors.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "given/foreign.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/quantities.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

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

TEST(Bird, HasAnglesInRadiansAndWavelengthsInMicrometres) {
  const Folder folder;
  Columns c;
  c.directions(0.5, 0.25, 1, 3);
  c.brdf = {"0.3"};
  c.nm = {"0.55"};
  std::string text = file(c);
  const std::string nm = "\"unit\": \"nm\"";
  for (const std::string unit : {"\"deg\"", "\"°\"", "\"deg\"", "\"deg\""})
    text.replace(text.find(unit), unit.size(), "\"rad\"");
  for (const std::string micrometre : {"μm", "µm", "um"}) {
    std::string one = text;
    put(folder / "x", one.replace(one.find(nm), nm.size(), "\"unit\": \"" + micrometre + "\""));
    const ForeignRead read = read_foreign_file(folder / "x");
    ASSERT_EQ(read.samples.size(), 1U);
    EXPECT_EQ(read.samples[0].wavelength, 0.55);
    EXPECT_EQ(read.samples[0].geometry.incident.theta, 0.5);
    EXPECT_EQ(read.samples[0].geometry.incident.phi, 0.25);
    EXPECT_EQ(read.samples[0].geometry.reflected.theta, 1);
    EXPECT_EQ(read.samples[0].geometry.reflected.phi, 3);
  }
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
  EXPECT_TRUE(
      says(refusal([](Columns& c) { c.phi_i[4] = "-1"; }), {"data.phi_i: value 5: -1 degrees, must be in [0, 360]"}));
  const auto replaced = [&](const std::string& what, const std::string& by) {
    std::string text = file(unpolarized());
    put(path, text.replace(text.find(what), what.size(), by));
    return foreign_refusal(path);
  };
  const std::string angle = "\"theta_r\": {\"unit\": \"deg\"", nm = "\"unit\": \"nm\"";
  EXPECT_TRUE(
      says(replaced(angle, "\"theta_r\": {\"unit\": \"grad\""), {"data.theta_r: unit 'grad' is none of deg, °, rad"}));
  EXPECT_TRUE(says(replaced(angle, "\"theta_r\": {\"unit\": 1"), {"data.theta_r: unit '' is none of deg, °, rad"}));
  EXPECT_TRUE(says(replaced("\"theta_r\"", "\"theta_s\""), {"data.theta_r: missing, or without a list of values"}));
  EXPECT_TRUE(says(replaced(angle + ", \"values\": [", angle + ", \"values\": 1, \"other\": ["),
                   {"data.theta_r: missing, or without a list of values"}));
  EXPECT_TRUE(says(replaced(nm, "\"unit\": \"mm\""), {"data.wavelength_i: unit 'mm' is none of nm, μm"}));
  EXPECT_TRUE(
      says(replaced("\"unit\": \"%\"", "\"unit\": \"nm\""), {"data.uBRDF: unit 'nm' is none of 1/sr, sr^-1, sr-1, %"}));
  EXPECT_TRUE(says(replaced("\"wavelength_i\"", "\"wavelength_r\": {\"unit\": \"um\", \"values\": " +
                                                    list(repeated("0.56", 36)) + "}, \"wavelength_i\""),
                   {"data.wavelength_r: value 1: 560 nm is not that of the incident light: fluorescence"}));
  const auto polarized_refusal = [&](const std::string& state, const std::string& notation, bool incident) {
    Columns c = unpolarized();
    (incident ? c.pol_i : c.pol_r) = repeated(state, 36);
    put(path, file(c, notation));
    return foreign_refusal(path);
  };
  EXPECT_TRUE(
      says(polarized_refusal("\"s\"", "letters", true), {"data.polarization_i: notation is neither sp nor inStokes"}));
  EXPECT_TRUE(says(polarized_refusal("[1, 0.5, 0, 0]", "inStokes", false),
                   {"data.polarization_r: value 1: a partial polarization of 0.5 is no analyzer; 0 or 1 are"}));
  for (const std::string state : {"[1, 0, 0]", "[2, 0, 0, 0]", "[1, 1, 1, 0]", "\"s\"", "[1, \"s\", 0, 0]"})
    EXPECT_TRUE(says(polarized_refusal(state, "inStokes", true),
                     {"data.polarization_i: value 1: ", " is no Stokes vector [1, s1, s2, s3]"}))
        << state;
  const std::string whole = file(unpolarized());
  const auto with_unit = [&](const std::string& unit) {
    std::string text = whole;
    put(path, text.replace(text.find("sr^-1"), 5, unit));
  };
  put(path, whole);
  const std::size_t count = read_foreign_file(path).samples.size();
  with_unit("sr-1");
  EXPECT_EQ(read_foreign_file(path).samples.size(), count);
  with_unit("percent");
  EXPECT_TRUE(says(foreign_refusal(path), {"unit 'percent' is none of 1/sr, sr^-1, sr-1"}));
  put(path, R"({"metadata": {"schema": "brdf_json_schema"}, "data": {"theta_i": {"unit": "deg", "values": []}}})");
  EXPECT_TRUE(says(foreign_refusal(path), {"data.theta_i: no values"}));
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

std::string exported(const Export& table) {
  std::ostringstream out;
  table.write(out);
  return out.str();
}

using nlohmann::json;

json exported_json(const Model& model, const ExportOptions& options = {}) {
  return json::parse(exported(Export(model, export_format_of("x.brdf"), options)));
}

Geometry geometry_of(const json& data, std::size_t row) {
  const auto angle = [&](const char* name) { return data[name]["values"][row].get<double>(); };
  return in_degrees(angle("theta_i"), angle("phi_i"), angle("theta_r"), angle("phi_r"));
}

/// f from light in the one state to an analyzer of the other, for those that have a quantity; "" for others.
std::string quantity_of(const json& incident, const json& analyzed) {
  const auto letter = [](const json& state) {
    return state == json{1, 1, 0, 0} ? "s" : state == json{1, -1, 0, 0} ? "p" : "";
  };
  const std::string i = letter(incident), r = letter(analyzed);
  return i.empty() || r.empty() ? "" : "f_" + i + r;
}

TEST(Bird, IsWrittenAsValuesBetweenStatesWithTheirUncertainties) {
  const Model model = material("ptfe-532");
  const json data = exported_json(model)["data"];
  const PreparedModel prepared = prepare(model, 0.532);
  const PreparedUncertainty uncertainty = prepare_uncertainty(model, 0.532);
  const json &incident = data["polarization_i"]["values"], &analyzed = data["polarization_r"]["values"];
  const std::size_t rows = data["BRDF"]["values"].size();
  ASSERT_EQ(rows % 37, 0U);  // u to u, and six states to six
  for (const char* name : {"theta_i", "phi_i", "theta_r", "phi_r", "wavelength_i", "uBRDF"})
    ASSERT_EQ(data[name]["values"].size(), rows) << name;
  const json unpolarized{1, 0, 0, 0};
  std::size_t compared = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const double value = data["BRDF"]["values"][row], known_to = data["uBRDF"]["values"][row];
    ASSERT_GE(value, 0);
    ASSERT_GT(known_to, 0);
    const std::string name = quantity_of(incident[row], analyzed[row]);
    const bool is_f11 = incident[row] == unpolarized;
    if (row % 5 != 0 || (name.empty() && !is_f11)) continue;
    const Geometry geometry = geometry_of(data, row);
    const Mueller m = prepared.evaluate(geometry, Frame::sp);
    const MuellerCovariance covariance = uncertainty.evaluate(geometry, Frame::sp);
    const Mueller slopes = is_f11 ? Mueller{{1}} : quantity(name).gradient(m, {});
    double variance = 0;
    for (std::size_t e = 0; e < 16; ++e)
      for (std::size_t f = 0; f < 16; ++f) variance += slopes.elements[e] * slopes.elements[f] * covariance(e, f);
    ASSERT_NEAR(value, is_f11 ? m(0, 0) : quantity(name).value(m, {}), 1e-8);  // eight digits
    ASSERT_NEAR(known_to, std::sqrt(variance), 5e-4 * known_to);               // four
    ++compared;
  }
  EXPECT_GE(compared, 1000U);
}

TEST(Bird, ThatIsWrittenHasAnglesThatTheSchemaTakes) {
  const json data = exported_json(material("ptfe-532"))["data"];
  for (const char* name : {"theta_i", "phi_i", "theta_r", "phi_r"}) {
    EXPECT_EQ(data[name]["unit"], "deg");
    EXPECT_EQ(data[name]["name"], name);
    for (const json& angle : data[name]["values"]) {
      ASSERT_GE(angle.get<double>(), 0);
      ASSERT_LT(angle.get<double>(), name[0] == 't' ? 90 : 360);
    }
  }
  EXPECT_EQ(data["uBRDF"]["name"], "BRDF");  // so the schema wants it
  EXPECT_EQ(data["BRDF"]["unit"], "1/sr");
  EXPECT_EQ(data["polarization_i"]["notation"], "inStokes");
  // Within the fit: sources up to 75 degrees.
  for (const json& angle : data["theta_i"]["values"]) ASSERT_LE(angle.get<double>(), 75);
}

TEST(Bird, ThatIsWrittenHasAllMetadataThatTheSchemaAsksFor) {
  ::setenv("SOURCE_DATE_EPOCH", "1000000000", 1);
  const json first = exported_json(material("ptfe-532")), again = exported_json(material("ptfe-532")),
             other = exported_json(material("ptfe-633"));
  EXPECT_EQ(first, again);  // the same at the same time
  const json& metadata = first["metadata"];
  for (const char* name : {"schema", "id", "type", "timestamp", "provenance", "description", "method",
                           "instrumentation", "software", "sample", "environment"})
    EXPECT_TRUE(metadata.contains(name)) << name;
  EXPECT_EQ(metadata["timestamp"], "2001-09-09T01:46:40+00:00");
  EXPECT_EQ(metadata["type"], "BRDF");
  EXPECT_EQ(metadata["method"], "simulation");
  const std::string id = metadata["id"];
  EXPECT_EQ(id.substr(0, 9), "urn:uuid:");
  EXPECT_EQ(id.size(), 45U);
  EXPECT_NE(id, other["metadata"]["id"]);
  for (const char* name : {"organization", "location", "email", "contact_person"})
    EXPECT_TRUE(metadata["provenance"].contains(name)) << name;
  for (const char* name : {"country", "city", "street", "building_nr", "postal_code"})
    EXPECT_TRUE(metadata["provenance"]["location"].contains(name)) << name;
  for (const char* name : {"name", "type", "dimensions", "shape", "zero_azimuth_location"})
    EXPECT_TRUE(metadata["sample"].contains(name)) << name;
  EXPECT_TRUE(says(metadata["provenance"]["comments"], {"Germer"}));
  Model scalar = diffuser({0.3});
  scalar.not_measured = ~Elements{1};
  const auto refusal = [&](const char* epoch) {
    ::setenv("SOURCE_DATE_EPOCH", epoch, 1);
    return export_refusal(scalar, "bird", {.wavelengths = {0.5}});
  };
  EXPECT_TRUE(says(refusal("yesterday"), {"SOURCE_DATE_EPOCH = 'yesterday': must be whole"}));
  EXPECT_TRUE(says(refusal("-1"), {"SOURCE_DATE_EPOCH = '-1': must be whole seconds since 1970"}));
  ::unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_GT(exported_json(scalar, {.wavelengths = {0.5}})["metadata"]["timestamp"].get<std::string>(), "2026");
}

TEST(Bird, ThatIsWrittenIsReadBackAsTheModel) {
  const Folder folder;
  const Model model = material("ptfe");
  put(folder / "x", exported(Export(model, export_format("bird"), {.wavelengths = {0.45, 0.532}})));
  const ForeignRead read = read_foreign_file(folder / "x");
  EXPECT_GE(read.samples.size(), 2000U);
  const std::array prepared{prepare(model, 0.45), prepare(model, 0.532)};
  for (const Sample& sample : read.samples) {
    const Mueller expected = prepared[sample.wavelength > 0.5].evaluate(sample.geometry);
    EXPECT_EQ(not_measured(sample).count(), 0U);
    for (std::size_t e = 0; e < 16; ++e)
      ASSERT_NEAR(sample.f11 * sample.normalized.elements[e], expected.elements[e], 1e-7 * expected(0, 0))
          << element_name(e);  // eight digits of each value
  }
}

TEST(Bird, IsWrittenWithTheStatesThatTheModelKnows) {
  Model model = diffuser({0.3});
  const auto all_but = [](int rows) {
    Elements unknown;
    for (std::size_t e = 0; e < 16; ++e) unknown[e] = int(e / 4) >= rows || int(e % 4) >= rows;
    return unknown;
  };
  const auto pairs = [&](int rows) {
    model.not_measured = all_but(rows);
    const json data = exported_json(model, {.wavelengths = {0.5}})["data"];
    EXPECT_EQ(data.contains("polarization_i"), rows > 2);
    EXPECT_FALSE(data.contains("uBRDF"));  // this model knows none
    for (std::size_t row = 0; row < data["BRDF"]["values"].size(); ++row) {
      const bool open = rows <= 2 || data["polarization_r"]["values"][row] == json{1, 0, 0, 0};
      EXPECT_NEAR(data["BRDF"]["values"][row].get<double>(), open ? 0.3 : 0.15, 1e-8);  // an analyzer passes half
    }
    std::size_t same = 0;  // rows of the first geometry, along the normal
    while (same < data["theta_r"]["values"].size() && data["theta_r"]["values"][same] == 0.0) ++same;
    return same;
  };
  EXPECT_EQ(pairs(1), 1U);
  EXPECT_EQ(pairs(2), 1U);  // 12 and 22 of the frame xy alone are not those of the frame sp
  EXPECT_EQ(pairs(3), 1U + 16);
  EXPECT_EQ(pairs(4), 1U + 36);
}

TEST(Bird, IsWrittenWithoutWhatIsNegative) {
  const Model model = random_model(Family::isotropic, {4, 3}, 0, 3);  // of matrices that mostly cannot exist
  const Export table(model, export_format("bird"), {.wavelengths = {0.5}});
  EXPECT_TRUE(says(table.understood(), {"geometries left out, where a value is negative", "nothing is interpolated"}));
  EXPECT_EQ(table.understood().find("adds"), std::string::npos);
  EXPECT_TRUE(says(export_refusal(diffuser({-0.3}), "bird", {.wavelengths = {0.5}}), {"a BiRD file has no negative"}));
}

TEST(Bird, ThatIsWrittenSaysWhichWavelengthsAreInIt) {
  // 0.55 − λ: negative at 600 nm everywhere.
  const Export table(diffuser({0.55, -1}), export_format("bird"), {.wavelengths = {0.5, 0.6}});
  const std::string text = table.understood();
  EXPECT_NE(text.find(" geometries at 500 nm, "), std::string::npos) << text;
  EXPECT_TRUE(says(text, {" left out, where a value is negative; no geometry left at 600 nm"}));
}

/// A diffuser fitted to what one pair of polar angles supports, in the plane of incidence.
Model fitted_at(double theta_i, double theta_r, double theta_i_max) {
  Model model = diffuser({0.3});
  model.validity = {{0.5}, radians(theta_i_max), radians(theta_r), {{0.5, DirectionPairs()}}};
  model.validity.supported[0].pairs.add(in_degrees(theta_i, 0, theta_r, 180));
  return model;
}

TEST(Bird, IsWrittenAtTheAnglesThatWereFittedWhateverTheyAre) {
  const auto data = [](const Model& model) { return exported_json(model)["data"]; };
  EXPECT_EQ(data(fitted_at(40, 20, 40))["theta_i"]["values"][0], 40);  // the largest, beside those by 15 degrees
  EXPECT_EQ(data(fitted_at(3, 3, 3))["theta_i"]["values"][0], 3);
  const Model inner = fitted_at(20, 40, 60);  // the nodes of the samples, where no usual one is supported
  EXPECT_EQ(data(inner)["theta_i"]["values"][0], 20);
  EXPECT_TRUE(says(Export(inner, export_format("bird")).understood(), {"1 geometry at 500 nm"}));
  Model none = inner;
  none.validity.supported = {{0.5, DirectionPairs()}};
  EXPECT_TRUE(says(export_refusal(none, "bird"), {"no samples support any of the directions of a BiRD file"}));
}

TEST(Bird, ThatIsWrittenSaysWhichElementsItLeavesOut) {
  Model model = random_model(Family::isotropic, {2, 1}, 0, 1);
  std::erase_if(model.blocks, [](const FittedBlock& fitted) {
    return fitted.block.name != "11" && fitted.block.name != "12,13,21,31";
  });
  model.not_measured = ~Elements{};
  for (const std::size_t e : {0U, 1U, 2U, 4U, 8U}) model.not_measured.reset(e);
  const Export table(model, export_format("bird"), {.wavelengths = {0.5}});
  EXPECT_TRUE(says(table.understood(), {"f11 in sr^-1", "; not written: 12, 13, 21 and 31, which these states tell"}));
}

TEST(Bird, IsWrittenOfAnisotropicSamplesAtAzimuthsOfTheSource) {
  const Model model = random_model(Family::anisotropic, {1, 0}, 0, 1);
  const json data = exported_json(model, {.wavelengths = {0.5}})["data"];
  const PreparedModel prepared = prepare(model, 0.5);
  double largest = 0;
  for (std::size_t row = 0; row < data["BRDF"]["values"].size(); row += 37) {
    largest = std::max(largest, data["phi_i"]["values"][row].get<double>());
    ASSERT_NEAR(data["BRDF"]["values"][row].get<double>(), prepared.f11(geometry_of(data, row)), 1e-8);
  }
  EXPECT_EQ(largest, 315);
}

}  // namespace
}  // namespace mmbrdf
