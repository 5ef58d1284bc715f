# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# cmake --install: the library, headers, CMake targets and pkg-config file of each component, the
# command line with manual pages and shell completion, examples and the licence. Parts that can be
# installed alone: <component> and <component>_dev, dev, tool, python.

include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tofsmith)

get_target_property(library_type tofsmith_core TYPE)
if(library_type STREQUAL "STATIC_LIBRARY")
  set(TOFSMITH_IS_STATIC ON)
else()
  set(TOFSMITH_IS_STATIC OFF)
endif()

# Dependencies that users of a component must find; for a static library, also its internal ones.
set(finds_core "find_dependency(Eigen3 3.4)")
if(TOFSMITH_IS_STATIC)
  list(APPEND finds_core "find_dependency(Threads)" "find_dependency(HWY)" "find_dependency(fmt)")
  if(TOFSMITH_HAS_TBB)
    list(APPEND finds_core "find_dependency(TBB)")
  endif()
  if(TOFSMITH_USE_FFTW)
    list(APPEND finds_core "find_dependency(PkgConfig)"
         "pkg_check_modules(FFTW REQUIRED QUIET IMPORTED_TARGET fftw3)")
  endif()
  if(TOFSMITH_HAS_OPENCL)
    set(finds_gpu "find_dependency(OpenCL)")
  endif()
  set(finds_io "find_dependency(TBB)" "find_dependency(tomlplusplus)" "find_dependency(OpenEXR)"
      "find_dependency(PNG)" "find_dependency(ZLIB)" "find_dependency(embree ${embree_VERSION})"
      "find_dependency(PkgConfig)"
      "pkg_check_modules(LIBZIP REQUIRED QUIET IMPORTED_TARGET libzip)"
      "pkg_check_modules(YAML_CPP REQUIRED QUIET IMPORTED_TARGET yaml-cpp)"
      "pkg_check_modules(HDF5 REQUIRED QUIET IMPORTED_TARGET hdf5-serial)")
  set(finds_lab "find_dependency(PkgConfig)"
      "pkg_check_modules(LIBMD REQUIRED QUIET IMPORTED_TARGET libmd)")
  set(finds_report "find_dependency(ZLIB)")
  set(finds_sweep "find_dependency(SQLite3)")
endif()

foreach(component IN LISTS TOFSMITH_BUILT_COMPONENTS)
  set(dev ${component}_dev)
  install(TARGETS tofsmith_${component} EXPORT tofsmith_${component}
          LIBRARY COMPONENT ${component} NAMELINK_COMPONENT ${dev}
          ARCHIVE COMPONENT ${dev})
  install(EXPORT tofsmith_${component} NAMESPACE tofsmith:: DESTINATION ${package_dir}
          FILE tofsmith_${component}_targets.cmake COMPONENT ${dev})
  set(dependencies ${PROJECT_BINARY_DIR}/tofsmith_${component}_dependencies.cmake)
  list(JOIN finds_${component} "\n" finds)
  file(CONFIGURE OUTPUT ${dependencies} CONTENT "# Dependencies of tofsmith::${component}.\n@finds@\n" @ONLY)
  install(FILES ${dependencies} DESTINATION ${package_dir} COMPONENT ${dev})
  set(folders ${tofsmith_${component}_folders})
  list(REMOVE_ITEM folders gpu)  # described by one header
  list(TRANSFORM folders PREPEND "${PROJECT_SOURCE_DIR}/include/tofsmith/"
       OUTPUT_VARIABLE headers)
  install(DIRECTORY ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tofsmith COMPONENT ${dev}
          FILES_MATCHING PATTERN "*.hpp")
  install(FILES ${PROJECT_SOURCE_DIR}/include/tofsmith/${component}.hpp
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tofsmith COMPONENT ${dev})
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/include/tofsmith/tofsmith.hpp
              ${PROJECT_BINARY_DIR}/include/tofsmith/version.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tofsmith COMPONENT core_dev)
foreach(component IN LISTS TOFSMITH_ALL_COMPONENTS)
  string(APPEND component_needs "set(_tofsmith_${component}_needs ${tofsmith_${component}_needs})\n")
endforeach()
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/tofsmithConfig.cmake.in ${PROJECT_BINARY_DIR}/tofsmithConfig.cmake
  INSTALL_DESTINATION ${package_dir})
# Before 1.0, minor versions may be incompatible.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tofsmithConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tofsmithConfig.cmake
              ${PROJECT_BINARY_DIR}/tofsmithConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT core_dev)
include(TofsmithPkgConfig)

# Debian packages contain the licence in Debian's format.
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/cpp DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples
        COMPONENT dev FILES_MATCHING PATTERN "[0-9]*.cpp")
if(TARGET _tofsmith)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/python
          DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT python
          FILES_MATCHING PATTERN "[0-9]*.py")
endif()

if(TARGET tofsmith_cli)
  file(RELATIVE_PATH from_bin_to_lib
       ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(tofsmith_cli PROPERTIES INSTALL_RPATH "$ORIGIN/${from_bin_to_lib}")
  install(TARGETS tofsmith_cli COMPONENT tool)
  # `tofsmith lab` copies this page; apps/lab_command.cpp contains its path.
  set(TOFSMITH_LAB_PAGE "" CACHE FILEPATH
      "The page that scripts/lab.sh has made, to be installed; empty: build-lab/lab.html if it is there")
  set(lab_page "${TOFSMITH_LAB_PAGE}")
  if(NOT lab_page)
    set(lab_page "${PROJECT_SOURCE_DIR}/build-lab/lab.html")
    set(lab_page_can_be_missing OPTIONAL)
  endif()
  install(FILES "${lab_page}" DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/tofsmith RENAME lab.html
          COMPONENT tool ${lab_page_can_be_missing})
  include(TofsmithManual)
endif()
