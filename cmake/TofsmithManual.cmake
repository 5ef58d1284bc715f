# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Generates manual pages and shell completion from `tofsmith --list-commands`.

find_program(TOFSMITH_BUILD_PYTHON3 NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH
             DOC "Makes manual pages and completions; no package of its own is needed")
if(NOT TOFSMITH_BUILD_PYTHON3)
  find_program(TOFSMITH_BUILD_PYTHON3 NAMES python3)
endif()
if(NOT TOFSMITH_BUILD_PYTHON3 OR CMAKE_CROSSCOMPILING)
  message(STATUS "No manual pages and no shell completion: they need python3, and to run what is built")
  return()
endif()

set(listing ${PROJECT_BINARY_DIR}/commands.json)
set(manual_dir ${PROJECT_BINARY_DIR}/manual)
set(completion_dir ${PROJECT_BINARY_DIR}/completion)
set(make_manual ${PROJECT_SOURCE_DIR}/cmake/make_manual.py)
set(make_completions ${PROJECT_SOURCE_DIR}/cmake/make_completions.py)
add_custom_command(OUTPUT ${listing} COMMAND tofsmith_cli --list-commands > ${listing}
                   DEPENDS tofsmith_cli VERBATIM COMMENT "Listing the commands")
add_custom_command(OUTPUT ${manual_dir}/tofsmith.1 DEPENDS ${listing} ${make_manual} VERBATIM
                   COMMAND ${TOFSMITH_BUILD_PYTHON3} ${make_manual} ${manual_dir} < ${listing}
                   COMMENT "Making the manual pages")
add_custom_command(OUTPUT ${completion_dir}/tofsmith DEPENDS ${listing} ${make_completions} VERBATIM
                   COMMAND ${TOFSMITH_BUILD_PYTHON3} ${make_completions} ${completion_dir} < ${listing}
                   COMMENT "Making the shell completion")
add_custom_target(tofsmith_manual ALL DEPENDS ${manual_dir}/tofsmith.1 ${completion_dir}/tofsmith)

set(share ${CMAKE_INSTALL_DATAROOTDIR})
install(DIRECTORY ${manual_dir}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tool)
install(FILES ${completion_dir}/tofsmith DESTINATION ${share}/bash-completion/completions
        COMPONENT tool)
install(FILES ${completion_dir}/_tofsmith DESTINATION ${share}/zsh/vendor-completions
        COMPONENT tool)
install(FILES ${completion_dir}/tofsmith.fish DESTINATION ${share}/fish/vendor_completions.d
        COMPONENT tool)
