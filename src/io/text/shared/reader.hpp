// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {

/// Names of values in errors: keys as in "light.peak_factor" and "box[0].size_m", or JSON pointers.
/// TOML also accepts numbers with a unit in quotes, and integers such as 1e4.
enum class Syntax { toml, json };

/// A parsed TOML or JSON file: a tree of values. Values of TOML have positions.
class Document {
 public:
  /// Line and column, or the setting that replaced the value of the file.
  struct Position {
    std::uint32_t line = 1, column = 1;
    std::string setting = {};
  };
  struct KeyAndValue {
    Position key, value;
  };
  /// Places of all values except the root.
  using Positions = std::unordered_map<const nlohmann::json*, KeyAndValue>;

  Document(nlohmann::json root, std::string_view source_name, Syntax syntax,
           std::optional<Positions> positions = {})
      : root_(std::move(root)),
        source_name_(source_name),
        syntax_(syntax),
        positions_(std::move(positions)) {}
  /// Positions belong to addresses of values, which moves keep.
  Document(Document&&) = default;
  Document& operator=(Document&&) = default;
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  /// Sets the function that returns a key of another table to suggest for an unknown key.
  void suggest_keys(std::function<std::string(std::string_view)> suggestion) {
    suggestion_ = std::move(suggestion);
  }
  /// Returns the key to suggest for an unknown key; "" without one.
  std::string suggestion(std::string_view key) const { return suggestion_ ? suggestion_(key) : ""; }

  nlohmann::json& root() { return root_; }
  const nlohmann::json& root() const { return root_; }
  const std::string& source_name() const { return source_name_; }
  Syntax syntax() const { return syntax_; }
  /// Returns "file:line:column", or "setting 'light.peak_factor=5'"; for JSON the file.
  std::string place_of(const nlohmann::json& value) const;
  std::string place_of_key(const nlohmann::json& value) const;
  /// Returns the place of a field such as "light.waveform level" or "order[2]", or else of the
  /// innermost table that contains it.
  std::string place_of_field(std::string_view field) const;
  /// Returns the value's name in errors; "" for the root.
  std::string name_of(const nlohmann::json& value) const;
  /// Base of relative paths: the file's directory, or the current directory for a setting.
  std::filesystem::path directory_of(const nlohmann::json& value) const;

 private:
  KeyAndValue positions_of(const nlohmann::json& value) const;
  std::string text_of(const Position& position) const;

  nlohmann::json root_;
  std::string source_name_;
  Syntax syntax_;
  std::optional<Positions> positions_;
  std::function<std::string(std::string_view)> suggestion_;
};

/// Parses a TOML file and applies settings. A word in a setting that is not a TOML value is a
/// string. A table in braces replaces the existing one; `key.key =` without a value removes the
/// key.
/// @param source_name  path, or name for error messages
/// @throws IoError "file:line:column: ..." at the first syntax error; for a key that is not there
///   to remove
Document parse_toml(std::string_view text, std::string_view source_name, Settings settings = {});

/// Returns a value in TOML syntax. Decimals that are whole have no fraction.
SettingValue setting_value(const nlohmann::json& value, std::string place);

/// Reads one value of a document. Every member throws IoError "place: name: found ...; expected
/// ...".
class ValueReader {
 public:
  /// The document must outlive the reader.
  explicit ValueReader(const Document& document) : ValueReader(document, document.root()) {}

  bool is_null() const { return value_->is_null(); }
  /// @param expected  for the error message
  double number(std::string_view expected = "a number") const;
  /// Requires a number in [low, high].
  double number(double low, double high, double tolerance) const;
  bool boolean() const;
  int integer(int low = std::numeric_limits<int>::min(),
              int high = std::numeric_limits<int>::max()) const;
  std::uint64_t unsigned_integer() const;
  std::string text() const;
  /// Returns the index of the word.
  std::size_t word(std::span<const std::string_view> words) const;

  std::vector<ValueReader> elements(std::string_view expected = "a list") const;
  /// @param count  required number; `because` explains it in errors
  std::vector<ValueReader> elements(std::size_t count, std::string_view because) const;

