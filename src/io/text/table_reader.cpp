// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/text/shared/table_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "core/shared/text_numbers.hpp"
#include "io/text/toml_hints.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

/// JSON's quoting is valid in TOML.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string joined(const std::string& list, const std::string& element) {
  return list.empty() ? element : fmt::format("{}, {}", list, element);
}

std::string describe(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (node.is_array()) return "a list";
  if (const auto* text = node.as_string()) return fmt::format("\"{}\"", text->get());
  std::ostringstream out;
  out.imbue(std::locale::classic());
  node.visit([&](const auto& value) {
    if constexpr (toml::is_value<decltype(value)>) out << value;
  });
  return out.str();
}

std::string one_line(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* text = node.as_string()) return quoted(text->get());
  std::string inside;
  if (const auto* list = node.as_array()) {
    for (const toml::node& element : *list) inside = joined(inside, one_line(element));
    return fmt::format("[{}]", inside);
  }
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      const std::string member =
          fmt::format("{} = {}", quoted(std::string(key.str())), one_line(value));
      inside = joined(inside, member);
    }
    return fmt::format("{{ {} }}", inside);
  }
  return describe(node);
}

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

}  // namespace

SettingValue toml_value_of(const toml::node& node, std::string place) {
  SettingValue value{one_line(node), {}, {}, std::move(place)};
  value.text = node.is_string() ? node.as_string()->get() : value.toml;
  if (node.is_integer()) value.number = static_cast<double>(node.as_integer()->get());
  if (node.is_floating_point() && std::isfinite(node.as_floating_point()->get()))
    value.number = node.as_floating_point()->get();
  return value;
}

SettingValue toml_value_of(double number, std::string place) {
  const std::string text = fmt::format("{}", number);
  return {text, text, number, std::move(place)};
}

TomlDocument::TomlDocument(std::string_view text, std::string_view source_name)
    : source_name_(source_name) {
  refuse_long_keys(text, source_name);
  try {
    root_ = toml::parse(text, source_name);
  } catch (const toml::parse_error& error) {
    throw IoError(
        place_of(error.source()),
        fmt::format("{}{}", error.description(), toml_hint(text, error.source().begin.line)));
  }
}

void TomlDocument::apply(const std::string& setting) {
  if (const std::optional<std::string> key = key_left_out(setting)) {
    refuse_long_keys(setting, describe_setting(setting));
    return leave_out(root_, *key, setting);
  }
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

TableReader::TableReader(const TomlDocument& document, Places& places)
    : TableReader(document, places, document.root(), "") {}

TableReader::TableReader(const TomlDocument& document, Places& places, const toml::table& table,
                         std::string prefix)
    : document_(document), places_(places), table_(table), prefix_(std::move(prefix)) {}

const toml::node* TableReader::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  const toml::node* node = table_.get(key);
  if (node) places_[full(key)] = document_.place_of(node->source());
  return node;
}

bool TableReader::contains(std::string_view key) { return find(key) != nullptr; }

void TableReader::mistyped(const std::string& name, const toml::node& node,
                           std::string_view expected) const {
  throw IoError(document_.place_of(node.source()),
                fmt::format("{}: found {}; expected {}", name, describe(node), expected));
}

std::string TableReader::place_of(std::string_view key) const {
  const toml::node* node = table_.get(key);
  return document_.place_of(node ? node->source() : table_.source());
}

void TableReader::fail(std::string_view key, std::string_view problem) const {
  throw IoError(place_of(key), fmt::format("{}: {}", full(key), problem));
}

double TableReader::finite_number(const std::string& name, const toml::node& node,
                                  std::string_view expected) const {
  if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
  // "20 MHz" is a number with its unit; "20" is text.
  if (const auto* text = node.as_string(); text && !number_in(text->get()))
    if (const auto number =
            number_in_unit(text->get(), unit_of_key(name.substr(0, name.find('[')))))
      return *number;
  const auto* number = node.as_floating_point();
  if (!number) mistyped(name, node, expected);
  if (!std::isfinite(number->get())) mistyped(name, node, "a finite number");
  return number->get();
}

std::vector<double> TableReader::number_list(const std::string& name,
                                             const toml::array& list) const {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < list.size(); ++i)
    numbers.push_back(finite_number(fmt::format("{}[{}]", name, i), *list.get(i), "a number"));
  return numbers;
}

