// SPDX-License-Identifier: BSD-3-Clause
// Numbers as they lie in memory, behind what tells how they lie there.
#pragma once

#include <pybind11/pybind11.h>

#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace mmbrdf::python {

template <class T>
std::string pickle_head(const std::string& what) {
  static_assert(std::is_trivially_copyable_v<T>);
  return "mmbrdf." + what + " 1, " + std::to_string(sizeof(T)) + " bytes each\n";
}

template <class T>
pybind11::bytes bits(const std::string& what, std::span<const T> values) {
  std::string text = pickle_head<T>(what);
  text.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return text;
}

/// Throws std::invalid_argument for bytes of something else, or of another version or machine.
template <class T>
std::vector<T> from_bits(const std::string& what, const pybind11::handle& bytes) {
  const auto text = bytes.cast<std::string_view>();
  const std::string head = pickle_head<T>(what);
  if (!text.starts_with(head) || (text.size() - head.size()) % sizeof(T) != 0)
    throw std::invalid_argument(what + ": not pickled by this version of mmbrdf on such a machine");
  std::vector<T> values((text.size() - head.size()) / sizeof(T));
  std::memcpy(values.data(), text.data() + head.size(), text.size() - head.size());
  return values;
}

}  // namespace mmbrdf::python
