# NetCDF files are read and written where the library is there; without it the program says so of such a file.
find_path(NETCDF_INCLUDE netcdf.h)
find_library(NETCDF_LIBRARY netcdf)
if(NETCDF_INCLUDE AND NETCDF_LIBRARY)
  set(MMBRDF_HAS_NETCDF ON)
  target_include_directories(mmbrdf SYSTEM PRIVATE ${NETCDF_INCLUDE})
  target_link_libraries(mmbrdf PRIVATE ${CMAKE_DL_LIBS})
  # It is loaded when a file asks for it, under the name that goes with its interface where there is one.
  file(REAL_PATH ${NETCDF_LIBRARY} netcdf)
  string(REGEX REPLACE "^.*/(lib[^/]*[.]so[.][0-9]+)[^/]*$" "\\1" netcdf ${netcdf})
  set_source_files_properties(src/formats/netcdf.cpp src/formats/netcdf_variables.cpp src/formats/netcdf_library.cpp
    src/formats/new_netcdf.cpp PROPERTIES
    COMPILE_DEFINITIONS "MMBRDF_NETCDF=\"${netcdf}\"")
else()
  message(STATUS "NetCDF (libnetcdf-dev) is not there: built without it")
endif()
