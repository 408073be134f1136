// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf plan

#include "mmbrdf/quantities/plan_like.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include "command.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/radiometry/reflectance_uncertainty.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "options/terms.hpp"
#include "pages/describe.hpp"
#include "pages/page.hpp"
#include "streams/geometry_rows.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::vector<std::string> designs, targets;
  std::string like, candidates, output;
  std::optional<double> wavelength_nm, noise;
  Terms terms;
  int choose = 0;
  Format format = Format::text;
};

/// The blocks in the order of their elements' names, then what was asked for.
std::vector<NamedTarget> wanted(const Options& options, const VarianceComponents& known) {
  std::vector<NamedTarget> result = block_targets(known);
  for (const std::string& text : options.targets) try {
      for (NamedTarget& one : targets_from(text)) result.push_back(std::move(one));
    } catch (const std::invalid_argument& error) {
      throw WrongUsage("--target", error.what());
    }
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
  if (options.wavelength_nm && options.like.empty()) throw WrongUsage("--wavelength", "goes with --like");
  if (options.noise && !(*options.noise >= least_noise && *options.noise <= largest_noise))
    throw WrongUsage("--noise", "must be in 1e-6...10, relative for f11");
  if (options.like.empty()) return components_like(nullptr, {}, options.noise);
  const Model model = open_model(options.like);
  try {
    const auto wavelength = options.wavelength_nm ? std::optional(micrometres(*options.wavelength_nm)) : std::nullopt;
    return components_like(&model, wavelength, options.noise);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(options.like + ": " + error.what());
  }
}

std::vector<NamedDesign> designs(const Options& options) {
  std::vector<NamedDesign> result;
  for (const std::string& path : options.designs)
    for (NamedDesign& one : with_turns({base_name(path), read_geometries(path)})) result.push_back(std::move(one));
  return result;
}

/// What errors that all readings share add to a target: their effects on a sample like this.
double shared_uncertainty(const PlanTarget& target, const Model& sample, double wavelength,
                          const std::vector<TypeBTerm>& terms) {
  if (target.kind == PlanTarget::Kind::block) return 0;
  std::vector<Contribution> parts;
  if (target.kind == PlanTarget::Kind::dhr) {
    parts = directional_hemispherical_budget(uncertain(sample, wavelength, terms), target.geometry.incident);
    parts.erase(parts.begin(), parts.end() - static_cast<std::ptrdiff_t>(terms.size()));  // those of the sample
  } else {
    const PreparedModel prepared = prepare(sample, wavelength);
    for (const TypeBTerm& term : terms)
      for (const Mueller& change : effects(term, prepared, target.geometry))
        parts.push_back({term.name, std::abs(change(0, 0)), term.freedom});
  }
  return standard_uncertainty(parts);
}

/// Of each target, with --term.
std::vector<double> shared_uncertainties(const std::vector<NamedTarget>& wanted, const Options& options) {
  const std::vector<TypeBTerm> terms = terms_from(options.terms);
  std::vector<double> result(wanted.size(), 0);
  if (terms.empty()) return result;
  if (options.targets.empty()) throw WrongUsage("--term", "goes with --target: it is in none of the blocks");
  const Model sample = options.like.empty() ? material("ptfe-532") : open_model(options.like);
  const double wavelength =
      options.wavelength_nm ? micrometres(*options.wavelength_nm) : sample.validity.wavelengths.front();
  std::ranges::transform(wanted, result.begin(), [&](const NamedTarget& one) {
    return shared_uncertainty(one.target, sample, wavelength, terms);
  });
  return result;
}

