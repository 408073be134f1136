// SPDX-License-Identifier: BSD-3-Clause
// Variables of a NetCDF file and their attributes, with complaints that name them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace mmbrdf {

struct NetcdfVariable {
  std::string name;
  int id = 0;
  std::vector<int> dimensions;
  std::vector<double> missing;  ///< each stands for no value
};

class NetcdfFile {
 public:
  /// Throws std::runtime_error for what NetCDF cannot open.
  explicit NetcdfFile(const std::string& path);
  ~NetcdfFile();
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  /// Nothing if there is none of this name. Throws for one that holds no numbers, or packed ones.
  std::optional<NetcdfVariable> variable(const std::string& name) const;

  std::size_t length(int dimension) const;
  std::string dimension_name(int dimension) const;

  /// A text attribute of the variable, or else of the file; empty if there is none.
  std::string text(const NetcdfVariable& variable, const std::string& attribute) const;

  /// Numbers of a block of a variable, in C order; NaN where there is no value.
  void read(const NetcdfVariable& variable, const std::vector<std::size_t>& start,
            const std::vector<std::size_t>& count, std::span<double> values) const;

  /// "path: variable NAME: what", as an error to throw.
  [[nodiscard]] std::runtime_error error(const std::string& variable, const std::string& what) const;

 private:
  void require(int status, const std::string& what) const;
  std::vector<double> missing_values(const std::string& name, int id, int type) const;

  std::string path_;
  int id_ = -1;
};

}  // namespace mmbrdf
