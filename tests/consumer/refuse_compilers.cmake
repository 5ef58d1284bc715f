# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# A compiler for 32 bits, or older than the minimum, is rejected with a message.
#   cmake -D source=DIR -D work=DIR -D compiler=CXX -P refuse_compilers.cmake

# The arguments replace what CMake would detect, because few machines have such compilers.
function(expect_refusal expected)
  file(REMOVE_RECURSE ${work})
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${work} -G Ninja ${ARGN}
                  RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE message)
  string(REGEX REPLACE "[ \n]+" " " message "${message}")
  if(result EQUAL 0 OR NOT message MATCHES "${expected}")
    message(FATAL_ERROR "expected a refusal with ${expected}, got ${result}: ${message}")
  endif()
endfunction()

expect_refusal("tofsmith needs a 64-bit processor and compiler.*32-bit pointers"
               -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_CXX_COMPILER_WORKS=TRUE
               -D CMAKE_CXX_ABI_COMPILED=TRUE -D CMAKE_SIZEOF_VOID_P=4)
set(is_old -D CMAKE_CXX_COMPILER_FORCED=TRUE -D CMAKE_CXX_COMPILER_ID_RUN=TRUE)
expect_refusal("11.4.0; tofsmith needs g\\+\\+ 12 or later" ${is_old}
               -D CMAKE_CXX_COMPILER_ID=GNU -D CMAKE_CXX_COMPILER_VERSION=11.4.0)
expect_refusal("13.0.1; tofsmith needs clang 14 or later" ${is_old}
               -D CMAKE_CXX_COMPILER_ID=Clang -D CMAKE_CXX_COMPILER_VERSION=13.0.1)
