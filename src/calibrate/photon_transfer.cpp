// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/photon_transfer.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

namespace {

constexpr double rounding_dn2 = 1.0 / 12.0;
constexpr double max_clipped = 1e-4;  // share of pixels at the limit of a valid point

struct PairStatistics {
  RunningStatistics mean, difference;
  std::size_t clipped = 0;
};

PairStatistics statistics_of(const RawFrames& raw, int first, int measurement, double limit) {
  PairStatistics s;
  const float* a = raw.frame(first) + measurement;
  const float* b = raw.frame(first + 1) + measurement;
  const auto stride = static_cast<std::size_t>(raw.measurements);
  for (std::size_t p = 0; p < raw.pixels_per_frame(); ++p) {
    const double x = a[p * stride], y = b[p * stride];
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    if (x >= limit || y >= limit) ++s.clipped;
    s.mean.add(0.5 * (x + y));
    s.difference.add(x - y);
  }
  return s;
}

/// Number at which pixels accumulate, or the highest.
double limit_of(const std::vector<RawFrames>& levels, bool& piled_up) {
  double highest = -INFINITY;
  for (const RawFrames& raw : levels)
    for (const float value : raw.values)
      if (std::isfinite(value)) highest = std::max(highest, static_cast<double>(value));
  std::size_t at_top = 0, near_top = 0;
  for (const RawFrames& raw : levels)
    for (const float value : raw.values) {
      if (static_cast<double>(value) >= highest - 0.5)
        ++at_top;
      else if (static_cast<double>(value) >= highest - 8.5)
        ++near_top;
    }
  // Tails decrease, whereas clipping accumulates pixels at the top.
  piled_up = at_top >= 32 && at_top > near_top;
  return highest;
}

/// @throws std::invalid_argument unless the frames are pairs of the size of `first` with enough
///         pixels
void check_pairs(const RawFrames& raw, const RawFrames& first, const char* name) {
  require(raw.frames >= 2 && raw.frames % 2 == 0, fmt::format("{} frames", name), raw.frames,
          "must be pairs of equal light: an even number, at least 2");
  require(raw.height == first.height && raw.width == first.width &&
              raw.measurements == first.measurements,
          fmt::format("{} size", name),
          fmt::format("({}, {}, {})", raw.height, raw.width, raw.measurements),
          fmt::format("must be ({}, {}, {}), like the first", first.height, first.width,
                      first.measurements));
  require(raw.pixels_per_frame() >= 16, fmt::format("{} pixels", name), raw.pixels_per_frame(),
          "must be >= 16");
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

void add_points(const RawFrames& raw, double limit, bool dark, double averaged,
                PhotonTransfer& result) {
  for (int f = 0; f < raw.frames; f += 2)
    for (int k = 0; k < raw.measurements; ++k) {
      const PairStatistics s = statistics_of(raw, f, k, limit);
      if (s.mean.count() < 16) continue;
      // A change of light shifts the mean of the difference, not its variance.
      add_point(s.mean, s.difference, dark, averaged, result);
      result.points.back().saturated =
          static_cast<double>(s.clipped) > max_clipped * static_cast<double>(s.mean.count());
    }
}

/// variance - rounding = a + b (mean - black), with iterated weights.
struct FittedLine {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double reduced_chi2 = 0.0;
};

FittedLine fit_line(const PhotonTransfer& result) {
  const double rounding = result.buckets * rounding_dn2;
  FittedLine line;
  for (int round = 0; round < 4; ++round) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    double chi2 = 0.0;
    int count = 0;
    for (const PhotonTransferPoint& p : result.points) {
      if (p.saturated) continue;
      const Eigen::Vector2d row(1.0, p.mean_dn - result.black_level_dn.value);
      const double relative =
          p.variance_dn2.standard_error / std::max(1e-300, p.variance_dn2.value);
      const double expected =
          round == 0 ? p.variance_dn2.value
                     : std::max(1e-3 * p.variance_dn2.value, row.dot(line.value) + rounding);
      const double error = std::max(1e-12, expected * relative);
      const double residual = p.variance_dn2.value - rounding - row.dot(line.value);
      normal += row * row.transpose() / (error * error);
      right += row * (p.variance_dn2.value - rounding) / (error * error);
      chi2 += std::pow(residual / error, 2);
      ++count;
    }
    line.covariance = normal.inverse();
    line.value = line.covariance * right;
    line.reduced_chi2 = chi2 / std::max(1, count - 2);
  }
  return line;
}

void set_black_level(const RawFrames& dark, const PhotonTransferOptions& options,
                     PhotonTransfer& result) {
  if (options.black_level_dn) {
    result.black_level_dn = {*options.black_level_dn, 0.0};
    return;
  }
  require(dark.frames > 0, "dark frames", 0,
          "must be > 0, or the black level must be given, because the line of variance over mean "
          "does not determine it");
  RunningStatistics mean;
  for (const float value : dark.values)
    if (std::isfinite(value)) mean.add(static_cast<double>(value));
  result.black_level_dn = mean.estimate();
}

int min_usual_bits(double highest_dn) {
  for (const int bits : {8, 10, 12, 14, 16})
    if (highest_dn <= std::exp2(bits) - 1) return bits;
  return 24;
}

void set_full_well(bool piled_up, PhotonTransfer& result) {
  const double last_dn = std::exp2(result.adc_bits) - 1.0;
  if (!piled_up) {
    result.notes.emplace_back(
        "no frame is saturated, so the full well is unknown; add brighter frames");
    return;
  }
  if (result.saturation_dn >= last_dn - 0.5) {
    result.notes.push_back(
        fmt::format("frames saturate at the converter's maximum {:.0f}, so the full well is "
                    "larger: at least {:.4g} e",
                    last_dn, (last_dn - result.black_level_dn.value) * result.gain_e_per_dn.value));
    return;
  }
  const double span_dn = result.saturation_dn - result.black_level_dn.value;
  // The limit is known to within rounding.
  const double error_dn = std::hypot(std::sqrt(rounding_dn2), result.black_level_dn.standard_error);
  result.full_well_e = Estimate{span_dn * result.gain_e_per_dn.value,
                                std::hypot(span_dn * result.gain_e_per_dn.standard_error,
                                           error_dn * result.gain_e_per_dn.value)};
}

void set_gain_and_read_noise(const FittedLine& line, PhotonTransfer& result) {
  // A number contains the read noise of all buckets.
  const double a = line.value[0] / result.buckets, b = line.value[1];
  require(b > 0.0 && b > 3 * std::sqrt(line.covariance(1, 1)), "rise of variance with the mean", b,
          "must be > 0 by 3 standard errors: the light levels must differ");
  // Points may scatter more than their pixel numbers predict.
  const Eigen::DiagonalMatrix<double, 2> of_one(1.0 / result.buckets, 1.0);
  const Eigen::Matrix2d covariance =
      of_one * line.covariance * of_one * std::max(1.0, line.reduced_chi2);
  const double gain = 1.0 / b;
  result.gain_e_per_dn = {gain, std::sqrt(covariance(1, 1)) / (b * b)};
  const double black_error_dn2 = b * result.black_level_dn.standard_error;  // affects a
  if (a <= 0.0) {
    result.read_noise_e = {0.0, gain * std::sqrt(std::sqrt(covariance(0, 0)))};
    result.notes.emplace_back("the read noise is too small to be separated from rounding");
    return;
  }
  const double root = std::sqrt(a);
  const Eigen::Vector2d slope(gain / (2 * root), -root / (b * b));
  result.read_noise_e = {gain * root, std::sqrt(slope.dot(covariance * slope) +
                                                std::pow(slope[0] * black_error_dn2, 2))};
}

/// Sets the given bits, or the smallest usual number for `highest_dn`, with a note.
void set_adc_bits(const PhotonTransferOptions& options, double highest_dn, PhotonTransfer& result) {
  result.adc_bits = options.adc_bits.value_or(min_usual_bits(highest_dn));
  if (!options.adc_bits)
    result.notes.push_back(fmt::format(
        "adc_bits is not set in the camera; assumed {} bits, which hold the largest value {:.0f}",
        result.adc_bits, highest_dn));
}

/// Fits gain and read noise to the points of `result`, whose black level and buckets are set.
/// @throws std::invalid_argument for too few points, or if their variance does not increase
void fit_photon_transfer(PhotonTransfer& result) {
  const auto fitted =
      std::ranges::count_if(result.points, [](const auto& p) { return !p.saturated; });
  require(fitted >= 3, "pairs below saturation", fitted, "must be >= 3, including dark pairs");
  const FittedLine line = fit_line(result);
  result.reduced_chi2 = line.reduced_chi2;
  set_gain_and_read_noise(line, result);
  if (result.reduced_chi2 > 3)
    result.notes.push_back(fmt::format(
        "the points scatter {:.2g} times as much as their errors; check for flickering light, a "
        "nonlinear response, or raw numbers that are not from {}",
        std::sqrt(result.reduced_chi2), result.buckets > 1 ? "this code" : "single taps"));
}

}  // namespace

