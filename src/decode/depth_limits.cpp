// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/depth_limits.hpp"

#include <fmt/format.h>

#include <cmath>
#include <type_traits>
#include <vector>

#include "decode/output/pixel_output.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

namespace {

/// Removes a depth outside the limits, except where a status already makes it doubtful.
void remove_if_outside(const DepthLimits& limits, double depth_m, std::size_t at,
                       const DecodedView& decoded) {
  if (limits.contains(depth_m)) return;
  for_each_plane(
      [at]<typename Value>(Value* plane) {
        if constexpr (std::is_same_v<Value, float> || std::is_same_v<Value, ReturnStatus>)
          if (plane) plane[at] = no_value<Value>;
      },
      decoded);
  PixelStatus& status = decoded.status[at];
  if (status == PixelStatus::ok || status == PixelStatus::ambiguous)
    status = limits.status_of(depth_m);
}

class BlockRestriction {
 public:
  BlockRestriction(const DepthLimits& limits, const DepthDecoder& decoder, const RawView& raw,
                   const PixelMaps& maps, int width, std::size_t first, const DecodedView& decoded)
      : limits_(limits),
        decoder_(decoder),
        raw_(raw),
        maps_(maps),
        width_(static_cast<std::size_t>(width)),
        first_(first),
        decoded_(decoded) {}

  void run(IndexRange pixels) {
    for (std::int64_t i = pixels.begin; i < pixels.end; ++i) choose(static_cast<std::size_t>(i));
    if (chosen_.empty()) return;
    const RawView view =
        marked_view(RawView::interleaved(values_.data(), 1, static_cast<int>(chosen_.size()),
                                         raw_.measurements),
                    averaged_.empty() ? nullptr : averaged_.data(), raw_.noise);
    DepthImage within(decoded_.planes(), 1, static_cast<int>(chosen_.size()));
    decoder_.decode_within(view, parts_.data(), DecodedView::of(within));
    for (std::size_t j = 0; j < chosen_.size(); ++j) merge(chosen_[j], within, j);
  }

 private:
  struct Pixel {
    std::size_t at = 0;
    double depth_m = 0.0;  ///< corrected
  };

  /// Returns the error of a decoded depth that corrections and maps will subtract; NaN for a dead
  /// pixel.
  double error_m(std::size_t pixel, double decoded_m, const float* signal_e_per_s) const {
    double sum_m = maps_.delay_offset_m.empty()
                       ? 0.0
                       : static_cast<double>(maps_.delay_offset_m.pixels[pixel]);
    const DecodingTable& table = decoder_.table();
    if (const auto& correction = table.correction)
      sum_m += correction->error_m(
          decoded_m, table.range_m, static_cast<int>(pixel / width_),
          static_cast<int>(pixel % width_),
          signal_e_per_s ? static_cast<double>(*signal_e_per_s) : correction->signal_e_per_s);
    return sum_m;
  }

  /// Removes a depth with confidence 1 that is outside the limits. Selects other pixels for
  /// decoding again.
  void choose(std::size_t at) {
    if (std::isnan(decoded_.depth_m[at])) return;
    const double range_m = decoder_.table().range_m;
    const double decoded_m = static_cast<double>(decoded_.depth_m[at]);
    const float* const signal = decoded_.signal_e_per_s ? decoded_.signal_e_per_s + at : nullptr;
    const double subtracted_m = error_m(first_ + at, decoded_m, signal);
    if (std::isnan(subtracted_m)) return;
    const double depth_m = wrap(decoded_m - subtracted_m, range_m);
    if (decoded_.confidence[at] >= 1.0f)  // no other depth is possible
      return remove_if_outside(limits_, depth_m, at, decoded_);
    chosen_.push_back({at, depth_m});
    parts_.push_back(part_of(first_ + at, signal));
    const std::size_t count = static_cast<std::size_t>(raw_.measurements);
    values_.resize(values_.size() + count);
    copy_pixels(raw_, static_cast<std::int64_t>(at), 1, values_.data() + values_.size() - count);
    if (raw_.averaged) averaged_.push_back(raw_.averaged[at]);
  }

