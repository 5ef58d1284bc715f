// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/shared/enum_words.hpp"

namespace tofsmith {

/// Writes the fields of one table, in the order in which they are named. The counterpart of
/// TableReader: what describes a table for the one describes it for the other.
class TableWriter {
 public:
  static constexpr bool reads = false;

  template <typename Value>
  void value(std::string_view key, const Value& value) {
    document_[std::string(key)] = value;
  }
  template <typename Value>
  void value(std::string_view key, const std::optional<Value>& optional) {
    if (optional) value(key, *optional);
  }
  template <typename Enum, std::size_t Count>
  void choice(std::string_view key, Enum chosen, const EnumWords<Enum, Count>& words) {
    value(key, std::string(words.of(chosen)));
  }
  void number_or_list(std::string_view key, double number, const std::vector<double>& list) {
    list.empty() ? value(key, number) : value(key, list);
  }
  void number_or_word(std::string_view key, double number, std::string_view word, bool is_word) {
    is_word ? value(key, std::string(word)) : value(key, number);
  }
  /// Raw numbers; NaN and infinity are written as words. An empty list is left out.
  void markers(std::string_view key, const std::vector<double>& numbers) {
    auto list = nlohmann::ordered_json::array();
    for (const double number : numbers) {
      if (std::isfinite(number))
        list.push_back(number);
      else
        list.push_back(std::isnan(number) ? "nan" : number > 0.0 ? "inf" : "-inf");
    }
    if (!list.empty()) value(key, list);
  }
  template <typename Value, typename Fields>
  void table(std::string_view key, const Value& source, Fields&& fields) {
    TableWriter inner;
    fields(inner, source);
    if (!inner.document_.empty()) value(key, inner.document_);
  }
  template <typename Value, typename Fields>
  void part(const std::optional<Value>& source, std::initializer_list<std::string_view> /*keys*/,
            Fields&& fields) {
    if (source) fields(*this, *source);
  }
  template <typename Value, typename Fields>
  void table(std::string_view key, const std::optional<Value>& source, Fields&& fields) {
    if (source) table(key, *source, fields);
  }
  TableWriter& required(std::string_view /*key*/, std::string_view /*example*/) { return *this; }
  void refuse(std::initializer_list<std::string_view> /*keys*/, std::string_view /*condition*/) {}

  const nlohmann::ordered_json& document() const { return document_; }

 private:
  nlohmann::ordered_json document_ = nlohmann::ordered_json::object();
};

}  // namespace tofsmith
