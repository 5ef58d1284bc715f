// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <toml++/toml.h>

#include <locale>
#include <sstream>

#include "io/text/shared/reader.hpp"
#include "io/text/toml_hints.hpp"

namespace tofsmith {
namespace {

/// Describes long settings by their beginning.
std::string describe_setting(std::string_view setting) {
  constexpr std::size_t longest = 160;
  if (setting.size() <= longest) return fmt::format("setting '{}'", setting);
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(setting[end]) & 0xC0) == 0x80) --end;  // UTF-8
  return fmt::format("setting '{}..'", setting.substr(0, end));
}

/// Keys of `change` override. Nodes are moved, because copies lose their position.
void lay_over(toml::table& base, toml::table&& change) {
  for (auto&& [key, node] : change) {
    toml::table* inner = node.as_table();
    toml::table* below = base[key.str()].as_table();
    if (inner && below && !inner->is_inline()) {
      lay_over(*below, std::move(*inner));
      continue;
    }
    base.erase(key.str());  // also erases the key, which stores the old position
    node.visit([&, k = key](auto& value) { base.insert_or_assign(k, std::move(value)); });
  }
}

/// Each part of a dotted key nests one table deeper, and tables are traversed recursively.
void refuse_long_keys(std::string_view text, std::string_view source_name) {
  constexpr int max_parts = 32;
  int line = 1, parts = 1;
  char quote = '\0';  // in a string or, as '#', in a comment
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      parts = 1;
      quote = '\0';
    } else if (quote != '\0') {
      if (c == '\\' && quote == '"') ++i;
      if (c == quote && quote != '#') quote = '\0';
    } else if (c == '"' || c == '\'' || c == '#') {
      quote = c;
    } else if (c == '.' && ++parts > max_parts) {
      throw IoError(
          fmt::format("{}:{}", source_name, line),
          fmt::format("found a key of more than {} parts between dots; expected fewer", max_parts));
    } else if (std::string_view(",=[]{}").find(c) != std::string_view::npos) {
      parts = 1;
    }
  }
}

toml::table parse_setting(const std::string& setting) {
  refuse_long_keys(setting, describe_setting(setting));
  try {
    return toml::parse(setting, describe_setting(setting));
  } catch (const toml::parse_error& error) {
    if (const auto quoted = with_quotes(setting)) try {
        return toml::parse(*quoted, describe_setting(setting));
      } catch (const toml::parse_error&) {  // report the error in the user's text
      }
    const std::string hint = setting.find('=') == setting.npos ? "" : toml_hint(setting, 1);
    throw IoError(
        describe_setting(setting),
        fmt::format("{}{}", error.description(), hint.empty() ? "; expected key = value" : hint));
  }
}

/// Returns the key of "sensor.full_well_e=".
std::optional<std::string> key_left_out(std::string_view setting) {
  const std::size_t end = setting.find_last_not_of(" \t");
  if (end == std::string_view::npos || setting[end] != '=') return std::nullopt;
  const std::string_view before = setting.substr(0, end);
  const std::size_t first = before.find_first_not_of(" \t"), last = before.find_last_not_of(" \t");
  if (first == std::string_view::npos || before.find_first_of("=\"'#") != std::string_view::npos)
    return std::nullopt;
  return std::string(before.substr(first, last - first + 1));
}

void leave_out(toml::table& root, std::string_view key, std::string_view setting) {
  toml::table* table = &root;
  for (std::string_view rest = key;;) {
    const std::size_t dot = rest.find('.');
    const std::string_view part = rest.substr(0, dot);
    if (dot == std::string_view::npos && table->erase(part) > 0) return;
    toml::table* inner = table->get_as<toml::table>(part);
    if (dot != std::string_view::npos && inner != nullptr) {
      table = inner;
      rest.remove_prefix(dot + 1);
      continue;
    }
    std::vector<std::string> there;
    for (const auto& [name, node] : *table) there.emplace_back(name.str());
    const std::string near = nearest_word(part, there);
    throw IoError(describe_setting(setting),
                  fmt::format("found no key {} to remove{}", key,
                              near.empty() ? "" : fmt::format("; did you mean {}?", near)));
  }
}

void apply(toml::table& root, const std::string& setting) {
  if (const std::optional<std::string> key = key_left_out(setting)) {
    refuse_long_keys(setting, describe_setting(setting));
    return leave_out(root, *key, setting);
  }
  toml::table change = parse_setting(setting);
  if (change.empty())
    throw IoError(describe_setting(setting), "found no key; expected key = value");
  lay_over(root, std::move(change));
}

toml::table parse_text(std::string_view text, std::string_view source_name) {
  refuse_long_keys(text, source_name);
  try {
    return toml::parse(text, source_name);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw IoError(fmt::format("{}:{}:{}", source_name, at.line, at.column),
                  fmt::format("{}{}", error.description(), toml_hint(text, at.line)));
  }
}

/// Converts nodes to JSON values at their final addresses. Dates become binary values with their
/// text.
class Converter {
 public:
  explicit Converter(std::string_view source_name) : source_name_(source_name) {}

  void convert(const toml::node& node, nlohmann::json& value) {
    node.visit([&](const auto& its) { assign(its, value); });
  }
  Document::Positions positions;

 private:
  void assign(const toml::table& table, nlohmann::json& value) {
    value = nlohmann::json::object();
    for (const auto& [key, node] : table) {
      nlohmann::json& member = value[std::string(key.str())];
      positions[&member] = {position_of(key.source()), position_of(node.source())};
      convert(node, member);
    }
  }
  void assign(const toml::array& list, nlohmann::json& value) {
    value = nlohmann::json::array_t(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
      positions[&value[i]].value = position_of(list[i].source());
      convert(list[i], value[i]);
    }
  }
  template <typename Type>
  static void assign(const toml::value<Type>& scalar, nlohmann::json& value) {
    if constexpr (std::is_same_v<Type, std::int64_t>) {
      if (*scalar >= 0)
        value = static_cast<std::uint64_t>(*scalar);
      else
        value = *scalar;
    } else if constexpr (std::is_arithmetic_v<Type> || std::is_same_v<Type, std::string>) {
      value = *scalar;
    } else {
      std::ostringstream out;
      out.imbue(std::locale::classic());
      out << scalar;
      const std::string text = out.str();
      value = nlohmann::json::binary({text.begin(), text.end()});
    }
  }
  Document::Position position_of(const toml::source_region& region) const {
    const bool is_setting = region.path && *region.path != source_name_;
    return {region.begin.line, region.begin.column, is_setting ? *region.path : ""};
  }

  std::string_view source_name_;
};

}  // namespace

Document parse_toml(std::string_view text, std::string_view source_name, Settings settings) {
  toml::table table = parse_text(text, source_name);
  for (const std::string& setting : settings) apply(table, setting);
  Converter converter(source_name);
  nlohmann::json root;
  converter.convert(table, root);
  return {std::move(root), source_name, Syntax::toml, std::move(converter.positions)};
}

}  // namespace tofsmith
