// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/depth_image.hpp"

namespace tofsmith {

bool DecodedView::wants_bins_only() const {
  return bin && !depth_m && !signal_e_per_s && !ambient_e_per_s && !confidence &&
         !predicted_standard_deviation_m && !status && !delay_m && !ratio && !returns;
}

DecodedView DecodedView::of(DepthImage& image) {
  return {.depth_m = image.depth_m.pixels.data(),
          .signal_e_per_s = image.signal_e_per_s.pixels.data(),
          .ambient_e_per_s = image.ambient_e_per_s.pixels.data(),
          .confidence = image.confidence.pixels.data(),
          .predicted_standard_deviation_m = image.predicted_standard_deviation_m.pixels.data(),
          .status = image.status.pixels.data()};
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
          later(delay_m),
          later(ratio),
          later(returns)};
}

}  // namespace tofsmith
