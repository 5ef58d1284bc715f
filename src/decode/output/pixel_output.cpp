// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/output/pixel_output.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/shared/shared_progress.hpp"
#include "decode/output/shared/decoder_parts.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

void store_invalid(std::size_t at, const DecodedView& decoded) {
  for_each_plane(
      [at]<typename Value>(Value* plane) {
        if (plane) plane[at] = no_value<Value>;
      },
      decoded);
}

void require_measurements(const RawView& raw, int measurements) {
  require(raw.measurements == measurements, "raw measurements", raw.measurements,
          "must equal the code's " + std::to_string(measurements));
}

void require_frame(const RawView& raw, int measurements) {
  require_measurements(raw, measurements);
  require(raw.height >= 0 && raw.width >= 0, "raw height and width",
          std::min(raw.height, raw.width), "must be >= 0");
}

double probability_of(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

void for_each_block(const RawView& raw, int measurements, const Progress& progress,
                    const std::function<void(IndexRange pixels)>& work, std::int64_t block_pixels) {
  require_frame(raw, measurements);
  const std::int64_t count = raw.pixels();
  SharedProgress shared(progress, static_cast<double>(count), "decoding");
  parallel_for_blocks(count, block_pixels, [&](IndexRange range) {
    work(range);
    shared.add(static_cast<double>(range.end - range.begin));
  });
  report(progress, 1.0, "decoding");
}

void decode_frame(
    const RawView& raw, const DecodedView& decoded, int measurements, const Progress& progress,
    const std::function<void(const RawBlock& raw, const DecodedView& decoded)>& decode_block,
    std::int64_t block_pixels) {
  for_each_block(
      raw, measurements, progress,
      [&](IndexRange block) {
        const std::int64_t pixels = block.end - block.begin;
        std::vector<float> values(static_cast<std::size_t>(pixels * measurements));
        copy_pixels(raw, block.begin, pixels, values.data());
        decode_block({values.data(), pixels, raw.averaged ? raw.averaged + block.begin : nullptr,
                      raw.noise, block.begin},
                     decoded.from(static_cast<std::size_t>(block.begin)));
      },
      block_pixels);
}

}  // namespace tofsmith
