// SPDX-License-Identifier: BSD-3-Clause
// Models at many wavelengths and geometries.
#include <pybind11/stl.h>

#include <algorithm>
#include <span>

#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/text/printable.hpp"
#include "mmbrdf/uncertainty/budget.hpp"
#include "mmbrdf/uncertainty/draws.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "mmbrdf/uncertainty/reading.hpp"
#include "question.hpp"

namespace mmbrdf::python {

std::vector<TypeBTerm> terms_from(const Terms& named) {
  static const std::map<std::string, ErrorOf> known{{"scale", ErrorOf::scale},
                                                    {"theta_i_deg", ErrorOf::theta_i},
                                                    {"theta_r_deg", ErrorOf::theta_r},
                                                    {"azimuth_deg", ErrorOf::azimuth},
                                                    {"calibration", ErrorOf::calibration}};
  std::vector<TypeBTerm> terms;
  for (const auto& [name, uncertainty] : named.value_or(std::map<std::string, double>{})) {
    const auto what = known.find(name);
    if (what == known.end())
      throw std::invalid_argument("terms: " + shown_name(name) +
                                  ": expected scale, theta_i_deg, theta_r_deg, azimuth_deg or calibration");
    terms.push_back({name, what->second, name.ends_with("_deg") ? radians(uncertainty) : uncertainty});
  }
  return terms;
}

namespace {

/// The array that the caller gave for the result, or a new one.
py::array_t<double> room_for_matrices(const Question& question, const std::optional<py::array>& out) {
  if (!out) return new_array<double>(question.broadcast(), {4, 4});
  std::vector<py::ssize_t> shape = question.broadcast().shape();
  shape.insert(shape.end(), {4, 4});
  const bool fits = std::equal(shape.begin(), shape.end(), out->shape(), out->shape() + out->ndim());
  if (!fits || !py::isinstance<py::array_t<double, py::array::c_style>>(*out) || !out->writeable())
    throw std::invalid_argument("out: must be a writable array of float64 in C order, of the shape of the result");
  const py::object shares = py::module_::import("numpy").attr("may_share_memory");
  for (std::size_t a = 0; a < 5; ++a)
    if (shares(*out, question.broadcast().array(a)).cast<bool>())
      throw std::invalid_argument("out: shares memory with an argument");
  return py::array_t<double>(*out);
}

py::object evaluate(const Question& question, Frame frame, int threads, const std::optional<py::array>& given) {
  auto result = room_for_matrices(question, given);
  auto* const out = reinterpret_cast<Mueller*>(result.mutable_data());  // sixteen doubles each
  Range range(question.object());
  const auto at_one_wavelength = [&](const PreparedModel& model, const Some& some) {
    range.count(model.wavelength(), some.geometries);
    model.evaluate(some.geometries, frame, {out + some.begin, some.geometries.size()});
  };
  const auto at_each = [&](const PreparedModel& model, std::span<const double> wavelengths,
                           std::span<const Geometry> geometries, std::size_t begin) {
    range.count(wavelengths, geometries);
    mmbrdf::evaluate(model, geometries, {out + begin, geometries.size()}, {.frame = frame, .wavelengths = wavelengths});
  };
  without_gil([&] {
    if (question.has_one_wavelength())
      question.each(
          threads, 2048, [&](double wavelength) { return question.prepared(wavelength); }, at_one_wavelength);
    else
      question.each_row(threads, 2048, at_each);
  });
  range.warn(question.broadcast().size());
  return result;
}

/// Uncertainties of a model with terms of type B.
struct PreparedBudget {
  PreparedUncertainty uncertainty;
  PreparedModel model;
  const std::vector<TypeBTerm>& terms;

