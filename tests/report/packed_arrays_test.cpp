// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/packed_arrays.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace tofsmith::plotly {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

std::vector<std::uint8_t> bytes_of(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  unsigned buffer = 0;
  int bits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    buffer = buffer << 6 | static_cast<unsigned>(digits.find(c));
    if ((bits += 6) < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(buffer >> bits & 255));
  }
  return bytes;
}

/// As src/report/page.js does it.
std::vector<float> unpacked(const Json& array, std::size_t count, std::size_t columns) {
  const int bytes = array.at("bytes");
  const std::vector<std::uint8_t> packed = bytes_of(array.at("data"));
  std::vector<std::uint8_t> planes(count * static_cast<std::size_t>(bytes));
  uLongf size = planes.size();
  EXPECT_EQ(uncompress(planes.data(), &size, packed.data(), packed.size()), Z_OK);
  EXPECT_EQ(size, planes.size());
  const std::uint64_t mask = (std::uint64_t{1} << (8 * bytes)) - 1;
  std::vector<float> values;
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t word = array.at("is_difference") && i % columns > 0 ? before : 0;
    for (int b = 0; b < bytes; ++b)
      word += std::uint64_t{planes[static_cast<std::size_t>(b) * count + i]} << (8 * b);
    before = word &= mask;
    if (!array.contains("step")) {
      values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(word)));
    } else {
      const double multiple = static_cast<double>(word) - 1 + array.at("low").get<double>();
      values.push_back(word == 0 ? nan
                                 : static_cast<float>(multiple * array.at("step").get<double>()));
    }
  }
  return values;
}

/// What comes out of an array of rows of 8 that goes in.
std::vector<float> there_and_back(const std::vector<float>& values, double resolution) {
  Json json = {{"z", typed_array(values, {values.size() / 8, 8}, resolution)}};
  PackedArrays arrays;
  arrays.take_from(json);
  EXPECT_EQ(json, Json({{"z", {{"packed", 0}}}}));
  EXPECT_EQ(arrays.json().size(), 1U);
  return unpacked(arrays.json()[0], values.size(), 8);
}

std::vector<float> waves(float size, std::size_t count = 64) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(size * std::sin(0.7F * static_cast<float>(i)));
  return values;
}

TEST(PackedArrays, KeepEveryBitOfValuesWithoutAStep) {
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> values = waves(3e7F);
  values[3] = infinity;
  values[9] = -0.0F;
  values[10] = std::numeric_limits<float>::denorm_min();
  const std::vector<float> out = there_and_back(values, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint32_t>(out[i]), std::bit_cast<std::uint32_t>(values[i])) << i;
}

TEST(PackedArrays, RoundToNoMoreThanTheResolution) {
  for (const float size : {0.01F, 1.0F, 200.0F, 1e5F})
    for (const double resolution : {0.001, 0.3}) {
      std::vector<float> values = waves(size);
      values[5] = nan;
      const std::vector<float> out = there_and_back(values, resolution);
      for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(std::isnan(out[i]), i == 5) << i;
        if (i != 5) {
          EXPECT_LE(std::abs(out[i] - values[i]), 0.5 * resolution + 1e-7 * size) << i;
        }
      }
    }
}

TEST(PackedArrays, HoldPicturesWithoutValuesAndOfOneValue) {
  for (const float value : {nan, 0.0F, -3.5F}) {
    const std::vector<float> out = there_and_back(std::vector<float>(24, value), 0.5);
    for (const float one : out) EXPECT_TRUE(one == value || (std::isnan(value) && std::isnan(one)));
  }
}

TEST(PackedArrays, KeepValuesFarBeyondTheirStepAsTheyAre) {
  std::vector<float> values = waves(1.0F);
  values[7] = 3e30F;
  EXPECT_EQ(there_and_back(values, 1e-3), values);
}

TEST(PackedArrays, TakeLongListsOfNumbersAndLeaveOthers) {
  Json list = Json::array(), words = Json::array();
  for (int i = 0; i < 80; ++i) {
    list.push_back(i == 3 ? Json(nullptr) : Json(0.25 * i));
    words.push_back(i == 3 ? Json("word") : Json(i));
  }
  Json json = {{"x", list}, {"words", words}, {"short", {1, 2, 3}}};
  PackedArrays arrays;
  arrays.take_from(json);
  EXPECT_EQ(json, Json({{"x", {{"packed", 0}}}, {"words", words}, {"short", {1, 2, 3}}}));
  const std::vector<float> out = unpacked(arrays.json()[0], 80, 80);
  for (std::size_t i = 0; i < 80; ++i) {
    EXPECT_EQ(std::isnan(out[i]), i == 3);
    if (i != 3) {
      EXPECT_EQ(out[i], 0.25F * static_cast<float>(i));
    }
  }
}

TEST(PackedArrays, HoldTheSameArrayOnce) {
  PackedArrays arrays;
  const Json picture = typed_array(waves(1.0F), {8, 8}, 0.01),
             other = typed_array(waves(1.0F), {64});
  Json first = {{"a", picture}, {"b", {other, 5, "text"}}}, second = {{"c", picture}};
  arrays.take_from(first);
  arrays.take_from(second);
  EXPECT_EQ(arrays.json().size(), 2U);
  EXPECT_EQ(first["a"], second["c"]);
  EXPECT_NE(first["a"], first["b"][0]);
  EXPECT_EQ(first["b"][2], "text");
}

TEST(PackedArrays, AreSmallerThanTheNumbersOfAPicture) {
  std::vector<float> values = waves(10.0F, 64 * 64);
  const Json typed = typed_array(values, {64, 64}, 20.0 / 1024);
  Json json = typed;
  PackedArrays arrays;
  arrays.take_from(json);
  EXPECT_LT(4 * arrays.json()[0].dump().size(), typed.dump().size());
}

}  // namespace
}  // namespace tofsmith::plotly
