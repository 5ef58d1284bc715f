// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/unit_text.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <tuple>
#include <utility>

#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

TEST(UnitText, ConvertsNumbersToTheUnitOfAKey) {
  for (const auto& [text, unit, number] :
       {std::tuple<std::string_view, std::string_view, double>{"20e6", "Hz", 20e6},
        {"20MHz", "Hz", 20e6},
        {" 1.5 GHz ", "Hz", 1.5e9},
        {"2m", "m", 2.0},
        {"5 mm", "m", 0.005},
        {"10 um", "m", 1e-5},
        {"20 ms", "s", 0.02},
        {"100ns", "s", 100e-9},
        {"2m/s", unit_of_key("velocity_m_per_s"), 2.0},
        {"30 cm/s", unit_of_key("velocity_m_per_s"), 0.3},
        {"20klx", "klx", 20.0},
        {"20000 lux", "klx", 20.0},
        {"1 GB", "MB", 1000.0},
        {"45deg", "degrees", 45.0},
        {"+3", "m", 3.0},
        {"1e4", "", 1e4}})
    EXPECT_DOUBLE_EQ(number_in_unit(text, unit).value_or(-1.0), number) << text;
}

TEST(UnitText, RejectsOtherUnitsAndText) {
  for (const auto& [text, unit] : {std::pair<std::string_view, std::string_view>{"20kg", "m"},
                                   {"20MHz", "s"},
                                   {"2m", ""},
                                   {"many", "m"},
                                   {"", "m"},
                                   {"2 m m", "m"},
                                   {"0,02", "m"}})
    EXPECT_FALSE(number_in_unit(text, unit)) << text;
}

}  // namespace
}  // namespace tofsmith
