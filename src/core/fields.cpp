// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <variant>

#include "core/shared/overloaded.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

std::string full_help(std::string_view unit, std::string_view help, std::string_view only_with,
                      std::string_view if_absent) {
  std::string text(help);
  if (!unit.empty()) {
    std::size_t end_of_noun = text.size();
    for (const std::string_view mark : {";", ":", ". "})
      end_of_noun = std::min(end_of_noun, text.find(mark));
    text.insert(end_of_noun, fmt::format(" [{}]", unit));
  }
  if (!if_absent.empty()) text += fmt::format(" (default: {})", if_absent);
  if (!only_with.empty()) text += fmt::format("; only with {}", only_with);
  return text;
}

std::string error_name(std::string_view name) {
  for (const std::string_view end : {"_m", "_mde"})
    if (name.ends_with(end)) name.remove_suffix(end.size());
  return std::string(name) + "_se_m";
}

int scaled_count(int count, double effort, ByEffort by_effort) {
  return std::max(by_effort.min, static_cast<int>(std::lround(effort * count)));
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

std::string Range::text(bool is_integer) const {
  if (!is_restricted) return "a number";
  if (std::isfinite(high))
    return fmt::format("in {}{}, {}{}", includes_low ? '[' : '(', low, high,
                       includes_high ? ']' : ')');
  if (!std::isfinite(low)) return "finite";
  return fmt::format("{}{} {}", is_integer || includes_infinity ? "" : "finite and ",
                     includes_low ? ">=" : ">", low);
}

void UnusualNumbers::visit(const Key& key, const Value& value) {
  constexpr double far = 10.0;
  if (!(key.usual_high > key.usual_low)) return;
  const auto check = [&](double number) {
    if (number == 0.0 || !std::isfinite(number)) return;
    if (number * far >= key.usual_low && number <= key.usual_high * far) return;
    std::string unit(unit_of_key(key.name));
    if (!unit.empty()) unit.insert(0, " ");
    notes.push_back(fmt::format("{}{} = {:g}{}; most cameras have {:g} to {:g}{}; check the unit",
                                prefix(), key.name, number, unit, key.usual_low, key.usual_high,
                                unit));
  };
  std::visit(Overloaded{
                 [&](int* number) { check(*number); },
                 [&](double* number) { check(*number); },
                 [&](const NumberOrList& either) {
                   if (either.list.empty()) check(either.number);
                 },
                 [](const auto& /*not_one_number*/) {},
             },
             value);
}

}  // namespace tofsmith
