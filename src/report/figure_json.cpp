// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/figure_json.hpp"
#include "core/shared/text_numbers.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith::figure_json {
namespace {

/// low > high if no value is finite.
ValueRange finite_range(std::span<const float> values) {
  ValueRange range{infinity, -infinity};
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, static_cast<double>(value));
    range.high = std::max(range.high, static_cast<double>(value));
  }
  return range;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t b = 0; b < count; ++b)
      word |= static_cast<std::uint32_t>(bytes[i + b]) << (16 - 8 * b);
    for (std::size_t d = 0; d < 4; ++d)
      text += d <= count ? digits[word >> (18 - 6 * d) & 63] : '=';
  }
  return text;
}

/// Stores low bytes before high bytes, which improves the compression.
std::vector<std::uint8_t> deflated(std::span<const std::uint16_t> words) {
  std::vector<std::uint8_t> planes;
  planes.reserve(2 * words.size());
  for (const int shift : {0, 8})
    for (const std::uint16_t word : words)
      planes.push_back(static_cast<std::uint8_t>(word >> shift & 255));
  uLongf size = compressBound(planes.size());
  std::vector<std::uint8_t> packed(size);
  const int done =
      compress2(packed.data(), &size, planes.data(), planes.size(), Z_DEFAULT_COMPRESSION);
  require(done == Z_OK, "zlib", done, "must be 0: out of memory");
  packed.resize(size);
  return packed;
}

Json range_json(const std::optional<ValueRange>& range) {
  return range ? Json{number(range->low), number(range->high)} : Json();
}

/// @param field  "Axis::range.low"; @param what  "axis" or "scale"
void check_range(const std::optional<ValueRange>& range, bool is_logarithmic,
                 const std::string& field, const std::string& what) {
  if (!range) return;
  require(range->low < range->high, field, range->low, "must be below range.high");
  require(!is_logarithmic || range->low > 0, field, range->low,
          "must be > 0 on a logarithmic " + what);
}

}  // namespace

Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return number_in(fmt::format("{:.6g}", value)).value();
}

Json numbers(std::span<const double> values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

Json packed(std::span<const float> values, std::size_t row, double resolution) {
  constexpr double most = 65000.0;
  const ValueRange range = finite_range(values);
  const double extent = std::max(0.0, range.high - range.low);
  double step = std::max(resolution, extent / most);
  if (step <= 0.0) step = std::max(1e-6, 1e-4 * std::abs(range.low));
  const double low = range.low <= range.high ? std::floor(range.low / step) : 0.0;
  std::vector<std::uint16_t> words;
  std::uint16_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double multiple = static_cast<double>(values[i]) / step - low;
    const auto word =
        static_cast<std::uint16_t>(std::isfinite(values[i]) ? std::lround(multiple) + 1 : 0);
    if (i % row == 0) before = 0;
    words.push_back(static_cast<std::uint16_t>(word - before));
    before = word;
  }
  return {{"count", values.size()},
          {"row", row},
          {"low", low},
          {"step", step},
          {"words", base64(deflated(words))}};
}

Json axis(const Axis& axis) {
  check_range(axis.range, axis.logarithmic, "Axis::range.low", "axis");
  return {{"label", axis.label},
          {"unit", axis.unit},
          {"log", axis.logarithmic},
          {"from_zero", axis.from_zero},
          {"range", range_json(axis.range)}};
}

Json colours(const ColourScale& scale) {
  static constexpr std::array names = {"viridis", "cividis", "diverging"};
  require(!(scale.logarithmic && scale.map == ColourMap::diverging), "ColourScale::logarithmic",
          true, "must be false for a diverging map");
  require(scale.clip_fraction >= 0 && scale.clip_fraction < 0.5, "ColourScale::clip_fraction",
          scale.clip_fraction, "must be in [0, 0.5)");
  check_range(scale.range, scale.logarithmic, "ColourScale::range.low", "scale");
  return {{"label", scale.label},
          {"unit", scale.unit},
          {"map", names[static_cast<std::size_t>(scale.map)]},
          {"log", scale.logarithmic},
          {"range", range_json(scale.range)},
          {"clip", scale.clip_fraction}};
}

double resolution_of(const ColourScale& scale, std::span<const float> values) {
  if (scale.logarithmic) return 0.0;
  const ValueRange range = scale.range.value_or(finite_range(values));
  return std::max(0.0, range.high - range.low) / 512.0;
}

}  // namespace tofsmith::figure_json
