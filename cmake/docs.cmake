# The pages, and the site of them.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT program
  FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN site EXCLUDE)

# The same as a site, where Sphinx is there: target docs makes it, and then it is installed.
if(TARGET mmbrdf_program AND TARGET mmbrdf_python AND PROJECT_IS_TOP_LEVEL)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  add_custom_target(docs COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/docs/site/build.py
    --programs ${PROJECT_BINARY_DIR} --output ${PROJECT_BINARY_DIR}/docs DEPENDS mmbrdf_program mmbrdf_python USES_TERMINAL VERBATIM)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/docs/html DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program OPTIONAL)
endif()
