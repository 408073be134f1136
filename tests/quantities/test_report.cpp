// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "given/cases.hpp"
#include "given/least_squares.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/fitting/leverage.hpp"
#include "mmbrdf/fitting/symmetry.hpp"
#include "mmbrdf/mixed/sample_traits.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/fit_warnings.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array green{0.532};

const std::vector<std::string> of_the_model{"title",         "warnings",    "notes",        "model",  "fit",
                                            "realizability", "uncertainty", "reflectances", "budgets"};
const std::vector<std::string> of_samples{"data",        "directions",  "residuals",       "chi_squared",
                                          "conventions", "reciprocity", "mirror_symmetry", "dependence_on_phi_i",
                                          "noise",       "repeats",     "leverage",        "outliers"};

std::vector<std::string> names(const Json& object) {
  std::vector<std::string> result;
  for (const auto& [name, value] : object.items()) result.push_back(name);
  return result;
}

Json report(const Model& model, std::span<const double> wavelengths = {}) {
  return Json::parse(report_json(model, "it", wavelengths));
}

Json report(const Model& model, std::span<const Sample> samples) {
  return Json::parse(report_json(model, "it", {}, ReportedSamples{"data.csv", samples}));
}

/// Of all azimuths, with noise.
std::vector<Sample> measured(const Model& model, int count = 300) {
  return simulate(model, green, random_geometries(count, 3), 0.01, 7);
}

/// Whether one of the warnings begins so.
bool says(const Json& lines, const std::string& beginning) {
  return std::ranges::any_of(lines, [&](const Json& line) { return line.get<std::string>().starts_with(beginning); });
}
bool warns(const Json& report, const std::string& beginning) { return says(report["warnings"], beginning); }
bool notes(const Json& report, const std::string& beginning) { return says(report["notes"], beginning); }

/// A small fit of what was measured, so that it has all there is to report on.
Model fitted(std::span<const Sample> samples) { return fit(samples, {Family::isotropic, {4, 2}}).model; }

TEST(Report, HasItsFieldsInOrder) {
  const Model model = least_squares("ptfe-532");
  const Json alone = report(model), beside = report(model, measured(model));
  EXPECT_EQ(names(alone), of_the_model);
  EXPECT_EQ(alone["warnings"], Json::array());
  std::vector<std::string> all = of_the_model;
  all.insert(all.end(), of_samples.begin(), of_samples.end());
  EXPECT_EQ(names(beside), all);
  for (const char* name : {"title", "model", "fit", "realizability", "uncertainty", "reflectances", "budgets"})
    EXPECT_EQ(alone[name], beside[name]) << name;
  for (const auto& [name, rows] : beside.items()) {
    if (!rows.is_array() || name == "warnings" || name == "notes") continue;
    for (const Json& row : rows) EXPECT_EQ(names(row), names(rows.front())) << name;
  }
  EXPECT_EQ(beside["residuals"].size(), 17U);
}

// Two of three wavelengths with the same directions are warned of in one line.
TEST(Report, SaysOnceForAllWavelengthsWhatNoSamplesSupport) {
  std::vector<Geometry> forward, further;
  for (const Geometry& g : random_geometries(300, 3)) {
    const double cosine = std::cos(g.reflected.phi - g.incident.phi);
    if (cosine < 0) forward.push_back(g);
    if (cosine < -0.5) further.push_back(g);
  }
  const Model truth = material("ptfe");
  std::vector<Sample> samples = simulate(truth, std::array{0.351, 0.633}, forward, 0.006, 1);
  std::ranges::move(simulate(truth, green, further, 0.006, 1), std::back_inserter(samples));
  FitOptions options;
  options.minimum_norm = true;
  std::vector<std::string> found;
  const Json all = report(fit(samples, {Family::isotropic, {4, 2}}, options).model);
  for (const Json& line : all["warnings"])
    if (const auto at = line.get<std::string>().find(": no samples support"); at != std::string::npos)
      found.push_back(line.get<std::string>().substr(0, at));
  EXPECT_EQ(found, (std::vector<std::string>{"351, 633 nm", "532 nm"}));
}

