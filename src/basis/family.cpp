// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/basis/family.hpp"

#include <stdexcept>

#include "text/names.hpp"

namespace mmbrdf {
namespace {

constexpr Named<Family> family_names[] = {
    {Family::isotropic, "isotropic"}, {Family::germer2017, "germer2017"}, {Family::anisotropic, "anisotropic"}};
constexpr Named<Rotation> rotation_names[] = {{Rotation::covariant, "covariant"}, {Rotation::as_printed, "as_printed"}};

}  // namespace

FamilyTraits traits(Family family) {
  switch (family) {
    case Family::germer2017:
      return {.at_zero_azimuth = true, .minimum_norm = true, .published_form = true};
    case Family::isotropic:
      return {.at_zero_azimuth = false, .minimum_norm = false, .published_form = true};
    case Family::anisotropic:
      break;
  }
  return {.at_zero_azimuth = false, .minimum_norm = false, .published_form = false};
}

bool turns(Family family, Rotation rotation) {
  return traits(family).at_zero_azimuth && rotation == Rotation::covariant;
}

void require_valid(Family family, Rotation rotation) {
  if (rotation == Rotation::as_printed && !traits(family).at_zero_azimuth)
    throw std::invalid_argument("as_printed goes with germer2017, not with " + to_string(family));
}

std::string to_string(Family family) { return name_of(family_names, family); }
std::string to_string(Rotation rotation) { return name_of(rotation_names, rotation); }
Family family_from(const std::string& name) { return value_of(family_names, name, "basis"); }
Rotation rotation_from(const std::string& name) { return value_of(rotation_names, name, "rotation"); }

}  // namespace mmbrdf
