// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include "given/files.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"

namespace mmbrdf {
namespace {

/// A model with everything that a file can hold, and numbers of many sizes.
Model any_model(Family family = Family::isotropic, unsigned seed = 1) {
  std::mt19937_64 engine(seed);
  std::lognormal_distribution<double> size(0, 15);
  const auto number = [&] { return engine() % 2 ? size(engine) : -size(engine); };
  Model model;
  model.name = "any \"thing\", ±1";
  model.family = family;
  model.powers = 1;
  for (Block& block : blocks(family, Orders{3, 2})) {
    FittedBlock fitted;
    const std::size_t count = 2 * block.modes.size();
    for (std::size_t i = 0; i < count; ++i) fitted.coefficients.push_back(number());
    fitted.covariance.resize(count * count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j <= i; ++j)
        fitted.covariance[i * count + j] = fitted.covariance[j * count + i] = i == j ? size(engine) : number();
    fitted.rank = static_cast<int>(count) - 1;
    for (std::size_t i = 0; i < count; ++i) fitted.null_space.push_back(number());
    fitted.rows = 12345678;
    fitted.condition = size(engine);
    fitted.block = std::move(block);
    model.blocks.push_back(std::move(fitted));
  }
  model.reflectance = {{0.351, 0.532}, {0.976, 0.984}, {4, -0.1, -0.1, 9}};
  for (std::size_t i = 0; i < 2 * model.blocks[0].coefficients.size(); ++i)
    model.reflectance.covariance_with_f11.push_back(number());
  model.validity = {{0.351, 1.0 / 3, 0.532}, radians(75), 1.4289};
  model.provenance = {{"data", "measured on a Monday"}, {"command", "mmbrdf fit \"d.csv\""}};
  std::sort(model.validity.wavelengths.begin(), model.validity.wavelengths.end());
  return model;
}

/// As a fit that takes the reflectances from its own samples has them.
Model with_variances_alone(Model model) {
  model.reflectance.covariance = {4, 9};
  return model;
}

void expect_same(const Model& a, const Model& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.family, b.family);
  EXPECT_EQ(a.mapping, b.mapping);
  EXPECT_EQ(a.rotation, b.rotation);
  EXPECT_EQ(a.powers, b.powers);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t i = 0; i < a.blocks.size(); ++i) {
    EXPECT_EQ(a.blocks[i].block.name, b.blocks[i].block.name);
    EXPECT_EQ(a.blocks[i].block.elements, b.blocks[i].block.elements);
    EXPECT_EQ(a.blocks[i].block.modes, b.blocks[i].block.modes);
    EXPECT_EQ(a.blocks[i].coefficients, b.blocks[i].coefficients);
    EXPECT_EQ(a.blocks[i].covariance, b.blocks[i].covariance);
    EXPECT_EQ(a.blocks[i].rank, b.blocks[i].rank);
    EXPECT_EQ(a.blocks[i].null_space, b.blocks[i].null_space);
    EXPECT_EQ(a.blocks[i].rows, b.blocks[i].rows);
    EXPECT_EQ(a.blocks[i].condition, b.blocks[i].condition);
  }
  EXPECT_EQ(a.reflectance.wavelengths, b.reflectance.wavelengths);
  EXPECT_EQ(a.reflectance.values, b.reflectance.values);
  EXPECT_EQ(a.reflectance.covariance, b.reflectance.covariance);
  EXPECT_EQ(a.reflectance.covariance_with_f11, b.reflectance.covariance_with_f11);
  EXPECT_EQ(a.validity.wavelengths, b.validity.wavelengths);
  ASSERT_EQ(a.validity.theta_i_max.has_value(), b.validity.theta_i_max.has_value());
  ASSERT_EQ(a.validity.theta_r_max.has_value(), b.validity.theta_r_max.has_value());
  EXPECT_DOUBLE_EQ(a.validity.theta_i_max.value_or(0), b.validity.theta_i_max.value_or(0));
  EXPECT_DOUBLE_EQ(a.validity.theta_r_max.value_or(0), b.validity.theta_r_max.value_or(0));
  EXPECT_EQ(a.provenance, b.provenance);
}

