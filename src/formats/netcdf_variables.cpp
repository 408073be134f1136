// SPDX-License-Identifier: BSD-3-Clause
#include "formats/netcdf_variables.hpp"

#ifdef MMBRDF_NETCDF

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "formats/netcdf_header.hpp"
#include "formats/netcdf_library.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

const std::map<int, double> default_fills{{NC_SHORT, NC_FILL_SHORT},
                                          {NC_USHORT, NC_FILL_USHORT},
                                          {NC_INT, NC_FILL_INT},
                                          {NC_UINT, NC_FILL_UINT},
                                          {NC_INT64, static_cast<double>(NC_FILL_INT64)},
                                          {NC_UINT64, static_cast<double>(NC_FILL_UINT64)},
                                          {NC_FLOAT, static_cast<double>(NC_FILL_FLOAT)},
                                          {NC_DOUBLE, NC_FILL_DOUBLE}};

/// Locked until the end of the expression that this is in.
LockedNetcdf library() { return netcdf_library(); }

}  // namespace

NetcdfFile::NetcdfFile(const std::string& path) : path_(path) {
  require_classic_header(path);
  try {
    library();
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(path + ": " + e.what());
  }
  // Absolute, so that no name of a file is taken for an address.
  if (const int status = library()->open(std::filesystem::absolute(path).c_str(), NC_NOWRITE, &id_); status != NC_NOERR)
    throw std::runtime_error(path + ": not to be opened as NetCDF: " + library()->strerror(status) + "; cut off?");
}

NetcdfFile::~NetcdfFile() { library()->close(id_); }

void NetcdfFile::require(int status, const std::string& what) const {
  if (status != NC_NOERR) throw std::runtime_error(path_ + ": " + what + ": " + library()->strerror(status));
}

std::optional<NetcdfVariable> NetcdfFile::variable(const std::string& name) const {
  NetcdfVariable result{name, 0, {}, {}};
  const int status = library()->inq_varid(id_, name.c_str(), &result.id);
  if (status == NC_ENOTVAR) return {};
  require(status, name);
  nc_type type = NC_NAT;
  int count = 0;
  require(library()->inq_var(id_, result.id, nullptr, &type, &count, nullptr, nullptr), name);
  result.dimensions.resize(static_cast<std::size_t>(count));
  require(library()->inq_vardimid(id_, result.id, result.dimensions.data()), name);
  if (type == NC_CHAR || type == NC_STRING || type > NC_STRING) throw error(name, "holds no numbers");
  for (const char* packed : {"scale_factor", "add_offset"})
    if (library()->inq_att(id_, result.id, packed, nullptr, nullptr) == NC_NOERR)
      throw error(name, std::string(packed) + ": packed numbers cannot be read; write them unpacked");
  result.missing = missing_values(name, result.id, type);
  return result;
}

// As xarray and netCDF4 of Python mask them: a default fill value only where there is no other, of bytes none.
std::vector<double> NetcdfFile::missing_values(const std::string& name, int id, int type) const {
  constexpr std::size_t most = 1000;
  std::vector<double> result;
  bool filled = false;
  for (const char* attribute : {"_FillValue", "missing_value"}) {
    std::size_t length = 0;
    if (library()->inq_attlen(id_, id, attribute, &length) != NC_NOERR || length == 0) continue;
    if (length > most) throw error(name, std::string(attribute) + " has " + std::to_string(length) + " values");
    std::vector<double> values(length);
    require(library()->get_att_double(id_, id, attribute, values.data()), name + ": " + attribute);
    filled = filled || attribute[0] == '_';
    result.insert(result.end(), values.begin(), values.end());
  }
  if (!filled && default_fills.contains(type)) result.push_back(default_fills.at(type));
  if (type == NC_FLOAT)  // as numbers of the variable are
    for (double& value : result)
      if (std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()))
        value = static_cast<double>(static_cast<float>(value));
  return result;
}

std::size_t NetcdfFile::length(int dimension) const {
  std::size_t result = 0;
  require(library()->inq_dimlen(id_, dimension, &result), "a dimension");
  return result;
}

std::string NetcdfFile::dimension_name(int dimension) const {
  std::array<char, NC_MAX_NAME + 1> name{};
  require(library()->inq_dimname(id_, dimension, name.data()), "a dimension");
  return name.data();
}

std::string NetcdfFile::text(const NetcdfVariable& variable, const std::string& attribute) const {
  constexpr std::size_t longest = 65535;
  for (const int where : {variable.id, NC_GLOBAL}) {
    nc_type type = NC_NAT;
    std::size_t length = 0;
    if (library()->inq_att(id_, where, attribute.c_str(), &type, &length) != NC_NOERR) continue;
    if (type == NC_CHAR && length <= longest) {
      std::string result(length, '\0');
      require(library()->get_att_text(id_, where, attribute.c_str(), result.data()), attribute);
      return result.substr(0, result.find('\0'));
    }
    if (type == NC_STRING && length == 1) {
      char* one = nullptr;
      require(library()->get_att_string(id_, where, attribute.c_str(), &one), attribute);
      const std::string result = one == nullptr ? "" : one;
      library()->free_string(1, &one);
      return result;
    }
    throw error(variable.name, "attribute " + attribute + " is no text");
  }
  return "";
}

void NetcdfFile::read(const NetcdfVariable& variable, const std::vector<std::size_t>& start,
                      const std::vector<std::size_t>& count, std::span<double> values) const {
  const int status = library()->get_vara_double(id_, variable.id, start.data(), count.data(), values.data());
  if (status != NC_NOERR && status != NC_ERANGE)
    throw error(variable.name, std::string(library()->strerror(status)) + ": cut off?");
  for (double& value : values)
    if (std::ranges::find(variable.missing, value) != variable.missing.end())
      value = std::numeric_limits<double>::quiet_NaN();
}

std::runtime_error NetcdfFile::error(const std::string& variable, const std::string& what) const {
  return std::runtime_error(path_ + ": variable " + shown_name(variable) + ": " + what);
}

}  // namespace mmbrdf

#endif
