// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/correlation_calibration.hpp"

#include <fmt/format.h>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "calibrate/harmonic_fit.hpp"
#include "calibrate/sweep_pixels.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {
namespace {

/// Sensor::tap_mismatch m of each exposure with two taps, whose changes with delay have the ratio
/// -(1 - m / 2) / (1 + m / 2).
std::vector<Estimate> tap_imbalance(const Eigen::MatrixXd& table, const Eigen::MatrixXd& error,
                                    std::vector<std::string>& notes) {
  std::vector<Estimate> mismatch;
  for (Eigen::Index i = 0; i + 1 < table.cols(); i += 2) {
    const Eigen::VectorXd a = table.col(i).array() - table.col(i).mean();
    const Eigen::VectorXd b = table.col(i + 1).array() - table.col(i + 1).mean();
    // The noise of `a` adds to its expected square.
    const double size2 = std::max(1e-300, a.squaredNorm() - error.col(i).squaredNorm());
    const double ratio = -a.dot(b) / size2;
    const double variance =
        error.col(i + 1).cwiseAbs2().mean() + ratio * ratio * error.col(i).cwiseAbs2().mean();
    const double ratio_error = std::sqrt(variance / size2);
    mismatch.push_back(
        {2 * (1 - ratio) / (1 + ratio), 4 / ((1 + ratio) * (1 + ratio)) * ratio_error});
    const auto exposure = static_cast<int>(i / 2) + 1;
    const Estimate& m = mismatch.back();
    if (std::abs(m.value) > 3 * m.standard_error && std::abs(m.value) > 1e-3)
      notes.push_back(fmt::format(
          "taps of exposure {}: the first is {:+.3g} ± {:.1g} % more sensitive than the second",
          exposure, 100 * m.value, 100 * m.standard_error));
    const double left = std::sqrt((b + ratio * a).squaredNorm() / size2);
    if (left > 0.02)
      notes.push_back(fmt::format(
          "taps of exposure {} are not complementary: {:.2g} % of their change does not cancel",
          exposure, 100 * left));
  }
  return mismatch;
}

constexpr int max_harmonics = 64;

struct Workbench {
  const RawFrames& raw;
  DelayGroups groups;
  std::vector<std::size_t> live;
  Eigen::MatrixXd mean;
  SweepDrift drift;
  HarmonicBasis basis;

  /// Corrected for the drift of light and level.
  Eigen::MatrixXd corrected(std::size_t pixel) const {
    Eigen::MatrixXd values = pixel_values(raw, pixel);
    if (drift.significant) values -= swing(values) / swing(mean) * drift.correction;
    return values;
  }
};

std::vector<double> places_of_frames(const DelayGroups& groups) {
  std::vector<double> places;
  for (const int g : groups.group_of_frame)
    places.push_back(groups.place[static_cast<std::size_t>(g)]);
  return places;
}

Workbench workbench_of(const DelaySweep& sweep, std::vector<std::size_t> live) {
  DelayGroups groups = delay_groups(sweep.delay_periods);
  Eigen::MatrixXd mean = mean_curve(sweep.frames, live);
  SweepDrift drift = sweep_drift(mean, groups, mean_curve_variance(sweep.frames, groups, live));
  int harmonics = std::min((groups.count() - 1) / 2, max_harmonics);
  if (!groups.equal_steps) harmonics = std::max(1, harmonics * 3 / 4);  // bridge gaps
  HarmonicBasis basis(places_of_frames(groups), harmonics);
  return {sweep.frames,    std::move(groups), std::move(live),
          std::move(mean), std::move(drift),  std::move(basis)};
}

std::vector<Eigen::MatrixXcf> pixel_harmonics(const Workbench& bench) {
  std::vector<Eigen::MatrixXcf> harmonics;
  harmonics.reserve(bench.live.size());
  for (const std::size_t p : bench.live)
    harmonics.push_back(bench.basis.coefficients(bench.corrected(p)).cast<std::complex<float>>());
  return harmonics;
}

bool drop_low_pixels(std::vector<std::size_t>& live, const PixelAlignment& alignment,
                     DeadPixels& dead) {
  const double usual = median_of(alignment.gain);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < live.size(); ++i)
    if (alignment.gain[i] >= 0.1 * usual) kept.push_back(live[i]);
  dead.low += static_cast<int>(live.size() - kept.size());
  const bool dropped = kept.size() < live.size();
  live = std::move(kept);
  return dropped;
}

