// SPDX-License-Identifier: BSD-3-Clause
#include "formats/netcdf_header.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <vector>

#include "formats/byte_file.hpp"
#include "mmbrdf/text/input.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::uint64_t longest_name = 256, most_dimensions = 1024, most_others = 8192;  // as the library has them
constexpr std::uint64_t longest_attribute = 1 << 24;
constexpr std::uint64_t huge = std::numeric_limits<std::uint64_t>::max();
constexpr std::array<std::uint64_t, 12> type_sizes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};  // byte, char … uint64

std::uint64_t sum(std::uint64_t a, std::uint64_t b) { return a > huge - b ? huge : a + b; }
std::uint64_t padded(std::uint64_t bytes) { return bytes > huge - 3 ? huge : (bytes + 3) / 4 * 4; }

class Header {
 public:
  explicit Header(const std::string& path)
      : path_(path), in_(open_input(path)), size_(std::filesystem::file_size(path)) {}

  void check() {
    std::array<char, 4> magic{};
    in_.read(magic.data(), 4);
    version_ = static_cast<unsigned char>(magic[3]);
    if (!in_ || std::string_view(magic.data(), 3) != "CDF" || (version_ != 1 && version_ != 2 && version_ != 5)) return;
    at_ = 4;
    records_ = count();
    const std::uint64_t dimensions = list(10, "dimensions", most_dimensions);
    for (std::uint64_t d = 0; d < dimensions; ++d) {
      const std::string of = name("a dimension");
      lengths_.push_back(count());
      if (lengths_.back() == 0 && std::ranges::count(lengths_, 0U) > 1)
        throw error("dimension " + shown_name(of) + " is a second one without a length");
    }
    attributes();
    const std::uint64_t variables = list(11, "variables", most_others);
    for (std::uint64_t v = 0; v < variables; ++v) variable();
    for (const Variable& one : variables_) require_within(one);
  }

 private:
  struct Variable {
    std::string name;
    std::uint64_t bytes, begin;  // of a record, if it has records
    bool records;
  };

  [[nodiscard]] std::runtime_error error(const std::string& what) const {
    return std::runtime_error(path_ + ": NetCDF header: " + what + "; damaged or cut off?");
  }

  void require_left(std::uint64_t bytes) const {
    if (bytes > size_ - at_)
      throw error("at offset " + std::to_string(at_) + " " + std::to_string(bytes) +
                  " more bytes do not fit into a file of " + std::to_string(size_));
  }

  void skip(std::uint64_t bytes) {
    require_left(bytes);
    at_ += bytes;
    in_.seekg(static_cast<std::streamoff>(at_));
  }

  std::uint64_t number(std::size_t width) {
    require_left(width);
    std::array<char, 8> bytes{};
    in_.read(bytes.data(), static_cast<std::streamsize>(width));
    if (!in_) throw error("offset " + std::to_string(at_) + " cannot be read");
    at_ += width;
    std::uint64_t result = 0;
    for (std::size_t b = 0; b < width; ++b) result = result << 8U | static_cast<unsigned char>(bytes[b]);
    return result;
  }

  std::uint64_t count() { return number(version_ == 5 ? 8 : 4); }

  std::uint64_t list(std::uint64_t tag, const std::string& of, std::uint64_t most) {
    const std::uint64_t found = number(4), entries = count();
    if (found != tag && (found != 0 || entries != 0))
      throw error("tag " + std::to_string(found) + " in place of " + std::to_string(tag) + ", a list of " + of);
    if (entries > most) throw error(std::to_string(entries) + " " + of + ", must be at most " + std::to_string(most));
    return entries;
  }

  std::string name(const std::string& of) {
    const std::uint64_t length = count();
    if (length == 0 || length > longest_name)
      throw error("the name of " + of + " has " + std::to_string(length) + " bytes, must be 1 to " +
                  std::to_string(longest_name));
    require_left(padded(length));
    std::string result(length, '\0');
    in_.read(result.data(), static_cast<std::streamsize>(length));
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
    if (!in_ || std::ranges::any_of(result, is_control)) throw error("the name of " + of + " is none");
    skip(padded(length));
    return result;
  }

  std::uint64_t type_size(const std::string& of) {
    const std::uint64_t type = number(4);
    if (type < 1 || type > (version_ == 5 ? 11 : 6)) throw error(of + " has the type " + std::to_string(type));
    return type_sizes[type];
  }

  void attributes() {
    const std::uint64_t entries = list(12, "attributes", most_others);
    for (std::uint64_t a = 0; a < entries; ++a) {
      const std::string of = "attribute " + shown_name(name("an attribute"));
      const std::uint64_t size = type_size(of), bytes = padded(product(size, count()));
      if (bytes > longest_attribute) throw error(of + " has " + std::to_string(bytes) + " bytes");
      skip(bytes);
    }
  }

  void variable() {
    Variable result{name("a variable"), 1, 0, false};
    const std::string of = "variable " + shown_name(result.name);
    const std::uint64_t dimensions = count();
    if (dimensions > most_dimensions) throw error(of + " has " + std::to_string(dimensions) + " dimensions");
    for (std::uint64_t d = 0; d < dimensions; ++d) {
      const std::uint64_t id = count();
      if (id >= lengths_.size()) throw error(of + " has the dimension " + std::to_string(id) + ", which is not there");
      const std::uint64_t length = lengths_[id];
      if (length == 0 && d > 0) throw error(of + " has its records behind another dimension");
      result.records = result.records || length == 0;
      result.bytes = product(result.bytes, length == 0 ? 1 : length);
    }
    attributes();
    result.bytes = product(result.bytes, type_size(of));
    count();  // the same size, or less where it is too large for the field
    result.begin = number(version_ == 1 ? 4 : 8);
    if (result.records) step_ = sum(step_, padded(result.bytes)), ++record_variables_, only_ = result.bytes;
    variables_.push_back(result);
  }

  void require_within(const Variable& one) const {
    std::uint64_t end = sum(one.begin, one.bytes);
    if (one.records && records_ == 0) return;
    if (one.records) end = sum(end, product(records_ - 1, record_variables_ == 1 ? only_ : step_));
    if (one.begin < at_ || end > size_)
      throw error("variable " + shown_name(one.name) + " goes from byte " + std::to_string(one.begin) + " to " +
                  std::to_string(end) + " of a file of " + std::to_string(size_));
  }

  std::string path_;
  std::ifstream in_;
  std::uint64_t size_, at_ = 0, records_ = 0;
  std::uint64_t step_ = 0, only_ = 0, record_variables_ = 0;  // bytes from one record to the next
  unsigned version_ = 0;
  std::vector<std::uint64_t> lengths_;  // 0: that of the records
  std::vector<Variable> variables_;
};

}  // namespace

void require_classic_header(const std::string& path) { Header(path).check(); }

}  // namespace mmbrdf
