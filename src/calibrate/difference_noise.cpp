// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "calibrate/photon_transfer_fit.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

namespace {

constexpr int buckets = 2;
constexpr double min_signal_sigma = 8.0;  // for reliable depth, and so reliable light
constexpr std::size_t min_group = 256, max_groups = 16;
constexpr double max_filled = 0.95;  // relative to the maximum of a converter

/// A measurement in two frames with the same light.
struct PairedNumber {
  double light_dn;  ///< of both buckets
  double change;    ///< [DN]
};

/// Scales the table so that the signal is in DN/s.
DecodingTable in_raw_numbers(DecodingTable table) {
  table.gain_e_per_raw.setOnes();
  table.constant_variance_e2.setConstant(buckets / 12.0);
  table.dark_electrons.setZero();
  table.shot_dark_electrons.setZero();
  table.correction.reset();
  return table;
}

/// Mean and difference of two frames, corrected for a common change of light.
struct FramePair {
  RawFrames mean;
  RawFrames change;
  double mean_square = 0.0;  ///< of the changes
};

FramePair pair_of(const RawFrames& raw, int first) {
  FramePair pair;
  pair.mean = {.frames = 1,
               .height = raw.height,
               .width = raw.width,
               .measurements = raw.measurements,
               .values = {}};
  pair.change = pair.mean;
  const std::size_t count = raw.pixels_per_frame() * static_cast<std::size_t>(raw.measurements);
  const float* a = raw.frame(first);
  const float* b = raw.frame(first + 1);
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    pair.mean.values.push_back(0.5f * (a[i] + b[i]));
    pair.change.values.push_back(a[i] - b[i]);
    const auto mean = static_cast<double>(pair.mean.values[i]);
    const auto change = static_cast<double>(pair.change.values[i]);
    if (!std::isfinite(mean)) continue;
    product += mean * change;
    square += mean * mean;
  }
  // A change of light scales all differences equally and is not noise.
  const double share = square > 0.0 ? product / square : 0.0;
  RunningStatistics squares;
  for (std::size_t i = 0; i < count; ++i) {
    pair.change.values[i] -= static_cast<float>(share) * pair.mean.values[i];
    const auto change = static_cast<double>(pair.change.values[i]);
    if (std::isfinite(change)) squares.add(change * change);
  }
  pair.mean_square = squares.mean();
  return pair;
}

/// Light of each measurement at a depth, per signal and second.
Eigen::VectorXd light_per_signal(const DecodingTable& table, double depth_m) {
  const double at = depth_m / table.row_m();
  const double whole = std::floor(at);
  const auto samples = static_cast<Eigen::Index>(table.samples());
  const Eigen::Index n = static_cast<Eigen::Index>(whole) % samples;
  const Eigen::RowVectorXd row = (1.0 - (at - whole)) * table.shot().row(n) +
                                 (at - whole) * table.shot().row((n + 1) % samples);
  return row.transpose().cwiseProduct(table.exposure_s);
}

/// Numbers of pixels with reliable depth whose fuller bucket is below `limit_dn`, since a
/// difference does not reveal clipping. The selection depends only on the mean of the frames, which
/// is independent of the change.
std::vector<PairedNumber> paired_numbers(const FramePair& pair, const Decoder& decoder,
                                         double limit_dn, std::size_t& too_bright) {
  const DecodingTable& table = decoder.table();
  const DepthImage decoded = decoder.decode(pair.mean);
  const auto measurements = static_cast<std::size_t>(table.measurements());
  std::vector<PairedNumber> numbers;
  for (std::size_t p = 0; p < pair.mean.pixels_per_frame(); ++p) {
    const auto signal = static_cast<double>(decoded.signal_e_per_s.pixels[p]);
    const auto depth_m = static_cast<double>(decoded.depth_m.pixels[p]);
    const float* mean = pair.mean.values.data() + p * measurements;
    const float* change = pair.change.values.data() + p * measurements;
    double square = 0.0;
    for (std::size_t k = 0; k < measurements; ++k)
      square += static_cast<double>(mean[k]) * static_cast<double>(mean[k]);
    // The mean of two frames has a quarter of the variance of their difference.
    const double needed = min_signal_sigma * min_signal_sigma * 0.25 * pair.mean_square *
                          static_cast<double>(measurements);
    if (!(signal > 0.0) || !std::isfinite(depth_m) || !(square > needed)) continue;
    const Eigen::VectorXd light_dn = signal * light_per_signal(table, depth_m);
    double fullest_dn = 0.0;
    for (std::size_t k = 0; k < measurements; ++k)
      fullest_dn = std::max(fullest_dn, 0.5 * (light_dn[static_cast<Eigen::Index>(k)] +
                                               std::abs(static_cast<double>(mean[k]))));
    if (fullest_dn > limit_dn) {
      ++too_bright;
      continue;
    }
    for (std::size_t k = 0; k < measurements; ++k)
      numbers.push_back({light_dn[static_cast<Eigen::Index>(k)], static_cast<double>(change[k])});
  }
  return numbers;
}

