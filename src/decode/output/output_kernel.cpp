// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/output/output_kernel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/output/output_kernel.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h and be the first header.
#include <hwy/highway.h>

#include "decode/output/output_noise-inl.hpp"
#include "decode/output/output_position-inl.hpp"
#include "decode/output/output_residual-inl.hpp"
#include "decode/shared/marked_raw.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

/// `Rank` 0: known only at run time.
template <int Rank>
HWY_INLINE void write_chunk(const BinRecords& records, const OutputConstants& c,
                            const LobePosterior& posterior, const RecordTable& limits,
                            const OutputSteps& steps, const std::uint8_t* saturated,
                            OutputChunk& chunk, const DecodedView& planes) {
  const RecordLayout& layout = records.layout;
  const int rank = Rank > 0 ? Rank : layout.rank;
  find_rows(records.records, chunk.bin, chunk.pixels, chunk.start);
  for (int i = 0; i < chunk.pixels; i += lanes_of())
    gather(records.records.data(), chunk.start + i, 0, steps.fields, chunk.record + i);
  refine(layout, rank, chunk);
  if (planes.depth_m) write_depth(c, chunk, planes.depth_m);
  if (planes.bin) std::copy_n(chunk.bin, chunk.pixels, planes.bin);
  if (planes.signal_e_per_s) write_values(chunk, chunk.signal, planes.signal_e_per_s);
  if (steps.ambient) {
    find_chords(records.chords, chunk);
    find_ambient(c, layout, chunk);
  }
  if (planes.ambient_e_per_s) write_ambient(c, chunk, planes.ambient_e_per_s);
  if (planes.deviation_m) write_depth_noise(chunk, planes.deviation_m);
  if (steps.confidence) find_confidence(c, records, posterior, rank, chunk);
  if (planes.confidence) write_values(chunk, chunk.confidence, planes.confidence);
  if (steps.residual) find_residual<Rank>(c, records, limits, planes.residual != nullptr, chunk);
  if (planes.residual) write_values(chunk, chunk.residual, planes.residual);
  if (planes.status) {
    if (!steps.residual) std::fill_n(chunk.inconsistent, pixels_per_chunk, 0.0f);
    if (!steps.confidence) std::fill_n(chunk.confidence, pixels_per_chunk, 1.0f);
    find_signal_noise(layout, chunk);
    write_status(c, chunk, saturated, planes.status);
  }
}

/// Copies row numbers, followed by -1.
HWY_INLINE void copy_rows(const std::int32_t* numbers, int pixels, std::int32_t* to) {
  std::fill(std::copy_n(numbers, pixels, to), to + pixels_per_chunk, -1);
}

void find_shares(const MatchedTile& tile, int first, OutputChunk& chunk) {
  for (float* share : {chunk.variance_share, chunk.lobe_share, chunk.residual_share})
    std::fill_n(share, pixels_per_chunk, 1.0f);
  if (!tile.averaged) return;
  for (int i = 0; i < chunk.pixels; ++i) {
    const float averaged = tile.averaged[first + i], share = 1.0f / averaged;
    const NoiseRatios noise = tile.noise.at(averaged);
    chunk.variance_share[i] = share;
    chunk.lobe_share[i] = share * noise.of_lobes;
    chunk.residual_share[i] = share * noise.of_residual;
  }
}

template <int Rank>
HWY_INLINE void write_tile(const BinRecords& records, const OutputConstants& c,
                           const LobePosterior& posterior, const RecordTable& limits,
                           const OutputSteps& steps, const MatchedTile& tile,
                           const DecodedView& planes) {
  OutputChunk chunk;
  for (int first = 0; first < tile.pixels; first += pixels_per_chunk) {
    chunk.pixels = std::min(tile.pixels - first, pixels_per_chunk);
    copy_rows(tile.bin + first, chunk.pixels, chunk.bin);
    chunk.plane = tile.plane + first;
    chunk.electrons = tile.electrons ? tile.electrons + first : nullptr;
    find_shares(tile, first, chunk);
    write_chunk<Rank>(records, c, posterior, limits, steps,
                      tile.saturated ? tile.saturated + first : nullptr, chunk,
                      planes.from(static_cast<std::size_t>(first)));
  }
}