  MuellerCovariance total(const Geometry& geometry, Frame frame) const {
    return budget(model, uncertainty, terms, geometry, frame).total;
  }
  void evaluate(std::span<const Geometry> geometries, Frame frame, std::span<MuellerCovariance> out) const {
    if (terms.empty()) return uncertainty.evaluate(geometries, frame, out);
    std::ranges::transform(geometries, out.begin(), [&](const Geometry& g) { return total(g, frame); });
  }
  void evaluate(std::span<const Geometry> geometries, Frame frame, std::span<Mueller> out) const {
    if (terms.empty()) return uncertainty.standard_uncertainty(geometries, frame, out);
    std::ranges::transform(geometries, out.begin(),
                           [&](const Geometry& g) { return standard_uncertainty(total(g, frame)); });
  }
};

/// Result, which is numbers alone, at each position.
template <class Result>
py::object uncertainties(const Question& question, Frame frame, const std::vector<TypeBTerm>& terms, int threads,
                         std::vector<py::ssize_t> core) {
  auto result = new_array<double>(question.broadcast(), core);
  auto* const out = reinterpret_cast<Result*>(result.mutable_data());
  Range range(question.object());
  without_gil([&] {
    question.each(
        threads, 64,
        [&](double wavelength) {
          return PreparedBudget{prepare_uncertainty(question.model(), wavelength), question.prepared(wavelength),
                                terms};
        },
        [&](const PreparedBudget& p, const Some& some) {
          range.count(p.model.wavelength(), some.geometries);
          const std::size_t count = some.geometries.size();
          if (!some.positions) return p.evaluate(some.geometries, frame, std::span(out + some.begin, count));
          std::vector<Result> here(count);
          p.evaluate(some.geometries, frame, here);
          for (std::size_t i = 0; i < count; ++i) out[some.position(i)] = here[i];
        });
  });
  range.warn(question.broadcast().size());
  return result;
}

py::object evaluate_uncertainty(const Question& question, Frame frame, const std::vector<TypeBTerm>& terms,
                                int threads) {
  return uncertainties<Mueller>(question, frame, terms, threads, {4, 4});
}

py::object covariance(const Question& question, Frame frame, const std::vector<TypeBTerm>& terms, int threads) {
  return uncertainties<MuellerCovariance>(question, frame, terms, threads, {16, 16});
}

py::object outside_of(const Question& question) {
  auto result = new_array<std::uint8_t>(question.broadcast(), {});
  auto* const out = result.mutable_data();
  without_gil([&] {
    question.each(
        1, 1, [&](double wavelength) { return wavelength; },
        [&](double wavelength, const Some& some) {
          for (std::size_t i = 0; i < some.geometries.size(); ++i) {
            require_valid(some.geometries[i]);
            out[some.position(i)] =
                static_cast<std::uint8_t>(outside(question.model().validity, wavelength, some.geometries[i]));
          }
        });
  });
  return unwrapped(result);
}

py::object estimable(const Question& question, int threads) {
  auto result = new_array<bool>(question.broadcast(), {});
  auto* const out = result.mutable_data();
  without_gil([&] {
    question.each(
        threads, 64,
        [&](double wavelength) { return std::pair(prepare_uncertainty(question.model(), wavelength), wavelength); },
        [&](const auto& at, const Some& some) {
          const auto& [u, wavelength] = at;
          for (std::size_t i = 0; i < some.geometries.size(); ++i)
            out[some.position(i)] =
                u.estimable(some.geometries[i]) &&
                !leaves_known_range(outside(question.model().validity, wavelength, some.geometries[i]));
        });
  });
  return unwrapped(result);
}

py::object evaluate_draws(const Question& question, Frame frame, int count, unsigned long seed, int threads) {
  const Draws draws = without_gil([&] { return Draws(question.model(), count, seed); });  // refuses a count
  std::vector<py::ssize_t> shape = question.broadcast().shape();
  shape.insert(shape.begin(), count);
  shape.insert(shape.end(), {4, 4});
  py::array_t<double> result(shape);
  auto* const out = reinterpret_cast<Mueller*>(result.mutable_data());
  const std::size_t size = question.broadcast().size();
  Range range(question.object());
  without_gil([&] {
    question.each(
        threads, 16, [&](double wavelength) { return draws.at(wavelength); },
        [&](const std::vector<PreparedModel>& models, const Some& some) {
          range.count(models.front().wavelength(), some.geometries);
          std::vector<Mueller> here(some.geometries.size());
          for (std::size_t d = 0; d < models.size(); ++d) {
            models[d].evaluate(some.geometries, frame, here);
            for (std::size_t i = 0; i < here.size(); ++i) out[d * size + some.position(i)] = here[i];
          }
        });
  });
  range.warn(size);
  return result;
}

/// Readings of the sample, and their uncertainties, behind each other at each position.
py::object predicted_readings(const Question& question, bool at_its_azimuth, int threads) {
  auto result = new_array<double>(question.broadcast(), {2, 4, 4});
  auto* const out = reinterpret_cast<Mueller*>(result.mutable_data());
  Range range(question.object());
  without_gil([&] {
    question.each(
        threads, 16,
        [&](double wavelength) { return std::pair(predict_readings(question.model(), wavelength), wavelength); },
        [&](const auto& at, const Some& some) {
          const auto& [prediction, wavelength] = at;
          range.count(wavelength, some.geometries);
          for (std::size_t i = 0; i < some.geometries.size(); ++i) {
            const Geometry& g = some.geometries[i];
            const PredictedReading one = at_its_azimuth ? prediction.at_its_azimuth(g) : prediction.at_some_azimuth(g);
            out[2 * some.position(i)] = one.value;
            out[2 * some.position(i) + 1] = one.uncertainty;
          }
        });
  });
  range.warn(question.broadcast().size());
  const auto part = [&](int which) -> py::object {
    return result[py::make_tuple(py::ellipsis(), which, py::slice(0, 4, 1), py::slice(0, 4, 1))];
  };
  return record("Evaluation", part(0), part(1), outside_of(question));
}

constexpr const char* evaluate_doc =
    "The Mueller BRDF in sr^-1: array (..., 4, 4), row = outgoing, column = incoming Stokes component.\n\n"
    "wavelength_nm and the four angles are numbers or arrays, broadcast against each other; the shape before (4, 4) "
    "is\ntheirs. Directions point away from the sample, to the source (i) and to the detector (r); azimuths are "
    "counted\n"
    "from x towards y, so forward scattering is phi_r - phi_i = 180, and a negative polar angle means the opposite\n"
    "azimuth. wavelength_nm may be None for a model of one wavelength.\n\n"
    "frame    'xy', 'sp' or 'scattering_plane': the axes of the Stokes components\n"
    "as_printed  published coefficients: the sum at the azimuths given, to compare only; a model that was fitted\n"
    "           so (Model.as_printed) is always evaluated so\n"
    "threads  how many at most; None or 0: as many as there are cores\n"
    "out        an array of float64 in C order for the result, which is then not allocated anew; after\n"
    "           an error a part of it may be written\n\n"
    "Warns (ExtrapolationWarning) of geometries outside the fitted range. Raises ValueError for angles outside\n"
    "[-90, 90] degrees, shapes that do not broadcast, and a wavelength that is missing or not positive.";

constexpr const char* uncertainty_doc =
    "Standard uncertainties (k = 1) of what evaluate() gives, in sr^-1: array (..., 4, 4). Arguments as there.\n\n"
    "They are those of the fit, and of the terms of type B: {'scale': 0.003} is 0.3 %, the same error in all data;\n"
    "'theta_i_deg', 'theta_r_deg' and 'azimuth_deg' are errors of angles, 'calibration' those of the 15 normalised\n"
    "elements. Raises ValueError for a model whose covariance is not known.";

constexpr const char* covariance_doc =
    "Covariances of the sixteen elements in row-major order, in sr^-2: array (..., 16, 16). Arguments as those of\n"
    "evaluate_uncertainty(), whose squares are the diagonal.";

constexpr const char* outside_doc =
    "Which of the fitted ranges each question leaves: array of uint8, 0 inside, else a sum of Outside. Arguments as\n"
    "those of evaluate().";

constexpr const char* estimable_doc =
    "Whether the data of the fit determine every element there: array of bool. Where they do not, uncertainties are\n"
    "too small. Nothing outside of the fitted range is estimable. Arguments as those of evaluate().";

constexpr const char* readings_doc =
    "What a reading of the sample will be, which is less certain than the mean that evaluate() gives, as Evaluation:\n"
    "(..., 4, 4), element 11 is f11 in sr^-1, the others are divided by it, in the xy frame. Its noise, and that the\n"
    "sample stands at an azimuth that nobody knows, are in u. Other arguments as those of evaluate().\n\n"
    "at_its_azimuth  with the sample as it stood in the readings of the fit: its anisotropy is in the value\n\n"
    "Raises ValueError for a model of a fit with uncertainty='noise', a wavelength that was not fitted, and 90 "
    "degrees.";

constexpr const char* draws_doc =
    "What `count` models drawn from the covariance of the fit give (GUM Supplement 1), in sr^-1: array\n"
    "(count, ..., 4, 4). Other arguments as those of evaluate(). The same seed gives the same draws.";

void bind_rest(ModelClass& c) {
  const py::arg_v frame = py::arg("frame") = "xy", as_printed = py::arg("as_printed") = false,
                  threads = py::arg("threads") = py::none();
  define(
      c, "outside",
      [](ModelObject& model, const Wavelength& w, const Given& ti, const Given& pi, const Given& tr, const Given& pr) {
        return outside_of({model, w, ti, pi, tr, pr, false});
      },
      outside_doc);
  define(
      c, "estimable",
      [](ModelObject& model, const Wavelength& w, const Given& ti, const Given& pi, const Given& tr, const Given& pr,
         bool printed, Threads count) {
        return estimable({model, w, ti, pi, tr, pr, printed}, count.value_or(0));
      },
      estimable_doc, as_printed, threads);
  define(
      c, "predict_readings",
      [](ModelObject& model, const Wavelength& w, const Given& ti, const Given& pi, const Given& tr, const Given& pr,
         bool at_its_azimuth, Threads count) {
        return predicted_readings({model, w, ti, pi, tr, pr, false}, at_its_azimuth, count.value_or(0));
      },
      readings_doc, py::arg("at_its_azimuth") = false, threads);
  c.def(
      "evaluate_draws",
      [](ModelObject& model, int count, unsigned long seed, const Wavelength& w, const Given& ti, const Given& pi,
         const Given& tr, const Given& pr, const std::string& name, bool printed, Threads most) {
        return evaluate_draws({model, w, ti, pi, tr, pr, printed}, frame_from(name), count, seed, most.value_or(0));
      },
      py::arg("count"), py::arg("seed"), py::arg("wavelength_nm") = py::none(), py::arg("theta_i_deg"),
      py::arg("phi_i_deg"), py::arg("theta_r_deg"), py::arg("phi_r_deg"), py::kw_only(), frame, as_printed, threads,
      draws_doc);
}

}  // namespace

void bind_evaluation(ModelClass& c) {
  const py::arg_v frame = py::arg("frame") = "xy", as_printed = py::arg("as_printed") = false,
                  threads = py::arg("threads") = py::none(), terms = py::arg("terms") = py::none();
  define(
      c, "evaluate",
      [](ModelObject& model, const Wavelength& w, const Given& ti, const Given& pi, const Given& tr, const Given& pr,
         const std::string& name, bool printed, Threads count, const std::optional<py::array>& out) {
        return evaluate({model, w, ti, pi, tr, pr, printed}, frame_from(name), count.value_or(0), out);
      },
      evaluate_doc, frame, as_printed, threads, py::arg("out") = py::none());
  define(
      c, "evaluate_uncertainty",
      [](ModelObject& model, const Wavelength& w, const Given& ti, const Given& pi, const Given& tr, const Given& pr,
         const std::string& name, bool printed, const Terms& named, Threads count) {
        return evaluate_uncertainty({model, w, ti, pi, tr, pr, printed}, frame_from(name), terms_from(named),
                                    count.value_or(0));
      },
      uncertainty_doc, frame, as_printed, terms, threads);
  define(
      c, "covariance",
      [](ModelObject& model, const Wavelength& w, const Given& ti, const Given& pi, const Given& tr, const Given& pr,
         const std::string& name, bool printed, const Terms& named, Threads count) {
        return covariance({model, w, ti, pi, tr, pr, printed}, frame_from(name), terms_from(named), count.value_or(0));
      },
      covariance_doc, frame, as_printed, terms, threads);
  bind_rest(c);
}

}  // namespace mmbrdf::python
