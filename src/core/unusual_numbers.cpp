// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/unusual_numbers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <variant>

#include "core/shared/overloaded.hpp"

namespace tofsmith {

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
