// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tofsmith {

inline std::vector<std::uint8_t> bytes_of_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count));
  }
  return bytes;
}

/// Returns the values of a packed array, like unpacked() of viewer/figures.js.
inline std::vector<float> unpacked(const nlohmann::json& array) {
  const auto count = array.at("count").get<std::size_t>(), row = array.at("row").get<std::size_t>();
  const std::vector<std::uint8_t> packed = bytes_of_base64(array.at("words"));
  std::vector<std::uint8_t> planes(2 * count);
  uLongf size = planes.size();
  EXPECT_EQ(uncompress(planes.data(), &size, packed.data(), packed.size()), Z_OK);
  EXPECT_EQ(size, planes.size());
  std::vector<float> values;
  std::uint16_t word = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % row == 0) word = 0;
    word = static_cast<std::uint16_t>(word + planes[i] + 256 * planes[count + i]);
    const double multiple = word - 1 + array.at("low").get<double>();
    values.push_back(word == 0 ? std::numeric_limits<float>::quiet_NaN()
                               : static_cast<float>(multiple * array.at("step").get<double>()));
  }
  return values;
}

}  // namespace tofsmith
