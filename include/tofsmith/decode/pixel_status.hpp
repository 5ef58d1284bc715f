// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace tofsmith {

/// What became of a pixel. Where several apply, the first in the order invalid, saturated,
/// no_return, low_signal, ambiguous is given.
enum class PixelStatus : std::uint8_t {
  ok = 0,
  invalid = 1,     ///< a measurement is NaN or infinite: no depth
  no_return = 2,   ///< no depth explains the pixel with positive signal: no depth
  saturated = 3,   ///< a measurement is clipped: the depth may be far off
  low_signal = 4,  ///< the signal does not stand out of its noise
  ambiguous = 5,   ///< another depth, far from this one, explains the pixel almost as well
};

inline constexpr std::array all_pixel_statuses = {PixelStatus::ok,         PixelStatus::invalid,
                                                  PixelStatus::no_return,  PixelStatus::saturated,
                                                  PixelStatus::low_signal, PixelStatus::ambiguous};

/// "ok", "invalid", "no_return", "saturated", "low_signal", "ambiguous".
std::string_view name_of(PixelStatus status);

}  // namespace tofsmith
