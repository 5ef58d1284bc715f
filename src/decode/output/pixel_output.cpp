// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/output/pixel_output.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/shared/shared_progress.hpp"
#include "decode/output/shared/decoder_parts.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

PixelStatus status_of(const DecodingTable& table, const DecodeOptions& options, const float* raw,
                      const PixelDecoding& pixel) {
  const SaturationLevels levels(table);
  for (int k = 0; k < table.measurements(); ++k)
    if (levels.clip(raw[k])) return PixelStatus::saturated;
  const PixelEstimate& estimate = pixel.estimate;
  if (!(estimate.signal_e_per_s > 0.0)) return PixelStatus::no_return;
  if (estimate.signal_e_per_s <
      options.low_signal_sigma * estimate.signal_standard_deviation_e_per_s)
    return PixelStatus::low_signal;
  if (pixel.residual.is_inconsistent) return PixelStatus::inconsistent;
  if (pixel.confidence < options.min_confidence) return PixelStatus::ambiguous;
  return PixelStatus::ok;
}

void store_value(float* plane, std::size_t at, bool has_depth, double value) {
  if (plane) plane[at] = has_depth ? static_cast<float>(value) : no_value<float>;
}

}  // namespace

void store_light(const PixelDecoding& pixel, bool has_depth, std::size_t at,
                 const DecodedView& decoded) {
  store_value(decoded.signal_e_per_s, at, has_depth, pixel.estimate.signal_e_per_s);
  store_value(decoded.ambient_e_per_s, at, has_depth, pixel.estimate.ambient_e_per_s);
  store_value(decoded.confidence, at, has_depth, pixel.confidence);
  store_value(decoded.residual, at, has_depth, pixel.residual.per_freedom);
}

void store_pixel(const DecodingTable& table, const DecodeOptions& options, const float* raw,
                 const PixelDecoding& pixel, std::size_t at, const DecodedView& decoded) {
  const PixelEstimate& estimate = pixel.estimate;
  const bool has_depth = estimate.signal_e_per_s > 0.0;
  // Rounding to float may yield the end of the range, which equals 0.
  const bool at_end =
      static_cast<float>(pixel.depth_row * table.row_m()) >= static_cast<float>(table.range_m);
  if (decoded.bin) decoded.bin[at] = nearest_bin(table.in_bins(pixel.depth_row), table.bin_count());
  store_value(decoded.depth_m, at, has_depth, at_end ? 0.0 : pixel.depth_row * table.row_m());
  store_value(decoded.deviation_m, at, has_depth,
              estimate.depth_standard_deviation_row * table.row_m());
  store_light(pixel, has_depth, at, decoded);
  if (decoded.status) decoded.status[at] = status_of(table, options, raw, pixel);
}

void store_pixel(const DecodingTable& table, const DecodeOptions& options,
                 const ResidualModel& residuals, const double* electrons, PixelDecoding decoding,
                 const PixelToDecode& pixel, const DecodedView& decoded) {
  if (decoding.estimate.signal_e_per_s > 0.0 && (decoded.residual || decoded.status))
    decoding.residual =
        residuals.residual(electrons, decoding.estimate, Position::at(decoding.depth_row),
                           pixel.variance_share * pixel.noise.of_residual);
  store_pixel(table, options, pixel.raw, decoding, pixel.at, decoded);
}

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
