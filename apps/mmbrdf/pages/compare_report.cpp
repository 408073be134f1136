// SPDX-License-Identifier: BSD-3-Clause
#include "pages/compare_report.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "mmbrdf/model/description.hpp"
#include "pages/describe.hpp"
#include "pages/page.hpp"

namespace mmbrdf::program {

namespace {

/// To what chance leaves of a root mean square of so many.
std::string rms_text(double rms, double count) { return to_place_of(rms, rms / std::sqrt(2 * count)); }

/// Of so many differences, how many say something of their own: directions share the errors of models and instruments.
double independent(long samples) {
  constexpr long most = 1250;  // which leaves 2 % of a root mean square
  return static_cast<double>(std::min(samples, most));
}

/// What text has beside the numbers is in a table of its own.
Table table(const CompareReport& report) {
  Table table{{{"element", "%-8s"}, {"unit", "%-6s"}}};
  for (const char* name : {"rms", "mean", "largest"}) {  // each with what chance leaves of it
    table.columns.push_back({name, name[0] == 'r' ? "%11.6g" : "%12.6g"});
    table.columns.push_back({.name = std::string("u_") + name, .where = nowhere});
  }
  table.columns.push_back({.name = "wavelength_nm", .format = "%7.6g", .heading = "at nm", .digits = shortest});
  for (const std::string angle : {"theta_i", "phi_i", "theta_r", "phi_r"})
    table.columns.push_back({.name = angle + "_deg", .format = "%8.2f", .heading = angle, .digits = shortest});
  if (report.significance)
    for (const char* name : {"mean_over_u", "largest_over_u", "within_95", "u_difference", "rms_over_u", "beyond_2u"})
      table.columns.push_back({.name = name, .where = in_csv | in_json});
  const auto add = [&](std::size_t e, const std::string& unit, const Difference& d) {
    Table::Row& row = table.rows.emplace_back(Table::Row{element_name(e), unit});
    if (d.samples == 0) return;  // not measured
    const double count = independent(d.samples);
    row.insert(row.end(), {d.rms, d.rms / std::sqrt(2 * count), d.mean, d.rms / std::sqrt(count), d.largest, d.rms});
    std::ranges::copy(place(d), std::back_inserter(row));
    if (!report.significance || (*report.significance)[e].samples == 0) return;
    const Significance& s = (*report.significance)[e];
    const bool relative = e == 0 && unit == "f11";
    row.insert(row.end(), {s.mean, s.largest, s.within, relative ? Json() : Json(s.u), s.rms, s.beyond});
  };
  add(0, "sr^-1", report.comparison.f11);
  add(0, "f11", report.comparison.f11_relative);
  for (std::size_t e = 1; e < 16; ++e) add(e, "f11", report.comparison.normalized[e]);
  return table;
}

void add_significance(Page& page, const CompareReport& report) {
  Table table{{{"element", "%-8s"},
               {"unit", "%-6s"},
               {"typical u", "%11s"},
               {"rms d/u", "%12.2f"},
               {"largest d/u", "%12.2f"},
               {"beyond 2 u, %", "%14.1f"}}};
  for (std::size_t e = 0; e < 16; ++e) {
    const Significance& s = (*report.significance)[e];
    if (s.samples == 0) continue;
    table.rows.push_back(
        {element_name(e), e == 0 ? "sr^-1" : "f11", to_place_of(s.u, s.u), s.rms, s.largest, 100 * s.beyond});
  }
  if (table.rows.empty()) return;
  page.add("\ndifference d over its standard uncertainty u, " + report.uncertain +
           ":\nrms 1 and 4.6 % beyond 2 u if they differ by chance\n");
  page.add(table);
}

Page page_of(const CompareReport& report) {
  const Comparison& comparison = report.comparison;
  double others = 0;
  long values = 0;
  for (std::size_t e = 1; e < 16; ++e) {
    others += comparison.normalized[e].samples > 0 ? 1 : 0;
    values += comparison.normalized[e].samples;
  }
  const bool as_printed = report.rotation == Rotation::as_printed;
  Page page;
  page.add(report.second + " - " + report.first + (as_printed ? " as printed" : "") + ": " +
           counted(comparison.samples, report.matched.empty() ? "sample" : "pair") + " at " +
           nanometre_list(report.wavelengths) + ", frame xy\n" + report.matched + "\n");
  page.add(table(report));
  if (report.significance) add_significance(page, report);
  page.add(report.significance ? "\n" : "\n" + report.uncertain + "\n");
  if (others > 0)
    page.add(format("%-35s", ("rms of the " + brief(others) + " others / f11").c_str()) +
             rms_text(polarization_rms(comparison), independent(values)) + "\n");
  const Difference most = largest(comparison);
  page.add(format("%-35s", "largest difference / f11") + to_place_of(most.largest, most.rms) + "\n");
  return page;
}

std::string csv_of(const CompareReport& report) {
  Table all = table(report);
  all.rows.push_back({"polarization", "f11", polarization_rms(report.comparison)});
  return csv(all);
}

std::string json_of(const CompareReport& report) {
  Json json;
  json["model"] = report.first;
  json["compared_with"] = report.second;
  if (report.rotation) json["rotation"] = to_string(*report.rotation);
  json["frame"] = "xy";
  json["samples"] = report.comparison.samples;
  json["dark_samples"] = report.comparison.dark;
  for (const double wavelength : report.wavelengths) json["wavelengths_nm"].push_back(nanometres(wavelength));
  json["elements"] = json_of(table(report));
  json["rms_polarization"] = polarization_rms(report.comparison);
  json["largest"] = largest(report.comparison).largest;
  return printed(json);
}

}  // namespace

std::array<double, 5> place(const Difference& d) {
  return {nanometres(d.wavelength), degrees(d.geometry.incident.theta), degrees(d.geometry.incident.phi),
          degrees(d.geometry.reflected.theta), degrees(d.geometry.reflected.phi)};
}

std::string written(const CompareReport& report, Format format) {
  if (format == Format::csv) return csv_of(report);
  return format == Format::json ? json_of(report) : page_of(report).written(format);
}

}  // namespace mmbrdf::program
