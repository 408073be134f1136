// SPDX-License-Identifier: BSD-3-Clause
/// Files of samples: the published measurements, and the project's own columns (docs/formats.md).
///
/// Reading throws std::runtime_error with "file:line: …" and the value that is wrong.
/// Writing replaces a file as a whole: write_file.hpp.
#pragma once

#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/polarization/mueller.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// What a table of samples does not say itself.
struct SampleTable {
  /// Own names, such as "theta_i_deg" or "f11", of columns that are called otherwise: CsvReader.
  ColumnNames columns = {};
  /// Whether rows with a field that is NA or NaN, or without an angle or wavelength, are passed over, not refused.
  bool skip_incomplete = false;
  /// In which the matrices are. Not given: as a column `frame` says, else xy; of f_ss … f_pp, sp.
  std::optional<Frame> frame = {};
  StokesConvention convention = StokesConvention::germer2017;

  bool operator==(const SampleTable&) const = default;
};

class ElementColumns;

/// Samples of a file one at a time, in constant memory: see read_samples.
class SampleReader {
 public:
  /// Reads the header. Refuses a file in another program's format (foreign.hpp), and says which one it is.
  SampleReader(std::istream& in, const std::string& name, const SampleTable& table = {});
  ~SampleReader();
  /// The next sample; false at the end.
  bool next(Sample& sample);

  /// What of the table is not as in the project's own, in words: what separates, other names, what f11 was made of, what
  /// was not read, rows that were passed over, and that have elements unknown in xy. Empty if there is nothing to
  /// say.
  std::string understood() const;

  /// From which readings the samples were made, and how, if the file says it above its header: "# reduction: …".
  std::string reduction() const { return reader_.remark("reduction"); }

 private:
  bool complete() const;
  Frame frame_of_row() const;

  std::string name_;
  SampleTable table_;
  CsvReader reader_;
  GeometryColumns geometry_;
  std::unique_ptr<const ElementColumns> elements_;
  int rotation_, frame_;
  std::vector<int> needed_, read_;  // columns
  long rows_ = 0, passed_over_ = 0, lost_ = 0;
};

/// Whether a file begins as one of samples does, and none of a model: as one of another program's formats (foreign.hpp),
/// or its first line, but for empty ones and comments,
/// with a letter, a quote or a comma, or with a number behind a comment that names angles. Throws std::runtime_error for a
/// file that cannot be opened.
bool holds_samples(const std::string& path);
bool holds_samples(std::istream& in);

/// Samples in the layout of the published data, with the project's own column names, or as other programs write tables
/// (docs/formats.md). Throws std::runtime_error, as the classes above do, for a file without rows or with elements that
/// are not normalised, and for uncertainties that are negative or not there for all elements. Without their columns they
/// are 0, not known.
std::vector<Sample> read_samples(const std::string& path, const SampleTable& table = {});
std::vector<Sample> read_samples(std::istream& in, const std::string& name, const SampleTable& table = {});

/// The project's own columns: wavelength_nm, angles in degrees, f11, m12 … m44, with as many digits as it takes:
/// matrices read back are the same bits, wavelengths and angles equal to 1 in the last place. Behind them u_f11, u_m12
/// … u_m44, if the samples have uncertainties. Wavelengths below 10 nm make it wavelength_um, as GeometryColumns ask.
/// Above the header "# reduction: " and that text, if there is one. Throws std::invalid_argument for invalid samples, if
/// only some have uncertainties, and for a text with a line end. Where any is known as_measured, a column `frame` says in
/// which frame the elements of each row are, and those are as they were measured.
void write_samples(const std::string& path, std::span<const Sample> samples, const std::string& reduction = "");
void write_samples(std::ostream& out, std::span<const Sample> samples, const std::string& reduction = "");

/// The same, some samples at a time, in constant memory. Not checked: they must be valid. Throws std::invalid_argument for
/// one known as_measured without a column of frames.
class SampleWriter {
 public:
  /// Writes the header line: columns of these elements, and of f11; of the frame of each row, without which none may be
  /// known as_measured; wavelengths in nanometres, or below 10 nm in micrometres. `out` must outlive the writer.
  SampleWriter(std::ostream& out, const Elements& measured, bool with_uncertainties, bool with_frames,
               bool in_micrometres = false);
  void write(std::span<const Sample> samples);

 private:
  std::ostream& out_;
  Elements written_;
  bool with_uncertainties_, with_frames_, in_micrometres_;
};

}  // namespace mmbrdf
