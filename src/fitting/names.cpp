// SPDX-License-Identifier: BSD-3-Clause
// The names that files and the program use for enumerators.
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include "mmbrdf/fit.hpp"

namespace mmbrdf {
namespace {

constexpr std::array<std::pair<Function, const char*>, 14> function_names{{{Function::m11, "11"},
                                                                           {Function::m12, "12"},
                                                                           {Function::m13, "13"},
                                                                           {Function::m14, "14"},
                                                                           {Function::m22, "22"},
                                                                           {Function::m23, "23"},
                                                                           {Function::m24, "24"},
                                                                           {Function::m33, "33"},
                                                                           {Function::m34, "34"},
                                                                           {Function::m44, "44"},
                                                                           {Function::g, "g"},
                                                                           {Function::h, "h"},
                                                                           {Function::u, "u"},
                                                                           {Function::v, "v"}}};
constexpr std::array<std::pair<Family, const char*>, 3> family_names{
    {{Family::isotropic, "isotropic"}, {Family::germer2017, "germer2017"}, {Family::anisotropic, "anisotropic"}}};
constexpr std::array<std::pair<DiscMapping, const char*>, 2> mapping_names{
    {{DiscMapping::lambert, "lambert"}, {DiscMapping::projected, "projected"}}};

constexpr std::array<std::pair<Frame, const char*>, 3> frame_names{
    {{Frame::xy, "xy"}, {Frame::sp, "sp"}, {Frame::scattering_plane, "scattering_plane"}}};
constexpr std::array<std::pair<Weights, const char*>, 4> weights_names{{{Weights::none, "none"},
                                                                        {Weights::speckle, "speckle"},
                                                                        {Weights::data, "data"},
                                                                        {Weights::estimated, "estimated"}}};
constexpr std::array<std::pair<Covariance, const char*>, 2> covariance_names{
    {{Covariance::residuals, "residuals"}, {Covariance::sandwich, "sandwich"}}};

template <class Names, class Value>
std::string name_of(const Names& names, Value value) {
  for (const auto& [candidate, name] : names)
    if (candidate == value) return name;
  throw std::invalid_argument("unknown enumerator " + std::to_string(static_cast<int>(value)));
}

template <class Names>
auto value_of(const Names& names, const std::string& text, const char* what) {
  std::string known;
  for (const auto& [value, name] : names) {
    if (name == text) return value;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw std::invalid_argument(std::string(what) + " '" + text + "' is not one of " + known);
}

}  // namespace

std::string to_string(Family family) { return name_of(family_names, family); }
std::string to_string(Function function) { return name_of(function_names, function); }
std::string to_string(DiscMapping mapping) { return name_of(mapping_names, mapping); }
std::string to_string(Frame frame) { return name_of(frame_names, frame); }
std::string to_string(Weights weights) { return name_of(weights_names, weights); }
std::string to_string(Covariance covariance) { return name_of(covariance_names, covariance); }
Family family_from(const std::string& name) { return value_of(family_names, name, "basis"); }
Function function_from(const std::string& name) { return value_of(function_names, name, "function"); }
DiscMapping disc_mapping_from(const std::string& name) { return value_of(mapping_names, name, "mapping"); }
Frame frame_from(const std::string& name) { return value_of(frame_names, name, "frame"); }
Weights weights_from(const std::string& name) { return value_of(weights_names, name, "weights"); }
Covariance covariance_from(const std::string& name) { return value_of(covariance_names, name, "covariance"); }

Function function_of(int row, int column) {
  return function_from(std::to_string(row + 1) + std::to_string(column + 1));
}

}  // namespace mmbrdf
