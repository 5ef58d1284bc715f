# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Adds the sources of the kernels as strings to tofsmith::gpu, for compilation on devices, and links
# OpenCL. Included from src/CMakeLists.txt.

# Adds NAME, a string declared in HEADER: kernel_parameters.h, numbers.cl and the given files.
function(tofsmith_add_kernels name header)
  set(kernel_text)
  foreach(file kernel_parameters.h numbers.cl ${ARGN})
    set(path "${CMAKE_CURRENT_SOURCE_DIR}/gpu/${file}")
    file(READ "${path}" text)
    string(APPEND kernel_text "${text}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${path}")
  endforeach()
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp")
  file(CONFIGURE OUTPUT "${source}" @ONLY CONTENT
"#include \"gpu/@header@\"
namespace tofsmith {
const std::string_view @name@ = R\"kernels(@kernel_text@)kernels\";
}  // namespace tofsmith
")
  target_sources(tofsmith_gpu PRIVATE "${source}")
endfunction()

tofsmith_add_kernels(decode_kernels device_tables.hpp bins.cl planes.cl)
tofsmith_add_kernels(filter_kernels device_tables.hpp windows.cl slopes.cl)
tofsmith_add_kernels(time_kernels device_time_filter.hpp time.cl)
tofsmith_add_kernels(mean_kernels device_raw.hpp means.cl)

if(TOFSMITH_HAS_OPENCL)
  target_link_libraries(tofsmith_gpu PRIVATE OpenCL::OpenCL)
  set_source_files_properties(gpu/opencl.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endif()
