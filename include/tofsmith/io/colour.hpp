// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tofsmith {

/// Light of an sRGB value, both in [0, 1]. @see IEC 61966-2-1
double linear_from_srgb(double srgb);
/// Inverse of linear_from_srgb().
double srgb_from_linear(double linear);

/// Luminance of linear light with Rec. 709 (sRGB) primaries.
constexpr double luminance_rec709(double red, double green, double blue) {
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

}  // namespace tofsmith
