// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/depth_image.hpp"

#include <fmt/format.h>

#include "core/shared/enum_words.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

constexpr EnumWords<PixelStatus, all_pixel_statuses.size()> pixel_status_words(
    "PixelStatus", "status", "ok", "invalid", "no_return", "saturated", "low_signal", "ambiguous",
    "mixed", "inconsistent", "too_near", "too_far");

constexpr EnumWords<DecodedPlane, plane_descriptions.size()> plane_words("DecodedPlane", "plane",
                                                                         words_of(DecodedPlane{}));

/// ": 0 ok, 1 invalid, ..."
template <typename Statuses>
std::string codes_text(const Statuses& all) {
  std::string text;
  for (const auto status : all)
    text += fmt::format("{}{} {}", text.empty() ? ": " : ", ", static_cast<int>(status),
                        name_of(status));
  return text;
}

}  // namespace

std::string_view name_of(DecodedPlane plane) { return plane_words.of(plane); }

DecodedPlane parse_decoded_plane(std::string_view name) {
  return plane_words.parse(usual_word(DecodedPlane{}, name));
}

std::string help_of(DecodedPlane plane) {
  const PlaneDescription& described = description_of(plane);
  std::string codes;
  if (plane == DecodedPlane::status) codes = codes_text(all_pixel_statuses);
  if (plane == DecodedPlane::returns) codes = codes_text(all_return_statuses);
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

std::string_view name_of(PixelStatus status) { return pixel_status_words.of(status); }

DepthImage::DepthImage(const std::vector<DecodedPlane>& planes, int height, int width) {
  for (const DecodedPlane plane : planes)
    with_plane(
        plane,
        [&]<typename Value>(Image<Value>& image) {
          image = {height, width, no_value<Value>};
        },
        *this);
}

}  // namespace tofsmith
