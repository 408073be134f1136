// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mmbrdf/files/model_file.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

/// A value in a file, which knows where it stands: complaints are std::runtime_error with file and path, as in
/// "m.json: blocks[1].coefficients[3]: must be a number, not 'x'".
class Field {
 public:
  Field(const nlohmann::json& value, const std::string& file, std::string path = "")
      : value_(value), file_(file), path_(std::move(path)) {}

  [[noreturn]] void refuse(const std::string& reason) const {
    throw std::runtime_error(file_ + ": " + path_ + (path_.empty() ? "" : ": ") + reason);
  }

  bool has(const std::string& name) const { return object().contains(name); }

  Field operator[](const std::string& name) const {
    const Field child(has(name) ? object().at(name) : value_, file_,
                      (path_.empty() ? "" : path_ + ".") + shown_name(name));
    if (!has(name)) child.refuse("missing");
    return child;
  }

  std::vector<Field> items() const {
    if (!value_.is_array()) refuse("must be an array, not " + shown());
    std::vector<Field> fields;
    for (std::size_t i = 0; i < value_.size(); ++i)
      fields.emplace_back(value_[i], file_, path_ + "[" + std::to_string(i) + "]");
    return fields;
  }

  bool is_null() const { return value_.is_null(); }

  double number() const {
    if (!value_.is_number()) refuse("must be a number, not " + shown());
    return value_.get<double>();
  }

  int integer() const {
    constexpr double largest = 1e6;  // beyond all that is counted here
    if (!value_.is_number_integer() || std::abs(number()) > largest) refuse("must be an integer, not " + shown());
    return value_.get<int>();
  }

  bool boolean() const {
    if (!value_.is_boolean()) refuse("must be true or false, not " + shown());
    return value_.get<bool>();
  }

  std::string text() const {
    if (!value_.is_string()) refuse("must be a string, not " + shown());
    return value_.get<std::string>();
  }

  std::vector<double> numbers() const {
    if (value_.is_array() &&
        std::all_of(value_.begin(), value_.end(), [](const nlohmann::json& v) { return v.is_number(); }))
      return value_.get<std::vector<double>>();
    std::vector<double> values;  // for the message that says which one
    for (const Field& item : items()) values.push_back(item.number());
    return values;
  }

  std::map<std::string, std::string> texts() const {
    std::map<std::string, std::string> result;
    for (const auto& [name, unused] : object().items()) result[name] = (*this)[name].text();
    return result;
  }

  /// A misspelt optional field must not pass for an absent one.
  void require_no_other_than(std::initializer_list<std::string_view> names) const {
    for (const auto& [name, unused] : object().items())
      if (std::find(names.begin(), names.end(), name) == names.end()) (*this)[name].refuse("unknown field");
  }

  void require_equal(const nlohmann::ordered_json& expected) const {
    for (const auto& [name, value] : expected.items())
      if (const Field field = (*this)[name]; field.text() != value)
        field.refuse(field.shown() + " is not supported, only " + value.dump());
  }

  std::string shown() const {
    if (value_.is_structured()) return value_.is_array() ? "an array" : "an object";
    return value_.is_string() ? in_quotes(value_.get_ref<const std::string&>()) : value_.dump();
  }

 private:
  const nlohmann::json& object() const {
    if (!value_.is_object()) refuse("must be an object, not " + shown());
    return value_;
  }

  const nlohmann::json& value_;
  const std::string& file_;
  std::string path_;
};

/// What every file of the project begins with; `fields` are all that there may be.
inline void require_format(const Field& root, const std::string& format, const nlohmann::ordered_json& conventions,
                           const nlohmann::ordered_json& units, std::initializer_list<std::string_view> fields) {
  if (root["format"].text() != format) root["format"].refuse(root["format"].shown() + " is not '" + format + "'");
  if (const int version = root["schema_version"].integer(); version != schema_version)
    root["schema_version"].refuse(std::to_string(version) + ", but this version of mmbrdf reads " +
                                  std::to_string(schema_version));
  root.require_no_other_than(fields);
  root["conventions"].require_equal(conventions);
  root["units"].require_equal(units);
}

/// Runs a check of the library on what a field says; its complaint becomes one about the field.
template <class Check>
auto checked(const Field& field, Check check) {
  try {
    return check();
  } catch (const std::invalid_argument& e) {
    field.refuse(e.what());
  }
}

/// Nothing is saved that nobody could read: runs a reader on what is to be saved.
template <class Read>
void require_readable(Read read) {
  try {
    read();
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(std::string(e.what()) + "; not saved, since it could not be read back");
  }
}

inline void require_count(const Field& field, std::size_t count, std::size_t needed, const std::string& what) {
  if (count != needed)
    field.refuse(std::to_string(count) + " numbers in place of " + std::to_string(needed) + ", " + what);
}

inline Elements read_elements(const Field& field) {
  Elements result;
  for (const Field& item : field.items()) {
    std::size_t e = 0;
    while (e < 16 && item.text() != element_name(e)) ++e;
    if (e == 16) item.refuse(item.shown() + " is none of the elements 11 ... 44");
    result.set(e);
  }
  return result;
}

inline nlohmann::ordered_json elements_json(const Elements& elements) {
  nlohmann::ordered_json result = nlohmann::ordered_json::array();
  for (std::size_t e = 0; e < 16; ++e)
    if (elements[e]) result.push_back(element_name(e));
  return result;
}

/// The square matrix from its lower triangle.
inline std::vector<double> read_covariance(const Field& field, std::size_t size) {
  const std::vector<double> triangle = field.numbers();
  require_count(field, triangle.size(), size * (size + 1) / 2, "the lower triangle");
  std::vector<double> square(size * size);
  auto value = triangle.begin();
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column <= row; ++column)
      square[row * size + column] = square[column * size + row] = *value++;
  for (std::size_t i = 0; i < size; ++i)
    if (square[i * size + i] < 0) field.refuse("variance " + std::to_string(i) + " is negative");
  return square;
}

/// The lower triangle of a covariance, or variances alone.
inline std::vector<double> read_variances(const Field& field, std::size_t size) {
  const std::vector<double> variances = field.numbers();
  if (variances.size() != size) return read_covariance(field, size);
  for (std::size_t i = 0; i < size; ++i)
    if (variances[i] < 0) field.refuse("variance " + std::to_string(i) + " is negative");
  return variances;
}

/// Of a square matrix, row by row with the diagonal.
inline std::vector<double> lower_triangle(const std::vector<double>& square, std::size_t size) {
  std::vector<double> triangle;
  for (std::size_t row = 0; row < size; ++row)
    triangle.insert(triangle.end(), &square[row * size], &square[row * size] + row + 1);
  return triangle;
}

}  // namespace mmbrdf