void TableReader::value(std::string_view key, bool& target) {
  const toml::node* node = find(key);
  if (!node) return;
  if (!node->is_boolean()) mistyped(full(key), *node, "true or false");
  target = node->as_boolean()->get();
}

void TableReader::value(std::string_view key, int& target) {
  const toml::node* node = find(key);
  if (!node) return;
  const auto* decimal = node->as_floating_point();  // 1e4
  const bool is_whole =
      decimal && decimal->get() == std::trunc(decimal->get()) && std::abs(decimal->get()) < 1e15;
  if (!node->is_integer() && !is_whole) mistyped(full(key), *node, "an integer");
  const std::int64_t number =
      is_whole ? static_cast<std::int64_t>(decimal->get()) : node->as_integer()->get();
  if (number < std::numeric_limits<int>::min() || number > std::numeric_limits<int>::max())
    mistyped(full(key), *node, "an integer of at most 32 bits");
  target = static_cast<int>(number);
}

void TableReader::value(std::string_view key, double& target) {
  if (const toml::node* node = find(key)) target = finite_number(full(key), *node, "a number");
}

void TableReader::value(std::string_view key, std::string& target) {
  const toml::node* node = find(key);
  if (!node) return;
  if (!node->is_string()) mistyped(full(key), *node, "a text in quotes");
  target = node->as_string()->get();
}

void TableReader::value(std::string_view key, std::vector<double>& target) {
  const toml::node* node = find(key);
  if (!node) return;
  if (!node->is_array()) mistyped(full(key), *node, "a list of numbers");
  target = number_list(full(key), *node->as_array());
}

void TableReader::raw_numbers(std::string_view key, std::vector<double>& target) {
  const toml::node* node = find(key);
  if (!node) return;
  if (!node->is_array()) mistyped(full(key), *node, "a list of numbers, such as [65535]");
  target.clear();
  for (const toml::node& element : *node->as_array()) {
    const std::string word = element.value<std::string>().value_or("");
    if (element.is_floating_point())
      target.push_back(element.as_floating_point()->get());
    else if (word == "nan")
      target.push_back(std::numeric_limits<double>::quiet_NaN());
    else if (word == "inf" || word == "-inf")
      target.push_back(word == "inf" ? infinity : -infinity);
    else
      target.push_back(finite_number(full(key), element, "a number, nan, inf or -inf"));
  }
}

void TableReader::value(std::string_view key, std::vector<int>& target) {
  const toml::node* node = find(key);
  if (!node) return;
  if (!node->is_array()) mistyped(full(key), *node, "a list of integers");
  target.clear();
  for (const toml::node& element : *node->as_array()) {
    const auto* number = element.as_integer();
    if (!number || number->get() < -65535 || number->get() > 65535)
      mistyped(full(key), element, "an integer in [-65535, 65535]");
    target.push_back(static_cast<int>(number->get()));
  }
}

void TableReader::value(std::string_view key, std::vector<std::string>& target) {
  const toml::node* node = find(key);
  if (!node) return;
  if (!node->is_array()) mistyped(full(key), *node, "a list of texts in quotes");
  target.clear();
  for (const toml::node& element : *node->as_array()) {
    if (!element.is_string()) mistyped(full(key), element, "a text in quotes");
    target.push_back(element.as_string()->get());
  }
}

void TableReader::value(std::string_view key, std::uint64_t& target) {
  const toml::node* node = find(key);
  if (!node) return;
  if (!node->is_integer() || node->as_integer()->get() < 0)
    mistyped(full(key), *node, "an integer >= 0");
  target = static_cast<std::uint64_t>(node->as_integer()->get());
}

void TableReader::value(std::string_view key, std::vector<SettingValue>& target) {
  const toml::node* node = find(key);
  if (!node) return;
  if (!node->is_array()) mistyped(full(key), *node, "a list of values");
  target.clear();
  for (const toml::node& element : *node->as_array())
    target.push_back(toml_value_of(element, document_.place_of(element.source())));
}

std::vector<double> TableReader::numbers(std::string_view key, const toml::node& node,
                                         std::size_t count, std::string_view expected) const {
  if (!node.is_array()) mistyped(full(key), node, expected);
  std::vector<double> list = number_list(full(key), *node.as_array());
  if (list.size() != count)
    fail(key, fmt::format("found {} numbers; expected {}", list.size(), expected));
  return list;
}

