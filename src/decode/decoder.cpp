// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/decoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "decode/bin_matcher.hpp"
#include "decode/pixel_model.hpp"
#include "decode/pixel_output.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Calls use(tile, first pixel) for all pixels, tile by tile.
template <typename Use>
void for_each_tile(const BinMatcher& matcher, int measurements, const float* raw,
                   std::int64_t pixels, const Use& use) {
  Tile tile;
  for (std::int64_t first = 0; first < pixels; first += pixels_per_tile) {
    const auto count = static_cast<int>(std::min<std::int64_t>(pixels - first, pixels_per_tile));
    matcher.match(raw + first * measurements, count, tile);
    use(std::as_const(tile), first);
  }
}

/// P y' of one pixel in the plane, out of a tile.
void plane_vector(const Tile& tile, int pixel, int rank, double* plane) {
  for (int j = 0; j < rank; ++j)
    plane[j] = tile.unit[j * pixels_per_tile + pixel] * tile.length[pixel];
}

}  // namespace

void DecodeOptions::validate() const {
  require(std::isfinite(low_signal_sigma) && low_signal_sigma >= 0.0,
          "DecodeOptions::low_signal_sigma", low_signal_sigma, "must be finite and >= 0");
  require(minimum_confidence >= 0.0 && minimum_confidence <= 1.0,
          "DecodeOptions::minimum_confidence", minimum_confidence, "must be in [0, 1]");
}

struct Decoder::Plan {
  Plan(DecodingTable table_, const DecodeOptions& options_, const AmbientProjection& projection)
      : table(std::move(table_)),
        options(options_),
        model(table, projection),
        matcher(table, projection) {}

  DecodingTable table;
  DecodeOptions options;
  PixelModel model;
  BinMatcher matcher;

  void decode_pixel(const float* raw, const Tile& tile, int pixel, std::size_t at,
                    const DecodedView& into) const;
  double confidence(const Tile& tile, int pixel, const double* variance_e2) const;
};

Decoder::Decoder(DecodingTable table, const DecodeOptions& options) {
  options.validate();
  table.validate();
  const AmbientProjection projection(table);
  plan_ = std::make_unique<const Plan>(std::move(table), options, projection);
}
Decoder::~Decoder() = default;
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;

const DecodingTable& Decoder::table() const { return plan_->table; }
const DecodeOptions& Decoder::options() const { return plan_->options; }
int Decoder::rank() const { return plan_->model.rank(); }

void Decoder::decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const {
  for_each_tile(plan_->matcher, this->measurements(), measurements, pixels,
                [&](const Tile& tile, std::int64_t first) {
                  std::copy_n(tile.bin, tile.pixels, bin + first);
                });
}

void Decoder::decode_depth_bins(const float* measurements, std::int64_t pixels,
                                double* depth_bin) const {
  const int rank = this->rank();
  for_each_tile(plan_->matcher, this->measurements(), measurements, pixels,
                [&](const Tile& tile, std::int64_t first) {
                  std::array<double, max_measurements> plane;
                  for (int i = 0; i < tile.pixels; ++i) {
                    double& position = depth_bin[first + i];
                    position = std::numeric_limits<double>::quiet_NaN();
                    if (tile.bin[i] < 0) continue;
                    plane_vector(tile, i, rank, plane.data());
                    position = plan_->model.refine(plane.data(), tile.bin[i]).in_bins(samples());
                  }
                });
}

void Decoder::decode(const RawView& raw, const DecodedView& decoded,
                     const Progress& progress) const {
  decode_frame(raw, decoded, measurements(), progress,
               [&](const float* values, std::int64_t pixels, const DecodedView& block) {
                 for_each_tile(plan_->matcher, measurements(), values, pixels,
                               [&](const Tile& tile, std::int64_t first) {
                                 for (int i = 0; i < tile.pixels; ++i)
                                   plan_->decode_pixel(values + (first + i) * measurements(), tile,
                                                       i, static_cast<std::size_t>(first + i),
                                                       block);
                               });
               });
}

DepthImage Decoder::decode(const RawFrames& raw, int frame, const Progress& progress) const {
  return decoded_image(raw, frame, [&](const RawView& view, const DecodedView& decoded) {
    decode(view, decoded, progress);
  });
}

void Decoder::Plan::decode_pixel(const float* raw, const Tile& tile, int pixel, std::size_t at,
                                 const DecodedView& into) const {
  if (tile.bin[pixel] < 0) return store_invalid(at, into);
  std::array<double, max_measurements> plane, electrons, variance_e2;
  plane_vector(tile, pixel, model.rank(), plane.data());
  for (int k = 0; k < model.measurements(); ++k)
    electrons[static_cast<std::size_t>(k)] = matcher.electrons(raw[k], k);

  const Position position = model.refine(plane.data(), tile.bin[pixel]);
  PixelDecoding decoding{
      position.in_bins(table.samples()),
      model.estimate(electrons.data(), plane.data(), position, variance_e2.data())};
  if (decoding.estimate.signal_e_per_s > 0.0)
    decoding.confidence = confidence(tile, pixel, variance_e2.data());
  store_pixel(table, options, raw, decoding, at, into);
}

/// Probability that the pixel's bin scores higher than the best one outside its main lobe, for
/// normal noise on the difference of the two scores.
double Decoder::Plan::confidence(const Tile& tile, int pixel, const double* variance_e2) const {
  const DirectionTable& directions = matcher.directions();
  const std::int32_t bin = tile.bin[pixel], samples = directions.samples();
  const Lobe lobe = directions.main_lobe(bin);
  if (lobe.end - lobe.begin >= samples) return 1.0;

  std::array<float, max_measurements> components;
  for (int j = 0; j < directions.rank(); ++j)
    components[static_cast<std::size_t>(j)] = tile.unit_float[j * pixels_per_tile + pixel];
  const std::int32_t rival =
      best_bin_within(directions, components.data(), lobe.end, lobe.begin + samples);
  std::array<double, max_measurements> difference;
  double lead_e = 0.0;
  for (int j = 0; j < directions.rank(); ++j) {
    const double d = directions.direction(bin, j) - directions.direction(rival, j);
    difference[static_cast<std::size_t>(j)] = d;
    lead_e += d * tile.unit[j * pixels_per_tile + pixel] * tile.length[pixel];
  }
  return confidence_of(lead_e, model.deviation_along(difference.data(), variance_e2));
}

}  // namespace tofsmith
