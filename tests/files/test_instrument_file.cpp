// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/instrument_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <functional>
#include <sstream>

#include "given/cases.hpp"
#include "given/files.hpp"
#include "mmbrdf/files/readings_file.hpp"
#include "mmbrdf/polarimetry/goniometer.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"

namespace mmbrdf {
namespace {

Calibration any_calibration() {
  Calibration c;
  c.wavelength = 0.532;
  const double azimuths[] = {-0.9, -0.26, 0.26, 0.9, 1.1};
  c.polarimeter = ideal_polarimeter(radians(131.8), azimuths);
  const std::size_t size = 40;
  c.covariance.resize(size * size);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j)
      c.covariance[i * size + j] = 1e-9 * (i == j ? 1.1 : 0.01 / 3 / double(1 + i + j));
  c.polarizer_offset = radians(23);
  c.extinction = 1e-5 / 3;
  c.polarizer_phase = 0.1;
  c.film_thickness = 1.0 / 3;
  c.film_misfit = 0.01 / 3;
  c.scale_uncertainty = 0.01 / 7;
  c.figure_of_merit = {1e-3 / 3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3, {}};
  c.figure_of_merit.elements(1, 2) = 1e-3 / 7;
  c.singular_ratio = 0.01 / 3;
  c.identifiability = 0.02;
  c.generator_condition = condition_number(c.polarimeter.generator);
  c.analyzer_condition = condition_number(c.polarimeter.analyzer);
  c.chi_squared = 812.5;
  c.degrees_of_freedom = 800;
  c.provenance = {{"data", "references.csv"}};
  return c;
}

TEST(Instrument, IsReadBackFromItsFileToTheSameBits) {
  const Calibration c = any_calibration();
  const Folder folder;
  save_instrument(folder / "i.json", c);
  const Calibration back = load_instrument(folder / "i.json");
  EXPECT_EQ(back.wavelength, c.wavelength);
  EXPECT_EQ(back.polarimeter.generator, c.polarimeter.generator);
  EXPECT_EQ(back.polarimeter.analyzer, c.polarimeter.analyzer);
  EXPECT_EQ(back.covariance, c.covariance);
  EXPECT_NEAR(back.polarizer_offset, c.polarizer_offset, 1e-15);
  EXPECT_NEAR(back.polarizer_phase, c.polarizer_phase, 1e-15);
  EXPECT_EQ(back.extinction, c.extinction);
  EXPECT_EQ(back.film_thickness, c.film_thickness);
  EXPECT_NEAR(back.film_misfit, c.film_misfit, 1e-15);
  EXPECT_EQ(back.scale_uncertainty, c.scale_uncertainty);
  EXPECT_EQ(back.figure_of_merit.total, c.figure_of_merit.total);
  EXPECT_EQ(back.figure_of_merit.wafer, c.figure_of_merit.wafer);
  EXPECT_EQ(back.figure_of_merit.elements.elements, c.figure_of_merit.elements.elements);
  EXPECT_EQ(back.identifiability, c.identifiability);
  EXPECT_EQ(back.chi_squared, c.chi_squared);
  EXPECT_EQ(back.degrees_of_freedom, c.degrees_of_freedom);
  EXPECT_EQ(back.provenance, c.provenance);
  EXPECT_EQ(to_json(back), to_json(c));
}

TEST(Instrument, OfTurningRetardersIsReadBackFromItsFewNumbers) {
  GoniometerOptions made;
  made.dials = dial_angles(5, radians(6), 61);
  made.retardance = radians(90);
  CalibrationOptions options;
  options.wavelength = 0.532;
  options.retarders.emplace();
  options.retarders->dials = made.dials;
  const std::vector<Reference> references = Goniometer(made, 1).references(0.532, 1, 2);
  const Calibration c = calibrate(std::span(references).first(1), options);
  const std::string text = to_json(c);
  EXPECT_LT(text.size(), 10'000u);
  const Calibration back = calibration_from_json(text, "i.json");
  ASSERT_TRUE(back.retarders);
  EXPECT_EQ(back.retarders->covariance, c.retarders->covariance);
  EXPECT_EQ(back.polarimeter.pairs, c.polarimeter.pairs);
  for (std::size_t k = 0; k < retarder_parameters; ++k)  // angles go through degrees
    EXPECT_NEAR(parameters(back.retarders->values)[k], parameters(c.retarders->values)[k], 1e-15);
  ASSERT_EQ(back.covariance.size(), c.covariance.size());
  for (std::size_t k = 0; k < c.covariance.size(); ++k) EXPECT_NEAR(back.covariance[k], c.covariance[k], 1e-18);
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return complaint([&] { calibration_from_json(changed, "i.json"); });
  };
  EXPECT_TRUE(
      says(refusal("\"retarders\": {", "\"generator\": [[1, 0, 0, 0]], \"retarders\": {"), {"i.json: generator"}));
  EXPECT_TRUE(says(refusal("\"responsivity\": ", "\"responsivity\": -"), {"responsivity", "is not positive"}));
  EXPECT_TRUE(says(refusal("\"dials_deg\": [", "\"dials_deg\": [[1, 2, 3], "), {"dials_deg"}));
  EXPECT_TRUE(says(refusal("\"extinction\": 0.0,", "\"extinction\": 2.0,"), {"extinction"}));
}

TEST(Instrument, ThatCannotBeIsRefusedWithItsField) {
  const std::string text = to_json(any_calibration());
  const auto complains = [&](const std::string& what, const std::string& with) {
    std::string bad = text;
    bad.replace(bad.find(what), what.size(), with);
    return complaint([&] { calibration_from_json(bad, "i.json"); });
  };
  EXPECT_TRUE(says(complains("mmbrdf instrument", "mmbrdf model"), {"i.json: format: 'mmbrdf model'"}));
  EXPECT_TRUE(says(complains("532.0", "-1"), {"i.json: wavelength_nm: -1 is not positive"}));
  EXPECT_TRUE(says(complains("532.0", "1e308"), {"i.json: wavelength_nm: ", "is not a wavelength in nm"}));
  const std::string condition = "\"generator_condition\": ";
  EXPECT_TRUE(
      says(complains(condition, condition + "1"), {"i.json: generator_condition: 1", "the states of the file"}));
  EXPECT_TRUE(says(complains("\"degrees_of_freedom\": 800", "\"degrees_of_freedom\": -1"),
                   {"i.json: degrees_of_freedom: -1 is negative"}));
  EXPECT_TRUE(says(complains("\"degrees_of_freedom\": 800", "\"degrees_of_freedom\": 0"),
                   {"i.json: degrees_of_freedom: 0, and there is a covariance"}));
  EXPECT_TRUE(says(complains("\"scattering_plane\"", "\"xy\""), {"i.json: conventions.frame: 'xy'"}));
  EXPECT_TRUE(says(complains("\"singular_ratio\"", "\"singular\""), {"i.json: singular: unknown field"}));
  EXPECT_TRUE(says(complains("\"generator\": [", "\"generator\": [[1, 0, 0],"), {"i.json: generator[0]: 3 numbers"}));
  EXPECT_TRUE(says(complains("\"covariance\": [", "\"covariance\": [1, "), {"i.json: covariance: 821 numbers"}));
}

/// Kilobytes that this process has had at most.
long most_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

Calibration with_states(std::size_t count) {
  Calibration c = any_calibration();
  std::vector<double> azimuths;
  for (std::size_t k = 0; k < count; ++k) azimuths.push_back(3 * static_cast<double>(k) / static_cast<double>(count));
  c.polarimeter = ideal_polarimeter(radians(131.8), azimuths);
  c.generator_condition = condition_number(c.polarimeter.generator);
  c.analyzer_condition = condition_number(c.polarimeter.analyzer);
  const std::size_t size = 8 * count;
  c.covariance.assign(size * size, 1e-9 / 3);
  for (std::size_t i = 0; i < size; ++i) c.covariance[i * size + i] = 1e-8 / 3;
  return c;
}

TEST(Instrument, OfTheMostStatesIsReadAndReducesInFiftyMegabytes) {
  const std::string text = to_json(with_states(most_states));
  const long before = most_memory();
  const Calibration c = calibration_from_json(text, "i.json");
  const Reduction reduction(c.polarimeter, c.covariance);
  const Mueller m = reduction.mueller(readings(c.polarimeter, diagonal(1, 0.5, 0.4, 0.3)));
  EXPECT_NEAR(m(1, 1), 0.5, 1e-12);
  EXPECT_EQ(reduction.errors(m).size(), 8 * most_states);
  EXPECT_LT(most_memory() - before, 50'000);
}

TEST(Instrument, OfMoreStatesIsRefusedByFileReadingsReductionAndCalibration) {
  const Calibration c = with_states(most_states + 1);
  EXPECT_EQ(message_of([&] { Reduction{c.polarimeter}; }), "generator: 101 states, at most 100 can be used");
  std::string text = to_json(any_calibration()), first = "\"generator\": [";
  for (std::size_t more = 5; more <= most_states; ++more)
    text.insert(text.find(first) + first.size(), "[1, 0, 0, 0], ");
  EXPECT_TRUE(says(complaint([&] { calibration_from_json(text, "i.json"); }),
                   {"i.json: generator: 101 states, more than 100"}));
  std::istringstream references(
      "wavelength_nm,reference,number,angle_deg,generator_state,analyzer_state,intensity\n532,empty,1,0,101,1,1\n");
  EXPECT_TRUE(says(complaint([&] { read_references(references, "r.csv"); }),
                   {"generator_state: 101: states are numbered from 1 to at most 100"}));
  CalibrationOptions options;
  options.generator_states = most_states + 1;
  EXPECT_EQ(message_of([&] { calibrate({}, options); }), "101 states of the generator, more than 100");
}

TEST(Instrument, ThatCouldNotBeReadBackIsNotWritten) {
  const auto refusal = [](const std::function<void(Calibration&)>& spoil) {
    Calibration c = any_calibration();
    spoil(c);
    return message_of([&] { to_json(c); });
  };
  EXPECT_EQ(refusal([](Calibration& c) { c.extinction = 2; }), "instrument: polarizer.extinction: 2.0 is more than 1");
  EXPECT_EQ(refusal([](Calibration& c) { c.figure_of_merit.elements(2, 1) = -1; }),
            "instrument: figure_of_merit.elements[2]: -1 is negative");
  EXPECT_EQ(refusal([](Calibration& c) { c.degrees_of_freedom = -1; }),
            "instrument: degrees_of_freedom: -1 is negative");
  EXPECT_EQ(refusal([](Calibration& c) { c.wavelength = 1e300; }),
            "instrument: wavelength_nm: 1e+303 is not a wavelength in nm");
  for (const double wavelength : {0.0, -0.5, std::nan("")})
    EXPECT_EQ(refusal([&](Calibration& c) { c.wavelength = wavelength; }), "the wavelength must be positive");
  EXPECT_EQ(refusal([](Calibration& c) {
              for (std::size_t k = 0; k < 4; ++k) c.polarimeter.pairs.push_back({k, k});
            }),
            "an instrument file has pairs of states of turning retarders only");
  EXPECT_NE(refusal([](Calibration& c) { c.generator_condition *= 1.001; }), "nothing was thrown");
  EXPECT_NE(refusal([](Calibration& c) { c.covariance.assign(c.covariance.size(), 1e308); }), "nothing was thrown");
}

TEST(Instrument, WithWhatIsNotFiniteIsNotWritten) {
  Calibration c = any_calibration();
  c.generator_condition = std::numeric_limits<double>::infinity();
  EXPECT_THROW(to_json(c), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