Table table_of(const VarianceComponents& components, const std::vector<NamedDesign>& designs,
               const std::vector<NamedTarget>& wanted, const std::vector<double>& shared) {
  Table table{{{"design", "%-60s"}, {"readings", "%8s"}}};
  std::vector<PlanTarget> targets;
  for (const NamedTarget& one : wanted) {
    table.columns.push_back({"expected_u_" + one.name, "%13.2g", one.name});
    targets.push_back(one.target);
  }
  for (const NamedDesign& design : designs) {
    Table::Row row{design.name, design.geometries.size()};
    const std::vector<double> own = expected_uncertainties(components, design.geometries, targets);
    for (std::size_t t = 0; t < own.size(); ++t) row.push_back(std::hypot(own[t], shared[t]));
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

void print(const Table& table, const Terms& terms, Format format) {
  if (format == Format::csv) {
    std::cout << csv(table);
    return;
  }
  if (format == Format::json) return program::print(json_of(table));
  Page page;
  page.add(
      "expected standard uncertainties, root mean square over the elements of a block up to 70 degrees; errors that\n"
      "all readings share are not in them" +
      std::string(terms.texts.empty() ? "" : ", but for those of --term in the targets") + "\n\n");
  page.add(table);
  std::cout << page.written(format);
}

void plan(const Options& options) {
  for (const std::string& path : options.designs) require_kept(path, options.output, "geometries");
  require_kept(options.candidates, options.output, "candidates");
  if (!options.like.empty()) require_model_kept(options.like, options.output);
  const VarianceComponents known = components(options);
  const std::vector<NamedTarget> all = wanted(options, known);
  std::vector<NamedDesign> list = designs(options);
  if (options.choose == 0 && !options.candidates.empty()) throw missing("--choose");
  if (options.choose > 0) {
    if (options.candidates.empty()) throw missing("--from");
    const std::vector<Geometry> candidates = read_geometries(options.candidates);
    std::vector<PlanTarget> targets;
    const bool own = all.size() > block_targets(known).size();
    for (const NamedTarget& one : all)
      if (!own || one.target.kind != PlanTarget::Kind::block) targets.push_back(one.target);
    const std::vector<Geometry> start = list.empty() ? std::vector<Geometry>{} : list.front().geometries;
    NamedDesign more{list.empty() ? "chosen" : list.front().name + " and chosen", start};
    std::vector<Geometry> picks;
    for (const std::size_t c : chosen(known, start, targets, candidates, static_cast<std::size_t>(options.choose)))
      picks.push_back(candidates[c]);
    more.geometries.insert(more.geometries.end(), picks.begin(), picks.end());
    list.push_back(std::move(more));
    if (!options.output.empty()) write_text(options.output, geometries_csv(picks));
  }
  print(table_of(known, list, all, shared_uncertainties(all, options)), options.terms, options.format);
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
    "  mmbrdf plan scan.csv --target dhr:8 --term scale=0.3%\n"
    "  mmbrdf plan scan.csv --choose 50 --from candidates.csv -o next.csv";

}  // namespace

Run plan_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_files(app, "GEOMETRIES.csv", o->designs, "Designs: directions to be measured").required();
  add_text(app, "--like", o->like, "MODEL", "A fit whose variances the sample will have [sintered PTFE]");
  add_option(app, "-w,--wavelength", o->wavelength_nm, number, "NM", "Of the fit of --like, in nm [its first]");
  add_option(app, "--noise", o->noise, number, "S", "Of a reading, at normal directions [of the fit; 0.007]");
  add_texts(app, "--target", o->targets, "TARGET",
            "What is to be known: dhr:THETA[,THETA...] or\nf:THETA_I:THETA_R[:PHI_R], in degrees");
  add_term(app, o->terms, "Add to each target an error that all readings share, as in\nscale=0.3%; repeatable");
  add_option(app, "--choose", o->choose, whole_number, "N", "Choose N more readings");
  add_file(app, "--from", o->candidates, "CANDIDATES.csv", "Directions to choose from");
  add_output_file(app, "-o,--output", o->output, "CHOSEN.csv", "Write what is chosen");
  add_option(app, "--format", o->format, format_from, "FORMAT", "text, csv, json or html [text]");
  set_footer(app, footer);
  return [o] { plan(*o); };
}

}  // namespace mmbrdf::program
