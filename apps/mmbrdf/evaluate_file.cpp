// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <vector>

#include "files.hpp"
#include "mmbrdf/description.hpp"
#include "mmbrdf/io.hpp"
#include "output.hpp"
#include "recent_wavelengths.hpp"

namespace mmbrdf::program {

namespace {

/// Counts rows on standard error, if that is a terminal.
class Progress {
 public:
  void row() {
    ++rows_;
    if (terminal_ && rows_ % 4096 == 0 && Clock::now() - shown_ > std::chrono::milliseconds(250)) {
      shown_ = Clock::now();
      std::cerr << "\rmmbrdf: " << rows_ << " rows" << std::flush;
    }
  }
  void end() const {
    if (terminal_) {
      std::cerr << "\r\033[K" << std::flush;
    }
  }
  long rows() const { return rows_; }

 private:
  using Clock = std::chrono::steady_clock;
  const bool terminal_ = isatty(STDERR_FILENO) != 0;
  Clock::time_point shown_ = Clock::now();
  long rows_ = 0;
};

double own_wavelength(const Model& model) {
  try {
    return only_wavelength(model);
  } catch (const std::invalid_argument&) {
    return 0;  // then each row must have one
  }
}

std::string header(const CsvReader& reader, const std::string& added) {
  const std::vector<std::string>& columns = reader.columns();
  std::string text;
  for (const std::string& column : columns) {
    const bool taken = !column.empty() && (added + ",").find("," + column + ",") != std::string::npos;
    const std::string name = (taken ? "input_" : "") + column;
    if (taken && std::find(columns.begin(), columns.end(), name) != columns.end()) {
      throw reader.error("columns " + column + " and " + name + " are there already: " + column +
                         " would be written again");
    }
    text += (&column == &columns.front() ? "" : ",") + name;
  }
  return text + added + "\n";
}

bool has_wavelengths(const CsvReader& reader) {
  try {
    GeometryColumns{reader};
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

class FileEvaluator {
 public:
  FileEvaluator(const Model& model, const RowsOfFile& what, const AddedColumns& added, CsvReader& reader)
      : added_(added),
        reader_(reader),
        columns_(reader, what.wavelength > 0 ? what.wavelength : own_wavelength(model)),
        header_(header(reader, added.names)),
        unknown_(unknown_range_line(what.model, model.validity)) {
    if (what.wavelength > 0 && has_wavelengths(reader)) {
      warn("--wavelength is not used: the rows have their own");
    }
  }

  /// The rest of the file.
  void write(std::ostream& out) {
    RowWriter writer(out, header_);
    while (out && reader_.next()) {  // when out has failed, write_file tells why
      add_row(writer.text());
      progress_.row();
      writer.end_row();
    }
    writer.flush();
  }

  void report() const {
    progress_.end();
    report_rows(outside_, progress_.rows(), unknown_);
  }

 private:
  void add_row(std::string& text) {
    const double wavelength = columns_.wavelength(reader_);
    const Geometry geometry = columns_.geometry(reader_);
    text += reader_.text();
    try {
      outside_ += leaves_known_range(added_.append(text, wavelength, geometry)) ? 1 : 0;
    } catch (const std::invalid_argument& error) {
      throw reader_.error(plain_message(error));
    }
  }

  const AddedColumns& added_;
  CsvReader& reader_;
  GeometryColumns columns_;
  std::string header_;
  Progress progress_;
  std::string unknown_;  // what the model does not say about its range
  long outside_ = 0;
};

void evaluate_stream(const Model& model, const RowsOfFile& what, const AddedColumns& added, std::istream& in,
                     const std::string& name) {
  CsvReader reader(in, name);
  FileEvaluator evaluator(model, what, added, reader);
  if (is_standard_output(what.output)) {
    evaluator.write(std::cout);
  } else {
    write_file(what.output, [&](std::ostream& out) { evaluator.write(out); });
  }
  evaluator.report();
}

}  // namespace

void RowWriter::end_row() {
  constexpr std::size_t chunk = 1 << 16;
  text_ += '\n';
  if (text_.size() > chunk) {
    flush();
  }
}

void RowWriter::flush() {
  out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
  text_.clear();
  if (&out_ == &std::cout) {
    flush_output();
  }
}

void report_rows(long outside, long rows, const std::string& unknown_range) {
  if (outside > 0) {
    warn(std::to_string(outside) + " of " + counted(rows, "row") + (outside == 1 ? " lies" : " lie") +
         " outside the fitted range: see column validity");
  }
  if (!unknown_range.empty()) {
    warn(unknown_range);
  }
}

AddedColumns evaluated_columns(const Model& model, Frame frame, Rotation rotation, bool normalized) {
  const auto models = std::make_shared<RecentWavelengths<PreparedModel>>(
      [first = prepare(model, 1, rotation)](double wavelength) { return first.at(wavelength); });
  return {element_columns(normalized) + ",validity",
          [models, frame, normalized](std::string& text, double wavelength, const Geometry& geometry) {
            const PreparedModel& prepared = models->at(wavelength);
            const Mueller f = prepared.evaluate(geometry, frame);
            append_elements(text, normalized ? normalized_beside_f11(f) : f);
            const Outside outside = prepared.outside(geometry);
            text += ',';
            text += to_string(outside);
            return outside;
          }};
}

void evaluate_file(const Model& model, const RowsOfFile& what, const AddedColumns& columns) {
  read_input(what.input,
             [&](std::istream& in, const std::string& name) { evaluate_stream(model, what, columns, in, name); });
}

}  // namespace mmbrdf::program
