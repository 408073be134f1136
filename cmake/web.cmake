# The library as WebAssembly, by emscripten (preset web): what the module of web/mmbrdf calls, and no more.
# Rooms that measure and fit are left out, and what writes formats of others; so is what includes them.
list(FILTER sources EXCLUDE REGEX "/src/(fitting|polarimetry)/")
list(FILTER sources EXCLUDE REGEX "/src/formats/(angle_table|export|new_netcdf|transfer[a-z_]*|[a-z]+_export)[.]cpp$")
list(FILTER sources EXCLUDE REGEX "/src/samples/(comparison|inspection|matching|simulation|noise|partition|mirror_pairs)[.]cpp$")
list(FILTER sources EXCLUDE REGEX "/src/files/(instrument_file|readings_file)[.]cpp$")
list(FILTER sources EXCLUDE REGEX
  "/src/quantities/(angle_unit|conventions|fit_warnings|fit_warnings_inspect|plan_like|report|report_samples|significance)[.]cpp$")

# Headers of the two libraries alone: beside others of /usr/include those of emscripten would be hidden.
set(web_headers ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${web_headers})
foreach(library Eigen3::Eigen nlohmann_json::nlohmann_json)
  get_target_property(folders ${library} INTERFACE_INCLUDE_DIRECTORIES)
  foreach(folder IN LISTS folders)
    foreach(name Eigen unsupported nlohmann)
      if(IS_DIRECTORY "${folder}/${name}")
        file(CREATE_LINK ${folder}/${name} ${web_headers}/${name} SYMBOLIC)
      endif()
    endforeach()
  endforeach()
  set_target_properties(${library} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${web_headers})
endforeach()

# A caught error would end the program without the first; the last is what its standard library has not.
add_compile_options(-fexceptions -msimd128 "SHELL:-include ${PROJECT_SOURCE_DIR}/web/mmbrdf/standard_library.hpp")
