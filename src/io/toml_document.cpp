// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/toml_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

std::string describe_setting(std::string_view setting) {
  return fmt::format("setting '{}'", setting);
}

/// Keys of `change` replace those of `base`. Nodes are moved: copies forget where they stood.
void lay_over(toml::table& base, toml::table&& change) {
  for (auto&& [key, node] : change) {
    toml::table* inner = node.as_table();
    toml::table* below = base[key.str()].as_table();
    if (inner && below && !inner->is_inline()) {
      lay_over(*below, std::move(*inner));
      continue;
    }
    base.erase(key.str());  // with its key, which remembers the old place
    node.visit([&, k = key](auto& value) { base.insert_or_assign(k, std::move(value)); });
  }
}

/// `key = word` as `key = "word"`.
std::optional<std::string> with_quotes(const std::string& setting) {
  const std::size_t begin = setting.find_first_not_of(' ', setting.find('=') + 1);
  if (setting.find('=') == std::string::npos || begin == std::string::npos) return std::nullopt;
  const std::string word = setting.substr(begin);
  const bool plain = std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) ||
           std::string_view("_./-").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (!plain || std::isdigit(static_cast<unsigned char>(word[0]))) return std::nullopt;
  return fmt::format("{}\"{}\"", setting.substr(0, begin), word);
}

toml::table parse_setting(const std::string& setting) {
  try {
    return toml::parse(setting, describe_setting(setting));
  } catch (const toml::parse_error& error) {
    if (const auto quoted = with_quotes(setting)) try {
        return toml::parse(*quoted, describe_setting(setting));
      } catch (const toml::parse_error&) {  // the first message is about what the user wrote
      }
    throw IoError(describe_setting(setting),
                  fmt::format("{}; expected key = value", error.description()));
  }
}

}  // namespace

TomlDocument::TomlDocument(std::string_view text, std::string_view source_name)
    : source_name_(source_name) {
  try {
    root_ = toml::parse(text, source_name);
  } catch (const toml::parse_error& error) {
    throw IoError(place_of(error.source()), error.description());
  }
}

void TomlDocument::apply(const std::string& setting) {
  toml::table change = parse_setting(setting);
  if (change.empty())
    throw IoError(describe_setting(setting), "found no key; expected key = value");
  lay_over(root_, std::move(change));
}

bool TomlDocument::is_setting(const toml::source_region& region) const {
  return region.path && *region.path != source_name_;
}

std::string TomlDocument::place_of(const toml::source_region& region) const {
  if (is_setting(region)) return *region.path;
  return fmt::format("{}:{}:{}", source_name_, region.begin.line, region.begin.column);
}

std::filesystem::path TomlDocument::directory_of(const toml::source_region& region) const {
  return is_setting(region) ? std::filesystem::path()
                            : std::filesystem::path(source_name_).parent_path();
}

}  // namespace tofsmith
