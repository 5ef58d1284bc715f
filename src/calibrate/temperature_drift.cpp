// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "calibrate/harmonic_fit.hpp"
#include "calibrate/reference_samples.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

namespace {

constexpr int min_frames = 5;
constexpr double narrow_c = 2.0;
constexpr double significant = 4.0;  // standard errors
/// Condition number of collinear regressors (Belsley, Kuh and Welsch 1980).
constexpr double collinear = 30.0;

void validate(const std::vector<double>& temperature_c, const std::string& field, int frames) {
  require(temperature_c.size() == static_cast<std::size_t>(frames), field, temperature_c.size(),
          fmt::format("must be one for each of the {} frames", frames));
  for (const double t : temperature_c) require(std::isfinite(t), field, t, "each must be finite");
  const auto [least, most] = std::ranges::minmax_element(temperature_c);
  require(*most > *least, field, *least, "must not all be the same");
}

void validate(const RawFrames& frames, const FrameTemperatures& temperatures) {
  const bool has_sensor = !temperatures.of_sensor_c.empty();
  validate(temperatures.of_camera_c, "temperatures", frames.frames);
  if (has_sensor) validate(temperatures.of_sensor_c, "sensor_temperatures", frames.frames);
  require(frames.frames >= min_frames + has_sensor, "frames", frames.frames,
          fmt::format("must be at least {}", min_frames + has_sensor));
}

/// 97.5 % point of Student's t to third order (Abramowitz and Stegun 26.7.5); 1 % low at 3 degrees
/// of freedom.
double t_factor(int freedom) {
  const double z = 1.959964, n = freedom, z2 = z * z;
  return z + z * (z2 + 1.0) / (4.0 * n) + z * ((5.0 * z2 + 16.0) * z2 + 3.0) / (96.0 * n * n) +
         z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / (384.0 * n * n * n);
}

struct Weighted {
  double value, weight;
};

double weighted_median(std::vector<Weighted> items) {
  std::ranges::sort(items, {}, &Weighted::value);
  double all = 0.0;
  for (const Weighted& item : items) all += item.weight;
  double sum = 0.0;
  for (const Weighted& item : items) {
    sum += item.weight;
    if (sum >= 0.5 * all) return item.value;
  }
  return items.back().value;
}

struct LinearFit {
  std::vector<Estimate> coefficients;
  double rms = 0.0;
};

/// y = sum of coefficient * column; all 0 if the columns are dependent.
LinearFit fit(const std::vector<Eigen::VectorXd>& columns, const std::vector<double>& y) {
  const auto count = static_cast<Eigen::Index>(y.size()),
             unknowns = static_cast<Eigen::Index>(columns.size());
  LinearFit result{.coefficients = std::vector<Estimate>(columns.size())};
  Eigen::MatrixXd terms(count, unknowns);
  for (Eigen::Index c = 0; c < unknowns; ++c) terms.col(c) = columns[static_cast<std::size_t>(c)];
  const Eigen::Map<const Eigen::VectorXd> of(y.data(), count);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(terms);
  if (qr.rank() < unknowns) return result;
  const Eigen::VectorXd coefficient = qr.solve(of);
  const double variance =
      (of - terms * coefficient).squaredNorm() / static_cast<double>(count - unknowns);
  const Eigen::MatrixXd covariance = (terms.transpose() * terms).inverse() * variance;
  for (Eigen::Index c = 0; c < unknowns; ++c)
    result.coefficients[static_cast<std::size_t>(c)] = {coefficient[c],
                                                        std::sqrt(covariance(c, c))};
  result.rms = std::sqrt(variance);
  return result;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Eigen::VectorXd from_mean(const std::vector<double>& values, double mean) {
  const Eigen::Map<const Eigen::VectorXd> all(values.data(),
                                              static_cast<Eigen::Index>(values.size()));
  return all.array() - mean;
}

/// Condition number of two centred columns scaled to equal norms; infinite if they are
/// proportional.
double condition_number(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const double correlation = std::abs(a.dot(b)) / (a.norm() * b.norm());
  return std::sqrt((1.0 + correlation) / std::max(1.0 - correlation, 0.0));
}

/// Sign of the temperature's change; 0 for changes of at most 1 % of the span.
Eigen::VectorXd directions(const std::vector<double>& temperature_c) {
  constexpr double still = 0.01;
  const auto [least, most] = std::ranges::minmax_element(temperature_c);
  const std::size_t count = temperature_c.size();
  Eigen::VectorXd signs(static_cast<Eigen::Index>(count));
  for (std::size_t f = 0; f < count; ++f) {
    const double change_c =
        temperature_c[std::min(f + 1, count - 1)] - temperature_c[f > 0 ? f - 1 : 0];
    const bool is_still = std::abs(change_c) <= still * (*most - *least);
    signs[static_cast<Eigen::Index>(f)] = is_still ? 0.0 : std::copysign(1.0, change_c);
  }
  return signs;
}

/// Offset at rising minus offset at falling temperatures; none unless at least three frames have
/// each.
std::optional<Estimate> hysteresis_of(std::vector<Eigen::VectorXd> columns,
                                      const TemperatureDrift& drift) {
  constexpr Eigen::Index min_branch = 3;
  const Eigen::VectorXd direction = directions(drift.temperature_c);
  if ((direction.array() > 0.0).count() < min_branch ||
      (direction.array() < 0.0).count() < min_branch)
    return std::nullopt;
  columns.push_back(direction);
  const Estimate half = fit(columns, drift.offset_m).coefficients.back();
  if (half.standard_error == 0.0) return std::nullopt;
  return Estimate{2.0 * half.value, 2.0 * half.standard_error};
}

void compare_frames(const std::vector<DepthImage>& images, double range_m,
                    TemperatureDrift& result) {
  const std::size_t count = images.size();
  std::vector<std::vector<Weighted>> offsets(count), signals(count);
  for (std::size_t i = 0; i < images.front().depth_m.size(); ++i) {
    std::complex<double> direction = 0.0;
    double mean_log = 0.0, variance = 0.0;
    bool counts = true;
    for (const DepthImage& image : images) {
      const auto signal = static_cast<double>(image.signal_e_per_s.pixels[i]);
      counts = counts && image.status.pixels[i] == PixelStatus::ok && signal > 0.0;
      if (!counts) break;
      const auto deviation_m = static_cast<double>(image.deviation_m.pixels[i]);
      direction += std::polar(1.0, turn * static_cast<double>(image.depth_m.pixels[i]) / range_m);
      mean_log += std::log(signal) / static_cast<double>(count);
      variance += deviation_m * deviation_m;
    }
    if (!counts || !(variance > 0.0)) continue;
    ++result.pixels;
    const double mean_m = std::arg(direction) / turn * range_m;
    for (std::size_t f = 0; f < count; ++f) {
      const auto depth_m = static_cast<double>(images[f].depth_m.pixels[i]);
      const auto signal = static_cast<double>(images[f].signal_e_per_s.pixels[i]);
      offsets[f].push_back({wrapped_difference_m(depth_m - mean_m, range_m), 1.0 / variance});
      signals[f].push_back({std::log(signal) - mean_log, 1.0 / variance});
    }
  }
  require(result.pixels > 0, "pixels", result.pixels,
          "must be >= 1: pixels with status ok in every frame");
  for (std::size_t f = 0; f < count; ++f) {
    result.offset_m.push_back(weighted_median(std::move(offsets[f])));
    result.log_signal.push_back(weighted_median(std::move(signals[f])));
  }
}

/// Fits lines, then hysteresis and a second-order term in addition.
void fit_lines(const FrameTemperatures& temperatures, TemperatureDrift& result) {
  const std::vector<double>& camera_c = temperatures.of_camera_c;
  const std::vector<double>& sensor_c = temperatures.of_sensor_c;
  result.temperature_c = camera_c;
  result.mean_c = mean_of(camera_c);
  const Eigen::VectorXd warmer = from_mean(camera_c, result.mean_c);
  std::vector<Eigen::VectorXd> columns = {Eigen::VectorXd::Ones(warmer.size()), warmer};
  if (!sensor_c.empty()) {
    SensorDrift sensor{.mean_c = mean_of(sensor_c), .temperature_c = sensor_c};
    const Eigen::VectorXd warmer_sensor = from_mean(sensor_c, sensor.mean_c);
    const double condition = condition_number(warmer, warmer_sensor);
    if (condition > collinear) {
      result.notes.push_back(fmt::format(
          "the temperatures of light source and sensor change together (condition number {:.3g}, "
          "above {:.0f}): their drifts cannot be separated, and only the light source's is fitted. "
          "Record frames in which one temperature changes without the other",
          condition, collinear));
    } else {
      columns.push_back(warmer_sensor);
      result.sensor = std::move(sensor);
    }
  }
  const LinearFit offset = fit(columns, result.offset_m), signal = fit(columns, result.log_signal);
  result.offset_m_per_c = offset.coefficients[1];
  result.signal_per_c = signal.coefficients[1];
  result.offset_rms_m = offset.rms;
  result.signal_rms = signal.rms;
  if (result.sensor) {
    result.sensor->offset_m_per_c = offset.coefficients[2];
    result.sensor->signal_per_c = signal.coefficients[2];
  }
  result.interval_factor = t_factor(static_cast<int>(camera_c.size() - columns.size()));
  result.hysteresis_m = hysteresis_of(columns, result);
  columns.push_back(warmer.cwiseProduct(warmer));
  result.offset_m_per_c2 = fit(columns, result.offset_m).coefficients.back();
  result.signal_per_c2 = fit(columns, result.log_signal).coefficients.back();
}

bool is_significant(const Estimate& term) {
  return std::abs(term.value) > significant * term.standard_error;
}

void note_temperatures(const std::vector<double>& temperature_c, std::vector<std::string>& notes) {
  const auto [least, most] = std::ranges::minmax_element(temperature_c);
  if (*most - *least < narrow_c)
    notes.push_back(fmt::format("temperatures vary by {:.2g} degrees only", *most - *least));
  constexpr double hottest_c = 200.0;
  if (*least > hottest_c)
    notes.push_back(
        fmt::format("temperatures of {:.4g} and more are implausible for cameras; check that they "
                    "are in degrees C, not kelvin",
                    *least));
}

/// Adds notes on terms that the lines lack.
void note_lines(bool has_sensor, TemperatureDrift& result) {
  for (const auto& [what, second] :
       {std::pair("offset", result.offset_m_per_c2), std::pair("signal", result.signal_per_c2)})
    if (is_significant(second))
      result.notes.push_back(fmt::format("{} is not linear in temperature", what));
  if (result.hysteresis_m && is_significant(*result.hysteresis_m))
    result.notes.push_back(
        fmt::format("hysteresis: at the same temperature, depth is {:+.3g} ± {:.2g} mm larger "
                    "while the temperature rises than while it falls, so the thermometer leads or "
                    "lags the part that drifts. {}",
                    1e3 * result.hysteresis_m->value,
                    1e3 * result.interval_factor * result.hysteresis_m->standard_error,
                    has_sensor ? "Record slower changes"
                               : "Record slower changes, or fit the temperatures of light "
                                 "source and sensor together"));
}

}  // namespace

TemperatureDrift calibrate_temperature(const RawFrames& frames,
                                       const FrameTemperatures& temperatures, const CodeSet& code,
                                       const Camera& camera, const Progress& progress) {
  validate(frames, temperatures);
  Camera cold = camera;
  cold.temperature.reset();
  const DecodingTable table = make_decoding_table(ForwardModel(code, cold), cold);
  // Errors of the model must not reject pixels.
  const Decoder decoder(table, {.false_alarm_rate = 0.0});
  const ProgressParts parts(progress, static_cast<std::size_t>(frames.frames));
  std::vector<DepthImage> images;
  for (int f = 0; f < frames.frames; ++f)
    images.push_back(decoder.decode(frames, f, parts[static_cast<std::size_t>(f)]));

  TemperatureDrift result;
  compare_frames(images, table.range_m, result);
  fit_lines(temperatures, result);
  note_lines(!temperatures.of_sensor_c.empty(), result);
  note_temperatures(temperatures.of_camera_c, result.notes);
  if (result.sensor) note_temperatures(temperatures.of_sensor_c, result.notes);
  return result;
}

Camera with_temperature(Camera camera, const TemperatureDrift& found,
                        std::optional<double> reference_c,
                        std::optional<double> sensor_reference_c) {
  camera.temperature = Temperature{.reference_c = reference_c.value_or(found.mean_c),
                                   .offset_m_per_c = found.offset_m_per_c.value,
                                   .signal_per_c = found.signal_per_c.value};
  require(found.sensor || !sensor_reference_c, "sensor_reference_c",
          sensor_reference_c.value_or(0.0), "requires a drift with the sensor's temperature");
  if (found.sensor)
    camera.temperature->sensor =
        SensorTemperature{.reference_c = sensor_reference_c.value_or(found.sensor->mean_c),
                          .offset_m_per_c = found.sensor->offset_m_per_c.value,
                          .signal_per_c = found.sensor->signal_per_c.value};
  camera.validate();
  return camera;
}

}  // namespace tofsmith
