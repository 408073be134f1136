// SPDX-License-Identifier: BSD-3-Clause
// The container of named arrays that .pbsdf and RGL .bsdf files share: "tensor_file", NUL, version 1.0, then for each
// field its name, type, offset and shape; all little-endian, arrays in C order.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/byte_file.hpp"
#include "formats/reader.hpp"

namespace mmbrdf {

struct TensorField {
  std::string name;
  int type = 0;
  std::uint64_t offset = 0;
  std::vector<std::uint64_t> shape;
};

bool is_tensor_file(std::string_view head, std::uint64_t size);

/// Names of the fields, as far as the head has them.
std::vector<std::string> tensor_names(std::string_view head);

/// Whether any of these is among them.
bool has_tensor(std::string_view head, std::initializer_list<std::string_view> names);

/// Radians: angles in these files are in single precision, or in few digits.
inline constexpr double single_precision = 1e-5;

class TensorFile {
 public:
  /// Throws std::runtime_error if the header is cut off, or a field does not lie within the file.
  explicit TensorFile(const Source& source);

  /// Throws if there is none of this name.
  const TensorField& field(const std::string& name) const;

  /// Numbers of a field from the `first` one on. What is not finite is as it is.
  void read(const TensorField& field, std::uint64_t first, std::span<double> values);

  /// All numbers of a field of one axis: others of length 1 may be around it. At most 10000, finite and rising, or this
  /// throws.
  std::vector<double> axis(const std::string& name);

  /// The same of angles in radians, clamped to [least, most]; what is further outside than single_precision throws.
  std::vector<double> angles(const std::string& name, double least, double most);

  /// Throws unless the field is of floating-point numbers in this shape.
  void require_shape(const TensorField& field, const std::vector<std::uint64_t>& shape) const;

  /// "path: field NAME: what", as an error to throw.
  [[nodiscard]] std::runtime_error error(const TensorField& field, const std::string& what) const;

 private:
  std::string path_;
  ByteFile file_;
  std::vector<TensorField> fields_;
  std::vector<char> bytes_;
};

/// A field to be written: numbers in single precision, 16 bits of whole ones, or bytes.
struct NewTensor {
  std::string name;
  std::vector<std::uint64_t> shape;
  std::span<const float> singles = {};
  std::span<const std::uint16_t> whole = {};
  std::string_view bytes = {};
};
void write_tensor_file(std::ostream& out, std::span<const NewTensor> fields);

/// A tensor file that holds something else: throws, with the names of its fields.
std::unique_ptr<ForeignFile::Reader> open_other_tensor(const Source& source);

}  // namespace mmbrdf
