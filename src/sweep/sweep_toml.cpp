// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/shared/text_numbers.hpp"
#include "io/shared/read_file.hpp"
#include "io/text/shared/reader.hpp"
#include "io/text/shared/text_lines.hpp"
#include "sweep/item_key.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/number_table.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {
namespace {

/// Returns a number, or else a string.
SettingValue setting_value_of_line(const std::string& line, std::string place) {
  double number = 0.0;
  const char* const end = line.data() + line.size();
  const auto [stopped, error] = std::from_chars(line.data(), end, number);
  if (error == std::errc() && stopped == end && std::isfinite(number))
    return {line, line, number, std::move(place)};
  if (line == "true" || line == "false") return {line, line, {}, std::move(place)};
  return setting_value(line, std::move(place));
}

constexpr std::int64_t max_axis_values = 1'000'000;

/// Returns the names of all fields and of the fields of their structs.
template <typename Struct>
std::vector<std::string> field_names() {
  std::vector<std::string> names;
  Struct any;
  for_each_field(any, [&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(field.value)>;
    if constexpr (HasFields<Value>)
      std::ranges::move(field_names<Value>(), std::back_inserter(names));
    else
      names.emplace_back(field.name);
  });
  return names;
}

/// @param field  member that contains the key
void check_key(const TableReader& table, const char* field, const std::string& key) {
  const std::vector<std::string> other_keys = field_names<ItemValues>();
  std::vector<std::string> known = camera_keys();
  known.insert(known.end(), other_keys.begin(), other_keys.end());
  if (std::ranges::find(known, key) != known.end()) return;
  // Suggest the key that ends with this word, else the most similar one.
  const auto ends_so = [&](const std::string& word) { return word.ends_with("." + key); };
  const auto found = std::ranges::find_if(known, ends_so);
  const std::string near = found != known.end() ? *found : nearest_word(key, known);
  table.fail(field, fmt::format("found unknown axis \"{}\"; {}", key,
                                near.empty() ? "expected a key of the camera such as "
                                               "light.peak_factor, or " +
                                                   fmt::format("{}", fmt::join(other_keys, ", "))
                                             : fmt::format("did you mean \"{}\"?", near)));
}

/// Rounds, so that 0.1 + 0.2 gives the 0.3 of a written list.
double rounded(double value) { return *number_in(fmt::format("{:.12g}", value)); }

std::vector<SettingValue> range_values(const TableReader& table, double from, double to,
                                       double step) {
  const std::string place = table.place_of("from");
  const double steps = (to - from) / step;
  if (!(steps >= 0.0) || !std::isfinite(steps))
    table.fail("step",
               fmt::format("found {}; expected a step that leads from {} to {}", step, from, to));
  if (steps >= static_cast<double>(max_axis_values))
    table.fail("step",
               fmt::format("found {:.3g} values; expected at most {}", steps, max_axis_values));
  std::vector<SettingValue> values;
  const auto count = static_cast<std::int64_t>(std::floor(steps * (1 + 1e-12) + 1e-9));
  for (std::int64_t i = 0; i <= count; ++i)
    values.push_back(setting_value(rounded(from + static_cast<double>(i) * step), place));
  return values;
}

std::vector<SettingValue> logarithmic_values(const TableReader& table, double from, double to,
                                             int count) {
  const std::string place = table.place_of("from");
  if (!(from > 0.0)) table.fail("from", fmt::format("found {}; expected a number > 0", from));
  if (!(to > 0.0)) table.fail("to", fmt::format("found {}; expected a number > 0", to));
  if (count < 2 || count > max_axis_values)
    table.fail("count", fmt::format("found {}; expected 2 to {}", count, max_axis_values));
  std::vector<SettingValue> values;
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    const double value = i + 1 == count ? to : from * std::pow(to / from, share);
    values.push_back(setting_value(rounded(value), place));
  }
  return values;
}

bool may_be_value(const std::string& line) {
  const auto is_of_a_word = [](char c) {
    return is_letter_or_digit(c) || std::string_view("+-_./").find(c) != std::string_view::npos;
  };
  const bool in_brackets = std::string_view("\"'[{").find(line.front()) != std::string_view::npos;
  return line.size() <= 4096 && (in_brackets || std::ranges::all_of(line, is_of_a_word));
}

/// Returns the value in TOML syntax.
std::string value_on_line(std::string_view line) {
  std::string_view text = trimmed(line);
  while (!text.empty() && std::string_view(",;\t ").find(text.back()) != std::string_view::npos)
    text.remove_suffix(1);
  const bool is_quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  std::string number(is_quoted ? text.substr(1, text.size() - 2) : text);
  if (std::ranges::count(number, ',') == 1) std::ranges::replace(number, ',', '.');
  if (number.starts_with('+')) number.erase(0, 1);
  return finite_number_in(number) ? number : std::string(text);
}

