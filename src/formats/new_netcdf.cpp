// SPDX-License-Identifier: BSD-3-Clause
#include "formats/new_netcdf.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#ifdef MMBRDF_NETCDF
#include "formats/netcdf_library.hpp"
#endif

namespace mmbrdf {

#ifndef MMBRDF_NETCDF

NewNetcdf::NewNetcdf() {
  throw std::invalid_argument("a NetCDF file, but this build of mmbrdf has no NetCDF; build it with libnetcdf-dev");
}
NewNetcdf::~NewNetcdf() = default;
void NewNetcdf::attribute(const std::string&, const std::string&) {}
void NewNetcdf::axis(const std::string&, std::span<const double>, const Attributes&) {}
void NewNetcdf::axis(const std::string&, std::span<const int>, const Attributes&) {}
void NewNetcdf::variable(const std::string&, const Axes&, std::span<const double>, const Attributes&) {}
void NewNetcdf::flags(const std::string&, const Axes&, std::span<const int>, std::span<const int>, const Attributes&) {}
std::string NewNetcdf::bytes() { return ""; }

#else

NewNetcdf::NewNetcdf() {
  try {
    netcdf_library();
  } catch (const std::runtime_error& e) {
    throw std::invalid_argument(e.what());
  }
  require(netcdf_library()->create_mem("model.nc", NC_NETCDF4 | NC_CLOBBER, 1 << 16, &id_), "a new file");
}

NewNetcdf::~NewNetcdf() {
  if (id_ < 0) return;
  NC_memio memory{};
  if (netcdf_library()->close_memio(id_, &memory) == NC_NOERR) std::free(memory.memory);
}

void NewNetcdf::require(int status, const std::string& what) {
  if (status != NC_NOERR) throw std::runtime_error("NetCDF: " + what + ": " + netcdf_library()->strerror(status));
}

void NewNetcdf::attribute(const std::string& name, const std::string& text) {
  require(netcdf_library()->put_att_text(id_, NC_GLOBAL, name.c_str(), text.size(), text.c_str()), name);
}

void NewNetcdf::length(const std::string& name, std::size_t length) {
  int id = 0;
  require(netcdf_library()->def_dim(id_, name.c_str(), length, &id), name);
  axes_.emplace_back(name, id);
}

int NewNetcdf::define(const std::string& name, int type, const Axes& axes, const Attributes& attributes) {
  std::vector<int> ids;
  for (const std::string& axis : axes)
    ids.push_back(std::ranges::find(axes_, axis, &std::pair<std::string, int>::first)->second);
  int id = 0;
  require(netcdf_library()->def_var(id_, name.c_str(), type, static_cast<int>(ids.size()), ids.data(), &id), name);
  for (const auto& [attribute, text] : attributes)
    require(netcdf_library()->put_att_text(id_, id, attribute.c_str(), text.size(), text.c_str()), name);
  return id;
}

void NewNetcdf::axis(const std::string& name, std::span<const double> values, const Attributes& attributes) {
  length(name, values.size());
  require(netcdf_library()->put_var_double(id_, define(name, NC_DOUBLE, {name}, attributes), values.data()), name);
}

void NewNetcdf::axis(const std::string& name, std::span<const int> values, const Attributes& attributes) {
  length(name, values.size());
  require(netcdf_library()->put_var_int(id_, define(name, NC_INT, {name}, attributes), values.data()), name);
}

void NewNetcdf::variable(const std::string& name, const Axes& axes, std::span<const double> values,
                         const Attributes& attributes) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const int id = define(name, NC_DOUBLE, axes, attributes);
  if (!axes.empty()) {
    require(netcdf_library()->put_att_double(id_, id, "_FillValue", NC_DOUBLE, 1, &nan), name);
    require(netcdf_library()->def_var_deflate(id_, id, 1, 1, 2), name);
  }
  require(netcdf_library()->put_var_double(id_, id, values.data()), name);
}

void NewNetcdf::flags(const std::string& name, const Axes& axes, std::span<const int> values,
                      std::span<const int> masks, const Attributes& attributes) {
  const int id = define(name, NC_INT, axes, attributes);
  require(netcdf_library()->put_att_int(id_, id, "flag_masks", NC_INT, masks.size(), masks.data()), name);
  require(netcdf_library()->def_var_deflate(id_, id, 1, 1, 2), name);
  require(netcdf_library()->put_var_int(id_, id, values.data()), name);
}

std::string NewNetcdf::bytes() {
  NC_memio memory{};
  const int id = std::exchange(id_, -1);
  require(netcdf_library()->close_memio(id, &memory), "the file");
  const std::string result(static_cast<const char*>(memory.memory), memory.size);
  std::free(memory.memory);
  return result;
}

#endif

}  // namespace mmbrdf
