// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <stdexcept>
#include <vector>

#include "describe.hpp"
#include "files.hpp"
#include "mmbrdf/io.hpp"
#include "output.hpp"

namespace mmbrdf::program {

namespace {

/// The model at the wavelengths that were asked for lately.
class RecentWavelengths {
 public:
  explicit RecentWavelengths(PreparedModel first) : models_{std::move(first)} {}

  const PreparedModel& at(double wavelength) {
    if (models_[last_].wavelength() != wavelength) {
      const auto known = std::find_if(models_.begin(), models_.end(),
                                      [=](const PreparedModel& model) { return model.wavelength() == wavelength; });
      last_ = static_cast<std::size_t>(known - models_.begin());
      if (known == models_.end()) {
        add(models_[0].at(wavelength));
      }
    }
    return models_[last_];
  }

 private:
  static constexpr std::size_t most = 16;

  void add(PreparedModel model) {
    if (models_.size() < most) {
      last_ = models_.size();
      models_.push_back(std::move(model));
    } else {
      last_ = oldest_;
      models_[last_] = std::move(model);
      oldest_ = (oldest_ + 1) % most;
    }
  }

  std::vector<PreparedModel> models_;
  std::size_t last_ = 0, oldest_ = 0;
};

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

std::string header(const CsvReader& reader, bool normalized) {
  const std::string added = element_columns(normalized) + ",validity";
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
  FileEvaluator(const Model& model, const FileEvaluation& what, CsvReader& reader)
      : what_(what),
        reader_(reader),
        columns_(reader, what.wavelength > 0 ? what.wavelength : own_wavelength(model)),
        header_(header(reader, what.normalized)),
        models_(prepare(model, 1, what.rotation)),
        unknown_(unknown_range_line(what.model, model.validity)) {
    if (what.wavelength > 0 && has_wavelengths(reader)) {
      warn("--wavelength is not used: the rows have their own");
    }
  }

  /// The rest of the file.
  void write(std::ostream& out) {
    std::string text = header_;
    while (out && reader_.next()) {  // when out has failed, write_file tells why
      add_row(text);
      progress_.row();
      if (text.size() > chunk) {
        put(out, text);
      }
    }
    put(out, text);
  }

  void report() const {
    progress_.end();
    if (outside_ > 0) {
      warn(std::to_string(outside_) + " of " + counted(progress_.rows(), "row") + (outside_ == 1 ? " lies" : " lie") +
           " outside the fitted range: see column validity");
    }
    if (!unknown_.empty()) {
      warn(unknown_);
    }
  }

 private:
  static constexpr std::size_t chunk = 1 << 16;

  void add_row(std::string& text) {
    const PreparedModel& model = models_.at(columns_.wavelength(reader_));
    const Geometry geometry = columns_.geometry(reader_);
    const Outside outside = model.outside(geometry);
    text += reader_.text();
    append_elements(text, evaluated(model, geometry));
    text += ',';
    text += to_string(outside);
    text += '\n';
    outside_ += leaves_known_range(outside) ? 1 : 0;
  }

  Mueller evaluated(const PreparedModel& model, const Geometry& geometry) const {
    try {
      const Mueller f = model.evaluate(geometry, what_.frame);
      return what_.normalized ? normalized_beside_f11(f) : f;
    } catch (const std::invalid_argument& error) {
      throw reader_.error(plain_message(error));
    }
  }

  static void put(std::ostream& out, std::string& text) {
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    text.clear();
    if (&out == &std::cout) {
      flush_output();
    }
  }

  const FileEvaluation& what_;
  CsvReader& reader_;
  GeometryColumns columns_;
  std::string header_;
  RecentWavelengths models_;
  Progress progress_;
  std::string unknown_;  // what the model does not say about its range
  long outside_ = 0;
};

void evaluate_stream(const Model& model, const FileEvaluation& what, std::istream& in, const std::string& name) {
  CsvReader reader(in, name);
  FileEvaluator evaluator(model, what, reader);
  if (is_standard_output(what.output)) {
    evaluator.write(std::cout);
  } else {
    write_file(what.output, [&](std::ostream& out) { evaluator.write(out); });
  }
  evaluator.report();
}

}  // namespace

void evaluate_file(const Model& model, const FileEvaluation& what) {
  read_input(what.input, [&](std::istream& in, const std::string& name) { evaluate_stream(model, what, in, name); });
}

}  // namespace mmbrdf::program
