# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Whether every name has one definition (the C++ One Definition Rule). Link-time optimization sees
# the types of all translation units at once: the target `odr` merges the objects of the libraries, the
# command line and the Python module, generates no code, and fails where two definitions differ.

option(TOFSMITH_ODR "Compile for the target odr, which compares definitions; GCC only" OFF)
if(NOT TOFSMITH_ODR)
  return()
endif()

set(objects)
list(TRANSFORM TOFSMITH_BUILT_COMPONENTS PREPEND tofsmith_ OUTPUT_VARIABLE libraries)
foreach(target IN LISTS libraries ITEMS tofsmith_paper tofsmith_demo_command
        tofsmith_other_commands tofsmith_cli _tofsmith)
  if(TARGET ${target})
    target_compile_options(${target} PRIVATE -O0 -flto -fno-fat-lto-objects)
    list(APPEND objects "$<FILTER:$<TARGET_OBJECTS:${target}>,EXCLUDE,[.]gch$>")
  endif()
endforeach()
set(merged "${CMAKE_CURRENT_BINARY_DIR}/odr.o")
add_custom_command(OUTPUT "${merged}" DEPENDS ${objects} VERBATIM COMMAND_EXPAND_LISTS
  COMMENT "Comparing definitions"
  COMMAND ${CMAKE_CXX_COMPILER} -O0 -flto -r -nostdlib -Werror=odr -o "${merged}" ${objects})
add_custom_target(odr DEPENDS "${merged}")
