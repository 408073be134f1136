// SPDX-License-Identifier: BSD-3-Clause
// Text line by line, and word by word.
#pragma once

#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace mmbrdf {

inline constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";  // of UTF-8, which texts may begin with

/// Radians: an angle of a text has few digits of π/2 and 2π.
inline constexpr double few_digits = 1e-4;

class TextFile {
 public:
  explicit TextFile(const std::string& path);

  /// The next line that is not empty, without blanks around it; false at the end.
  bool next();
  std::string_view line() const { return line_; }

  /// "; its last line has no end: is it complete?" behind the last line if that is so; else nothing.
  std::string end_note() const { return ended_ ? "" : "; its last line has no end: is it complete?"; }

  /// The next word of this line or the next ones; empty at the end. Words of a comment, from `comment` to the end of the
  /// line, are none. Valid until the next call.
  std::string_view word(char comment);

  /// What is left of the line of the last word.
  void skip_line() { rest_ = {}; }

  /// "file:line: what", as an error to throw.
  [[nodiscard]] std::runtime_error error(const std::string& what) const;

  /// A finite number; `what` says what it is. Throws as error().
  double number(std::string_view text, const std::string& what) const;

 private:
  std::string path_, text_;
  std::ifstream in_;
  std::string_view line_, rest_;
  long number_ = 0;
  bool ended_ = true;
};

/// Parts between commas, or else between blanks, without blanks around them. A comma at the end ends the last part.
std::vector<std::string_view> fields(std::string_view line);

/// The first word of each line of a text begins so and is followed by a blank or the line's end: tells formats of
/// keywords. Nothing that is not text has any.
bool has_keyword(std::string_view head, std::string_view keyword);

bool same_word(std::string_view a, std::string_view b);  ///< in any case

}  // namespace mmbrdf
