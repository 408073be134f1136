// SPDX-License-Identifier: BSD-3-Clause
#include "streams/geometry_rows.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <streambuf>

#include "mmbrdf/files/csv.hpp"
#include "pages/output.hpp"
#include "streams/npy.hpp"

namespace mmbrdf::program {

namespace {

// ---- CSV ------------------------------------------------------------------------------------------------------------

constexpr std::size_t bytes_at_once = 1 << 16;

class Memory : public std::streambuf {
 public:
  explicit Memory(const std::string& bytes) {
    char* const begin = const_cast<char*>(bytes.data());  // of a buffer that is only read
    setg(begin, begin, begin + bytes.size());
  }
};

/// Cuts a stream at ends of lines.
class Lines {
 public:
  Lines(std::istream& in, std::string name, long before) : in_(in), name_(std::move(name)), before_(before) {}

  bool next(Piece& piece) {
    piece.bytes = std::move(rest_);
    piece.before = before_;
    rest_.clear();
    const std::size_t kept = piece.bytes.size();
    piece.bytes.resize(kept + bytes_at_once);
    in_.read(&piece.bytes[kept], static_cast<std::streamsize>(bytes_at_once));
    piece.bytes.resize(kept + static_cast<std::size_t>(in_.gcount()));
    before_ += std::count(piece.bytes.begin() + static_cast<std::ptrdiff_t>(kept), piece.bytes.end(), '\n');
    if (in_.bad()) throw std::runtime_error(name_ + ": read error after line " + std::to_string(before_));
    if (!in_.eof()) {  // a line without end, longer than any may be, goes on as it is and is refused there
      if (const std::size_t end = piece.bytes.rfind('\n'); end != std::string::npos) {
        rest_ = piece.bytes.substr(end + 1);
        piece.bytes.resize(end + 1);
      }
    }
    return !piece.bytes.empty();
  }