Eigen::MatrixXd table_of(const Workbench& bench, const PixelAlignment& alignment) {
  const int rows = bench.groups.count();
  if (!bench.groups.from_zero) return curve_of(alignment.common, rows);
  // If rows are measured positions, components beyond the harmonics (corners, the highest harmonic
  // of an even N) are taken from the means.
  const Eigen::MatrixXd mean = bench.mean - bench.drift.correction;
  const Eigen::MatrixXcd unaligned = bench.basis.coefficients(mean);
  return group_means(mean, bench.groups) + curve_of(alignment.common - unaligned, rows);
}

/// Variance of a raw number at each position (G, K).
Eigen::MatrixXd noise_variance(const Workbench& bench, const PixelAlignment& alignment,
                               CalibratedCorrelation& result) {
  const int groups = bench.groups.count(), frames = bench.raw.frames;
  const Eigen::Index columns = bench.raw.measurements;
  if (bench.live.size() >= enough_pixels) {
    result.noise_source = "pixels";
    constexpr std::size_t max_pixels = 4096;
    const std::size_t stride = (bench.live.size() + max_pixels - 1) / max_pixels;
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(frames, columns);
    double used = 0.0;
    for (std::size_t i = 0; i < bench.live.size(); i += stride) {
      const Eigen::MatrixXd model = bench.basis.values(
          alignment.gain[i] * advanced(alignment.common, alignment.delay_periods[i]));
      Eigen::MatrixXd rest = bench.corrected(bench.live[i]) - model;
      rest.rowwise() -= rest.colwise().mean().eval();
      sum += rest.cwiseAbs2();
      ++used;
    }
    const double values = static_cast<double>(frames) * static_cast<double>(columns);
    // Fitted parameters: levels, gain and delay of each pixel, and the common curve.
    const double freedom = (values - static_cast<double>(columns) - 2.0) / values *
                           (1.0 - 1.0 / static_cast<double>(bench.live.size()));
    return group_means(sum, bench.groups) / (used * freedom);
  }
  const Eigen::MatrixXd mean = bench.mean - bench.drift.correction;
  const double pixels = static_cast<double>(bench.live.size());
  constexpr int min_freedom = 4;
  if (frames - groups >= min_freedom) {
    result.noise_source = "repeats";
    return Eigen::MatrixXd::Constant(
        groups, columns,
        pixels * within_groups(mean, bench.groups).squaredNorm() /
            (static_cast<double>(frames - groups) * static_cast<double>(columns)));
  }
  // The upper half of the harmonics contains only noise for band-limited cameras.
  result.noise_source = "high harmonics";
  const Eigen::MatrixXcd c = bench.basis.coefficients(mean);
  const Eigen::Index upper = std::max<Eigen::Index>(1, (c.rows() - 1) / 2);
  const double power = c.bottomRows(upper).squaredNorm() /
                       (static_cast<double>(upper) * static_cast<double>(columns));
  return Eigen::MatrixXd::Constant(groups, columns, pixels * power * frames);
}

void set_errors(const Workbench& bench, const PixelAlignment& alignment,
                CalibratedCorrelation& result, double range_m) {
  const Eigen::MatrixXd variance = noise_variance(bench, alignment, result);
  result.noise_rms = std::sqrt(variance.mean());
  double weight = 0.0;
  for (const double gain : alignment.gain) weight += gain * gain;
  result.standard_error = variance / weight;
  Eigen::VectorXd time = Eigen::VectorXd::Zero(bench.groups.count());
  for (int f = 0; f < bench.raw.frames; ++f)
    time[bench.groups.group_of_frame[static_cast<std::size_t>(f)]] +=
        sweep_time(f, bench.raw.frames);
  Eigen::MatrixXd signal = result.table.correlation;
  signal.rowwise() -= signal.colwise().mean().eval();
  for (int g = 0; g < bench.groups.count(); ++g) {
    const double repeats = bench.groups.repeats[static_cast<std::size_t>(g)];
    result.standard_error.row(g) /= repeats;
    if (!bench.drift.significant) continue;
    const double t = time[g] / repeats;  // for the error of the drift correction
    result.standard_error.row(g).array() +=
        (t * bench.drift.light.standard_error * signal.row(g).array()).square() +
        std::pow(t * bench.drift.level.standard_error, 2);
  }
  result.standard_error = result.standard_error.cwiseSqrt();

  // Fisher information of delay and gain.
  const Eigen::MatrixXcd& c = alignment.common;
  double slope2 = 0.0, size2 = 0.0;
  for (Eigen::Index n = 1; n < c.rows(); ++n) {
    const double power = 2 * c.row(n).squaredNorm();
    slope2 += power * std::pow(2 * std::numbers::pi * static_cast<double>(n), 2);
    size2 += power;
  }
  const double frames = bench.raw.frames;
  result.delay_error_m = range_m * result.noise_rms / std::sqrt(frames * slope2);
  result.gain_error = result.noise_rms / std::sqrt(frames * size2);
}

