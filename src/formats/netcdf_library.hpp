// SPDX-License-Identifier: BSD-3-Clause
// netCDF-C, which is loaded when a file asks for it. For sources that are compiled with MMBRDF_NETCDF, its name.
#pragma once

#include <netcdf.h>
#include <netcdf_mem.h>

#include <mutex>
#include <stdexcept>
#include <string>

namespace mmbrdf {

/// Its functions, loaded with the first file: it and some forty libraries that it needs take a program ten times as
/// long to start as all else.
class NetcdfLibrary {
  void* handle_;

  struct Symbol {
    void* address;
    template <class Function>
    operator Function*() const {
      return reinterpret_cast<Function*>(address);
    }
  };
  /// Throws std::runtime_error if it is not there.
  Symbol found(const char* name) const;

 public:
  NetcdfLibrary();

  decltype(&::nc_close) close = found("nc_close");
  decltype(&::nc_close_memio) close_memio = found("nc_close_memio");
  decltype(&::nc_create_mem) create_mem = found("nc_create_mem");
  decltype(&::nc_def_dim) def_dim = found("nc_def_dim");
  decltype(&::nc_def_var) def_var = found("nc_def_var");
  decltype(&::nc_def_var_deflate) def_var_deflate = found("nc_def_var_deflate");
  decltype(&::nc_free_string) free_string = found("nc_free_string");
  decltype(&::nc_get_att_double) get_att_double = found("nc_get_att_double");
  decltype(&::nc_get_att_string) get_att_string = found("nc_get_att_string");
  decltype(&::nc_get_att_text) get_att_text = found("nc_get_att_text");
  decltype(&::nc_get_vara_double) get_vara_double = found("nc_get_vara_double");
  decltype(&::nc_inq_att) inq_att = found("nc_inq_att");
  decltype(&::nc_inq_attlen) inq_attlen = found("nc_inq_attlen");
  decltype(&::nc_inq_dimlen) inq_dimlen = found("nc_inq_dimlen");
  decltype(&::nc_inq_dimname) inq_dimname = found("nc_inq_dimname");
  decltype(&::nc_inq_var) inq_var = found("nc_inq_var");
  decltype(&::nc_inq_vardimid) inq_vardimid = found("nc_inq_vardimid");
  decltype(&::nc_inq_varid) inq_varid = found("nc_inq_varid");
  decltype(&::nc_open) open = found("nc_open");
  decltype(&::nc_put_att_double) put_att_double = found("nc_put_att_double");
  decltype(&::nc_put_att_int) put_att_int = found("nc_put_att_int");
  decltype(&::nc_put_att_text) put_att_text = found("nc_put_att_text");
  decltype(&::nc_put_var_double) put_var_double = found("nc_put_var_double");
  decltype(&::nc_put_var_int) put_var_int = found("nc_put_var_int");
  decltype(&::nc_strerror) strerror = found("nc_strerror");

  /// HDF5 writes pages about errors that netCDF-C expects, in each thread that has not forbidden it.
  void hush() const;
};

/// The library, for one thread at a time: neither it nor HDF5 below it can be used by more.
class LockedNetcdf {
 public:
  const NetcdfLibrary* operator->() const { return &library_; }

 private:
  friend LockedNetcdf netcdf_library();
  explicit LockedNetcdf(const NetcdfLibrary& library) : library_(library) { library_.hush(); }
  static std::recursive_mutex& mutex() {
    static std::recursive_mutex result;
    return result;
  }
  std::unique_lock<std::recursive_mutex> lock_{mutex()};
  const NetcdfLibrary& library_;
};

/// Locked until the end of the expression that this is in. Throws std::runtime_error, naming the package, if it cannot be
/// loaded.
LockedNetcdf netcdf_library();

}  // namespace mmbrdf
