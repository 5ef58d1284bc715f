// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/decoder.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "decode/output/output_kernel.hpp"
#include "decode/output/pixel_model.hpp"
#include "decode/output/shared/decoder_parts.hpp"
#include "decode/search/chord_matcher.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

template <typename Use>
void for_each_tile(const ChordMatcher& matcher, const RawView& raw, IndexRange pixels,
                   bool for_outputs, const Use& use) {
  PixelTile tile;
  for (std::int64_t first = pixels.begin; first < pixels.end; first += pixels_per_tile) {
    const auto count =
        static_cast<int>(std::min<std::int64_t>(pixels.end - first, pixels_per_tile));
    if (for_outputs)
      matcher.match(raw, first, count, for_outputs, tile);
    else
      matcher.match_bins(raw, first, count, tile);
    use(tile, first);
  }
}

/// Returns a view of consecutive pixels, one pixel per row.
RawView column_of(const float* measurements, std::int64_t pixels, int count) {
  constexpr std::int64_t longest = std::numeric_limits<int>::max();
  require(pixels >= 0 && pixels <= longest, "pixels", pixels, "must be in [0, 2^31)");
  return RawView::interleaved(measurements, 1, static_cast<int>(pixels), count);
}

}  // namespace

void DecodeOptions::validate() const { check_fields(*this, "DecodeOptions::"); }

struct Decoder::Plan {
  Plan(DecodingTable table_, const DecodeOptions& options_, const AmbientProjection& projection)
      : table(std::move(table_)),
        options(options_),
        model(table, projection),
        matcher(table, projection),
        outputs(table, projection, options) {
    if (table.samples() == table.bin_count()) return;
    for (std::int32_t row = 0; row < table.samples(); ++row)
      bin_of_row.push_back(table.nearest_bin(row));
  }

  DecodingTable table;
  DecodeOptions options;
  PixelModel model;
  ChordMatcher matcher;
  OutputKernel outputs;
  std::vector<std::int32_t> bin_of_row;  // empty: bins are rows

  void write(PixelTile& tile, const float* averaged, const NoiseRatios& noise,
             const DecodedView& planes) const;
  void decode_within(const PixelToDecode& pixel, const DecodedView& planes) const;
  void write_bins(const PixelTile& tile, std::int32_t* bin) const {
    if (bin_of_row.empty()) {
      std::copy_n(tile.bin, tile.pixels, bin);
      return;
    }
    for (int i = 0; i < tile.pixels; ++i) {
      const std::int32_t row = tile.bin[i];
      bin[i] = row < 0 ? row : bin_of_row[static_cast<std::size_t>(row)];
    }
  }
};

Decoder::Decoder(DecodingTable table, const DecodeOptions& options) {
  options.validate();
  table.validate();
  const AmbientProjection projection(table);
  plan_ = make_hidden<const Plan>(std::move(table), options, projection);
}

const DecodingTable& Decoder::table() const { return plan_->table; }
int Decoder::rank() const { return plan_->model.rank(); }

DecoderParts parts_of(const Decoder& decoder) {
  return {decoder.plan_->matcher, decoder.plan_->outputs};
}

void Decoder::decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const {
  for_each_tile(
      plan_->matcher, column_of(measurements, pixels, this->measurements()), {0, pixels}, false,
      [&](const PixelTile& tile, std::int64_t first) { plan_->write_bins(tile, bin + first); });
}

void Decoder::decode_depth_bins(const float* measurements, std::int64_t pixels,
                                double* depth_bin) const {
  const int rank = this->rank(), count = this->measurements();
  for_each_tile(
      plan_->matcher, column_of(measurements, pixels, count), {0, pixels}, true,
      [&](const PixelTile& tile, std::int64_t first) {
        std::array<double, max_measurements> raw;
        PlaneVector plane;
        for (int i = 0; i < tile.pixels; ++i) {
          double& position = depth_bin[first + i];
          position = std::numeric_limits<double>::quiet_NaN();
          if (tile.bin[i] < 0) continue;
          for (int k = 0; k < count; ++k)
            raw[static_cast<std::size_t>(k)] = tile.raw[k * pixels_per_tile + i];
          plan_->matcher.bins().exact().project(raw.data(), plane);
          for (int j = 0; j < rank; ++j) plane.unit[static_cast<std::size_t>(j)] *= plane.length;
          position = table().in_bins(
              plan_->model.refine(plane.unit.data(), tile.bin[i]).in_rows(table().samples()));
        }
      });
}

