// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/bounds.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/shared/random.hpp"
#include "rows_setup.hpp"
#include "simulate/shared/camera_bounds.hpp"
#include "simulate/ziv_zakai.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

namespace {

using std::numbers::pi;

CramerRaoBound bound_of(const CodeSet& code, const Camera& camera,
                        NoiseInformation information = NoiseInformation::mean) {
  return {ForwardModel(code, camera), camera, information};
}

/// Like a Cramer-Rao bound, this ignores confusion of depths.
double by_information_m(const ReceiverBound& bound, const Camera& camera,
                        const OperatingPoint& point) {
  return camera.range_m() * std::sqrt(2 / pi / bound.information(point));
}

TEST(CramerRaoBound, MatchesAnInverseOfTheFisherMatrix) {
  struct Case {
    Camera camera;
    const char* code;
    OperatingPoint point;
    int step;
    double tolerance;
  };
  Camera taps = built_in_camera("paper-10f0"), rows = rows_camera();
  taps.sensor.dark_current_e_per_s = 300.0;
  rows.sensor.read_noise_e = 2.0;
  for (const Case& its : {Case{taps, "hamiltonian-k5", {2e4, 3e3}, 61, 1e-3},
                          Case{rows, "histogram-k6", {2e3, 5e2}, 29, 5e-3}}) {
    const ForwardModel model(build_family(its.code, its.camera), its.camera);
    const auto& [signal, ambient] = its.point;
    const Eigen::VectorXd sigma_m = CramerRaoBound(model, its.camera).sigma_m(its.point);
    ASSERT_EQ(sigma_m.size(), 4 * model.samples());
    for (int j = 3; j < sigma_m.size(); j += its.step) {
      const double z = (j + 0.5) / 4, h = 1e-3;
      const Return seen{signal, z};
      Eigen::MatrixXd jacobian(model.measurements(), 3);
      jacobian << signal * (model.correlation(z + h) - model.correlation(z - h)) / (2 * h),
          model.correlation(z), model.ambient_gain();
      jacobian = model.exposure_s().asDiagonal() * jacobian;
      const Eigen::Matrix3d fisher =
          jacobian.transpose() * model.covariance_e2({&seen, 1}, ambient).inverse() * jacobian;
      const double expected_m = std::sqrt(fisher.inverse()(0, 0)) * its.camera.bin_m();
      EXPECT_NEAR(sigma_m[j] / expected_m, 1.0, its.tolerance) << its.code << ", " << j;
    }
  }
}

TEST(CramerRaoBound, VarianceAddsLittleInformation) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const double mean = bound_of(code, camera).mae_m({1e4, 1e4});
  const double both = bound_of(code, camera, NoiseInformation::mean_and_variance).mae_m({1e4, 1e4});
  EXPECT_LE(both, mean * (1 + 1e-12));
  EXPECT_GT(both, 0.99 * mean);
}

TEST(CramerRaoBound, AllowsMeasurementsWithoutAmbientLight) {
  // Ambient light cancels in differences of buckets: its column of the Fisher matrix is zero.
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  const CodeSet code = build_family("hamiltonian-k3", camera);
  const double separate = bound_of(code, camera).mae_m({1e4, 1e4});
  camera.sensor.readout = Readout::difference;
  const double difference = bound_of(code, camera).mae_m({1e4, 1e4});
  EXPECT_TRUE(std::isfinite(difference));
  EXPECT_GE(difference, separate * (1 - 1e-9));
  EXPECT_LT(difference, 1.2 * separate);
}

TEST(CramerRaoBound, IsInfiniteWhereMeasurementsDoNotDependOnDepth) {
  const Camera camera = built_in_camera("paper-30x");
  // With one narrow pulse and gates open half of the time, measurements only change near the edges.
  const CodeSet code =
      CodeSet::create("dead zones", 240, 1, {3, rectangular_pulse(1.0 / 30)},
                      {square_wave(1, 0.0), square_wave(1, 1.0 / 3), square_wave(1, 2.0 / 3)});
  EXPECT_TRUE(std::isinf(bound_of(code, camera).mae_m({1e5, 1e3})));
}

