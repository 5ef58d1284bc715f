// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/image_limits.hpp"

#include <fmt/format.h>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

void check_image_size(std::string_view file, std::uint64_t height, std::uint64_t width) {
  const bool sides_fit =
      height >= 1 && width >= 1 && height <= max_image_side && width <= max_image_side;
  if (sides_fit && height * width <= max_image_pixels) return;
  throw IoError(file, fmt::format("found an image of {} x {} pixels (height x width); expected "
                                  "sides of 1 to {} and at most {} pixels",
                                  height, width, max_image_side, max_image_pixels));
}

}  // namespace tofsmith
