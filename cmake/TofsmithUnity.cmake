# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Compiles the sources of a folder in groups, so that the headers and templates they share are read
# and compiled once a group: builds, lint and sanitizers take a third of the time. Tests, the demo
# and packages are built so.

option(TOFSMITH_UNITY "Compile the sources of a folder in groups" OFF)
set(TOFSMITH_UNITY_SOURCES 18 CACHE STRING "Sources in a group at most")

# Left alone are kernels that include themselves once for each SIMD target, and what says so.
function(tofsmith_group_sources target)
  if(NOT TOFSMITH_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(SORT sources)
  set(folders)
  foreach(source IN LISTS sources)
    get_filename_component(path "${source}" ABSOLUTE)
    # Of src/ the folder, whatever the room: rooms are small.
    file(RELATIVE_PATH folder "${CMAKE_CURRENT_SOURCE_DIR}" "${path}")
    string(REGEX REPLACE "/.*" "" folder "${folder}")
    if(folder MATCHES "\\.cpp$")
      get_filename_component(folder "${CMAKE_CURRENT_SOURCE_DIR}" NAME)
    endif()
    file(STRINGS "${path}" kernel REGEX "foreach_target" LIMIT_COUNT 1)
    get_source_file_property(alone "${path}" SKIP_UNITY_BUILD_INCLUSION)
    if(path MATCHES "\\.cpp$" AND NOT kernel AND NOT alone)
      list(APPEND folders ${folder})
      list(APPEND sources_of_${folder} "${path}")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES folders)
  # Groups of a folder are as large as each other, so that no core waits long for the last.
  foreach(folder IN LISTS folders)
    list(LENGTH sources_of_${folder} count)
    math(EXPR groups "(${count} + ${TOFSMITH_UNITY_SOURCES} - 1) / ${TOFSMITH_UNITY_SOURCES}")
    set(place 0)
    foreach(path IN LISTS sources_of_${folder})
      math(EXPR group "${place} * ${groups} / ${count}")
      math(EXPR place "${place} + 1")
      set_source_files_properties("${path}" PROPERTIES UNITY_GROUP "${folder}_${group}")
    endforeach()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