TEST(CramerRaoBound, UniformAlbedoIncreasesTheBoundButKeepsItFinite) {
  const Camera camera = built_in_camera("paper-10f0");
  const CramerRaoBound bound = bound_of(build_family("hamiltonian-k4", camera), camera);
  const OperatingPoint point{1e5, 1e3};
  EXPECT_GT(bound.mae_uniform_albedo_m(point), bound.mae_m(point));
  EXPECT_LT(bound.mae_uniform_albedo_m(point), camera.range_m() / 4);
  double sum = 0.0;
  for (int i = 0; i < 400; ++i)
    sum += std::min(camera.range_m() / 4, bound.mae_m({(i + 0.5) / 400 * 1e5, 1e3}));
  EXPECT_NEAR(bound.mae_uniform_albedo_m(point) / (sum / 400), 1.0, 0.02);
}

TEST(ReceiverBound, IsTheClosedFormForOneTap) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.impulse_response = {};
  camera.light.impulse_response = {.kind = ImpulseResponse::Kind::gaussian, .cutoff_hz = 45e6};
  camera.light.peak_factor = 4.0;
  const double S = 3e3, A = 2e4, T = 0.3;
  double v = 0.0;
  for (int n = 1; n < 40; ++n)
    v = std::max(v, std::pow(2 * pi * n * 4 / pi * std::sin(pi / 4), 2) *
                        std::pow(0.5, std::pow(n / 3.0, 2)));
  double gated = 0.0;
  for (int i = 1; i < 100000; ++i)
    gated = std::max(gated, i * 1e-5 * (1 - i * 1e-5) / (4 * 400.0 + T * A * i * 1e-5));
  const ReceiverBound bound(camera, 4);
  EXPECT_NEAR(bound.tap_information({S, A}) / (v * S * S * T * T * gated), 1.0, 1e-6);
}

TEST(ReceiverBound, OfPhotonsEqualsThatOfTheBestGate) {
  // With photon noise only, a Gaussian response of deviation s has information 1 / s^2 per photon.
  // A gate that passes the fraction Q(x) retains phi(x)^2 / Q(x) of it, at most 0.405.
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.impulse_response = {};
  camera.sensor.read_noise_e = 0.0;
  camera.light.impulse_response = {.kind = ImpulseResponse::Kind::gaussian, .cutoff_hz = 150e6};
  const double deviation = std::sqrt(std::log(2.0)) / (2 * pi * 10.0);  // periods; |H(fc)|^2 = 1/2
  double kept = 0.0;
  for (double x = -3.0; x < 3.0; x += 1e-3)
    kept = std::max(kept, std::exp(-x * x) / (pi * std::erfc(x / std::sqrt(2.0))));
  const double per_photon = deviation * deviation / (1e4 * 0.3);
  EXPECT_NEAR(ReceiverBound(camera, 3).photon_information({1e4, 0.0}) * per_photon / kept, 1.0,
              1e-3);
  camera.sensor.taps = 8;
  EXPECT_NEAR(ReceiverBound(camera, 3).photon_information({1e4, 0.0}) * per_photon, 1.0, 1e-3)
      << "eight taps know when photons came";
}

TEST(ReceiverBound, IsZeroWithoutImpulseResponses) {
  EXPECT_EQ(ReceiverBound(built_in_camera("paper-30x"), 4).mae_m({1e4, 1e4}), 0.0);
}

TEST(ReceiverBound, LightOfPeakFactorOneMayStillBlink) {
  // With peak factor 1, the largest harmonic needs only half of the mean power.
  Camera camera = built_in_camera("paper-5f0");
  camera.light.peak_factor = 1.0;
  std::vector<Waveform> gates;
  for (int k = 0; k < 3; ++k) gates.push_back(square_wave(1, k / 3.0));
  const CodeSet code =
      CodeSet::create("blinking", camera.samples, 1, {3, square_wave(1, 0.0)}, gates);
  const OperatingPoint point{1e4, 1e5};
  EXPECT_LE(by_information_m(ReceiverBound(camera, 3), camera, point),
            bound_of(code, camera).mae_m(point));
}

TEST(ReceiverBound, OfUniformAlbedoIsTheMeanOverIt) {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 60;
  camera.operating.signal_e_per_s = {1e3, 1e5};
  camera.operating.ambient_e_per_s = {1e2, 1e5};
  camera.sensor.taps = 2;
  camera.sensor.readout = Readout::difference;
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const ReceiverBound of_camera(camera, 4);
  for (const OperatingPoint& point : camera.operating.points()) {
    double sum_m = 0.0;
    for (int i = 0; i < 200; ++i) {
      const double root = (i + 0.5) / 200;
      sum_m +=
          2 * root * of_camera.mae_m({root * root * point.signal_e_per_s, point.ambient_e_per_s});
    }
    EXPECT_NEAR(of_camera.mae_uniform_albedo_m(point) / (sum_m / 200), 1.0, 0.01);
  }
  camera.operating.uniform_albedo = true;
  for (const PointDepthError& error : evaluate(code, camera, {.trials = 2000}).points)
    EXPECT_GE(error.circular_mde_m.value + 4 * error.circular_mde_m.standard_error,
              error.receiver_bound_mae_m);
}

