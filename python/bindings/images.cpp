// SPDX-License-Identifier: BSD-3-Clause
// Cameras: a polarimeter in each pixel. mmbrdf.images says what arrays mean; here they are flat.
#include "mmbrdf/polarimetry/images.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "instrument.hpp"
#include "mmbrdf/polarimetry/judgement.hpp"

namespace mmbrdf::python {

namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

template <class T, int flags>
std::span<const T> all(const py::array_t<T, flags>& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

py::array_t<double> array_of(const std::vector<double>& numbers, std::size_t pixels, std::size_t states) {
  if (states == 0) {
    const std::size_t each = pixels == 0 ? 0 : numbers.size() / pixels;
    return py::array_t<double>({static_cast<py::ssize_t>(pixels), static_cast<py::ssize_t>(each)}, numbers.data());
  }
  return py::array_t<double>({static_cast<py::ssize_t>(pixels), static_cast<py::ssize_t>(states), py::ssize_t{4}},
                             numbers.data());
}

Floats reduced(const PixelInverses& inverses, const Floats& readings, std::size_t first, int threads) {
  const std::size_t pixels = static_cast<std::size_t>(readings.size()) / std::max<std::size_t>(1, inverses.readings);
  Floats result({static_cast<py::ssize_t>(pixels), py::ssize_t{4}, py::ssize_t{4}});
  const std::span<float> out(result.mutable_data(), 16 * pixels);
  without_gil([&] { muellers(inverses, all(readings), out, threads, first); });
  return result;
}

/// (kind, angle in degrees, s exceeds p, sign of delta) and so on.
using GivenReference = std::tuple<std::string, double, int, int>;

struct Cameras {
  std::vector<Reference> references;
  CalibrationOptions options;
};

Cameras cameras_from(const std::vector<GivenReference>& given, std::size_t generators, std::size_t analyzers,
                     double wavelength_nm, const std::tuple<double, double, double>& noise, int dial_sense,
                     bool fit_phase, const Given& dials, double retardance, const std::optional<double>& polarizer_near,
                     bool fit_extinction, bool fit_diattenuation, bool fit_drift) {
  Cameras result;
  for (const auto& [kind, angle, s_exceeds_p, sign] : given)
    result.references.push_back({reference_kind_from(kind), radians(angle), {}, s_exceeds_p, sign});
  CalibrationOptions& o = result.options;
  o.generator_states = generators;
  o.analyzer_states = analyzers;
  o.wavelength = micrometres(wavelength_nm);
  o.noise = {std::get<0>(noise), std::get<1>(noise), std::get<2>(noise)};
  o.dial_sense = dial_sense;
  o.fit_polarizer_phase = fit_phase;
  if (polarizer_near) o.polarizer_near = radians(*polarizer_near);
  if (dials.is_none()) return result;
  o.retarders.emplace();
  o.retarders->dials = dials_from(dials);
  o.retarders->fit_extinction = fit_extinction;
  o.retarders->fit_diattenuation = fit_diattenuation;
  o.retarders->fit_drift = fit_drift;
  o.retarders->nominal.generator.retardance = o.retarders->nominal.analyzer.retardance = radians(retardance);
  return result;
}

InstrumentPointer shared_start(const Cameras& cameras, const Numbers& mean) {
  Cameras with = cameras;
  if (mean.ndim() != 2 || static_cast<std::size_t>(mean.shape(0)) != cameras.references.size())
    throw std::invalid_argument("mean readings: expected an array (references, readings)");
  for (std::size_t i = 0; i < with.references.size(); ++i) {
    const double* const row = mean.data() + static_cast<py::ssize_t>(i) * mean.shape(1);
    with.references[i].readings.assign(row, row + mean.shape(1));
  }
  return without_gil(
      [&] { return std::make_shared<Instrument>(calibrate(with.references, with.options), "median of the image"); });
}

py::dict calibrated(const Cameras& cameras, const InstrumentPointer& start, const Floats& readings, int threads,
                    double most_misfit) {
  const PixelCalibrations found = without_gil([&] {
    return calibrate_pixels(*start, cameras.references, all(readings), cameras.options, {threads, most_misfit});
  });
  const std::size_t pixels = found.failures.size(), p = start->polarimeter.generator.size(),
                    q = start->polarimeter.analyzer.size();
  py::dict result;
  result["generator"] = array_of(found.generators, pixels, p);
  result["analyzer"] = array_of(found.analyzers, pixels, q);
  if (found.retarders.empty()) {
    result["u_generator"] = array_of(found.generator_uncertainties, pixels, p);
    result["u_analyzer"] = array_of(found.analyzer_uncertainties, pixels, q);
  } else {
    result["retarders"] = array_of(found.retarders, pixels, 0);
    result["u_retarders"] = array_of(found.retarder_uncertainties, pixels, 0);
  }
  result["misfit"] = py::array_t<double>(static_cast<py::ssize_t>(pixels), found.misfit.data());
  py::array_t<std::uint8_t> failure(static_cast<py::ssize_t>(pixels));
  std::ranges::transform(found.failures, failure.mutable_data(),
                         [](PixelFailure f) { return static_cast<std::uint8_t>(f); });
  result["failure"] = failure;
  return result;
}

}  // namespace

void bind_images(py::module_& m) {
  py::class_<PixelInverses>(m, "_PixelInverses")
      .def(py::init([](const Numbers& generators, const Numbers& analyzers, const Polarimeter& like, int threads) {
             return without_gil([&] { return pixel_inverses(all(generators), all(analyzers), like, threads); });
           }),
           py::arg("generators"), py::arg("analyzers"), py::arg("like"), py::arg("threads") = 0)
      .def_property_readonly("pixels", &PixelInverses::pixels)
      .def("reduce", reduced, py::arg("readings"), py::arg("first") = 0, py::arg("threads") = 0);
  py::class_<Cameras>(m, "_Cameras")
      .def(py::init(&cameras_from), py::arg("references"), py::arg("generators"), py::arg("analyzers"),
           py::arg("wavelength_nm"), py::arg("noise"), py::arg("dial_sense"), py::arg("fit_polarizer_phase"),
           py::arg("dials_deg"), py::arg("retardance_deg"), py::arg("polarizer_near_deg"), py::arg("fit_extinction"),
           py::arg("fit_diattenuation"), py::arg("fit_drift"))
      .def("start", shared_start, py::arg("mean"))
      .def("calibrate", calibrated, py::arg("start"), py::arg("readings"), py::arg("threads"), py::arg("most_misfit"));
}

}  // namespace mmbrdf::python
