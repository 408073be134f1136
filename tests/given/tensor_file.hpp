// SPDX-License-Identifier: BSD-3-Clause
/// Tensor files, as .pbsdf and RGL .bsdf files are, written from their description.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "given/foreign.hpp"

namespace mmbrdf {

/// An array of a tensor file; types as there, 10 is float.
struct TensorArray {
  std::string name;
  std::uint8_t type;
  std::vector<std::uint64_t> shape;
  std::string data;
};

inline std::string tensor_file(const std::vector<TensorArray>& fields) {
  std::string head("tensor_file\0\1\0", 14);
  append(head, static_cast<std::uint32_t>(fields.size()));
  std::uint64_t offset = head.size();
  for (const TensorArray& field : fields) offset += 13 + field.name.size() + 8 * field.shape.size();
  std::string data;
  for (const TensorArray& field : fields) {
    while ((offset + data.size()) % 8 != 0) data += '\0';
    append(head, static_cast<std::uint16_t>(field.name.size()));
    head += field.name;
    append(head, static_cast<std::uint16_t>(field.shape.size()));
    append(head, field.type);
    append(head, offset + data.size());
    for (const std::uint64_t size : field.shape) append(head, size);
    data += field.data;
  }
  return head + data;
}

inline std::string singles(const std::vector<double>& values) {
  std::string bytes;
  for (const double value : values) append(bytes, static_cast<float>(value));
  return bytes;
}

}  // namespace mmbrdf
