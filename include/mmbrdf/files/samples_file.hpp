// SPDX-License-Identifier: BSD-3-Clause
/// Files: samples, published coefficients, and models. The layouts are described in docs/formats.md.
///
/// Reading throws std::runtime_error with "file:line: …" and the value that is wrong. Writing goes to a temporary
/// file in the same folder that is renamed when it is complete: an error leaves what was there before.
#pragma once

#include <array>
#include <fstream>
#include <functional>
#include <iosfwd>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mmbrdf/model/model.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// Opens a file for reading. Throws std::runtime_error, naming the path and the reason, if that fails or it is a
/// folder.
std::ifstream open_input(const std::string& path);

/// Rows of comma-separated fields under a header line, one at a time, in constant memory. LF or CRLF; empty lines and
/// lines that begin with # are passed over; a UTF-8 byte order mark too. Fields are not quoted; blanks around them do
/// not count.
class CsvReader {
 public:
  /// Reads the header. `name` stands for the file in messages. Throws std::runtime_error for an empty file, a binary
  /// one, a first row of numbers (no header), or a column name given twice. `in` must outlive the reader.
  CsvReader(std::istream& in, std::string name);

  /// A file without a header line, whose columns are these.
  CsvReader(std::istream& in, std::string name, std::vector<std::string> columns);

  /// Rows of the same file as `whole` that are behind so many lines of it: for pieces of it in several threads.
  CsvReader(std::istream& in, const CsvReader& whole, long lines_before);

  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  const std::vector<std::string>& columns() const { return columns_; }

  /// Position of the column with one of these names, or −1. Throws std::runtime_error if two columns have one.
  int find(std::span<const std::string_view> names) const;

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

  /// "file:line: " + text, as an error to throw.
  [[nodiscard]] std::runtime_error error(const std::string& text) const;

  /// Of the row, from 1.
  long line() const { return line_number_; }

 private:
  bool read_line();
  bool read_row();

  std::istream& in_;
  std::string name_;
  std::vector<char> line_;
  std::string_view text_;
  long line_number_ = 0;
  std::vector<std::string> columns_;
  std::vector<std::string_view> fields_;
};

/// Finds the columns of wavelength and angles under any of their documented names and units, and reads them.
/// Polar angles may be negative as in the published data, and come back unfolded. Throws std::runtime_error if a column
/// is missing or there twice, a polar angle leaves [−90, 90] degrees, or a wavelength is not positive.
class GeometryColumns {
 public:
  /// Without a wavelength column, `wavelength` (micrometres) is used for each row if it is positive.
  explicit GeometryColumns(const CsvReader& reader, double wavelength = 0);
  Geometry geometry(const CsvReader& reader) const;
  double wavelength(const CsvReader& reader) const;

 private:
  int wavelength_column_ = -1;
  double units_per_micrometre_ = 1;
  double wavelength_ = 0;
  std::array<int, 4> angles_{};  // theta_i, phi_i, theta_r, phi_r
};

/// Samples of a file one at a time, in constant memory: see read_samples.
class SampleReader {
 public:
  /// Reads the header.
  SampleReader(std::istream& in, const std::string& name);
  /// The next sample; false at the end.
  bool next(Sample& sample);

 private:
  std::string name_;
  CsvReader reader_;
  GeometryColumns geometry_;
  int m11_ = -1;
  std::array<int, 16> elements_, uncertainties_;  // columns; −1: none
  long rows_ = 0;
};

/// Samples in the layout of the published data, or with the project's own column names (docs/formats.md). Throws
/// std::runtime_error, as the classes above do, for a file without rows or with elements that are not normalised, and
/// for uncertainties that are negative or not there for all elements. Without their columns they are 0, not known.
std::vector<Sample> read_samples(const std::string& path);
std::vector<Sample> read_samples(std::istream& in, const std::string& name);

/// The project's own columns: wavelength_nm, angles in degrees, f11, m12 … m44, with as many digits as it takes:
/// matrices read back are the same bits, wavelengths and angles equal to 1 in the last place. Behind them u_f11, u_m12
/// … u_m44, if the samples have uncertainties. Throws std::invalid_argument for invalid samples, or if only some have.
void write_samples(const std::string& path, std::span<const Sample> samples);
void write_samples(std::ostream& out, std::span<const Sample> samples);

/// Published coefficient files: i, j, n, m, k, l, p, a without a header, rows in any order. The model has family
/// germer2017, no reflectance table, and its validity is unknown; powers of a mode that the file lacks are 0. Throws
/// std::runtime_error for indices that break a rule, duplicates, i > j, and p outside 0…9.
Model read_coefficients(const std::string& path);
Model read_coefficients(std::istream& in, const std::string& name);

/// The published layout, which SCATMECH reads; of an isotropic model its published form. Reading a published file and
/// writing it gives the same bytes, but for the line ends. Reflectance table, validity and covariance have no place in
/// it: the caller must say so. Throws std::invalid_argument for a model that has no published form: an anisotropic one,
/// or another mapping than lambert.
std::string to_coefficients_csv(const Model& model);

/// The project's own model files (docs/formats.md). A model read back has the same bits, but for the angles of its
/// validity. Reading throws std::runtime_error with "name: field: …"; writing std::invalid_argument for an invalid
/// model.
inline constexpr int schema_version = 1;
Model model_from_json(std::string_view text, const std::string& name);
std::string to_json(const Model& model);

/// A model from a file: JSON if the first character that is not white space is {, else published coefficients. A model
/// without a name gets that of the file, without folder and extension.
Model load_model(const std::string& path);

/// JSON, or the published coefficient layout if the path ends in .csv or .CSV.
void save_model(const std::string& path, const Model& model);

/// Runs `write` on a stream whose contents appear under `path` only when all of it is written: a temporary file in the
/// same folder, renamed. Links are followed, and an existing file keeps its permissions. A path that exists and is not
/// a regular file (a device, a pipe, /dev/stdout) is written to directly. The stream can go back to the beginning,
/// seekp(0), where the file can. Throws std::runtime_error naming the path if it cannot be written in full, and
/// whatever `write` throws; then an earlier file is left as it was.
void write_file(const std::string& path, const std::function<void(std::ostream&)>& write);

}  // namespace mmbrdf
