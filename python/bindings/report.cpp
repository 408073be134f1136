// SPDX-License-Identifier: BSD-3-Clause
// Facts about models.
#include "mmbrdf/quantities/report.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <ostream>
#include <tuple>
#include <variant>

#include "dataset.hpp"
#include "mmbrdf/files/write_file.hpp"
#include "mmbrdf/quantities/fit_warnings.hpp"
#include "mmbrdf/text/date.hpp"
#include "mmbrdf/text/notation.hpp"
#include "mmbrdf/text/rounding.hpp"
#include "question.hpp"

namespace mmbrdf::python {

namespace {

/// {"theta_i": (0, 30)}
py::dict hole_object(const Hole& hole) {
  py::dict result;
  const auto add = [&](const char* name, const std::optional<Hole::Degrees>& part) {
    if (part) result[name] = py::make_tuple(part->from, part->to);
  };
  add("theta_i", hole.theta_i);
  add("theta_r", hole.theta_r);
  add("phi_r_phi_i", hole.phi);
  return result;
}

py::array_t<double> array_of(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::object missing_object(const MissingShares& missing) {
  py::array_t<double> detector = array_of(missing.detector);
  return record("Missing", array_of(missing.theta_deg), array_of(missing.phi_deg), array_of(missing.theta_i),
                detector.reshape({static_cast<py::ssize_t>(missing.theta_deg.size()),
                                  static_cast<py::ssize_t>(missing.phi_deg.size())}));
}

py::object inspection_object(const Dataset& data) {
  const Inspection seen = without_gil([&] { return inspect(data.samples); });
  const auto finding = [](const Finding& one) {
    return record("Finding", one.fault, one.evidence, one.remedy,
                  tuple_of(one.samples, [](std::size_t i) { return py::int_(i); }));
  };
  py::dict rows;
  for (const auto& [name, text] : inspection_rows(seen, data.samples)) rows[py::str(name)] = text;
  return record("Inspection", tuple_of(seen.findings, finding), seen.f11_residual, seen.unsupported, seen.hole,
                tuple_of(seen.untested, [](const Untested& one) { return record("Untested", one.fault, one.reason); }),
                hole_object(seen.hole_at), missing_object(seen.missing), array_of(seen.residuals), rows,
                verdict_line(seen));
}

/// Of date, software, command, model, data and files: (what, name, SHA-256) each.
ReportOrigin origin_of(const py::dict& said) {
  const auto text = [&](const char* name) { return said[name].cast<std::string>(); };
  ReportOrigin origin{text("date"), text("software"), text("command")};
  origin.model = text("model");
  origin.data = text("data");
  for (const auto& [what, name, digest] :
       said["files"].cast<std::vector<std::tuple<std::string, std::string, std::string>>>())
    origin.files.push_back({what, name, digest});
  return origin;
}

using NamedOrTyped = std::variant<std::map<std::string, double>, std::vector<std::string>>;

std::vector<TypeBTerm> terms_of(const std::optional<NamedOrTyped>& given) {
  if (!given) return {};
  if (const auto* named = std::get_if<std::map<std::string, double>>(&*given)) return terms_from(*named);
  std::vector<TypeBTerm> result;
  for (const std::string& text : std::get<std::vector<std::string>>(*given)) {
    try {
      result.push_back(term_from(text));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(std::string("terms: ") + error.what());
    }
  }
  return result;
}

void bind_documents(py::module_& m) {
  m.def(
      "_report_document",
      [](const ModelObject& model, const std::string& facts, const py::dict& said, const std::string& notation,
         double theta_i_deg) {
        return report_document(model.model(), facts, origin_of(said), {notation_from(notation), theta_i_deg});
      },
      py::arg("model"), py::arg("facts"), py::arg("origin"), py::arg("notation"), py::arg("theta_i_deg"),
      "The document of a report as JSON text: report_document() of report.hpp.");
  m.def("_report_markdown", &report_markdown, py::arg("document"), "Such a document as Markdown.");
  m.def(
      "_shown_name_of",
      [](const ModelObject& model, const std::string& name) { return shown_name_of(model.model(), name); },
      py::arg("model"), py::arg("name"), "How reports and pictures name a model that was called so.");
  m.def("_symbols_in_print", &symbols_in_print, py::arg("sentence"), "A sentence with its symbols as in print.");
  m.def("_utc_timestamp", &utc_timestamp, "Now, or at SOURCE_DATE_EPOCH.");
}

}  // namespace

void bind_report(py::module_& m) {
  m.def(
      "report_json",
      [](const ModelObject& model, const std::string& name, const std::optional<std::vector<double>>& wavelengths_nm,
         const DatasetPointer& data, const std::string& data_name, const std::optional<NamedOrTyped>& given) {
        const std::vector<TypeBTerm> terms = terms_of(given);
        const std::vector<double> wavelengths = micrometres(wavelengths_nm.value_or(std::vector<double>{}));
        return without_gil([&] {
          return report_json(model.model(), name, wavelengths,
                             data ? std::optional(ReportedSamples{data_name, data->samples}) : std::nullopt, terms);
        });
      },
      py::arg("model"), py::arg("name"), py::arg("wavelength_nm") = py::none(), py::arg("data") = py::none(),
      py::arg("data_name") = "samples", py::arg("terms") = py::none(),
      "What is known about a model, and about samples beside it, as the JSON text that `mmbrdf report --format json`\n"
      "prints: title, warnings, notes, model, fit, realizability, reflectances, budgets and, with samples, residuals, "
      "symmetries,\n"
      "noise, leverage and outliers. wavelength_nm are those to report on; None: those it was fitted to. terms of type "
      "B "
      "are of\n"
      "all u: as those of evaluate_uncertainty(), or as they are typed, ['plaque:scale=0.3%,dof=12'].");
  m.def(
      "inspect", [](const Dataset& data) { return inspection_object(data); }, py::arg("data"),
      "What is wrong with samples, as far as they betray it, before they are fitted: an Inspection. Fill values, "
      "f11\n"
      "below 0, elements that are not divided, matrices that cannot exist, zeros, repeated rows, wavelengths; by fits "
      "of low order to "
      "the\n"
      "first wavelength radians that are called degrees, the scale of f11, a cosine too many or too few, folded "
      "azimuths,\n"
      "frame and signs, and which of these could not be seen. residuals are nan where there is no fit.");
  bind_documents(m);
  m.def("_to_place_of", &to_place_of, py::arg("value"), py::arg("uncertainty"),
        "A number to the place where two digits of its standard uncertainty end; six digits without one.");
  m.def(
      "_write_text",
      [](const std::filesystem::path& path, const std::string& text) {
        without_gil([&] { write_file(path.string(), [&](std::ostream& out) { out << text; }); });
      },
      py::arg("path"), py::arg("text"), "All of it or nothing, through links and into devices: write_file().");
}

}  // namespace mmbrdf::python