void add_point(const RunningStatistics& light_dn, const RunningStatistics& change, bool dark,
               double averaged, PhotonTransfer& result) {
  const double variance = 0.5 * averaged * change.variance();
  result.points.push_back(
      {.mean_dn = light_dn.mean(),
       .variance_dn2 = {variance,
                        variance * std::sqrt(2.0 / static_cast<double>(change.count() - 1))},
       .dark = dark});
}

/// Adds a point per group of similar light.
void add_groups(std::vector<PairedNumber> numbers, double averaged, PhotonTransfer& result) {
  std::ranges::sort(numbers, {}, &PairedNumber::light_dn);
  const std::size_t groups = std::min(max_groups, numbers.size() / min_group);
  for (std::size_t g = 0; g < groups; ++g) {
    RunningStatistics light_dn, change;
    for (std::size_t i = g * numbers.size() / groups; i < (g + 1) * numbers.size() / groups; ++i) {
      light_dn.add(numbers[i].light_dn);
      change.add(numbers[i].change);
    }
    add_point(light_dn, change, false, averaged, result);
  }
}

void add_dark(const RawFrames& dark, double averaged, PhotonTransfer& result) {
  for (int f = 0; f < dark.frames; f += 2) {
    RunningStatistics none, change;
    const std::size_t count = dark.pixels_per_frame() * static_cast<std::size_t>(dark.measurements);
    for (std::size_t i = 0; i < count; ++i) {
      const double d =
          static_cast<double>(dark.frame(f)[i]) - static_cast<double>(dark.frame(f + 1)[i]);
      if (!std::isfinite(d)) continue;
      none.add(0.0);
      change.add(d);
    }
    if (change.count() > 1) add_point(none, change, true, averaged, result);
  }
}

}  // namespace

PhotonTransfer photon_transfer(const std::vector<RawFrames>& levels, const RawFrames& dark,
                               const DecodingTable& table, const PhotonTransferOptions& options) {
  options.validate();
  require(!levels.empty(), "levels", 0, "must be >= 1");
  for (const RawFrames& raw : levels) check_pairs(raw, levels.front(), "level");
  if (dark.frames > 0) check_pairs(dark, levels.front(), "dark");
  require(levels.front().measurements == table.measurements(), "measurements of the frames",
          levels.front().measurements,
          fmt::format("must be {}, like the code", table.measurements()));

  PhotonTransfer result;
  result.buckets = buckets;
  const Decoder decoder(in_raw_numbers(table));
  const double limit_dn =
      options.adc_bits
          ? max_filled * (std::exp2(*options.adc_bits) - 1.0 - options.black_level_dn.value_or(0.0))
          : INFINITY;
  std::size_t too_bright = 0;
  if (dark.frames > 0) add_dark(dark, options.averaged, result);
  for (const RawFrames& raw : levels)
    for (int f = 0; f < raw.frames; f += 2) {
      const FramePair pair = pair_of(raw, f);
      add_groups(paired_numbers(pair, decoder, limit_dn, too_bright), options.averaged, result);
      for (const float value : pair.mean.values)
        if (std::isfinite(value))
          result.saturation_dn =
              std::max(result.saturation_dn, std::abs(static_cast<double>(value)));
    }
  if (too_bright > 0)
    result.notes.push_back(
        fmt::format("{} pixels were excluded, because one of their buckets comes within 5 % of the "
                    "converter's maximum, which differences do not show",
                    too_bright));
  set_adc_bits(options, result.saturation_dn, result);
  fit_photon_transfer(result);
  result.notes.emplace_back(
      "all light was assumed to be the camera's own: shot noise of other light appears as read "
      "noise if it is in all frames, and otherwise as a smaller gain");
  return result;
}

}  // namespace tofsmith