void write(const BinRecords& records, const OutputConstants& c, const LobePosterior& posterior,
           const RecordTable& limits, const OutputSteps& steps, const MatchedTile& tile,
           const DecodedView& planes) {
  switch (records.layout.rank) {
    case 2:
      return write_tile<2>(records, c, posterior, limits, steps, tile, planes);
    case 3:
      return write_tile<3>(records, c, posterior, limits, steps, tile, planes);
    case 4:
      return write_tile<4>(records, c, posterior, limits, steps, tile, planes);
    default:
      return write_tile<0>(records, c, posterior, limits, steps, tile, planes);
  }
}

HWY_INLINE void join(const std::int32_t* bin, const OutputChunk& chunk, double samples,
                     double* depth_bin) {
  const Doubles d;
  const hn::Rebind<std::int32_t, decltype(d)> di;
  const hn::Rebind<float, decltype(d)> df;
  const auto zero = hn::Zero(d), all_samples = hn::Set(d, samples);
  const auto none = hn::Set(d, std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < chunk.pixels; i += lanes_of(d)) {
    const auto whole = hn::PromoteTo(d, hn::LoadU(di, bin + i));
    auto at = hn::Add(whole, hn::PromoteTo(d, hn::LoadU(df, chunk.offset + i)));
    at = hn::Add(at, hn::IfThenElseZero(hn::Lt(at, zero), all_samples));
    at = hn::Sub(at, hn::IfThenElseZero(hn::Ge(at, all_samples), all_samples));
    hn::StoreU(hn::IfThenElse(hn::Lt(whole, zero), none, at), d, depth_bin + i);
  }
}

template <int Rank>
HWY_INLINE void find_tile_positions(const BinRecords& records, const OutputConstants& c,
                                    const MatchedTile& tile, double* depth_bin) {
  OutputChunk chunk;
  const RecordLayout& layout = records.layout;
  for (int first = 0; first < tile.pixels; first += pixels_per_chunk) {
    chunk.pixels = std::min(tile.pixels - first, pixels_per_chunk);
    chunk.plane = tile.plane + first;
    find_rows(records.records, tile.bin + first, chunk.pixels, chunk.start);
    for (int i = 0; i < chunk.pixels; i += lanes_of())
      gather(records.records.data(), chunk.start + i, 0, layout.end_of_depth(), chunk.record + i);
    refine(layout, Rank > 0 ? Rank : layout.rank, chunk);
    join(tile.bin + first, chunk, c.samples, depth_bin + first);
  }
}

