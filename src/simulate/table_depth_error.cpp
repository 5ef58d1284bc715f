// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/table_depth_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/random.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

namespace {

/// Raw numbers of pixels that a table describes.
class TablePixels {
 public:
  TablePixels(const DecodingTable& table, const OperatingPoint& light)
      : table_(table), mean_e_(light.signal_e_per_s * table.correlation) {
    const bool own_light = table.shot_correlation.size() > 0;
    variance_e2_ = light.signal_e_per_s * (own_light ? table.shot_correlation : table.correlation);
    mean_e_.rowwise() += light.ambient_e_per_s * table.ambient_gain.transpose();
    variance_e2_.rowwise() +=
        light.ambient_e_per_s *
        (table.shot_ambient_gain.size() > 0 ? table.shot_ambient_gain : table.ambient_gain)
            .transpose();
    mean_e_ *= table.exposure_s.asDiagonal();
    variance_e2_ *= table.exposure_s.asDiagonal();
    mean_e_.rowwise() += table.dark_electrons.transpose();
    variance_e2_.rowwise() +=
        (table.shot_dark_electrons.size() > 0 ? table.shot_dark_electrons : table.dark_electrons)
            .transpose();
    variance_e2_.rowwise() += table.constant_variance_e2.transpose();
  }

  void draw(double depth_bin, RandomStream& random, float* raw) const {
    const auto from = static_cast<Eigen::Index>(depth_bin), to = (from + 1) % mean_e_.rows();
    const double t = depth_bin - static_cast<double>(from);
    for (Eigen::Index k = 0; k < mean_e_.cols(); ++k) {
      const double mean = (1 - t) * mean_e_(from, k) + t * mean_e_(to, k);
      const double variance = (1 - t) * variance_e2_(from, k) + t * variance_e2_(to, k);
      const double electrons = mean + std::sqrt(std::max(variance, 0.0)) * random.normal();
      raw[k] = static_cast<float>(electrons / table_.gain_e_per_raw[k] + table_.black_level[k]);
    }
  }

 private:
  const DecodingTable& table_;
  Eigen::MatrixXd mean_e_, variance_e2_;  // (N, K)
};

/// Sums over pairs of trials in neighbouring slices.
struct Sums {
  double error = 0.0;
  double squared_differences = 0.0;
};

}  // namespace

Estimate table_depth_error_m(const DecodingTable& table, const OperatingPoint& light,
                             std::int64_t trials, std::uint64_t seed) {
  require(trials >= 2, "trials", trials, "must be >= 2");
  constexpr std::int64_t pairs_per_block = 256;
  const Decoder decoder(table);
  const TablePixels pixels(table, light);
  const std::int64_t pairs = (trials + 1) / 2;
  const int samples = table.samples(), measurements = table.measurements();

  std::vector<Sums> of_block(
      static_cast<std::size_t>((pairs + pairs_per_block - 1) / pairs_per_block));
  parallel_for_blocks(pairs, pairs_per_block, [&](IndexRange range) {
    const std::int64_t first = 2 * range.begin, count = 2 * (range.end - range.begin);
    std::vector<double> truth(static_cast<std::size_t>(count)), found(truth);
    std::vector<float> raw(truth.size() * static_cast<std::size_t>(measurements));
    for (std::int64_t i = 0; i < count; ++i) {
      RandomStream random(seed, static_cast<std::uint64_t>(first + i));
      const double slice = static_cast<double>(first + i) + random.uniform();
      const double depth_bin = slice / static_cast<double>(2 * pairs) * samples;
      truth[static_cast<std::size_t>(i)] = depth_bin;
      pixels.draw(depth_bin, random, &raw[static_cast<std::size_t>(i * measurements)]);
    }
    decoder.decode_depth_bins(raw.data(), count, found.data());
    Sums& sums = of_block[static_cast<std::size_t>(range.begin / pairs_per_block)];
    const auto error_of = [&](std::size_t i) {
      return std::abs(circular_difference(found[i], truth[i], samples));
    };
    for (std::size_t i = 0; i < truth.size(); i += 2) {
      const double a = error_of(i), b = error_of(i + 1);
      sums.error += a + b;
      sums.squared_differences += (a - b) * (a - b);
    }
  });

  Sums total;
  for (const Sums& sums : of_block) {
    total.error += sums.error;
    total.squared_differences += sums.squared_differences;
  }
  const double per_trial = table.bin_m() / static_cast<double>(2 * pairs);
  return {total.error * per_trial, std::sqrt(total.squared_differences) * per_trial};
}

}  // namespace tofsmith