TEST(CameraBounds, EqualThoseOfEachCode) {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 60;
  camera.operating.signal_e_per_s = {1e3, 1e5};
  camera.operating.ambient_e_per_s = {1e2, 1e5};
  for (const bool uniform_albedo : {false, true}) {
    camera.operating.uniform_albedo = uniform_albedo;
    camera.operating.neighbours = 3.0;
    CameraBounds shared(camera);
    for (const char* name : {"hamiltonian-k4", "sinusoid-k3", "sinusoid-k4"}) {
      const CodeSet code = build_family(name, camera);
      const DepthErrorReport alone = evaluate(code, camera, {.trials = 100});
      const DepthErrorReport together = evaluate(code, camera, {.trials = 100}, shared, {});
      for (std::size_t i = 0; i < alone.points.size(); ++i) {
        EXPECT_GT(alone.points[i].receiver_bound_mae_m, 0.0);
        EXPECT_EQ(alone.points[i].receiver_bound_mae_m, together.points[i].receiver_bound_mae_m);
        EXPECT_EQ(alone.points[i].direct_tof_bound_mae_m,
                  together.points[i].direct_tof_bound_mae_m);
        EXPECT_EQ(alone.points[i].circular_mde_m.value, together.points[i].circular_mde_m.value);
      }
    }
  }
}

TEST(ReceiverBound, IsAQuarterOfTheRangeWithoutLightAndFollowsInformationInBrightLight) {
  const Camera camera = built_in_camera("paper-10f0");
  const ReceiverBound bound(camera, 4);
  EXPECT_DOUBLE_EQ(bound.mae_m({0.0, 1e4}), camera.range_m() / 4);
  EXPECT_NEAR(bound.mae_m({1e-3, 1e4}), camera.range_m() / 4, 1e-3 * camera.range_m());
  for (const double read_noise_e : {20.0, 2000.0}) {
    Camera noisy = camera;
    noisy.sensor.read_noise_e = read_noise_e;
    const ReceiverBound of_noisy(noisy, 4);
    const OperatingPoint bright{1e7, 0.0};
    EXPECT_NEAR(of_noisy.mae_m(bright) / by_information_m(of_noisy, noisy, bright), 1.0, 0.02);
  }
  for (double signal_e_per_s = 1e2; signal_e_per_s < 1e6; signal_e_per_s *= 3)
    EXPECT_LT(bound.mae_m({2 * signal_e_per_s, 1e4}), bound.mae_m({signal_e_per_s, 1e4}));
  const OperatingPoint dim{1e3, 1e5};
  EXPECT_GT(bound.mae_m(dim), 1.5 * by_information_m(bound, camera, dim));
}

TEST(ReceiverBound, ADrainCanOnlyReduceIt) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  const OperatingPoint point{1e3, 1e7};
  const double with_drain = ReceiverBound(camera, 4).tap_information(point);
  camera.sensor.drain = false;
  const double without = ReceiverBound(camera, 4).tap_information(point);
  EXPECT_GT(with_drain, without * 1.5);
}

/// Integrates over shifts for given weights of the harmonics, by brute force.
double confusion_of(const Eigen::VectorXd& power, const Eigen::VectorXd& shares) {
  constexpr int cells = 20000;
  double sum = 0.0;
  for (int j = 0; j < cells; ++j) {
    const double h = 0.5 * (j + 0.5) / cells;
    double squared = 0.0;
    for (Eigen::Index n = 0; n < power.size(); ++n)
      squared +=
          shares[n] * power[n] * std::pow(2 * std::sin(pi * static_cast<double>(n + 1) * h), 2);
    sum += 0.5 * std::erfc(std::sqrt(squared / 8.0));
  }
  return 0.5 * sum / cells;
}

