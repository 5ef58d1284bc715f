# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# tofsmith.pc, for `pkg-config --cflags --libs tofsmith`. Included from TofsmithInstall.cmake.

set(pc_requires eigen3)
set(pc_libs)
if(TOFSMITH_IS_STATIC)
  # Not in Requires.private: --static would ask for static builds of these and of all that they use,
  # which Debian does not have.
  list(APPEND pc_requires tbb libhwy fmt tomlplusplus OpenEXR libpng libzip assimp sqlite3)
  list(APPEND pc_libs -lembree3 -pthread)
  if(TOFSMITH_USE_FFTW)
    list(APPEND pc_requires fftw3)
    list(APPEND pc_libs -lfftw3_threads)
  endif()
  if(TOFSMITH_HAS_LXI)
    list(APPEND pc_requires liblxi)
    list(APPEND pc_libs -ltirpc)
  endif()
  if(TOFSMITH_HAS_MPI)
    list(APPEND pc_libs ${MPI_CXX_LIBRARIES})
  endif()
endif()
list(JOIN pc_requires ", " pc_requires)
list(JOIN pc_libs " " pc_libs)
set(pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH pc_to_prefix "/prefix/${pc_dir}" /prefix)
string(REGEX REPLACE "/$" "" pc_to_prefix "${pc_to_prefix}")
configure_file(${PROJECT_SOURCE_DIR}/cmake/tofsmith.pc.in ${PROJECT_BINARY_DIR}/tofsmith.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/tofsmith.pc DESTINATION ${pc_dir} COMPONENT dev)
