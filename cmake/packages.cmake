# Debian packages of what is installed, and an archive that runs from any folder: ./dev package, preset package.
set(CPACK_PACKAGE_VENDOR "The mmbrdf contributors")
set(CPACK_PACKAGE_CONTACT "The mmbrdf contributors <mmbrdf@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_FILE ${PROJECT_SOURCE_DIR}/cmake/description.txt)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)

set(CPACK_COMPONENTS_ALL library development program python r)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)   # ./dev leaves out python and r, which belong to an interpreter
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  set(CPACK_COMPONENT_${component}_GROUP ${component})
endforeach()

set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
set(so_version ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})

# debian(COMPONENT PACKAGE "what it is" [DEPENDS ...] [RECOMMENDS ...])
function(debian component package summary)
  cmake_parse_arguments(arg "" "SECTION;DEPENDS;RECOMMENDS" "" ${ARGN})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "Mueller-matrix BRDFs: ${summary}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${arg_DEPENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_RECOMMENDS "${arg_RECOMMENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION "${arg_SECTION}" PARENT_SCOPE)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} RENAME copyright COMPONENT ${component})
endfunction()
find_package(Python3 REQUIRED COMPONENTS Interpreter)
math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
debian(library libmmbrdf${so_version} "library" SECTION libs RECOMMENDS libnetcdf19)
debian(development libmmbrdf-dev "headers for C and C++, modules for Fortran and Octave" SECTION libdevel
  DEPENDS "libmmbrdf${so_version} (= ${PROJECT_VERSION})")
debian(program mmbrdf "program" SECTION science RECOMMENDS libnetcdf19)
debian(python python3-mmbrdf "Python package" SECTION python
  DEPENDS "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy"
  RECOMMENDS "python3-matplotlib, python3-xarray, python3-netcdf4")
debian(r r-other-mmbrdf "R package" SECTION gnu-r DEPENDS "r-base-core, r-api-4.0")

include(CPack)
