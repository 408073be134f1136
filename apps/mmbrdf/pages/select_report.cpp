// SPDX-License-Identifier: BSD-3-Clause
#include "pages/select_report.hpp"

#include <algorithm>
#include <array>
#include <iostream>

#include "mmbrdf/model/description.hpp"
#include "pages/describe.hpp"
#include "pages/page.hpp"

namespace mmbrdf::program {

namespace {

using Kind = Partition::Kind;

/// Both parts with their names.
std::array<std::pair<const char*, const PartSelection*>, 2> parts(const Selection& selection) {
  return {{{"f11", &selection.f11}, {"other", &selection.other}}};
}

bool is_recommended(const PartSelection& part, const Candidate& candidate) {
  return part.recommended && &candidate == &part.candidates[*part.recommended];
}

/// "recommended", "refused" or nothing.
std::string status(const PartSelection& part, const Candidate& candidate) {
  return is_recommended(part, candidate) ? "recommended" : candidate.refusal.empty() ? "" : "refused";
}

/// "3 folds by row, 6 incident angles"
std::string left_out(std::span<const Partition> partitions) {
  std::vector<std::string> words;
  for (const Partition& partition : partitions) {
    const std::string count = std::to_string(partition.names.size());
    words.push_back(partition.kind == Kind::angle        ? count + " incident angles"
                    : partition.kind == Kind::wavelength ? count + " wavelengths"
                    : partition.kind == Kind::random     ? count + " random folds"
                                                         : count + " folds by row");
  }
  return joined(words);
}

/// "--orders 7,4 --powers 1"
std::string recommended_options(const SelectReport& report) {
  const Selection& selection = report.selection;
  return "--orders " + std::to_string(selection.orders->f11) + "," + std::to_string(selection.orders->other) +
         (report.wavelengths.size() > 1 ? " --powers " + std::to_string(selection.powers) : "");
}

constexpr std::array kinds{Kind::rows, Kind::random, Kind::angle, Kind::wavelength};

std::vector<Column> columns(const SelectReport& report) {
  std::vector<Column> columns{{"part", "%s", "", in_csv}, {"order", "%5s"},         {"powers", "%6s"},
                              {"coefficients", "%12s"},   {"rank", "%6s"},          {"condition", "%10.4g"},
                              {"rms", "%10.4g"},          {"aic", "%10.1f", "AIC"}, {"bic", "%10.1f", "BIC"}};
  for (const Kind kind : kinds) {
    const bool there = std::ranges::count(report.partitions, kind, &Partition::kind) > 0;
    columns.push_back(
        {"cv_" + to_string(kind), "%13.4g", "CV " + to_string(kind), there ? in_text | in_csv : unsigned{in_csv}});
  }
  columns.push_back({"status", " %s", "", in_text | in_csv});
  columns.push_back({"reason", "%s", "", in_csv});
  columns.push_back({"cross_validation", "", "", in_json});
  columns.push_back({"refused", "", "", in_json});
  return columns;
}

const HeldOut* of_kind(const SelectReport& report, const Candidate& candidate, Kind kind) {
  for (std::size_t p = 0; p < report.partitions.size(); ++p)
    if (report.partitions[p].kind == kind) return &candidate.held_out[p];
  return nullptr;
}

Json cross_validation_json(const SelectReport& report, const Candidate& candidate) {
  Json json = Json::object();
  for (std::size_t p = 0; p < report.partitions.size(); ++p) {
    const HeldOut& held_out = candidate.held_out[p];
    const Partition& partition = report.partitions[p];
    if (held_out.undetermined.empty()) {
      json[to_string(partition.kind)] = {
          {"rms", held_out.rms}, {"worst", held_out.worst}, {"worst_fold", partition.names[held_out.worst_fold]}};
    } else {
      json[to_string(partition.kind)] = {{"rms", nullptr}, {"undetermined", held_out.undetermined}};
    }
  }
  return json;
}

/// The candidates for f11, or for the other elements.
Table table(const SelectReport& report, const PartSelection& part) {
  Table table{columns(report)};
  const std::string name = &part == &report.selection.f11 ? "f11" : "other";
  for (const Candidate& one : part.candidates) {
    Table::Row row{name, one.order, one.powers, one.coefficients, one.rank, one.condition, one.rms, one.aic, one.bic};
    for (const Kind kind : kinds) {
      const HeldOut* held_out = of_kind(report, one, kind);
      row.push_back(held_out && held_out->undetermined.empty() ? Json(held_out->rms) : Json());
    }
    row.insert(row.end(), {status(part, one), is_recommended(part, one) ? part.reason : one.refusal,
                           cross_validation_json(report, one), one.refusal.empty() ? Json() : Json(one.refusal)});
    table.rows.push_back(row);
  }
  return table;
}

Page page_of(const SelectReport& report) {
  Page page;
  page.add(report.data + ": " + counted(report.rows, "row") + " at " + nanometre_list(report.wavelengths) + "\nbasis " +
           to_string(report.options.family) + ", " + to_string(report.options.mapping) + " mapping, weights " +
           report.weights + "\nleft out in turn: " + left_out(report.partitions) + "\n");
  const bool divided = report.wavelengths.size() > 1 || report.options.reflectance;
  for (const auto& [name, part] : parts(report.selection)) {
    const bool is_f11 = part == &report.selection.f11;
    if (part->candidates.empty()) continue;  // not measured
    page.add(!is_f11 ? "\nThe others / f11\n" : divided ? "\nf11 / reflectance, sr^-1\n" : "\nf11, sr^-1\n");
    page.add(table(report, *part));
    for (const Candidate& one : part->candidates) {
      if (!one.refusal.empty()) {
        page.add("order " + std::to_string(one.order) +
                 (one.powers > 0 ? ", powers " + std::to_string(one.powers) : "") + " refused: " + one.refusal + "\n");
      }
    }
  }
  page.add("\n" + (report.selection.orders ? "recommended: " + recommended_options(report) : "no recommendation") +
           "\n  f11     " + report.selection.f11.reason + "\n  others  " + report.selection.other.reason + "\n");
  return page;
}

void print_csv(const SelectReport& report) {
  Table all = table(report, report.selection.f11);
  for (Table::Row& row : table(report, report.selection.other).rows) all.rows.push_back(std::move(row));
  std::cout << csv(all);
}

void print_json(const SelectReport& report) {
  Json json{{"data", report.data}, {"rows", report.rows}, {"weights", report.weights}};
  json["wavelengths_nm"] = Json::array();
  for (const double wavelength : report.wavelengths) json["wavelengths_nm"].push_back(nanometres(wavelength));
  json["basis"] = to_string(report.options.family);
  json["mapping"] = to_string(report.options.mapping);
  json["left_out"] = left_out(report.partitions);
  const Selection& selection = report.selection;
  for (const auto& [name, part] : parts(selection)) json[name] = json_of(table(report, *part));
  json["recommended_orders"] = selection.orders ? Json{selection.orders->f11, selection.orders->other} : Json();
  json["recommended_powers"] = selection.orders ? Json(selection.powers) : Json();
  json["reason_f11"] = selection.f11.reason;
  json["reason_other"] = selection.other.reason;
  print(json);
}

}  // namespace

void print(const SelectReport& report, Format format) {
  if (format == Format::csv) return print_csv(report);
  if (format == Format::json) return print_json(report);
  std::cout << page_of(report).written(format);
}

}  // namespace mmbrdf::program