/// Recognizes "light.peak_factor" and "peak_factor".
bool is_name_of(const std::string& line, const std::vector<std::string>& keys) {
  return std::ranges::any_of(keys, [&](const std::string& key) {
    return line == key || (!line.empty() && key.ends_with("." + line));
  });
}

std::vector<SettingValue> file_values(const TableReader& table, const std::string& name,
                                      const std::vector<std::string>& keys) {
  const std::filesystem::path path = table.resolve("file", name);
  std::string text;
  try {
    text = read_text_file(path);
  } catch (const IoError& error) {
    table.fail("file", error.what());
  }
  std::vector<SettingValue> values;
  const std::vector<TextLine> lines = content_lines(text);
  for (const TextLine& line : lines) {
    const std::string value = value_on_line(line.text);
    const std::string place = fmt::format("{}:{}:{}", path.string(), line.number,
                                          line.text.find_first_not_of(" \t\r") + 1);
    if (&line == &lines.front() && is_name_of(value, keys)) continue;
    if (!may_be_value(value))  // do not print the line of a wrong file
      throw IoError(place,
                    "found a line that is not a value; expected a number, a word, a path or a text "
                    "in quotes");
    values.push_back(setting_value_of_line(value, place));
    if (const auto read = values.back().number; read && !is_measured(*read))
      throw IoError(place, fmt::format("found {}, which SCPI instruments return for invalid "
                                       "measurements; expected a measured value",
                                       value));
  }
  if (values.empty())
    table.fail("file",
               fmt::format("{} contains no values; expected one value per line", path.string()));
  return values;
}

void check_value(const SweepAxis& axis, const SettingValue& value) {
  ItemValues any;
  set_value(any, axis.key, value);
  if (any.options.seed >= std::uint64_t{1} << 53)  // exports contain doubles
    throw IoError(value.place, fmt::format("{}: found {}; expected an integer >= 0 below 2^53",
                                           axis.key, value.toml));
}

std::vector<std::string> read_axis_keys(TableReader& table) {
  std::vector<std::string> keys;
  if (!table.contains("keys")) {
    table.required("key", "\"light.peak_factor\"").value("key", keys.emplace_back());
    check_key(table, "key", keys.front());
    return keys;
  }
  table.refuse({"key"}, "no keys");
  table.value("keys", keys);
  if (keys.empty()) table.fail("keys", "found an empty list; expected at least one key");
  for (const std::string& key : keys) check_key(table, "keys", key);
  return keys;
}

/// Returns the elements of a list, else the value for each key.
/// @throws IoError for a list of another length
std::vector<SettingValue> values_of_keys(const SettingValue& entry,
                                         const std::vector<std::string>& keys) {
  if (keys.size() == 1 || !entry.text.starts_with('['))
    return std::vector<SettingValue>(keys.size(), entry);
  const Document document = parse_toml("entry = " + entry.text, entry.place);
  std::vector<SettingValue> values;
  for (const nlohmann::json& element : document.root().at("entry"))
    values.push_back(setting_value(element, entry.place));
  if (values.size() != keys.size())
    throw IoError(entry.place,
                  fmt::format("found {}; expected one value for all of {}, or a list of {}, one "
                              "for each",
                              entry.text, fmt::join(keys, ", "), keys.size()));
  return values;
}

/// @param keys  keys that the axis sets
/// @throws IoError naming file:line:column
std::vector<SettingValue> read_axis_entries(TableReader& table, const char* key,
                                            const std::vector<std::string>& keys) {
  std::vector<SettingValue> entries;
  const bool has_values = table.contains("values"), has_file = table.contains("file");
  if (has_values || has_file) {
    table.refuse({"from", "to", "step", "count"}, "no values and no file");
    if (has_values) table.refuse({"file"}, "no values");
    table.value("values", entries);
    if (has_values && entries.empty())
      table.fail("values", "found an empty list; expected at least one value");
    std::string file;
    table.value("file", file);
    if (has_file) entries = file_values(table, file, keys);
    return entries;
  }
  if (!table.contains("from"))
    table.fail(key,
               "found no values; expected values = [...], file = \"...\", or from, to and step "
               "(even) or count (logarithmic)");
  double from = 0.0, to = 0.0, step = 0.0;
  int count = 0;
  table.value("from", from);
  table.required("to", "1e5").value("to", to);
  if (table.contains("count")) {
    table.refuse({"step"}, "no count");
    table.value("count", count);
    return logarithmic_values(table, from, to, count);
  }
  table.required("step", "1").value("step", step);
  return range_values(table, from, to, step);
}

