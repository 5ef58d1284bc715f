// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/depth_image.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <type_traits>

#include "decode/output/pixel_output.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

/// ": 0 ok, 1 invalid, ..."; empty for planes of numbers.
template <typename Value>
std::string codes_text(const Image<Value>& /*plane*/) {
  std::string text;
  if constexpr (std::is_enum_v<Value>)
    for (int code = 0; const std::string_view word : all_words<Value>)
      text += fmt::format("{}{} {}", text.empty() ? ": " : ", ", code++, word);
  return text;
}

}  // namespace

std::string help_of(DecodedPlane plane) {
  const PlaneDescription& described = description_of(plane);
  const DepthImage types;
  const std::string codes = with_plane(
      plane, [](const auto& values) { return codes_text(values); }, types);
  return fmt::format("{}{}{}", described.help, codes,
                     described.use == PlaneUse::of_returns ? " (two-return and tail only)" : "");
}

std::vector<DecodedPlane> usual_planes(bool multipath) {
  std::vector<DecodedPlane> planes;
  for (const PlaneDescription& described : plane_descriptions)
    if (described.use == PlaneUse::usual || (multipath && described.use == PlaneUse::of_returns))
      planes.push_back(described.plane);
  return planes;
}

bool DecodedView::wants_bins_only() const {
  int wanted = 0;
  for_each_plane([&](const auto* plane) { wanted += plane ? 1 : 0; }, *this);
  return bin && wanted == 1;
}

std::vector<DecodedPlane> DecodedView::planes() const {
  std::vector<DecodedPlane> wanted;
  for (const PlaneDescription& described : plane_descriptions)
    if (with_plane(
            described.plane, [](const auto* plane) { return plane != nullptr; }, *this))
      wanted.push_back(described.plane);
  return wanted;
}

DecodedView DecodedView::of(DepthImage& image) {
  DecodedView view;
  for_each_plane([](auto*& to, auto& from) { to = from.pixels.data(); }, view, image);
  return view;
}

DecodedView DecodedView::from(std::size_t pixel) const {
  DecodedView later;
  for_each_plane([pixel](auto*& to, auto* from) { to = from ? from + pixel : nullptr; }, later,
                 *this);
  return later;
}

DepthImage::DepthImage(const std::vector<DecodedPlane>& planes, int height, int width) {
  for (const DecodedPlane plane : planes)
    with_plane(
        plane,
        [&]<typename Value>(Image<Value>& image) {
          image = {height, width, no_value<Value>};
        },
        *this);
}

namespace {

std::string size_text(int height, int width) {
  return std::to_string(height) + " x " + std::to_string(width);
}

void validate_map(const Image<float>& map, const char* field, int height, int width,
                  bool must_be_positive) {
  if (map.empty()) return;
  require(map.height == height && map.width == width, field, size_text(map.height, map.width),
          "must have the size of the frames, " + size_text(height, width));
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const float value = map(row, column);
      if (std::isnan(value) || (std::isfinite(value) && (value > 0.0f || !must_be_positive)))
        continue;
      reject(std::string(field) + "[" + std::to_string(row) + ", " + std::to_string(column) + "]",
             detail::describe(value),
             must_be_positive ? "must be finite and > 0, or NaN for a dead pixel"
                              : "must be finite, or NaN for a dead pixel");
    }
}

void require_within(const Image<float>& map, const char* field, std::size_t first,
                    std::size_t count) {
  if (map.empty()) return;
  require(first <= map.size() && count <= map.size() - first, field,
          std::to_string(map.size()) + " pixels",
          "must cover pixels " + std::to_string(first) + " to " + std::to_string(first + count));
}

float wrapped(double depth_m, double range_m) {
  const double turn_m = depth_m - range_m * std::floor(depth_m / range_m);
  // Rounding to float can yield range_m, which equals 0.
  const auto rounded = static_cast<float>(turn_m);
  return rounded >= static_cast<float>(range_m) ? 0.0f : rounded;
}

}  // namespace

void PixelMaps::validate(int height, int width) const {
  validate_map(delay_offset_m, "delay_offset_m", height, width, false);
  validate_map(gain, "gain", height, width, true);
}

void apply(const PixelMaps& maps, double range_m, const DecodedView& decoded, std::size_t first,
           std::size_t count) {
  require(std::isfinite(range_m) && range_m > 0.0, "range_m", range_m, "must be finite and > 0");
  require_within(maps.delay_offset_m, "delay_offset_m", first, count);
  require_within(maps.gain, "gain", first, count);
  if (maps.empty()) return;
  parallel_for_blocks(static_cast<std::int64_t>(count), 16384, [&](IndexRange range) {
    for (std::int64_t i = range.begin; i < range.end; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const float offset_m =
          maps.delay_offset_m.empty() ? 0.0f : maps.delay_offset_m.pixels[first + at];
      const float gain = maps.gain.empty() ? 1.0f : maps.gain.pixels[first + at];
      if (std::isnan(offset_m) || std::isnan(gain)) {
        store_invalid(at, decoded);
        continue;
      }
      if (decoded.depth_m && offset_m != 0.0f)
        decoded.depth_m[at] = wrapped(static_cast<double>(decoded.depth_m[at]) - offset_m, range_m);
      if (decoded.signal_e_per_s) decoded.signal_e_per_s[at] /= gain;
      if (decoded.ambient_e_per_s) decoded.ambient_e_per_s[at] /= gain;
    }
  });
}

}  // namespace tofsmith
