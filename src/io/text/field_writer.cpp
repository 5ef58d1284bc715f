// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/text/field_writer.hpp"

#include <cmath>

#include "core/shared/overloaded.hpp"

namespace tofsmith {

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