std::string refusal(const std::string& json) {
  return complaint([&] { model_from_json(json, "m.json"); });
}

/// The text with its first `what` replaced, which must be there.
std::string with(std::string text, const std::string& what, const std::string& other) {
  const std::size_t position = text.find(what);
  if (position == std::string::npos) throw std::logic_error("no " + what + " in the file");
  return text.replace(position, what.size(), other);
}

/// A model of two modes, whose file is short enough to be taken apart.
std::string small_file() {
  Model model;
  model.name = "small";
  for (Block& block :
       blocks(Family::isotropic, std::vector<Mode>{{Function::m11, 0, 0, 0, 0}, {Function::m44, 1, 1, 1, -1}})) {
    FittedBlock fitted;
    fitted.block = std::move(block);
    fitted.coefficients = {0.25};
    fitted.covariance = {0.5};
    fitted.rank = 1;
    fitted.condition = 2;
    model.blocks.push_back(std::move(fitted));
  }
  model.reflectance = {{0.5}, {0.9}};
  return to_json(model);
}

TEST(Json, OfEveryFamilyIsReadBackToTheSameBits) {
  for (const Family family : {Family::isotropic, Family::germer2017, Family::anisotropic})
    for (unsigned seed = 0; seed < 5; ++seed) {
      const Model model = any_model(family, seed);
      expect_same(model_from_json(to_json(model), "m.json"), model);
      expect_same(model_from_json(to_json(with_variances_alone(model)), "m.json"), with_variances_alone(model));
    }
}

TEST(Json, SaysHowAzimuthsEnterOnlyWhereTheyEnterAsPrinted) {
  Model model = any_model(Family::germer2017);
  const std::string covariant = to_json(model);
  EXPECT_EQ(covariant.find("rotation"), std::string::npos);  // files of before are what they were, and are read
  model.rotation = Rotation::as_printed;
  const std::string printed = to_json(model), line = "\n  \"rotation\": \"as_printed\",";
  expect_same(model_from_json(printed, "m.json"), model);
  EXPECT_EQ(with(printed, line, ""), covariant);
  expect_same(model_from_json(with(printed, "as_printed", "covariant"), "m.json"), any_model(Family::germer2017));
  EXPECT_EQ(refusal(with(printed, "as_printed", "printed")),
            "m.json: rotation: rotation 'printed' is not one of covariant, as_printed");
  EXPECT_EQ(refusal(with(printed, "\"germer2017\"", "\"anisotropic\"")),
            "m.json: rotation: as_printed goes with germer2017, not with anisotropic");
  EXPECT_EQ(refusal(with(printed, "\"as_printed\"", "true")), "m.json: rotation: must be a string, not true");
}

TEST(Json, WithoutWhatIsUnknownIsReadBackWithoutIt) {
  Model model = any_model();
  model.mapping = DiscMapping::projected;
  for (FittedBlock& fitted : model.blocks) {
    fitted.covariance.clear();
    fitted.rank = 0;
    fitted.null_space.clear();
    fitted.rows = 0;
    fitted.condition = 0;
  }
  model.reflectance = {};
  model.validity = {};
  model.provenance = {};
  const std::string text = to_json(model);
  for (const char* absent : {"covariance", "rank", "condition", "null_space", "\"rows\"", "\"reflectance\""})
    EXPECT_EQ(text.find(absent), std::string::npos) << absent;
  expect_same(model_from_json(text, "m.json"), model);
}

TEST(Json, SavedIsLoaded) {
  const Folder folder;
  const Model model = any_model();
  save_model(folder / "m.json", model);
  expect_same(load_model(folder / "m.json"), model);
}

