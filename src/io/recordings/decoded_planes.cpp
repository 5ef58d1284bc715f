// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/decoded_planes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "core/shared/enum_words.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr EnumWords<DecodedPlane, all_decoded_planes.size()> plane_words("DecodedPlane", "plane",
                                                                         words_of(DecodedPlane{}));
constexpr EnumWords<DepthKind, 2> kind_words("DepthKind", "kind", words_of(DepthKind{}));

/// What a plane holds where there is nothing.
float nothing_of(const Image<float>&) { return std::numeric_limits<float>::quiet_NaN(); }
std::int32_t nothing_of(const Image<std::int32_t>&) { return -1; }
PixelStatus nothing_of(const Image<PixelStatus>&) { return PixelStatus::invalid; }
ReturnStatus nothing_of(const Image<ReturnStatus>&) { return ReturnStatus::none; }

}  // namespace

std::string_view name_of(DecodedPlane plane) { return plane_words.of(plane); }

DecodedPlane parse_decoded_plane(std::string_view name) {
  std::string known;
  for (const DecodedPlane plane : all_decoded_planes) {
    if (name_of(plane) == name) return plane;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", name_of(plane));
  }
  reject("plane", name, "must be one of " + known);
}

std::string_view name_of(DepthKind kind) { return kind_words.of(kind); }

DepthKind parse_depth_kind(std::string_view name) { return kind_words.parse(name); }

bool is_multipath_plane(DecodedPlane plane) {
  return plane == DecodedPlane::delay || plane == DecodedPlane::ratio ||
         plane == DecodedPlane::returns;
}

std::vector<DecodedPlane> usual_planes(bool multipath) {
  std::vector<DecodedPlane> planes;
  for (const DecodedPlane plane : all_decoded_planes)
    if (plane != DecodedPlane::bin && plane != DecodedPlane::averaged &&
        plane != DecodedPlane::residual && (multipath || !is_multipath_plane(plane)))
      planes.push_back(plane);
  return planes;
}

NpyType type_of_plane(DecodedPlane plane) {
  if (plane == DecodedPlane::status || plane == DecodedPlane::returns) return NpyType::uint8;
  return plane == DecodedPlane::bin ? NpyType::int32 : NpyType::float32;
}

std::size_t bytes_per_pixel(const std::vector<DecodedPlane>& planes) {
  std::size_t bytes = 0;
  for (const DecodedPlane plane : planes) bytes += item_size(type_of_plane(plane));
  return bytes;
}

template <typename Planes, typename Use>
auto DecodedPlanes::with(Planes& planes, DecodedPlane plane, const Use& use) {
  switch (plane) {
    case DecodedPlane::depth:
      return use(planes.image_.depth_m);
    case DecodedPlane::signal:
      return use(planes.image_.signal_e_per_s);
    case DecodedPlane::ambient:
      return use(planes.image_.ambient_e_per_s);
    case DecodedPlane::confidence:
      return use(planes.image_.confidence);
    case DecodedPlane::deviation:
      return use(planes.image_.predicted_standard_deviation_m);
    case DecodedPlane::status:
      return use(planes.image_.status);
    case DecodedPlane::delay:
      return use(planes.delay_m_);
    case DecodedPlane::ratio:
      return use(planes.ratio_);
    case DecodedPlane::returns:
      return use(planes.returns_);
    case DecodedPlane::averaged:
      return use(planes.averaged_);
    case DecodedPlane::residual:
      return use(planes.image_.residual);
    case DecodedPlane::bin:
      break;
  }
  return use(planes.bin_);
}

DecodedPlanes::DecodedPlanes(const std::vector<DecodedPlane>& planes, int height, int width)
    : height_(height), width_(width) {
  for (const DecodedPlane plane : planes)
    with(*this, plane, [&](auto& image) { image = {height, width}; });
}

DecodedPlanes::DecodedPlanes(DepthImage image)
    : height_(image.height()), width_(image.width()), image_(std::move(image)) {}

DecodedView DecodedPlanes::view() {
  DecodedView view = DecodedView::of(image_);
  view.bin = bin_.pixels.data();
  view.delay_m = delay_m_.pixels.data();
  view.ratio = ratio_.pixels.data();
  view.returns = returns_.pixels.data();
  return view;
}

void DecodedPlanes::keep_averaged(const RawView& raw, std::size_t first) {
  if (averaged_.empty()) return;
  float* const to = averaged_.pixels.data() + first;
  if (raw.averaged)
    std::copy_n(raw.averaged, raw.pixels(), to);
  else
    std::fill_n(to, raw.pixels(), 1.0f);
}

void DecodedPlanes::undistort(const Undistortion& undistortion, bool as_z) {
  for (const DecodedPlane plane : all_decoded_planes)
    with(*this, plane, [&](auto& image) {
      if (!image.empty()) undistortion.apply(image, nothing_of(image));
    });
  if (!as_z && !image_.depth_m.empty()) undistortion.turn_radial(image_.depth_m);
}

bool DecodedPlanes::has(DecodedPlane plane) const {
  return with(*this, plane, [](const auto& image) { return !image.empty(); });
}

Image<float> DecodedPlanes::floats(DecodedPlane plane) const {
  return with(*this, plane, [](const auto& image) {
    Image<float> floats(image.height, image.width);
    std::ranges::transform(image.pixels, floats.pixels.begin(),
                           [](auto value) { return static_cast<float>(value); });
    return floats;
  });
}

std::span<const std::byte> DecodedPlanes::items(DecodedPlane plane, int rows) const {
  return with(*this, plane, [&](const auto& image) {
    const std::size_t count =
        static_cast<std::size_t>(rows) * static_cast<std::size_t>(image.width);
    return std::as_bytes(std::span(image.pixels).first(count));
  });
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
