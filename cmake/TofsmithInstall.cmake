# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# cmake --install: the library with its headers and CMake package, the command line, the licence.

include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tofsmith)

install(TARGETS tofsmith EXPORT tofsmithTargets)
install(EXPORT tofsmithTargets NAMESPACE tofsmith:: DESTINATION ${package_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/tofsmith ${PROJECT_BINARY_DIR}/include/tofsmith
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

if(TARGET tofsmith_cli)
  file(RELATIVE_PATH from_bin_to_lib
       ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(tofsmith_cli PROPERTIES INSTALL_RPATH "$ORIGIN/${from_bin_to_lib}")
  install(TARGETS tofsmith_cli)
endif()

get_target_property(library_type tofsmith TYPE)
if(library_type STREQUAL "STATIC_LIBRARY")
  set(TOFSMITH_IS_STATIC ON)
else()
  set(TOFSMITH_IS_STATIC OFF)
endif()
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/tofsmithConfig.cmake.in ${PROJECT_BINARY_DIR}/tofsmithConfig.cmake
  INSTALL_DESTINATION ${package_dir})
# Before 1.0 a minor version may break its users.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tofsmithConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tofsmithConfig.cmake
              ${PROJECT_BINARY_DIR}/tofsmithConfigVersion.cmake
        DESTINATION ${package_dir})
