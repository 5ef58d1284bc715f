# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Puts plotly.js and the report's own style and script into the library, so that reports need no
# file at run time. Included from src/CMakeLists.txt.

find_file(TOFSMITH_PLOTLY_JS plotly.js PATHS /usr/share/python3-plotly
          DOC "plotly.js, not minified; Debian: python3-plotly")
if(NOT TOFSMITH_PLOTLY_JS)
  message(FATAL_ERROR "plotly.js is missing: apt-get install python3-plotly, "
                      "or give its path with -DTOFSMITH_PLOTLY_JS=FILE")
endif()
find_program(TOFSMITH_ESBUILD esbuild DOC "Minifies plotly.js; Debian: esbuild")
if(NOT TOFSMITH_ESBUILD)
  message(FATAL_ERROR "esbuild is missing: apt-get install esbuild")
endif()

# The licence comment is the head of the file; the minifier drops it, so it goes in as a banner.
file(STRINGS "${TOFSMITH_PLOTLY_JS}" plotly_head LIMIT_COUNT 6)
list(FILTER plotly_head INCLUDE REGEX "^/?\\*")
list(JOIN plotly_head " " plotly_licence)  # a command takes no line break
if(NOT plotly_licence MATCHES "plotly\\.js v.*MIT license")
  message(FATAL_ERROR "${TOFSMITH_PLOTLY_JS} does not start with plotly.js' MIT licence")
endif()

set(plotly_minified "${CMAKE_CURRENT_BINARY_DIR}/plotly.min.js")
add_custom_command(OUTPUT "${plotly_minified}.gz"
  COMMAND "${TOFSMITH_ESBUILD}" "${TOFSMITH_PLOTLY_JS}" --minify "--banner:js=${plotly_licence}"
          "--outfile=${plotly_minified}" --log-level=warning
  COMMAND gzip -9nkf "${plotly_minified}"  # without name and time: the same bytes each time
  BYPRODUCTS "${plotly_minified}"
  DEPENDS "${TOFSMITH_PLOTLY_JS}" COMMENT "Minifying plotly.js" VERBATIM)

# An assembler file takes bytes as they are and at once; a C++ array of 4 MB takes a minute.
enable_language(ASM)
set(resource_files)
set(assembler ".section .rodata\n")
set(report "${CMAKE_CURRENT_SOURCE_DIR}/report")
set(resources "plotly_js" "${plotly_minified}.gz"
              "plotly_licences" "${report}/plotly_licences.js"
              "page_css" "${report}/page.css"
              "page_js" "${report}/page.js")
while(resources)
  list(POP_FRONT resources name file)
  list(APPEND resource_files "${file}")
  string(APPEND assembler
    ".global tofsmith_resource_${name}\n.hidden tofsmith_resource_${name}\n"
    ".global tofsmith_resource_${name}_end\n.hidden tofsmith_resource_${name}_end\n"
    "tofsmith_resource_${name}:\n.incbin \"${file}\"\ntofsmith_resource_${name}_end:\n.byte 0\n")
endwhile()
string(APPEND assembler ".section .note.GNU-stack,\"\",%progbits\n")
set(resource_assembler "${CMAKE_CURRENT_BINARY_DIR}/report_resources.s")
file(CONFIGURE OUTPUT "${resource_assembler}" CONTENT "${assembler}" @ONLY)
set_source_files_properties("${resource_assembler}" PROPERTIES OBJECT_DEPENDS "${resource_files}")

# A target of its own: the C++ warning options mean nothing to an assembler.
add_library(tofsmith_report_resources OBJECT "${resource_assembler}")
target_sources(tofsmith_report PRIVATE $<TARGET_OBJECTS:tofsmith_report_resources>)