/// A scale that is 1 % uncertain adds 1 % of each value to its u.
TEST(Report, AddsTermsToAllThatIsUncertain) {
  const Model model = least_squares("ptfe-532");
  const std::vector<TypeBTerm> plaque{{"plaque", ErrorOf::scale, 0.01, 12}};
  const Json plain = report(model), all = Json::parse(report_json(model, "it", {}, {}, plaque));
  const auto expect_more = [](const Json& before, const Json& after, const char* value, const char* u) {
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_NEAR(after[i][u].get<double>(),
                  std::hypot(before[i][u].get<double>(), 0.01 * after[i][value].get<double>()), 1e-9)
          << value << i;
  };
  expect_more(plain["reflectances"], all["reflectances"], "value", "u");
  expect_more(plain["realizability"], all["realizability"], "smallest_f11", "u_smallest_f11");
  expect_more(plain["realizability"], all["realizability"], "largest_dhr", "u_largest_dhr");
  EXPECT_FALSE(plain.contains("terms"));
  EXPECT_EQ(all["terms"],
            Json::parse(R"([{"cause": "plaque", "kind": "scale", "u": 0.01, "degrees_of_freedom": 12}])"));
  EXPECT_NE(all["uncertainty"].get<std::string>().find(" and of the term plaque"), std::string::npos);
  const Json& cause = all["budgets"][1];
  EXPECT_EQ(cause["cause"], "plaque");
  EXPECT_EQ(cause["degrees_of_freedom"], 12);
}

// A measurement at 90 degrees tells nothing of f11: the term of an angle has no limit there.
TEST(Report, HasNoUncertaintyOfATermThatHasNoLimit) {
  const std::vector<TypeBTerm> arm{{"arm", ErrorOf::theta_r, radians(0.1)}};
  const Json all = Json::parse(report_json(least_squares("ptfe-532"), "it", {}, {}, arm));
  for (const Json& row : all["realizability"])
    EXPECT_EQ(row["u_smallest_f11"].is_null(), row["theta_max_deg"] == 90) << row.dump();
  EXPECT_NEAR(all["terms"][0]["u"].get<double>(), 0.1, 1e-15);
  EXPECT_EQ(all["terms"][0]["kind"], "theta_r_deg");
}

TEST(Report, RefusesTermsOfAnUncertaintyThatIsNotKnown) {
  const std::vector<TypeBTerm> terms{{"plaque", ErrorOf::scale, 0.01}};
  EXPECT_THROW(report_json(diffuser({0.3}), "it", green, {}, terms), std::invalid_argument);
}

TEST(Report, SaysOfAFitOfTheSampleWhatTheSampleIsLike) {
  const Model model = fit_sample(measured(material("ptfe-532"))).model;
  const std::vector<SampleTraits> traits = sample_traits(*model.posterior, 0);
  const Json rows = report(model)["sample"];
  ASSERT_EQ(rows.size(), traits.size());
  for (std::size_t b = 0; b < traits.size(); ++b) {
    EXPECT_EQ(rows[b]["wavelength_nm"], 532);
    EXPECT_EQ(rows[b]["block"], traits[b].block);
    EXPECT_EQ(rows[b]["noise"].get<double>(), traits[b].noise);
    EXPECT_EQ(rows[b]["once_per_turn"].get<double>(), traits[b].anisotropy[0]);
    EXPECT_EQ(rows[b]["thrice_per_turn"].get<double>(), traits[b].anisotropy[2]);
    EXPECT_EQ(rows[b]["nonreciprocal"].get<double>(), traits[b].nonreciprocal);
  }
}

TEST(Report, SaysOfTheModelWhatItSaysOfItself) {
  Model model = least_squares("ptfe");
  const Json json = report(model, green);
  EXPECT_EQ(json["title"], "Report on it (ptfe)");
  std::vector<std::string> expected{"name", "basis", "fitted range", "reflectance table"};
  for (const auto& [name, text] : model.provenance) expected.push_back(name);
  EXPECT_EQ(names(json["model"]), expected);
  EXPECT_EQ(json["model"]["name"], "ptfe");
  EXPECT_TRUE(json["model"]["reflectance table"].get<std::string>().ends_with(
      "; valid from 351 nm to 1064 nm, and f11 with it"));
  EXPECT_EQ(json["fit"][2]["block"], "14,41");
  EXPECT_EQ(json["fit"][2]["condition"].get<double>(), model.blocks[2].condition);
  model.name.clear();
  EXPECT_EQ(report(model, green)["model"]["name"], "it");
}

