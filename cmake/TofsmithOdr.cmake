# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# The target `odr` checks the C++ One Definition Rule. Objects of the libraries, the command line and
# the Python module contain their types as link-time optimization writes them, next to the usual
# code. The target merges these descriptions, generates no code, and fails where two definitions of
# a name differ.

option(TOFSMITH_ODR "Add the target odr, which compares definitions; GCC only" OFF)
if(TOFSMITH_ODR AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(TOFSMITH_HAS_ODR ON)
  string(APPEND CMAKE_CXX_FLAGS " -fno-lto")  # links use the code, not the descriptions
endif()

# Adds the target `odr`. Call it after all other targets are defined.
function(tofsmith_add_odr)
  if(NOT TOFSMITH_HAS_ODR)
    return()
  endif()
  set(objects)
  list(TRANSFORM TOFSMITH_BUILT_COMPONENTS PREPEND tofsmith_ OUTPUT_VARIABLE libraries)
  foreach(target IN LISTS libraries ITEMS tofsmith_demo_command
          tofsmith_other_commands tofsmith_cli _tofsmith)
    if(TARGET ${target})
      target_compile_options(${target} PRIVATE -flto -ffat-lto-objects)
      list(APPEND objects "$<FILTER:$<TARGET_OBJECTS:${target}>,EXCLUDE,[.]gch$>")
    endif()
  endforeach()
  set(merged "${CMAKE_CURRENT_BINARY_DIR}/odr.o")
  add_custom_command(OUTPUT "${merged}" DEPENDS ${objects} VERBATIM COMMAND_EXPAND_LISTS
    COMMENT "Comparing definitions"
    COMMAND ${CMAKE_CXX_COMPILER} -O0 -flto -r -nostdlib -Werror=odr -o "${merged}" ${objects})
  add_custom_target(odr DEPENDS "${merged}")
endfunction()
