// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/image.hpp"

#include <string>

#include "core/shared/pixel_runs.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

RawView view_of_frame(const RawFrames& raw, int frame) {
  require(frame >= 0 && frame < raw.frames, "frame", frame,
          "must be in [0, " + std::to_string(raw.frames) + ")");
  require(raw.height >= 0 && raw.width >= 0 && raw.measurements >= 0 &&
              raw.values.size() == static_cast<std::size_t>(raw.frames) * raw.pixels_per_frame() *
                                       static_cast<std::size_t>(raw.measurements),
          "raw values", raw.values.size(), "must be frames x height x width x measurements");
  return RawView::interleaved(raw.frame(frame), raw.height, raw.width, raw.measurements);
}

void copy_pixels(const RawView& raw, std::int64_t first, std::int64_t count, float* values) {
  for_each_run(raw, first, count, [&](const auto* pixel, std::int64_t length, std::int64_t) {
    for (std::int64_t i = 0; i < length; ++i, pixel += raw.column_stride)
      for (int k = 0; k < raw.measurements; ++k)
        *values++ = static_cast<float>(pixel[k * raw.measurement_stride]);
  });
}

}  // namespace tofsmith
