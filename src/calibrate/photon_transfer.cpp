// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/photon_transfer.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "calibrate/photon_transfer_fit.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

constexpr double rounding_dn2 = 1.0 / 12.0;
constexpr double max_clipped = 1e-4;  // share of pixels at the limit of a valid point

struct PairStatistics {
  RunningStatistics mean, difference, raw;
  std::size_t clipped = 0, pixels = 0;
};

PairStatistics statistics_of(const RawFrames& raw, int first, int measurement, double limit) {
  PairStatistics s;
  const float* a = raw.frame(first) + measurement;
  const float* b = raw.frame(first + 1) + measurement;
  const auto stride = static_cast<std::size_t>(raw.measurements);
  for (std::size_t p = 0; p < raw.pixels_per_frame(); ++p) {
    const double x = a[p * stride], y = b[p * stride];
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    ++s.pixels;
    if (x >= limit || y >= limit) ++s.clipped;
    s.mean.add(0.5 * (x + y));
    s.difference.add(x - y);
    s.raw.add(x);
    s.raw.add(y);
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

}  // namespace

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

namespace {

void add_points(const RawFrames& raw, double limit, bool dark, double averaged,
                PhotonTransfer& result) {
  for (int f = 0; f < raw.frames; f += 2)
    for (int k = 0; k < raw.measurements; ++k) {
      const PairStatistics s = statistics_of(raw, f, k, limit);
      if (s.pixels < 16) continue;
      PhotonTransferPoint point{.mean_dn = s.mean.mean(), .dark = dark};
      // A change of light shifts the mean of the difference, not its variance.
      const double variance = 0.5 * averaged * s.difference.variance();
      point.variance_dn2 = {variance,
                            variance * std::sqrt(2.0 / static_cast<double>(s.pixels - 1))};
      point.saturated =
          static_cast<double>(s.clipped) > max_clipped * static_cast<double>(s.pixels);
      result.points.push_back(point);
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

}  // namespace

void set_adc_bits(const PhotonTransferOptions& options, double highest_dn, PhotonTransfer& result) {
  result.adc_bits = options.adc_bits.value_or(min_usual_bits(highest_dn));
  if (!options.adc_bits)
    result.notes.push_back(fmt::format(
        "adc_bits is not set in the camera; assumed {} bits, which hold the largest value {:.0f}",
        result.adc_bits, highest_dn));
}

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

}  // namespace tofsmith
