// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/packed_arrays.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "tofsmith/core/error.hpp"

namespace tofsmith::plotly {
namespace {

/// Numbers of some bytes each.
struct Words {
  std::vector<std::uint32_t> values;
  int bytes = 4;
  std::optional<std::int64_t> low;  ///< of rounded ones
};

/// Whole multiples of `step`; none if they do not fit into 31 bits.
std::optional<Words> rounded(const std::vector<float>& values, double step) {
  std::int64_t low = std::numeric_limits<std::int64_t>::max();
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    const double multiple = std::round(static_cast<double>(value) / step);
    if (std::abs(multiple) >= 1 << 30) return std::nullopt;
    low = std::min(low, static_cast<std::int64_t>(multiple));
  }
  Words words{.values = {}, .bytes = 1, .low = low};
  std::uint64_t largest = 0;
  if (low == std::numeric_limits<std::int64_t>::max()) words.low = 0;  // nothing to see
  for (const float value : values) {
    std::int64_t word = 0;
    if (std::isfinite(value))
      word = static_cast<std::int64_t>(std::round(static_cast<double>(value) / step)) - low + 1;
    words.values.push_back(static_cast<std::uint32_t>(word));
    largest = std::max(largest, static_cast<std::uint64_t>(word));
  }
  while (largest >> (8 * words.bytes) != 0) ++words.bytes;
  return words;
}

Words bits_of(const std::vector<float>& values) {
  Words words;
  for (const float value : values) words.values.push_back(std::bit_cast<std::uint32_t>(value));
  return words;
}

/// What each number of a row is beyond the one before, as far as its bytes hold it.
void take_differences(Words& words, std::size_t row) {
  for (std::size_t first = 0; first < words.values.size(); first += row) {
    const std::size_t end = std::min(first + row, words.values.size());
    for (std::size_t i = end - 1; i > first; --i) words.values[i] -= words.values[i - 1];
  }
}

std::vector<std::uint8_t> deflated(const Words& words) {
  std::vector<std::uint8_t> planes;
  planes.reserve(words.values.size() * static_cast<std::size_t>(words.bytes));
  for (int b = 0; b < words.bytes; ++b)
    for (const std::uint32_t value : words.values)
      planes.push_back(static_cast<std::uint8_t>(value >> (8 * b) & 255));
  uLongf size = compressBound(planes.size());
  std::vector<std::uint8_t> packed(size);
  const int done =
      compress2(packed.data(), &size, planes.data(), planes.size(), Z_DEFAULT_COMPRESSION);
  require(done == Z_OK, "zlib", done, "must be 0: out of memory");
  packed.resize(size);
  return packed;
}

std::size_t row_of(const std::string& shape, std::size_t count) {
  const auto comma = shape.find(',');
  const std::size_t columns =
      comma == std::string::npos ? count : std::stoul(shape.substr(comma + 1));
  return std::max<std::size_t>(columns, 1);
}

Json packed(const Json& typed) {
  const std::vector<float> values = floats_of(typed);
  const std::string shape = typed.at("shape");
  std::optional<Words> words;
  if (typed.contains("step")) words = rounded(values, typed.at("step"));
  Json json = {{"shape", shape}};
  if (words) {
    json["step"] = typed.at("step");
    json["low"] = *words->low;
  } else {
    words = bits_of(values);
  }
  std::vector<std::uint8_t> smallest = deflated(*words);
  take_differences(*words, row_of(shape, values.size()));
  std::vector<std::uint8_t> differences = deflated(*words);
  const bool is_difference = differences.size() < smallest.size();
  if (is_difference) smallest = std::move(differences);
  json["bytes"] = words->bytes;
  json["is_difference"] = is_difference;
  json["data"] = encode_base64(smallest);
  return json;
}

/// Whether it holds many numbers, or nulls, and nothing else.
bool is_long_list(const Json& json) {
  constexpr std::size_t many = 64;
  return json.is_array() && json.size() >= many &&
         std::all_of(json.begin(), json.end(),
                     [](const Json& item) { return item.is_number() || item.is_null(); });
}

Json typed_list(const Json& list) {
  std::vector<float> values;
  for (const Json& item : list)
    values.push_back(item.is_null() ? std::numeric_limits<float>::quiet_NaN() : item.get<float>());
  return typed_array(values, {values.size()});
}

}  // namespace

std::size_t PackedArrays::place_of(const Json& typed) {
  const auto [place, is_new] = places_.try_emplace(typed.dump(), arrays_.size());
  if (is_new) arrays_.push_back(packed(typed));
  return place->second;
}

void PackedArrays::take_from(Json& json) {
  if (json.is_object() && json.contains("bdata")) {
    json = Json{{"packed", place_of(json)}};
  } else if (is_long_list(json)) {
    json = Json{{"packed", place_of(typed_list(json))}};
  } else if (json.is_structured()) {
    for (auto& child : json) take_from(child);
  }
}

}  // namespace tofsmith::plotly
