// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

void make_output_directory(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error)
    throw IoError(directory.string(),
                  fmt::format("cannot create this directory ({}); expected a writable location",
                              error.message()));
  if (!std::filesystem::is_directory(directory, error))
    throw IoError(directory.string(), "is a file; expected a directory");
}

void check_not_input(const std::filesystem::path& output, const std::vector<std::string>& inputs) {
  std::error_code ignored;
  for (const std::string& input : inputs)
    if (std::filesystem::equivalent(output, input, ignored))
      throw IoError(output.string(),
                    fmt::format("is the input {} of this command; choose another name, which "
                                "--force does not replace",
                                input));
}

OutputPolicy policy_to_go_on(const std::vector<std::filesystem::path>& outputs,
                             OutputPolicy policy) {
  const auto is_there = [](const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored);
  };
  const auto missing = std::find_if_not(outputs.begin(), outputs.end(), is_there);
  const bool stopped = missing != outputs.begin() && missing != outputs.end() &&
                       std::none_of(missing, outputs.end(), is_there);
  return stopped && policy == OutputPolicy::refuse_existing ? OutputPolicy::refuse_other : policy;
}

}  // namespace tofsmith
