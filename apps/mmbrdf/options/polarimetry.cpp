// SPDX-License-Identifier: BSD-3-Clause
#include "options/polarimetry.hpp"

#include <cmath>
#include <iostream>
#include <map>

#include "mmbrdf/model/description.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"
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
  std::string kinds;
  for (const auto& [name, value] : {std::pair("empty", merit.empty),
                                    {"polarizer", merit.polarizer},
                                    {"wafer", merit.wafer},
                                    {"retarder", merit.retarder}})
    if (value > 0) kinds += (kinds.empty() ? "" : ", ") + format("%s %.3e", name, value);
  if (!kinds.empty()) print_line("  by reference", kinds);
  for (std::size_t row = 0; row < 4; ++row) {
    const double* const m = &merit.elements.elements[4 * row];
    print_line(row == 0 ? "  by element" : "", format("%9.2e %9.2e %9.2e %9.2e", m[0], m[1], m[2], m[3]));
  }
}

/// By chance it differs by √(2/dof) from 1.
std::string reduced_chi_squared(double chi_squared, double freedom) {
  const double reduced = chi_squared / freedom;
  return to_place_of(reduced, reduced * std::sqrt(2 / freedom)) + format(", %.0f degrees of freedom", freedom);
}

void print_quality(const Calibration& c) {
  print_line("wavelength", brief(nanometres(c.wavelength)) + " nm");
  print_line("states", std::to_string(c.polarimeter.generator.size()) + " of the generator, " +
                           std::to_string(c.polarimeter.analyzer.size()) + " of the analyzer");
  print_line("condition",
             c.polarimeter.pairs.empty()
                 ? format("generator %.3f, analyzer %.3f (best 1.732)", c.generator_condition, c.analyzer_condition)
                 : format("%.3f of %zu pairs of states (best 3)", Reduction(c.polarimeter).condition(),
                          c.polarimeter.pairs.size()));
  print_merit(c.figure_of_merit);
  print_line("misfit", c.retarders
                           ? format("identifiability %.3e", c.identifiability)
                           : format("s16/s15 %.3e, identifiability s15/s1 %.3e", c.singular_ratio, c.identifiability));
  print_line("chi^2/dof", !c.covariance.empty()
                              ? reduced_chi_squared(c.chi_squared, static_cast<double>(c.degrees_of_freedom))
                              : "not refined");
  if (c.scale_uncertainty > 0)
    print_line("scale", format("known to %.1e, from the scatter of the empty references", c.scale_uncertainty));
  if (c.retarders && !c.references.empty()) {
    double squares = 0;
    for (const FittedReference& reference : c.references) squares += reference.drift * reference.drift;
    print_line("source drift", format("%.1e, rms over the references, from first frame to last",
                                      std::sqrt(squares / static_cast<double>(c.references.size()))));
  }
  if (c.retarders && c.polarizer_offset == 0 && c.extinction == 0) return;  // no reference polarizer
  print_line("polarizer", format("offset %.4f degrees, extinction %.2e, phase %.3f degrees",
                                 degrees(c.polarizer_offset), c.extinction, degrees(c.polarizer_phase)));
  if (c.film_thickness > 0) {
    print_line("film thickness",
               format("%.5f um, psi and delta off by %.3f degrees", c.film_thickness, degrees(c.film_misfit)));
  }
}

/// The numbers of two turning retarders, each with its standard uncertainty if it was fitted.
void print_retarders(const CalibratedRetarders& retarders) {
  const auto values = parameters(retarders.values);
  std::cout << '\n' << format("%-30s %12s %12s\n", "", "value", "u");
  for (std::size_t k = 0; k < retarder_parameters; ++k) {
    const bool angle = k < 8 && k % 4 != 3;
    const double unit = angle ? degrees(1) : 1;
    const double variance = retarders.covariance.empty() ? 0 : retarders.covariance[k * (retarder_parameters + 1)];
    const double u = unit * std::sqrt(std::max(variance, 0.0)), value = unit * values[k];
    std::cout << format("%-30s ", (parameter_name(k) + (angle ? ", deg" : "")).c_str())
              << (u > 0 ? format("%12s %12s", to_place_of(value, u).c_str(), to_place_of(u, u).c_str())
                        : format("%12s %12s", shortest(std::round(value * 1e6) / 1e6).c_str(), "given"))
              << '\n';
  }
}

void print_provenance(const Calibration& c) {
  std::cout << (c.provenance.empty() ? "" : "\n");
  for (const auto& [key, value] : c.provenance) print_line(key, value);
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

void add_reading_options(CLI::App& app, double& saturation, ReadingNoise& noise) {
  add_option(app, "--noise", noise, noise_from, "LAW", "Of the readings B: dark:X,shot:Y,relative:Z [relative:0.001]");
  add_option(app, "--saturation", saturation, positive_number, "LIMIT", "Refuse intensities from this one on");
}

RetarderOptions TurningRetarders::options(std::size_t frames) const {
  RetarderOptions result;
  result.dials = dial_angles(ratio, step, frames);
  result.nominal.generator.retardance = result.nominal.analyzer.retardance = retardance;
  return result;
}

TurningRetarders retarders_from(const std::string& text) {
  const std::invalid_argument wrong("\"" + text + "\": expected 1:RATIO,STEP[,RETARDANCE], angles in degrees");
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw wrong;
  const std::vector<double> n = numbers(text.substr(colon + 1));
  const double first = number(text.substr(0, colon));
  if (n.size() < 2 || n.size() > 3 || first == 0 || n[0] == 0 || n[1] == 0) throw wrong;
  TurningRetarders result{n[0] / first, radians(n[1])};
  if (n.size() == 3) result.retardance = radians(n[2]);
  if (!(std::abs(std::sin(result.retardance)) > 1e-6)) throw wrong;
  return result;
}

Option add_retarders(CLI::App& app, std::optional<TurningRetarders>& retarders, const std::string& description) {
  return add_option(app, "--retarders", retarders, retarders_from, "1:RATIO,STEP[,RET]", description);
}

void heed(const Verdict& verdict, const std::string& name) {
  for (const std::string& doubt : verdict.doubts) warn(name + ": " + doubt);
  if (!verdict.refusal.empty()) throw std::runtime_error(name + ": " + verdict.refusal);
}

void print_instrument(const Calibration& c) {
  print_quality(c);
  if (c.retarders) {
    print_retarders(*c.retarders);
    print_provenance(c);
    return;
  }
  const std::size_t generators = c.polarimeter.generator.size();
  const std::size_t parameters = 4 * (generators + c.polarimeter.analyzer.size());
  print_states("generator", c.polarimeter.generator, c.covariance, parameters, 0);
  print_states("analyzer", c.polarimeter.analyzer, c.covariance, parameters, 4 * generators);
  print_provenance(c);
}

}  // namespace mmbrdf::program