  void read(bool& target) const { target = boolean(); }
  void read(int& target) const { target = integer(); }
  void read(double& target) const { target = number(); }
  void read(std::string& target) const { target = text(); }
  void read(std::uint64_t& target) const { target = unsigned_integer(); }
  void read(std::int64_t& target) const { target = static_cast<std::int64_t>(unsigned_integer()); }
  void read(SettingValue& target) const { target = setting_value(*value_, place()); }
  void read(std::vector<double>& target) const { read_list(target, "a list of numbers"); }
  void read(std::vector<std::string>& target) const {
    read_list(target, "a list of texts in quotes");
  }
  void read(std::vector<SettingValue>& target) const { read_list(target, "a list of values"); }
  void read(std::vector<int>& target) const;
  void read(Eigen::Vector3d& target) const;
  void read(std::array<double, 2>& target) const;
  /// Accepts NaN and infinity: nan, inf, -inf, or these words in quotes.
  void read_raw(std::vector<double>& target) const;
  void read_number_or_list(double& number, std::vector<double>& list) const;
  /// `is_word` becomes true for `word`.
  void read_number_or_word(double& number, std::string_view word, bool& is_word) const;

  /// Rejects other members; suggests the most similar known one.
  void only(std::initializer_list<std::string_view> members) const;
  ValueReader member(std::string_view name) const;
  std::optional<ValueReader> optional_member(std::string_view name) const;

  std::string name() const { return document_->name_of(*value_); }
  std::string place() const { return document_->place_of(*value_); }
  [[noreturn]] void fail(std::string_view problem) const;
  [[noreturn]] void mistyped(std::string_view expected) const;

 protected:
  ValueReader(const Document& document, const nlohmann::json& value, std::string_view key = {})
      : document_(&document), value_(&value), key_(key) {}
  bool is_toml() const { return document_->syntax() == Syntax::toml; }
  void require_table(std::string_view expected) const;

  const Document* document_;
  const nlohmann::json* value_;
  std::string_view key_;  ///< of the value or of the list that contains it

 private:
  std::vector<double> numbers(std::size_t count, std::string_view expected) const;
  template <typename Item>
  void read_list(std::vector<Item>& list, std::string_view expected) const {
    list.clear();
    for (const ValueReader& element : elements(expected)) element.read(list.emplace_back());
  }
};

/// Reads the keys of one table. Missing keys, and null for optional values, leave values unchanged.
/// finish() rejects keys that were not read.
class TableReader : public ValueReader {
 public:
  /// @param expected  for the error message
  explicit TableReader(const ValueReader& table, std::string_view expected = "a table")
      : ValueReader(table) {
    require_table(expected);
  }
  explicit TableReader(const Document& document) : TableReader(ValueReader(document)) {}

  /// Returns the value, and marks the key as known.
  std::optional<ValueReader> find(std::string_view key);
  bool contains(std::string_view key) { return find(key).has_value(); }

  template <typename Value>
  void value(std::string_view key, Value& target) {
    if (const auto found = find(key)) found->read(target);
  }
  template <typename Value>
  void value(std::string_view key, std::optional<Value>& target) {
    if (const auto found = find(key); found && !found->is_null()) value(key, target.emplace());
  }
  template <HasWords Enum>
  void value(std::string_view key, Enum& target) {
    if (const auto found = find(key)) target = static_cast<Enum>(found->word(all_words<Enum>));
  }

  /// Calls `fields(TableReader&, Value&)` if the table exists.
  template <typename Value, typename Fields>
  void table(std::string_view key, Value& target, Fields&& fields) {
    if (const auto found = find(key)) {
      TableReader inner(*found);
      fields(inner, target);
      inner.finish();
    }
  }
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

  /// Returns the key with its tables, such as "light.peak_factor".
  std::string full(std::string_view key) const;
  /// Position of the value, or of the table if the key is missing.
  std::string place_of(std::string_view key) const;
  /// Resolves a path relative to the file that contains the key.
  std::filesystem::path resolve(std::string_view key, const std::string& path) const;
  /// @throws IoError at place_of(key)
  [[noreturn]] void fail(std::string_view key, std::string_view problem) const;
  /// Rejects keys that were not read, with the most similar known one; then reports a missing key.
  void finish() const;

 private:
  const nlohmann::json& value_or_table(std::string_view key) const;
  std::vector<TableReader> enter_each(std::string_view key);
  IoError missing(std::string_view key, std::string_view example) const;

  std::vector<std::string> known_;
  std::optional<IoError> missing_;
};

}  // namespace tofsmith
