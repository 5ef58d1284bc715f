# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# cpack: Debian packages of each component and its headers, the command line and the Python package.
# scripts/package.sh configures a build for it and runs it.

set(TOFSMITH_MAINTAINER "The tofsmith authors <authors@tofsmith.invalid>" CACHE STRING
    "Maintainer of the Debian packages")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "The tofsmith authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "coding functions of time-of-flight cameras")
set(CPACK_PACKAGE_CONTACT "${TOFSMITH_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX "${CMAKE_INSTALL_PREFIX}")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
    GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
if(CMAKE_CROSSCOMPILING AND CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
endif()
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/src")

get_target_property(abi_version tofsmith_core SOVERSION)
set(same_version "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
set(about "tofsmith finds, judges and uses the coding functions of continuous-wave
time-of-flight cameras: it designs modulation and demodulation waveforms for a
camera, simulates scenes with them and decodes raw measurements into depth.")

# For each component its library, libtofsmith-core0.1, and its headers, libtofsmith-core-dev.
set(libraries)
set(development)
foreach(component IN LISTS TOFSMITH_BUILT_COMPONENTS)
  string(TOUPPER "${component}" upper)
  set(library_package "libtofsmith-${component}${abi_version}")
  set(below_libraries)
  set(below_development "${library_package} ${same_version}")
  foreach(below IN LISTS tofsmith_${component}_needs)
    list(APPEND below_libraries "libtofsmith-${below}${abi_version} ${same_version}")
    list(APPEND below_development "libtofsmith-${below}-dev ${same_version}")
  endforeach()
  if(component STREQUAL "core")
    list(APPEND below_development "libeigen3-dev (>= 3.4)")
  endif()
  list(JOIN below_libraries ", " below_libraries)
  list(JOIN below_development ", " below_development)
  list(APPEND libraries "${library_package} ${same_version}")
  list(APPEND development "libtofsmith-${component}-dev ${same_version}")
  set(what "${about}\n\nThis component is ${tofsmith_${component}_about}.")

  list(APPEND CPACK_COMPONENTS_ALL ${component} ${component}_dev)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME "${library_package}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${below_libraries}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/debian/triggers")
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${what} The package is its shared library.")
  set(CPACK_DEBIAN_${upper}_DEV_PACKAGE_NAME "libtofsmith-${component}-dev")
  set(CPACK_DEBIAN_${upper}_DEV_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_${upper}_DEV_PACKAGE_DEPENDS "${below_development}")
  set(CPACK_COMPONENT_${upper}_DEV_DESCRIPTION
      "${what} The package has its headers, CMake targets and pkg-config file.")
endforeach()
list(JOIN libraries ", " libraries)
list(JOIN development ", " development)

list(APPEND CPACK_COMPONENTS_ALL dev)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libtofsmith-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "${development}")
set(CPACK_COMPONENT_DEV_DESCRIPTION
    "${about}\n\nThis package brings what compiles against all components, and examples.")

if(TARGET tofsmith_cli)
  list(APPEND CPACK_COMPONENTS_ALL tool)
  set(CPACK_DEBIAN_TOOL_PACKAGE_NAME tofsmith)
  set(CPACK_DEBIAN_TOOL_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_TOOL_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_TOOL_PACKAGE_DEPENDS "${libraries}")
  set(CPACK_DEBIAN_TOOL_PACKAGE_SUGGESTS "libtofsmith-dev, python3-tofsmith")
  set(CPACK_COMPONENT_TOOL_DESCRIPTION
      "${about}\n\nThis package is the command line, with manual pages and shell completion.")
endif()

if(TARGET _tofsmith)
  list(APPEND CPACK_COMPONENTS_ALL python)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-tofsmith)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "${libraries}, python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-matplotlib)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-torch, python3-pyvisa, python3-pyvisa-py")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
      "${PROJECT_SOURCE_DIR}/cmake/debian/postinst;${PROJECT_SOURCE_DIR}/cmake/debian/prerm")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
      "${about}\n\nThis package is the Python module tofsmith.")
endif()

# Adds Debian's files, the bill of materials and dates after installation and before packing.
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER "${component}" upper)
  list(APPEND debian_names "${component}" "${CPACK_DEBIAN_${upper}_PACKAGE_NAME}")
endforeach()
find_program(TOFSMITH_PACKAGING_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
configure_file(${PROJECT_SOURCE_DIR}/cmake/debian/stage.cmake.in
               ${PROJECT_BINARY_DIR}/stage_debian.cmake @ONLY)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_BINARY_DIR}/stage_debian.cmake)
include(CPack)
