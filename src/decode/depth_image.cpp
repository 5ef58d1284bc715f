// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/depth_image.hpp"

#include <limits>

#include "core/shared/enum_words.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

constexpr EnumWords<PixelStatus, all_pixel_statuses.size()> pixel_status_words(
    "PixelStatus", "status", "ok", "invalid", "no_return", "saturated", "low_signal", "ambiguous",
    "mixed", "inconsistent");

}  // namespace

bool DecodedView::wants_bins_only() const {
  return bin && !depth_m && !signal_e_per_s && !ambient_e_per_s && !confidence &&
         !predicted_standard_deviation_m && !status && !residual && !delay_m && !ratio && !returns;
}

DecodedView DecodedView::of(DepthImage& image) {
  return {.depth_m = image.depth_m.pixels.data(),
          .signal_e_per_s = image.signal_e_per_s.pixels.data(),
          .ambient_e_per_s = image.ambient_e_per_s.pixels.data(),
          .confidence = image.confidence.pixels.data(),
          .predicted_standard_deviation_m = image.predicted_standard_deviation_m.pixels.data(),
          .status = image.status.pixels.data(),
          .residual = image.residual.pixels.data()};
}

DecodedView DecodedView::from(std::size_t pixel) const {
  const auto later = [pixel](auto* plane) { return plane ? plane + pixel : nullptr; };
  return {later(bin),
          later(depth_m),
          later(signal_e_per_s),
          later(ambient_e_per_s),
          later(confidence),
          later(predicted_standard_deviation_m),
          later(status),
          later(residual),
          later(delay_m),
          later(ratio),
          later(returns)};
}

std::string_view name_of(PixelStatus status) { return pixel_status_words.of(status); }

DepthImage::DepthImage(int height, int width)
    : depth_m(height, width, std::numeric_limits<float>::quiet_NaN()),
      signal_e_per_s(depth_m),
      ambient_e_per_s(depth_m),
      confidence(depth_m),
      predicted_standard_deviation_m(depth_m),
      status(height, width, PixelStatus::invalid) {}

}  // namespace tofsmith
