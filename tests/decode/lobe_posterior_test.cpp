// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include "core/shared/random.hpp"
#include "decode/ambient_projection.hpp"
#include "decode/output/lobe_posterior.hpp"
#include "decode/search/chord_matcher.hpp"
#include "decode/search/smooth_curve.hpp"
#include "decode_setup.hpp"
#include "each_target.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/decode_method.hpp"

namespace tofsmith {

namespace {

/// Returns ln of the integral of exp(c t - t^2 / 2) / t dt from 0.1 to infinity, by the trapezoidal
/// rule over ln t or, for large c, by its asymptotic series.
inline double reference_log_density(double c) {
  if (c > 20.0)
    return 0.5 * c * c + std::log(std::sqrt(2 * std::numbers::pi) / c * (1.0 + 1.0 / (c * c)));
  constexpr int steps = 600;
  const double from = std::log(0.1), to = std::log(std::max(c, 0.0) + 9.0);
  const double step = (to - from) / steps;
  const auto exponent = [c](double t) { return c * t - 0.5 * t * t; };
  const double largest = exponent(std::max(c, 0.1));
  double sum = 0.0;
  for (int i = 0; i <= steps; ++i)
    sum += (i == 0 || i == steps ? 0.5 : 1.0) *
           std::exp(exponent(std::exp(from + i * step)) - largest);
  return largest + std::log(sum * step);
}

/// Returns the posterior probability of the main lobe according to its definition, in double,
/// sampled at `parts` points per row on the chords; a smooth curve is first interpolated to twice
/// the number of rows.
/// @param q            measurement after projection (rank)
/// @param variance_e2  (K)
inline double reference_posterior(const AmbientProjection& projection, const MainLobe& lobe,
                                  const Eigen::VectorXd& q, const Eigen::VectorXd& variance_e2,
                                  std::int32_t row, int parts) {
  const Eigen::MatrixXd& v = projection.noise_basis;
  const Eigen::LLT<Eigen::MatrixXd> covariance(v.transpose() * variance_e2.asDiagonal() * v);
  const Eigen::VectorXd white = covariance.matrixL().solve(q);
  const int finer = depth_polynomials(projection.curve) ? 2 : 1;
  const RowMajorMatrix curve =
      finer > 1 ? RowMajorMatrix(interpolated(projection.curve, finer)) : projection.curve;
  const Eigen::VectorXd turn_rad = turns_of(curve);
  const auto samples = static_cast<std::int32_t>(curve.rows());
  std::vector<double> log_density, away;
  for (std::int32_t n = 0; n < samples; ++n)
    for (int part = 0; part < parts; ++part) {
      double t = (part + 0.5) / parts;
      if (turn_rad[n] > jump_turn_rad) t = t < 0.5 ? 0.0 : 1.0;
      const Eigen::VectorXd point =
          (1 - t) * curve.row(n).transpose() + t * curve.row((n + 1) % samples).transpose();
      const Eigen::VectorXd direction = covariance.matrixL().solve(point);
      const double length = direction.norm();
      log_density.push_back(
          reference_log_density(length > 0.0 ? white.dot(direction) / length : 0.0));
      away.push_back(std::remainder((n + (part + 0.5) / parts) / finer - row, samples / finer));
    }
  const double largest = *std::max_element(log_density.begin(), log_density.end());
  double inside = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < away.size(); ++i) {
    const double mass = std::exp(log_density[i] - largest);
    whole += mass;
    if (away[i] >= -lobe.left && away[i] <= lobe.right) inside += mass;
  }
  return inside / whole;
}

// Confidence as a posterior probability, compared with its definition by brute force and with the
// fraction of depths in the correct lobe.

double signal_deviation(const DecodingTable& table, double ambient) {
  const AmbientProjection projection(table);
  const ExpectedNoise noise(table);
  const double variance = (ambient * noise.shot_ambient + noise.floor_variance_e2).mean();
  return std::sqrt(variance) / projection.curve.rowwise().norm().mean();
}

/// Differences are in standard deviations.
double largest_difference(const DecodingTable& table, const std::vector<double>& signals,
                          int pixels, int parts) {
  const AmbientProjection projection(table);
  const ExpectedNoise noise(table);
  const LobePosterior posterior(table, projection);
  const double ambient = 1e4, deviation = signal_deviation(table, ambient);
  RandomStream random(3, 0);
  double largest = 0.0;
  for (const double signal : signals)
    for (int i = 0; i < pixels; ++i) {
      const auto bin = static_cast<std::int32_t>(random.uniform() * table.samples());
      const Eigen::VectorXd variance = (signal * deviation * noise.shot_gated.row(bin).transpose() +
                                        ambient * noise.shot_ambient + noise.floor_variance_e2)
                                           .cwiseMax(1e-3);
      Eigen::VectorXd white(table.measurements());
      for (double& value : white) value = random.normal();
      const Eigen::VectorXd q =
          signal * deviation * projection.curve.row(bin).transpose() +
          projection.noise_basis.transpose() * variance.cwiseSqrt().cwiseProduct(white);
      Eigen::Index best = 0;
      (projection.curve.rowwise().normalized() * q).maxCoeff(&best);
      const auto at = static_cast<std::int32_t>(best);
      const double expected =
          reference_posterior(projection, posterior.main_lobe(at), q, variance, at, parts);
      std::optional<double> first;
      for_each_target([&](std::int64_t) {
        const double found = posterior.probability(q.data(), variance.data(), at);
        largest = std::max(largest, std::abs(found - expected));
        EXPECT_EQ(found, first.value_or(found)) << "not the same on every processor";
        first = found;
      });
    }
  return largest;
}

TEST(LobePosterior, IsTheIntegralOverTheCurveAndAllSignals) {
  const Camera one_tap = camera_with("paper-10f0"), two_buckets = camera_with("paper-10f0", 2);
  Camera unequal = one_tap;
  unequal.exposure_s.each_s = {0.01, 0.03, 0.05, 0.13};
  for (const auto& [code, camera] : {std::pair{"sinusoid-k4", one_tap},
                                     {"hamiltonian-k3", one_tap},
                                     {"hamiltonian-k4", one_tap},
                                     {"hamiltonian-k5", one_tap},
                                     {"multifrequency-k5", one_tap},
                                     {"gray-k4", one_tap},
                                     {"hamiltonian-k4", two_buckets},
                                     {"hamiltonian-k4", unequal}})
    EXPECT_LT(largest_difference(decoding_table_of(code, camera), {0.0, 1.0, 2.0, 4.0, 8.0}, 6, 1),
              0.02)
        << code;
}

TEST(LobePosterior, CountsAllBinsOfARunOfOneDirection) {
  // Correlation functions that rise from 0 have rows that differ in signal only.
  const DecodingTable table = decoding_table_of("gray-k4", camera_with("paper-30x"));
  // In the brightest light the lobe ends at bins, not half a bin further: 0.5 of 15 bins.
  EXPECT_LT(largest_difference(table, {20.0, 50.0, 300.0}, 12, 20), 0.05);
}

/// A smooth table with more rows puts pixels on the curve and not on chords.
DecodingTable finely_sampled(DecodingTable table) {
  constexpr int finer = 8;
  if (!depth_polynomials(AmbientProjection(table).curve)) return table;
  table.correlation = interpolated(table.correlation, finer);
  if (table.shot_correlation.size() > 0)
    table.shot_correlation = interpolated(table.shot_correlation, finer);
  return table;
}

/// Returns a curve of two nearly equal halves: depths half a range apart differ by `share` of the
/// signal, over a stretch of bins.
DecodingTable twins(int samples, double share) {
  Eigen::MatrixXd correlation(samples, 4);
  for (int n = 0; n < samples; ++n) {
    const double phase = 4 * std::numbers::pi * n / samples;
    const double beside = n < samples / 2 ? share : -share;
    correlation.row(n) << std::cos(phase), std::sin(phase), 0.8 * std::cos(3 * phase),
        0.8 * std::sin(3 * phase) + beside;
  }
  DecodingTable table = make_decoding_table(correlation, 10.0);
  table.ambient_gain.setZero();
  table.constant_variance_e2.setConstant(3600.0);
  table.shot_correlation = Eigen::MatrixXd::Zero(table.samples(), 4);
  table.shot_ambient_gain = Eigen::VectorXd::Zero(4);
  return table;
}

TEST(LobePosterior, FindsTwinsBetweenRowsInBrightLight) {
  // The main peak is narrower than a row, so that rows alone do not show which twin is higher.
  const DecodingTable table = twins(160, 0.003);
  EXPECT_LT(largest_difference(table, {60.0, 150.0, 330.0}, 6, 50), 0.02);
}

TEST(LobePosterior, DecodersReportTwinsAsAmbiguous) {
  const DecodingTable table = twins(160, 0.002);
  constexpr int pixels = 4000;
  const std::vector<float> raw = noisy_pixels(finely_sampled(table), 2e4, 0.0, pixels, 7);
  for (const DecodeMethod method : {DecodeMethod::zncc, DecodeMethod::ml}) {
    const DepthImage image = decode_row(method, table, raw);
    RandomStream random(7, 0);
    int ok = 0, wrong = 0;
    for (int i = 0; i < pixels; ++i) {
      const double truth_m = 10.0 * random.uniform();
      for (int k = 0; k < 4; ++k) random.normal();
      if (image.status.pixels[static_cast<std::size_t>(i)] != PixelStatus::ok) continue;
      ++ok;
      const double depth_m = image.depth_m.pixels[static_cast<std::size_t>(i)];
      wrong += std::abs(std::remainder(depth_m - truth_m, 10.0)) > 0.5;
    }
    EXPECT_LT(ok, pixels / 2) << name_of(method);
    EXPECT_LE(wrong, 0.1 * ok + 3) << name_of(method);
  }
}

/// Fraction of pixels in the main lobe by class of confidence, for log-uniform signals from 0.1 to
/// `brightest` deviations.
struct Reliability {
  static constexpr std::array<double, 8> edges = {0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.995, 2.0};
  std::array<RunningStatistics, edges.size()> claimed, right;
};

Reliability reliability_of(DecodingTable table, DecodeMethod method, int pixels) {
  constexpr double ambient = 1e4, darkest = 0.1, brightest = 300.0;
  table.hidden_ambient_e_per_s = 0.0;
  const double deviation = signal_deviation(table, ambient);
  table.hidden_ambient_e_per_s = ambient;
  const LobePosterior posterior(table, AmbientProjection(table));
  const DecodingTable fine = finely_sampled(table);
  RandomStream random(11, 0);
  std::vector<float> raw;
  std::vector<double> truth;
  for (int i = 0; i < pixels; ++i) {
    truth.push_back(table.samples() * random.uniform());
    const double signal = deviation * darkest * std::pow(brightest / darkest, random.uniform());
    const double depth_bin = truth.back() * fine.bin_count() / table.samples();
    append_noisy_pixel(fine, signal, ambient, depth_bin, random, raw);
  }
  const DepthImage image = decode_row(method, table, raw);
  Reliability result;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double confidence = image.confidence.pixels[i];
    if (std::isnan(confidence)) continue;
    const double depth_row = image.depth_m.pixels[i] / table.row_m();
    const auto row = static_cast<std::int32_t>(std::lround(depth_row)) % table.samples();
    const MainLobe lobe = posterior.main_lobe(row);
    const double away = std::remainder(truth[i] - row, table.samples());
    const auto at = static_cast<std::size_t>(
        std::upper_bound(Reliability::edges.begin(), Reliability::edges.end(), confidence) -
        Reliability::edges.begin());
    result.claimed[at].add(confidence);
    result.right[at].add(away >= -lobe.left && away <= lobe.right);
  }
  return result;
}