TEST(ModelFile, OfATextIsThatOfTheFile) {
  const Model published = model_from_text("1, 1, 0, 0, 0, 0, 0, 2.5\n", "folder/sample.csv");
  EXPECT_EQ(published.family, Family::germer2017);
  EXPECT_EQ(published.name, "sample");
  expect_same(model_from_text(to_json(any_model()), "any.json"), any_model());
  for (const auto& [text, message] : {std::pair{std::string_view(), "a.csv: empty file, without a model"},
                                      {std::string_view("{}\0", 3), "a.csv: binary file, not a model"}})
    try {
      model_from_text(text, "a.csv");
      FAIL() << message;
    } catch (const std::runtime_error& e) {
      EXPECT_STREQ(e.what(), message);
    }
}

TEST(Json, ThatNobodyCouldReadIsNotSaved) {
  const Folder folder;
  put(folder / "m.json", "old");
  Model model = any_model();
  model.blocks[1].covariance[0] = -1;
  EXPECT_TRUE(says(complaint([&] { save_model(folder / "m.json", model); }),
                   {"m.json: blocks[1].covariance: variance 0 is negative", "not saved"}));
  EXPECT_EQ(contents(folder / "m.json"), "old");
  EXPECT_EQ(folder.files(), 1);
}

TEST(ModelFormat, IsThatOfTheEndingInEitherCase) {
  EXPECT_EQ(model_format("a.csv").ending, ".csv");
  EXPECT_EQ(model_format("A.CSV").ending, ".csv");
  for (const char* path : {"a.json", "a", "csv", "a.csv.gz"}) EXPECT_EQ(model_format(path).ending, "") << path;
}

TEST(ModelFormat, LeavesNothingOfWhatItSaysThatItLoses) {
  const Folder folder;
  const Model model = any_model(Family::germer2017);
  const ModelFormat& format = model_format("m.csv");
  EXPECT_EQ(format.lost(model).size(), 5u);
  save_model(folder / "m.csv", model);
  EXPECT_TRUE(format.lost(as_printed(load_model(folder / "m.csv"))) == std::vector<std::string>{"how azimuths enter"});
  EXPECT_TRUE(format.lost(load_model(folder / "m.csv")).empty());
  EXPECT_EQ(model_format("m.json").lost, nullptr);
}

TEST(Json, HasLinesOfAtMost120Characters) {
  std::istringstream lines(to_json(any_model(Family::germer2017)));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120U) << line;
}

TEST(Json, DoesNotDependOnTheLocale) {
  const Model model = any_model();
  const std::string text = to_json(model);
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"})
    if (std::setlocale(LC_ALL, name)) break;
  EXPECT_EQ(to_json(model), text);
  expect_same(model_from_json(text, "m.json"), model);
  std::setlocale(LC_ALL, "C");
}

TEST(Json, ThatIsCutOffAnywhereIsRefusedInALineThatNamesTheLine) {
  const std::string text = small_file();
  for (std::size_t length = 1; length + 2 < text.size(); ++length) {
    const std::string message = refusal(text.substr(0, length));
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(length) - 1, '\n');
    EXPECT_TRUE(says(message, {"m.json:" + std::to_string(line) + ": not JSON: "})) << length;
    EXPECT_EQ(message.find("json.exception"), std::string::npos) << message;
  }
}

TEST(Json, OfAnotherFormatVersionOrConventionIsRefused) {
  const std::string text = small_file();
  EXPECT_EQ(refusal(text), "");
  EXPECT_EQ(refusal(with(text, "\"schema_version\": 1", "\"schema_version\": 2")),
            "m.json: schema_version: 2, but this version of mmbrdf reads 1");
  EXPECT_EQ(refusal(with(text, "mmbrdf model", "other")), "m.json: format: 'other' is not 'mmbrdf model'");
  EXPECT_EQ(refusal(with(text, "left - right", "right - left")),
            "m.json: conventions.s4: 'right - left' is not supported, only \"left - right\"");
  EXPECT_TRUE(says(refusal(with(text, "\"wavelength\": \"um\"", "\"wavelength\": \"nm\"")),
                   {"m.json: units.wavelength: 'nm'"}));
  EXPECT_TRUE(says(refusal(with(text, "isotropic", "Isotropic")), {"m.json: basis: ", "'Isotropic'", "germer2017"}));
  EXPECT_TRUE(says(refusal(with(text, "lambert", "equal")), {"m.json: mapping: ", "'equal'", "projected"}));
  EXPECT_EQ(refusal("[1, 2]"), "m.json: must be an object, not an array");
  EXPECT_EQ(refusal("{}"), "m.json: format: missing");
}

