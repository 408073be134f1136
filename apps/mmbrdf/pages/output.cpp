// SPDX-License-Identifier: BSD-3-Clause
#include "pages/output.hpp"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace mmbrdf::program {

namespace {

std::string written;  // "; m.json is written"

}  // namespace

void flush_output() {
  errno = std::cout ? 0 : errno;
  std::cout.flush();
  if (!std::cout) {
    throw std::runtime_error(std::string("standard output: cannot write") +
                             (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
  }
}

void note_written(const std::string& path) { written += "; " + path + " is written"; }

void say_failure(const std::string& message) { say(message + written); }

void say(const std::string& message) {
  constexpr std::size_t longest = 4000;
  std::cerr << "mmbrdf: " + printable(message, longest) + '\n';
}

void warn(const std::string& message) { say("warning: " + message); }

void note(const std::string& message) { say("note: " + message); }

std::string format(const char* pattern, ...) {
  std::array<char, 512> buffer{};
  std::va_list values;
  va_start(values, pattern);
  const int size = std::vsnprintf(buffer.data(), buffer.size(), pattern, values);
  va_end(values);
  if (size < 0 || static_cast<std::size_t>(size) >= buffer.size())
    throw std::logic_error(std::string("format: the text is too long for ") + pattern);
  return std::string(buffer.data(), static_cast<std::size_t>(size));
}

std::string exact(double value) {
  std::string text;
  append_exact(text, value);
  return text;
}

std::string brief(double value) { return format("%.10g", value); }

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) text += (i > 0 ? between : "") + words[i];
  return text;
}

std::string element_columns(bool normalized) {
  std::string text;
  for (std::size_t element = 0; element < 16; ++element)
    text += (normalized && element > 0 ? ",m" : ",f") + element_name(element);
  return text;
}

void append_elements(std::string& text, const Mueller& m) {
  for (const double value : m.elements) {
    text += ',';
    if (!std::isnan(value)) append_exact(text, value);  // else it was not measured
  }
}

Mueller normalized_beside_f11(const Mueller& f) {
  Mueller m = normalized(f);
  m(0, 0) = f(0, 0);
  return m;
}

}  // namespace mmbrdf::program