void expect_reliable(const DecodingTable& table, DecodeMethod method, int pixels,
                     const std::string& what) {
  const Reliability found = reliability_of(table, method, pixels);
  int classes = 0;
  for (std::size_t i = 0; i < found.claimed.size(); ++i) {
    if (found.claimed[i].count() < 200) continue;
    ++classes;
    const double claimed = found.claimed[i].mean(), right = found.right[i].mean();
    const double noise =
        4 * std::sqrt(claimed * (1 - claimed) / static_cast<double>(found.claimed[i].count()));
    const double allowed = claimed > 0.9 ? 0.02 : claimed > 0.7 ? 0.03 : 0.05;
    EXPECT_NEAR(claimed, right, allowed + noise) << what << ", " << found.claimed[i].count();
  }
  EXPECT_GE(classes, 3) << what;
}

TEST(Confidence, IsTheFractionOfPixelsInTheCorrectLobe) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5",
                           "multifrequency-k5", "pulsed-multifrequency-k5", "square-k4"})
    expect_reliable(decoding_table_of(code, camera_with("paper-10f0")), DecodeMethod::zncc, 20000,
                    code);
  expect_reliable(decoding_table_of("hamiltonian-k4", camera_with("paper-10f0", 2)),
                  DecodeMethod::zncc, 20000, "two buckets");
}

