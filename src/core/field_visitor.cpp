// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/field_visitor.hpp"

#include <fmt/format.h>

#include "core/shared/overloaded.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

std::string_view name_of(ValueType type) {
  constexpr std::array<std::string_view, 13> names = {
      "boolean",     "integer",     "number", "text",           "numbers",
      "integers",    "number_pair", "choice", "number_or_list", "number_or_word",
      "raw_numbers", "path",        "table"};
  return names.at(static_cast<std::size_t>(type));
}

KeyDescription& KeyList::add(const Key& key, ValueType type) {
  // A part of a part is absent by default.
  const bool may_be_absent = std::exchange(is_optional_, false) || parts_.size() > 2;
  return keys.emplace_back(KeyDescription{.name = prefixes_.back() + std::string(key.name),
                                          .part = parts_.back(),
                                          .type = type,
                                          .may_be_absent = may_be_absent,
                                          .key = key});
}

void KeyList::visit(const Key& key, const Value& value) {
  // Order of the alternatives of Value.
  constexpr std::array<ValueType, std::variant_size_v<Value>> types = {
      ValueType::boolean,        ValueType::integer,     ValueType::number,
      ValueType::text,           ValueType::numbers,     ValueType::integers,
      ValueType::number_pair,    ValueType::choice,      ValueType::number_or_list,
      ValueType::number_or_word, ValueType::raw_numbers, ValueType::path};
  KeyDescription& added = add(key, types.at(value.index()));
  if (const auto* choice = std::get_if<WordChoice*>(&value))
    added.words.assign((*choice)->words.begin(), (*choice)->words.end());
  if (const auto* either = std::get_if<NumberOrWord>(&value))
    added.words.emplace_back(either->word);
}

bool KeyList::wants(const Key& /*key*/, bool /*is_there*/) { return is_optional_ = true; }

bool KeyList::enter(const Key& key) {
  const std::string name = add(key, ValueType::table).name;
  prefixes_.push_back(name + ".");
  return true;
}

bool KeyList::enter_part(const Key& key, std::span<const std::string> /*names*/,
                         bool /*is_there*/) {
  // A part of a part is listed under the outer one.
  parts_.push_back(parts_.back().empty() ? std::string(key.name) : parts_.back());
  return true;
}

void RangeCheck::visit(const Key& key, const Value& value) {
  const auto check = [&](double number, bool is_integer, const std::string& index = "") {
    if (key.range.contains(number)) return;
    reject(prefix() + std::string(key.name) + index, detail::describe(number),
           fmt::format("must be {}{}{}", key.range.text(is_integer), key.reason.empty() ? "" : ": ",
                       key.reason));
  };
  const auto check_each = [&](const auto& numbers, bool is_integer) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      check(static_cast<double>(numbers[i]), is_integer, fmt::format("[{}]", i));
  };
  std::visit(Overloaded{
                 [&](int* number) { check(*number, true); },
                 [&](double* number) { check(*number, false); },
                 [&](std::vector<double>* numbers) { check_each(*numbers, false); },
                 [&](std::vector<int>* numbers) { check_each(*numbers, true); },
                 [&](std::array<double, 2>* numbers) { check_each(*numbers, false); },
                 [&](const NumberOrList& either) {
                   if (either.list.empty())
                     check(either.number, false);
                   else
                     check_each(either.list, false);
                 },
                 [&](const NumberOrWord& either) { check(either.number, false); },
                 [](const auto& /*no_number*/) {},
             },
             value);
}

}  // namespace tofsmith
