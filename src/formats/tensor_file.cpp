// SPDX-License-Identifier: BSD-3-Clause
#include "formats/tensor_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <ostream>
#include <stdexcept>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::string_view magic("tensor_file\0", 12);
constexpr std::uint64_t longest_axis = 10000;
constexpr int uint8 = 1, uint16 = 3, float32 = 10, float64 = 11;
constexpr std::array<std::size_t, 12> tensor_type_sizes{0, 1, 1, 2, 2, 4,
                                                        4, 8, 8, 2, 4, 8};  // u8, i8 … i64, f16, f32, f64

/// Takes numbers from the beginning of bytes that may end.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}
  template <class Number>
  std::optional<Number> next() {
    if (bytes_.size() < sizeof(Number)) return {};
    const Number value = little_endian<Number>(bytes_.data());
    bytes_.remove_prefix(sizeof(Number));
    return value;
  }
  std::optional<std::string_view> text(std::size_t size) {
    if (bytes_.size() < size) return {};
    const std::string_view found = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return found;
  }

 private:
  std::string_view bytes_;
};

std::optional<TensorField> next_field(Bytes& bytes) {
  const auto length = bytes.next<std::uint16_t>();
  const auto name = length ? bytes.text(*length) : std::nullopt;
  const auto dimensions = bytes.next<std::uint16_t>();
  const auto type = bytes.next<std::uint8_t>();
  const auto offset = bytes.next<std::uint64_t>();
  if (!name || !dimensions || !type || !offset) return {};
  TensorField field{std::string(*name), *type, *offset, {}};
  for (int d = 0; d < *dimensions; ++d) {
    const auto size = bytes.next<std::uint64_t>();
    if (!size) return {};
    field.shape.push_back(*size);
  }
  return field;
}

/// Those that are there, and how many there should be.
std::vector<TensorField> fields_of(std::string_view head, std::uint32_t& count) {
  Bytes bytes(head.substr(std::min(head.size(), magic.size() + 2)));
  count = bytes.next<std::uint32_t>().value_or(1);
  std::vector<TensorField> fields;
  while (fields.size() < count) {
    std::optional<TensorField> field = next_field(bytes);
    if (!field) break;
    fields.push_back(std::move(*field));
  }
  return fields;
}

double number_at(const char* bytes, int type) {
  switch (type) {
    case 1:
      return little_endian<std::uint8_t>(bytes);
    case 2:
      return little_endian<std::int8_t>(bytes);
    case 3:
      return little_endian<std::uint16_t>(bytes);
    case 4:
      return little_endian<std::int16_t>(bytes);
    case 5:
      return little_endian<std::uint32_t>(bytes);
    case 6:
      return little_endian<std::int32_t>(bytes);
    case 7:
      return static_cast<double>(little_endian<std::uint64_t>(bytes));
    case 8:
      return static_cast<double>(little_endian<std::int64_t>(bytes));
    case float32:
      return static_cast<double>(little_endian<float>(bytes));
    default:
      return little_endian<double>(bytes);
  }
}

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  std::string text;
  for (const std::uint64_t size : shape) text += (text.empty() ? "" : ", ") + std::to_string(size);
  return "[" + text + "]";
}

}  // namespace

bool is_tensor_file(std::string_view head, std::uint64_t) { return head.starts_with(magic); }

std::vector<std::string> tensor_names(std::string_view head) {
  std::vector<std::string> names;
  std::uint32_t count = 0;
  if (is_tensor_file(head, 0))
    for (const TensorField& field : fields_of(head, count)) names.push_back(field.name);
  return names;
}

bool has_tensor(std::string_view head, std::initializer_list<std::string_view> names) {
  const std::vector<std::string> there = tensor_names(head);
  return std::ranges::any_of(names, [&](std::string_view name) { return std::ranges::count(there, name) > 0; });
}

TensorFile::TensorFile(const Source& source) : path_(source.path), file_(source.path) {
  std::uint32_t count = 0;
  fields_ = fields_of(source.head, count);
  if (fields_.size() < count)
    throw source.error("the header says " + std::to_string(count) + " fields, but has " +
                       std::to_string(fields_.size()) + ": cut off?");
  for (const TensorField& field : fields_) {
    if (field.type < 1 || field.type > float64 || field.type == 9)
      throw error(field, "type " + std::to_string(field.type) + " cannot be read");
    std::uint64_t bytes = tensor_type_sizes[static_cast<std::size_t>(field.type)];
    for (const std::uint64_t size : field.shape) {
      if (size == 0) throw error(field, "shape " + shape_text(field.shape) + " is empty");
      bytes = product(bytes, size);
    }
    if (field.offset > source.size || bytes > source.size - field.offset)
      throw error(field, "shape " + shape_text(field.shape) + " at offset " + std::to_string(field.offset) +
                             " is not all within the " + std::to_string(source.size) + " bytes of the file: cut off?");
  }
}

