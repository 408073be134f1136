# Writes OUTPUT, a C++ file that holds the text of each of FILES: see src/files/embedded_materials.hpp.
#   cmake -DOUTPUT=embedded_materials.cpp "-DFILES=a.json;b.json" -P embed_materials.cmake

# Compilers limit a single literal to 65536 bytes; adjacent literals are joined by the compiler.
set(chunk_size 60000)

function(set_literals result file text)
  set(literals "")
  string(LENGTH "${text}" left)
  while(left GREATER chunk_size)
    string(SUBSTRING "${text}" 0 ${chunk_size} chunk)
    string(FIND "${chunk}" "," cut REVERSE)   # at a comma, never inside a character of several bytes
    if(cut LESS 1)
      message(FATAL_ERROR "${file}: no comma within ${chunk_size} bytes")
    endif()
    string(SUBSTRING "${text}" 0 ${cut} chunk)
    string(SUBSTRING "${text}" ${cut} -1 text)
    string(APPEND literals "R\"json(${chunk})json\"\n")
    string(LENGTH "${text}" left)
  endwhile()
  set(${result} "${literals}R\"json(${text})json\"sv" PARENT_SCOPE)
endfunction()

# The posterior is the last field of a file, and begins with its orders.
set(posterior_begins ",\n  \"posterior\": ")
set(entries "")
foreach(file IN LISTS FILES)
  cmake_path(GET file STEM LAST_ONLY name)
  file(READ "${file}" text)
  if(text MATCHES "\\)json\"")
    message(FATAL_ERROR "${file}: the characters )json\" would end the raw string literal")
  endif()
  string(FIND "${text}" "${posterior_begins}" cut)
  set(posterior "")
  if(NOT cut EQUAL -1)
    string(LENGTH "${posterior_begins}" length)
    math(EXPR begin "${cut} + ${length}")
    string(SUBSTRING "${text}" ${begin} -1 posterior)
    string(SUBSTRING "${text}" 0 ${cut} text)
    string(APPEND text "\n}\n")
    if(NOT posterior MATCHES "\n  }\n}\n$" OR NOT posterior MATCHES "^{[ \n]*\"orders\": .([0-9]+), ([0-9]+).,")
      message(FATAL_ERROR "${file}: the posterior does not begin with its orders, or is not the last field")
    endif()
    set(orders "${CMAKE_MATCH_1}, ${CMAKE_MATCH_2}")
    string(LENGTH "${posterior}" length)
    math(EXPR length "${length} - 3")   # without the end of the model
    string(SUBSTRING "${posterior}" 0 ${length} posterior)
  else()
    set(orders "0, 0")
  endif()
  set_literals(head "${file}" "${text}")
  set_literals(tail "${file}" "${posterior}")
  string(APPEND entries "    {\"${name}\"sv,\n${head},\n${tail},\n{${orders}}},\n")
endforeach()

if(entries STREQUAL "")
  set(body "  return {};\n")
else()
  set(body "  static constexpr EmbeddedMaterial all[] = {\n${entries}  };\n  return all;\n")
endif()

file(WRITE "${OUTPUT}" "// Written by cmake/embed_materials.cmake from materials/*.json.
#include \"files/embedded_materials.hpp\"

#pragma GCC diagnostic ignored \"-Woverlength-strings\"   // the joined literals, under -Wpedantic

namespace mmbrdf {

std::span<const EmbeddedMaterial> embedded_materials() {
  using namespace std::string_view_literals;
${body}}

}  // namespace mmbrdf
")
