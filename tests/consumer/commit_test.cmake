# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# The commit is the given one, git's, the archive's, or none. A file that already contains it is not
# modified, so that nothing is recompiled.
#   cmake -D script=build_commit.cmake -D work=DIR -P commit_test.cmake

set(source ${work}/source)
set(output ${work}/commit.cpp)
file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${source}/cmake)

function(expect wanted)
  execute_process(COMMAND ${CMAKE_COMMAND} -D source=${source} -D output=${output} ${ARGN}
                          -P ${script} COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${output} text)
  if(NOT text MATCHES "build_commit = \"([^\"]*)\"" OR NOT CMAKE_MATCH_1 MATCHES "^${wanted}$")
    message(SEND_ERROR "expected ${wanted} in\n${text}")
  endif()
endfunction()

function(git)
  execute_process(COMMAND git -c user.name=t -c user.email=t@t.invalid ${ARGN}
                  WORKING_DIRECTORY ${source} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(WRITE ${source}/cmake/archived_commit.txt "commit $Format:%H$\nseconds $Format:%ct$\n")
expect(unknown)
file(WRITE ${source}/cmake/archived_commit.txt
     "commit 0123456789abcdef0123456789abcdef01234567\nseconds 1700000000\n")
expect(0123456789ab)
expect(from-outside -D commit=from-outside)

file(TIMESTAMP ${output} before "%s%f" UTC)
execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 0.05)
expect(from-outside -D commit=from-outside)
file(TIMESTAMP ${output} after "%s%f" UTC)
if(NOT before STREQUAL after)
  message(SEND_ERROR "the file was written again although nothing changed")
endif()

find_program(git_found git)
if(git_found)
  # Commits of an enclosing project must be ignored.
  execute_process(COMMAND git init -q ${work} COMMAND_ERROR_IS_FATAL ANY)
  expect(0123456789ab)
  git(init -q .)
  git(add .)
  git(commit -q -m first)
  expect("[0-9a-f]+")
  file(APPEND ${source}/cmake/archived_commit.txt "changed\n")
  expect("[0-9a-f]+[+]dirty")
  git(checkout -q .)
  file(WRITE ${source}/untracked "")
  expect("[0-9a-f]+")
endif()
