// SPDX-License-Identifier: BSD-3-Clause
// Apertures, in degrees.
#include "mmbrdf/geometry/apertures.hpp"

#include "bindings.hpp"

namespace mmbrdf::python {

namespace {

using ApertureClass = py::class_<Aperture>;

void bind_cones(ApertureClass& c) {
  c.def_static(
       "direction", [](double theta, double phi) { return Aperture::direction(direction_from_degrees(theta, phi)); },
       py::arg("theta_deg"), py::arg("phi_deg") = 0.0, "One direction.")
      .def_static(
          "cone",
          [](double theta, double phi, double half) {
            return Aperture::cone(direction_from_degrees(theta, phi), radians(half));
          },
          py::arg("theta_deg"), py::arg("phi_deg"), py::arg("half_angle_deg"),
          "All directions within the half-angle of an axis.")
      .def_static(
          "annulus",
          [](double theta, double phi, double inner, double outer) {
            return Aperture::annulus(direction_from_degrees(theta, phi), radians(inner), radians(outer));
          },
          py::arg("theta_deg"), py::arg("phi_deg"), py::arg("inner_deg"), py::arg("outer_deg"),
          "All directions between two angles from an axis.");
}

void bind_flat_shapes(ApertureClass& c) {
  c.def_static(
       "ellipse",
       [](double theta, double phi, double half_theta, double half_phi, double turn) {
         return Aperture::ellipse(direction_from_degrees(theta, phi), radians(half_theta), radians(half_phi),
                                  radians(turn));
       },
       py::arg("theta_deg"), py::arg("phi_deg"), py::arg("half_theta_deg"), py::arg("half_phi_deg"),
       py::arg("turn_deg") = 0.0,
       "An ellipse in a plane across the axis: half_theta_deg is its half-angle along the meridian, half_phi_deg "
       "across\n"
       "it. Both are turned about the axis by turn_deg, from rising theta to rising phi.")
      .def_static(
          "rectangle",
          [](double theta, double phi, double half_theta, double half_phi, double turn) {
            return Aperture::rectangle(direction_from_degrees(theta, phi), radians(half_theta), radians(half_phi),
                                       radians(turn));
          },
          py::arg("theta_deg"), py::arg("phi_deg"), py::arg("half_theta_deg"), py::arg("half_phi_deg"),
          py::arg("turn_deg") = 0.0, "A rectangle with such half-angles.");
}

void bind_rings(ApertureClass& c) {
  c.def_static(
       "ring", [](double least, double most) { return Aperture::ring(radians(least), radians(most)); },
       py::arg("theta_min_deg"), py::arg("theta_max_deg"),
       "All azimuths, between two polar angles; without width a circle of directions.")
      .def_static(
          "cap", [](double most) { return Aperture::cap(radians(most)); }, py::arg("theta_max_deg"),
          "All azimuths, from the normal to a polar angle.")
      .def_static("hemisphere", &Aperture::hemisphere, "All directions above the surface.");
}

}  // namespace

void bind_apertures(py::module_& m) {
  ApertureClass c(m, "Aperture",
                  "Directions from which a sample is illuminated or into which light is collected. Angles are in "
                  "degrees.\nRaises ValueError for a shape that reaches below the horizon.");
  bind_cones(c);
  bind_flat_shapes(c);
  bind_rings(c);
  c.def("without", &Aperture::without, py::arg("port"), "With one more port: a cone that is taken out.")
      .def_property_readonly("projected_solid_angle", &Aperture::projected_solid_angle, "In sr")
      .def("__repr__", [](const Aperture& a) {
        return "<mmbrdf.Aperture: " + formatted("{:.6g}", a.projected_solid_angle()) + " sr projected, up to " +
               formatted("{:.6g}", degrees(a.largest_theta())) + " degrees>";
      });
}

}  // namespace mmbrdf::python
