# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Writes the source file that contains the commit, if the commit has changed.
#   cmake -D source=DIR -D output=FILE -D commit=TEXT -P build_commit.cmake
# For an empty commit, git is asked, or cmake/archived_commit.txt in an archive made by git.

# Sets the output of git in the directory, or "".
function(git result)
  execute_process(COMMAND git --no-optional-locks ${ARGN} WORKING_DIRECTORY ${source}
                  OUTPUT_VARIABLE text ERROR_QUIET RESULT_VARIABLE failed
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(failed)
    set(text "")
  endif()
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# The commit of a project that contains tofsmith's sources is not tofsmith's.
git(top rev-parse --show-toplevel)
if(top)
  file(REAL_PATH "${top}" top)
  file(REAL_PATH "${source}" here)
endif()
if(NOT commit AND top AND top STREQUAL here)
  git(commit rev-parse HEAD)
  string(SUBSTRING "${commit}" 0 12 commit)  # git's abbreviation depends on the clone
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