TEST(Report, KeepsWhatTheProvenanceSaysUnderANameThatIsTaken) {
  Model model = least_squares("ptfe-532");
  model.provenance["name"] = "another";
  const Json told = report(model)["model"];
  EXPECT_EQ(told["name"], "ptfe-532");
  EXPECT_EQ(told["provenance: name"], "another");
}

TEST(Report, IsOfTheWavelengthsAndAnglesThatTheModelWasFittedTo) {
  Model model = diffuser({0.2, 0.1});
  model.validity = {{0.4, 0.5}, radians(60), radians(70)};
  const Json json = report(model);
  std::vector<std::pair<double, double>> places;
  for (const Json& row : json["realizability"]) places.emplace_back(row["wavelength_nm"], row["theta_max_deg"]);
  EXPECT_EQ(places, (std::vector<std::pair<double, double>>{{400, 70}, {400, 90}, {500, 70}, {500, 90}}));
}

TEST(Report, HasTheNumbersOfTheModelToTheLastBit) {
  const Model model = least_squares("ptfe");
  const Json json = report(model, green);
  const ModelDiagnostics d = model_diagnostics(model, green[0]);
  const Json& horizon = json["realizability"][1];
  EXPECT_EQ(horizon["wavelength_nm"].get<double>(), 532);
  EXPECT_EQ(horizon["theta_max_deg"].get<double>(), 90);
  EXPECT_EQ(horizon["smallest_margin"].get<double>(), d.margin.value);
  EXPECT_EQ(horizon["smallest_f11"].get<double>(), d.f11.value);
  EXPECT_EQ(horizon["largest_dhr"].get<double>(), d.dhr);
  const UncertainModel u = uncertain(model, green[0]);
  const Direction at_60{radians(60), 0};
  const Json& dhr = json["reflectances"][3];
  EXPECT_EQ(dhr["quantity"], "dhr, theta_i 60");
  EXPECT_EQ(dhr["value"].get<double>(), directional_hemispherical_reflectance(model, green[0], at_60));
  EXPECT_EQ(dhr["u"].get<double>(), standard_uncertainty(directional_hemispherical_budget(u, at_60)));
  const Json& bhr = json["reflectances"][5];
  EXPECT_EQ(bhr["value"].get<double>(), bihemispherical_reflectance(model, green[0]));
  EXPECT_EQ(bhr["u"].get<double>(), standard_uncertainty(bihemispherical_budget(u)));
  const Json& factor = json["reflectances"][7];
  const Geometry to_the_normal{{radians(45), 0}, {0, 0}};
  EXPECT_EQ(factor["quantity"], "reflectance factor 45:0");
  EXPECT_EQ(factor["value"].get<double>(), reflectance_factor(prepare(model, green[0]).f11(to_the_normal)));
  EXPECT_EQ(factor["u"].get<double>(), reflectance_factor(u.fit.standard_uncertainty(to_the_normal)(0, 0)));
}