TEST(Json, WithoutAFieldItNeedsIsRefused) {
  const std::string text = small_file();
  for (const char* name : {"format",         "schema_version",  "name",   "basis",    "orders", "powers",
                           "mapping",        "conventions",     "s4",     "frame",    "units",  "validity",
                           "wavelengths_um", "theta_i_max_deg", "blocks", "elements", "modes",  "coefficients",
                           "provenance",     "values"}) {
    const std::string quoted = '"' + std::string(name) + '"';
    EXPECT_TRUE(says(refusal(with(text, quoted, "\"x" + quoted.substr(1))), {"m.json: ", std::string(name)})) << name;
  }
}

TEST(Json, WithAFieldOfTheWrongKindIsRefusedByItsPath) {
  const std::string text = small_file();
  const std::vector<std::vector<std::string>> cases = {
      {"\"powers\": 0", "\"powers\": 0.5", "m.json: powers: must be an integer, not 0.5"},
      {"\"powers\": 0", "\"powers\": \"0\"", "m.json: powers: must be an integer, not '0'"},
      {"\"powers\": 0", "\"powers\": -1", "m.json: powers: -1"},
      {"\"powers\": 0", "\"powers\": 1e300", "m.json: powers: must be an integer"},
      {"\"powers\": 0", "\"powers\": 12345678901234567890", "m.json: powers: must be an integer"},
      {"\"powers\": 0", "\"powers\": 1", "m.json: blocks[0].coefficients: 1 numbers in place of 2"},
      {"\"name\": \"small\"", "\"name\": 7", "m.json: name: must be a string, not 7"},
      {"\"coefficients\": [0.25]", "\"coefficients\": [0.25, 1]", "m.json: blocks[0].coefficients: 2 numbers"},
      {"\"coefficients\": [0.25]", "\"coefficients\": [null]",
       "m.json: blocks[0].coefficients[0]: must be a number, not null"},
      {"\"coefficients\": [0.25]", "\"coefficients\": 0.25",
       "m.json: blocks[0].coefficients: must be an array, not 0.25"},
      {"\"coefficients\": [0.25]", "\"coefficients\": [NaN]", ": not JSON: "},
      {"\"coefficients\": [0.25]", "\"coefficients\": [-1e999]", "'-1e999' is beyond the range of double precision"},
      {"\"covariance\": [0.5]", "\"covariance\": []", "m.json: blocks[0].covariance: 0 numbers in place of 1"},
      {"\"covariance\": [0.5]", "\"covariance\": [-0.5]", "m.json: blocks[0].covariance: variance 0 is negative"},
      {"\"rank\": 1", "\"rank\": 2", "m.json: blocks[0].rank: 2 is not in 0...1"},
      {"\"rank\": 1", "\"rank\": 1, \"rows\": 10.7", "m.json: blocks[0].rows: must be a number of rows, not 10.7"},
      {"\"rank\": 1", "\"rank\": 1, \"rows\": 1e300", "m.json: blocks[0].rows: must be a number of rows, not 1e"},
      {"\"condition\": 2.0", "\"condition\": -2", "m.json: blocks[0].condition: -2 is negative"},
      {"[\"11\",0,0,0,0]", "[\"11\",0,0,0]", "m.json: blocks[0].modes[0]: must be [function, n, m, k, l]"},
      {"[\"11\",0,0,0,0]", "[\"q\",0,0,0,0]", "m.json: blocks[0].modes[0][0]: function 'q'"},
      {"[\"11\",0,0,0,0]", "[\"11\",0,2,0,0]", "m.json: blocks[0].modes[0]: mode 11 (n, m, k, l) = (0, 2, 0, 0)"},
      {"[\"11\",0,0,0,0]", "[\"11\",1,1,3,-3]", "(1, 1, 3, -3)"},
      {"[\"11\",0,0,0,0]", "[\"11\",0,0,0,0], [\"11\",0,0,0,0]", "m.json: blocks[0].modes: mode 11"},
      {"[\"11\",0,0,0,0]", "[\"11\",2,0,0,0], [\"11\",0,0,0,0]", "m.json: blocks[0].modes[0]: out of order"},
      {"[\"11\",0,0,0,0]", "[\"11\",0,0,0,0], [\"44\",0,0,0,0]",
       "m.json: blocks[0].modes: must be the modes of one block"},
      {"[\"11\",0,0,0,0]", "[\"44\",0,0,0,0]", "m.json: blocks[0].elements: '11', but the modes feed 44"},
      {"\"orders\": [0, 1]", "\"orders\": [7, 4]", "m.json: orders: must be [0, 1]"},
      {"\"theta_i_max_deg\": null", "\"theta_i_max_deg\": 91", "m.json: validity.theta_i_max_deg: 91"},
      {"\"theta_r_max_deg\": null", "\"theta_r_max_deg\": -1",
       "m.json: validity.theta_r_max_deg: -1 degrees is not in 0...90"},
      {"\"rank\": 1", "\"rank\": -1", "m.json: blocks[0].rank: -1 is not in 0...1"},
      {"\"rank\": 1", "\"rank\": 1, \"rows\": -1", "m.json: blocks[0].rows: must be a number of rows, not -1"},
      {"\"wavelengths_um\": []", "\"wavelengths_um\": [0.5, 0.4]",
       "m.json: validity.wavelengths_um: must be positive and rise"},
      {"\"values\": [0.9]", "\"values\": [0.9, 1]", "m.json: reflectance: "},
      {"\"values\": [0.9]", "\"values\": [-0.9]", "m.json: reflectance: "},
      {"\"reflectance\"", "\"reflectence\"", "m.json: reflectence: unknown field"},
      {"\"values\": [0.9]", "\"values\": [0.9], \"covariance\": [1, 2], \"covariance_with_f11\": [0]",
       "m.json: reflectance.covariance: 2 numbers in place of 1"},
      {"\"values\": [0.9]", "\"values\": [0.9], \"covariance\": [-1], \"covariance_with_f11\": [0]",
       "m.json: reflectance.covariance: variance 0 is negative"},
      {"\"values\": [0.9]", "\"values\": [0.9], \"covariance\": [1], \"covariance_with_f11\": [0, 1]",
       "m.json: reflectance.covariance_with_f11: 2 numbers in place of 1"},
      {"\"values\": [0.9]", "\"values\": [0.9], \"covariance_with_f11\": [0]",
       "m.json: reflectance.covariance_with_f11: there is no covariance"},
      {"\"rank\"", "\"ranc\"", "m.json: blocks[0].ranc: unknown field"},
      {"\"provenance\": {}", "\"provenance\": {\"data\": 1}", "m.json: provenance.data: must be a string, not 1"},
      {"\"name\": \"small\"", "\"name\": \"small\", \"name\": \"other\"", "m.json: the field 'name' is there twice"},
  };
  for (const auto& change : cases) EXPECT_TRUE(says(refusal(with(text, change[0], change[1])), {change[2]}));
}

