# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# For emscripten: what core, design and the documents of io need are libraries of headers, which
# Debian installs beside the system's own. They are linked into a folder of their own, since the
# rest of /usr/include is not for this compiler.

set(wasm_headers "${PROJECT_BINARY_DIR}/headers")
file(MAKE_DIRECTORY "${wasm_headers}")
foreach(folder IN ITEMS eigen3/unsupported hwy fmt nlohmann toml++)
  if(NOT EXISTS "/usr/include/${folder}")
    message(FATAL_ERROR "There is no /usr/include/${folder}: scripts/packages.sh installs it")
  endif()
  get_filename_component(name "${folder}" NAME)
  file(CREATE_LINK "/usr/include/${folder}" "${wasm_headers}/${name}" SYMBOLIC)
endforeach()
# Random123 refuses architectures that it does not list, before it takes the code for all of them.
file(CONFIGURE OUTPUT "${wasm_headers}/Random123/philox.h" CONTENT
     "#define __riscv\n#define R123_USE_SSE 0\n#include \"/usr/include/Random123/philox.h\"\n#undef __riscv\n")
# Eigen takes the vectors of SSE2, which emscripten translates (-msse2): sums then have the order
# that they have natively. What it asks for beside them that only an x86 has are the header of MMX,
# of which it needs nothing, and hints to GCC's allocation of registers.
if(NOT EXISTS "${wasm_headers}/mmintrin.h")
  file(COPY /usr/include/eigen3/Eigen DESTINATION "${wasm_headers}")
  set(with_hints "${wasm_headers}/Eigen/src/Core/products/GeneralBlockPanelKernel.h")
  file(READ "${with_hints}" text)
  string(REPLACE "EIGEN_GNUC_AT_LEAST(6,0) && defined(EIGEN_VECTORIZE_SSE)" "0" text "${text}")
  file(WRITE "${with_hints}" "${text}")
  file(WRITE "${wasm_headers}/mmintrin.h" "")
endif()

add_library(tofsmith_wasm_headers INTERFACE IMPORTED GLOBAL)
target_include_directories(tofsmith_wasm_headers SYSTEM INTERFACE "${wasm_headers}")
target_compile_definitions(tofsmith_wasm_headers INTERFACE FMT_HEADER_ONLY HWY_COMPILE_ONLY_EMU128)
foreach(library IN ITEMS Eigen3::Eigen hwy::hwy fmt::fmt nlohmann_json::nlohmann_json
                         tomlplusplus::tomlplusplus)
  add_library(${library} INTERFACE IMPORTED GLOBAL)
  target_link_libraries(${library} INTERFACE tofsmith_wasm_headers)
endforeach()
add_library(Threads::Threads INTERFACE IMPORTED GLOBAL)  # all work is done in one thread
set(HWY_INCLUDE_DIR "${wasm_headers}")
set(RANDOM123_INCLUDE_DIR "${wasm_headers}")
set(TOFSMITH_HAS_TBB OFF)
