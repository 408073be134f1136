// SPDX-License-Identifier: BSD-3-Clause
// Apertures, in degrees.
#include "aperture.hpp"

#include <pybind11/stl.h>

namespace mmbrdf::python {

namespace {

using ApertureClass = py::class_<ApertureObject>;

template <class... Angles, class... Extra>
void define(ApertureClass& c, const char* name, Aperture (*make)(Angles...), const Extra&... extra) {
  c.def_static(
      name, [=](Angles... angles) { return ApertureObject(make(angles...), name, {angles...}); }, extra...);
}

ApertureObject without(const ApertureObject& aperture, const ApertureObject& port) {
  ApertureObject result = aperture;
  static_cast<Aperture&>(result) = aperture.without(port);
  result.ports.push_back(port);
  return result;
}

py::tuple pickled(const ApertureObject& aperture) {
  return py::make_tuple(aperture.name, aperture.angles, tuple_of(aperture.ports, pickled));
}

ApertureObject unpickled(const py::tuple& state) {
  const py::object make = py::type::of<ApertureObject>().attr(state[0].cast<std::string>().c_str());
  ApertureObject result = make(*state[1].cast<py::list>()).cast<ApertureObject>();
  for (const py::handle port : state[2]) result = without(result, unpickled(port.cast<py::tuple>()));
  return result;
}

void bind_cones(ApertureClass& c) {
  define(
      c, "direction", +[](double theta, double phi) { return Aperture::direction(direction_from_degrees(theta, phi)); },
      py::arg("theta_deg"), py::arg("phi_deg") = 0.0, "One direction.");
  define(
      c, "cone",
      +[](double theta, double phi, double half) {
        return Aperture::cone(direction_from_degrees(theta, phi), radians(half));
      },
      py::arg("theta_deg"), py::arg("phi_deg"), py::arg("half_angle_deg"),
      "All directions within the half-angle of an axis.");
  define(
      c, "annulus",
      +[](double theta, double phi, double inner, double outer) {
        return Aperture::annulus(direction_from_degrees(theta, phi), radians(inner), radians(outer));
      },
      py::arg("theta_deg"), py::arg("phi_deg"), py::arg("inner_deg"), py::arg("outer_deg"),
      "All directions between two angles from an axis.");
}

using Flat = Aperture (*)(const Direction&, double, double, double);

template <Flat shape>
void define_flat(ApertureClass& c, const char* name, const char* doc) {
  define(
      c, name,
      +[](double theta, double phi, double half_theta, double half_phi, double turn) {
        return shape(direction_from_degrees(theta, phi), radians(half_theta), radians(half_phi), radians(turn));
      },
      py::arg("theta_deg"), py::arg("phi_deg"), py::arg("half_theta_deg"), py::arg("half_phi_deg"),
      py::arg("turn_deg") = 0.0, doc);
}

void bind_rings(ApertureClass& c) {
  define(
      c, "ring", +[](double least, double most) { return Aperture::ring(radians(least), radians(most)); },
      py::arg("theta_min_deg"), py::arg("theta_max_deg"),
      "All azimuths, between two polar angles; without width a circle of directions.");
  define(
      c, "cap", +[](double most) { return Aperture::cap(radians(most)); }, py::arg("theta_max_deg"),
      "All azimuths, from the normal to a polar angle.");
  define(c, "hemisphere", &Aperture::hemisphere, "All directions above the surface.");
}

}  // namespace

void bind_apertures(py::module_& m) {
  ApertureClass c(m, "Aperture",
                  "Directions from which a sample is illuminated or into which light is collected. Angles are in "
                  "degrees.\nRaises ValueError for a shape that reaches below the horizon.");
  bind_cones(c);
  define_flat<Aperture::ellipse>(
      c, "ellipse",
      "An ellipse in a plane across the axis: half_theta_deg is its half-angle along the meridian, half_phi_deg "
      "across\nit. Both are turned about the axis by turn_deg, from rising theta to rising phi.");
  define_flat<Aperture::rectangle>(c, "rectangle", "A rectangle with such half-angles.");
  bind_rings(c);
  c.def("without", without, py::arg("port"), "With one more port: a cone that is taken out.")
      .def_property_readonly("projected_solid_angle", &Aperture::projected_solid_angle, "In sr")
      .def_property_readonly(
          "largest_theta_deg", [](const ApertureObject& a) { return degrees(a.largest_theta()); },
          "The largest polar angle of its directions")
      .def("__repr__",
           [](const ApertureObject& a) {
             return "<mmbrdf.Aperture: " + formatted("{:.6g}", a.projected_solid_angle()) + " sr projected, up to " +
                    formatted("{:.6g}", degrees(a.largest_theta())) + " degrees>";
           })
      .def(py::pickle(&pickled, &unpickled));
}

}  // namespace mmbrdf::python
