# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Packs the viewer of reports into one page and compiles it into the library, so that reports need
# no other file. Included from src/CMakeLists.txt.

find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(viewer "${PROJECT_SOURCE_DIR}/viewer")
file(GLOB viewer_files CONFIGURE_DEPENDS "${viewer}/*.js" "${viewer}/*.css" "${viewer}/*.html")
set(viewer_source "${CMAKE_CURRENT_BINARY_DIR}/viewer_page.cpp")
add_custom_command(OUTPUT "${viewer_source}"
  COMMAND Python3::Interpreter "${viewer}/pack.py" --page "${viewer}/report.html"
          --cpp -o "${viewer_source}"
  DEPENDS "${viewer}/pack.py" ${viewer_files} COMMENT "Packing the viewer of reports" VERBATIM)
set_source_files_properties("${viewer_source}" PROPERTIES
  COMPILE_OPTIONS -Wno-overlength-strings SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
target_sources(tofsmith_report PRIVATE "${viewer_source}")
