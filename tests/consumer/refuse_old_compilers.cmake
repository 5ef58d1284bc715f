# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# A compiler older than the minimum is rejected with its version and the minimum.
#   cmake -D source=DIR -D work=DIR -P refuse_old_compilers.cmake

foreach(old IN ITEMS "GNU;11.4.0;g\\+\\+ 12" "Clang;13.0.1;clang 14")
  list(GET old 0 id)
  list(GET old 1 version)
  list(GET old 2 minimum)
  file(REMOVE_RECURSE ${work})
  # Sets the version instead of detecting it, because no old compiler is installed.
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${work} -G Ninja -D CMAKE_CXX_COMPILER_FORCED=TRUE
                          -D CMAKE_CXX_COMPILER_ID_RUN=TRUE -D CMAKE_CXX_COMPILER_ID=${id}
                          -D CMAKE_CXX_COMPILER_VERSION=${version}
                  RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE message)
  string(REGEX REPLACE "[ \n]+" " " message "${message}")
  if(result EQUAL 0 OR NOT message MATCHES "${version}; tofsmith needs ${minimum} or later")
    message(FATAL_ERROR "expected a refusal of ${id} ${version}, got ${result}: ${message}")
  endif()
endforeach()
