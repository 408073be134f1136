// SPDX-License-Identifier: BSD-3-Clause
// Rows of geometries of any number, from a CSV file or from elsewhere, with what a model says of each behind it.
#pragma once

#include <functional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/model/description.hpp"
#include "streams/geometry_rows.hpp"

namespace mmbrdf::program {

/// What is written behind the geometry of a row: fields, each with a comma before it.
struct AddedFields {
  std::string text;
  Outside outside = inside;
};

struct AddedColumns {
  std::string names;  ///< ",f11,f12,…"
  /// Of rows of one wavelength, in micrometres. Throws std::invalid_argument where there is no answer to one of them.
  std::function<std::vector<AddedFields>(double wavelength, std::span<const Geometry> geometries)> fields;
};

/// What is written of many rows.
struct Evaluated {
  std::string names;    ///< ",f11,f12,…" behind the columns of the input
  bool binary = false;  ///< the 16 elements of each row alone, as a .npy file has them
  /// Makes what appends some rows to `out`, each behind its text unless binary, and counts them.
  /// One for each thread. Throws std::runtime_error from the source.
  std::function<std::function<RangeCount(const GeometrySource&, const Rows&, std::string& out)>()> writer;
  int threads = 1;
};

/// The 16 elements, and the validity unless binary.
Evaluated evaluated_rows(const Model& model, Frame frame, bool normalized, bool binary);

/// The same of other columns, in one thread.
Evaluated with_columns(const AddedColumns& columns);

struct RowsOfFile {
  std::string model;      ///< name, for messages
  std::string input;      ///< path; - for standard input
  std::string output;     ///< path; empty or - for standard output
  double wavelength = 0;  ///< micrometres, for rows without; 0: the model's own
};

/// Each row as it is, with the columns behind it; or binary. A column of the input that has the name of one of those is
/// called input_NAME. Says on standard error how many rows lie outside the fitted range, if that is known.
/// Throws std::runtime_error naming file and line.
void evaluate_file(const Model& model, const RowsOfFile& what, const Evaluated& evaluated);

/// Text that goes to `out` piece by piece.
class RowWriter {
 public:
  RowWriter(std::ostream& out, std::string header) : out_(out), text_(std::move(header)) {}
  std::string& text() { return text_; }
  void end_row();
  void flush();

 private:
  std::ostream& out_;
  std::string text_;
};

/// Says that so many rows lie outside the fitted range, and what the model does not say about it. `where` says which.
void report_rows(const RangeCount& range, const std::string& unknown_range,
                 const std::string& where = ": see column validity");

}  // namespace mmbrdf::program
