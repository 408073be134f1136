// SPDX-License-Identifier: BSD-3-Clause
// How the program reads the values of its options.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/model/model.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "options/option.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

// Reading text. All throw std::invalid_argument, naming the text, if it has another form; that is wrong usage. Whether
// a number makes sense (an angle of 95 degrees does not) is asked later, and is bad input.

double number(const std::string& text);  ///< finite
double positive_number(const std::string& text);
int whole_number(const std::string& text);  ///< 0 or more
int thread_count(const std::string& text);  ///< 0 to 1024
unsigned long seed(const std::string& text);

/// THETA,PHI in degrees, as typed, or THETA where azimuths do not matter.
struct DirectionDegrees {
  double theta = 0;
  double phi = 0;
  bool has_phi = true;
};
DirectionDegrees incident_degrees(const std::string& text);   ///< THETA[,PHI]
DirectionDegrees reflected_degrees(const std::string& text);  ///< THETA,PHI, or 0

/// THETA_I,THETA_R in degrees, as typed: the largest polar angles.
struct AnglesDegrees {
  double theta_i = 0;
  double theta_r = 0;
};
AnglesDegrees angles_degrees(const std::string& text);

std::vector<double> numbers(const std::string& text);     ///< A[,B…]
std::vector<double> range_from(const std::string& text);  ///< FROM:TO:STEP, both ends included; at most 100 000
Orders orders_from(const std::string& text);              ///< F11,OTHER
/// NM:R[,NM:R…] in any order, as reflectance_line()
ReflectanceTable typed_reflectance(const std::string& text);

/// scale=0.3%,source=0.5deg,receiver=0.5deg, each once at most: standard uncertainties. A scale may be a number too.
DeclaredErrors declared_from(const std::string& text);

/// germer2017 or random:N
struct Grid {
  int random = 0;  ///< number of random pairs of directions; 0: the published grid
};
Grid grid_from(const std::string& text);

Format format_from(const std::string& name);
Format format_without_csv(const std::string& name);

// What the numbers mean. These throw std::invalid_argument for values that make no sense.

double micrometres(double wavelength_nm);
std::vector<double> micrometres(const std::vector<double>& wavelengths_nm);

/// Micrometres: what was given, or the model's own if it needs none. Throws WrongUsage for models that do.
double wavelength_from(const std::optional<double>& wavelength_nm, const Model& model);

std::vector<Geometry> geometries(const Grid& grid, unsigned long seed);

/// In radians, θ ≥ 0. `option` begins the message.
Direction direction_from(const DirectionDegrees& degrees, const std::string& option);

// Options whose value one of the functions above reads.

template <class T>
T parsed(const std::string& option, const std::string& text, T (*parse)(const std::string&)) {
  try {
    return parse(text);
  } catch (const std::invalid_argument& error) {
    throw WrongUsage(option, error.what());
  }
}

/// `shown` is what the help prints after the option's name.
template <class Target, class T>
Option add_option(CLI::App& app, const std::string& names, Target& target, T (*parse)(const std::string&),
                  const std::string& shown, const std::string& description) {
  const std::string name = names.substr(names.find("--") == std::string::npos ? 0 : names.find("--"));
  const auto use = [&target, parse, name](const std::string& text) { target = parsed(name, text, parse); };
  return add_used(app, names, use, shown, description);
}

/// --basis and --orders
void add_basis_option(CLI::App& app, Basis& basis);

/// --weights; `standard` is what holds without.
template <class Target>
void add_weights_option(CLI::App& app, Target& weights, const std::string& standard = "none") {
  add_option(app, "--weights", weights, weights_from, "NAME",
             "none, speckle: cos(theta_r)/cos(theta_i), data: 1/u^2 of the\nsamples' own uncertainties, or estimated "
             "from what an\nunweighted fit leaves of 14 and 41 [" +
                 standard + "]");
}

}  // namespace mmbrdf::program
