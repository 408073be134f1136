// SPDX-License-Identifier: BSD-3-Clause
// A model asked for all quantities at once.
#include "mmbrdf/quantities/answer.hpp"

#include <pybind11/stl.h>

#include <cmath>
#include <utility>

#include "question.hpp"

namespace mmbrdf::python {

namespace {

struct AnswersAt {
  PreparedAnswers answers;
  double wavelength;
};

/// Rows for each quantity, the broadcast shape behind them: value, u, low, high, and u of each part. NaN
/// for what is not known.
py::array_t<double> rows(const Question& question, const Answers& answers, std::size_t quantities, std::size_t per_one,
                         int threads) {
  std::vector<py::ssize_t> shape = question.broadcast().shape();
  shape.insert(shape.begin(), static_cast<py::ssize_t>(quantities * per_one));
  py::array_t<double> result(shape);
  double* const out = result.mutable_data();
  const std::size_t size = question.broadcast().size();
  Range range(question.object());
  without_gil([&] {
    question.each(
        threads, 16,
        [&](double wavelength) {
          return AnswersAt{answers.at(wavelength), wavelength};
        },
        [&](const AnswersAt& here, const Some& some) {
          range.count(here.wavelength, some.geometries);
          const std::vector<Answer> all = here.answers.at(some.geometries);
          for (std::size_t i = 0; i < all.size(); ++i) {
            double* to = out + some.position(i);
            for (const Answered& a : all[i].quantities) {
              std::vector<std::optional<double>> column{a.value, a.uncertainty, a.low, a.high};
              column.insert(column.end(), a.parts.begin(), a.parts.end());
              column.resize(per_one);
              for (const auto& value : column) *std::exchange(to, to + size) = value.value_or(std::nan(""));
            }
          }
        });
  });
  range.warn(size);
  return result;
}

py::dict analyze(const Question& question, const AnswerOptions& options, int threads) {
  const auto all = quantities(options.light.has_value());
  const Answers answers = without_gil([&] { return Answers(question.model(), options); });
  const std::vector<std::string> causes = answers.names_of_parts();
  const std::size_t per_one = 4 + causes.size();
  const py::object values = rows(question, answers, all.size(), per_one, threads);
  py::dict result;
  for (std::size_t q = 0; q < all.size(); ++q) {
    const auto row = [&](std::size_t which) -> py::object { return values[py::int_(per_one * q + which)]; };
    py::dict parts;
    for (std::size_t c = 0; c < causes.size(); ++c) parts[causes[c].c_str()] = row(4 + c);
    result[py::str(all[q].name)] = record("Analyzed", row(0), row(1), parts, row(2), row(3));
  }
  return result;
}

constexpr const char* analyze_doc =
    "Every derived quantity with its standard uncertainty (k = 1), and where that is from: {name: Analyzed}, with the\n"
    "names of quantities(). Arguments as those of evaluate_uncertainty().\n\n"
    "stokes   S1 ... S4 of incident light in the frame: adds what becomes of it\n"
    "frame    of stokes; quantities are those of the matrix in the frame sp\n"
    "draws    uncertainties of ratios from so many drawn models, with intervals; 0: in first order\n"
    "seed     whole number that chooses the draws\n\n"
    "nan stands where a quantity has no meaning, as a ratio where f11 is not positive, and where an uncertainty is "
    "not\n"
    "known. Raises ValueError for light that cannot exist and a covariance that is none.";

}  // namespace

void bind_answer(ModelClass& c) {
  define(
      c, "analyze",
      [](ModelObject& model, const Wavelength& w, const Given& ti, const Given& pi, const Given& tr, const Given& pr,
         const std::string& frame, bool printed, const Terms& terms, const std::optional<Stokes>& stokes, int draws,
         unsigned long seed, Threads threads) {
        return analyze({model, w, ti, pi, tr, pr, printed}, {frame_from(frame), terms_from(terms), stokes, draws, seed},
                       threads.value_or(0));
      },
      analyze_doc, py::arg("frame") = "xy", py::arg("as_printed") = false, py::arg("terms") = py::none(),
      py::arg("stokes") = py::none(), py::arg("draws") = 0, py::arg("seed") = 0, py::arg("threads") = py::none());
}

}  // namespace mmbrdf::python
