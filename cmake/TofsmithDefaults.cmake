# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Language level, warnings and ccache, shared by every target of the project.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_BUILD_RPATH_USE_ORIGIN ON)  # the same bytes for any build folder

find_program(TOFSMITH_CCACHE ccache)
if(TOFSMITH_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # With this setting ccache serves translation units that use a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      ${TOFSMITH_CCACHE})
endif()

add_library(tofsmith_build_options INTERFACE)
target_compile_features(tofsmith_build_options INTERFACE cxx_std_20)
target_compile_options(tofsmith_build_options INTERFACE
  -Wall -Wextra -Wconversion -Wno-sign-conversion -Wno-missing-field-initializers
  # With contraction, sums would depend on the compiler. Kernels use FMA explicitly.
  -ffp-contract=off
  $<$<BOOL:${TOFSMITH_WERROR}>:-Werror>
  $<$<AND:$<BOOL:${TOFSMITH_CCACHE}>,$<CXX_COMPILER_ID:GNU>>:-fpch-preprocess>)

# Hardening for readers of untrusted files; tests/consumer/hardening_test.py verifies it in installed
# files. Sanitizers check more and cannot be combined with it.
option(TOFSMITH_HARDEN "Compile optimized builds with what hardens them against hostile input" ON)
if(TOFSMITH_HARDEN AND CMAKE_SYSTEM_NAME STREQUAL "Linux" AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang"
   AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(hardening -fstack-protector-strong)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND hardening -fcf-protection)
  elseif(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
    list(APPEND hardening -mbranch-protection=standard)
  endif()
  if(NOT CMAKE_CXX_FLAGS MATCHES "FORTIFY")  # set by a distribution
    list(APPEND hardening -D_FORTIFY_SOURCE=2)
  endif()
  set(optimized "$<CONFIG:Release,RelWithDebInfo,MinSizeRel>")
  target_compile_options(tofsmith_build_options INTERFACE "$<${optimized}:${hardening}>")
  target_link_options(tofsmith_build_options INTERFACE
    "$<${optimized}:LINKER:-z,relro,-z,now,-z,noexecstack>")
endif()

# -O1 in optimized builds, in two thirds of the time of -O3, for code that runs for a shorter time
# than it compiles. Results are the same: no level contracts or reorders sums. At -O1, GCC 12 falsely
# warns that Eigen uses freed temporaries.
set(tofsmith_fast_options "$<$<CONFIG:Release>:-O1;$<$<CXX_COMPILER_ID:GNU>:-Wno-use-after-free>>")
if(TOFSMITH_OPTIMIZE_KERNELS_ONLY)  # src/CMakeLists.txt excepts the kernels
  add_compile_options("${tofsmith_fast_options}")
endif()
# The same for a target in any build.
function(tofsmith_compile_fast target)
  get_target_property(type ${target} TYPE)
  set(scope PRIVATE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    set(scope INTERFACE)
  endif()
  target_compile_options(${target} ${scope} "${tofsmith_fast_options}")
endfunction()
