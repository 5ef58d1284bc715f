// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/text/field_toml.hpp"

#include <algorithm>
#include <cmath>

#include "core/shared/overloaded.hpp"

namespace tofsmith {

void FieldReader::visit(const Key& key, const Value& value) {
  if (!key.example.empty()) table().required_at_end(key.name, key.example);
  const auto found = table().find(key.name);
  if (!found) return;
  std::visit(Overloaded{
                 [&](WordChoice* choice) { choice->chosen = found->word(choice->words); },
                 [&](const NumberOrList& either) {
                   found->read_number_or_list(either.number, either.list);
                 },
                 [&](const NumberOrWord& either) {
                   found->read_number_or_word(either.number, either.word, either.is_word);
                 },
                 [&](const RawNumberList& raw) { found->read_raw(raw.numbers); },
                 [&](const InputPath& input) {
                   found->read(input.path);
                   if (input.path.empty()) return;
                   // Absolute, so that the struct can be read back from another directory.
                   const auto path =
                       std::filesystem::absolute(table().resolve(key.name, input.path));
                   input.path = path.lexically_normal().string();
                   files_[found->name()] = input.path;
                 },
                 [&](auto* target) { found->read(*target); },
             },
             value);
}

bool FieldReader::wants(const Key& key, bool /*is_there*/) { return table().contains(key.name); }

bool FieldReader::enter_part(const Key& /*key*/, std::span<const std::string> names,
                             bool /*is_there*/) {
  // Check all names, so that each becomes known as a suggestion for misspelled keys.
  return std::count_if(names.begin(), names.end(),
                       [&](const auto& name) { return table().contains(name); }) > 0;
}

void FieldReader::refuse(const Key& key, const Value& /*value*/) {
  table().refuse({key.name}, key.condition);
}

bool FieldReader::enter(const Key& key) {
  const auto found = table().find(key.name);
  if (found) inner_.emplace_back(*found);
  return found.has_value();
}

void FieldReader::leave() {
  inner_.back().finish();
  inner_.pop_back();
}

namespace {

nlohmann::ordered_json raw_numbers_json(const std::vector<double>& numbers) {
  auto list = nlohmann::ordered_json::array();
  for (const double number : numbers) {
    if (std::isfinite(number))
      list.push_back(number);
    else
      list.push_back(std::isnan(number) ? "nan" : number > 0.0 ? "inf" : "-inf");
  }
  return list;
}

}  // namespace

void FieldWriter::visit(const Key& key, const Value& value) {
  nlohmann::ordered_json& table = tables_.back();
  const std::string name(key.name);
  std::visit(Overloaded{
                 [&](const WordChoice* choice) { table[name] = choice->words[choice->chosen]; },
                 [&](const NumberOrList& either) {
                   if (either.list.empty())
                     table[name] = either.number;
                   else
                     table[name] = either.list;
                 },
                 [&](const NumberOrWord& either) {
                   if (either.is_word)
                     table[name] = either.word;
                   else
                     table[name] = either.number;
                 },
                 [&](const RawNumberList& raw) {
                   if (!raw.numbers.empty()) table[name] = raw_numbers_json(raw.numbers);
                 },
                 [&](const InputPath& input) {
                   if (!input.path.empty()) table[name] = input.path;
                 },
                 [&](const auto* source) { table[name] = *source; },
             },
             value);
}

bool FieldWriter::enter(const Key& key) {
  tables_.emplace_back(nlohmann::ordered_json::object());
  names_.emplace_back(key.name);
  return true;
}

void FieldWriter::leave() {
  nlohmann::ordered_json table = std::move(tables_.back());
  tables_.pop_back();
  if (!table.empty()) tables_.back()[names_.back()] = std::move(table);
  names_.pop_back();
}

}  // namespace tofsmith
