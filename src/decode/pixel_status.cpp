// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/depth_image.hpp"

#include "core/shared/enum_words.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {
constexpr EnumWords<PixelStatus, 6> pixel_status_words("PixelStatus", "status", "ok", "invalid",
                                                       "no_return", "saturated", "low_signal",
                                                       "ambiguous");
}  // namespace

std::string_view name_of(PixelStatus status) { return pixel_status_words.of(status); }

}  // namespace tofsmith