TEST(Json, WithAPosteriorThatIsNoneIsRefusedByItsPath) {
  const std::string text = to_json(material("ptfe-532"));
  EXPECT_EQ(refusal(text), "");
  // What stands behind the colon of the first field of this name.
  const auto in_place_of = [&](const std::string& field, const std::string& other) {
    const std::size_t begin = text.find(':', text.find("\"" + field + "\"", text.find("\"posterior\""))) + 1;
    std::string changed = text;
    return refusal(changed.replace(begin, text.find_first_of(",}\n", begin) - begin, " " + other));
  };
  const std::string block = "m.json: posterior.wavelengths[0].blocks[0]";
  for (const char* four_bytes_of_eight : {"\"AAAA\"", "\"AAA\"", "\"A!==\"", "\"AAAAAA==\""})
    EXPECT_EQ(in_place_of("mean", four_bytes_of_eight), block + ".mean: must be numbers of 64 bits in base 64");
  EXPECT_EQ(in_place_of("free_mean", "\"AAAA\""), block + ".free_mean: must be numbers of 32 bits in base 64");
  for (const char* wrong : {"AAAA", "A", "A!=="})
    EXPECT_TRUE(says(
        refusal(with(text, "\"mean\":", "\"deviations\": \"\", \"factor\": \"" + std::string(wrong) + "\", \"mean\":")),
        {block + ".factor: must be ", " numbers of 12 bits in base 64"}));
  EXPECT_EQ(in_place_of("angles_rad", "\"AAAAAA==\""),
            "m.json: posterior.readings[0]: must be four angles for each count");
  EXPECT_TRUE(says(in_place_of("elements", "\"44\""), {block + ".elements: ", "block 11 comes here"}));
  const std::size_t of_wavelength = text.find("\"readings\"", text.find("\"law\""));
  std::string negative = text;
  negative.replace(text.find_first_of("0123456789", of_wavelength), 1, "-1");
  EXPECT_EQ(refusal(negative), "m.json: posterior.wavelengths[0].readings: -1 is negative");
}

