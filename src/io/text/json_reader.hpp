// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Value of a JSON document and its path. Every member throws IoError "file: /json/pointer: found
/// ...; expected ...".
class JsonReader {
 public:
  /// Both arguments must outlive the reader. @param file  name in error messages
  JsonReader(const nlohmann::json& document, std::string_view file);

  double number() const;
  /// Requires a number in [low, high].
  double number(double low, double high, double tolerance) const;
  bool is_null() const { return value_->is_null(); }
  bool boolean() const;
  int integer(int low, int high) const;
  std::uint64_t unsigned_integer() const;
  std::string text() const;
  std::string dump() const { return value_->dump(); }

  /// @param count  required number; `because` explains it in errors
  std::vector<JsonReader> elements() const;
  std::vector<JsonReader> elements(std::size_t count, std::string_view because) const;

  /// Rejects other members; suggests the most similar known one.
  void only(std::initializer_list<std::string_view> members) const;
  JsonReader member(std::string_view name) const;
  std::optional<JsonReader> optional_member(std::string_view name) const;

  [[noreturn]] void fail(std::string_view problem) const;
  [[noreturn]] void mistyped(std::string_view expected) const;

 private:
  JsonReader(const nlohmann::json& value, std::string_view file, std::string pointer);
  void check_object() const;

  const nlohmann::json* value_;
  std::string_view file_;
  std::string pointer_;
};

}  // namespace tofsmith
