// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/shared/actual_code.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "camera/frequency_lists.hpp"
#include "core/shared/random.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/camera/square_light.hpp"

namespace tofsmith {

namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

// Two-bucket sensors: every exposure is read out twice, d and 1 - d.

struct TwoBucketCase {
  std::string code;
  int exposures;
  int samples;
};

class TwoBuckets : public testing::TestWithParam<TwoBucketCase> {
 protected:
  Camera camera(const char* name) const {
    Camera camera = built_in_camera(name);
    camera.samples = GetParam().samples;
    camera.sensor.taps = 2;
    return camera;
  }
};

TEST_P(TwoBuckets, ExposuresShareTheTimeAndGiveTwoValuesEach) {
  const Camera camera = this->camera("paper-10f0");
  const CodeSet code = build_family(GetParam().code, camera);
  const ForwardModel model(code, camera);
  EXPECT_EQ(code.exposures(), GetParam().exposures);
  EXPECT_EQ(model.measurements(), 2 * GetParam().exposures);
  for (const double exposure_s : model.exposure_s())
    EXPECT_DOUBLE_EQ(exposure_s, camera.exposure_s.total_s / GetParam().exposures);
  // Every readout has its own read noise.
  for (const double variance : model.constant_variance_e2()) EXPECT_DOUBLE_EQ(variance, 400.0);
}

TEST_P(TwoBuckets, ABucketAndItsComplementContainAllLight) {
  for (const char* name : {"paper-30x", "paper-10f0", "paper-5f0"})
    for (const double contrast : {1.0, 0.6})
      for (const double dark : {0.0, 3e3}) {
        Camera camera = this->camera(name);
        camera.sensor.modulation_contrast = contrast;
        camera.sensor.dark_current_e_per_s = dark;
        const CodeSet code = build_family(GetParam().code, camera);
        const ForwardModel model(code, camera);
        const double S = 2e4, A = 3e3, T = camera.exposure_s.total_s / code.exposures();
        for (const double depth_bin : {0.0, 33.7, 0.71 * camera.samples}) {
          const Return r{S, depth_bin};
          const Eigen::VectorXd mean = model.expected_electrons({&r, 1}, A);
          const Eigen::VectorXd variance = model.variance_e2({&r, 1}, A);
          for (int e = 0; e < code.exposures(); ++e) {
            const double all_e = T * (S * code.modulation(e).mean() + A + 2 * dark);
            EXPECT_NEAR(mean[2 * e] + mean[2 * e + 1], all_e, 1e-9 * all_e);
            EXPECT_NEAR(variance[2 * e] + variance[2 * e + 1], all_e + 2 * 400.0, 1e-9 * all_e);
          }
        }
      }
}

TEST_P(TwoBuckets, TheSecondBucketIsOneMinusTheFirst) {
  const Camera camera = this->camera("paper-5f0");
  Camera one_tap = camera;
  one_tap.sensor.taps = 1;
  const Eigen::MatrixXd both =
      ForwardModel(build_family(GetParam().code, camera), camera).correlation_table(480);
  const Eigen::MatrixXd first =
      ForwardModel(build_family(GetParam().code, one_tap), one_tap).correlation_table(480);
  for (Eigen::Index e = 0; e < first.cols(); ++e) {
    EXPECT_LT((both.col(2 * e) - first.col(e)).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((both.col(2 * e + 1).array() - 1.0 + first.col(e).array()).abs().maxCoeff(), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Codes, TwoBuckets,
                         testing::Values(TwoBucketCase{"hamiltonian-k4", 4, 240},
                                         TwoBucketCase{"hamiltonian-k5", 5, 240},
                                         TwoBucketCase{"hamiltonian-k6", 6, 240},
                                         TwoBucketCase{"hamiltonian-k7", 7, 252},
                                         TwoBucketCase{"hamiltonian-k8", 8, 252},
                                         TwoBucketCase{"sinusoid-k4", 4, 240},
                                         TwoBucketCase{"multifrequency-1x4-7x4", 8, 240},
                                         TwoBucketCase{"pulsed-multifrequency-k4", 4, 240}),
                         [](const auto& info) {
                           std::string name = info.param.code;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(TwoBucketFamilies, BuildALongWalkOnFewSamples) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  EXPECT_EQ(build_family("hamiltonian-k7", camera).samples(), camera.samples);
}

// Outputs of generators and light sources, and imperfect taps.

constexpr double frequency_hz = 15e6;

ImpulseResponse response_of(ImpulseResponse::Kind kind) {
  ImpulseResponse response;
  response.kind = kind;
  response.f_max_hz = response.cutoff_hz = 10 * frequency_hz;
  return response;
}

TEST(ArmOutput, KeepsTheMean) {
  using Kind = ImpulseResponse::Kind;
  const Waveform waveform = Waveform::binary({{0.1, 0.23}, {0.5, 0.77}}, 2.0);
  for (const Kind kind : {Kind::none, Kind::hann, Kind::gaussian, Kind::lowpass})
    for (const int points : {48, 101}) {
      const Eigen::VectorXd actual = arm_output(waveform, response_of(kind), frequency_hz, points);
      ASSERT_EQ(actual.size(), points);
      EXPECT_NEAR(actual.mean(), waveform.mean(), 1e-12) << name_of(kind);
    }
}

TEST(ArmOutput, WithoutResponseEqualsTheCellAverages) {
  const Waveform waveform = rectangular_pulse(0.3, 0.9);
  EXPECT_EQ(arm_output(waveform, {}, frequency_hz, 64), waveform.cell_averages(64));
}

TEST(ArmOutput, IsTheConvolutionWithTheWindow) {
  // Integral of a Hann window of width W, centred on zero, over the part that overlaps the pulse.
  // From -W/2 to x it is 1/2 + x/W + sin(2 pi x / W) / (2 pi).
  const double width = 1.444010597686313 / 10;  // periods
  const auto integral = [&](double x) {
    if (x <= -width / 2) return 0.0;
    if (x >= width / 2) return 1.0;
    return 0.5 + x / width + std::sin(2 * std::numbers::pi * x / width) / (2 * std::numbers::pi);
  };
  const double begin = 0.3, end = 0.52;
  const Eigen::VectorXd actual =
      arm_output(Waveform::binary({{begin, end}}), response_of(ImpulseResponse::Kind::hann),
                 frequency_hz, 480);
  for (int j = 0; j < 480; ++j) {
    const double t = j / 480.0;
    EXPECT_NEAR(actual[j], integral(t - begin) - integral(t - end), 1e-4) << t;
  }
}

TEST(ArmOutput, OfALowPassIsDelayed) {
  // x(t) = 1 - exp(-2 pi f_c t); the response to the previous pulse has decayed by then.
  const double rate = 2 * std::numbers::pi * 10;
  const Eigen::VectorXd actual =
      arm_output(Waveform::binary({{0.25, 0.75}}), response_of(ImpulseResponse::Kind::lowpass),
                 frequency_hz, 1000);
  for (const int j : {100, 200, 300, 400, 600, 700})
    EXPECT_NEAR(actual[j], j < 250 ? 0.0 : 1 - std::exp(-rate * (j / 1000.0 - 0.25)), 2e-3) << j;
}

using std::numbers::pi;

Camera camera_with_jitter(double light_s, double sensor_s) {
  Camera camera = built_in_camera("paper-30x");
  camera.samples = 60;
  camera.light.edge_jitter_s = light_s;
  camera.sensor.edge_jitter_s = sensor_s;
  return camera;
}

TEST(EdgeJitter, AttenuatesEveryHarmonicInClosedForm) {
  for (const char* name : {"paper-30x", "paper-10f0"}) {
    Camera camera = built_in_camera(name);
    const Eigen::VectorXcd plain = camera.transfer(40);
    camera.light.edge_jitter_s = 80e-12;
    camera.sensor.edge_jitter_s = 50e-12;
    const Eigen::VectorXcd blurred = camera.transfer(40);
    for (int n = 0; n <= 40; ++n) {
      const double w = 2 * pi * n * 15e6;
      const double blur = std::exp(-w * w * (80e-12 * 80e-12 + 50e-12 * 50e-12) / 2);
      EXPECT_NEAR(std::abs(blurred[n] - blur * plain[n]), 0.0, 1e-14) << name << " " << n;
    }
  }
}

TEST(EdgeJitter, EqualsTheMeanOverDisplacedEdges) {
  // Correlates a pulse with a gate whose edges are displaced independently in each period.
  const Camera camera = camera_with_jitter(1e-9, 0.5e-9);
  const double f0 = camera.fundamental_frequency_hz;
  const CodeSet code =
      CodeSet::create("one", 60, 1, {3, rectangular_pulse(0.2, 0.1)}, {3, square_wave(1, 0.2)});
  const ForwardModel model(code, camera);
  ForwardModel still(code, camera_with_jitter(0.0, 0.0));
  RandomStream random(4, 0);
  constexpr int periods = 3000;
  for (const double depth_bin : {6.0, 11.3, 40.0}) {
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < periods; ++i) {
      const auto moved = [&](double edge, double rms_s) {
        return edge + rms_s * f0 * random.normal();
      };
      const Waveform light = Waveform::binary({{moved(0.1, 1e-9), moved(0.3, 1e-9)}}, 5.0);
      const Waveform gate = Waveform::binary({{moved(0.2, 0.5e-9), moved(0.7, 0.5e-9)}});
      const double chi = CorrelationFunction(gate, light)(depth_bin / 60);
      sum += chi;
      squares += chi * chi;
    }
    const double mean = sum / periods;
    const double se = std::sqrt((squares / periods - mean * mean) / periods);
    EXPECT_NEAR(model.correlation(depth_bin)[0], mean, 4 * se + 1e-6) << depth_bin;
  }
  EXPECT_GT(std::abs(model.correlation(6.0)[0] - still.correlation(6.0)[0]), 1e-4);
}

TEST(EdgeJitter, LimitsTheBandOfItsArm) {
  EXPECT_FALSE(built_in_camera("paper-30x").band_limited());
  EXPECT_TRUE(camera_with_jitter(0.0, 1e-12).band_limited());
  EXPECT_FALSE(camera_with_jitter(0.0, 1e-12).light_is_band_limited());
}

TEST(TapMismatch, ScalesSignalAndAmbientOfNeighbours) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.dark_current_e_per_s = 100.0;
  for (const int taps : {1, 2}) {
    camera.sensor.taps = taps;
    camera.sensor.tap_mismatch = 0.0;
    const CodeSet code = build_family("hamiltonian-k3", camera);
    const ForwardModel even(code, camera);
    camera.sensor.tap_mismatch = 0.02;
    const ForwardModel uneven(code, camera);
    for (int i = 0; i < code.measurements(); ++i) {
      const double gain = i % 2 == 0 ? 1.01 : 0.99;
      EXPECT_NEAR(uneven.correlation(17.3)[i], gain * even.correlation(17.3)[i], 1e-15);
      EXPECT_NEAR(uneven.correlation_table(30)(7, i), gain * even.correlation_table(30)(7, i),
                  1e-15);
      EXPECT_NEAR(uneven.ambient_gain()[i], gain * even.ambient_gain()[i], 1e-15);
    }
    EXPECT_EQ(uneven.dark_electrons(), even.dark_electrons());
  }
}

TEST(ImperfectArms, RejectInvalidValues) {
  Camera camera = built_in_camera("paper-10f0");
  camera.light.edge_jitter_s = -1e-12;
  EXPECT_THROW(camera.validate(), std::invalid_argument);
  camera.light.edge_jitter_s = NAN;
  EXPECT_THROW(camera.validate(), std::invalid_argument);
  camera.light.edge_jitter_s = 0.0;
  for (const double mismatch : {-1.0, 1.0, static_cast<double>(NAN)}) {
    camera.sensor.tap_mismatch = mismatch;
    EXPECT_THROW(camera.validate(), std::invalid_argument);
  }
}

// Frequencies of square light.

auto rejects(const char* key, const char* reason) {
  return ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(key), HasSubstr(reason)));
}

TEST(CommonFrequency, IsTheGreatestCommonDivisor) {
  const auto common_hz = [](std::vector<double> list) {
    return common_frequency_hz(list).value_or(0.0);
  };
  EXPECT_NEAR(common_hz({16e6, 80e6, 120e6}), 8e6, 1e-3);
  EXPECT_NEAR(common_hz({240e6 / 7, 240e6 / 11}), 240e6 / 77, 1.0);
  EXPECT_NEAR(common_hz({20e6, 20000010.0}), 10.0, 1e-3);
  EXPECT_EQ(common_hz({20e6, 20000003.0}), 0.0);
  EXPECT_EQ(common_hz({20e6, 20e6 * 1.41421356237}), 0.0);
}

TEST(SquareLight, DividesItsClock) {
  const SquareLight square{.clock_hz = 96e6, .dividers = std::vector{4, 8, 6}};
  EXPECT_EQ(square.modulation_frequencies_hz(), (std::vector{12e6, 16e6, 24e6}));
  EXPECT_NO_THROW(square.validate());
}

TEST(SquareLight, NamesTheKeyThatBreaksARule) {
  const auto validates = [](SquareLight square) { return [square] { square.validate(); }; };
  EXPECT_THAT(validates({}), rejects("light.frequencies_hz = none", "light.clock_hz"));
  EXPECT_THAT(validates({.frequencies_hz = std::vector{2e7, 8e7, 2e7}}),
              rejects("light.frequencies_hz = 2", "listed once"));
  EXPECT_THAT(validates({.frequencies_hz = std::vector{2e7, 8e7}, .clock_hz = 6e7}),
              rejects("light.frequencies_hz = 8", "at most light.clock_hz"));
  EXPECT_THAT(validates({.frequencies_hz = std::vector{2e7, 80000003.0}}),
              rejects("light.frequencies_hz", "common divisor of at least 10 Hz"));
  EXPECT_THAT(validates({.dividers = std::vector{2, 3}}),
              rejects("light.dividers", "requires light.clock_hz"));
  EXPECT_THAT(validates({.clock_hz = 1e8, .dividers = std::vector{2, 2}}),
              rejects("light.dividers = 2", "listed once"));
  EXPECT_THAT(
      validates({.frequencies_hz = std::vector{2e7}, .clock_hz = 1e8, .dividers = std::vector{2}}),
      rejects("light.dividers = [2]", "together with light.frequencies_hz"));
  EXPECT_THAT(validates({.duty_range = {{0.5, 0.2}}, .frequencies_hz = std::vector{2e7}}),
              rejects("light.duty_range", "smallest < largest"));
}

}  // namespace

}  // namespace tofsmith
