// SPDX-License-Identifier: BSD-3-Clause
// What a caller of mmbrdf.h gets is what the library gives, to the last bit. That a C compiler takes it, and links what is
// installed, is tested by run.py.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "given/files.hpp"
#include "mmbrdf.h"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

using namespace mmbrdf;

namespace {

constexpr double wavelength = 0.532;

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

/// Equal to the last bit, and NaN where the other is.
void expect_same(double a, double b) {
  if (a != a && b != b) return;
  EXPECT_EQ(bits(a), bits(b)) << a << " and " << b;
}

/// Geometries, and the numbers in which C has them.
struct Asked {
  explicit Asked(int count) : geometries(random_geometries(count, 1)) {
    for (const Geometry& g : geometries)
      numbers.insert(numbers.end(), {g.incident.theta, g.incident.phi, g.reflected.theta, g.reflected.phi});
  }
  std::int64_t n() const { return static_cast<std::int64_t>(geometries.size()); }
  std::vector<Geometry> geometries;
  std::vector<double> numbers;
};

/// Handles of a model, freed in the end.
struct Handles {
  explicit Handles(const char* name) {
    EXPECT_EQ(mmbrdf_material(name, &model, &error), MMBRDF_OK) << error.message;
    EXPECT_EQ(mmbrdf_prepare(model, wavelength, &prepared, &error), MMBRDF_OK) << error.message;
  }
  explicit Handles(const Model& of, const std::string& path) {
    save_model(path, of);
    EXPECT_EQ(mmbrdf_load_model(path.c_str(), &model, &error), MMBRDF_OK) << error.message;
    EXPECT_EQ(mmbrdf_prepare(model, wavelength, &prepared, &error), MMBRDF_OK) << error.message;
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    mmbrdf_free_prepared(prepared);
    mmbrdf_free_model(model);
  }
  mmbrdf_error error{};
  mmbrdf_model* model = nullptr;
  mmbrdf_prepared* prepared = nullptr;
};

/// f11 and elements 12, 21 and 22 measured; no covariance.
Model partly_measured() {
  Model model = material("ptfe-532");
  std::erase_if(model.blocks, [](const FittedBlock& b) {
    return b.block.elements.front() != Element{0, 0} && b.block.elements.front() != Element{0, 1};
  });
  model.posterior.reset();
  return model;
}

TEST(CInterface, GivesTheMatricesOfTheLibraryInEveryFrameConventionAndOrder) {
  const Asked asked(9000);  // enough for two threads
  const Handles ptfe("ptfe");
  std::vector<Mueller> expected(asked.geometries.size());
  std::vector<double> got(16 * expected.size());
  for (int frame = MMBRDF_XY; frame <= MMBRDF_SCATTERING_PLANE; ++frame) {
    evaluate(prepare(material("ptfe"), wavelength), asked.geometries, expected, {.frame = static_cast<Frame>(frame)});
    for (int convention = MMBRDF_GERMER2017; convention <= MMBRDF_P_FIRST_LEFT_HANDED_AXES_RIGHT; ++convention)
      for (const int order : {MMBRDF_ROW_MAJOR, MMBRDF_COLUMN_MAJOR}) {
        const mmbrdf_layout layout{frame, convention, order};
        ASSERT_EQ(
            mmbrdf_evaluate(ptfe.prepared, asked.n(), asked.numbers.data(), &layout, 1 + order, got.data(), nullptr),
            MMBRDF_OK);
        for (std::size_t q = 0; q < expected.size(); q += 7) {
          const Mueller m =
              convert(expected[q], StokesConvention::germer2017, static_cast<StokesConvention>(convention));
          for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j)
              expect_same(got[16 * q + (order == MMBRDF_ROW_MAJOR ? 4 * i + j : i + 4 * j)], m.elements[4 * i + j]);
        }
      }
  }
}

TEST(CInterface, TakesNoLayoutForTheOneOfTheProject) {
  const Asked asked(3);
  const Handles ptfe("ptfe");
  std::vector<double> got(48), f11(3);
  ASSERT_EQ(mmbrdf_evaluate(ptfe.prepared, 3, asked.numbers.data(), nullptr, 1, got.data(), nullptr), MMBRDF_OK);
  ASSERT_EQ(mmbrdf_f11(ptfe.prepared, 3, asked.numbers.data(), 1, f11.data(), nullptr), MMBRDF_OK);
  const PreparedModel prepared = prepare(material("ptfe"), wavelength);
  for (std::size_t q = 0; q < 3; ++q) {
    const Mueller m = prepared.evaluate(asked.geometries[q]);
    for (std::size_t e = 0; e < 16; ++e) expect_same(got[16 * q + e], m.elements[e]);
    expect_same(f11[q], m(0, 0));
  }
}

