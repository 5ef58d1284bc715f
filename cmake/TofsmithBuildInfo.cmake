# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Writes the data of build_info() and `tofsmith --version`. Each build looks up the commit and stores
# it in a separate source file, so that a new commit compiles only that file and links. Included
# from src/CMakeLists.txt.

set(TOFSMITH_COMMIT "" CACHE STRING "The commit to name; empty: ask git")
set(commit_source "${CMAKE_CURRENT_BINARY_DIR}/build_commit.cpp")
set(write_commit ${CMAKE_COMMAND} -D "source=${PROJECT_SOURCE_DIR}" -D "output=${commit_source}"
                 -D "commit=${TOFSMITH_COMMIT}" -P "${PROJECT_SOURCE_DIR}/cmake/build_commit.cmake")
execute_process(COMMAND ${write_commit} COMMAND_ERROR_IS_FATAL ANY)  # for lint, which builds nothing
add_custom_target(tofsmith_build_commit BYPRODUCTS "${commit_source}"
                  COMMAND ${write_commit} COMMENT "Looking up the commit" VERBATIM)
add_dependencies(tofsmith_core tofsmith_build_commit)
target_sources(tofsmith_core PRIVATE "${commit_source}")
set_source_files_properties("${commit_source}" PROPERTIES
  SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)

get_target_property(library_type tofsmith_core TYPE)
set(library_is_shared OFF)
if(library_type STREQUAL "SHARED_LIBRARY")
  set(library_is_shared ON)
endif()
set_source_files_properties(core/build_info.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON
  COMPILE_DEFINITIONS "TOFSMITH_BUILD_COMPILER=\"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\";TOFSMITH_BUILD_TYPE=\"$<CONFIG>\";TOFSMITH_BUILD_SHARED=$<BOOL:${library_is_shared}>;TOFSMITH_BUILD_TBB=$<BOOL:${TOFSMITH_HAS_TBB}>;TOFSMITH_BUILD_FFTW=$<BOOL:${TOFSMITH_USE_FFTW}>")
