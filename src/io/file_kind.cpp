// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/shared/file_kind.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = lower_case(c);
  return extension;
}

std::string known_extension(const std::filesystem::path& path,
                            std::initializer_list<std::string_view> known) {
  std::string extension = lower_extension(path);
  if (std::find(known.begin(), known.end(), extension) != known.end()) return extension;
  throw IoError(
      path.string(),
      fmt::format("found {}; expected one of {}",
                  extension.empty() ? "no extension" : fmt::format("the extension '{}'", extension),
                  fmt::join(known, ", ")));
}

std::string file_name_of(std::string_view name) {
  std::string file;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || (c == '.' && !file.empty());
    file += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return file;
}

}  // namespace tofsmith
