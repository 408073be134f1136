// SPDX-License-Identifier: BSD-3-Clause
// The document of a report: report.hpp.

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "given/least_squares.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/quantities/report.hpp"
#include "mmbrdf/samples/simulation.hpp"

namespace mmbrdf {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array green{0.532};

ReportOrigin origin() {
  return {.date = "2026-11-30T00:20:00+00:00",
          .software = "mmbrdf 0",
          .command = "mmbrdf report theta_i.json",
          .files = {{"model", "theta_i.json", "00ff"}},
          .model = "theta_i.json"};
}

Json document(const Model& model, std::span<const double> wavelengths = {}, const ReportStyle& style = {},
              const std::optional<ReportedSamples>& samples = {}) {
  return Json::parse(report_document(model, report_json(model, "theta_i.json", wavelengths, samples), origin(), style));
}

std::vector<Sample> measured(bool with_u) {
  std::vector<Sample> samples = simulate(material("ptfe-532"), green, random_geometries(300, 3), 0.01, 7);
  if (with_u)
    for (Sample& s : samples) {
      s.uncertainty.elements.fill(0.01);
      s.uncertainty(0, 0) = 0.01 * s.f11;
    }
  return samples;
}

std::vector<Json> of_kind(const Json& document, const std::string& kind) {
  std::vector<Json> found;
  for (const Json& block : document["blocks"])
    if (block["kind"] == kind) found.push_back(block);
  return found;
}

std::string all_text(const Json& document) {
  std::string text;
  for (const Json& block : document["blocks"]) text += block.dump() + "\n";
  return text;
}

/// Significant ones, without a power of ten.
int digits_of(const std::string& number) {
  int count = 0;
  for (const char c : number.substr(0, number.find(' ')))
    if (c >= '0' && c <= '9' && (count > 0 || c != '0')) ++count;
  return count;
}

TEST(ReportDocument, BeginsWithTheSampleItsReflectancesAndWhatIsLeft) {
  const std::vector<Sample> samples = measured(true);
  const Model model = fit(samples, {Family::isotropic, {4, 2}}).model;
  const Json json = document(model, {}, {}, ReportedSamples{"data.csv", samples});
  const Json& first = json["blocks"][0];
  EXPECT_EQ(first["kind"], "summary");
  EXPECT_EQ(first["subject"], "theta_i.json at 532 nm");
  const std::regex said(
      R"(: directional-hemispherical reflectance DHR\(8°\) = 0\.\d+\(\d\d\); reflectance factor R\(0°:45°\) = [01]\.\d+\(\d\d\); )"
      R"(χ²/ν = \d\.\d+\(\d+\) \(f₁₁\) and \d\.\d+\(\d+\) \(other elements\)\. Uncertainties are standard \(k = 1\), of the fit; .*)");
  EXPECT_TRUE(std::regex_match(first["text"].get<std::string>(), said)) << first["text"];
}

// Pictures know kinds of errors alone: those of one kind go together, √(0.3² + 0.4²) = 0.5.
TEST(ReportDocument, DrawsBandsWithTheTerms) {
  const Model model = material("ptfe-532");
  const std::vector<TypeBTerm> terms{
      {"plaque", ErrorOf::scale, 0.003}, {"lamp", ErrorOf::scale, 0.004}, {"arm", ErrorOf::theta_r, radians(0.02)}};
  const Json json = Json::parse(report_document(model, report_json(model, "it", green, {}, terms)));
  std::size_t with_terms = 0;
  for (const Json& figure : of_kind(json, "figure")) {
    const bool banded = figure["plot"] == "reflectance-against-angle" || figure["plot"] == "reflectance-factor";
    EXPECT_EQ(figure["arguments"].contains("terms"), banded) << figure["plot"];
    if (!banded) continue;
    ++with_terms;
    EXPECT_NEAR(figure["arguments"]["terms"]["scale"].get<double>(), 0.005, 1e-15);
    EXPECT_NEAR(figure["arguments"]["terms"]["theta_r_deg"].get<double>(), 0.02, 1e-15);
    EXPECT_NE(figure["command"].get<std::string>().find(" --term scale=0.005 --term theta_r_deg=0.02"),
              std::string::npos);
  }
  EXPECT_EQ(with_terms, 2U);
  EXPECT_NE(json["blocks"][0]["text"].get<std::string>().find("and of the terms plaque, lamp, arm."),
            std::string::npos);
}

TEST(ReportDocument, SaysWhatItDoesNotKnow) {
  const std::string alone = document(least_squares("ptfe-532"))["blocks"][0]["text"];
  EXPECT_NE(alone.find("χ²/ν is not known, for no samples are beside it"), std::string::npos);
  const std::vector<Sample> samples = measured(false);
  const std::string without =
      document(least_squares("ptfe-532"), {}, {}, ReportedSamples{"d", samples})["blocks"][0]["text"];
  EXPECT_NE(without.find("the samples do not state their uncertainties"), std::string::npos);
  const std::string unknown = document(diffuser({0.3}))["blocks"][0]["text"];
  EXPECT_NE(unknown.find("The uncertainty is not known."), std::string::npos);
}

TEST(ReportDocument, HasTablesWhoseRowsAreAsLongAsTheirHeads) {
  const std::vector<Sample> samples = measured(true);
  const Json json = document(material("ptfe"), green, {}, ReportedSamples{"data.csv", samples});
  int number = 0;
  for (const Json& table : of_kind(json, "table")) {
    EXPECT_EQ(table["number"], ++number);
    for (const Json& row : table["rows"]) {
      EXPECT_EQ(row.size(), table["columns"].size()) << table["caption"];
      for (const Json& cell : row) EXPECT_TRUE(cell.is_string());
    }
  }
  EXPECT_GT(number, 12);
}

TEST(ReportDocument, HasNoNumberOfMoreDigitsThanItsUncertaintyLeaves) {
  const std::vector<Sample> samples = measured(true);
  const Json json = document(material("ptfe"), green, {}, ReportedSamples{"data.csv", samples});
  const std::regex with_u(R"((−)?\d+(\.\d+)?\(\d\d?(\.\d)?\)( × 10\S+)?( \*)?)");
  int alone = 0;
  for (const Json& table : of_kind(json, "table"))
    for (const Json& row : table["rows"])
      for (std::size_t c = 0; c < row.size(); ++c) {
        const std::string cell = row[c], heading = table["columns"][c]["heading"];
        const bool number = table["columns"][c]["align"] == "right" && cell.find('.') != std::string::npos;
        if (!number || std::regex_match(cell, with_u) || cell.find(" ± ") != std::string::npos) continue;
        if (heading.find("/ °") != std::string::npos) continue;  // of a grid
        ++alone;
        // Three of what has no uncertainty; of the largest residual as many as it has before the last of the rms.
        EXPECT_LE(digits_of(cell), heading == "largest" ? 4 : 3) << cell << " in " << table["caption"];
      }
  EXPECT_GT(alone, 50);
}

TEST(ReportDocument, WritesUncertaintiesAsItIsAsked) {
  const Model model = material("ptfe-532");
  EXPECT_NE(all_text(document(model)).find("0.9832(32)"), std::string::npos);
  const std::string text = all_text(document(model, {}, {Notation::plus_minus, 45}));
  EXPECT_NE(text.find("0.9832 ± 0.0032"), std::string::npos);
  EXPECT_EQ(text.find("(32)"), std::string::npos);
}

TEST(ReportDocument, HasSymbolsInPrintButNotInNamesAndCommands) {
  Model model = material("ptfe-532");
  model.provenance["command"] = "mmbrdf fit --columns theta_i_deg=AOI";
  const Json json = document(model);
  const std::string text = all_text(json);
  for (const char* name :
       {"theta_i.json (ptfe-532) at 532 nm", "mmbrdf report theta_i.json", "--columns theta_i_deg=AOI"})
    EXPECT_NE(text.find(name), std::string::npos) << name;
  EXPECT_NE(text.find("θᵢ ≤ 75°"), std::string::npos);
  const std::regex ascii(R"(theta_[ir](?!_deg|\.json)|sr\^-1|chi\^2|phi_[ir](?!_deg))");
  std::smatch found;
  EXPECT_FALSE(std::regex_search(text, found, ascii)) << found.prefix().str().substr(0, 200);
}

TEST(ReportDocument, SaysFromWhereToWhereATableOfReflectancesIsValid) {
  EXPECT_NE(all_text(document(material("ptfe"))).find("; valid from 351 nm to 1064 nm, and f11 with it"),
            std::string::npos);
}

TEST(ReportDocument, SaysWhereItComesFrom) {
  const std::string text = all_text(document(material("ptfe-532")));
  for (const char* said : {"2026-11-30T00:20:00+00:00", "mmbrdf 0", "SHA-256 of the model", "00ff"})
    EXPECT_NE(text.find(said), std::string::npos) << said;
}

TEST(ReportDocument, HasOnePictureForSeveralWavelengths) {
  std::multiset<std::string> kinds;
  for (const Json& figure : of_kind(document(material("ptfe")), "figure")) kinds.insert(figure["plot"]);
  EXPECT_EQ(kinds,
            (std::multiset<std::string>{"by-wavelength", "coefficient-spectrum", "coefficient-spectrum", "hemisphere",
                                        "realizability-map", "reflectance-against-angle", "reflectance-factor"}));
}

TEST(ReportDocument, HasPicturesOfResidualsForAnyDirections) {
  const std::vector<Sample> random = measured(false);
  const std::vector<Sample> grid = simulate(material("ptfe-532"), green, germer2017_grid(), 0.01, 7);
  for (const auto& [samples, maps] : {std::pair(random, 0), std::pair(grid, 3)}) {
    int residuals = 0, of_grid = 0;
    for (const Json& figure :
         of_kind(document(material("ptfe-532"), {}, {}, ReportedSamples{"data.csv", samples}), "figure")) {
      residuals += figure["plot"] == "residuals";
      of_grid += figure["plot"] == "residual-map";
    }
    EXPECT_EQ(residuals, 1);
    EXPECT_EQ(of_grid, maps);
  }
}

TEST(ReportDocument, OfPicturesHasTheCommandsThatDrawThem) {
  const Json figure = of_kind(document(material("ptfe-532")), "figure")[0];
  EXPECT_EQ(figure["command"], "mmbrdf plot reflectance-against-angle theta_i.json -w 532 --width 8 -o figure1.pdf");
}

TEST(ReportDocument, LeavesOutPicturesOfWhatWasNotMeasured) {
  std::vector<Sample> samples = measured(false);
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  for (Sample& s : samples)
    for (std::size_t e = 1; e < 16; ++e) s.normalized.elements[e] = unknown;
  const Model model = fit(samples, {Family::isotropic, {4, 2}}).model;
  std::set<std::string> kinds;
  for (const Json& figure : of_kind(document(model), "figure")) kinds.insert(figure["plot"]);
  EXPECT_TRUE(kinds.contains("hemisphere"));
  EXPECT_FALSE(kinds.contains("in-plane-curves") || kinds.contains("realizability-map"));
}

TEST(ReportMarkdown, HasAllOfTheDocumentAndNoMarkupOfOthers) {
  Model model = material("ptfe-532");
  model.provenance["remark"] = "<b>|*x*\nnew";
  const Json json = document(model);
  const std::string text = report_markdown(json.dump());
  EXPECT_TRUE(text.starts_with(
      "# Report on theta\\_i.json (ptfe-532)\n\n**theta\\_i.json (ptfe-532) at 532 nm**: directional"));
  EXPECT_NE(text.find("| remark | \\<b>\\|\\*x\\* new |"), std::string::npos);
  for (const Json& heading : of_kind(json, "heading")) {
    EXPECT_NE(text.find("\n## " + heading["text"].get<std::string>() + "\n"), std::string::npos);
    EXPECT_NE(text.find("](#" + heading["anchor"].get<std::string>() + ")\n"), std::string::npos);
  }
  EXPECT_NE(text.find("\n    mmbrdf plot hemisphere "), std::string::npos);
}

}  // namespace
}  // namespace mmbrdf