TEST(Report, HasTheNumbersOfTheSamplesToTheLastBit) {
  const std::vector<Sample> samples = measured(material("ptfe-532"));
  const Model model = fitted(samples);
  const Json json = report(model, samples);
  const Comparison c = compare(model, samples);
  EXPECT_EQ(json["residuals"][0]["rms"].get<double>(), c.f11.rms);
  EXPECT_EQ(json["residuals"][16]["element"], "44");
  EXPECT_EQ(json["residuals"][16]["largest"].get<double>(), c.normalized[15].largest);
  const SymmetryTests tests = symmetry_tests(samples, orders(model));
  EXPECT_EQ(json["reciprocity"][0]["F"].get<double>(), tests.reciprocity[0].f);
  EXPECT_EQ(json["mirror_symmetry"][1]["p"].get<double>(), tests.mirror[1].p);
  EXPECT_EQ(json["dependence_on_phi_i"][2]["rms_without"].get<double>(), tests.azimuth[2].rms_extended);
  const NoiseEstimate noise = estimate_noise(samples, residuals(model, samples));
  EXPECT_EQ(json["noise"][0]["scale"].get<double>(), noise.law.scale);
  EXPECT_EQ(json["noise"][0]["u_exponent_r"].get<double>(), std::sqrt(noise.covariance[8]));
  const SampleDiagnostics diagnostics = sample_diagnostics(samples, fit(samples, {Family::isotropic, {4, 2}}));
  const SampleDiagnostics::Leverage& block = diagnostics.leverage[3];
  EXPECT_EQ(json["leverage"][3]["largest_leverage"].get<double>(), block.values[block.largest]);
  EXPECT_EQ(json["leverage"][3]["sample"], block.largest + 1);
}

TEST(Report, SetsTheResidualsBesideTheUncertaintiesOfTheSamples) {
  std::vector<Sample> samples = measured(material("ptfe-532"));
  const Model model = fitted(samples);
  EXPECT_TRUE(report(model, samples)["chi_squared"].is_string());
  for (Sample& s : samples) {
    const double u = 0.01 * std::sqrt(std::cos(s.geometry.incident.theta) / std::cos(s.geometry.reflected.theta));
    s.uncertainty.elements.fill(u);
    s.uncertainty(0, 0) = u * s.f11;
  }
  const Json json = report(model, samples);
  const FitResult weighted = fit(samples, {Family::isotropic, {4, 2}}, {}, Weights::data);
  ASSERT_EQ(json["chi_squared"].size(), 7U);
  EXPECT_EQ(json["chi_squared"][0]["block"], "11");
  EXPECT_EQ(json["chi_squared"][0]["chi_squared_per_dof"].get<double>(), weighted.solutions[0].variance());
  EXPECT_EQ(json["chi_squared"][6]["block"], "all but 11");
  EXPECT_EQ(json["chi_squared"][6]["chi_squared_per_dof"].get<double>(), chi_squared_per_dof(weighted).others);
  for (Sample& s : samples) s.uncertainty = 0.1 * s.uncertainty;
  EXPECT_TRUE(warns(report(model, samples), "chi^2 per degree of freedom is "));
}

TEST(Report, OfAModelAsPrintedHasTheLeverageOfTheRowsThatWereFitted) {
  const std::vector<Sample> samples = measured(material("ptfe-532"));
  const Basis basis{Family::germer2017, {4, 2}, DiscMapping::lambert, Rotation::as_printed};
  const FitResult result = fit(samples, basis);
  const Json json = report(result.model, samples);
  EXPECT_TRUE(json["model"]["basis"].get<std::string>().starts_with("germer2017 as printed, orders 4,2, "));
  const SampleDiagnostics diagnostics = sample_diagnostics(samples, result);
  for (std::size_t b = 0; b < diagnostics.leverage.size(); ++b) {
    const SampleDiagnostics::Leverage& block = diagnostics.leverage[b];
    EXPECT_EQ(json["leverage"][b]["rank"], block.rank) << block.block;
    EXPECT_EQ(json["leverage"][b]["largest_leverage"].get<double>(), block.values[block.largest]) << block.block;
  }
}

TEST(Report, WarnsOfAModelThatIsNotPhysical) {
  Model model = least_squares("ptfe-532");
  for (double& a : model.blocks.back().coefficients) a *= 3;  // of 44
  const Json json = report(model);
  EXPECT_GT(json["realizability"][0]["unrealizable"].get<int>(), 0);
  EXPECT_TRUE(warns(json, json["realizability"][0]["unrealizable"].dump() +
                              " of 27225 matrices within the fitted angles at 532 nm cannot exist"));
  model = least_squares("ptfe-532");
  for (double& a : model.blocks.front().coefficients) a *= 1.1;
  EXPECT_TRUE(warns(report(model), "the directional-hemispherical reflectance reaches 1.08"));
  for (double& a : model.blocks.front().coefficients) a *= -1;
  EXPECT_TRUE(warns(report(model), "f11 is not positive at 27225 of 27225 directions within the fitted angles"));
}