  /// The part of the range whose corrected depths are within the limits.
  RangePart part_of(std::size_t pixel, const float* signal_e_per_s) const {
    const double range_m = decoder_.table().range_m;
    const auto decoded_m = [&](double depth_m) {
      const double once_m = depth_m + error_m(pixel, depth_m, signal_e_per_s);
      return depth_m + error_m(pixel, once_m, signal_e_per_s);
    };
    const double begin_m = decoded_m(limits_.min_m), end_m = decoded_m(limits_.max_m);
    return {wrap(begin_m, range_m) / range_m, (end_m - begin_m) / range_m};
  }

  void merge(const Pixel& pixel, const DepthImage& within, std::size_t from) {
    if (!std::isnan(within.depth_m.pixels[from])) return copy(pixel.at, within, from);
    remove_if_outside(limits_, pixel.depth_m, pixel.at, decoded_);
  }

  void copy(std::size_t at, const DepthImage& within, std::size_t from) const {
    for_each_plane(
        [&](auto* to, const auto& image) {
          if (to) to[at] = image.pixels[from];
        },
        decoded_, within);
  }

  const DepthLimits& limits_;
  const DepthDecoder& decoder_;
  const RawView& raw_;
  const PixelMaps& maps_;
  std::size_t width_;
  std::size_t first_;
  const DecodedView& decoded_;
  std::vector<Pixel> chosen_;
  std::vector<RangePart> parts_;
  std::vector<float> values_, averaged_;
};

}  // namespace

std::optional<DepthLimits> depth_limits(const DecodingTable& table,
                                        std::optional<double> min_depth_m,
                                        std::optional<double> max_depth_m) {
  constexpr double rounding = 1e-9;
  const auto& distance_m = table.working_distance_m;
  const double range_m = table.range_m;
  if (!distance_m && !min_depth_m && !max_depth_m) return std::nullopt;
  if (distance_m && !(min_depth_m && max_depth_m))
    require((*distance_m)[1] <= range_m * (1.0 + rounding), "operating.working_distance_m",
            fmt::format("[{}, {}]", (*distance_m)[0], (*distance_m)[1]),
            fmt::format("must end within the unambiguous range of the table, {:.6g} m", range_m));
  const double min_m = min_depth_m.value_or(distance_m ? (*distance_m)[0] : 0.0);
  const double max_m = max_depth_m.value_or(distance_m ? (*distance_m)[1] : range_m);
  require(min_m >= 0.0 && std::isfinite(min_m), "min_depth_m", min_m, "must be finite and >= 0");
  require(max_m > 0.0 && max_m <= range_m * (1.0 + rounding), "max_depth_m", max_m,
          fmt::format("must be > 0 and at most the unambiguous range, {:.6g} m", range_m));
  require(min_m < max_m, min_depth_m ? "min_depth_m" : "max_depth_m", min_depth_m ? min_m : max_m,
          min_depth_m ? fmt::format("must be below the largest depth, {:.6g} m", max_m)
                      : fmt::format("must be above the smallest depth, {:.6g} m", min_m));
  return DepthLimits{min_m, max_m};
}

void restrict_depths(const DepthLimits& limits, const DepthDecoder& decoder, const RawView& raw,
                     const PixelMaps& maps, int width, std::size_t first,
                     const DecodedView& decoded, const Progress& progress) {
  require(decoded.depth_m && decoded.confidence && decoded.status, "decoded", "a null plane",
          "must have depth, confidence and status");
  constexpr std::int64_t block_pixels = usual_block_pixels / 16;
  const MarkedRaw marked(raw, decoder.table().marking);
  for_each_block(
      marked.view(), decoder.table().measurements(), progress,
      [&](IndexRange pixels) {
        BlockRestriction(limits, decoder, marked.view(), maps, width, first, decoded).run(pixels);
      },
      block_pixels);
}

void remove_outside(const DepthLimits& limits, const DecodedView& decoded, std::size_t count) {
  require(decoded.depth_m && decoded.status, "decoded", "a null plane",
          "must have depth and status");
  for (std::size_t i = 0; i < count; ++i) {
    const double depth_m = static_cast<double>(decoded.depth_m[i]);
    if (!std::isnan(depth_m)) remove_if_outside(limits, depth_m, i, decoded);
  }
}

}  // namespace tofsmith
