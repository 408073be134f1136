// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf::python {

/// Samples as Python holds them: they never change, so arrays may show their memory.
struct Dataset : std::enable_shared_from_this<Dataset> {
  explicit Dataset(std::vector<Sample> its_samples) : samples(std::move(its_samples)) {}
  std::vector<Sample> samples;
  std::string read_as = {};    ///< what of the table was not as in the project's own
  std::string reduction = {};  ///< from which readings they were made, and how, if that is known
};
using DatasetPointer = std::shared_ptr<Dataset>;

/// The Python object Dataset of these samples.
py::object dataset_object(std::vector<Sample> samples, const std::string& reduction = "");

/// From four arrays that broadcast: theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg.
std::vector<Geometry> geometries_from(const py::sequence& angles);

/// Directions in degrees: the Python object Geometry of numbers, and of arrays.
py::object geometry_object(const Geometry& geometry);
py::object geometry_of(const std::vector<Geometry>& geometries);

/// The Python object PolarizedBrdf of four arrays.
py::object polarized(const std::vector<PolarizedBrdf>& curve);

}  // namespace mmbrdf::python
