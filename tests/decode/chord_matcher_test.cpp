// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Tables with large angles between bins, compared with a search of all their chords.
#include "decode/search/chord_matcher.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "decode_setup.hpp"
#include "reference_decoder.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

/// Returns a curve of random harmonics with large angles between rows. A component at the highest
/// frequency prevents interpolation as a smooth curve.
DecodingTable coarse_table(int measurements, int samples, std::uint64_t seed) {
  const int harmonics = measurements;
  DecodingTable table = make_decoding_table(
      ForwardModel(
          build_family("sinusoid-k" + std::to_string(measurements), camera_with("paper-10f0")),
          camera_with("paper-10f0")),
      camera_with("paper-10f0"));
  RandomStream random(seed, 0);
  table.correlation.resize(samples, measurements);
  for (int k = 0; k < measurements; ++k) {
    Eigen::VectorXd of_tap = Eigen::VectorXd::Zero(samples);
    for (int h = 1; h <= harmonics; ++h) {
      const double phase = 2.0 * std::numbers::pi * random.uniform(), size = random.uniform();
      for (int n = 0; n < samples; ++n)
        of_tap[n] += size * std::cos(2.0 * std::numbers::pi * h * n / samples + phase);
    }
    for (int n = 0; n < samples; n += 2) of_tap[n] += 1e-3;
    of_tap.array() -= of_tap.minCoeff();
    table.correlation.col(k) = of_tap / of_tap.maxCoeff();
  }
  table.shot_correlation = {};
  table.validate();
  return table;
}

/// Chords up to 10 degrees are not subdivided; two depths closer than half of that may be confused.
constexpr double closest_score = 1.0 - 4e-3;

/// Excludes jumps.
double best_score(const ReferenceDecoder& reference, const Eigen::VectorXd& difference,
                  const Eigen::VectorXd& turn_rad) {
  double best = 0.0;
  for (int n = 0; n < turn_rad.size(); ++n) {
    const auto before = n > 0 ? n - 1 : turn_rad.size() - 1;
    if (std::max(turn_rad[n], turn_rad[before]) <= jump_turn_rad)
      best = std::max(best, reference.best_score_beside(difference, n));
  }
  return best;
}

class CoarseTable : public testing::TestWithParam<int> {};

TEST_P(CoarseTable, FindsEveryDepthBetweenItsBinsWithoutNoise) {
  for (const int samples : {24, 36, 60}) {
    const DecodingTable table = coarse_table(GetParam(), samples, 7);
    ASSERT_GT(furthest_turn_rad(table), coarse_turn_rad);
    const Eigen::VectorXd turn_rad = turns_of(AmbientProjection(table).curve);
    const Decoder decoder(table);
    const ReferenceDecoder reference(table);
    std::vector<float> raw;
    std::vector<double> truth;
    for (int i = 0; i < 10 * samples; ++i) {
      const double depth_bin = 0.1 * i;
      const int from = static_cast<int>(depth_bin), to = (from + 1) % samples;
      if (turn_rad[from] > jump_turn_rad) continue;
      truth.push_back(depth_bin);
      const double t = depth_bin - from;
      for (int k = 0; k < table.measurements(); ++k)
        raw.push_back(static_cast<float>(
            1e6 * table.exposure_s[k] *
                ((1 - t) * table.correlation(from, k) + t * table.correlation(to, k)) +
            table.dark_electrons[k]));
    }
    std::vector<double> found(truth.size());
    decoder.decode_depth_bins(raw.data(), std::ssize(truth), found.data());
    int off = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const Eigen::VectorXd difference =
          reference.difference(&raw[i * static_cast<std::size_t>(table.measurements())]);
      EXPECT_GE(reference.score_at(difference, found[i]), closest_score * difference.norm());
      off += std::abs(circular_difference(found[i], truth[i], samples)) > 1e-3;
    }
    EXPECT_LE(off, std::ssize(truth) / 50) << samples;
  }
}

TEST_P(CoarseTable, FindsTheBestOfAllChords) {
  const DecodingTable table = coarse_table(GetParam(), 60, 3);
  const Eigen::VectorXd turn_rad = turns_of(AmbientProjection(table).curve);
  const Decoder decoder(table);
  const ReferenceDecoder reference(table);
  constexpr int pixels = 400;
  const std::vector<float> raw = noisy_pixels(table, 1e5, 1e4, pixels, 5);
  std::vector<double> found(pixels);
  decoder.decode_depth_bins(raw.data(), pixels, found.data());
  std::vector<float> depth_m(pixels);
  DecodedView planes;
  planes.depth_m = depth_m.data();
  decoder.decode(RawView::interleaved(raw.data(), 1, pixels, table.measurements()), planes);
  int ties = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const Eigen::VectorXd difference =
        reference.difference(&raw[i * static_cast<std::size_t>(table.measurements())]);
    const double best = best_score(reference, difference, turn_rad);
    const double score = reference.score_at(difference, found[i]);
    EXPECT_GE(score, closest_score * best);
    ties += score < (1.0 - 1e-9) * best;
    EXPECT_NEAR(circular_difference(depth_m[i] / table.bin_m(), found[i], 60.0), 0.0, 1e-3);
  }
  EXPECT_LE(ties, pixels / 50);
}

TEST_P(CoarseTable, DoesNotChangeTheBestBins) {
  const DecodingTable table = coarse_table(GetParam(), 60, 3);
  const Decoder decoder(table);
  const ReferenceDecoder reference(table);
  constexpr int pixels = 500;
  const std::vector<float> raw = noisy_pixels(table, 1e4, 1e4, pixels, 5);
  std::vector<std::int32_t> plane(pixels), bins(pixels);
  std::vector<float> depth_m(pixels);
  DecodedView planes;
  planes.bin = plane.data();
  planes.depth_m = depth_m.data();
  decoder.decode(RawView::interleaved(raw.data(), 1, pixels, table.measurements()), planes);
  decoder.decode_bins(raw.data(), pixels, bins.data());
  EXPECT_EQ(plane, bins);
  for (std::size_t i = 0; i < pixels; ++i)
    EXPECT_EQ(bins[i], reference.bin(&raw[i * static_cast<std::size_t>(table.measurements())]));
}

INSTANTIATE_TEST_SUITE_P(Measurements, CoarseTable, testing::Values(4, 5, 7));

TEST(ChordMatcher, DoesNotSubdivideFineTablesOrJumps) {
  for (const char* code :
       {"hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5", "sinusoid-k4", "double-ramp-k3"}) {
    const DecodeSetup setup(code, camera_with("paper-10f0"));
    const AmbientProjection projection(setup.decoder.table());
    EXPECT_FALSE(ChordMatcher(setup.decoder.table(), projection).is_coarse()) << code;
  }
}

}  // namespace
}  // namespace tofsmith
