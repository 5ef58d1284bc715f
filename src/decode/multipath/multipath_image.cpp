// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith {

MultipathImage::MultipathImage(int height, int width)
    : direct(height, width),
      delay_m(direct.depth_m),
      ratio(direct.depth_m),
      returns(height, width, ReturnStatus::none) {}

DecodedView MultipathImage::view() {
  DecodedView view = DecodedView::of(direct);
  view.delay_m = delay_m.pixels.data();
  view.ratio = ratio.pixels.data();
  view.returns = returns.pixels.data();
  return view;
}

}  // namespace tofsmith