TEST(Report, OnlyNotesWhatIsWrongBeyondTheFittedRange) {
  std::vector<Sample> samples = simulate(diffuser({0.3}), green, random_geometries(300, 3));
  const auto square = [](double x) { return x * x; };
  for (Sample& s : samples)  // negative far from the normal
    s.f11 -= 0.25 * (square(std::sin(s.geometry.incident.theta)) + square(std::sin(s.geometry.reflected.theta)));
  Model model = fit(samples, {Family::isotropic, {4, 0}}).model;
  model.validity = {{0.532}, radians(30), radians(30)};
  const Json json = report(model);
  ASSERT_EQ(json["realizability"][0]["f11_not_positive"], 0);
  ASSERT_GT(json["realizability"][1]["f11_not_positive"], 0);
  EXPECT_FALSE(warns(json, "f11 is not positive"));
  EXPECT_TRUE(notes(json, "f11 is not positive at "));
  model.validity = {};
  EXPECT_TRUE(warns(report(model), "f11 is not positive at "));  // who knows what was fitted
}

TEST(Report, NotesWavelengthsBetweenThoseOfTheFit) {
  const Json json = report(least_squares("ptfe"), std::array{0.443});
  EXPECT_TRUE(notes(json, "443 nm lies between the fitted wavelengths 351, 532, 633, 1064 nm"));
  EXPECT_EQ(json["reflectances"][0]["validity"], "interpolated");
}

TEST(Report, HasBudgetsWhoseCausesMakeTheUncertainty) {
  const Json json = report(material("ptfe-532"));
  ASSERT_FALSE(json["budgets"].empty());
  for (const char* quantity : {"dhr, theta_i 8", "reflectance factor 0:45"}) {
    double sum = 0, together = 0, u = 0;
    for (const Json& row : json["budgets"]) {
      if (row["quantity"] != quantity) continue;
      if (row["cause"] != "together") {
        sum += std::pow(row["u"].get<double>(), 2);
        EXPECT_TRUE(row["U"].is_null());
        continue;
      }
      together = row["u"];
      EXPECT_EQ(row["U"].get<double>(), reported_coverage * together);
    }
    for (const Json& row : json["reflectances"])
      if (row["quantity"] == quantity) u = row["u"];
    EXPECT_GT(u, 0);
    EXPECT_DOUBLE_EQ(together, std::sqrt(sum));
    EXPECT_NEAR(together, u, 1e-12 * u);  // the same sum in another frame
  }
  Model without = least_squares("ptfe-532");
  without.blocks[0].covariance.clear();
  EXPECT_EQ(report(without)["budgets"], Json::array());
  EXPECT_EQ(report(without)["uncertainty"], "not known");
}

TEST(Report, SaysWhichDirectionsPicturesHave) {
  const Model model = least_squares("ptfe-532");
  std::vector<Sample> samples = simulate(model, green, germer2017_grid());
  const Json grid = report(model, samples)["directions"];
  EXPECT_EQ(grid["grid"], true);
  EXPECT_EQ(grid["phi_i_deg"], degrees(samples.back().geometry.incident.phi));
  EXPECT_EQ(grid["theta_i_deg"].size(), 3U);
  const Json random = report(model, measured(model))["directions"];
  EXPECT_EQ(random["grid"], false);
  EXPECT_EQ(random["phi_i_deg"], 180);
}

TEST(Report, WarnsOfWhatIsNotKnown) {
  const Model model = least_squares("ptfe-532");
  EXPECT_TRUE(warns(report(model, std::array{0.6}), "600 nm lies outside the fitted range"));
  Model without = model;
  without.blocks[2].covariance.clear();
  const Json json = report(without);
  EXPECT_TRUE(warns(json, "the covariance of the coefficients is not known, or not of all"));
  EXPECT_EQ(json["fit"][2]["covariance"], false);
  for (const Json& row : json["reflectances"]) EXPECT_TRUE(row["u"].is_null());
  Model free = model;
  free.blocks[0].rank = 39;
  EXPECT_TRUE(warns(report(free), "the data left 1 of 40 combinations of block 11 free"));
  Model mixed = material("ptfe-532");  // whose u is of the modes behind it
  mixed.blocks[0].rank = 39;
  EXPECT_TRUE(
      warns(report(mixed), "the data left 1 of 40 combinations of block 11 free: what that leaves open is in u"));
}

