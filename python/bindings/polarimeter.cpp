// SPDX-License-Identifier: BSD-3-Clause
// Polarimeters: states, calibration, reduction, and a simulated goniometer.
#include "mmbrdf/polarimetry/polarimeter.hpp"

#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>

#include "instrument.hpp"
#include "matrices.hpp"
#include "mmbrdf/polarimetry/reduction.hpp"
#include "mmbrdf/polarimetry/rotating_retarders.hpp"
#include "mmbrdf/polarization/elements.hpp"

namespace mmbrdf::python {

namespace {

std::vector<Stokes> states_from(const Given& states, const char* name) {
  const Broadcast broadcast({{name, states, {4}}});
  if (broadcast.shape().size() != 1) throw std::invalid_argument(std::string(name) + ": expected an array (states, 4)");
  std::vector<Stokes> result;
  for (std::size_t i = 0; i < broadcast.size(); ++i) result.push_back(broadcast.at<4>(0, i));
  return result;
}

py::array_t<double> array_of(const std::vector<Stokes>& states) {
  py::array_t<double> result({static_cast<py::ssize_t>(states.size()), py::ssize_t{4}});
  for (std::size_t i = 0; i < states.size(); ++i)
    std::copy(states[i].begin(), states[i].end(), result.mutable_data() + 4 * i);
  return result;
}

/// The last axes of readings: (analyzer states, generator states), or (pairs).
std::vector<py::ssize_t> shape_of(const Polarimeter& p) {
  if (!p.pairs.empty()) return {static_cast<py::ssize_t>(p.pairs.size())};
  return {static_cast<py::ssize_t>(p.analyzer.size()), static_cast<py::ssize_t>(p.generator.size())};
}

Operand readings_operand(const Polarimeter& p, const Given& readings, const char* name) {
  return {name, readings, shape_of(p)};
}

std::vector<StatePair> pairs_from(const Given& pairs) {
  std::vector<StatePair> result;
  if (pairs.is_none()) return result;
  const Broadcast broadcast({{"pairs", pairs, {2}}});
  if (broadcast.shape().size() != 1 || broadcast.size() == 0)
    throw std::invalid_argument("pairs: expected an array (readings, 2)");
  for (std::size_t i = 0; i < broadcast.size(); ++i) {
    const auto [generator, analyzer] = broadcast.at<2>(0, i);
    if (!(generator >= 0 && analyzer >= 0 && generator < most_states && analyzer < most_states) ||
        generator != std::floor(generator) || analyzer != std::floor(analyzer))
      throw std::invalid_argument("pairs: places of states are whole numbers from 0");
    result.push_back({static_cast<std::size_t>(generator), static_cast<std::size_t>(analyzer)});
  }
  return result;
}

py::object pairs_of(const Polarimeter& p) {
  if (p.pairs.empty()) return py::none();
  py::array_t<std::int64_t> result({static_cast<py::ssize_t>(p.pairs.size()), py::ssize_t{2}});
  for (std::size_t j = 0; j < p.pairs.size(); ++j) {
    result.mutable_data()[2 * j] = static_cast<std::int64_t>(p.pairs[j].generator);
    result.mutable_data()[2 * j + 1] = static_cast<std::int64_t>(p.pairs[j].analyzer);
  }
  return result;
}

py::array_t<bool> determined(const Polarimeter& p) {
  const Reduction reduction(p);
  py::array_t<bool> result({py::ssize_t{4}, py::ssize_t{4}});
  for (std::size_t e = 0; e < 16; ++e) result.mutable_data()[e] = !reduction.undetermined()[e];
  return result;
}

/// `pixels` of Number at any strides, whose readings are the last axes.
template <class Number>
class Pixels {
 public:
  Pixels(const py::array& array, std::size_t core) : data_(static_cast<const char*>(array.data())) {
    const auto axes = static_cast<std::size_t>(array.ndim());
    for (std::size_t d = 0; d < axes; ++d) {
      const auto axis = static_cast<py::ssize_t>(d);
      (d < axes - core ? outer_ : core_).push_back({array.shape(axis), array.strides(axis)});
    }
    adjacent_ =
        (array.flags() & py::array::c_style) != 0 && reinterpret_cast<std::uintptr_t>(data_) % alignof(Number) == 0;
  }

