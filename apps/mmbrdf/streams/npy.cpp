// SPDX-License-Identifier: BSD-3-Clause
#include "streams/npy.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/text/printable.hpp"

namespace mmbrdf::program {

namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t header_size = 128;  // room for any number of rows
constexpr std::size_t longest_header = 1 << 16;

std::runtime_error failure(const std::string& name, const std::string& text) {
  return std::runtime_error(name + ": " + text);
}

std::string read_bytes(std::istream& in, const std::string& name, std::size_t count) {
  std::string bytes(count, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  if (static_cast<std::size_t>(in.gcount()) != count) throw failure(name, "ends within the header of a .npy file");
  return bytes;
}

/// What stands behind a key of the header, from the first character that is not blank.
std::string_view value_of(std::string_view header, const std::string& key, const std::string& name) {
  const std::size_t at = header.find("'" + key + "':");
  if (at == std::string_view::npos) throw failure(name, "no '" + key + "' in the header of the .npy file");
  std::string_view value = header.substr(at + key.size() + 3);
  value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
  return value;
}

/// (3, 5) or (3,)
std::vector<std::size_t> shape_from(std::string_view text, const std::string& name) {
  std::vector<std::size_t> shape;
  const std::size_t end = text.find(')');
  if (!text.starts_with('(') || end == std::string_view::npos)
    throw failure(name, "no shape in the header of the .npy file");
  text = text.substr(1, end - 1);
  while (text.find_first_not_of(", ") != std::string_view::npos) {
    text.remove_prefix(text.find_first_not_of(", "));
    std::size_t length = 0;
    const auto [last, problem] = std::from_chars(text.data(), text.data() + text.size(), length);
    if (problem != std::errc{}) throw failure(name, "no shape in the header of the .npy file");
    shape.push_back(length);
    text.remove_prefix(static_cast<std::size_t>(last - text.data()));
  }
  return shape;
}

/// Little-endian.
std::size_t number_from(std::string_view bytes) {
  std::size_t number = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) number = number * 256 + static_cast<unsigned char>(bytes[i]);
  return number;
}

}  // namespace

bool is_npy(const std::string& path) { return has_ending(path, ".npy"); }

bool begins_as_npy(std::istream& in) { return in.peek() == std::char_traits<char>::to_int_type(magic.front()); }

std::vector<std::size_t> read_npy_header(std::istream& in, const std::string& name) {
  std::string start(magic.size() + 2, '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (!start.starts_with(magic)) throw failure(name, "does not begin as a .npy file does");
  const int version = start[magic.size()];
  if (version < 1 || version > 3) throw failure(name, ".npy format " + std::to_string(version) + ", known are 1 to 3");
  const std::size_t length = number_from(read_bytes(in, name, version == 1 ? 2 : 4));
  if (length > longest_header) throw failure(name, "a .npy header of " + std::to_string(length) + " bytes");
  const std::string header = read_bytes(in, name, length);
  const std::string_view type = value_of(header, "descr", name);
  if (!type.starts_with("'<f8'")) {
    throw failure(name, "numbers of type " + printable(type.substr(0, type.find(',')), 40) +
                            ", expected '<f8': save array.astype('<f8')");
  }
  if (!value_of(header, "fortran_order", name).starts_with("False"))
    throw failure(name, "in Fortran order, expected C order: save numpy.ascontiguousarray(array)");
  return shape_from(value_of(header, "shape", name), name);
}

std::string npy_header(const std::vector<std::size_t>& shape) {
  std::string text = "{'descr': '<f8', 'fortran_order': False, 'shape': (";
  for (const std::size_t& length : shape)
    text += std::to_string(length) + (shape.size() == 1 ? "," : &length == &shape.back() ? "" : ", ");
  text += "), }";
  std::string header(magic);
  const std::size_t rest = header_size - magic.size() - 4;
  header += {1, 0, static_cast<char>(rest % 256), static_cast<char>(rest / 256)};
  return header + text + std::string(rest - text.size() - 1, ' ') + '\n';
}

double from_npy(const char* bytes) {
  if constexpr (std::endian::native == std::endian::little) {
    double value = 0;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  return std::bit_cast<double>(static_cast<std::uint64_t>(number_from({bytes, 8})));
}

void to_npy(double value, char* bytes) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(bytes, &bits, sizeof bits);
    return;
  }
  for (int i = 0; i < 8; ++i) bytes[i] = static_cast<char>(bits >> (8 * i));
}

}  // namespace mmbrdf::program
