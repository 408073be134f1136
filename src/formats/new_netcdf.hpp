// SPDX-License-Identifier: BSD-3-Clause
// A NetCDF-4 file that is made in memory: doubles and 32-bit integers over fixed axes, and attributes of text, which all
// tools of the field read.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace mmbrdf {

class NewNetcdf {
 public:
  using Attributes = std::vector<std::pair<std::string, std::string>>;
  using Axes = std::vector<std::string>;

  /// Throws std::invalid_argument if netCDF-C is not there, or this build is without it. All else throws
  /// std::runtime_error with what the library says.
  NewNetcdf();
  ~NewNetcdf();
  NewNetcdf(const NewNetcdf&) = delete;
  NewNetcdf& operator=(const NewNetcdf&) = delete;

  /// Of the file.
  void attribute(const std::string& name, const std::string& text);

  /// An axis, and the variable of its name.
  void axis(const std::string& name, std::span<const double> values, const Attributes& attributes);
  void axis(const std::string& name, std::span<const int> values, const Attributes& attributes);

  /// In C order, _FillValue NaN, deflated; none of axes for one number.
  void variable(const std::string& name, const Axes& axes, std::span<const double> values,
                const Attributes& attributes);

  /// Of flags: bits and their names.
  void flags(const std::string& name, const Axes& axes, std::span<const int> values, std::span<const int> masks,
             const Attributes& attributes);

  /// Ends it; once.
  std::string bytes();

 private:
  int define(const std::string& name, int type, const Axes& axes, const Attributes& attributes);
  void length(const std::string& name, std::size_t length);
  static void require(int status, const std::string& what);

  [[maybe_unused]] int id_ = -1;
  std::vector<std::pair<std::string, int>> axes_;
};

}  // namespace mmbrdf
