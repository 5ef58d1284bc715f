# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Installs a build into an empty prefix, then builds and runs the consumer with this installation
# only, by the CMake package and by pkg-config.
#   cmake -D build=DIR -D work=DIR -D compiler=CXX -D flags=FLAGS -D type=TYPE
#         -D "components=core;design;.." -D harden=ON|OFF -P install_and_use.cmake

cmake_policy(SET CMP0057 NEW)  # IN_LIST

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(configure ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -G Ninja
    -D CMAKE_PREFIX_PATH=${work}/moved -D CMAKE_CXX_COMPILER=${compiler}
    -D CMAKE_CXX_FLAGS=${flags} -D CMAKE_BUILD_TYPE=${type})

file(REMOVE_RECURSE ${work})
run(${CMAKE_COMMAND} --install ${build} --prefix ${work}/prefix)
# Moves the installation, so that absolute paths of the build or the first prefix cause errors.
file(RENAME ${work}/prefix ${work}/moved)

run(${configure} -B ${work}/core -D components=core)
run(${CMAKE_COMMAND} --build ${work}/core)
run(${work}/core/decode_a_pixel)
if(EXISTS ${work}/core/consumer)
  message(FATAL_ERROR "asked for core alone, found design, too")
endif()
if("design" IN_LIST components)
  run(${configure} -B ${work}/consumer -D "components=core\;design")
  run(${CMAKE_COMMAND} --build ${work}/consumer --target consumer)
  run(${work}/consumer/consumer)
endif()
run(${configure} -B ${work}/all)  # all installed components
if(harden AND type STREQUAL "Release" AND NOT flags MATCHES "-fsanitize")
  file(GLOB_RECURSE elf_files ${work}/moved/*.so ${work}/moved/bin/*)
  if(elf_files)
    run(${CMAKE_CURRENT_LIST_DIR}/../../scripts/check_elf.py ${elf_files})
  endif()
endif()
if(EXISTS ${work}/moved/bin/tofsmith)
  run(${work}/moved/bin/tofsmith --version)
endif()

file(GLOB_RECURSE found ${work}/moved/tofsmith.pc)
get_filename_component(directory ${found} DIRECTORY)
get_filename_component(libraries ${directory} DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${directory})
set(ENV{LD_LIBRARY_PATH} "${libraries}:$ENV{LD_LIBRARY_PATH}")
separate_arguments(flags UNIX_COMMAND "${flags}")
function(use_by_pkg_config name source)
  execute_process(COMMAND pkg-config --cflags --libs "${name} >= 0.1"
                  OUTPUT_VARIABLE by_pkg_config OUTPUT_STRIP_TRAILING_WHITESPACE
                  COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(by_pkg_config UNIX_COMMAND "${by_pkg_config}")
  run(${compiler} -std=c++20 ${flags} ${CMAKE_CURRENT_LIST_DIR}/${source} ${by_pkg_config}
      -o ${work}/by_${name})
  run(${work}/by_${name})
endfunction()
use_by_pkg_config(tofsmith-core decode_a_pixel.cpp)
if("design" IN_LIST components)
  use_by_pkg_config(tofsmith main.cpp)
endif()

# A missing component is rejected with a message that lists what to install.
function(refuse asked expected)
  execute_process(COMMAND ${configure} -B ${work}/refused -D "components=${asked}"
                  RESULT_VARIABLE failed ERROR_VARIABLE message OUTPUT_QUIET)
  file(REMOVE_RECURSE ${work}/refused)
  string(REGEX REPLACE "[ \n]+" " " message "${message}")
  if(NOT failed OR NOT message MATCHES "${expected}")
    message(FATAL_ERROR "asking for ${asked} should say '${expected}', but says\n${message}")
  endif()
endfunction()
file(GLOB_RECURSE sweep_targets ${work}/moved/tofsmith_sweep_targets*.cmake)
if(sweep_targets)
  file(REMOVE ${sweep_targets})
endif()
refuse(sweep "apt install .*libtofsmith-sweep-dev")
refuse("core;sweeps" "no component 'sweeps'; it has core, gpu, design, io, report, lab, sweep")