/// Returns an axis per key, all but the first linked.
std::vector<SweepAxis> read_sweep_axes(TableReader& table) {
  const std::vector<std::string> keys = read_axis_keys(table);
  const char* const field = table.contains("keys") ? "keys" : "key";
  std::string group;
  table.value("group", group);
  std::vector<SweepAxis> axes;
  for (const std::string& key : keys)
    axes.push_back(
        {.key = key, .place = table.place_of(field), .linked = !axes.empty(), .group = group});
  for (const SettingValue& entry : read_axis_entries(table, field, keys)) {
    std::vector<SettingValue> values = values_of_keys(entry, keys);
    for (std::size_t k = 0; k < keys.size(); ++k) axes[k].values.push_back(std::move(values[k]));
  }
  return axes;
}

/// @param unit  of a number in quotes that has a unit
template <typename Number>
std::optional<Number> number_of(const SettingValue& value, std::string_view unit) {
  if constexpr (std::is_floating_point_v<Number>) {
    if (value.toml == "inf") return infinity;
    const bool has_unit = !value.number && !number_in(value.text);
    return has_unit ? number_in_unit(value.text, unit) : value.number;
  } else {
    Number integer = 0;  // seeds can be larger than 2^53
    const char* const end = value.toml.data() + value.toml.size();
    const auto [stopped, error] = std::from_chars(value.toml.data(), end, integer);
    if (error == std::errc() && stopped == end) return integer;
    const double number = value.number.value_or(0.5);
    if (number != std::floor(number) || std::abs(number) >= 0x1p53 ||
        !std::in_range<Number>(static_cast<std::int64_t>(number)))
      return std::nullopt;
    return static_cast<Number>(number);
  }
}

