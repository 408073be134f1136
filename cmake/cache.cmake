# Where ccache is installed, a source that was compiled in one folder of the project is not compiled again in another: a fresh
# clone, a second working tree, and continuous integration on a machine that has built the project before.
if(PROJECT_IS_TOP_LEVEL AND NOT EMSCRIPTEN AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(CCACHE ccache)
  if(CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime   # precompiled headers are new files
      ${CCACHE})
  endif()
endif()