void find_positions(const BinRecords& records, const OutputConstants& c, const MatchedTile& tile,
                    double* depth_bin) {
  switch (records.layout.rank) {
    case 2:
      return find_tile_positions<2>(records, c, tile, depth_bin);
    case 3:
      return find_tile_positions<3>(records, c, tile, depth_bin);
    case 4:
      return find_tile_positions<4>(records, c, tile, depth_bin);
    default:
      return find_tile_positions<0>(records, c, tile, depth_bin);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(write);
HWY_EXPORT(find_positions);

namespace {

float with_room_for(double value, int integers) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  const int digits = std::numeric_limits<float>::digits -
                     static_cast<int>(std::bit_width(static_cast<unsigned>(integers)));
  return static_cast<float>(
      std::ldexp(std::nearbyint(std::ldexp(mantissa, digits)), exponent - digits));
}

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

OutputKernel::OutputKernel(const DecodingTable& table, const AmbientProjection& projection,
                           const DecodeOptions& options, bool only_positions)
    : records_(table, projection, !only_positions),
      limits_(only_positions ? 0 : table.samples(), LimitLayout::stride) {
  const double bin_m = table.row_m();
  const ExpectedNoise noise(table);
  const double ambient2 = projection.ambient.squaredNorm();
  constants_.samples = table.samples();
  constants_.bin_m = static_cast<float>(bin_m);
  constants_.bin_high_m = with_room_for(bin_m, table.samples());
  constants_.bin_low_m = static_cast<float>(bin_m - constants_.bin_high_m);
  constants_.range_m = static_cast<float>(table.range_m);
  constants_.sees_ambient = ambient2 > 0.0;
  if (constants_.sees_ambient) constants_.ambient_weight = in_floats(projection.ambient / ambient2);
  constants_.shot_ambient = in_floats(noise.shot_ambient);
  constants_.floor_noise_e2 = in_floats(noise.floor_variance_e2);
  constants_.typical_ambient =
      static_cast<float>(typical_variance(projection.noise_basis, noise.shot_ambient));
  constants_.typical_floor_e2 = static_cast<float>(
      std::max(min_variance_e2, typical_variance(projection.noise_basis, noise.floor_variance_e2)));
  const auto least_of = [](double largest, double least) {
    return static_cast<float>(least_variance_share * std::max(least, largest));
  };
  constants_.least_shot = least_of(noise.shot_gated.maxCoeff(), 0.0);
  constants_.least_shot_ambient = least_of(noise.shot_ambient.maxCoeff(), 0.0);
  constants_.least_floor_e2 = least_of(noise.floor_variance_e2.maxCoeff(), min_variance_e2);
  constants_.low_signal_sigma2 = static_cast<float>(std::min<double>(
      options.low_signal_sigma * options.low_signal_sigma, std::numeric_limits<float>::max()));
  constants_.min_confidence = static_cast<float>(options.min_confidence);
  if (only_positions) return;
  posterior_.emplace(table, projection);
  for (std::int32_t n = 0; n < table.samples(); ++n) {
    float* const fields = records_.records.row(n) + records_.layout.bound();
    const LobeBound& bound = posterior_->bound(n);
    fields[0] = static_cast<float>(projection.curve.row(n).norm());
    fields[1] = static_cast<float>(bound.cosine);
    fields[2] = static_cast<float>(bound.sine);
    fields[3] = static_cast<float>(
        typical_variance(projection.noise_basis, noise.shot_gated.row(n).transpose()));
  }
  residuals_.emplace(table, projection, options);
  fill_limits(projection);
}

void OutputKernel::fill_limits(const AmbientProjection& projection) {
  const ResidualModel& residuals = *residuals_;
  const RowMajorMatrix off_plane = residuals.off_plane().transpose();
  RowMajorMatrix basis(projection.noise_basis.rows(), projection.rank() + off_plane.rows());
  basis << projection.noise_basis, residuals.off_plane_noise();
  constants_.off_plane_count = static_cast<int>(off_plane.rows());
  constants_.off_plane.assign(off_plane.data(), off_plane.data() + off_plane.size());
  constants_.residual_basis.assign(basis.data(), basis.data() + basis.size());
  constants_.ambient_direction = in_floats(residuals.ambient_direction());
  for (std::size_t n = 0; n < residuals.limits().size(); ++n) {
    const ResidualModel::Limit& limit = residuals.limits()[n];
    float* const row = limits_.row(static_cast<std::int32_t>(n));
    row[LimitLayout::variance] = static_cast<float>(limit.of_signal);
    row[LimitLayout::variance + 1] = static_cast<float>(limit.of_ambient);
    row[LimitLayout::variance + 2] = static_cast<float>(limit.of_floor);
    row[LimitLayout::error] = static_cast<float>(limit.error);
    row[LimitLayout::root] = static_cast<float>(limit.root);
    row[LimitLayout::per_freedom] = static_cast<float>(limit.per_freedom);
  }
  constants_.finds_inconsistent = residuals.half_quantile() > 0.0;
  constants_.half_quantile = static_cast<float>(residuals.half_quantile());
}

OutputSteps OutputKernel::steps_for(const DecodedView& planes) const {
  const RecordLayout& layout = records_.layout;
  OutputSteps steps;
  steps.confidence = planes.confidence || (planes.status && constants_.min_confidence > 0.0f);
  steps.residual = planes.residual || (planes.status && constants_.finds_inconsistent);
  steps.noise = steps.confidence || steps.residual || planes.deviation_m || planes.status;
  steps.ambient = steps.noise || planes.ambient_e_per_s;
  steps.electrons = (constants_.sees_ambient && steps.ambient) ||
                    (steps.residual && constants_.off_plane_count > 0);
  steps.fields = steps.confidence || steps.residual ? layout.end_of_bound()
                 : steps.noise                      ? layout.end_of_noise()
                 : steps.ambient                    ? layout.end_of_light()
                                                    : layout.end_of_depth();
  return steps;
}

void OutputKernel::write(const MatchedTile& tile, const DecodedView& planes) const {
  const OutputSteps steps = steps_for(planes);
  HWY_DYNAMIC_DISPATCH(write)(records_, constants_, *posterior_, limits_, steps, tile, planes);
}

void OutputKernel::find_positions(const MatchedTile& tile, double* depth_bin) const {
  HWY_DYNAMIC_DISPATCH(find_positions)(records_, constants_, tile, depth_bin);
}

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

}  // namespace tofsmith
#endif
