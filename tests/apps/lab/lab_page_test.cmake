# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# The lab's page in a browser: packed with a stand-in for the engine, and, where scripts/lab.sh has
# built it, as it is given out. Included from tests/CMakeLists.txt.

set(lab_tests "${CMAKE_CURRENT_SOURCE_DIR}/apps/lab")
set(mock_page "${CMAKE_CURRENT_BINARY_DIR}/mock_lab.html")
add_test(NAME Lab.PacksItsPage
  COMMAND /usr/bin/python3 "${PROJECT_SOURCE_DIR}/apps/lab/page/pack.py"
          --worker "${lab_tests}/mock_engine.js" -o "${mock_page}")
set_tests_properties(Lab.PacksItsPage PROPERTIES FIXTURES_SETUP mock_lab LABELS apps)
add_test(NAME Lab.RefusesWhatItCannotPack
  COMMAND /usr/bin/python3 "${lab_tests}/pack_test.py" "${PROJECT_SOURCE_DIR}/apps/lab/page/pack.py")
set_tests_properties(Lab.RefusesWhatItCannotPack PROPERTIES LABELS apps)
add_test(NAME Lab.PageWorksInABrowser
  COMMAND /usr/bin/python3 "${lab_tests}/lab_page_test.py" "${mock_page}")
set_tests_properties(Lab.PageWorksInABrowser
  PROPERTIES FIXTURES_REQUIRED mock_lab SKIP_RETURN_CODE 77 TIMEOUT 300 LABELS apps)
add_test(NAME Lab.BuiltPageWorksInABrowser
  COMMAND /usr/bin/python3 "${lab_tests}/lab_page_test.py" "${PROJECT_SOURCE_DIR}/build-lab/lab.html")
set_tests_properties(Lab.BuiltPageWorksInABrowser
  PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600 LABELS apps)
if(TARGET tofsmith_cli)
  add_test(NAME Lab.PageEqualsTheCommand
    COMMAND /usr/bin/python3 "${lab_tests}/lab_numbers_test.py" $<TARGET_FILE:tofsmith_cli>
            "${PROJECT_SOURCE_DIR}/build-lab/lab.html")
  set_tests_properties(Lab.PageEqualsTheCommand
    PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 LABELS apps)
endif()
