// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {

SettingValue toml_value_of(const toml::node& node, std::string place);

/// Integers are written without a fraction.
SettingValue toml_value_of(double number, std::string place);

/// A TOML file with settings applied, which stores the position of each value.
class TomlDocument {
 public:
  /// @param source_name  path, or name for error messages
  /// @throws IoError "file:line:column: ..." at the first syntax error
  TomlDocument(std::string_view text, std::string_view source_name);

  /// Applies one setting `key.key = value`. A word that is not a TOML value is a string. A table in
  /// braces replaces the existing one; `key.key =` without a value removes the key.
  /// @throws IoError for invalid syntax, or if there is no key to remove
  void apply(const std::string& setting);

  /// Sets the function that returns a key of another table to suggest for an unknown key.
  void suggest_keys(std::function<std::string(std::string_view)> suggestion) {
    suggestion_ = std::move(suggestion);
  }
  /// Returns the key to suggest for an unknown key; "" without one.
  std::string suggestion(std::string_view key) const { return suggestion_ ? suggestion_(key) : ""; }

  const toml::table& root() const { return root_; }
  const std::string& source_name() const { return source_name_; }
  /// Returns "file:line:column", or "setting 'light.peak_factor=5'".
  std::string place_of(const toml::source_region& region) const;
  /// Base of relative paths: the file's directory, or the current directory for a setting.
  std::filesystem::path directory_of(const toml::source_region& region) const;

 private:
  bool is_setting(const toml::source_region& region) const;

  std::string source_name_;
  toml::table root_;
  std::function<std::string(std::string_view)> suggestion_;
};

/// Reads the fields of one table. Missing fields keep their values. finish() rejects keys that were
/// not read.
///
/// Every member throws IoError with file:line:column, the key, the value found and the value
/// expected.
class TableReader {
 public:
  /// Positions by full key, such as "light.peak_factor".
  using Places = std::map<std::string, std::string>;

  /// Both arguments must outlive the reader.
  TableReader(const TomlDocument& document, Places& places);

  void value(std::string_view key, bool& target);
  void value(std::string_view key, int& target);
  void value(std::string_view key, double& target);
  void value(std::string_view key, std::string& target);
  void value(std::string_view key, std::vector<double>& target);
  void value(std::string_view key, std::vector<int>& target);
  void value(std::string_view key, std::vector<std::string>& target);
  /// Requires an integer >= 0 of at most 63 bits.
  void value(std::string_view key, std::uint64_t& target);
  void value(std::string_view key, std::vector<SettingValue>& target);
  /// Requires exactly three numbers.
  void value(std::string_view key, Eigen::Vector3d& target);
  /// Requires exactly two numbers.
  void value(std::string_view key, std::array<double, 2>& target);
  template <typename Value>
  void value(std::string_view key, std::optional<Value>& target) {
    if (contains(key)) value(key, target.emplace());
  }

  /// Returns the index of the word; none if the key is missing.
  std::optional<std::size_t> word(std::string_view key, std::span<const std::string_view> words);
  template <HasWords Enum>
  void choice(std::string_view key, Enum& target) {
    if (const auto index = word(key, words_of(Enum{}))) target = static_cast<Enum>(*index);
  }

  /// Accepts NaN and infinity: nan, inf, -inf, or these words in quotes.
  void raw_numbers(std::string_view key, std::vector<double>& target);

  void number_or_list(std::string_view key, double& number, std::vector<double>& list);
  /// `is_word` becomes true for `word`.
  void number_or_word(std::string_view key, double& number, std::string_view word, bool& is_word);

  /// Calls `fields(TableReader&, Value&)` if the table exists.
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

  std::optional<TableReader> enter(std::string_view key);
  /// Calls `fields(TableReader&)` for every table of a list [[key]], named key[0], key[1], ...
  template <typename Fields>
  void tables(std::string_view key, Fields&& fields) {
    for (TableReader& inner : enter_each(key)) {
      fields(inner);
      inner.finish();
    }
  }

  /// @param example  a value for the error message
  TableReader& required(std::string_view key, std::string_view example);
  /// As required(), but finish() throws, after it has looked for unknown keys.
  void required_at_end(std::string_view key, std::string_view example);
  /// Rejects keys that are only valid under a condition that is not met.
  /// @param condition  in the user's syntax, such as `kind = "hann"`
  void refuse(std::initializer_list<std::string_view> keys, std::string_view condition);

  bool contains(std::string_view key);
  /// Returns the key with its tables, such as "light.peak_factor".
  std::string full(std::string_view key) const { return prefix_ + std::string(key); }
  /// Position of the value, or of the table if the key is missing.
  std::string place_of(std::string_view key) const;
  /// Resolves a path relative to the file that contains the key.
  std::filesystem::path resolve(std::string_view key, const std::string& path) const;
  /// @throws IoError at place_of(key)
  [[noreturn]] void fail(std::string_view key, std::string_view problem) const;
  /// Rejects keys that were not read, with the most similar known one; then reports a missing key.
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
  IoError missing(std::string_view key, std::string_view example) const;

  std::vector<std::string> known_;
  std::optional<IoError> missing_;
};

}  // namespace tofsmith
