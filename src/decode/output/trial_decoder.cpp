// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/output/shared/trial_decoder.hpp"

#include <limits>

namespace tofsmith {

namespace {

PlaneMap plane_map_of(const DecodingTable& table, const AmbientProjection& projection) {
  const RawScale scale(table);
  Eigen::VectorXd at_zero(table.measurements()), gain(table.measurements());
  for (int k = 0; k < table.measurements(); ++k) {
    at_zero[k] = scale.electrons(0.0, k);
    gain[k] = scale.electrons(1.0, k) - at_zero[k];
  }
  return {projection.basis.transpose() * gain.asDiagonal(), projection.basis.transpose() * at_zero};
}

/// Number of trials above which a table of cells saves time (measured).
std::int64_t trials_worth_cells(int rank, int samples) {
  return std::int64_t{rank <= 3 ? 1000 : 4000} * samples;
}

}  // namespace

TrialDecoder::Zncc::Zncc(const DecodingTable& table, const AmbientProjection& projection,
                         std::int64_t trials)
    : plane_map(plane_map_of(table, projection)),
      matcher(table, projection, trials < trials_worth_cells(projection.rank(), table.samples())),
      outputs(table, projection, {}, /*only_positions=*/true),
      rows(table.samples()),
      bins(table.bin_count()) {}

TrialDecoder::TrialDecoder(DecodeMethod method, DecodingTable table, UnwrapWeights unwrap_weights,
                           std::int64_t trials)
    : measurements_(table.measurements()),
      samples_(table.bin_count()),
      bins_per_row_(static_cast<double>(table.bin_count()) / table.samples()) {
  if (method != DecodeMethod::zncc) {
    other_ = make_decoder(method, std::move(table), {}, unwrap_weights);
    return;
  }
  table.validate();
  zncc_ = std::make_unique<const Zncc>(table, AmbientProjection(table), trials);
}

void TrialDecoder::decode_plane(bool sub_bin, PixelTile& tile, double* depth_bin) const {
  if (sub_bin)
    zncc_->matcher.match_plane(tile);
  else
    zncc_->matcher.match_plane_bins(tile);
  positions_of(sub_bin, tile, depth_bin);
}

void TrialDecoder::decode_raw(const float* raw, bool sub_bin, PixelTile& tile,
                              double* depth_bin) const {
  const int count = tile.pixels;
  const RawView view = RawView::planar(raw, 1, pixels_per_tile, measurements_);
  if (zncc_) {
    if (sub_bin)
      zncc_->matcher.match(view, 0, count, false, tile);
    else
      zncc_->matcher.match_bins(view, 0, count, tile);
    return positions_of(sub_bin, tile, depth_bin);
  }
  // Other methods require interleaved measurements.
  copy_pixels(view, 0, count, tile.raw);
  if (sub_bin) return other_->decode_depth_bins(tile.raw, count, depth_bin);
  other_->decode_bins(tile.raw, count, tile.bin);
  std::copy_n(tile.bin, count, depth_bin);
}

void TrialDecoder::positions_of(bool sub_bin, const PixelTile& tile, double* depth_bin) const {
  if (sub_bin) {
    zncc_->outputs.find_positions({.pixels = tile.pixels, .plane = tile.plane, .bin = tile.bin},
                                  depth_bin);
    for (int i = 0; i < tile.pixels; ++i) depth_bin[i] *= bins_per_row_;
    return;
  }
  for (int i = 0; i < tile.pixels; ++i)
    depth_bin[i] = tile.bin[i] < 0 ? std::numeric_limits<double>::quiet_NaN()
                                   : nearest_bin_of_row(tile.bin[i], zncc_->rows, zncc_->bins);
}

}  // namespace tofsmith
