# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# tofsmith-<component>.pc for each component and tofsmith.pc for all, for
# `pkg-config --cflags --libs tofsmith-core`. Included from TofsmithInstall.cmake.

# Requires.private is unsuitable: --static would require static builds of these libraries and of
# their dependencies, which Debian does not have.
set(pc_requires_core eigen3)
if(TOFSMITH_IS_STATIC)
  list(APPEND pc_requires_core libhwy fmt)
  set(pc_libs_core -pthread)
  if(TOFSMITH_HAS_TBB)
    list(APPEND pc_requires_core tbb)
  endif()
  if(TOFSMITH_USE_FFTW)
    list(APPEND pc_requires_core fftw3)
    list(APPEND pc_libs_core -lfftw3_threads)
  endif()
  if(TOFSMITH_HAS_OPENCL)
    set(pc_requires_gpu OpenCL)
  endif()
  set(pc_requires_io tbb tomlplusplus OpenEXR libpng zlib libzip yaml-cpp hdf5-serial)
  set(pc_libs_io -lembree${embree_VERSION_MAJOR})
  set(pc_requires_lab libmd)
  set(pc_requires_report zlib)
  set(pc_requires_sweep sqlite3)
endif()

set(pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH pc_to_prefix "/prefix/${pc_dir}" /prefix)
string(REGEX REPLACE "/$" "" pc_to_prefix "${pc_to_prefix}")

function(tofsmith_write_pc name about libs requires part)
  set(pc_name ${name})
  set(pc_about "${about}")
  list(JOIN libs " " pc_libs)
  list(JOIN requires ", " pc_requires)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/tofsmith.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${pc_dir} COMPONENT ${part})
endfunction()

set(pc_all)
foreach(component IN LISTS TOFSMITH_BUILT_COMPONENTS)
  set(requires ${pc_requires_${component}})
  foreach(below IN LISTS tofsmith_${component}_needs)
    list(PREPEND requires "tofsmith-${below} = ${PROJECT_VERSION}")
  endforeach()
  tofsmith_write_pc(tofsmith-${component} "${tofsmith_${component}_about}"
                    "-ltofsmith_${component};${pc_libs_${component}}" "${requires}" ${component}_dev)
  list(APPEND pc_all "tofsmith-${component} = ${PROJECT_VERSION}")
endforeach()
tofsmith_write_pc(tofsmith "all components" "" "${pc_all}" dev)
