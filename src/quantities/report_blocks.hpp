// SPDX-License-Identifier: BSD-3-Clause
// The document of a report: its blocks, one behind the other. Part of report.hpp, which says what they hold.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mmbrdf/quantities/report.hpp"
#include "quantities/report_fields.hpp"

namespace mmbrdf {

/// How a number or word of a row is written.
enum class Cell {
  words,    ///< of others: as they are
  prose,    ///< of this project, with its symbols in print
  count,    ///< all digits
  two,      ///< significant digits
  three,    ///< significant digits
  angle,    ///< to hundredths of a degree
  given,    ///< wavelengths, to 1e-9 nm
  yes_no,   ///< true or false
  with_u,   ///< with the uncertainty that another column of the row has
  like,     ///< to the place where two digits of another column end
  element,  ///< "23" of f₂₃
  place,    ///< "theta_i 80, theta_r 70, phi_r - phi_i 180 degrees" as three angles below one heading
};

struct DocumentColumn {
  std::string key, heading;
  Cell cell = Cell::words;
  std::string other = {};  ///< column that with_u and like name
};

class Document {
 public:
  Document(const std::string& title, Notation notation, std::vector<std::string> names)
      : json_{{"title", title}, {"blocks", Json::array()}}, notation_(notation), names_(std::move(names)) {}

  /// The first sentence: of what, and what of it.
  void summary(const std::string& subject, const std::string& text) {
    add({{"kind", "summary"}, {"subject", subject}, {"text", in_symbols(text)}});
  }
  void heading(const std::string& text);
  void paragraph(const std::string& text) { add({{"kind", "paragraph"}, {"text", in_symbols(text)}}); }
  /// "warnings", "notes" or "contents", whose lines the headings are.
  void lines(const std::string& kind, const Json& sentences);
  /// Cells are text; columns of numbers are set to the right.
  void table(const std::string& caption, const std::vector<std::string>& headings, const std::vector<bool>& numbers,
             const Json& rows, const std::string& remark = "");
  /// Of rows as the facts have them.
  void table(const std::string& caption, const std::vector<DocumentColumn>& columns, const Json& rows);
  /// What mmbrdf plot draws, of the width of a page in cm.
  void figure(const std::string& caption, const std::string& kind, const Json& arguments, const std::string& command,
              bool of_data, double width_cm);

  Notation notation() const { return notation_; }
  std::string in_symbols(const std::string& sentence) const;  ///< but for the names of files in it
  std::string text() const { return json_.dump(-1, ' ', false, Json::error_handler_t::replace); }

 private:
  void add(const Json& block) { json_["blocks"].push_back(block); }
  std::string cell(const DocumentColumn& column, const Json& row) const;

  Json json_;
  Notation notation_;
  std::vector<std::string> names_;
  int tables_ = 0, figures_ = 0;
};

/// The tables of the facts, with pictures behind them. `field` is one of them.
void add_field(Document& document, const std::string& field, const Json& value);

/// What is drawn, and with which command.
struct Drawn {
  const Model& model;
  const ReportOrigin& origin;
  std::vector<double> wavelengths;  ///< nm; empty: its only one, which nobody knows
  double theta_i_deg, phi_i_deg;
  Json terms = Json::object();  ///< of u, as mmbrdf.plot takes them: {"scale": 0.003}
};
void add_reflectance_figures(Document& document, const Drawn& drawn);
void add_model_figures(Document& document, const Drawn& drawn);
void add_residual_figures(Document& document, const Drawn& drawn, const Json& directions);
void add_coefficient_figures(Document& document, const Drawn& drawn);

}  // namespace mmbrdf
