// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/decoded_planes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "core/shared/enum_words.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith {

namespace {

constexpr EnumWords<DepthKind, 2> kind_words("DepthKind", "kind", words_of(DepthKind{}));

}  // namespace

std::string_view help_of_outputs() {
  static const std::string text = [] {
    std::string all = "planes to write; others are not computed";
    for (const PlaneDescription& described : plane_descriptions)
      all +=
          fmt::format("{}{}{}: {}", described.plane == DecodedPlane{} ? ". " : "; ", described.word,
                      described.unit.empty() ? "" : fmt::format(" [{}]", described.unit),
                      help_of(described.plane));
    return all;
  }();
  return text;
}

std::string_view name_of(DepthKind kind) { return kind_words.of(kind); }

DepthKind parse_depth_kind(std::string_view name) { return kind_words.parse(name); }

NpyType type_of(DecodedPlane plane) {
  static const DepthImage types;
  return with_plane(
      plane,
      []<typename Value>(const Image<Value>&) {
        if constexpr (std::is_enum_v<Value>)
          return npy_type_of<std::underlying_type_t<Value>>;
        else
          return npy_type_of<Value>;
      },
      types);
}

std::size_t bytes_per_pixel(const std::vector<DecodedPlane>& planes) {
  std::size_t bytes = 0;
  for (const DecodedPlane plane : planes) bytes += item_size(type_of(plane));
  return bytes;
}

void undistort(DepthImage& image, const Undistortion& undistortion, bool as_z) {
  for_each_plane(
      [&]<typename Value>(Image<Value>& plane) {
        if (!plane.empty()) undistortion.apply(plane, no_value<Value>);
      },
      image);
  if (!as_z && !image.depth_m.empty()) undistortion.turn_radial(image.depth_m);
}

Image<float> floats_of(const DepthImage& image, DecodedPlane plane) {
  return with_plane(
      plane,
      [](const auto& values) {
        Image<float> floats(values.height, values.width);
        std::ranges::transform(values.pixels, floats.pixels.begin(),
                               [](auto value) { return static_cast<float>(value); });
        return floats;
      },
      image);
}

std::span<const std::byte> items_of(const DepthImage& image, DecodedPlane plane, int rows) {
  return with_plane(
      plane,
      [rows](const auto& values) {
        const std::size_t count =
            static_cast<std::size_t>(rows) * static_cast<std::size_t>(values.width);
        return std::as_bytes(std::span(values.pixels).first(count));
      },
      image);
}

void turn_into_z(float* depth_m, int first_row, int rows, const PixelRays& pixel_rays) {
  const int width = pixel_rays.view().width;
  parallel_for(rows, [&](std::int64_t row) {
    float* depth = depth_m + row * width;
    for (int column = 0; column < width; ++column)
      depth[column] = static_cast<float>(
          depth[column] *
          (1.0 / pixel_rays.radial_per_z(first_row + static_cast<int>(row), column)));
  });
}

}  // namespace tofsmith
