// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/decode/decoded_view.hpp"

namespace tofsmith {

/// What a decoder of several returns says about every pixel of a frame; all planes are (H, W).
struct MultipathImage {
  DepthImage direct;            ///< of the direct return
  Image<float> delay_m;         ///< of the second return behind it [m]; NaN where there is none
  Image<float> ratio;           ///< r = S2 / S1, in [0, 1]; NaN where there is none
  Image<ReturnStatus> returns;  ///< how many returns the pixel shows

  MultipathImage() = default;
  MultipathImage(int height, int width);
  int height() const { return direct.height(); }
  int width() const { return direct.width(); }
  /// Where a decoder writes all of it.
  DecodedView view();
};

}  // namespace tofsmith
