// SPDX-License-Identifier: BSD-3-Clause
#include "options/polarimetry.hpp"

#include <cmath>
#include <iostream>
#include <map>

#include "mmbrdf/model/description.hpp"
#include "options/arguments.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

void print_line(const std::string& name, const std::string& value) {
  std::cout << format("%-20s ", printable(name, 100).c_str()) << printable(value, longest_text) << '\n';
}

/// One state in each row; behind it, if they are known, standard uncertainties. `first` is its first parameter.
void print_states(const std::string& title, const std::vector<Stokes>& states, std::span<const double> covariance,
                  std::size_t parameters, std::size_t first) {
  std::cout << '\n'
            << format("%-10s", title.c_str()) << "        S1        S2        S3        S4"
            << (covariance.empty() ? "\n" : "     u(S1)     u(S2)     u(S3)     u(S4)\n");
  for (std::size_t s = 0; s < states.size(); ++s) {
    std::string values = format("%-10zu", s + 1), uncertainties;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t i = (first + 4 * s + k) * (parameters + 1);
      const double u = covariance.empty() ? 0 : std::sqrt(std::max(covariance[i], 0.0));
      values += u > 0 ? format("%10s", to_place_of(states[s][k], u).c_str()) : format("%10.6f", states[s][k]);
      uncertainties += covariance.empty() ? "" : format("%10s", to_place_of(u, u).c_str());
    }
    std::cout << values << uncertainties << '\n';
  }
}

void print_merit(const FigureOfMerit& merit) {
  print_line("figure of merit", format("%.3e, corrected for what was fitted %.3e", merit.total, merit.corrected));
  print_line("  by reference",
             format("empty %.3e, polarizer %.3e, wafer %.3e", merit.empty, merit.polarizer, merit.wafer));
  for (std::size_t row = 0; row < 4; ++row) {
    const double* const m = &merit.elements.elements[4 * row];
    print_line(row == 0 ? "  by element" : "", format("%9.2e %9.2e %9.2e %9.2e", m[0], m[1], m[2], m[3]));
  }
}

void print_quality(const Calibration& c) {
  print_line("wavelength", brief(nanometres(c.wavelength)) + " nm");
  print_line("states", std::to_string(c.polarimeter.generator.size()) + " of the generator, " +
                           std::to_string(c.polarimeter.analyzer.size()) + " of the analyzer");
  print_line("condition",
             format("generator %.3f, analyzer %.3f (best 1.732)", c.generator_condition, c.analyzer_condition));
  print_merit(c.figure_of_merit);
  print_line("misfit", format("s16/s15 %.3e, identifiability s15/s1 %.3e", c.singular_ratio, c.identifiability));
  print_line("chi^2/dof", !c.covariance.empty()
                              ? format("%.3f, %ld degrees of freedom",
                                       c.chi_squared / static_cast<double>(c.degrees_of_freedom), c.degrees_of_freedom)
                              : "not refined");
  if (c.scale_uncertainty > 0)
    print_line("scale", format("known to %.1e, from the scatter of the empty references", c.scale_uncertainty));
  print_line("polarizer", format("offset %.4f degrees, extinction %.2e, phase %.3f degrees",
                                 degrees(c.polarizer_offset), c.extinction, degrees(c.polarizer_phase)));
  if (c.film_thickness > 0) {
    print_line("film thickness",
               format("%.5f um, psi and delta off by %.3f degrees", c.film_thickness, degrees(c.film_misfit)));
  }
}

}  // namespace

Film film_from(const std::string& text) {
  const std::vector<double> n = numbers(text);
  if (n.size() != 4) throw std::invalid_argument("\"" + text + "\": expected N,THICKNESS_UM,N_SUBSTRATE,K_SUBSTRATE");
  return {n[0], n[1], {n[2], n[3]}};
}

ReadingNoise noise_from(const std::string& text) {
  ReadingNoise noise;
  std::map<std::string, double*> terms = {{"dark", &noise.dark}, {"shot", &noise.shot}, {"relative", &noise.relative}};
  const auto wrong = [&](const std::string& part) {
    return std::invalid_argument("\"" + part + "\": expected dark:X,shot:Y,relative:Z, or some of it, of 0 or more");
  };
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size()), colon = text.find(':', begin);
    const std::string part = text.substr(begin, end - begin);
    const auto term = terms.find(text.substr(begin, std::min(colon, end) - begin));
    if (colon >= end || term == terms.end()) throw wrong(part);
    *term->second = number(text.substr(colon + 1, end - colon - 1));
    if (*term->second < 0) throw wrong(part);
    terms.erase(term);  // a second one is wrong
    begin = end + 1;
  }
  return noise;
}

double positive_number(const std::string& text) {
  const double value = number(text);
  if (!(value > 0)) throw std::invalid_argument("\"" + text + "\": expected a positive number");
  return value;
}

void add_reading_options(CLI::App& app, double& saturation, ReadingNoise& noise) {
  add_option(app, "--noise", noise, noise_from, "LAW", "Of the readings B: dark:X,shot:Y,relative:Z [relative:0.001]");
  add_option(app, "--saturation", saturation, positive_number, "LIMIT", "Refuse intensities from this one on");
}

void heed(const Verdict& verdict, const std::string& name) {
  for (const std::string& doubt : verdict.doubts) warn(name + ": " + doubt);
  if (!verdict.refusal.empty()) throw std::runtime_error(name + ": " + verdict.refusal);
}

void print_instrument(const Calibration& c) {
  print_quality(c);
  const std::size_t generators = c.polarimeter.generator.size();
  const std::size_t parameters = 4 * (generators + c.polarimeter.analyzer.size());
  print_states("generator", c.polarimeter.generator, c.covariance, parameters, 0);
  print_states("analyzer", c.polarimeter.analyzer, c.covariance, parameters, 4 * generators);
  std::cout << (c.provenance.empty() ? "" : "\n");
  for (const auto& [key, value] : c.provenance) print_line(key, value);
}

}  // namespace mmbrdf::program