PhotonTransfer photon_transfer(const std::vector<RawFrames>& levels, const RawFrames& dark,
                               const PhotonTransferOptions& options) {
  options.validate();
  require(!levels.empty(), "levels", 0, "must be >= 1");
  for (const RawFrames& raw : levels) check_pairs(raw, levels.front(), "level");
  if (dark.frames > 0) check_pairs(dark, levels.front(), "dark");

  PhotonTransfer result;
  set_black_level(dark, options, result);
  bool piled_up = false;
  result.saturation_dn = limit_of(levels, piled_up);
  set_adc_bits(options, result.saturation_dn, result);
  const double limit = piled_up ? result.saturation_dn - 0.5 : INFINITY;
  if (dark.frames > 0) add_points(dark, limit, true, options.averaged, result);
  for (const RawFrames& raw : levels) add_points(raw, limit, false, options.averaged, result);
  fit_photon_transfer(result);
  set_full_well(piled_up, result);
  return result;
}

Camera with_noise(Camera camera, const PhotonTransfer& found) {
  camera.sensor.gain_e_per_dn = found.gain_e_per_dn.value;
  camera.sensor.read_noise_e = found.read_noise_e.value;
  // The black level cancels in differences.
  if (camera.sensor.readout != Readout::difference)
    camera.sensor.black_level_dn = std::max(0.0, found.black_level_dn.value);
  camera.sensor.adc_bits = found.adc_bits;
  if (found.full_well_e) camera.sensor.full_well_e = found.full_well_e->value;
  camera.validate();
  return camera;
}

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
  pair.mean = {
      .frames = 1, .height = raw.height, .width = raw.width, .measurements = raw.measurements};
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