TEST(Json, WithNamesThatWouldSpoilATerminalIsRefusedInOneLine) {
  std::string text = to_json(any_model());
  text.insert(text.find("\"name\""), "\"a\\n\\u001b[31m" + std::string(9000, 'x') + "\": 1, ");
  const std::string message = complaint([&] { model_from_json(text, "m.json"); });
  EXPECT_TRUE(says(message, {"m.json: 'a\\x0a\\x1b[31mx", "...': unknown field"}));
  EXPECT_LT(message.size(), 100u);
}

TEST(Json, WithABlockTwiceOrOutOfOrderIsRefused) {
  const std::string text = small_file();
  const std::size_t begin = text.find("    {", text.find("\"blocks\"")), end = text.rfind("  ]");
  const std::size_t middle = text.find("    {", begin + 1);
  const std::string first = text.substr(begin, middle - begin), second = text.substr(middle, end - middle);
  const std::string head = text.substr(0, begin), tail = text.substr(end);
  EXPECT_EQ(refusal(head + first + second + tail), "");
  EXPECT_TRUE(
      says(refusal(head + second.substr(0, second.size() - 1) + ",\n" + first.substr(0, first.size() - 2) + tail),
           {"m.json: blocks[0]: block 44 is out of order"}));
  EXPECT_TRUE(says(refusal(head + first + first + second + tail), {"m.json: blocks: mode 11", "given twice"}));
  EXPECT_TRUE(
      says(refusal(head + first + with(first, "0,0,0,0", "2,0,0,0") + second + tail), {"m.json: blocks[1]: block 11"}));
  EXPECT_TRUE(says(refusal(head + second + tail), {"m.json: ", "element 11"}));
  EXPECT_TRUE(says(refusal(head + tail), {"m.json: blocks: there is no block"}));
}

TEST(Json, IsNotMadeOfInvalidModels) {
  Model model = any_model();
  model.blocks[0].coefficients[0] = std::nan("");
  EXPECT_THROW(to_json(model), std::invalid_argument);
  model = any_model();
  model.blocks[0].covariance.pop_back();
  EXPECT_THROW(to_json(model), std::invalid_argument);
  model = any_model();
  model.blocks[0].condition = std::numeric_limits<double>::infinity();
  EXPECT_THROW(to_json(model), std::invalid_argument);
  model = any_model();
  model.provenance["data"] = "\xff";
  EXPECT_THROW(to_json(model), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
