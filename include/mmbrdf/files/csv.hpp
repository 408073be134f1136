// SPDX-License-Identifier: BSD-3-Clause
/// Tables of comma-separated values, row by row, and the columns of geometries in them (docs/formats.md).
#pragma once

#include <array>
#include <iosfwd>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/text/input.hpp"

namespace mmbrdf {

/// Whether the path ends so, in either case: ".csv"
bool has_ending(std::string_view path, std::string_view ending);

/// Other names of columns: {{"theta_i_deg", "AOI"}}. A number, counted from 1, is the column there.
using ColumnNames = std::map<std::string, std::string>;

/// How the fields of a table are written (docs/formats.md, "Tables of others").
struct TableLayout {
  char separator = ',';         ///< ' ' stands for any number of blanks
  bool foreign = false;         ///< what is said of quotes, names and numbers below
  bool header_comment = false;  ///< the header is a line that begins with # or %
  bool row_names = false;       ///< of which the header says nothing
  char decimal = 0;             ///< '.' or ',', once a number had it
};

/// Rows of comma-separated fields under a header line, one at a time, in constant memory. LF or CRLF; empty lines and
/// lines that begin with # are passed over; a UTF-8 byte order mark too. Fields are not quoted; blanks around them do
/// not count.
class CsvReader {
 public:
  /// Reads the header. `name` stands for the file in messages. Throws std::runtime_error for an empty file, a binary
  /// one, a first row of numbers (no header), or a column name given twice. `in` must outlive the reader.
  CsvReader(std::istream& in, std::string name);

  /// A table as other programs write it: separated by commas, semicolons, tabs or blanks; names and fields in quotes or
  /// not, names in any case, with units in brackets or behind _; decimal commas where commas do not separate; exponents
  /// with D; a header in a comment before the first row; row names that the header leaves out. `columns` has names for
  /// columns that are called otherwise, or the numbers of all that are needed where there is no header. Throws
  /// std::runtime_error as above, and for a column of `columns` that is not there. `unnamed` are the names of the
  /// first columns, and there are no others, where there is no header and nothing else is said; empty: a table needs one.
  CsvReader(std::istream& in, std::string name, const ColumnNames& columns,
            const std::vector<std::string>& unnamed = {});

  /// A file without a header line, whose columns are these. What is behind `remark` in a line is passed over; 0: nothing.
  CsvReader(std::istream& in, std::string name, std::vector<std::string> columns, char remark = 0);

  /// Rows of the same file as `whole` that are behind so many lines of it: for pieces of it in several threads.
  CsvReader(std::istream& in, const CsvReader& whole, long lines_before);

  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  const std::vector<std::string>& columns() const { return columns_; }

  /// The names by which they are found: those of columns(), but in a table of others in lower case, with _ between
  /// words, and those that `columns` gave. Upper case stays in a name such as M12 beside names in lower case.
  const std::vector<std::string>& keys() const { return keys_; }

  /// Position of the column with one of these names, or −1. Throws std::runtime_error if two columns have one.
  int find(std::span<const std::string_view> names) const;
  int find(std::string_view name) const { return find(std::span(&name, 1)); }

  /// What is behind "# NAME: " in a line above the header; empty if none is there.
  std::string remark(std::string_view name) const;

  /// How it is written.
  const TableLayout& layout() const { return layout_; }

  /// Whether what was taken for the header of a table of others may be a title above it: the line below has more or fewer
  /// fields.
  bool may_be_title() const { return may_be_title_; }

  /// Reads the next row; false at the end. Throws std::runtime_error for a row with more or fewer fields than columns,
  /// for one of more than longest_line bytes, and for control characters: the file is binary.
  bool next();
  static constexpr int longest_line = 65535;

  /// The row as it stands in the file, without its line end. Valid until next().
  std::string_view text() const { return text_; }

  /// A field of the row without surrounding blanks. Valid until next().
  std::string_view field(int column) const { return fields_[static_cast<std::size_t>(column)]; }

  /// A field as a finite number. Throws std::runtime_error with line, column and text for anything else.
  double number(int column) const;

  /// Whether a field says that there is no value: empty, NA, N/A, NaN, NULL, None, in any case, or -, #N/A, #DIV/0!,
  /// 1.#IND and the like.
  bool is_missing(int column) const;

  /// "file:line: " + text, as an error to throw.
  [[nodiscard]] std::runtime_error error(const std::string& text) const;

  /// Of the row, from 1.
  long line() const { return line_number_; }

 private:
  bool read_line();
  bool read_row();
  void require_distinct_columns() const;
  void name_columns(const ColumnNames& columns);
  double foreign_number(std::string_view field) const;
  std::string row_hint(int column) const;

  std::istream& in_;
  std::string name_;
  std::vector<char> line_;
  std::string_view text_;
  long line_number_ = 0;
  char remark_ = 0;
  std::vector<std::string> remarks_;  ///< lines above the header, without their marks
  std::vector<std::string> columns_, keys_;
  std::vector<std::string_view> fields_;
  mutable TableLayout layout_;  // the decimal mark is that of the first number that has one
  long pending_ = 0;            // the line of a row that was read with the header
  long first_row_ = 0;          // the line of the first, if it was
  bool may_be_title_ = false;
};

/// Finds the columns of wavelength and angles under any of their documented names and units, and reads them.
/// Polar angles may be negative as in the published data, and come back unfolded. Throws std::runtime_error if a column
/// is missing or there twice, a polar angle leaves [−90, 90] degrees, or a wavelength is not positive, or such that it
/// seems to be in another unit: below 10 in nanometres, beyond 20 in a column `lambda`.
class GeometryColumns {
 public:
  /// Without a wavelength column, `wavelength` (micrometres) is used for each row if it is positive.
  explicit GeometryColumns(const CsvReader& reader, double wavelength = 0);
  Geometry geometry(const CsvReader& reader) const;
  double wavelength(const CsvReader& reader) const;

  /// Their positions: of the wavelength, if it has a column, and of the angles.
  std::vector<int> columns() const;

 private:
  int wavelength_column_ = -1;
  double units_per_micrometre_ = 1;
  double wavelength_ = 0;
  std::array<int, 4> angles_{};  // theta_i, phi_i, theta_r, phi_r; −1: 0
  std::array<bool, 4> in_radians_{};
  bool relative_azimuth_ = false;  // phi_r is counted from phi_i
};

}  // namespace mmbrdf