TEST(Confidence, SeparatesCloseLobesOfHighHarmonics) {
  Camera camera = camera_with("paper-10f0", 2);
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  camera.sensor.drain = false;
  camera.sensor.readout = Readout::difference;
  for (const char* code :
       {"multifrequency-29x4-30x4", "multifrequency-59x4-60x4", "multifrequency-29x3-30x3-31x3"})
    expect_reliable(decoding_table_of(code, camera), DecodeMethod::zncc, 6000, code);
}

TEST(Confidence, IsTheFractionOfPixelsInTheCorrectLobeForOtherMethods) {
  for (const char* code : {"hamiltonian-k4", "multifrequency-k5"})
    expect_reliable(decoding_table_of(code, camera_with("paper-10f0")), DecodeMethod::ml, 3000,
                    code);
  const Camera sharp = camera_with("paper-30x");
  expect_reliable(decoding_table_of("hamiltonian-k5", sharp), DecodeMethod::ml, 3000,
                  "hamiltonian-k5");
  expect_reliable(decoding_table_of("multifrequency-k5", sharp), DecodeMethod::unwrap, 6000,
                  "multifrequency-k5");
  const Camera kinect = built_in_camera("kinect-v2");
  expect_reliable(decoding_table_of("multifrequency-2x3-10x3-15x3", kinect), DecodeMethod::unwrap,
                  6000, "kinect-v2");
}

}  // namespace

}  // namespace tofsmith
