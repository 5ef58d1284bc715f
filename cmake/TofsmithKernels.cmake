# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# The kernels of tofsmith::gpu as a text in it, which devices compile; and OpenCL. Included from
# src/CMakeLists.txt.

set(kernel_text)
foreach(file IN ITEMS decode_parameters.h bins.cl planes.cl)
  set(path "${CMAKE_CURRENT_SOURCE_DIR}/gpu/${file}")
  file(READ "${path}" text)
  string(APPEND kernel_text "${text}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${path}")
endforeach()
set(kernel_source "${CMAKE_CURRENT_BINARY_DIR}/decode_kernels.cpp")
file(CONFIGURE OUTPUT "${kernel_source}" @ONLY CONTENT
"#include \"gpu/decode_tables.hpp\"
namespace tofsmith {
const std::string_view decode_kernels = R\"kernels(@kernel_text@)kernels\";
}  // namespace tofsmith
")
target_sources(tofsmith_gpu PRIVATE "${kernel_source}")

if(TOFSMITH_HAS_OPENCL)
  target_link_libraries(tofsmith_gpu PRIVATE OpenCL::OpenCL)
  set_source_files_properties(gpu/opencl.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endif()
