// SPDX-License-Identifier: BSD-3-Clause
/// Files that lie beside the repository and are no part of it. A test that needs one begins
///   const std::string file = published("PTFE.data.csv");
///   if (file.empty()) GTEST_SKIP() << absent("PTFE.data.csv");
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "given/checkout.hpp"

namespace mmbrdf {

/// Path of `file` in the folder named by an environment variable or, without that, in `beside`, seen from the checkout; empty if there is none.
inline std::string existing(const char* variable, const std::string& beside, const std::string& file) {
  const char* folder = std::getenv(variable);
  const std::filesystem::path path = std::filesystem::path(folder ? folder : in_checkout(beside)) / file;
  return std::filesystem::exists(path) ? path.string() : "";
}

/// The data and coefficients of Germer 2017 (figshare 10.6084/m9.figshare.5417410).
inline std::string published(const std::string& file) {
  return existing("MMBRDF_DATA", "../shared/data/germer2017", file);
}

/// Values computed by other programs: SCATMECH, an independent prototype. The whole file in the folder MMBRDF_REFERENCE
/// or beside the repository, else what of it is in tests/data/; empty if nothing is.
inline std::string reference(const std::string& file) {
  const std::string whole = existing("MMBRDF_REFERENCE", "../shared/reference", file);
  const std::string here = in_checkout("tests/data/" + file);
  return !whole.empty() ? whole : std::filesystem::exists(here) ? here : "";
}

/// The line with which a test is skipped.
inline std::string absent(const std::string& file) {
  return "skipped: the published data are not present (" + file + ")";
}

/// The numbers of a file of comma-separated values below its one line of headings.
inline std::vector<std::vector<double>> read_numbers(const std::string& path) {
  std::ifstream file(path);
  std::string line, field;
  std::getline(file, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    rows.emplace_back();
    while (std::getline(fields, field, ',')) rows.back().push_back(std::stod(field));
  }
  if (rows.empty()) throw std::runtime_error(path + ": no rows");
  return rows;
}

}  // namespace mmbrdf
