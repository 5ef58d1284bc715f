# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Renders the sample page in a browser, wide and light, narrow and dark. Included from
# tests/CMakeLists.txt.

add_executable(write_sample_page report/browser/write_sample_page.cpp report/sample_page.cpp)
target_link_libraries(write_sample_page PRIVATE tofsmith tofsmith_build_options fmt::fmt)
target_include_directories(write_sample_page PRIVATE report ${PROJECT_SOURCE_DIR}/src)
target_include_directories(write_sample_page SYSTEM PRIVATE ${RANDOM123_INCLUDE_DIR})

set(sample_page "${CMAKE_CURRENT_BINARY_DIR}/sample_page.html")
set(browser_test /usr/bin/python3 "${CMAKE_CURRENT_SOURCE_DIR}/report/browser/browser_test.py")
add_test(NAME Report.WritesTheSamplePage COMMAND write_sample_page "${sample_page}")
set_tests_properties(Report.WritesTheSamplePage PROPERTIES FIXTURES_SETUP sample_page)
add_test(NAME Report.DrawsEveryFigureInABrowser
  COMMAND ${browser_test} "${sample_page}" --screenshot sample_page.png)
add_test(NAME Report.DrawsEveryFigureOnADarkPhone
  COMMAND ${browser_test} "${sample_page}" --screenshot sample_page_phone.png --width 390 --dark)
set_tests_properties(Report.DrawsEveryFigureInABrowser Report.DrawsEveryFigureOnADarkPhone
  PROPERTIES FIXTURES_REQUIRED sample_page SKIP_RETURN_CODE 77 TIMEOUT 300)

if(TOFSMITH_BUILD_APPS)
  # The report of the program built by scripts/demo.sh.
  set(demo_directory "${CMAKE_CURRENT_BINARY_DIR}/demo")
  add_test(NAME Report.DemoRuns
    COMMAND tofsmith_demo demo -o "${demo_directory}" --trials 2000 --force)
  set_tests_properties(Report.DemoRuns PROPERTIES FIXTURES_SETUP demo_report TIMEOUT 300)
  add_test(NAME Report.DrawsEveryFigureOfTheDemoInABrowser
    COMMAND ${browser_test} "${demo_directory}/report.html" --screenshot demo_report.png
      --width 1400 --height 900 --one-screen --max-bytes 1500000)
  set_tests_properties(Report.DrawsEveryFigureOfTheDemoInABrowser
    PROPERTIES FIXTURES_REQUIRED demo_report SKIP_RETURN_CODE 77 TIMEOUT 300)
endif()
