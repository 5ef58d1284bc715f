// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace tofsmith {

/// A TOML file with settings laid over it, which knows where each of its values was written.
class TomlDocument {
 public:
  /// @param source_name  the file's path, or what errors shall call the text
  /// @throws IoError "file:line:column: .." at the first character that is no TOML
  TomlDocument(std::string_view text, std::string_view source_name);

  /// Lays one `key.key = value` over the document, as if the file had said so. A word that is no
  /// TOML value is a string, so that shells need no second pair of quotes. A table in braces
  /// replaces the one before; other keys of a table stay.
  /// @throws IoError if that is no TOML
  void apply(const std::string& setting);

  const toml::table& root() const { return root_; }
  const std::string& source_name() const { return source_name_; }
  /// "file:line:column", or "setting 'light.peak_factor=5'".
  std::string place_of(const toml::source_region& region) const;
  /// Where relative paths in this value start: the file's directory, or the current one for a
  /// setting.
  std::filesystem::path directory_of(const toml::source_region& region) const;

 private:
  bool is_setting(const toml::source_region& region) const;

  std::string source_name_;
  toml::table root_;
};

}  // namespace tofsmith
