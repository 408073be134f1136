// SPDX-License-Identifier: BSD-3-Clause
// The law of files: whatever a fit gives is written, read back to the same bits, and usable.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include "given/files.hpp"
#include "mmbrdf/files/coefficients_file.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {
namespace {

/// How many fits: MMBRDF_FITS, or 100.
unsigned long fits() {
  const char* const given = std::getenv("MMBRDF_FITS");
  return given ? std::stoul(given) : 100;
}

/// A small data set with a basis and options, any that there are.
struct Case {
  std::mt19937_64 engine;
  bool of_sample;  // one of sixteen: it takes 30 samples for each wavelength, and longer
  std::vector<Sample> samples;
  Basis basis;
  FitOptions options;
  Weights weights;

  explicit Case(unsigned long seed) : engine(seed), of_sample(one_of(16) == 0) {
    const std::size_t wavelengths = 1 + one_of(of_sample ? 2 : 4), rows = of_sample ? 30 + one_of(6) : 1 + one_of(12);
    const std::size_t kind = one_of(4);
    for (std::size_t w = 0; w < wavelengths; ++w)
      for (std::size_t r = 0; r < rows; ++r) add_sample(0.35 + 0.2 * static_cast<double>(w), kind);
    basis = {of_sample ? Family::isotropic : static_cast<Family>(one_of(3)),
             {order(), order()},
             static_cast<DiscMapping>(one_of(2)),
             Rotation::covariant};
    if (basis.family == Family::germer2017) basis.rotation = static_cast<Rotation>(one_of(2));
    options.minimum_norm = of_sample || one_of(4) > 0;
    options.uncertainty = one_of(2) == 0 || of_sample ? Uncertainty::sample : Uncertainty::noise;
    options.covariance = of_sample ? Covariance::residuals : static_cast<Covariance>(one_of(3));
    weights = options.covariance == Covariance::given ? Weights::data : static_cast<Weights>(one_of(4));
    if (of_sample) weights = one_of(2) ? Weights::speckle : Weights::none;
    if (one_of(3) == 0) options.powers = static_cast<int>(one_of(wavelengths));
    if (one_of(3) == 0) options.reflectance = ReflectanceTable{{0.3, 1.2}, {0.9, 0.95}};
    if (one_of(3) == 0) forget_elements(one_of(2) == 0);
  }

  /// Those of row and column 4, or any.
  void forget_elements(bool of_linear_states) {
    const Elements some = of_linear_states ? 0xf888 : engine() & 0xfffe;
    for (Sample& sample : samples)
      for (std::size_t e = 1; e < 16; ++e)
        if (some[e] && (of_linear_states || one_of(4) > 0))
          sample.normalized.elements[e] = std::numeric_limits<double>::quiet_NaN();
  }

  std::size_t one_of(std::size_t count) { return engine() % count; }
  int order() { return static_cast<int>(of_sample ? 2 + one_of(2) : one_of(4)); }
  double part() { return static_cast<double>(engine() >> 11) * 0x1p-53; }
  double noise() { return 0.02 * (2 * part() - 1); }

  /// In any directions, hardly apart, in one plane, or all in the same two directions.
  void add_sample(double wavelength, std::size_t kind) {
    const double step = radians(static_cast<double>(one_of(4)));
    Sample s{wavelength, {{0.7, 0}, {0.5, 2}}, 0.3 * (1 + noise()), {}};
    if (kind == 0) s.geometry = {{1.4 * part(), 6 * part()}, {1.4 * part(), 6 * part()}};
    if (kind == 1) s.geometry = {{0.7 + step, 0}, {0.5 + radians(static_cast<double>(one_of(3))), 2 + step}};
    if (kind == 2) s.geometry = {{1.4 * part(), 0}, {1.4 * part(), one_of(2) ? 0 : radians(180)}};
    for (double& element : s.normalized.elements) element = noise();
    s.normalized(0, 0) = 1;
    s.uncertainty.elements.fill(0.01 * (0.5 + part()));
    samples.push_back(s);
  }

  Geometry geometry() { return {{1.5 * part(), 6 * part()}, {1.5 * part(), 6 * part()}}; }
};

/// Finite, and NaN where they were not measured.
void expect_known(const Mueller& m, const Elements& unknown, const char* what) {
  for (std::size_t e = 0; e < 16; ++e)
    EXPECT_TRUE(unknown[e] ? std::isnan(m.elements[e]) : std::isfinite(m.elements[e])) << what << " " << e;
}

/// Evaluates, analyzes and integrates.
void use(const Model& model, Case& from) {
  const int draws = model.posterior ? 0 : 20;
  const Elements unknown = unknown_elements(model);
  const Answers answers(model, {.light = Stokes{1, 0.3, 0, 0.1}, .draws = draws});
  for (const double wavelength : {from.samples.front().wavelength, 0.43}) {
    const PreparedModel prepared = prepare(model, wavelength);
    const PreparedAnswers here = answers.at(wavelength);
    for (const Geometry& g : {from.samples.front().geometry, from.geometry()}) {
      expect_known(prepared.evaluate(g), unknown, "element");
      const Answer answer = here.at(g);
      if (answer.uncertainties) expect_known(*answer.uncertainties, unknown, "uncertainty of an element");
      for (const Answered& q : answer.quantities)
        for (const auto& number : {q.value, q.uncertainty, q.low, q.high})
          EXPECT_TRUE(std::isfinite(number.value_or(0))) << q.quantity->name;
    }
    const Average mean = average(prepared, Aperture::cone({0.3, 0}, 0.02), Aperture::direction({0.5, 1}));
    expect_known(mean.mueller, unknown, "mean");
    EXPECT_TRUE(std::isfinite(directional_hemispherical_reflectance(model, wavelength, {0.2, 0})));
    if (!answers.unknown_uncertainty().empty()) continue;
    EXPECT_GE(prepare_uncertainty(model, wavelength).directional_hemispherical_reflectance({0.2, 0}), 0);
  }
}

}  // namespace

TEST(FittedModels, OfEveryKindAreReadBackToTheSameBitsAndUsable) {
  const Folder folder;
  unsigned long fitted = 0, of_sample = 0, refused = 0;
  for (unsigned long seed = 1; seed <= fits(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Case one(seed);
    Model model;
    try {
      model = fit(one.samples, one.basis, one.options, one.weights).model;
    } catch (const std::invalid_argument&) {  // too few rows, or a reflectance that is not positive
      ++refused;
      continue;
    }
    ++fitted;
    of_sample += model.posterior ? 1 : 0;
    try {
      model.name = "m";
      save_model(folder / "m.json", model);
      const Model back = load_model(folder / "m.json");
      EXPECT_TRUE(to_json(back) == contents(folder / "m.json"));
      use(back, one);
      if (model.family == Family::germer2017 && model.mapping == DiscMapping::lambert) {
        save_model(folder / "m.csv", model);
        use(load_model(folder / "m.csv"), one);
      }
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
  std::cout << fitted << " fits read back and used, " << of_sample << " of the sample; " << refused << " refused\n";
  EXPECT_GT(fitted, fits() / 2);
  EXPECT_GT(of_sample, fits() / 50);
}

}  // namespace mmbrdf
