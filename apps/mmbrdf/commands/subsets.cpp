// SPDX-License-Identifier: BSD-3-Clause
// mmbrdf subsets

#include "mmbrdf/fitting/subsets.hpp"
#include "mmbrdf/model/description.hpp"

#include <cmath>
#include <memory>

#include "command.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"
#include "pages/describe.hpp"
#include "pages/page.hpp"

namespace mmbrdf::program {

namespace {

struct Options {
  std::string data, reference, output;
  Division division;
  bool as_printed = false;
  Basis basis;
  FitOptions fit;
  Weights weights = Weights::none;
  std::optional<double> wavelength_nm;
  SampleTable table;
  double theta_i_deg = 45;
  std::vector<double> theta_r_deg = range_from("-60:60:1");
  Format format = Format::text;
};

/// The samples, and what was asked of all splits.
struct Question : SubsetQuestion {
  std::vector<Sample> samples;
  std::optional<Model> given;  // the reference, if it is not the fit to all samples
};

std::string range_text(const Options& o) {
  return brief(o.theta_r_deg.front()) + " ... " + brief(o.theta_r_deg.back()) + " degrees (" +
         counted(static_cast<long>(o.theta_r_deg.size()), "angle") + ")";
}

std::string division(const Options& o) {
  return o.division.by_lot() ? "by lot, seed " + std::to_string(o.division.seed) : "dealt in turn";
}

std::string heading(const Question& q, const Options& o) {
  std::string text = data_name(o.data) + ": " + counted(static_cast<long>(q.samples.size()), "sample") + " in " +
                     std::to_string(o.division.parts) + " parts, " + division(o) + "\n";
  text += "basis " + to_string(o.basis.family) + (o.as_printed ? " as printed" : "") + ", orders " +
          std::to_string(o.basis.orders.f11) + "," + std::to_string(o.basis.orders.other) + ", weights " +
          to_string(o.weights) + "\n";
  return text + "f_ss, f_sp, f_ps, f_pp at " + brief(nanometres(q.wavelength)) +
         " nm, theta_i = " + brief(o.theta_i_deg) + ", theta_r = " + range_text(o) + "\nall divided by " +
         (o.reference.empty() ? std::string("the fit to all samples") : base_name(o.reference)) + "\n\n";
}

/// To what the predicted uncertainty leaves.
std::string percent(const char* what, double value, double predicted) {
  return format("%-52s %8s %%\n", what, to_place_of(100 * value, 100 * predicted).c_str());
}

std::string text(const Question& q, const Options& o, const std::vector<SubsetSplit>& splits) {
  std::string text = heading(q, o);
  const double predicted = splits.front().predicted;
  if (splits.size() == 1) {
    const SubsetStatistics& s = splits.front().statistics;
    text += percent("mean standard deviation of the fits", s.mean_deviation, predicted);
    text += percent("|mean of the fits - 1|, mean", s.mean_distance, predicted);
    text += percent("|mean of the fits - 1|, largest", s.largest_distance, predicted);
    text.insert(text.size() - 1, " at theta_r = " + brief(o.theta_r_deg[s.largest_at]));
  } else {
    text += counted(static_cast<long>(splits.size()), "split") + "\n";
  }
  text += percent("standard deviation, root mean square", root_mean_variance(splits), predicted);
  text += percent("the same as the covariance of one fit predicts it", predicted, predicted);
  if (predicted > 0) text += format("%-52s %8.2f\n", "observed / predicted", root_mean_variance(splits) / predicted);
  return text;
}

constexpr std::array<const char*, 4> names{"f_ss", "f_sp", "f_ps", "f_pp"};
constexpr std::array members{&PolarizedBrdf::ss, &PolarizedBrdf::sp, &PolarizedBrdf::ps, &PolarizedBrdf::pp};

/// The curves of one split.
std::string curves_csv(const Options& o, const SubsetSplit& split) {
  std::string text = "theta_r_deg";
  for (const std::string name : names) {
    for (std::size_t k = 1; k <= split.curves.size(); ++k) text += "," + name + "_" + std::to_string(k);
    text += "," + name + "_mean,s_" + name + ",u_" + name + "," + name + "_reference";
  }
  for (std::size_t g = 0; g < split.reference.size(); ++g) {
    text += "\n" + shortest(o.theta_r_deg[g]);
    for (const auto member : members) {
      for (const PolarizedCurve& curve : split.curves) text += "," + exact(curve[g].*member);
      for (const PolarizedCurve* curve :
           {&split.statistics.mean, &split.statistics.deviation, &split.uncertainty, &split.reference}) {
        text += "," + exact((*curve)[g].*member);
      }
    }
  }
  return text + "\n";
}

/// A row for each split.
Table table(const Options& o, const std::vector<SubsetSplit>& splits) {
  Table table{{{.name = "seed"},
               {.name = "mean_deviation"},
               {.name = "root_mean_variance"},
               {.name = "predicted", .where = in_csv},
               {.name = "mean_distance"},
               {.name = "largest_distance"},
               {.name = "theta_r_deg", .where = in_csv, .digits = shortest},
               {.name = "largest_at_theta_r_deg", .where = in_json}}};
  for (std::size_t i = 0; i < splits.size(); ++i) {
    const SubsetStatistics& s = splits[i].statistics;
    const double at = o.theta_r_deg[s.largest_at];
    table.rows.push_back({splits[i].seed ? Json(*splits[i].seed) : Json(), s.mean_deviation, s.root_mean_variance,
                          splits[i].predicted, s.mean_distance, s.largest_distance, at, at});
  }
  return table;
}

std::string csv(const Question&, const Options& o, const std::vector<SubsetSplit>& splits) {
  return splits.size() == 1 ? curves_csv(o, splits.front()) : csv(table(o, splits));
}

std::string json(const Question& q, const Options& o, const std::vector<SubsetSplit>& splits) {
  Json json{{"data", data_name(o.data)},
            {"samples", q.samples.size()},
            {"parts", o.division.parts},
            {"basis", to_string(o.basis.family)},
            {"orders", {o.basis.orders.f11, o.basis.orders.other}},
            {"rotation", to_string(o.basis.rotation)},
            {"weights", to_string(o.weights)},
            {"wavelength_nm", nanometres(q.wavelength)},
            {"theta_i_deg", o.theta_i_deg},
            {"angles", o.theta_r_deg.size()}};
  json["reference"] = o.reference.empty() ? Json() : Json(base_name(o.reference));
  json["splits"] = json_of(table(o, splits));
  json["observed"] = root_mean_variance(splits);
  json["predicted"] = splits.front().predicted;
  return printed(json);
}

void require_valid(const Options& o) {
  if (o.theta_i_deg < 0 || o.theta_i_deg > 90)
    throw std::invalid_argument("--theta-i " + shortest(o.theta_i_deg) + ": is not in [0, 90] degrees");
  for (const double theta : {o.theta_r_deg.front(), o.theta_r_deg.back()})
    if (std::abs(theta) > 90)
      throw std::invalid_argument("--range: " + shortest(theta) + " is not in [-90, 90] degrees");
  if (o.as_printed && !traits(o.basis.family).at_zero_azimuth)
    throw WrongUsage("--as-printed", "goes with --basis germer2017");
  if (o.division.parts < 2 || o.division.parts > max_folds)
    throw std::invalid_argument("--k " + std::to_string(o.division.parts) + ": is not in 2..." +
                                std::to_string(max_folds));
  if (o.division.splits < 1) throw std::invalid_argument("--splits 0: must be at least 1");
  if (o.division.splits > max_splits)
    throw std::invalid_argument("--splits " + std::to_string(o.division.splits) + ": at most " +
                                std::to_string(max_splits));
  require_kept(o.data, o.output, "data");
  require_kept(o.reference, o.output, "reference");
}

/// Of the directions of the curves, by what the fit to all samples and the reference were fitted to.
void warn_of_directions(const Model& model, const Question& q, const std::string& name) {
  std::vector<Sample> asked;
  for (const Geometry& geometry : q.geometries) asked.push_back({q.wavelength, geometry, 1, identity()});
  warn_if_outside(model, asked, name);
}

/// The wavelength at which the fits are compared: the only one, or the one asked for.
double wavelength_of(const std::vector<Sample>& samples, const Options& o) {
  const std::vector<double> present = wavelengths(samples);
  if (present.size() == 1) return present.front();
  throw WrongUsage("--wavelength is required", data_name(o.data) + " has samples at " + nanometre_list(present));
}

Question question(const Options& o) {
  std::optional<std::vector<double>> wavelengths_nm;
  if (o.wavelength_nm) wavelengths_nm = {*o.wavelength_nm};
  Question q;
  q.basis = o.basis;
  q.fit = o.fit;
  q.weights = o.weights;
  q.samples = samples_at(o.data, wavelengths_nm, o.table);
  q.wavelength = wavelength_of(q.samples, o);
  std::vector<double> theta_r;
  for (const double theta : o.theta_r_deg) theta_r.push_back(radians(theta));
  q.geometries = in_plane(radians(o.theta_i_deg), theta_r);
  if (!o.reference.empty()) q.given = open_model(o.reference);
  return q;
}

void study(Options o) {
  require_valid(o);
  o.basis.rotation = o.as_printed ? Rotation::as_printed : Rotation::covariant;
  Question q = question(o);
  if (q.given) q.reference = &*q.given;
  std::vector<SubsetSplit> splits;
  try {
    splits = split_samples(q.samples, o.division, q);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(data_name(o.data) + ": " + error.what());
  }
  Model range;
  range.validity = splits.front().validity;
  warn_of_directions(range, q, data_name(o.data));
  if (q.reference) warn_of_directions(*q.reference, q, base_name(o.reference));
  if (const std::size_t left_out = splits.front().statistics.left_out; left_out > 0)
    warn("the reference is not positive at " + std::to_string(left_out) + " of " +
         std::to_string(o.theta_r_deg.size()) + " angles: what is divided by it leaves them out");
  if (o.format == Format::csv) return write_text(o.output, csv(q, o, splits));
  if (o.format == Format::json) return write_text(o.output, json(q, o, splits));
  Page page;
  page.add(text(q, o, splits));
  write_text(o.output, page.written(o.format));
}

constexpr const char* footer =
    "The samples of one wavelength are divided into K parts, and each is fitted apart. The fits are compared in the\n"
    "plane of incidence, where f_ss, f_sp, f_ps, f_pp are BRDFs between linear polarizations, the incident one first:\n"
    "how much they differ from each other (standard deviation with K - 1 degrees of freedom) and their mean from the\n"
    "reference. Beside it stands what the covariance of the one fit to all samples predicts for a fit to a K-th of\n"
    "them. theta_r > 0 is forward, towards the specular direction. csv has the curves (s_: standard deviation of the\n"
    "fits, u_: predicted), with --splits a row for each split.\n"
    "\n"
    "Examples:\n"
    "  mmbrdf subsets data.csv --wavelength 532\n"
    "  mmbrdf subsets data.csv --splits 30 --seed 1";

}  // namespace

Run subsets_command(CLI::App& app, const CommandLine&) {
  const auto o = std::make_shared<Options>();
  add_file(app, "DATA.csv", o->data, " ", "Samples; - is standard input").required();
  add_option(app, "--k", o->division.parts, whole_number, "K", "Number of parts [3]");
  add_flag(app, "--random", o->division.random, "Divide by lot; else every K-th direction is of one part");
  add_option(app, "--splits", o->division.splits, whole_number, "N",
             "Divide by lot as often as this, with seeds S, S+1, ... [1]");
  add_option(app, "--seed", o->division.seed, seed, "S", "Whole number that chooses the lot [0]");
  add_option(app, "-w,--wavelength", o->wavelength_nm, number, "NM", "Of the samples, in nm, if there are several");
  add_table_options(app, o->table);
  add_option(app, "--theta-i", o->theta_i_deg, number, "DEG", "Polar angle of incidence [45]");
  add_option(app, "--range", o->theta_r_deg, range_from, "FROM:TO:STEP", "Polar angles of the detector [-60:60:1]");
  add_basis_option(app, o->basis);
  add_flag(app, "--as-printed", o->as_printed, "germer2017: fit and evaluate at the azimuths as they are");
  add_weights_option(app, o->weights);
  add_model(app, o->reference, "--reference")
      .required(false)
      .option_text("MODEL")
      .description(
          "What the fits are divided by: built-in name, JSON model or\ncoefficient CSV [the fit to all samples]");
  add_file(app, "-o,--output", o->output, "OUT", "Where the result goes; - is standard output [-]");
  add_option(app, "--format", o->format, format_from, "FORMAT", "text, csv, json or html [text]");
  set_footer(app, footer);
  return [o] { study(*o); };
}

}  // namespace mmbrdf::program