void TableReader::value(std::string_view key, Eigen::Vector3d& target) {
  const toml::node* node = find(key);
  if (!node) return;
  const std::vector<double> list = numbers(key, *node, 3, "a list of three numbers");
  target = {list[0], list[1], list[2]};
}

void TableReader::value(std::string_view key, std::array<double, 2>& target) {
  const toml::node* node = find(key);
  if (!node) return;
  const std::vector<double> list = numbers(key, *node, 2, "a list of two numbers");
  target = {list[0], list[1]};
}

void TableReader::number_or_list(std::string_view key, double& number, std::vector<double>& list) {
  const toml::node* node = find(key);
  if (!node) return;
  if (!node->is_array()) {
    number = finite_number(full(key), *node, "a number or a list of numbers");
    list.clear();
    return;
  }
  list = number_list(full(key), *node->as_array());
  if (list.empty()) fail(key, "found an empty list; expected at least one number");
}

void TableReader::number_or_word(std::string_view key, double& number, std::string_view word,
                                 bool& is_word) {
  const toml::node* node = find(key);
  if (!node) return;
  is_word = node->is_string() && node->as_string()->get() == word;
  if (!is_word) number = finite_number(full(key), *node, fmt::format("a number or \"{}\"", word));
}

std::optional<std::size_t> TableReader::word(std::string_view key,
                                             std::span<const std::string_view> words) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  const auto* text = node->as_string();
  const auto found = std::find(words.begin(), words.end(), text ? text->get() : std::string());
  if (found == words.end()) {
    const std::string near = text ? nearest_word(text->get(), words) : "";
    mistyped(full(key), *node,
             fmt::format("one of \"{}\"{}", fmt::join(words, "\", \""),
                         near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
  }
  return static_cast<std::size_t>(found - words.begin());
}

std::optional<TableReader> TableReader::enter(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  if (!node->is_table()) mistyped(full(key), *node, "a table");
  return TableReader(document_, places_, *node->as_table(), full(key) + ".");
}

std::vector<TableReader> TableReader::enter_each(std::string_view key) {
  std::vector<TableReader> readers;
  const toml::node* node = find(key);
  if (!node) return readers;
  const std::string expected = fmt::format("tables that begin with [[{}]]", full(key));
  if (!node->is_array()) mistyped(full(key), *node, expected);
  const toml::array& list = *node->as_array();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string name = fmt::format("{}[{}]", full(key), i);
    if (!list.get(i)->is_table()) mistyped(name, *list.get(i), expected);
    places_[name] = document_.place_of(list.get(i)->source());
    readers.push_back(TableReader(document_, places_, *list.get(i)->as_table(), name + "."));
  }
  return readers;
}

TableReader& TableReader::required(std::string_view key, std::string_view example) {
  if (table_.contains(key)) return *this;
  throw missing(key, example);
}

void TableReader::required_at_end(std::string_view key, std::string_view example) {
  if (!table_.contains(key) && !missing_) missing_ = missing(key, example);
}

IoError TableReader::missing(std::string_view key, std::string_view example) const {
  return {prefix_.empty() ? document_.source_name() : document_.place_of(table_.source()),
          fmt::format("found no {}; expected a line such as `{} = {}`", full(key), key, example)};
}

void TableReader::refuse(std::initializer_list<std::string_view> keys, std::string_view condition) {
  for (const std::string_view key : keys)
    if (contains(key)) {
      if (missing_) throw *missing_;  // the missing key may be this condition
      fail(key, fmt::format("is only valid with {}", condition));
    }
}

std::filesystem::path TableReader::resolve(std::string_view key, const std::string& path) const {
  const toml::node* node = table_.get(key);
  return node ? document_.directory_of(node->source()) / path : std::filesystem::path(path);
}

void TableReader::finish() const {
  for (const auto& [key, node] : table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    std::string near = document_.suggestion(full(key.str()));
    if (near.empty()) {
      near = nearest_word(key.str(), known_);
      if (!near.empty()) near = full(near);
    }
    throw IoError(document_.place_of(key.source()),
                  fmt::format("unknown key {}; {}", full(key.str()),
                              near.empty() ? fmt::format("expected {}", fmt::join(known_, ", "))
                                           : key_suggestion(key.str(), near)));
  }
  if (missing_) throw *missing_;
}

}  // namespace tofsmith