TEST(Report, OfAModelOfNoKnownWavelengthNamesNone) {
  const Model model = diffuser({0.3});
  const Json json = report(model);
  EXPECT_TRUE(warns(json, "it does not say to which wavelengths and angles it was fitted"));
  EXPECT_EQ(json["realizability"].size(), 1U);  // up to the horizon
  EXPECT_TRUE(json["realizability"][0]["wavelength_nm"].is_null());
  EXPECT_TRUE(json["fit"][0]["rank"].is_null());
  EXPECT_TRUE(json["fit"][0]["condition"].is_null());
  EXPECT_EQ(report(model, green)["realizability"][0]["wavelength_nm"].get<double>(), 532);
}

TEST(Report, WarnsOfSamplesThatBreakASymmetry) {
  std::vector<Sample> samples = measured(material("ptfe-532"));
  for (Sample& s : samples) s.normalized(3, 3) += 0.1 * s.geometry.incident.theta;  // and not of reflected.theta
  EXPECT_TRUE(warns(report(fitted(samples), samples), "the data break reciprocity in block 44: F = "));
  for (Sample& s : samples) s.geometry.incident.phi = 0;
  EXPECT_EQ(report(fitted(samples), samples)["dependence_on_phi_i"],
            "the source has one azimuth in these data: whether the sample is isotropic cannot be told");
}

TEST(Report, ListsTheFirstOutliersAndCountsAll) {
  std::vector<Sample> samples = measured(material("ptfe-532"), 400);
  for (std::size_t e = 1; e < 16; ++e) samples[70].normalized.elements[e] = samples[200].normalized.elements[e] = 2;
  samples[70].normalized(3, 3) = 3;
  const Json json = report(material("ptfe-532"), samples);
  ASSERT_EQ(json["outliers"].size(), listed_outliers);
  EXPECT_EQ(json["outliers"][0]["sample"], 71);
  EXPECT_EQ(json["outliers"][0]["element"], "44");
  const auto found = outliers(sample_diagnostics(samples, fit(samples)), outlier_threshold);
  EXPECT_GT(found.size(), listed_outliers);
  EXPECT_TRUE(warns(json, std::to_string(found.size()) + " elements of samples lie more than 5 standard deviations"));
}

TEST(Report, WarnsOfSamplesBeyondTheRangeAndOfFewOfThem) {
  const Model model = least_squares("ptfe-532");
  std::vector<Sample> samples = simulate(model, green, std::vector{in_degrees(80, 0, 10, 0), in_degrees(30, 0, 20, 9)});
  const Json json = report(model, samples);
  EXPECT_TRUE(warns(json, "1 of 2 samples lies outside the fitted range"));
  EXPECT_TRUE(notes(json, "the law of the noise at 532 nm is not known: "));
  EXPECT_EQ(json["noise"], Json::array());
  EXPECT_TRUE(warns(json, "sample 1 decides block 11 almost alone where it is: its leverage is 1.00"));
}

TEST(Report, IsOneLineOfUtf8) {
  const std::string text = report_json(diffuser({0.3}), "\xff\n");
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(Json::parse(text)["title"], "Report on \xef\xbf\xbd\n");
}

TEST(Report, RefusesWhatThereIsNothingToSayOf) {
  const Model model = least_squares("ptfe-532");
  EXPECT_EQ(message_of([] {
              report(diffuser({0.3, 0.1}));
            }),
            "it does not say to which wavelengths it was fitted: give some");
  EXPECT_EQ(message_of([&] { report(model, std::array{-0.5}); }), "wavelength -500 nm is not positive");
  EXPECT_EQ(message_of([&] { report(model, std::vector<Sample>{}); }), "no samples");
  EXPECT_EQ(message_of([] { report(Model{}); }), "model has no modes of element 11");
}

}  // namespace
}  // namespace mmbrdf
