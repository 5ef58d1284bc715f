// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "decode_setup.hpp"
#include "pixel_laws.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/decode/likelihood_decoder.hpp"

namespace tofsmith {

namespace {

/// Direct implementation of a pixel's likelihood, evaluated independently at each depth.
class ReferenceLikelihood {
 public:
  explicit ReferenceLikelihood(const DecodingTable& table)
      : table_(table),
        shot_(table.shot()),
        shot_ambient_gain_(table.shot_ambient()),
        floor_(table.constant_variance_e2 + table.shot_dark()) {
    const Eigen::VectorXd a = table.exposure_s.cwiseProduct(table.ambient_gain);
    sees_ambient_ = a.norm() > 1e-9 * table.exposure_s.norm();
  }

  bool sees_ambient() const { return sees_ambient_; }

  Eigen::VectorXd electrons(const float* raw) const {
    Eigen::VectorXd y(table_.measurements());
    for (int k = 0; k < y.size(); ++k)
      y[k] = (raw[k] - table_.black_level[k]) * table_.gain_e_per_raw[k] - table_.dark_electrons[k];
    return y;
  }

  /// sum (y - mu)^2 / v + log v.
  double cost(const Eigen::VectorXd& y, double depth_bin, double signal, double ambient) const {
    const Eigen::VectorXd mean = signal * seen(depth_bin) + ambient * seen_ambient();
    const Eigen::ArrayXd v = variance(y, depth_bin, signal, ambient).array();
    return ((y - mean).array().square() / v + v.log()).sum();
  }

  /// Minimum over a grid of depths and over all iterations of a reweighted least-squares fit of the
  /// light.
  double min_cost(const Eigen::VectorXd& y, int depths_per_bin) const {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < table_.samples() * depths_per_bin; ++i) {
      const double depth_bin = static_cast<double>(i) / depths_per_bin;
      Eigen::VectorXd v = Eigen::VectorXd::Constant(y.size(), y.cwiseAbs().mean() + 1.0);
      for (int step = 0; step < 4; ++step) {
        const Eigen::Vector2d light = weighted_fit(y, depth_bin, v);
        least = std::min(least, cost(y, depth_bin, light[0], light[1]));
        v = variance(y, depth_bin, light[0], light[1]);
      }
    }
    return least;
  }

 private:
  Eigen::VectorXd at(const Eigen::MatrixXd& table, double depth_bin) const {
    const int from = static_cast<int>(depth_bin) % table_.samples();
    const int to = (from + 1) % table_.samples();
    const double t = depth_bin - std::floor(depth_bin);
    return ((1 - t) * table.row(from) + t * table.row(to)).transpose();
  }
  Eigen::VectorXd seen(double depth_bin) const {
    return at(table_.correlation, depth_bin).cwiseProduct(table_.exposure_s);
  }
  Eigen::VectorXd seen_ambient() const {
    return table_.exposure_s.cwiseProduct(table_.ambient_gain);
  }
  Eigen::VectorXd variance(const Eigen::VectorXd& y, double depth_bin, double signal,
                           double ambient) const {
    const Eigen::VectorXd light = signal * at(shot_, depth_bin) + ambient * shot_ambient_gain_;
    return (light.cwiseProduct(table_.exposure_s) + floor_).cwiseMax(1e-4 * y.cwiseAbs().mean());
  }
  /// Signal and ambient light, both >= 0.
  Eigen::Vector2d weighted_fit(const Eigen::VectorXd& y, double depth_bin,
                               const Eigen::VectorXd& v) const {
    const Eigen::VectorXd weight = v.cwiseSqrt().cwiseInverse();
    Eigen::MatrixXd light(y.size(), 2);
    light << seen(depth_bin), seen_ambient();
    const Eigen::MatrixXd whitened = weight.asDiagonal() * light;
    const Eigen::VectorXd target = weight.cwiseProduct(y);
    const auto alone = [&](int column) {
      const double length2 = whitened.col(column).squaredNorm();
      return length2 > 0.0 ? std::max(0.0, whitened.col(column).dot(target) / length2) : 0.0;
    };
    const Eigen::Vector2d only_signal(alone(0), 0.0), only_ambient(0.0, alone(1));
    if (!sees_ambient_) return only_signal;
    const Eigen::Vector2d both = whitened.colPivHouseholderQr().solve(target);
    if (both.allFinite() && both.minCoeff() >= 0.0) return both;
    const double left_by_signal = (target - whitened * only_signal).squaredNorm();
    const double left_by_ambient = (target - whitened * only_ambient).squaredNorm();
    return left_by_signal <= left_by_ambient ? only_signal : only_ambient;
  }