void set_maps(const Workbench& bench, const PixelAlignment& alignment,
              const CorrelationCalibrationOptions& options, CalibratedCorrelation& result) {
  const RawFrames& raw = bench.raw;
  if (raw.pixels_per_frame() == 1) return;
  result.maps.delay_offset_m = Image<float>(raw.height, raw.width, NAN);
  result.maps.gain = Image<float>(raw.height, raw.width, NAN);
  double geometry_m = 0.0;  // mean, as the table belongs to the mean pixel
  if (!options.geometry_m.empty())
    for (const std::size_t p : bench.live)
      geometry_m += options.geometry_m.pixels[p] / static_cast<double>(bench.live.size());
  for (std::size_t i = 0; i < bench.live.size(); ++i) {
    const std::size_t p = bench.live[i];
    double offset_m = alignment.delay_periods[i] * options.range_m;
    if (!options.geometry_m.empty())
      offset_m -= static_cast<double>(options.geometry_m.pixels[p]) - geometry_m;
    result.maps.delay_offset_m.pixels[p] = static_cast<float>(offset_m);
    result.maps.gain.pixels[p] = static_cast<float>(alignment.gain[i]);
  }
}

void set_scale(const Workbench& bench, const CorrelationCalibrationOptions& options,
               CalibratedCorrelation& result) {
  const int columns = bench.raw.measurements;
  Eigen::VectorXd black = Eigen::VectorXd::Constant(columns, options.black_level);
  if (options.dark.frames > 0) {
    black.setZero();
    for (const std::size_t p : bench.live)
      black += pixel_values(options.dark, p).colwise().mean().transpose();
    black /= static_cast<double>(bench.live.size());
  }
  MeasuredTable& table = result.table;
  table.correlation.rowwise() -= black.transpose();
  table.black_level = black;
  if (options.dark.frames > 0 && !options.differences)
    table.ambient_gain = ambient_gain_of(table.correlation, MeasuredAmbient::mean);
  if (options.exposure_s.size() > 0) {
    const Eigen::VectorXd share = options.exposure_s / options.exposure_s.mean();
    table.correlation = (table.correlation * share.cwiseInverse().asDiagonal()).eval();
    result.standard_error = (result.standard_error * share.cwiseInverse().asDiagonal()).eval();
    table.exposure_s = options.exposure_s;
    if (table.ambient_gain.size() > 0) table.ambient_gain = table.ambient_gain.cwiseQuotient(share);
  }
}

/// Twice the standard errors of the table, in percent of the signal's part of the measurements
/// (root mean squares).
double model_error_percent(const CalibratedCorrelation& found) {
  const MeasuredTable& table = found.table;
  const Eigen::Index columns = table.correlation.cols();
  const Eigen::VectorXd exposure_s =
      table.exposure_s.size() > 0 ? table.exposure_s : Eigen::VectorXd::Ones(columns);
  Eigen::VectorXd ambient = ambient_gain_of(
      table.correlation, table.differences ? MeasuredAmbient::none : MeasuredAmbient::equal);
  if (table.ambient_gain.size() > 0) ambient = table.ambient_gain;
  ambient = ambient.cwiseProduct(exposure_s).eval();
  if (!ambient.isZero(0.0)) ambient.normalize();
  Eigen::MatrixXd signal = table.correlation * exposure_s.asDiagonal();
  signal -= (signal * ambient).eval() * ambient.transpose();
  const double error = (found.standard_error * exposure_s.asDiagonal()).norm();
  return std::min(100.0, 200.0 * error / std::max(signal.norm(), 1e-300));
}