TEST(CInterface, GivesTheUncertaintiesQuantitiesAndRangesOfTheLibrary) {
  const Asked asked(600);
  const Handles ptfe("ptfe");
  const Model model = material("ptfe");
  const std::size_t n = asked.geometries.size();

  const mmbrdf_layout layout{MMBRDF_SP, MMBRDF_P_FIRST_RIGHT, MMBRDF_COLUMN_MAJOR};
  std::vector<Mueller> u(n);
  prepare_uncertainty(model, wavelength).standard_uncertainty(asked.geometries, Frame::sp, u);
  std::vector<double> got(16 * n);
  ASSERT_EQ(
      mmbrdf_standard_uncertainty(ptfe.prepared, asked.n(), asked.numbers.data(), &layout, 1, got.data(), nullptr), 0);
  for (std::size_t q = 0; q < n; ++q)
    for (std::size_t e = 0; e < 16; ++e) expect_same(got[16 * q + 4 * (e % 4) + e / 4], u[q].elements[e]);

  const auto table = quantities(false);
  ASSERT_EQ(mmbrdf_quantity_count(), static_cast<int>(table.size()));
  const PreparedAnswers answers = Answers(model, {.parts = false}).at(wavelength);
  std::vector<double> values(table.size() * n), u_values(table.size() * n);
  ASSERT_EQ(mmbrdf_analyze(ptfe.prepared, mmbrdf_quantity_count(), nullptr, asked.n(), asked.numbers.data(), 1,
                           values.data(), u_values.data(), nullptr),
            MMBRDF_OK);
  std::vector<int> outside(n);
  ASSERT_EQ(mmbrdf_outside(ptfe.prepared, asked.n(), asked.numbers.data(), outside.data(), nullptr), MMBRDF_OK);
  const std::vector<Answer> all = answers.at(asked.geometries);
  for (std::size_t q = 0; q < n; ++q) {
    for (std::size_t k = 0; k < table.size(); ++k) {
      expect_same(values[n * k + q], all[q].quantities[k].value.value_or(std::nan("")));
      expect_same(u_values[n * k + q], all[q].quantities[k].uncertainty.value_or(std::nan("")));
    }
    EXPECT_EQ(outside[q], static_cast<int>(all[q].outside));
  }
  for (std::size_t k = 0; k < table.size(); ++k) {
    mmbrdf_quantity quantity;
    ASSERT_EQ(mmbrdf_quantity_at(static_cast<int>(k), &quantity, nullptr), MMBRDF_OK);
    EXPECT_EQ(quantity.name, table[k].name);  // as texts that end with 0
    EXPECT_EQ(quantity.unit, table[k].unit);
    EXPECT_EQ(quantity.meaning, table[k].meaning);
    ASSERT_EQ(
        mmbrdf_analyze(ptfe.prepared, 1, &quantity.name, 1, asked.numbers.data(), 1, got.data(), nullptr, nullptr), 0);
    expect_same(got[0], values[n * k]);
  }
}

TEST(CInterface, GivesTheReflectanceOfTheLibraryWithItsUncertainty) {
  const Handles ptfe("ptfe");
  const std::vector<double> directions{0, 0, 0.14, 1, 1.2, -2};
  double dhr[3], u[3];
  ASSERT_EQ(mmbrdf_dhr(ptfe.prepared, 3, directions.data(), dhr, u, nullptr), MMBRDF_OK);
  for (std::size_t q = 0; q < 3; ++q) {
    const Direction d{directions[2 * q], directions[2 * q + 1]};
    expect_same(dhr[q], directional_hemispherical_reflectance(material("ptfe"), wavelength, d));
    expect_same(u[q], prepare_uncertainty(material("ptfe"), wavelength).directional_hemispherical_reflectance(d));
  }
}

TEST(CInterface, SaysWhatTheModelSaysOfItself) {
  const Handles ptfe("ptfe");
  const Model model = material("ptfe");
  mmbrdf_description said;
  ASSERT_EQ(mmbrdf_describe(ptfe.model, &said, nullptr), MMBRDF_OK);
  EXPECT_EQ(said.name, model.name);
  EXPECT_EQ(said.basis, basis_line(model));
  EXPECT_EQ(said.fitted_range, fitted_range(model.validity));
  EXPECT_EQ(std::vector(said.wavelength_um, said.wavelength_um + said.wavelengths), model.validity.wavelengths);
  expect_same(said.theta_i_max_rad, *model.validity.theta_i_max);
  expect_same(said.theta_r_max_rad, *model.validity.theta_r_max);
  EXPECT_EQ(said.has_uncertainty, 1);
  EXPECT_STREQ(mmbrdf_version(), MMBRDF_VERSION);
  ASSERT_EQ(static_cast<std::size_t>(mmbrdf_material_count()), materials().size());
  for (int i = 0; i < mmbrdf_material_count(); ++i)
    EXPECT_EQ(mmbrdf_material_name(i), materials()[static_cast<std::size_t>(i)]);
  EXPECT_EQ(mmbrdf_material_name(-1), nullptr);
  EXPECT_EQ(mmbrdf_material_name(mmbrdf_material_count()), nullptr);
}