  /// Where they all stand one behind the other; null if they do not.
  const Number* adjacent() const { return adjacent_ ? reinterpret_cast<const Number*>(data_) : nullptr; }

  void gather(std::size_t begin, std::size_t end, Number* out) const {
    for (; begin < end; ++begin) {
      const char* from = data_;
      std::size_t rest = begin;
      for (std::size_t d = outer_.size(); d-- > 0;) {
        const auto length = static_cast<std::size_t>(outer_[d].length);
        from += static_cast<py::ssize_t>(rest % length) * outer_[d].stride;
        rest /= length;
      }
      const Axis columns = core_.back(), rows = core_.size() > 1 ? core_.front() : Axis{1, 0};
      for (py::ssize_t a = 0; a < rows.length; ++a)
        for (py::ssize_t b = 0; b < columns.length; ++b, ++out)
          std::memcpy(out, from + a * rows.stride + b * columns.stride, sizeof *out);
    }
  }

 private:
  struct Axis {
    py::ssize_t length, stride;
  };
  const char* data_;
  std::vector<Axis> outer_, core_;
  bool adjacent_;
};

template <class Number>
py::object reduced(const Polarimeter& p, const Broadcast& broadcast, const py::array& array, Refused refused) {
  const Reduction reduction(p);
  const std::size_t n = p.readings();
  const Pixels<Number> pixels(array, shape_of(p).size());
  auto result = new_array<Number>(broadcast, {4, 4});
  Number* const out = result.mutable_data();
  std::atomic<std::size_t> count = 0;
  const auto reduce = [&](const Number* from, std::size_t begin, std::size_t end) {
    count += reduction.muellers(std::span(from, n * (end - begin)), std::span(out + 16 * begin, 16 * (end - begin)),
                                {.refused = Refused::nan});
  };
  without_gil([&] {
    in_parts(broadcast.size(), 0, 8192, [&](std::size_t begin, std::size_t end) {
      if (const Number* const all = pixels.adjacent()) return reduce(all + n * begin, begin, end);
      constexpr std::size_t block = 256;
      std::vector<Number> some(n * block);
      for (std::size_t first = begin; first < end; first += block) {
        const std::size_t last = std::min(first + block, end);
        pixels.gather(first, last, some.data());
        reduce(some.data(), first, last);
      }
    });
    std::vector<Number> one(n);
    for (std::size_t i = 0; count > 0 && refused == Refused::error && i < broadcast.size(); ++i) {
      pixels.gather(i, i + 1, one.data());
      if (std::ranges::all_of(one, [](Number reading) { return std::isfinite(reading); })) continue;
      const std::string others = count == 1 ? "" : "; " + std::to_string(count) + " pixels have no answer";
      throw std::invalid_argument(broadcast.at_place(std::invalid_argument("a reading is not finite"), i).what() +
                                  others);
    }
  });
  return result;
}

py::object reduced_as_given(const Polarimeter& p, const Given& readings, const std::string& invalid) {
  const Refused refused = refused_from(invalid);
  const py::module_ numpy = py::module_::import("numpy");
  if (py::hasattr(readings, "dtype") && py::dtype::of<float>().equal(readings.attr("dtype")) &&
      !numpy.attr("ma").attr("is_masked")(readings).cast<bool>()) {
    const py::array array = numpy.attr("asarray")(readings);
    const Given shape_alone = numpy.attr("broadcast_to")(0.0, array.attr("shape"));  // one number, without strides
    return reduced<float>(p, Broadcast({readings_operand(p, shape_alone, "readings")}), array, refused);
  }
  const Broadcast broadcast({readings_operand(p, readings, "readings")});
  return reduced<double>(p, broadcast, broadcast.array(0), refused);
}

py::object reduced_covariance(const Polarimeter& p, const Given& variances) {
  const Reduction reduction(p);
  const Broadcast broadcast({readings_operand(p, variances, "variances")});
  auto result = new_array<double>(broadcast, {16, 16});
  for (std::size_t i = 0; i < broadcast.size(); ++i) {
    std::vector<double> all(p.readings());
    broadcast.gather(0, i, i + 1, all.data());
    const MuellerCovariance covariance = reduction.from_readings(all);
    std::copy(covariance.values.begin(), covariance.values.end(), result.mutable_data() + 256 * i);
  }
  return result;
}

py::object readings_of(const Polarimeter& p, const Given& mueller) {
  const Broadcast broadcast({{"mueller", mueller, {4, 4}}});
  auto result = new_array<double>(broadcast, shape_of(p));
  for (std::size_t i = 0; i < broadcast.size(); ++i) {
    const std::vector<double> all = readings(p, broadcast.mueller(0, i));
    std::copy(all.begin(), all.end(), result.mutable_data() + all.size() * i);
  }
  return result;
}

void bind_states(py::module_& m) {
  m.def(
      "condition_number", [](const Given& states) { return condition_number(states_from(states, "states")); },
      py::arg("states"), "Of states (n, 4): 3^0.5 at best, inf for fewer than four independent ones.");
  m.def(
      "optimal_angles",
      [](double retardance, int states) {
        std::vector<double> angles = optimal_angles(radians(retardance), states);
        for (double& angle : angles) angle = degrees(angle);
        return py::array_t<double>(static_cast<py::ssize_t>(angles.size()), angles.data());
      },
      py::arg("retardance_deg"), py::arg("states"),
      "Azimuths in degrees of a retarder behind a polarizer that make the condition number smallest: (states,).");
}

Polarimeter ideal_states(const std::vector<std::string>& generator,
                         const std::optional<std::vector<std::string>>& analyzer) {
  return ideal_polarimeter(generator, analyzer ? *analyzer : generator);
}

void bind_instrument(py::module_& m) {
  py::class_<Polarimeter>(m, "Polarimeter",
                          "What states a polarimeter makes (generator (n, 4)) and responds to (analyzer (n, 4)). A "
                          "reading is\nanalyzer @ M @ generator, for each of the pairs (readings, 2) of places of "
                          "states, or all.")
      .def(
          py::init([](const Given& generator, const Given& analyzer, const Given& pairs) {
            return reading({states_from(generator, "generator"), states_from(analyzer, "analyzer")}, pairs_from(pairs));
          }),
          py::arg("generator"), py::arg("analyzer"), py::arg("pairs") = py::none())
      .def_property_readonly(
          "generator", [](const Polarimeter& p) { return array_of(p.generator); }, "(n, 4)")
      .def_property_readonly(
          "analyzer", [](const Polarimeter& p) { return array_of(p.analyzer); }, "(n, 4)")
      .def_property_readonly("pairs", pairs_of,
                             "(readings, 2): places of the generator and the analyzer state of each reading, from 0. "
                             "None: all pairs")
      .def_property_readonly("determined", determined, "(4, 4) truth values: the elements that the readings determine")
      .def_property_readonly(
          "rank", [](const Polarimeter& p) { return Reduction(p).rank(); },
          "How many independent combinations of the sixteen elements the readings determine")
      .def_property_readonly(
          "condition", [](const Polarimeter& p) { return Reduction(p).condition(); },
          "Ratio of the largest singular value to the smallest of these: 3 at best")
      .def("readings", readings_of, py::arg("mueller"),
           "Of matrices (..., 4, 4): array (..., analyzer states, generator states), or (..., pairs)")
      .def("reduce", reduced_as_given, py::arg("readings"), py::arg("invalid") = "raise",
           "Matrices (..., 4, 4) that readings (..., analyzer states, generator states), or (..., pairs), stand for, "
           "by\n"
           "least squares, in the frame scattering_plane. Readings are dark-subtracted and divided by monitor and "
           "gain.\n"
           "NaN: the readings do not determine that element. An array of float32, in the bytes' order of the "
           "machine, gives\n"
           "one of float32, of the same numbers rounded. invalid='nan' makes NaN of matrices with a reading that is "
           "not finite, instead of an error.")
      .def("covariance", reduced_covariance, py::arg("variances"),
           "Of the sixteen elements, from independent readings with these variances: array (..., 16, 16), NaN as "
           "reduce()")
      .def(py::pickle(
          [](const Polarimeter& p) { return py::make_tuple(array_of(p.generator), array_of(p.analyzer), pairs_of(p)); },
          [](const py::tuple& t) {
            return reading({states_from(t[0], "generator"), states_from(t[1], "analyzer")}, pairs_from(t[2]));
          }))
      .def("__repr__", [](const Polarimeter& p) {
        return "<mmbrdf.Polarimeter: " + std::to_string(p.generator.size()) + " generator states, " +
               std::to_string(p.analyzer.size()) + " analyzer states" +
               (p.pairs.empty() ? "" : ", " + std::to_string(p.pairs.size()) + " pairs") + ">";
      });
  m.def(
      "ideal_polarimeter",
      [](double retardance, const Given& azimuths) {
        std::vector<double> angles = numbers("azimuths_deg", azimuths);
        for (double& angle : angles) angle *= radians(1);
        return ideal_polarimeter(radians(retardance), angles);
      },
      py::arg("retardance_deg"), py::arg("azimuths_deg"),
      "A polarizer and behind it a retarder at each of these azimuths; the analyzer mirrors it.");
  m.def("ideal_states", ideal_states, py::arg("generator"), py::arg("analyzer") = py::none(),
        "A Polarimeter of fully polarized states by their names: s, p, +45 (from s towards p), -45, L, R, or u, which "
        "is\n"
        "not polarized. The analyzer has those of the generator if none are given.");
}

py::array_t<double> array_of(const std::vector<DialAngles>& dials) {
  py::array_t<double> result({static_cast<py::ssize_t>(dials.size()), py::ssize_t{2}});
  for (std::size_t j = 0; j < dials.size(); ++j) {
    result.mutable_data()[2 * j] = degrees(dials[j].generator);
    result.mutable_data()[2 * j + 1] = degrees(dials[j].analyzer);
  }
  return result;
}

/// One number for both arms, or one for each.
std::array<double, 2> both(const char* name, const Given& given) {
  const std::vector<double> values = numbers(name, given);
  if (values.empty() || values.size() > 2)
    throw std::invalid_argument(std::string(name) + ": expected a number, or one for each arm");
  return {values.front(), values.back()};
}

Polarimeter rotating(const Given& dials, const Given& retardance, const Given& offset, const Given& polarizer,
                     const Given& diattenuation, double extinction) {
  const auto retardances = both("retardance_deg", retardance), offsets = both("offset_deg", offset);
  const auto polarizers = both("polarizer_deg", polarizer), diattenuations = both("diattenuation", diattenuation);
  const auto arm = [&](std::size_t k) {
    return RetarderArm{radians(retardances[k]), radians(offsets[k]), radians(polarizers[k]), diattenuations[k]};
  };
  return polarimeter({arm(0), arm(1), extinction, 1}, dials_from(dials));
}

void bind_retarders(py::module_& m) {
  m.def(
      "dial_angles",
      [](double ratio, double step, std::size_t frames) { return array_of(dial_angles(ratio, radians(step), frames)); },
      py::arg("ratio"), py::arg("step_deg"), py::arg("frames"),
      "Of two turning retarders (frames, 2), in degrees: the generator's does step_deg each frame, the analyzer's "
      "ratio\n"
      "times that.");
  m.def("rotating_retarders", rotating, py::arg("dials_deg"), py::kw_only(), py::arg("retardance_deg") = 90.0,
        py::arg("offset_deg") = 0.0, py::arg("polarizer_deg") = 0.0, py::arg("diattenuation") = 0.0,
        py::arg("extinction") = 0.0,
        "A Polarimeter of two turning retarders, each behind or before a polarizer, read at these dial angles\n"
        "(readings, 2). Each number is that of both arms, or a pair; offset is the azimuth of a fast axis at dial 0.");
}

}  // namespace

std::vector<DialAngles> dials_from(const Given& dials) {
  const Broadcast broadcast({{"dials_deg", dials, {2}}});
  if (broadcast.shape().size() != 1 || broadcast.size() == 0 || broadcast.size() > most_states)
    throw std::invalid_argument("dials_deg: expected an array (readings, 2) of at most " + std::to_string(most_states) +
                                " readings");
  std::vector<DialAngles> result;
  for (std::size_t i = 0; i < broadcast.size(); ++i) {
    const auto [generator, analyzer] = broadcast.at<2>(0, i);
    result.push_back({radians(generator), radians(analyzer)});
  }
  return result;
}

void bind_polarimeter(py::module_& m) {
  bind_states(m);
  bind_instrument(m);
  bind_retarders(m);
}

}  // namespace mmbrdf::python