template <typename Value>
void set_field(const Field<Value>& field, const SettingValue& value) {
  const auto refuse = [&](const std::string& expected) {
    throw IoError(value.place,
                  fmt::format("{}: found {}; expected {}", field.name, value.toml, expected));
  };
  if constexpr (HasWords<Value>) {
    constexpr auto& words = all_words<Value>;
    const auto word = std::ranges::find(words, value.text);
    if (word == words.end()) {
      const std::string near = nearest_word(value.text, words);
      refuse(fmt::format("one of \"{}\"{}", fmt::join(words, "\", \""),
                         near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
    }
    field.value = static_cast<Value>(word - words.begin());
  } else if constexpr (std::is_same_v<Value, bool>) {
    if (value.toml != "true" && value.toml != "false") refuse("true or false");
    field.value = value.toml == "true";
  } else if constexpr (std::is_same_v<Value, std::string>) {
    if (!value.toml.starts_with('"') || value.text.empty()) refuse("a name or file in quotes");
    field.value = value.text;
  } else {
    const std::optional<Value> number = number_of<Value>(value, field.unit());
    if (!number || !field.range.contains(static_cast<double>(*number)))
      refuse(fmt::format("{} {}", std::is_integral_v<Value> ? "an integer" : "a number",
                         field.range.is_restricted ? field.range.text(true) : ">= 0"));
    field.value = *number;
  }
}

template <typename Struct>
bool set_field_of(Struct& its, std::string_view key, const SettingValue& value) {
  bool is_set = false;
  for_each_field(its, [&](const auto& field) {
    if constexpr (HasFields<std::remove_cvref_t<decltype(field.value)>>) {
      is_set = set_field_of(field.value, key, value) || is_set;
    } else if (key == field.name) {
      set_field(field, value);
      is_set = true;
    }
  });
  return is_set;
}

/// Reads a key at the top level.
template <typename Value>
void read_field(TableReader& table, const Field<Value>& field) {
  if (!table.contains(field.name)) return;
  SettingValue value;
  table.value(field.name, value);
  set_field(field, value);
}

/// Reads `codes = [...]`, an axis that is combined with every other axis.
void read_codes(TableReader& table, SweepSpec& spec) {
  table.value("code", spec.code);
  std::vector<SettingValue> codes;
  table.value("codes", codes);
  if (!table.contains("codes")) return;
  if (table.contains("code")) table.refuse({"code"}, "no codes");
  if (codes.empty()) table.fail("codes", "found an empty list; expected at least one code");
  spec.axes.push_back({"code", std::move(codes), table.place_of("codes"), true});
}

bool has_axis(const SweepSpec& spec, std::string_view key) {
  return std::ranges::any_of(spec.axes, [&](const SweepAxis& axis) { return axis.key == key; });
}

void read_group(TableReader& table, SweepSpec& spec) {
  std::string name;
  SweepCombination combine = SweepCombination::zip;
  table.required("name", "\"optics\"").value("name", name);
  table.required("combine", "\"product\"").value("combine", combine);
  std::vector<std::string> names;
  for (const SweepAxis& axis : spec.axes)
    if (!axis.group.empty()) names.push_back(axis.group);
  if (std::ranges::find(names, name) == names.end()) {
    const std::string near = nearest_word(name, names);
    table.fail("name", fmt::format("found \"{}\", a group without axes{}", name,
                                   near.empty() ? "; expected a group of an axis"
                                                : fmt::format("; did you mean \"{}\"?", near)));
  }
  if (!spec.groups.emplace(name, combine).second)
    table.fail("name", fmt::format("found group \"{}\" a second time; expected one", name));
}

/// Axes and groups that advance together need equal lengths.
void check_lengths(const SweepSpec& spec) {
  const auto refuse = [&](std::size_t axis, const std::string& name, std::int64_t size,
                          const std::string& first_name, std::int64_t first_size,
                          const char* where) {
    throw IoError(spec.axes[axis].place,
                  fmt::format("{} has {} values and {} has {}; expected equal numbers {}", name,
                              size, first_name, first_size, where));
  };
  for (const std::vector<AxisBlock>& together : axis_blocks(spec))
    for (const AxisBlock& block : together) {
      const AxisBlock& first = together.front();
      if (block.size != first.size)
        refuse(block.digits.front().front(), name_of(spec, block), block.size, name_of(spec, first),
               first.size, "with combine = \"zip\"");
      for (const AxisDigit& digit : block.digits)
        for (const std::size_t a : digit) {
          const SweepAxis &axis = spec.axes[a], &before = spec.axes[digit.front()];
          if (axis.values.size() != before.values.size())
            refuse(a, "axis " + axis.key, static_cast<std::int64_t>(axis.values.size()), before.key,
                   static_cast<std::int64_t>(before.values.size()), "in a zipped group");
        }
    }
}

void check(const SweepSpec& spec) {
  if (spec.code.empty() && !has_axis(spec, "code"))
    throw IoError(spec.source_name,
                  "found no code; expected a line such as `codes = [\"hamiltonian-k4\"]`");
  for (std::size_t i = 0; i < spec.axes.size(); ++i) {
    const SweepAxis& axis = spec.axes[i];
    for (const SettingValue& value : axis.values) check_value(axis, value);
    for (std::size_t j = 0; j < i; ++j)
      if (spec.axes[j].key == axis.key)
        throw IoError(axis.place, fmt::format("axis {} occurs twice; the first is at {}", axis.key,
                                              spec.axes[j].place));
    if (axis.key == "code" && !spec.code.empty())
      throw IoError(axis.place, "found both an axis of codes and `code`; expected one of them");
  }
  check_lengths(spec);
  const auto asks_for_exposures = [](const std::string& code) {
    return code.find("{exposures}") != std::string::npos;
  };
  bool asked = asks_for_exposures(spec.code);
  for (const SweepAxis& axis : spec.axes)
    if (axis.key == "code")
      for (const SettingValue& value : axis.values) asked = asked || asks_for_exposures(value.text);
  if (asked != has_axis(spec, "exposures"))
    throw IoError(spec.source_name,
                  "an axis `exposures` and a code such as \"hamiltonian-k{exposures}\" require "
                  "each other; found one of them");
}

}  // namespace

bool set_value(ItemValues& item, std::string_view key, const SettingValue& value) {
  return set_field_of(item, key, value);
}

SweepSpec parse_sweep_toml(std::string_view text, std::string_view source_name) {
  const Document document = parse_toml(text, source_name);
  SweepSpec spec;
  spec.source_name = source_name;
  spec.directory = std::filesystem::path(source_name).parent_path();
  TableReader table(document);
  table.value("camera", spec.camera);
  table.value("set", spec.settings);
  table.value("combine", spec.combine);
  for_each_field(spec.options, [&](const auto& field) { read_field(table, field); });
  read_field(table, Field("effort", spec.effort, closed(0.01, 100)));
  read_codes(table, spec);
  table.tables("axis", [&](TableReader& inner) {
    for (SweepAxis& axis : read_sweep_axes(inner)) spec.axes.push_back(std::move(axis));
  });
  table.tables("group", [&](TableReader& inner) { read_group(inner, spec); });
  table.finish();
  check(spec);
  return spec;
}

SweepSpec read_sweep_toml(const std::filesystem::path& path) {
  return parse_sweep_toml(read_text_file(path, max_settings_file_bytes), path.string());
}

}  // namespace tofsmith