void Decoder::decode_pixels(const RawView& stored, const RangePart* parts,
                            const DecodedView& decoded, const Progress& progress) const {
  const MarkedRaw marked(stored, plan_->table.marking);
  const RawView& raw = marked.view();
  const int count = measurements();
  if (parts)
    return decode_frame(raw, decoded, count, progress,
                        [&](const RawBlock& block, const DecodedView& planes) {
                          for (std::int64_t i = 0; i < block.pixels; ++i)
                            plan_->decode_within(block.pixel(i, count, parts), planes);
                        });
  const bool is_bin_enough = decoded.wants_bins_only();
  for_each_block(raw, count, progress, [&](IndexRange block) {
    const auto write_bins = [&](const PixelTile& tile, std::int64_t first) {
      plan_->write_bins(tile, decoded.bin + first);
    };
    if (!is_bin_enough)
      for_each_tile(plan_->matcher, raw, block, true, [&](PixelTile& tile, std::int64_t first) {
        plan_->write(tile, raw.averaged ? raw.averaged + first : nullptr, raw.noise,
                     decoded.from(static_cast<std::size_t>(first)));
      });
    // The best chords determine the planes; their rows may differ from the best bins.
    if (is_bin_enough || (decoded.bin && plan_->matcher.is_coarse()))
      for_each_tile(plan_->matcher, raw, block, false, write_bins);
  });
}

void Decoder::Plan::write(PixelTile& tile, const float* averaged, const NoiseRatios& noise,
                          const DecodedView& planes) const {
  std::array<std::uint8_t, pixels_per_tile> saturated{};
  if (const SaturationLevels levels(table); levels.has_any() && planes.status)
    for (int k = 0; k < model.measurements(); ++k)
      for (int i = 0; i < tile.pixels; ++i)
        if (levels.clip(tile.raw[k * pixels_per_tile + i]))
          saturated[static_cast<std::size_t>(i)] = 1;
  if (outputs.steps_for(planes).electrons)
    for (int k = 0; k < model.measurements(); ++k)
      for (int i = 0; i < tile.pixels; ++i) {
        float& value = tile.raw[k * pixels_per_tile + i];
        value = static_cast<float>(matcher.bins().exact().electrons(value, k));
      }
  outputs.write({.pixels = tile.pixels,
                 .plane = tile.plane,
                 .electrons = tile.raw,
                 .bin = tile.bin,
                 .saturated = saturated.data(),
                 .averaged = averaged,
                 .noise = noise},
                planes);
  if (planes.bin && !bin_of_row.empty()) write_bins(tile, planes.bin);
}

void Decoder::Plan::decode_within(const PixelToDecode& pixel, const DecodedView& planes) const {
  std::array<double, max_measurements> electrons, plane, variance_e2;
  if (!matcher.bins().exact().scale().read(pixel.raw, electrons.data()))
    return store_invalid(pixel.at, planes);
  model.project(electrons.data(), plane.data());
  PixelDecoding decoding;
  if (const std::optional<Position> best = model.best_within(plane.data(), *pixel.part)) {
    decoding.depth_row = best->in_rows(table.samples());
    decoding.estimate = model.estimate(electrons.data(), plane.data(), *best, variance_e2.data(),
                                       pixel.variance_share);
  }
  if (decoding.estimate.signal_e_per_s > 0.0) {
    for (int k = 0; k < model.measurements(); ++k)
      variance_e2[static_cast<std::size_t>(k)] *= pixel.noise.of_lobes;
    decoding.set_confidence(outputs.posterior().confidence(
        plane.data(), variance_e2.data(), nearest_bin(decoding.depth_row, table.samples()),
        pixel.part));
  }
  store_pixel(table, options, outputs.residuals(), electrons.data(), decoding, pixel, planes);
}

}  // namespace tofsmith
