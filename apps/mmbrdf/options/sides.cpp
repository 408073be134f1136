// SPDX-License-Identifier: BSD-3-Clause
#include "options/sides.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "options/arguments.hpp"
#include "pages/output.hpp"

namespace mmbrdf::program {

namespace {

struct Form {
  const char* name;
  const char* arguments;
  std::size_t fewest, most;  // numbers
};

constexpr Form forms[] = {
    {"cone", "theta,phi,half", 3, 3},
    {"annulus", "theta,phi,inner,outer", 4, 4},
    {"ellipse", "theta,phi,half_theta,half_phi[,turn]", 4, 5},
    {"rectangle", "theta,phi,half_theta,half_phi[,turn]", 4, 5},
    {"ring", "theta_min,theta_max", 2, 2},
    {"cap", "theta", 1, 1},
};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

std::invalid_argument wrong(const std::string& text, const std::string& expected) {
  return std::invalid_argument("\"" + text + "\": expected " + expected);
}

/// NAME(A,B…)
Shape named_shape(const std::string& text) {
  const std::size_t open = text.find('(');
  const std::string name = text.substr(0, open);
  const auto* const form =
      std::find_if(std::begin(forms), std::end(forms), [&](const Form& f) { return f.name == name; });
  if (form == std::end(forms)) {
    throw wrong(text,
                "THETA, THETA,PHI, THETAa, d, cone(...), annulus(...), ellipse(...), rectangle(...), ring(...) or "
                "cap(...)");
  }
  const std::string expected = name + "(" + form->arguments + ")";
  if (open == std::string::npos || text.back() != ')') throw wrong(text, expected);
  Shape shape{name, {}};
  try {
    shape.numbers = numbers(text.substr(open + 1, text.size() - open - 2));
  } catch (const std::invalid_argument&) {
    throw wrong(text, expected);
  }
  if (shape.numbers.size() < form->fewest || shape.numbers.size() > form->most) throw wrong(text, expected);
  return shape;
}

/// THETA, THETA,PHI or THETAa.
Shape plain_shape(const std::string& text) {
  const bool ring = text.ends_with('a');
  Shape shape{ring ? "a" : "direction", {}};
  try {
    shape.numbers = numbers(ring ? text.substr(0, text.size() - 1) : text);
  } catch (const std::invalid_argument&) {
    shape.numbers.clear();
  }
  if (shape.numbers.empty() || shape.numbers.size() > (ring ? 1U : 2U))
    throw wrong(text, "THETA, THETA,PHI or THETAa in degrees");
  return shape;
}

Side side_from(const std::string& text) {
  Side side{text, {}};
  std::size_t begin = 0;
  for (std::size_t end = 0; end < text.size(); begin = end + 1) {
    end = begin + 1;  // a minus before a letter begins a port
    while (end < text.size() && !(text[end] == '-' && end + 1 < text.size() && is_letter(text[end + 1]))) ++end;
    const std::string part = text.substr(begin, end - begin);
    side.shapes.push_back(part == "d"                                ? Shape{"d", {}}
                          : !part.empty() && is_letter(part.front()) ? named_shape(part)
                                                                     : plain_shape(part));
  }
  if (side.shapes.empty()) throw wrong(text, "SOURCE:RECEIVER");
  return side;
}

Aperture shape_of(const Shape& shape, double phi_deg) {
  const std::vector<double>& n = shape.numbers;
  if (shape.name == "d") return Aperture::hemisphere();
  if (shape.name == "a") return Aperture::ring(radians(n[0]), radians(n[0]));
  if (shape.name == "ring") return Aperture::ring(radians(n[0]), radians(n[1]));
  if (shape.name == "cap") return Aperture::cap(radians(n[0]));
  const Direction axis = direction_from({n[0], n.size() > 1 ? n[1] : phi_deg}, "--geometry");
  if (shape.name == "direction") return Aperture::direction(axis);
  if (shape.name == "cone") return Aperture::cone(axis, radians(n[2]));
  if (shape.name == "annulus") return Aperture::annulus(axis, radians(n[2]), radians(n[3]));
  const double turn = n.size() > 4 ? radians(n[4]) : 0;
  return shape.name == "ellipse" ? Aperture::ellipse(axis, radians(n[2]), radians(n[3]), turn)
                                 : Aperture::rectangle(axis, radians(n[2]), radians(n[3]), turn);
}

}  // namespace

Sides sides_from(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || text.find(':', colon + 1) != std::string::npos)
    throw wrong(text, "SOURCE:RECEIVER, as in 0:45 or 8:d");
  return {side_from(text.substr(0, colon)), side_from(text.substr(colon + 1))};
}

Aperture aperture_of(const Side& side, double phi_deg) {
  Aperture aperture = shape_of(side.shapes.front(), phi_deg);
  for (std::size_t i = 1; i < side.shapes.size(); ++i) aperture = aperture.without(shape_of(side.shapes[i], phi_deg));
  return aperture;
}

std::string description(const Side& side, double phi_deg) {
  const Shape& first = side.shapes.front();
  const double area = aperture_of(side, phi_deg).projected_solid_angle();
  std::string what = side.text;
  if (first.name == "direction")
    what = "direction " + brief(first.numbers[0]) + "," + brief(first.numbers.size() > 1 ? first.numbers[1] : phi_deg);
  else if (first.name == "a")
    what = "all azimuths at " + brief(first.numbers[0]);
  else if (first.name == "d")
    what = "hemisphere" + side.text.substr(1);
  return what + (area > 0 ? format(", projected solid angle %.6g sr", area) : "");
}

bool is_hemisphere(const Side& side) { return side.shapes.front().name == "d"; }

const char* const sides_help =
    "SOURCE and RECEIVER are, all in degrees,\n"
    "  0, 45 or 45,PHI                          a direction; the source has PHI = 0, the receiver 180 (forward)\n"
    "  45a                                      all azimuths at that polar angle\n"
    "  d                                        the hemisphere\n"
    "  cone(theta,phi,half), annulus(theta,phi,inner,outer)\n"
    "  ellipse(theta,phi,half_theta,half_phi[,turn]), rectangle(theta,phi,half_theta,half_phi[,turn])\n"
    "                                           half-angles along the meridian and across it, turned about the axis\n"
    "  ring(theta_min,theta_max), cap(theta)    about the normal\n"
    "less ports that are cones: d-cone(8,180,4).\n";

}  // namespace mmbrdf::program
