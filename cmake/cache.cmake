# Where ccache is installed, a source that was compiled in one folder of the project is not compiled again in another: a fresh
# clone, a second working tree, and continuous integration on a machine that has built the project before.
if(PROJECT_IS_TOP_LEVEL AND NOT EMSCRIPTEN AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(CCACHE ccache)
  if(CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 CCACHE_PCH_EXTSUM=1 CCACHE_EXTRAFILES=${PROJECT_SOURCE_DIR}/cmake/sanitizers.txt
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime   # precompiled headers are new files
      ${CCACHE})
  endif()
endif()

# include_folders(RESULT LIBRARIES...): where those that are targets, and what they link, have their headers.
function(include_folders result)
  set(folders "")
  foreach(library IN LISTS ARGN)
    if(TARGET ${library})
      get_target_property(own ${library} INTERFACE_INCLUDE_DIRECTORIES)
      get_target_property(linked ${library} INTERFACE_LINK_LIBRARIES)
      include_folders(theirs ${linked})
      list(APPEND folders ${own} ${theirs})
    endif()
  endforeach()
  set(${result} ${folders} PARENT_SCOPE)
endfunction()

# precompile(TARGET HEADERS...): target_precompile_headers() of headers from outside the project, which are looked for where the target
# is linked with. What is compiled names the folder that it was made in; sums of the headers tell ccache that
# it is the same in another. Options that CMake hands to the inner compiler of clang have paths that ccache takes as they are; clang
# itself finds what was precompiled beside a header.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  set(CMAKE_CXX_COMPILE_OPTIONS_USE_PCH -include <PCH_HEADER>)
endif()
function(precompile target)
  target_precompile_headers(${target} PRIVATE ${ARGN})
  get_target_property(folder ${target} BINARY_DIR)
  get_target_property(libraries ${target} LINK_LIBRARIES)
  include_folders(folders ${libraries})
  set(sums "")
  foreach(header IN LISTS ARGN)
    string(REGEX MATCH "[^<>./]+" package ${header})    # rapidcheck of <rapidcheck.h> and <rapidcheck/gtest.h>
    find_path(root ${package} PATHS ${folders} NO_DEFAULT_PATH NO_CACHE)   # of two that are installed the one that is read
    find_path(root ${package} NO_CACHE)
    if(NOT root)
      return()   # without sums ccache looks at what was compiled
    endif()
    file(GLOB_RECURSE files ${root}/${package}/*)
    file(GLOB alone ${root}/${package}.h)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${files} ${alone})
    foreach(file IN LISTS files alone)
      file(MD5 ${file} sum)
      string(APPEND sums "${sum}\n")
    endforeach()
    unset(root)
  endforeach()
  foreach(ending gch pch)   # of g++ and of clang
    file(WRITE ${folder}/CMakeFiles/${target}.dir/cmake_pch.hxx.${ending}.sum "${sums}")
  endforeach()
endfunction()