TEST(CInterface, HasNanForWhatWasNotMeasuredAndSaysWhich) {
  const Folder folder;
  Model model = partly_measured();
  for (std::size_t e = 0; e < 16; ++e) model.not_measured[e] = true;
  for (const FittedBlock& b : model.blocks)
    for (const Element e : b.block.elements) model.not_measured[e.index()] = false;
  for (const FittedBlock& b : model.blocks)  // of 12, 13, 21, 31 the first: the transpose of what is known is another
    if (b.block.elements.size() > 1) model.not_measured[b.block.elements[0].index()] = true;
  const Handles some(model, folder / "some.json");
  const Asked asked(50);
  std::vector<double> matrix(16), u(16);
  for (const int order : {MMBRDF_ROW_MAJOR, MMBRDF_COLUMN_MAJOR})
    for (const int frame : {MMBRDF_XY, MMBRDF_SP}) {
      const mmbrdf_layout layout{frame, MMBRDF_P_FIRST_LEFT, order};
      int known[16];
      ASSERT_EQ(mmbrdf_known_elements(some.model, &layout, known, nullptr), MMBRDF_OK);
      ASSERT_EQ(mmbrdf_evaluate(some.prepared, 1, asked.numbers.data(), &layout, 1, matrix.data(), nullptr), MMBRDF_OK);
      ASSERT_EQ(mmbrdf_standard_uncertainty(some.prepared, 1, asked.numbers.data(), &layout, 1, u.data(), nullptr), 0);
      int count = 0;
      for (std::size_t e = 0; e < 16; ++e) {
        EXPECT_EQ(known[e] == 1, matrix[e] == matrix[e]);
        EXPECT_NE(u[e], u[e]) << "the model has no covariance";
        count += known[e];
      }
      EXPECT_GT(count, 0);
      EXPECT_LT(count, 16);
    }
  mmbrdf_description said;
  ASSERT_EQ(mmbrdf_describe(some.model, &said, nullptr), MMBRDF_OK);
  EXPECT_EQ(said.has_uncertainty, 0);
}

TEST(CInterface, PreparesUncertaintiesOnceForManyThreads) {
  const Handles ptfe("ptfe");
  const Asked asked(20);
  std::vector<std::vector<double>> got(8, std::vector<double>(16 * 20));
  {
    std::vector<std::jthread> threads;
    for (auto& own : got)
      threads.emplace_back([&] {
        mmbrdf_standard_uncertainty(ptfe.prepared, 20, asked.numbers.data(), nullptr, 1, own.data(), nullptr);
      });
  }
  for (const auto& own : got) EXPECT_EQ(own, got[0]);
  EXPECT_GT(got[0][0], 0);
}

/// A mistake has its code and one line, whether or not somebody wants to read it.
void expect_refused(int code, const mmbrdf_error& error, int expected, const std::string& message) {
  EXPECT_EQ(code, expected) << error.message;
  EXPECT_EQ(error.code, expected);
  EXPECT_NE(std::string(error.message).find(message), std::string::npos) << error.message;
  EXPECT_EQ(std::string(error.message).find('\n'), std::string::npos) << error.message;
}

TEST(CInterface, TakesNanometresForMicrometresAndSaysThatTheyAreOutside) {
  const Handles ptfe("ptfe");
  const double geometry[4] = {0.1, 0, 0.2, 3};
  mmbrdf_error e;
  mmbrdf_prepared* prepared = nullptr;
  int outside = 0;
  ASSERT_EQ(mmbrdf_prepare(ptfe.model, 532, &prepared, &e), MMBRDF_OK) << e.message;
  EXPECT_EQ(mmbrdf_outside(prepared, 1, geometry, &outside, &e), MMBRDF_OK) << e.message;
  EXPECT_EQ(outside, MMBRDF_OUTSIDE_WAVELENGTH);
  mmbrdf_free_prepared(prepared);
}