void add_notes(const Workbench& bench, const CorrelationCalibrationOptions& options,
               CalibratedCorrelation& result) {
  auto& notes = result.notes;
  if (bench.groups.has_repeats())
    notes.push_back(
        fmt::format("{} of {} frames repeat a delay (modulo the period) and were averaged",
                    bench.raw.frames - bench.groups.count(), bench.raw.frames));
  if (!bench.groups.from_zero)
    notes.push_back(
        fmt::format("the delays are not equal steps of a period from 0; the table of {} rows is a "
                    "Fourier series of {} harmonics fitted to them",
                    bench.groups.count(), bench.basis.harmonics()));
  if (!result.drift_known)
    notes.emplace_back(
        "drift of light and level is unknown; to determine it, measure the first delay again at "
        "the end");
  else if (result.drift_corrected)
    notes.push_back(
        fmt::format("over the sweep the light changed by {:+.3g} ± {:.1g} % and the level by "
                    "{:+.3g} ± {:.1g} raw numbers; both were corrected as linear drifts",
                    100 * result.light_drift.value, 100 * result.light_drift.standard_error,
                    result.level_drift.value, result.level_drift.standard_error));
  if (result.dead.total() > 0)
    notes.push_back(fmt::format(
        "{} dead pixels (NaN in both maps): {} not a number, {} constant, {} saturated, {} low",
        result.dead.total(), result.dead.not_a_number, result.dead.constant, result.dead.saturated,
        result.dead.low));
  if (options.dark.frames == 0)
    notes.emplace_back(
        "no frames with the light off: the black level is the camera's, and ambient light is "
        "assumed equal for all measurements");
  if (result.noise_source == "high harmonics")
    notes.emplace_back(
        "errors were estimated from the upper half of the harmonics, assumed to be noise; repeat "
        "delays or provide frames for better estimates");
  if (bench.live.size() > 1 && options.geometry_m.empty())
    notes.emplace_back(
        "the offset map includes the depth variation of the target; --target-distance-m removes "
        "that of a flat target, with the camera's [lens]");
}

}  // namespace

void CorrelationCalibrationOptions::validate(const DelaySweep& sweep) const {
  const RawFrames& frames = sweep.frames;
  require(taps >= 1, "taps", taps, "must be >= 1");
  require(differences || frames.measurements % taps == 0, "measurements", frames.measurements,
          fmt::format("must be a multiple of the camera's {} taps", taps));
  require(std::isfinite(range_m) && range_m > 0.0, "range_m", range_m, "must be finite and > 0");
  require(exposure_s.size() == 0 ||
              (exposure_s.size() == frames.measurements && exposure_s.minCoeff() > 0.0),
          "exposure_s", exposure_s.size(),
          fmt::format("must be {} exposure times > 0", frames.measurements));
  require(dark.frames == 0 || (dark.height == frames.height && dark.width == frames.width &&
                               dark.measurements == frames.measurements),
          "dark frames", fmt::format("({}, {}, {})", dark.height, dark.width, dark.measurements),
          fmt::format("must be ({}, {}, {}), the shape of the sweep's frames", frames.height,
                      frames.width, frames.measurements));
  require(geometry_m.empty() ||
              (geometry_m.height == frames.height && geometry_m.width == frames.width),
          "geometry", fmt::format("{} x {}", geometry_m.height, geometry_m.width),
          fmt::format("must be {} x {}", frames.height, frames.width));
}

CalibratedCorrelation calibrate_correlation(const DelaySweep& sweep,
                                            const CorrelationCalibrationOptions& options,
                                            const Progress& progress) {
  sweep.validate();
  options.validate(sweep);
  CalibratedCorrelation result;
  result.notes = sweep.notes;

  // Align with the mean; repeat without pixels of low response.
  std::vector<std::size_t> live = live_pixels(sweep, options, result.dead);
  PixelAlignment alignment = align_pixels(pixel_harmonics(workbench_of(sweep, live)), progress);
  if (drop_low_pixels(live, alignment, result.dead))
    alignment = align_pixels(pixel_harmonics(workbench_of(sweep, live)), progress);
  const Workbench bench = workbench_of(sweep, live);
  result.drift_known = bench.drift.known;
  result.drift_corrected = bench.drift.significant;
  result.light_drift = bench.drift.light;
  result.level_drift = bench.drift.level;

  result.table.taps = options.differences ? 1 : options.taps;
  result.table.differences = options.differences;
  result.table.correlation = table_of(bench, alignment);
  set_errors(bench, alignment, result, options.range_m);
  set_maps(bench, alignment, options, result);
  set_scale(bench, options, result);
  result.table.model_error_percent = model_error_percent(result);
  if (options.taps == 2 && !options.differences)
    result.tap_mismatch =
        tap_imbalance(result.table.correlation, result.standard_error, result.notes);
  add_notes(bench, options, result);
  return result;
}

}  // namespace tofsmith
