// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/pixel_output.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

PixelStatus status_of(const DecodingTable& table, const DecodeOptions& options, const float* raw,
                      const PixelDecoding& pixel) {
  if (table.saturation_level)
    for (int k = 0; k < table.measurements(); ++k)
      if (raw[k] >= *table.saturation_level) return PixelStatus::saturated;
  const PixelEstimate& estimate = pixel.estimate;
  if (!(estimate.signal_e_per_s > 0.0)) return PixelStatus::no_return;
  if (estimate.signal_e_per_s <
      options.low_signal_sigma * estimate.signal_standard_deviation_e_per_s)
    return PixelStatus::low_signal;
  if (pixel.confidence < options.minimum_confidence) return PixelStatus::ambiguous;
  return PixelStatus::ok;
}

}  // namespace

void store_pixel(const DecodingTable& table, const DecodeOptions& options, const float* raw,
                 const PixelDecoding& pixel, std::size_t at, DepthImage& image) {
  image.status.pixels[at] = status_of(table, options, raw, pixel);
  if (!(pixel.estimate.signal_e_per_s > 0.0)) return;

  const double bin_m = table.bin_m();
  const auto depth_m = static_cast<float>(pixel.depth_bin * bin_m);
  // Rounding to float can land on the end of the range, which is its beginning.
  image.depth_m.pixels[at] = depth_m < static_cast<float>(table.range_m) ? depth_m : 0.0f;
  image.signal_e_per_s.pixels[at] = static_cast<float>(pixel.estimate.signal_e_per_s);
  image.ambient_e_per_s.pixels[at] = static_cast<float>(pixel.estimate.ambient_e_per_s);
  image.confidence.pixels[at] = static_cast<float>(pixel.confidence);
  image.predicted_standard_deviation_m.pixels[at] =
      static_cast<float>(pixel.estimate.depth_standard_deviation_bin * bin_m);
}

double confidence_of(double lead, double deviation) {
  if (deviation == 0.0) return 1.0;
  return 0.5 * std::erfc(-std::max(lead, 0.0) / deviation * std::numbers::sqrt2 / 2);
}

DepthImage decode_frame(const RawFrames& raw, int frame, int measurements,
                        std::int64_t block_pixels, const Progress& progress,
                        const std::function<void(const float* raw, IndexRange pixels,
                                                 DepthImage& image)>& decode_block) {
  require(raw.measurements == measurements, "raw measurements", raw.measurements,
          "must equal the code's " + std::to_string(measurements));
  require(frame >= 0 && frame < raw.frames, "frame", frame,
          "must be in [0, " + std::to_string(raw.frames) + ")");
  require(raw.height >= 0 && raw.width >= 0 &&
              raw.values.size() == static_cast<std::size_t>(raw.frames) * raw.pixels_per_frame() *
                                       static_cast<std::size_t>(raw.measurements),
          "raw values", raw.values.size(), "must be frames x height x width x measurements");

  const std::int64_t blocks_per_report = 64;
  DepthImage image(raw.height, raw.width);
  const float* pixels = raw.frame(frame);
  const auto count = static_cast<std::int64_t>(raw.pixels_per_frame());
  for (std::int64_t done = 0; done < count; done += block_pixels * blocks_per_report) {
    report(progress, static_cast<double>(done) / static_cast<double>(count), "decoding");
    const std::int64_t end = std::min(count, done + block_pixels * blocks_per_report);
    parallel_for_blocks(end - done, block_pixels, [&](IndexRange range) {
      const IndexRange block{done + range.begin, done + range.end};
      decode_block(pixels + block.begin * measurements, block, image);
    });
  }
  report(progress, 1.0, "decoding");
  return image;
}

}  // namespace tofsmith