TEST(CInterface, AnswersMistakesWithACodeAndALine) {
  const Handles ptfe("ptfe");
  const double good[4] = {0.1, 0, 0.2, 3}, bad[8] = {0.1, 0, 0.2, 3, 0.1, 0, 2, 0};
  double out[32], *const none = nullptr;
  mmbrdf_error e;
  mmbrdf_model* model = ptfe.model;
  mmbrdf_prepared* prepared = ptfe.prepared;
  constexpr int wrong = MMBRDF_INVALID_ARGUMENT;
  expect_refused(mmbrdf_material("nowhere", &model, &e), e, wrong, "'nowhere' is not one of ptfe, ");
  EXPECT_EQ(model, nullptr);
  expect_refused(mmbrdf_material(nullptr, &model, &e), e, wrong, "name is null");
  expect_refused(mmbrdf_material("ptfe", nullptr, &e), e, wrong, "model is null");
  expect_refused(mmbrdf_load_model("no/such\n.json", &model, &e), e, MMBRDF_FAILED, "No such file");
  expect_refused(mmbrdf_load_model(std::string(5000, 'x').c_str(), &model, &e), e, MMBRDF_FAILED, "...");
  EXPECT_LT(std::string(e.message).size(), sizeof e.message);
  expect_refused(mmbrdf_prepare(nullptr, wavelength, &prepared, &e), e, wrong, "model is null");
  EXPECT_EQ(prepared, nullptr);
  expect_refused(mmbrdf_prepare(ptfe.model, -1, &prepared, &e), e, wrong, "wavelength");
  prepared = ptfe.prepared;
  expect_refused(mmbrdf_evaluate(nullptr, 1, good, nullptr, 1, out, &e), e, wrong, "prepared is null");
  expect_refused(mmbrdf_evaluate(prepared, -1, good, nullptr, 1, out, &e), e, wrong, "n = -1");
  expect_refused(mmbrdf_evaluate(prepared, INT64_MAX, good, nullptr, 1, out, &e), e, wrong, "n = 9223");
  expect_refused(mmbrdf_evaluate(prepared, 1, none, nullptr, 1, out, &e), e, wrong, "geometries_rad is null");
  expect_refused(mmbrdf_evaluate(prepared, 1, good, nullptr, 1, none, &e), e, wrong, "matrices is null");
  expect_refused(mmbrdf_evaluate(prepared, 1, good, nullptr, -1, out, &e), e, wrong, "threads = -1");
  expect_refused(mmbrdf_evaluate(prepared, 2, bad, nullptr, 1, out, &e), e, wrong, "geometry 2: theta_r");
  expect_refused(mmbrdf_f11(prepared, 2, bad, 1, out, &e), e, wrong, "geometry 2: theta_r");
  expect_refused(mmbrdf_standard_uncertainty(prepared, 2, bad, nullptr, 1, out, &e), e, wrong, "geometry 2: theta_r");
  for (const mmbrdf_layout& layout : {mmbrdf_layout{3, 0, 0}, {0, 6, 0}, {0, 0, 2}, {-1, 0, 0}})
    expect_refused(mmbrdf_evaluate(prepared, 1, good, &layout, 1, out, &e), e, wrong, ", must be from 0 to ");
  mmbrdf_layout layout;
  expect_refused(mmbrdf_layout_from("ps", "germer2017", 0, &layout, &e), e, wrong, "ps");
  expect_refused(mmbrdf_layout_from("sp", "iau", 0, &layout, &e), e, wrong, "iau");
  expect_refused(mmbrdf_layout_from("sp", "germer2017", 0, nullptr, &e), e, wrong, "layout is null");
  EXPECT_EQ(mmbrdf_layout_from("sp", "p_first_left", 1, &layout, &e), 0);
  EXPECT_TRUE(layout.frame == MMBRDF_SP && layout.convention == MMBRDF_P_FIRST_LEFT && layout.order == 1);
  const char* names[] = {"f_ss", nullptr, "stokes"};
  expect_refused(mmbrdf_analyze(prepared, 2, names, 1, good, 1, out, none, &e), e, wrong, "name of a quantity is null");
  names[1] = "gloss";
  expect_refused(mmbrdf_analyze(prepared, 2, names, 1, good, 1, out, none, &e), e, wrong, "'gloss' is not known");
  names[1] = quantities(true).back().name.data();
  expect_refused(mmbrdf_analyze(prepared, 2, names, 1, good, 1, out, none, &e), e, wrong, "takes light");
  expect_refused(mmbrdf_analyze(prepared, 1, nullptr, 1, good, 1, out, none, &e), e, wrong, "count = 1");
  expect_refused(mmbrdf_quantity_at(mmbrdf_quantity_count(), nullptr, &e), e, wrong, "number");
  expect_refused(mmbrdf_dhr(prepared, 1, &bad[6], out, none, &e), e, wrong, "direction 1");
  expect_refused(mmbrdf_describe(ptfe.model, nullptr, &e), e, wrong, "description is null");
  EXPECT_EQ(mmbrdf_evaluate(prepared, -1, good, nullptr, 1, out, nullptr), wrong);  // nobody reads the message
  EXPECT_EQ(mmbrdf_evaluate(prepared, 0, none, nullptr, 0, none, &e), MMBRDF_OK);
  EXPECT_STREQ(e.message, "");
  mmbrdf_free_model(nullptr);
  mmbrdf_free_prepared(nullptr);
}

}  // namespace
