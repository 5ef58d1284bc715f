// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/pixel_status.hpp"

#include "tofsmith/core/error.hpp"

namespace tofsmith {

std::string_view name_of(PixelStatus status) {
  switch (status) {
    case PixelStatus::ok:
      return "ok";
    case PixelStatus::invalid:
      return "invalid";
    case PixelStatus::no_return:
      return "no_return";
    case PixelStatus::saturated:
      return "saturated";
    case PixelStatus::low_signal:
      return "low_signal";
    case PixelStatus::ambiguous:
      return "ambiguous";
  }
  reject("PixelStatus", std::to_string(static_cast<int>(status)), "must be in [0, 5]");
}

}  // namespace tofsmith
