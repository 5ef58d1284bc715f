// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "source_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace tofsmith::house {

std::vector<SourceFile> read_sources(const std::vector<std::string>& folders) {
  const std::filesystem::path root = TOFSMITH_SOURCE_DIR;
  std::vector<SourceFile> files;
  for (const std::string& folder : folders) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::filesystem::path& path = entry.path();
      if (path.extension() != ".hpp" && path.extension() != ".cpp") continue;
      SourceFile file{path.lexically_relative(root).generic_string(), {}};
      std::ifstream stream(path);
      for (std::string line; std::getline(stream, line);) file.lines.push_back(line);
      files.push_back(std::move(file));
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

std::string violation(const SourceFile& file, std::size_t line_index, const std::string& rule) {
  return file.path + ":" + std::to_string(line_index + 1) + ": " + rule;
}

}  // namespace tofsmith::house
