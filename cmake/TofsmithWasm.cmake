# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# For emscripten: core, design and the document readers of io need only header libraries. Debian
# installs them in /usr/include, whose other headers this compiler must not use, so they are linked
# into a separate folder.

set(wasm_headers "${PROJECT_BINARY_DIR}/headers")
file(MAKE_DIRECTORY "${wasm_headers}")
foreach(folder IN ITEMS eigen3/unsupported hwy fmt nlohmann toml++)
  if(NOT EXISTS "/usr/include/${folder}")
    message(FATAL_ERROR "There is no /usr/include/${folder}: scripts/packages.sh installs it")
  endif()
  get_filename_component(name "${folder}" NAME)
  file(CREATE_LINK "/usr/include/${folder}" "${wasm_headers}/${name}" SYMBOLIC)
endforeach()
# Random123 rejects architectures that it does not list, although its portable code fits them.
file(CONFIGURE OUTPUT "${wasm_headers}/Random123/philox.h" CONTENT
     "#define __riscv\n#define R123_USE_SSE 0\n#include \"/usr/include/Random123/philox.h\"\n#undef __riscv\n")
# Eigen uses SSE2 vectors, which emscripten translates (-msse2), so that sums have the same order as
# in native code. It also includes the MMX header, of which it uses nothing, and contains hints for
# GCC's register allocation; both exist only on x86.
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
add_library(Threads::Threads INTERFACE IMPORTED GLOBAL)  # the module is single-threaded
set(HWY_INCLUDE_DIR "${wasm_headers}")
set(RANDOM123_INCLUDE_DIR "${wasm_headers}")
set(TOFSMITH_HAS_TBB OFF)
