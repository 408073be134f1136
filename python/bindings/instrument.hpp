// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "mmbrdf/polarimetry/calibration.hpp"

namespace mmbrdf::python {

/// A calibrated instrument as Python holds it, with the name of the file it is from: its own, or that of its references.
struct Instrument : Calibration {
  Instrument(Calibration calibration, std::string its_name)
      : Calibration(std::move(calibration)), name(std::move(its_name)) {}
  std::string name;
};
using InstrumentPointer = std::shared_ptr<Instrument>;

/// (index of the film, thickness in micrometres, complex index of the substrate)
using FilmTuple = std::tuple<std::complex<double>, double, std::complex<double>>;

/// (readings, 2) in degrees. Throws std::invalid_argument for another shape, or more than most_states.
std::vector<DialAngles> dials_from(const Given& dials);

}  // namespace mmbrdf::python
