# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Installs a build into an empty prefix, then builds and runs the consumer against it alone: by the
# CMake package, and by pkg-config.
#   cmake -D build=DIR -D work=DIR -D compiler=CXX -D flags=FLAGS -D type=TYPE -P install_and_use.cmake

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${work})
run(${CMAKE_COMMAND} --install ${build} --prefix ${work}/prefix)
# Moved, so that a path of the build or of the first prefix left in the package shows.
file(RENAME ${work}/prefix ${work}/moved)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${work}/consumer -G Ninja
    -D CMAKE_PREFIX_PATH=${work}/moved -D CMAKE_CXX_COMPILER=${compiler}
    -D CMAKE_CXX_FLAGS=${flags} -D CMAKE_BUILD_TYPE=${type})
run(${CMAKE_COMMAND} --build ${work}/consumer)
run(${work}/consumer/consumer)
if(EXISTS ${work}/moved/bin/tofsmith)
  run(${work}/moved/bin/tofsmith --version)
endif()

file(GLOB_RECURSE found ${work}/moved/tofsmith.pc)
get_filename_component(directory ${found} DIRECTORY)
get_filename_component(libraries ${directory} DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${directory})
set(ENV{LD_LIBRARY_PATH} "${libraries}:$ENV{LD_LIBRARY_PATH}")
execute_process(COMMAND pkg-config --cflags --libs "tofsmith >= 0.1"
                OUTPUT_VARIABLE by_pkg_config OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
separate_arguments(by_pkg_config UNIX_COMMAND "${by_pkg_config}")
run(${compiler} -std=c++20 ${flags} ${CMAKE_CURRENT_LIST_DIR}/main.cpp ${by_pkg_config}
    -o ${work}/by_pkg_config)
run(${work}/by_pkg_config)
