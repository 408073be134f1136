// SPDX-License-Identifier: BSD-3-Clause
#ifdef MMBRDF_NETCDF

#include "formats/netcdf_library.hpp"

#include <dlfcn.h>

#include <cstdint>

namespace mmbrdf {

NetcdfLibrary::NetcdfLibrary() : handle_(::dlopen(MMBRDF_NETCDF, RTLD_LAZY | RTLD_LOCAL)) {}

NetcdfLibrary::Symbol NetcdfLibrary::found(const char* name) const {
  const Symbol result{handle_ == nullptr ? nullptr : ::dlsym(handle_, name)};
  if (result.address != nullptr) return result;
  const char* const why = ::dlerror();
  throw std::runtime_error(std::string("a NetCDF file, but " MMBRDF_NETCDF ", which it needs, cannot be loaded: ") +
                           (why == nullptr ? "not there" : why) + "; install netCDF-C (Debian: libnetcdf19)");
}

void NetcdfLibrary::hush() const {
  thread_local bool hushed = false;
  if (hushed) return;
  hushed = true;
  using SetAuto = int(std::int64_t stack, void* function, void* data);
  if (void* const set_auto = ::dlsym(handle_, "H5Eset_auto2"))
    reinterpret_cast<SetAuto*>(set_auto)(0, nullptr, nullptr);
}

LockedNetcdf netcdf_library() {
  static const NetcdfLibrary result;
  return LockedNetcdf(result);
}

}  // namespace mmbrdf

#endif
