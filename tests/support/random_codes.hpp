// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/shared/random.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

struct RandomCode {
  int measurements, samples;
  int rank;  ///< upper limit of the rank of its curve without ambient light
};

/// A smooth closed curve, randomly oriented in measurement space.
inline DecodingTable random_table(const RandomCode& code, RandomStream& random) {
  Eigen::MatrixXd curve(code.samples, code.rank), axes(code.rank, code.measurements);
  for (int j = 0; j < code.rank; ++j) {
    const double shift = random.uniform(), size = 1.0 / (1 + j / 2);
    for (int n = 0; n < code.samples; ++n)
      curve(n, j) = size * std::cos(2 * std::numbers::pi *
                                    ((1 + j / 2) * n / double(code.samples) - 0.25 * j - shift));
  }
  for (double& value : axes.reshaped()) value = random.normal();
  const auto each = [&](double low, double high) {
    Eigen::VectorXd values(code.measurements);
    for (double& value : values) value = low + (high - low) * random.uniform();
    return values;
  };
  DecodingTable table;
  table.correlation = curve * axes;
  table.correlation.array() += 1.0 - table.correlation.minCoeff();
  table.ambient_gain = each(0.5, 1.0);
  table.exposure_s = each(0.01, 0.02);
  table.dark_electrons = each(0.0, 30.0);
  table.constant_variance_e2 = each(50.0, 100.0);
  table.black_level = each(0.0, 64.0);
  table.gain_e_per_raw = each(1.0, 3.0);
  table.range_m = 10.0;
  return table;
}

/// Returns raw values (pixels, K) of three equal parts: a slanted plane, random depths, and depths
/// on and half-way between bins, half of the latter without noise.
inline std::vector<float> random_pixels(const DecodingTable& table, int pixels,
                                        RandomStream& random) {
  const int samples = table.samples();
  std::vector<float> raw;
  const double start = random.uniform() * samples, slope = 0.2 * samples / pixels;
  for (int i = 0; i < pixels; ++i) {
    const int part = 3 * i / pixels;
    double depth_bin = random.uniform() * samples;
    if (part == 0) depth_bin = start + slope * i;
    if (part == 2) depth_bin = std::floor(depth_bin) + 0.5 * (i % 2);
    const int from = static_cast<int>(depth_bin) % samples, to = (from + 1) % samples;
    const double t = depth_bin - std::floor(depth_bin);
    const double signal = std::pow(10.0, 3 + 3 * random.uniform()),
                 noise = part == 2 ? i / 2 % 2 : 1;
    for (int k = 0; k < table.measurements(); ++k) {
      const double chi = (1 - t) * table.correlation(from, k) + t * table.correlation(to, k);
      const double mean = table.exposure_s[k] * (signal * chi + 1e5 * table.ambient_gain[k]) +
                          table.dark_electrons[k];
      raw.push_back(static_cast<float>(table.black_level[k] +
                                       (mean + noise * std::sqrt(mean) * random.normal()) /
                                           table.gain_e_per_raw[k]));
    }
  }
  return raw;
}

// Equally many codes for each search method (by angle, by cells of two ranks, by arcs), for full
// rank with K = 3 and 4, for larger K, and for few and many bins.
inline constexpr RandomCode random_codes[] = {
    {3, 8, 2},    {3, 1500, 2}, {4, 64, 3},  {4, 700, 3},  {5, 9, 4},   {5, 1000, 4}, {6, 300, 3},
    {7, 5000, 4}, {8, 400, 4},  {9, 120, 8}, {12, 900, 2}, {13, 50, 4}, {16, 2000, 6}};

}  // namespace tofsmith
