# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# cmake --install: the library with its headers, CMake package and pkg-config file, the command line
# with its manual pages and shell completion, examples, the licence. Components: library, dev, tool, python.

include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tofsmith)

get_target_property(library_type tofsmith TYPE)
if(library_type STREQUAL "STATIC_LIBRARY")
  set(TOFSMITH_IS_STATIC ON)
else()
  set(TOFSMITH_IS_STATIC OFF)
endif()

install(TARGETS tofsmith EXPORT tofsmithTargets
        LIBRARY COMPONENT library NAMELINK_COMPONENT dev
        ARCHIVE COMPONENT dev)
install(EXPORT tofsmithTargets NAMESPACE tofsmith:: DESTINATION ${package_dir} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/tofsmith ${PROJECT_BINARY_DIR}/include/tofsmith
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev FILES_MATCHING PATTERN "*.hpp")
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/tofsmithConfig.cmake.in ${PROJECT_BINARY_DIR}/tofsmithConfig.cmake
  INSTALL_DESTINATION ${package_dir})
# Before 1.0 a minor version may break its users.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tofsmithConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tofsmithConfig.cmake
              ${PROJECT_BINARY_DIR}/tofsmithConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT dev)
include(TofsmithPkgConfig)

# A Debian package has its licence in a file of Debian's form.
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
  include(TofsmithManual)
endif()
