# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# The lab's page in a browser: with the engine as a program, and, where scripts/lab.sh has built it,
# as it is given out. Included from tests/CMakeLists.txt.

set(lab_tests "${CMAKE_CURRENT_SOURCE_DIR}/apps/lab")
set(built_page "${PROJECT_SOURCE_DIR}/build-lab/lab.html")
add_test(NAME Lab.PacksItsPage
  COMMAND /usr/bin/python3 "${lab_tests}/pack_test.py" "${PROJECT_SOURCE_DIR}/viewer/pack.py")
set_tests_properties(Lab.PacksItsPage PROPERTIES LABELS apps)
add_test(NAME Lab.BuiltPageWorksInABrowser
  COMMAND /usr/bin/python3 -B "${lab_tests}/lab_page_test.py" "${built_page}")
set_tests_properties(Lab.BuiltPageWorksInABrowser
  PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600 LABELS apps COST 150)
if(TARGET tofsmith_cli)
  add_executable(lab_engine_cli apps/lab/lab_engine_cli.cpp)
  target_link_libraries(lab_engine_cli PRIVATE tofsmith_lab_engine tofsmith_build_options fmt::fmt)
  add_test(NAME Lab.PageWorksInABrowser
    COMMAND /usr/bin/python3 -B "${lab_tests}/lab_page_test.py" $<TARGET_FILE:lab_engine_cli>)
  add_test(NAME Lab.PageEqualsTheCommand
    COMMAND /usr/bin/python3 -B "${lab_tests}/lab_numbers_test.py" $<TARGET_FILE:tofsmith_cli>
            $<TARGET_FILE:lab_engine_cli>)
  add_test(NAME Lab.BuiltPageEqualsTheCommand
    COMMAND /usr/bin/python3 -B "${lab_tests}/lab_numbers_test.py" $<TARGET_FILE:tofsmith_cli>
            "${built_page}")
  set_tests_properties(
    Lab.PageWorksInABrowser Lab.PageEqualsTheCommand Lab.BuiltPageEqualsTheCommand
    PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600 LABELS apps COST 150)
endif()
