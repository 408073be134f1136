// SPDX-License-Identifier: BSD-3-Clause
#include "streams/evaluate_file.hpp"

#include <algorithm>
#include <cctype>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/text/printable.hpp"
#include "options/files.hpp"
#include "pages/output.hpp"
#include "streams/in_order.hpp"
#include "streams/npy.hpp"
#include "streams/progress.hpp"
#include "streams/waiting_input.hpp"

namespace mmbrdf::program {

namespace {

double own_wavelength(const Model& model) {
  try {
    return only_wavelength(model);
  } catch (const std::invalid_argument&) {
    return 0;  // then each row must have one
  }
}

/// Whether a column says in which frame samples are, as their reader takes it: not that of matrices that are written.
bool is_frame(std::string column) {
  std::ranges::transform(column, column.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return column == "frame";
}

std::string header(const GeometrySource& source, const std::string& added) {
  const bool matrices = added.find(",f11") != std::string::npos;
  const std::vector<std::string>& columns = source.columns;
  std::string text;
  for (const std::string& column : columns) {
    const bool taken = (!column.empty() && (added + ",").find("," + column + ",") != std::string::npos) ||
                       (matrices && is_frame(column));
    const std::string name = (taken ? "input_" : "") + column;
    if (taken && std::find(columns.begin(), columns.end(), name) != columns.end()) {
      throw source.error(0, "columns " + shown_name(column) + " and " + shown_name(name) +
                                " are there already: " + shown_name(column) + " would be written again");
    }
    text += (&column == &columns.front() ? "" : ",") + name;
  }
  return text + added + "\n";
}

/// A piece of the input and what it becomes.
struct EvaluatedPiece {
  Piece piece;
  std::string out;
  RangeCount range;
};

class FileEvaluator {
 public:
  FileEvaluator(const Model& model, const RowsOfFile& what, const Evaluated& evaluated, std::istream& in,
                const std::string& name, std::function<void()> end_input)
      : evaluated_(evaluated),
        end_input_(std::move(end_input)),
        output_(what.output),
        source_(open_geometries(in, name, what.wavelength > 0 ? what.wavelength : own_wavelength(model),
                                !evaluated.binary)),
        header_(evaluated.binary ? npy_header({0, 4, 4}) : header(source_, evaluated.names)),
        unknown_(unknown_range_line(what.model, model.validity)) {
    if (what.wavelength > 0 && source_.has_wavelengths) warn("--wavelength is not used: the rows have their own");
  }

  /// The rest of the file.
  void write(std::ostream& out) {
    if (evaluated_.binary) go_to_beginning(out);  // better refused now than after all the work
    run_in_order<EvaluatedPiece>({.read = [this](EvaluatedPiece& p) { return source_.next(p.piece); },
                                  .worker = [this] { return worker(); },
                                  .write =
                                      [&](EvaluatedPiece& p) {
                                        range_.add(p.range);
                                        progress_.add(p.range.asked);
                                        put(out, p.out.insert(0, std::exchange(header_, "")));
                                        return static_cast<bool>(out);  // else write_file tells why
                                      },
                                  .end_input = end_input_},
                                 evaluated_.threads);
    put(out, header_);  // of no rows
    if (evaluated_.binary && out.flush()) {
      go_to_beginning(out);
      put(out, npy_header({static_cast<std::size_t>(range_.asked), 4, 4}));
    }
  }

  void report() const {
    end_progress();
    report_rows(range_, unknown_, evaluated_.binary ? "" : ": see column validity");
  }

 private:
  void go_to_beginning(std::ostream& out) const {
    if (!out.seekp(0)) {
      throw std::runtime_error(output_ +
                               ": a .npy file begins with the number of its rows, which cannot be written at the end");
    }
  }

  std::function<void(EvaluatedPiece&)> worker() const {
    return [this, write = evaluated_.writer()](EvaluatedPiece& p) {
      const Rows rows = source_.rows(p.piece);
      p.range = write(source_, rows, p.out);
      if (rows.error) throw *rows.error;
    };
  }

  static void put(std::ostream& out, const std::string& text) {
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    if (&out == &std::cout) flush_output();
  }

  const Evaluated& evaluated_;
  std::function<void()> end_input_;
  std::string output_;
  GeometrySource source_;
  std::string header_;
  Progress progress_;
  std::string unknown_;  // what the model does not say about its range
  RangeCount range_;
};

void evaluate_stream(const Model& model, const RowsOfFile& what, const Evaluated& evaluated, std::istream& in,
                     const std::string& name, const std::function<void()>& end_input = {}) {
  FileEvaluator evaluator(model, what, evaluated, in, name, end_input);
  write_output(what.output, [&](std::ostream& out) { evaluator.write(out); });
  evaluator.report();
}

/// Of the rows from `first` on that have its wavelength, the end.
std::size_t end_of_wavelength(const Rows& rows, std::size_t first) {
  std::size_t end = first + 1;
  while (end < rows.size() && rows.wavelengths[end] == rows.wavelengths[first]) ++end;
  return end;
}

/// Fields of rows of one wavelength. What is thrown names the first row without an answer.
std::vector<AddedFields> fields_of(const AddedColumns& columns, const GeometrySource& source, const Rows& rows,
                                   std::size_t first, std::size_t end) {
  const std::span geometries = std::span(rows.geometries).subspan(first, end - first);
  try {
    return columns.fields(rows.wavelengths[first], geometries);
  } catch (const std::invalid_argument& error) {
    if (geometries.size() == 1) throw source.error(rows.numbers[first], error.what());
  }
  std::vector<AddedFields> result;
  for (; first < end; ++first) result.push_back(fields_of(columns, source, rows, first, first + 1).front());
  return result;
}

/// Evaluates rows at once, whatever their wavelengths.
class RowsEvaluator {
 public:
  RowsEvaluator(const Model& model, Frame frame, bool normalized, bool binary)
      : validity_(model.validity),
        prepared_(prepare(model, 1)),
        frame_(frame),
        normalized_(normalized),
        binary_(binary) {}

  RangeCount write(const GeometrySource& source, const Rows& rows, std::string& out) {
    RangeCount range;
    if (rows.size() == 0) return range;
    out.reserve(rows.size() * (binary_ ? 16 * sizeof(double) : 420));
    std::size_t row = 0;
    try {
      evaluate_valid(rows);
      for (; row < matrices_.size(); ++row) {
        if (normalized_) matrices_[row] = normalized_beside_f11(matrices_[row]);
        const Outside here = outside(validity_, rows.wavelengths[row], rows.geometries[row]);
        range.add(here);
        if (!binary_) append_row(rows.text(row), matrices_[row], here, out);
      }
      if (row < rows.size()) require_wavelength(rows.wavelengths[row]);
    } catch (const std::invalid_argument& error) {
      throw source.error(rows.numbers[row], error.what());
    }
    if (binary_) append_npy(out);
    return range;
  }

 private:
  /// Up to the first wavelength that none can be: something may be wrong with a row before it.
  void evaluate_valid(const Rows& rows) {
    const std::span<const double> all = rows.wavelengths;
    const auto wrong = std::ranges::find_if(all, [](double wavelength) { return wavelength > max_wavelength; });
    const std::span<const double> valid(all.begin(), wrong);
    matrices_.resize(valid.size());
    evaluate(prepared_, std::span(rows.geometries).first(valid.size()), matrices_,
             {.frame = frame_, .wavelengths = valid});
  }

  static void append_row(std::string_view text, const Mueller& f, const Outside& outside, std::string& out) {
    out += text;
    append_elements(out, f);
    out += ',';
    out += to_string(outside);
    out += '\n';
  }

  void append_npy(std::string& out) const {
    std::size_t at = out.size();
    out.resize(at + matrices_.size() * 16 * sizeof(double));
    for (const Mueller& f : matrices_) {
      for (const double value : f.elements) {
        to_npy(value, &out[at]);
        at += sizeof(double);
      }
    }
  }

  Validity validity_;
  PreparedModel prepared_;
  std::vector<Mueller> matrices_;
  Frame frame_;
  bool normalized_, binary_;
};

}  // namespace

void RowWriter::end_row() {
  constexpr std::size_t chunk = 1 << 16;
  text_ += '\n';
  if (text_.size() > chunk) flush();
}

void RowWriter::flush() {
  out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
  text_.clear();
  if (&out_ == &std::cout) flush_output();
}

void report_rows(const RangeCount& range, const std::string& unknown_range, const std::string& where) {
  if (range.outside > 0) warn(range.line("row") + where);
  if (!unknown_range.empty()) warn(unknown_range);
}

Evaluated evaluated_rows(const Model& model, Frame frame, bool normalized, bool binary) {
  return {.names = element_columns(normalized) + ",validity", .binary = binary, .writer = [=, &model] {
            const auto evaluator = std::make_shared<RowsEvaluator>(model, frame, normalized, binary);
            return [evaluator](const GeometrySource& source, const Rows& rows, std::string& out) {
              return evaluator->write(source, rows, out);
            };
          }};
}

Evaluated with_columns(const AddedColumns& columns) {
  const auto write = [columns](const GeometrySource& source, const Rows& rows, std::string& out) {
    RangeCount range;
    for (std::size_t row = 0; row < rows.size();)
      for (const AddedFields& added : fields_of(columns, source, rows, row, end_of_wavelength(rows, row))) {
        out += rows.text(row++);
        out += added.text;
        out += '\n';
        range.add(added.outside);
      }
    return range;
  };
  return {.names = columns.names, .binary = false, .writer = [write] { return write; }};
}

void evaluate_file(const Model& model, const RowsOfFile& what, const Evaluated& evaluated) {
  if (may_wait(what.input)) {
    WaitingInput input(what.input);
    std::istream in(&input);
    return evaluate_stream(model, what, evaluated, in, what.input == "-" ? "standard input" : what.input,
                           [&input] { input.end(); });
  }
  read_input(what.input,
             [&](std::istream& in, const std::string& name) { evaluate_stream(model, what, evaluated, in, name); });
}

}  // namespace mmbrdf::program
