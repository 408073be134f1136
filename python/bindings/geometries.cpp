// SPDX-License-Identifier: BSD-3-Clause
// Directions that samples are taken at, and models asked for.
#include <pybind11/stl.h>

#include <stdexcept>

#include "dataset.hpp"
#include "mmbrdf/fitting/subsets.hpp"

namespace mmbrdf::python {

std::vector<Geometry> geometries_from(const py::sequence& angles) {
  if (angles.size() != 4)
    throw std::invalid_argument("geometry: " + std::to_string(angles.size()) +
                                " arrays, expected theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg");
  return geometries(Broadcast(direction_operands(angles[0], angles[1], angles[2], angles[3])));
}

py::object geometry_object(const Geometry& g) {
  return record("Geometry", degrees(g.incident.theta), degrees(g.incident.phi), degrees(g.reflected.theta),
                degrees(g.reflected.phi));
}

py::object geometry_of(const std::vector<Geometry>& geometries) {
  std::array<py::array_t<double>, 4> angles;
  for (py::array_t<double>& one : angles) one = py::array_t<double>(static_cast<py::ssize_t>(geometries.size()));
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    const Geometry& g = geometries[i];
    const std::array values{g.incident.theta, g.incident.phi, g.reflected.theta, g.reflected.phi};
    for (std::size_t a = 0; a < 4; ++a) angles[a].mutable_data()[i] = degrees(values[a]);
  }
  return record("Geometry", angles[0], angles[1], angles[2], angles[3]);
}

void bind_geometries(py::module_& m) {
  m.def(
      "germer2017_grid", [] { return geometry_of(germer2017_grid()); },
      "The 1824 geometries of the published measurement, as a Geometry of arrays.");
  m.def(
      "random_geometries",
      [](int count, unsigned long seed, double most) {
        return geometry_of(random_geometries(count, seed, radians(most)));
      },
      py::arg("count"), py::arg("seed"), py::arg("theta_max_deg") = 75.0,
      "Pairs of directions, each uniform in projected direction cosines. The same seed gives the same pairs.");
  m.def(
      "in_plane",
      [](double theta_i, const Given& theta_r) {
        std::vector<double> angles = numbers("theta_r_deg", theta_r);
        for (double& angle : angles) angle = radians(angle);
        return geometry_of(in_plane(radians(theta_i), angles));
      },
      py::arg("theta_i_deg"), py::arg("theta_r_deg"),
      "Directions in the plane of incidence: the source at azimuth 0, the detector at azimuth 180 (forward) for\n"
      "theta_r_deg >= 0, at azimuth 0 (back) below.");
}

}  // namespace mmbrdf::python
