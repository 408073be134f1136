// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf moments

#include "mmbrdf/model/moments.hpp"

#include <cmath>
#include <memory>
#include <ostream>
#include <span>

#include "command.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/numerics/quadrature.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string model, output = "-";
  std::optional<std::vector<double>> wavelengths_nm;
  std::optional<std::vector<double>> mu_i, mu_r;
  int streams = 0, moments = 0;
};

struct Cosines {
  std::vector<double> incident, reflected;
  std::string words;  // of a quadrature
};

Cosines cosines_of(const Options& options) {
  if (options.streams == 0) {
    if (!options.mu_i) throw missing("--mu-i, or --streams,");
    if (!options.mu_r) throw missing("--mu-r, or --streams,");
    return {*options.mu_i, *options.mu_r, ""};
  }
  constexpr int most = 100;
  if (options.streams > most)
    throw WrongUsage("--streams", std::to_string(options.streams) + " are more than " + std::to_string(most));
  if (options.mu_i || options.mu_r) throw WrongUsage("--streams", "it says all cosines: leave out --mu-i and --mu-r");
  Cosines result;
  std::vector<Node> nodes = gauss_legendre(options.streams);
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
    result.incident.push_back(node->x);
    result.words += (result.words.empty() ? "" : ", ") + exact(node->x) + ":" + exact(node->weight);
  }
  result.reflected = result.incident;
  return result;
}

/// How many moments to print of those that there are.
std::size_t moments_asked(const Options& options, std::size_t there) {
  const auto most = static_cast<std::size_t>(2 * options.streams);
  const auto asked = static_cast<std::size_t>(options.moments);
  if (options.streams > 0 && asked > most)
    throw std::invalid_argument("--moments " + std::to_string(asked) + ": a quadrature of " +
                                std::to_string(options.streams) + " cosines in each hemisphere carries at most " +
                                std::to_string(most));
  constexpr std::size_t longest = 1000;  // what is beyond those that there are is 0
  if (asked > longest)
    throw WrongUsage("--moments", std::to_string(asked) + " are more than " + std::to_string(longest));
  if (asked > 0) return asked;
  return options.streams > 0 ? std::min(there, most) : there;
}

/// Of one wavelength.
struct Moments {
  double wavelength = 0;
  std::vector<FourierMoments> all;
  std::size_t count = 0;  // to be printed
  std::size_t there = 0;  // that there are
};

void write_header(std::ostream& out, const std::string& name, std::span<const double> wavelengths,
                  const Cosines& cosines) {
  out << "# model " << printable(name, longest_text) << " at " << nanometre_list(wavelengths)
      << ", f in sr^-1, frame sp: f(phi) = sum of c cos(m phi) + s sin(m phi), phi = phi_r - phi_i, 180 is forward\n";
  if (!cosines.words.empty()) out << "# cosine:weight, Gauss-Legendre on 0 to 1: " << cosines.words << '\n';
  out << (wavelengths.size() > 1 ? "wavelength_nm," : "") << "mu_i,mu_r,m";
  for (const char part : {'c', 's'})
    for (std::size_t e = 0; e < 16; ++e) out << ',' << part << element_name(e);
  out << '\n';
}

/// Each line behind `first`.
void write_moments(std::ostream& out, const std::string& first, const Cosines& cosines, const Moments& moments) {
  for (std::size_t i = 0; i < cosines.incident.size(); ++i)
    for (std::size_t r = 0; r < cosines.reflected.size(); ++r)
      for (std::size_t m = 0; m < moments.count; ++m) {
        const FourierMoments& one = moments.all[r * cosines.incident.size() + i];
        std::string line =
            first + exact(cosines.incident[i]) + "," + exact(cosines.reflected[r]) + "," + std::to_string(m);
        append_elements(line, m < one.cosine.size() ? one.cosine[m] : Mueller{});
        append_elements(line, m < one.sine.size() ? one.sine[m] : Mueller{});
        out << line << '\n';
      }
}

/// Warns of what lies beyond the fit.
Moments moments_at(const Model& model, double wavelength, const Cosines& cosines, const Options& options) {
  const PreparedModel prepared = prepare(model, wavelength);
  const auto there = static_cast<std::size_t>(highest_moment(prepared)) + 1;
  Moments result{wavelength, {}, moments_asked(options, there), there};
  result.all = fourier_moments(prepared, cosines.incident, cosines.reflected);
  RangeCount range;
  for (const double mu_i : cosines.incident)
    for (const double mu_r : cosines.reflected)
      range.add(static_cast<Outside>(outside(model.validity, wavelength, {{std::acos(mu_i), 0}, {std::acos(mu_r), 0}}) &
                                     ~unsigned{outside_directions}));  // of all azimuths
  if (const std::string line = range.line("pair"); !line.empty()) warn(options.model + ": " + line);
  return result;
}

void print_moments(const Options& options) {
  require_model_kept(options.model, options.output);
  const Cosines cosines = cosines_of(options);
  const Model model = open_model(options.model);
  const std::vector<double> wavelengths =
      options.wavelengths_nm ? micrometres(*options.wavelengths_nm) : std::vector{wavelength_from({}, model)};
  std::vector<Moments> all;
  for (const double wavelength : wavelengths) all.push_back(moments_at(model, wavelength, cosines, options));
  if (const auto& [wavelength, moments, count, there] = all.front(); count < there)  // the same at all wavelengths
    note("the model has moments up to m = " + std::to_string(there - 1) + ", of which " +
         std::to_string(there - count) + " are left out");
  write_output(options.output, [&](std::ostream& out) {
    write_header(out, model.name, wavelengths, cosines);
    for (const Moments& one : all)
      write_moments(out, all.size() > 1 ? shortest(nanometres(one.wavelength)) + "," : "", cosines, one);
  });
}

}  // namespace

Run moments_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_model(app, o->model);
  add_option(app, "-w,--wavelength", o->wavelengths_nm, numbers, "NM[,NM...]",
             "Wavelengths, in nm; of several a column says which [that of\nthe fit, if it is one]");
  add_option(app, "--mu-i", o->mu_i, numbers, "COS[,COS...]", "Cosines of the polar angle of the source");
  add_option(app, "--mu-r", o->mu_r, numbers, "COS[,COS...]", "Cosines of the polar angle of the detector");
  add_option(app, "--streams", o->streams, whole_number, "N",
             "N cosines of both, Gauss-Legendre on 0 to 1, with their\nweights");
  add_option(app, "--moments", o->moments, whole_number, "M",
             "How many, m = 0 to M - 1; of streams at most 2 N [all\nthat are not 0]");
  add_output_file(app, "-o,--output", o->output, "FILE", "CSV file to write [standard output]");
  set_footer(
      app,
      "f(phi) = sum over m of c cos(m phi) + s sin(m phi) in sr^-1, phi = phi_r - phi_i, weight 1 for each m. The "
      "frame is sp:\n"
      "Stokes vectors about the meridian planes. Moments come from the modes in closed form; of an isotropic "
      "model they are\n"
      "finitely many. mmbrdf export writes them in the layout of VLIDORT.\n"
      "\n"
      "Example:\n"
      "  mmbrdf moments ptfe --wavelength 532 --mu-i 0.5 --mu-r 0.2,0.8");
  return [o] { print_moments(*o); };
}

}  // namespace mmbrdf::program
