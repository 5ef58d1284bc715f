# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# A compiler for 32 bits is rejected with a message.
#   cmake -D source=DIR -D work=DIR -D compiler=CXX -P refuse_32_bit.cmake

file(REMOVE_RECURSE ${work})
# Sets the pointer size instead of detecting it, because few machines have 32-bit libraries.
execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${work} -G Ninja
                        -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_CXX_COMPILER_WORKS=TRUE
                        -D CMAKE_CXX_ABI_COMPILED=TRUE -D CMAKE_SIZEOF_VOID_P=4
                RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE message)
string(REGEX REPLACE "[ \n]+" " " message "${message}")
if(result EQUAL 0 OR NOT message MATCHES "tofsmith needs a 64-bit processor and compiler.*32-bit pointers")
  message(FATAL_ERROR "expected a refusal, got ${result}: ${message}")
endif()
