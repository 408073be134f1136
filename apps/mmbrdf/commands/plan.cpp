// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf plan

#include "mmbrdf/mixed/plan.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>

#include "command.hpp"
#include "mmbrdf/model/description.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "pages/describe.hpp"
#include "pages/table.hpp"
#include "streams/geometry_rows.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::vector<std::string> designs, targets;
  std::string like, candidates, output;
  std::optional<double> wavelength_nm, noise;
  int choose = 0;
  Format format = Format::text;
};

/// A target, and what it is called.
struct Wanted {
  std::string name;
  PlanTarget target;
};

std::string in_words(double degrees) { return format("%g", degrees); }

constexpr const char* target_form = "dhr:THETA[,THETA...] or f:THETA_I:THETA_R[:PHI_R], in degrees";

std::vector<Wanted> wanted_from(const std::string& text) {
  const auto wrong = [&] { return WrongUsage("--target", "\"" + text + "\": expected " + target_form); };
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(':', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  std::vector<Wanted> result;
  try {
    if (parts[0] == "dhr" && parts.size() == 2) {
      for (const double theta : numbers(parts[1]))
        result.push_back(
            {"dhr_" + in_words(theta), {PlanTarget::Kind::dhr, 0, {direction_from_degrees(theta, 0), {}}}});
    } else if (parts[0] == "f" && (parts.size() == 3 || parts.size() == 4)) {
      const double theta_i = number(parts[1]), theta_r = number(parts[2]),
                   phi = parts.size() == 4 ? number(parts[3]) : 180;
      result.push_back(
          {"f_" + in_words(theta_i) + "_" + in_words(theta_r) + (parts.size() == 4 ? "_" + in_words(phi) : ""),
           {PlanTarget::Kind::f11, 0, {direction_from_degrees(theta_i, 0), direction_from_degrees(theta_r, phi)}}});
    }
  } catch (const std::invalid_argument& error) {
    throw WrongUsage("--target", error.what());
  }
  if (result.empty()) throw wrong();
  return result;
}

/// The blocks in the order of their elements' names, then what was asked for.
std::vector<Wanted> wanted(const Options& options) {
  std::vector<Wanted> result;
  const std::vector<Block> list = blocks(Family::isotropic, {12, 10});
  for (std::size_t b = 0; b < list.size(); ++b) {
    std::string name;
    for (const char c : list[b].name) name += c == ',' ? '_' : c;
    result.push_back({name, {PlanTarget::Kind::block, b, {}}});
  }
  for (const std::string& text : options.targets)
    for (Wanted& one : wanted_from(text)) result.push_back(std::move(one));
  return result;
}

std::vector<Geometry> read_geometries(const std::string& path) {
  std::vector<Geometry> result;
  read_input(path, [&](std::istream& in, const std::string& name) {
    const GeometrySource source = open_geometries(in, name, 1, false);
    for (Piece piece; source.next(piece);) {
      const Rows rows = source.rows(piece);
      result.insert(result.end(), rows.geometries.begin(), rows.geometries.end());
      if (rows.error) throw std::runtime_error(*rows.error);
    }
  });
  if (result.empty()) throw std::runtime_error(path + ": no geometries");
  return result;
}

VarianceComponents components(const Options& options) {
  if (options.noise && !(*options.noise >= 1e-6 && *options.noise <= 10))
    throw WrongUsage("--noise", "must be in 1e-6...10, relative for f11");
  if (options.like.empty()) return default_components(options.noise.value_or(0.007));
  const Model model = open_model(options.like);
  if (!model.posterior)
    throw std::runtime_error(options.like +
                             ": says nothing of the sample's variances; fit it with --uncertainty sample");
  const double wavelength =
      options.wavelength_nm ? micrometres(*options.wavelength_nm) : model.posterior->data().wavelengths[0].wavelength;
  if (std::ranges::none_of(model.posterior->data().wavelengths,
                           [&](const PosteriorAt& at) { return same_wavelength(at.wavelength, wavelength); }))
    throw std::runtime_error(options.like + ": was not fitted at " + in_words(*options.wavelength_nm) + " nm, but at " +
                             nanometre_list(model.validity.wavelengths));
  VarianceComponents result = components_of(*model.posterior, wavelength);
  for (auto& block : result.blocks)
    if (options.noise) block.noise_variance = *options.noise * *options.noise;
  return result;
}

struct Design {
  std::string name;
  std::vector<Geometry> geometries;
};

/// The same readings, reading i of them with the sample turned by this part of a turn.
Design turned(const Design& design, const std::string& how, double (*part)(std::size_t)) {
  Design result{design.name + ", " + how, design.geometries};
  for (std::size_t i = 0; i < result.geometries.size(); ++i) {
    const double turn = 2 * std::numbers::pi * part(i);
    result.geometries[i].incident.phi += turn;
    result.geometries[i].reflected.phi += turn;
  }
  return result;
}

std::vector<Design> designs(const Options& options) {
  std::vector<Design> result;
  for (const std::string& path : options.designs) {
    const Design as_is{base_name(path), read_geometries(path)};
    result.push_back(as_is);
    result.push_back(turned(as_is, "every second one with the sample turned by 180 degrees",
                            [](std::size_t i) { return i % 2 == 0 ? 0 : 0.5; }));
    result.push_back(turned(as_is, "sample turned by 222.5 degrees from each to the next",
                            [](std::size_t i) { return std::fmod(static_cast<double>(i) / std::numbers::phi, 1); }));
  }
  return result;
}

Table table_of(const VarianceComponents& components, const std::vector<Design>& designs,
               const std::vector<Wanted>& wanted) {
  Table table{{{"design", "%-60s"}, {"readings", "%8s"}}};
  std::vector<PlanTarget> targets;
  for (const Wanted& one : wanted) {
    table.columns.push_back({"expected_u_" + one.name, "%13.2g", one.name});
    targets.push_back(one.target);
  }
  for (const Design& design : designs) {
    Table::Row row{design.name, design.geometries.size()};
    for (const double u : expected_uncertainties(components, design.geometries, targets)) row.push_back(u);
    table.rows.push_back(row);
  }
  return table;
}

std::string geometries_csv(const std::vector<Geometry>& list) {
  std::string text = "theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg\n";
  for (const auto& [i, r] : list)
    text += exact(in_degrees(i.theta)) + "," + exact(in_degrees(i.phi)) + "," + exact(in_degrees(r.theta)) + "," +
            exact(in_degrees(r.phi)) + "\n";
  return text;
}

void plan(const Options& options) {
  const VarianceComponents known = components(options);
  const std::vector<Wanted> all = wanted(options);
  std::vector<Design> list = designs(options);
  if (options.choose == 0 && !options.candidates.empty()) throw missing("--choose");
  if (options.choose > 0) {
    if (options.candidates.empty()) throw missing("--from");
    const std::vector<Geometry> candidates = read_geometries(options.candidates);
    std::vector<PlanTarget> targets;
    const bool own = all.size() > blocks(Family::isotropic, {12, 10}).size();
    for (const Wanted& one : all)
      if (!own || one.target.kind != PlanTarget::Kind::block) targets.push_back(one.target);
    const std::vector<Geometry> start = list.empty() ? std::vector<Geometry>{} : list.front().geometries;
    Design more{list.empty() ? "chosen" : list.front().name + " and chosen", start};
    std::vector<Geometry> picks;
    for (const std::size_t c : chosen(known, start, targets, candidates, static_cast<std::size_t>(options.choose)))
      picks.push_back(candidates[c]);
    more.geometries.insert(more.geometries.end(), picks.begin(), picks.end());
    list.push_back(std::move(more));
    if (!options.output.empty()) write_text(options.output, geometries_csv(picks));
  }
  const Table table = table_of(known, list, all);
  if (options.format == Format::csv) {
    std::cout << csv(table);
  } else if (options.format == Format::json) {
    print(json_of(table));
  } else {
    std::cout << "expected standard uncertainties, root mean square over the elements of a block up to 70 degrees; "
                 "errors that\nall readings share are not in them\n\n"
              << text(table);
  }
  if (options.like.empty())
    note(
        "the variances are those of sintered PTFE: for another material an order of magnitude; fit a small series and "
        "give it with --like");
}

constexpr const char* footer =
    "GEOMETRIES.csv has the columns theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, as samples have them; each file "
    "is\n"
    "one design, shown as it is and with the sample turned between its readings. Nothing need be measured: expected\n"
    "uncertainties depend on where is measured, on the noise, and on how much a sample deviates from an isotropic "
    "one.\n"
    "\n"
    "--choose takes from the candidates, one after the other, the direction that lowers the variances of the targets\n"
    "most: of all blocks, or of those that are given.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf plan scan.csv --like sample.json --target dhr:0,45,60 --target f:0:45\n"
    "  mmbrdf plan scan.csv --choose 50 --from candidates.csv -o next.csv";

}  // namespace

Run plan_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_texts(app, "GEOMETRIES.csv", o->designs, " ", "Designs: directions to be measured").required();
  add_text(app, "--like", o->like, "MODEL", "A fit whose variances the sample will have [sintered PTFE]");
  add_option(app, "-w,--wavelength", o->wavelength_nm, number, "NM", "Of that fit, in nm [its first]");
  add_option(app, "--noise", o->noise, number, "S", "Of a reading, at normal directions [of the fit; 0.007]");
  add_texts(app, "--target", o->targets, "TARGET",
            "What is to be known: dhr:THETA[,THETA...] or\nf:THETA_I:THETA_R[:PHI_R], in degrees");
  add_option(app, "--choose", o->choose, whole_number, "N", "Choose N more readings");
  add_file(app, "--from", o->candidates, "CANDIDATES.csv", "Directions to choose from");
  add_output_file(app, "-o,--output", o->output, "CHOSEN.csv", "Write what is chosen");
  add_option(app, "--format", o->format, format_from, "FORMAT", "text, csv or json [text]");
  set_footer(app, footer);
  return [o] { plan(*o); };
}

}  // namespace mmbrdf::program
