# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Compiles the sources of a folder in groups, so that the headers they share are read once a group:
# builds, lint and sanitizers take a third of the time. Tests, the demo and packages are built so.

option(TOFSMITH_UNITY "Compile the sources of a folder in groups" OFF)
set(TOFSMITH_UNITY_SOURCES 8 CACHE STRING "Sources in a group")

# Left alone are kernels that include themselves once for each SIMD target, and the paper's figures,
# programs of their own with settings of one name.
function(tofsmith_group_sources target)
  if(NOT TOFSMITH_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(SORT sources)
  foreach(source IN LISTS sources)
    get_filename_component(path "${source}" ABSOLUTE)
    get_filename_component(name "${path}" NAME)
    get_filename_component(folder "${path}" DIRECTORY)
    get_filename_component(folder "${folder}" NAME)
    file(STRINGS "${path}" kernel REGEX "foreach_target" LIMIT_COUNT 1)
    if(NOT path MATCHES "\\.cpp$" OR kernel OR name MATCHES "^fig[0-9]")
      continue()
    endif()
    if(NOT DEFINED ${folder}_count)
      set(${folder}_count 0)
    endif()
    math(EXPR chunk "${${folder}_count} / ${TOFSMITH_UNITY_SOURCES}")
    math(EXPR ${folder}_count "${${folder}_count} + 1")
    set_source_files_properties("${path}" PROPERTIES UNITY_GROUP "${folder}_${chunk}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