  DecodingTable table_;
  Eigen::MatrixXd shot_;
  Eigen::VectorXd shot_ambient_gain_, floor_;
  bool sees_ambient_ = true;
};

struct Case {
  const char* code;
  const char* camera = "paper-10f0";
  int taps = 1;
  Readout readout = Readout::separate;
  std::vector<double> exposure_s;
};

Camera camera_of(const Case& c) {
  Camera camera = camera_with(c.camera, c.taps, c.readout);
  camera.samples = std::string_view(c.code) == "gray-k4" ? 64 : 60;
  camera.exposure_s.each_s = c.exposure_s;
  return camera;
}

class LikelihoodOf : public testing::TestWithParam<Case> {};

TEST_P(LikelihoodOf, IsAtLeastThatOfADenseGrid) {
  const LikelihoodSetup setup(GetParam().code, camera_of(GetParam()));
  const DecodingTable& table = setup.decoder.table();
  const ReferenceLikelihood reference(table);
#ifdef NDEBUG
  const int pixels = 12;
#else
  const int pixels = 3;
#endif
  std::uint64_t seed = 1;
  for (const OperatingPoint& point :
       {OperatingPoint{1e3, 1e4}, OperatingPoint{3e3, 1e2}, OperatingPoint{1e4, 1e4},
        OperatingPoint{1e5, 1e2}, OperatingPoint{1e6, 1e4}}) {
    const std::vector<float> raw =
        noisy_pixels(table, point.signal_e_per_s, point.ambient_e_per_s, pixels, seed++);
    const DepthImage image = setup.decoder.decode(frame_of(raw, table.measurements()));
    for (int i = 0; i < pixels; ++i) {
      if (image.status(0, i) == PixelStatus::no_return) continue;
      const Eigen::VectorXd y =
          reference.electrons(&raw[static_cast<std::size_t>(i * table.measurements())]);
      const double ambient = reference.sees_ambient() ? image.ambient_e_per_s(0, i) : 0.0;
      const double found = reference.cost(y, image.depth_m(0, i) / table.row_m(),
                                          image.signal_e_per_s(0, i), ambient);
      EXPECT_LE(found, reference.min_cost(y, 4) + 1e-3)
          << "pixel " << i << " at " << point.signal_e_per_s << ", " << point.ambient_e_per_s;
      EXPECT_GE(image.signal_e_per_s(0, i), 0.0f);
      EXPECT_GE(ambient, 0.0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Codes, LikelihoodOf,
    testing::Values(
        Case{"hamiltonian-k3"}, Case{"hamiltonian-k4"}, Case{"hamiltonian-k5"},
        Case{"hamiltonian-k5", "paper-30x"}, Case{"sinusoid-k4", "paper-5f0"},
        Case{"multifrequency-k5"}, Case{"gray-k4"},
        Case{"single-ramp-k3", "paper-30x"},  // unequal duties
        Case{"double-ramp-k3"}, Case{"hamiltonian-k4", "paper-10f0", 2},
        Case{"hamiltonian-k5", "paper-10f0", 2, Readout::difference},
        Case{"hamiltonian-k4", "paper-10f0", 1, Readout::separate, {0.01, 0.03, 0.08, 0.18}},
        Case{"hamiltonian-k5", "paper-30x", 2, Readout::separate, {0.01, 0.02, 0.05, 0.08, 0.14}}));

TEST(LikelihoodDecoder, RecoversDepthSignalAndAmbientWithoutNoise) {
  for (const Case& c :
       {Case{"hamiltonian-k3", "paper-30x"}, Case{"hamiltonian-k5", "paper-30x"},
        Case{"multifrequency-k5", "paper-30x"}, Case{"hamiltonian-k4", "paper-30x", 2},
        Case{"hamiltonian-k5", "paper-30x", 2, Readout::difference},
        Case{"hamiltonian-k4", "paper-30x", 1, Readout::separate, {0.01, 0.03, 0.08, 0.18}}}) {
    const LikelihoodSetup setup(c.code, camera_of(c));
    std::vector<float> raw;
    for (int i = 0; i < 240; ++i) setup.append_expected(raw, 1e6, 0.25 * i, 1e4);
    const DepthImage image = setup.decoder.decode(frame_of(raw, setup.decoder.measurements()));
    for (int i = 0; i < 240; ++i) {
      const double at = image.depth_m(0, i) / setup.camera.bin_m();
      EXPECT_LT(std::abs(circular_difference(at, 0.25 * i, 60.0)), 2e-3) << c.code;
      // The chords between the rows of a sinusoid are shorter than the arc.
      const double tolerance = std::string_view(c.code) == "multifrequency-k5" ? 3000.0 : 300.0;
      EXPECT_NEAR(image.signal_e_per_s(0, i), 1e6, tolerance) << c.code;
      if (c.readout == Readout::difference)
        EXPECT_TRUE(std::isnan(image.ambient_e_per_s(0, i)));
      else
        EXPECT_NEAR(image.ambient_e_per_s(0, i), 1e4, tolerance) << c.code;
    }
  }
}

TEST(LikelihoodDecoder, TheSmallerOfTwoEqualDepthsWins) {
  // Two equal periods within the range.
  const LikelihoodSetup setup("multifrequency-2x4", camera_with("paper-30x"));
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e5, 1e4, 400, 3);
  for (const double at : depth_bins_of(setup.decoder, raw)) EXPECT_LT(at, 120.0);
}

TEST(LikelihoodDecoder, PositionsBinsAndFramesAgreeForAnyGroupingOfPixels) {
  const LikelihoodSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 3e3, 1e4, 500, 5);
  const std::vector<double> together = depth_bins_of(setup.decoder, raw);
  std::vector<std::int32_t> bins(500);
  setup.decoder.decode_bins(raw.data(), 500, bins.data());
  const DepthImage image = setup.decoder.decode(frame_of(raw, 4));
  for (std::size_t i = 0; i < 500; ++i) {
    double alone = 0.0;
    setup.decoder.decode_depth_bins(&raw[4 * i], 1, &alone);
    EXPECT_EQ(alone, together[i]);
    EXPECT_EQ(bins[i], std::lround(alone) % 240);
    EXPECT_FLOAT_EQ(image.depth_m.pixels[i], static_cast<float>(alone * setup.camera.bin_m()));
  }
}

TEST(LikelihoodDecoder, RejectsUnsuitableTablesAndStopsOnRequest) {
  const LikelihoodSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  EXPECT_THROW(setup.decoder.decode(frame_of(std::vector<float>(8, 1.0f), 4)),
               std::invalid_argument);
  EXPECT_THROW(setup.decoder.decode(frame_of(std::vector<float>(300, 1.0f), 3), 0,
                                    [](double, std::string_view) { return false; }),
               Interrupted);
  EXPECT_THROW(LikelihoodDecoder(setup.decoder.table(), {.min_confidence = 2.0}),
               std::invalid_argument);
}

TEST(LikelihoodDecoder, StrongSignalIsOk) {
  expect_strong_signal_is_ok(LikelihoodSetup("hamiltonian-k4", camera_with("paper-10f0")), 1e5,
                             100.0, 100.0);
}

TEST(LikelihoodDecoder, NaNIsInvalidAndDoesNotAffectNeighbours) {
  expect_not_a_number_disturbs_no_neighbour(
      LikelihoodSetup("hamiltonian-k4", camera_with("paper-10f0")).decoder, 20);
}

TEST(LikelihoodDecoder, PixelsWithoutReliableDepthAreMarked) {
  expect_statuses_of_bad_pixels<LikelihoodSetup>("hamiltonian-k4");
}

TEST(LikelihoodDecoder, NegativeSignalIsNoReturn) {
  expect_negative_signal_is_no_return<LikelihoodDecoder>();
}

TEST(LikelihoodDecoder, HugeValuesDoNotOverflow) {
  expect_huge_numbers_are_decoded(LikelihoodSetup("hamiltonian-k3", camera_with("paper-30x")));
}

TEST(LikelihoodDecoder, DeviationAgreesWithMonteCarloAtHighSignal) {
  Camera unequal = camera_with("paper-10f0");
  unequal.exposure_s.each_s = {0.01, 0.02, 0.05, 0.08, 0.14};
  for (const auto& [code, camera] : {std::pair{"sinusoid-k4", camera_with("paper-10f0")},
                                     {"hamiltonian-k4", camera_with("paper-10f0")},
                                     {"hamiltonian-k5", unequal},
                                     {"hamiltonian-k4", camera_with("paper-10f0", 2)}}) {
    const LikelihoodSetup setup(code, camera);
    for (const double truth_bin : {33.3, 121.7, 200.2})
      EXPECT_NEAR(estimates_at(setup, truth_bin, 1e6, 1e5).ratio(), 1.0, 4 * 0.0112)
          << code << " at " << truth_bin;
  }
}

}  // namespace

}  // namespace tofsmith