 private:
  std::istream& in_;
  std::string name_, rest_;
  long before_;
};

Rows rows_of_csv(const CsvReader& whole, const GeometryColumns& columns, const Piece& piece) {
  Memory memory(piece.bytes);
  std::istream in(&memory);
  CsvReader reader(in, whole, piece.before);
  Rows rows;
  try {
    while (reader.next()) {
      const double wavelength = columns.wavelength(reader);
      rows.geometries.push_back(columns.geometry(reader));
      rows.wavelengths.push_back(wavelength);
      rows.numbers.push_back(reader.line());
      rows.all_text += reader.text();
      rows.text_ends.push_back(rows.all_text.size());
    }
  } catch (const std::runtime_error& error) {
    rows.error = error;
  }
  return rows;
}

bool has_wavelengths(const CsvReader& reader) {
  try {
    GeometryColumns{reader};
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

GeometrySource csv_source(std::istream& in, const std::string& name, double wavelength) {
  const auto reader = std::make_shared<CsvReader>(in, name);
  const auto lines = std::make_shared<Lines>(in, name, reader->line());
  return {
      .columns = reader->columns(),
      .has_wavelengths = has_wavelengths(*reader),
      .next = [lines](Piece& piece) { return lines->next(piece); },
      .rows = [reader, columns = GeometryColumns(*reader, wavelength)](
                  const Piece& piece) { return rows_of_csv(*reader, columns, piece); },
      .error =
          [name, reader](long number, const std::string& text) {
            return std::runtime_error(name + ":" + std::to_string(number > 0 ? number : reader->line()) + ": " + text);
          }};
}

// ---- .npy -----------------------------------------------------------------------------------------------------------

constexpr std::size_t rows_at_once = 4096;
const std::vector<std::string> npy_columns = {"wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg"};

std::runtime_error npy_error(const std::string& name, long number, const std::string& text) {
  return std::runtime_error(name + ": " + (number > 0 ? "row " + std::to_string(number) + ": " : "") + text);
}

class NpyRows {
 public:
  NpyRows(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {
    const std::vector<std::size_t> shape = read_npy_header(in_, name_);
    if (shape.size() != 2 || shape[1] != npy_columns.size()) {
      std::string text;
      for (const std::size_t length : shape) text += (text.empty() ? "" : ", ") + std::to_string(length);
      throw npy_error(name_, 0, "shape (" + text + "), expected (rows, 5): " + joined(npy_columns));
    }
    count_ = shape[0];
  }

  /// Of a file that is too short, first the rows that there are: one of them may be wrong.
  bool next(Piece& piece) {
    const std::size_t count = std::min(rows_at_once, count_ - read_), width = 8 * npy_columns.size();
    piece.before = static_cast<long>(read_);
    piece.bytes.resize(count * width);
    in_.read(piece.bytes.data(), static_cast<std::streamsize>(piece.bytes.size()));
    const std::size_t there = static_cast<std::size_t>(in_.gcount()) / width;
    piece.bytes.resize(there * width);
    read_ += there;
    if (there == 0 && count > 0)
      throw npy_error(name_, 0, "ends after " + std::to_string(read_) + " of " + std::to_string(count_) + " rows");
    if (count == 0 && in_.peek() != std::istream::traits_type::eof())
      throw npy_error(name_, 0, "goes on behind its " + std::to_string(count_) + " rows");
    return count > 0;
  }

 private:
  std::istream& in_;
  std::string name_;
  std::size_t count_ = 0, read_ = 0;
};

double wavelength_of(double nanometres, long number, const std::string& name) {
  const double wavelength = nanometres / 1000;
  if (!(wavelength > 0) || !std::isfinite(wavelength))
    throw npy_error(name, number, "wavelength_nm: " + shortest(nanometres) + ": a wavelength must be positive");
  return wavelength;
}

Direction direction_of(double theta, double phi, const char* column, long number, const std::string& name) {
  if (!(std::abs(theta) <= 90)) {
    throw npy_error(name, number,
                    std::string(column) + ": " + shortest(theta) + " degrees; a polar angle is at most 90");
  }
  if (!std::isfinite(phi)) throw npy_error(name, number, shortest(phi) + " is not a finite azimuth");
  return direction_from_degrees(theta, phi);
}

Rows rows_of_npy(const std::string& name, const Piece& piece) {
  const std::size_t count = piece.bytes.size() / (8 * npy_columns.size());
  Rows rows;
  rows.wavelengths.reserve(count);
  rows.geometries.reserve(count);
  rows.numbers.reserve(count);
  const char* next = piece.bytes.data();
  for (std::size_t row = 0; row < count; ++row, next += 8 * npy_columns.size()) {
    const long number = piece.before + static_cast<long>(row) + 1;
    try {
      const double wavelength = wavelength_of(from_npy(next), number, name);
      rows.geometries.push_back({direction_of(from_npy(next + 8), from_npy(next + 16), "theta_i_deg", number, name),
                                 direction_of(from_npy(next + 24), from_npy(next + 32), "theta_r_deg", number, name)});
      rows.wavelengths.push_back(wavelength);
      rows.numbers.push_back(number);
    } catch (const std::runtime_error& error) {
      rows.error = error;
      break;
    }
  }
  return rows;
}

/// The fields as a CSV file has them.
void add_text(Rows& rows, const Piece& piece) {
  const char* next = piece.bytes.data();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t column = 0; column < npy_columns.size(); ++column, next += 8)
      rows.all_text += (column > 0 ? "," : "") + shortest(from_npy(next));
    rows.text_ends.push_back(rows.all_text.size());
  }
}

GeometrySource npy_source(std::istream& in, const std::string& name, bool with_text) {
  const auto array = std::make_shared<NpyRows>(in, name);
  return {.columns = npy_columns,
          .has_wavelengths = true,
          .next = [array](Piece& piece) { return array->next(piece); },
          .rows =
              [name, with_text](const Piece& piece) {
                Rows rows = rows_of_npy(name, piece);
                if (with_text) add_text(rows, piece);
                return rows;
              },
          .error = [name](long number, const std::string& text) { return npy_error(name, number, text); }};
}

}  // namespace

GeometrySource open_geometries(std::istream& in, const std::string& name, double wavelength, bool with_text) {
  return is_npy(name) || begins_as_npy(in) ? npy_source(in, name, with_text) : csv_source(in, name, wavelength);
}

}  // namespace mmbrdf::program
