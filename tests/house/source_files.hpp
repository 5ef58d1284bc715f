// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace tofsmith::house {

/// The path is relative to the root, with forward slashes.
struct SourceFile {
  std::string path;
  std::vector<std::string> lines;
};

/// Files are sorted by path.
std::vector<SourceFile> read_sources(const std::vector<std::string>& folders);

/// Formats a violation for editors: "path:line: rule".
std::string violation(const SourceFile& file, std::size_t line_index, const std::string& rule);

template <typename Check>
std::string violations_in(const std::vector<SourceFile>& files, const Check& check) {
  std::string all;
  for (const SourceFile& file : files)
    for (const std::string& found : check(file)) all += found + '\n';
  return all;
}

}  // namespace tofsmith::house