const TensorField& TensorFile::field(const std::string& name) const {
  const auto found = std::ranges::find(fields_, name, &TensorField::name);
  if (found == fields_.end()) throw std::runtime_error(path_ + ": no field " + name);
  return *found;
}

void TensorFile::read(const TensorField& field, std::uint64_t first, std::span<double> values) {
  const std::size_t size = tensor_type_sizes[static_cast<std::size_t>(field.type)];
  bytes_.resize(values.size() * size);
  file_.read(field.offset + first * size, bytes_);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = number_at(bytes_.data() + i * size, field.type);
}

std::vector<double> TensorFile::axis(const std::string& name) {
  const TensorField& field = this->field(name);
  std::uint64_t count = 1, longest = 1;
  for (const std::uint64_t size : field.shape) count = product(count, size), longest = std::max(longest, size);
  if (count != longest) throw error(field, "shape " + shape_text(field.shape) + " is not that of one axis");
  if (count > longest_axis)
    throw error(field, std::to_string(count) + " nodes of an axis, must be at most " + std::to_string(longest_axis));
  std::vector<double> values(count);
  read(field, 0, values);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]) || (i > 0 && !(values[i] > values[i - 1])))
      throw error(field, "value " + std::to_string(i + 1) + ", " + shortest(values[i]) + ", does not rise");
  return values;
}

std::vector<double> TensorFile::angles(const std::string& name, double least, double most) {
  std::vector<double> values = axis(name);
  for (double& value : values) {
    if (value < least - single_precision || value > most + single_precision)
      throw error(field(name),
                  shortest(value) + " is not in [" + rounded(least, 5) + ", " + rounded(most, 5) + "] radians");
    value = std::clamp(value, least, most);
  }
  return values;
}

void TensorFile::require_shape(const TensorField& field, const std::vector<std::uint64_t>& shape) const {
  if (field.shape != shape)
    throw error(field, "shape " + shape_text(field.shape) + ", but the axes ask for " + shape_text(shape));
  if (field.type < float32)
    throw error(field, "type " + std::to_string(field.type) + ", must be 10 or 11, floating point");
}

std::runtime_error TensorFile::error(const TensorField& field, const std::string& what) const {
  return std::runtime_error(path_ + ": field " + shown_name(field.name) + ": " + what);
}

namespace {

template <class Number>
void append(std::string& bytes, Number value) {
  for (std::size_t k = 0; k < sizeof value; ++k) bytes.push_back(static_cast<char>(value >> (8 * k) & 0xff));
}

}  // namespace

void write_tensor_file(std::ostream& out, std::span<const NewTensor> fields) {
  constexpr std::uint64_t alignment = 8;
  const auto size_of = [](const NewTensor& field) {
    return 4 * field.singles.size() + 2 * field.whole.size() + field.bytes.size();
  };
  const auto aligned = [](std::uint64_t at) { return (at + alignment - 1) / alignment * alignment; };
  std::uint64_t header = magic.size() + 2 + 4;
  for (const NewTensor& field : fields) header += 2 + field.name.size() + 2 + 1 + 8 + 8 * field.shape.size();
  std::string bytes(magic);
  append(bytes, std::uint8_t{1});
  append(bytes, std::uint8_t{0});
  append(bytes, static_cast<std::uint32_t>(fields.size()));
  std::uint64_t offset = aligned(header);
  for (const NewTensor& field : fields) {
    append(bytes, static_cast<std::uint16_t>(field.name.size()));
    bytes += field.name;
    append(bytes, static_cast<std::uint16_t>(field.shape.size()));
    append(bytes, static_cast<std::uint8_t>(!field.bytes.empty() ? uint8 : !field.whole.empty() ? uint16 : float32));
    append(bytes, offset);
    for (const std::uint64_t size : field.shape) append(bytes, size);
    offset = aligned(offset + size_of(field));
  }
  for (const NewTensor& field : fields) {
    bytes.resize(aligned(bytes.size()));
    bytes += field.bytes;
    for (const std::uint16_t value : field.whole) append(bytes, value);
    for (const float value : field.singles) append(bytes, std::bit_cast<std::uint32_t>(value));
  }
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::unique_ptr<ForeignFile::Reader> open_other_tensor(const Source& source) {
  const TensorFile file(source);
  std::string names;
  for (const std::string& name : tensor_names(source.head)) names += (names.empty() ? "" : ", ") + shown_name(name);
  throw source.error("a tensor file of " + (names.empty() ? "no fields" : names) +
                     ": neither a Mueller BRDF (.pbsdf: phi_d, theta_d, theta_h, wvls, M) nor an RGL material");
}

}  // namespace mmbrdf
