# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Writes the source file that names the commit, and leaves it alone when that has not changed.
#   cmake -D source=DIR -D output=FILE -D commit=TEXT -P build_commit.cmake
# An empty commit asks git, or, in an archive that git made, cmake/archived_commit.txt.

# What git says in the directory, or "".
function(git result)
  execute_process(COMMAND git --no-optional-locks ${ARGN} WORKING_DIRECTORY ${source}
                  OUTPUT_VARIABLE text ERROR_QUIET RESULT_VARIABLE failed
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(failed)
    set(text "")
  endif()
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# A project that carries tofsmith along has commits of its own.
git(top rev-parse --show-toplevel)
if(top)
  file(REAL_PATH "${top}" top)
  file(REAL_PATH "${source}" here)
endif()
if(NOT commit AND top AND top STREQUAL here)
  git(commit rev-parse HEAD)
  string(SUBSTRING "${commit}" 0 12 commit)  # git's own short form depends on the clone
  git(changes status --porcelain --untracked-files=no)
  if(commit AND changes)
    string(APPEND commit "+dirty")
  endif()
endif()
if(NOT commit)
  file(STRINGS ${source}/cmake/archived_commit.txt commit REGEX "^commit [0-9a-f]+$")
  string(REGEX REPLACE "^commit (............).*" "\\1" commit "${commit}")
endif()
if(NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${output} @ONLY CONTENT [[
// Written by cmake/build_commit.cmake.
#include "core/build_commit.hpp"

namespace tofsmith {

const char* const build_commit = "@commit@";

}  // namespace tofsmith
]])
