// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tofsmith::apps {

/// Directory of this program; empty if the system does not report it.
inline std::filesystem::path program_directory() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
}

/// Replaces this process with `python3 -m MODULE ARGUMENTS`. The package tofsmith is searched for
/// next to this program (build, installation, wheel), then where Python itself searches; if it is
/// missing, Python reports what to install. The environment variable TOFSMITH_PYTHON selects
/// another interpreter.
/// @param input  standard input of the module; empty: inherited
/// @throws IoError if Python cannot be started
[[noreturn]] void run_python_module(const std::string& module, const std::string& input,
                                    const std::vector<std::string>& arguments = {});

}  // namespace tofsmith::apps
