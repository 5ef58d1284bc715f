// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/recording_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace tofsmith {

namespace {

std::string_view likely_cause(PixelStatus status) {
  switch (status) {
    case PixelStatus::invalid:
      return "the raw numbers are NaN or infinite, or the maps mark every pixel as dead; check the "
             "files and --raw-format";
    case PixelStatus::saturated:
      return "every pixel has a raw number at the saturation level; reduce the exposure, or "
             "correct sensor.full_well_e, sensor.adc_bits and sensor.gain_e_per_dn";
    case PixelStatus::too_near:
    case PixelStatus::too_far:
      return "every depth is outside the limits; check --min-depth and --max-depth, or "
             "operating.working_distance_m of the camera";
    default:
      return "the raw numbers contain no signal; check the light source, --code, --layout and "
             "sensor.black_level_dn";
  }
}

}  // namespace

std::optional<std::string> electrons_note(const RawFramesReader& reader,
                                          const DecodingTable& table) {
  if (!reader.holds_integers() || table.saturation_level ||
      (table.gain_e_per_raw.array() != 1.0).any() || (table.black_level.array() != 0.0).any())
    return std::nullopt;
  return "no gain, black level or saturation level is set, so raw numbers are interpreted as "
         "electrons (--set sensor.adc_bits=... --set sensor.gain_e_per_dn=... --set "
         "sensor.black_level_dn=...)";
}

std::optional<std::string> repeated_offset_note(const DecodingTable& table,
                                                const Image<float>& offset_m) {
  if (table.playback_offset_m == 0.0) return std::nullopt;
  double count = 0.0, sum = 0.0, squares = 0.0;
  for (const float offset : offset_m.pixels) {
    if (!std::isfinite(offset)) continue;
    const auto value = static_cast<double>(offset);
    ++count;
    sum += value;
    squares += value * value;
  }
  const double mean_m = count > 0.0 ? sum / count : 0.0;
  const double spread_m =
      std::sqrt(std::max(squares / std::max(count, 1.0) - mean_m * mean_m, 0.0));
  if (!(std::abs(mean_m) > spread_m)) return std::nullopt;
  return fmt::format(
      "both the camera's [playback] and the offsets of the pixels contain a constant, {:.4g} m and "
      "{:.4g} m on average; their sum of {:.4g} m is subtracted from depth. If it is one constant, "
      "remove it from one of them: --set playback.offset_m=0, or an offset map with mean 0",
      table.playback_offset_m, mean_m, table.playback_offset_m + mean_m);
}

std::optional<std::string> large_offset_note(const DecodingTable& table,
                                             const Image<float>& offset_m) {
  double largest_m = 0.0;
  for (const float offset : offset_m.pixels)
    if (std::isfinite(offset)) largest_m = std::max(largest_m, std::abs(double{offset}));
  if (largest_m <= table.range_m) return std::nullopt;
  return fmt::format(
      "offsets of pixels reach {:.4g} m, more than the unambiguous range of {:.4g} m; check that "
      "they are in metres",
      largest_m, table.range_m);
}

std::optional<std::string> no_depth_note(const StatusCounts& statuses) {
  constexpr std::array without_depth = {PixelStatus::invalid, PixelStatus::no_return,
                                        PixelStatus::saturated, PixelStatus::too_near,
                                        PixelStatus::too_far};
  std::int64_t without = 0;
  std::string counts;
  for (const PixelStatus status : without_depth) {
    without += statuses.of(status);
    if (statuses.of(status) > 0)
      counts +=
          fmt::format("{}{} {}", counts.empty() ? "" : ", ", statuses.of(status), name_of(status));
  }
  if (without == 0 || without < statuses.pixels()) return std::nullopt;
  const auto by_count = [&](PixelStatus status) { return statuses.of(status); };
  return fmt::format("no pixel has a depth ({}); {}", counts,
                     likely_cause(std::ranges::max(without_depth, {}, by_count)));
}

std::optional<std::string> inconsistent_note(const StatusCounts& statuses) {
  constexpr double many = 0.1;
  const auto count = static_cast<double>(statuses.of(PixelStatus::inconsistent));
  const auto pixels = static_cast<double>(statuses.pixels());
  if (!(count > many * pixels)) return std::nullopt;
  return fmt::format(
      "{:.1f} % of the pixels are inconsistent: no depth explains their measurements within the "
      "camera's noise. Check --code, --camera and the order and type of the raw numbers. If they "
      "are right, the camera differs from its description: calibrate it, set "
      "sensor.modulation_contrast, or tolerate the difference with --model-error-percent",
      100.0 * count / pixels);
}

std::optional<std::string> noise_note(double ratio, int frame, double averaged) {
  constexpr double usual = 1.5;
  if (ratio <= usual && ratio >= 1.0 / usual) return std::nullopt;
  return fmt::format(
      "frame {} has {:.2g} times the noise that the camera predicts (estimated from differences of "
      "neighbouring pixels), so the filter {}. Measure the noise with `tofsmith calibrate noise`, "
      "or assume the noise of this frame with --averaged {:.3g}",
      frame, ratio,
      ratio < 1.0 ? "averages pixels of different depths" : "averages fewer pixels than it could",
      std::min(averaged / (ratio * ratio), 1e9));
}

}  // namespace tofsmith
