// SPDX-License-Identifier: BSD-3-Clause
/// Measurements in the formats of other programs, read as samples: which there are, what each holds and what it leaves
/// to be told is in docs/formats.md, "Formats of the field".
///
/// Directions, frame, units and signs of the samples are this project's (geometry.hpp, mueller.hpp), whatever those of
/// the file. Formats are told by what a file holds, never by its ending.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mmbrdf/polarization/mueller.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// What a file does not say itself.
struct ForeignOptions {
  /// Micrometres: of the file, or one for each of the values that it has at a geometry, in its order. Empty: not told.
  std::vector<double> wavelengths = {};
  std::string told_by = "--wavelength ";  ///< how messages say it is told: this, then a number in nanometres

  bool operator==(const ForeignOptions&) const = default;
};

/// Of which format a file is that begins so and has this many bytes: "an ASTM E1392 or E2387 file". Empty for any
/// other. foreign_head bytes are enough.
std::string foreign_format(std::string_view head, std::uint64_t size);
inline constexpr std::size_t foreign_head = 65536;

/// The same of a file. Throws std::runtime_error if it cannot be opened.
std::string foreign_format(const std::string& path);

/// A file in one of these formats, read in memory that does not grow with it; of JSON alone all is held.
///
/// Constructor and read() throw std::runtime_error for a file that is in no such format, is cut off, has dimensions or
/// numbers that cannot be, or does not fit to the options; the message is one line with the path, then line, field or
/// offset, the value and what to do. Nothing is allocated that is larger than the file could fill.
class ForeignFile {
 public:
  /// Reads what is needed to say what the file holds.
  explicit ForeignFile(const std::string& path, const ForeignOptions& options = {});
  ~ForeignFile();
  ForeignFile(ForeignFile&&) noexcept;
  ForeignFile& operator=(ForeignFile&&) noexcept;

  /// As foreign_format().
  const std::string& format() const { return format_; }

  /// The elements that any of its samples may have, in the frame in which it was measured; the others are unknown in all.
  Elements measured() const;

  /// Whether its samples have uncertainties.
  bool has_uncertainties() const;

  /// Whether samples may be known as_measured in another frame than xy.
  bool has_frames() const;

  /// Hands over all samples, a few thousand at a time, in the order of the file; once. Rows and nodes of which a direction is at
  /// or below the horizon are passed over, as are those that the format marks as not measured.
  void read(const std::function<void(std::span<const Sample>)>& use);

  /// What the file is and how it was understood, in words: parametrization, units, frame and signs, what it had no place
  /// for; after read(), what was passed over.
  std::string understood() const;

  /// Implemented by each format.
  class Reader;

 private:
  std::string path_, format_;
  std::unique_ptr<Reader> reader_;
};

}  // namespace mmbrdf