TEST(ZivZakai, IsAQuarterWithoutSignalAndTheDeviationWithMuch) {
  EXPECT_EQ(ziv_zakai_mae(Eigen::VectorXd(), 0.0), 0.25);
  EXPECT_EQ(ziv_zakai_mae(Eigen::VectorXd::Zero(5), infinity), 0.25);
  EXPECT_NEAR(ziv_zakai_mae(Eigen::VectorXd::Constant(3, 1e-9), infinity), 0.25, 1e-4);
  for (const double power : {1e4, 1e8}) {
    const double sigma = 1.0 / (2 * pi * std::sqrt(power));
    EXPECT_NEAR(ziv_zakai_mae(Eigen::VectorXd::Constant(1, power), infinity) / sigma,
                std::sqrt(2 / pi), 0.005);
  }
}

TEST(ZivZakai, OfInformationAloneIsTheDeviationUpToAQuarter) {
  for (const double information : {1e3, 1e9})
    EXPECT_NEAR(ziv_zakai_mae(Eigen::VectorXd(), information) * std::sqrt(information),
                std::sqrt(2 / pi), 0.002);
  EXPECT_NEAR(ziv_zakai_mae(Eigen::VectorXd(), 1e-6), 0.25, 1e-3);
  EXPECT_EQ(ziv_zakai_mae(Eigen::VectorXd(), infinity), 0.0);
  const Eigen::VectorXd tone = Eigen::VectorXd::Constant(1, 1e6);
  EXPECT_NEAR(ziv_zakai_mae(tone, 1e3) * std::sqrt(1e3), std::sqrt(2 / pi), 0.005)
      << "the smaller of both counts";
}

TEST(ZivZakai, OfOneToneEqualsTheIntegral) {
  for (const double power : {0.1, 1.0, 30.0}) {
    const Eigen::VectorXd one = Eigen::VectorXd::Constant(1, power);
    EXPECT_NEAR(ziv_zakai_mae(one, infinity) / confusion_of(one, Eigen::VectorXd::Ones(1)), 1.0,
                2e-3);
  }
}

TEST(ZivZakai, NoPhaseEstimateBeatsItAndTheBestComesNear) {
  // (cos, sin) of the phase times an amplitude, in unit noise.
  for (const double amplitude : {0.0, 0.3, 1.0, 2.0, 4.0, 10.0}) {
    RandomStream random(5, static_cast<std::uint64_t>(10 * amplitude));
    RunningStatistics error;
    for (int trial = 0; trial < 40000; ++trial) {
      const double turn = 2 * pi * random.uniform();
      const double x = amplitude * std::cos(turn) + random.normal();
      const double y = amplitude * std::sin(turn) + random.normal();
      const double off = std::remainder(std::atan2(y, x) - turn, 2 * pi) / (2 * pi);
      error.add(std::abs(off));
    }
    const double bound =
        ziv_zakai_mae(Eigen::VectorXd::Constant(1, amplitude * amplitude), infinity);
    EXPECT_GE(error.mean() + 4 * error.standard_error(), bound) << amplitude;
    EXPECT_LE(error.mean(), 1.12 * bound) << amplitude;
  }
}

TEST(ZivZakai, IsALowerLimitForAnySharesOfHarmonics) {
  for (std::uint64_t item = 0; item < 6; ++item) {
    RandomStream random(6, item);
    Eigen::VectorXd power(2 + static_cast<int>(6 * random.uniform()));
    const double scale = std::pow(10.0, -1 + 5 * random.uniform());
    for (double& p : power) p = scale * random.uniform();
    const double bound = ziv_zakai_mae(power, infinity);
    double least = 1.0;
    for (int i = 0; i < 40; ++i) {
      Eigen::VectorXd shares(power.size());
      for (double& w : shares) w = std::pow(random.uniform(), 3);
      shares /= shares.sum();
      least = std::min(least, confusion_of(power, shares));
    }
    EXPECT_LT(bound, least * (1 + 1e-3)) << item;
    EXPECT_GT(bound, 0.5 * least) << item;
  }
}

TEST(ZivZakai, MorePowerNeverRaisesItAndManyHarmonicsAreGrouped) {
  Eigen::VectorXd few = Eigen::VectorXd::Constant(90, 3.0);
  Eigen::VectorXd many = Eigen::VectorXd::Constant(400, 3.0);
  EXPECT_LE(ziv_zakai_mae(many, infinity), ziv_zakai_mae(few, infinity) * 1.003);
  EXPECT_GT(ziv_zakai_mae(many, infinity), 0.0);
  EXPECT_LT(ziv_zakai_mae(2.0 * few, infinity), ziv_zakai_mae(few, infinity));
}

}  // namespace

}  // namespace tofsmith
