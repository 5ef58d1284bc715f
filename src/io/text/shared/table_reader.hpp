// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/shared/enum_words.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {

/// A value taken out of a TOML file.
SettingValue toml_value_of(const toml::node& node, std::string place);

/// A number as TOML writes it: whole ones as integers.
SettingValue toml_value_of(double number, std::string place);

/// What a line of a file holds: a number, or else a text.
SettingValue toml_value_of_line(const std::string& line, std::string place);

/// A TOML file with settings laid over it, which knows where each of its values was written.
class TomlDocument {
 public:
  /// @param source_name  the file's path, or what errors shall call the text
  /// @throws IoError "file:line:column: .." at the first character that is no TOML
  TomlDocument(std::string_view text, std::string_view source_name);

  /// Lays one `key.key = value` over the document, as if the file had said so. A word that is no
  /// TOML value is a string, so that shells need no second pair of quotes. A table in braces
  /// replaces the one before; other keys of a table stay. `key.key =` without a value takes the
  /// key out.
  /// @throws IoError if that is no TOML, or there is no key to take out
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

/// Reads the fields of one table of a TOML document. A field that is not there keeps the value it
/// has. Every field that is asked for is known; finish() refuses all others.
///
/// Every member throws IoError that names file:line:column, the key, what was found and what was
/// expected.
class TableReader {
 public:
  /// Where each value that was read stands, by its full key such as "light.peak_factor".
  using Places = std::map<std::string, std::string>;

  /// The whole document. Both must outlive the reader.
  TableReader(const TomlDocument& document, Places& places);

  void value(std::string_view key, bool& target);
  void value(std::string_view key, int& target);
  void value(std::string_view key, double& target);
  void value(std::string_view key, std::string& target);
  /// A list of numbers.
  void value(std::string_view key, std::vector<double>& target);
  /// A list of integers.
  void value(std::string_view key, std::vector<int>& target);
  /// A list of texts.
  void value(std::string_view key, std::vector<std::string>& target);
  /// An integer >= 0 of at most 63 bits.
  void value(std::string_view key, std::uint64_t& target);
  /// A list of values of any kind.
  void value(std::string_view key, std::vector<SettingValue>& target);
  /// A list of exactly three numbers.
  void value(std::string_view key, Eigen::Vector3d& target);
  /// A list of exactly two numbers.
  void value(std::string_view key, std::array<double, 2>& target);
  template <typename Value>
  void value(std::string_view key, std::optional<Value>& target) {
    if (contains(key)) value(key, target.emplace());
  }

  /// Index of the word in a fixed set; none if the key is not there.
  std::optional<std::size_t> word(std::string_view key, std::span<const std::string_view> words);
  template <typename Enum, std::size_t Count>
  void choice(std::string_view key, Enum& target, const EnumWords<Enum, Count>& words) {
    if (const auto index = word(key, words.all())) target = static_cast<Enum>(*index);
  }

  /// A list of raw numbers, which may be NaN or infinite: nan, inf, -inf, or these words in quotes.
  void raw_numbers(std::string_view key, std::vector<double>& target);

  /// A number, or a list of them.
  void number_or_list(std::string_view key, double& number, std::vector<double>& list);
  /// A number, or `word`, in which case `is_word`.
  void number_or_word(std::string_view key, double& number, std::string_view word, bool& is_word);

  /// Reads a nested table when it is there: `fields(TableReader&, Value&)`.
  template <typename Value, typename Fields>
  void table(std::string_view key, Value& target, Fields&& fields) {
    if (auto inner = enter(key)) {
      fields(*inner, target);
      inner->finish();
    }
  }
  template <typename Value, typename Fields>
  void table(std::string_view key, std::optional<Value>& target, Fields&& fields) {
    if (contains(key)) table(key, target.emplace(), fields);
  }

  /// The nested table, if it is there.
  std::optional<TableReader> enter(std::string_view key);
  /// Reads every table of a list of them, [[key]]: `fields(TableReader&)`. They are called key[0],
  /// key[1] ..
  template <typename Fields>
  void tables(std::string_view key, Fields&& fields) {
    for (TableReader& inner : enter_each(key)) {
      fields(inner);
      inner.finish();
    }
  }

  /// The next field must be there. @param example  a value to show the user
  TableReader& required(std::string_view key, std::string_view example);
  /// Refuses keys that mean something only under a condition that does not hold.
  /// @param condition  as the user would write it, such as `kind = "hann"`
  void refuse(std::initializer_list<std::string_view> keys, std::string_view condition);

  bool contains(std::string_view key);
  /// The key with the tables that contain it, such as "light.peak_factor".
  std::string full(std::string_view key) const { return prefix_ + std::string(key); }
  /// Where the value of `key` was written, or the table if the key is not there.
  std::string place_of(std::string_view key) const;
  /// The path in `key`, from where it was written.
  std::filesystem::path resolve(std::string_view key, const std::string& path) const;
  /// @throws IoError about the value of `key`, or about the table if the key is not there
  [[noreturn]] void fail(std::string_view key, std::string_view problem) const;
  /// Refuses keys that nobody asked for, with the nearest one that was.
  void finish() const;

 private:
  TableReader(const TomlDocument& document, Places& places, const toml::table& table,
              std::string prefix);
  const toml::node* find(std::string_view key);
  std::vector<TableReader> enter_each(std::string_view key);
  std::vector<double> numbers(std::string_view key, const toml::node& node, std::size_t count,
                              std::string_view expected) const;
  double finite_number(const std::string& name, const toml::node& node,
                       std::string_view expected) const;
  std::vector<double> number_list(const std::string& name, const toml::array& list) const;
  [[noreturn]] void mistyped(const std::string& name, const toml::node& node,
                             std::string_view expected) const;

  const TomlDocument& document_;
  Places& places_;
  const toml::table& table_;
  std::string prefix_;  // "" or "light."
  std::vector<std::string> known_;
};

}  // namespace tofsmith
