// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "calibrate/harmonic_basis.hpp"
#include "calibrate/reference_samples.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

namespace {

constexpr int min_frames = 5;
constexpr double narrow_c = 2.0;
constexpr double curved = 4.0;  // standard errors of the second-order term

void validate(const RawFrames& frames, const std::vector<double>& temperature_c) {
  require(temperature_c.size() == static_cast<std::size_t>(frames.frames), "temperatures",
          temperature_c.size(),
          fmt::format("must be one for each of the {} frames", frames.frames));
  require(frames.frames >= min_frames, "frames", frames.frames,
          fmt::format("must be at least {}", min_frames));
  for (const double t : temperature_c)
    require(std::isfinite(t), "temperatures", t, "each must be finite");
  const auto [least, most] = std::ranges::minmax_element(temperature_c);
  require(*most > *least, "temperatures", *least, "must not all be the same");
}

/// 97.5 % point of Student's t: the normal one, corrected to third order (Abramowitz and Stegun
/// 26.7.5); 1 % low at 3 degrees of freedom.
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

/// Highest coefficient of a polynomial fit, and what is left over.
struct Slope {
  Estimate highest;
  double rms = 0.0;
};
Slope fit(const std::vector<double>& x, const std::vector<double>& y, int degree) {
  const auto count = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd terms(count, degree + 1);
  terms.col(0).setOnes();
  const Eigen::Map<const Eigen::VectorXd> at(x.data(), count), of(y.data(), count);
  for (int d = 1; d <= degree; ++d) terms.col(d) = terms.col(d - 1).cwiseProduct(at);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(terms);
  if (qr.rank() <= degree) return {};
  const Eigen::VectorXd coefficient = qr.solve(of);
  const double variance =
      (of - terms * coefficient).squaredNorm() / static_cast<double>(count - degree - 1);
  const Eigen::MatrixXd covariance = (terms.transpose() * terms).inverse() * variance;
  return {{coefficient[degree], std::sqrt(covariance(degree, degree))}, std::sqrt(variance)};
}

}  // namespace

TemperatureDrift calibrate_temperature(const RawFrames& frames,
                                       const std::vector<double>& temperature_c,
                                       const CodeSet& code, const Camera& camera,
                                       const Progress& progress) {
  validate(frames, temperature_c);
  Camera cold = camera;
  cold.temperature.reset();
  const DecodingTable table = make_decoding_table(ForwardModel(code, cold), cold);
  const double range_m = table.range_m;
  // Errors of the model must not drop pixels.
  const Decoder decoder(table, {.false_alarm_rate = 0.0});
  const auto count = static_cast<std::size_t>(frames.frames);
  const ProgressParts parts(progress, count);
  std::vector<DepthImage> images;
  for (int f = 0; f < frames.frames; ++f)
    images.push_back(decoder.decode(frames, f, parts[static_cast<std::size_t>(f)]));

  // Each pixel against its own mean over frames.
  TemperatureDrift result;
  result.temperature_c = temperature_c;
  std::vector<std::vector<Weighted>> offsets(count), signals(count);
  for (std::size_t i = 0; i < frames.pixels_per_frame(); ++i) {
    std::complex<double> direction = 0.0;
    double mean_log = 0.0, variance = 0.0;
    bool counts = true;
    for (const DepthImage& image : images) {
      const auto signal = static_cast<double>(image.signal_e_per_s.pixels[i]);
      counts = counts && image.status.pixels[i] == PixelStatus::ok && signal > 0.0;
      if (!counts) break;
      const auto deviation_m = static_cast<double>(image.predicted_standard_deviation_m.pixels[i]);
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
          "there must be some that decode with status ok in every frame");
  for (std::size_t f = 0; f < count; ++f) {
    result.offset_m.push_back(weighted_median(std::move(offsets[f])));
    result.log_signal.push_back(weighted_median(std::move(signals[f])));
  }

  // Lines over temperature, and whether they bend.
  result.mean_c =
      std::accumulate(temperature_c.begin(), temperature_c.end(), 0.0) / static_cast<double>(count);
  std::vector<double> from_mean_c = temperature_c;
  for (double& t : from_mean_c) t -= result.mean_c;
  const Slope offset = fit(from_mean_c, result.offset_m, 1);
  const Slope signal = fit(from_mean_c, result.log_signal, 1);
  result.offset_m_per_c = offset.highest;
  result.signal_per_c = signal.highest;
  result.offset_rms_m = offset.rms;
  result.signal_rms = signal.rms;
  result.offset_m_per_c2 = fit(from_mean_c, result.offset_m, 2).highest;
  result.signal_per_c2 = fit(from_mean_c, result.log_signal, 2).highest;
  result.interval_factor = t_factor(frames.frames - 2);
  const auto say_if_curved = [&](const char* what, const Estimate& second) {
    if (std::abs(second.value) > curved * second.standard_error)
      result.notes.push_back(
          fmt::format("{} bends over temperature: a line is not enough of it", what));
  };
  say_if_curved("offset", result.offset_m_per_c2);
  say_if_curved("signal", result.signal_per_c2);
  const auto [least, most] = std::ranges::minmax_element(temperature_c);
  if (*most - *least < narrow_c)
    result.notes.push_back(fmt::format("temperatures vary by {:.2g} degrees only", *most - *least));
  constexpr double hottest_c = 200.0;
  if (*least > hottest_c)
    result.notes.push_back(
        fmt::format("temperatures from {:.4g} on are hotter than cameras get: are they in kelvin? "
                    "--temperature "
                    "is in degrees C",
                    *least));
  return result;
}

Camera with_temperature(Camera camera, const TemperatureDrift& found,
                        std::optional<double> reference_c) {
  camera.temperature = Temperature{.reference_c = reference_c.value_or(found.mean_c),
                                   .offset_m_per_c = found.offset_m_per_c.value,
                                   .signal_per_c = found.signal_per_c.value};
  camera.validate();
  return camera;
}

}  // namespace tofsmith
