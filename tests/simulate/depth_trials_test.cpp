// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/depth_trials.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <tuple>

#include "each_target.hpp"
#include "simulate/pixel_capture.hpp"
#include "simulate/pixel_trials.hpp"
#include "simulate/trial_kernel.hpp"

namespace tofsmith {

namespace {

Camera camera_at(double signal_e_per_s, double ambient_e_per_s, int taps = 1,
                 const char* name = "paper-10f0") {
  Camera camera = built_in_camera(name);
  camera.sensor.taps = taps;
  camera.sensor.noise = NoiseModel::gaussian;
  camera.operating.signal_e_per_s = {signal_e_per_s};
  camera.operating.ambient_e_per_s = {ambient_e_per_s};
  return camera;
}

double joint(const Estimate& a, const Estimate& b) {
  return std::hypot(a.standard_error, b.standard_error);
}

struct Positions {
  std::vector<double> truth, found;
};
Positions positions_of(const DepthTrials& trials, std::int64_t of, std::int64_t count,
                       int at_once) {
  const auto tile = std::make_unique<TrialTile>();
  Positions positions;
  for (std::int64_t first = 0; first < count; first += at_once) {
    const TrialBlock block =
        trials.run({0, 0, of}, {first, std::min<std::int64_t>(count, first + at_once)}, *tile);
    positions.truth.insert(positions.truth.end(), block.true_bin.begin(), block.true_bin.end());
    positions.found.insert(positions.found.end(), block.decoded_bin.begin(),
                           block.decoded_bin.end());
  }
  return positions;
}

TEST(DepthTrials, ATrialDependsOnlyOnItsNumber) {
  for (const bool is_poisson : {false, true}) {
    Camera camera = camera_at(1e4, 1e4);
    if (is_poisson) camera.sensor.noise = NoiseModel::poisson;
    const ForwardModel model(build_family("hamiltonian-k4", camera), camera);
    const DepthTrials trials(model, camera, {.trials = 1000});
    EXPECT_EQ(trials.draws_in_plane(), !is_poisson);
    const Positions whole = positions_of(trials, 1000, 1000, trials_per_tile);
    for (const int at_once : {2, 30, 128}) {
      const Positions parts = positions_of(trials, 1000, 400, at_once);
      for (std::size_t i = 0; i < parts.truth.size(); ++i) {
        ASSERT_EQ(parts.truth[i], whole.truth[i]) << at_once << " at once, trial " << i;
        ASSERT_EQ(parts.found[i], whole.found[i]) << at_once << " at once, trial " << i;
      }
    }
  }
}

TEST(DepthTrials, EverySliceHasOneDepth) {
  const Camera camera = camera_at(1e4, 1e4);
  const ForwardModel model(build_family("sinusoid-k4", camera), camera);
  for_each_target([&] {
    const Positions positions =
        positions_of(DepthTrials(model, camera, {.trials = 3000}), 3000, 3000, trials_per_tile);
    RunningStatistics within;
    for (std::size_t t = 0; t < positions.truth.size(); ++t) {
      const double slice = positions.truth[t] / camera.samples * 3000 - static_cast<double>(t);
      EXPECT_GE(slice, 0.0);
      EXPECT_LT(slice, 1.0);
      within.add(slice);
    }
    EXPECT_NEAR(within.mean(), 0.5, 4 * within.standard_error());
    EXPECT_NEAR(within.variance(), 1.0 / 12, 0.01);
  });
}

TEST(DepthTrials, ProjectedNoiseGivesTheErrorsOfNoisePerMeasurement) {
  // The last code has more dimensions than the specialized kernels.
  for (const auto& [name, taps, samples] :
       {std::tuple("hamiltonian-k3", 1, 240), std::tuple("hamiltonian-k5", 1, 240),
        std::tuple("pulsed-multifrequency-k5", 1, 240), std::tuple("hamiltonian-k4", 2, 240),
        std::tuple("hamiltonian-k8", 1, 252)})
    for (const Readout readout : {Readout::separate, Readout::difference}) {
      if (readout == Readout::difference && taps == 1) continue;
      for (const double signal : {2e3, 3e4}) {
        Camera camera = camera_at(signal, 1e3, taps);
        camera.samples = samples;
        camera.sensor.readout = readout;
        camera.sensor.tap_mismatch = 0.02;
        const CodeSet code = build_family(name, camera);
        const PointDepthError plane = evaluate(code, camera, {.trials = 40000}).points[0];
        const PointDepthError measured =
            evaluate(code, camera, {.trials = 40000, .seed = 2, .draw_every_measurement = true})
                .points[0];
        const auto expect_same = [&](const Estimate& a, const Estimate& b) {
          EXPECT_NEAR(a.value, b.value, 4 * joint(a, b) + 1e-12) << name << " at " << signal;
        };
        expect_same(plane.linear_mde_m, measured.linear_mde_m);
        expect_same(plane.circular_mde_m, measured.circular_mde_m);
        expect_same(plane.outlier_rate, measured.outlier_rate);
      }
    }
}

TEST(DepthTrials, PoissonAndNormalNoiseAgreeInBrightLight) {
  Camera camera = camera_at(1e4, 3e4);
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const Estimate normal = evaluate(code, camera).points[0].circular_mde_m;
  camera.sensor.noise = NoiseModel::poisson;
  const Estimate poisson = evaluate(code, camera, {.seed = 2}).points[0].circular_mde_m;
  EXPECT_NEAR(poisson.value, normal.value, 4 * joint(poisson, normal));
}

TEST(DepthTrials, ClipsAndQuantizesLikePixelNoise) {
  for (const Readout readout : {Readout::separate, Readout::difference}) {
    Camera camera = camera_at(1e4, 1e4, 2);
    camera.sensor.readout = readout;
    camera.sensor.full_well_e = 900.0;
    camera.sensor.adc_bits = 10;
    camera.sensor.gain_e_per_dn = 1.5;
    camera.sensor.black_level_dn = 64.0;
    const ForwardModel model(build_family("hamiltonian-k3", camera), camera);
    const TrialModel trial_model(model, camera);
    const PixelNoise noise(camera.sensor);
    const auto tile = std::make_unique<TrialTile>();
    for (int k = 0; k < trial_model.taps(); ++k)
      for (int i = 0; i < trials_per_tile; ++i) {
        tile->taps[k * trials_per_tile + i] = static_cast<float>(5 * i + k);
        tile->normals[k * trials_per_tile + i] = static_cast<float>(i % 7 - 3);
      }
    std::vector<std::vector<double>> raw(trials_per_tile);
    for (std::size_t i = 0; i < raw.size(); ++i) {
      for (int k = 0; k < trial_model.taps(); ++k) {
        const double e = 5.0 * static_cast<double>(i) + k;
        raw[i].push_back(
            noise.convert(e + std::sqrt(e + 400.0) * (static_cast<double>(i % 7) - 3)));
      }
      noise.read_out(raw[i].data(), trial_model.taps());
    }
    read_out_taps(trial_model, {}, trials_per_tile, *tile);
    for (int k = 0; k < trial_model.measurements(); ++k)
      for (std::size_t i = 0; i < raw.size(); ++i)
        EXPECT_NEAR(tile->taps[static_cast<std::size_t>(k * trials_per_tile) + i],
                    raw[i][static_cast<std::size_t>(k)], readout == Readout::separate ? 1.0 : 2.0);
  }
}

TEST(AdaptiveTrials, MeetTheTargetOrReportFailure) {
  Camera camera = camera_at(1e4, 1e3);
  camera.operating.signal_e_per_s = {1e3, 1e4};
  const CodeSet code = build_family("hamiltonian-k4", camera);
  for (const DepthErrorKind kind : {DepthErrorKind::linear, DepthErrorKind::circular}) {
    camera.operating.error = kind;
    const DepthErrorReport report =
        evaluate(code, camera, {.trials = 2000, .target_standard_error = 0.03});
    EXPECT_EQ(report.points_short_of_target, 0);
    for (const PointDepthError& point : report.points) {
      const Estimate& error =
          kind == DepthErrorKind::linear ? point.linear_mde_m : point.circular_mde_m;
      EXPECT_LE(error.standard_error, 0.03 * error.value);
      EXPECT_LE(point.trials, report.trials);
    }
    EXPECT_GT(report.trials, 2000);
  }
  const DepthErrorReport capped =
      evaluate(code, camera, {.trials = 2000, .target_standard_error = 1e-4, .max_trials = 5000});
  EXPECT_EQ(capped.points_short_of_target, 2);
  for (const PointDepthError& point : capped.points) EXPECT_EQ(point.trials, 5000);
}

TEST(RootMeanSquare, EqualsThatOfPlainSquares) {
  for (const std::int64_t count : {1000, 1022}) {
    const Camera camera = camera_at(2e3, 1e3);
    const ForwardModel model(build_family("hamiltonian-k4", camera), camera);
    for_each_target([&] {
      const DepthTrials trials(model, camera, {.trials = count});
      const ErrorSums sums = sum_errors(trials, trials.first_rounds(), 3.0, {}).front();
      const Positions positions = positions_of(trials, count, count, trials_per_tile);
      double linear = 0.0, circular = 0.0, linear_scatter = 0.0, circular_scatter = 0.0;
      for (std::size_t t = 0; t < positions.truth.size(); t += 2) {
        double squares[2][2];
        for (std::size_t i = 0; i < 2; ++i) {
          const double error = std::abs(positions.found[t + i] - positions.truth[t + i]);
          squares[0][i] = error * error;
          squares[1][i] = std::pow(std::min(error, camera.samples - error), 2);
        }
        linear += squares[0][0] + squares[0][1];
        circular += squares[1][0] + squares[1][1];
        linear_scatter += std::pow(squares[0][0] - squares[0][1], 2);
        circular_scatter += std::pow(squares[1][0] - squares[1][1], 2);
      }
      const auto n = static_cast<double>(count);
      const auto expect = [n](const Estimate& found, double sum, double scatter) {
        const double root = std::sqrt(sum / n);
        EXPECT_NEAR(found.value, 2.0 * root, 1e-9 * root);
        EXPECT_NEAR(found.standard_error, std::sqrt(scatter) / n / root, 1e-9 * root);
      };
      expect(sums.linear_rms(2.0), linear, linear_scatter);
      expect(sums.circular_rms(2.0), circular, circular_scatter);
    });
  }
}

TEST(RootMeanSquare, OfNormalErrorsIsTheRootOfHalfPiTimesTheMean) {
  const Camera camera = camera_at(1e5, 1e2);
  const PointDepthError error =
      evaluate(build_family("sinusoid-k4", camera), camera, {.trials = 40000}).points[0];
  // The deviation varies with depth by a few percent, which raises the ratio to second order only.
  EXPECT_NEAR(error.circular_rmse_m.value / error.circular_mde_m.value,
              std::sqrt(std::numbers::pi / 2), 0.02);
}

TEST(DepthTrials, StandardErrorsAreTheSpreadOverSeedsAndDepthsAreUnbiased) {
  struct Case {
    double signal_e_per_s;
    std::int64_t trials;
    double target;
    bool is_poisson;
  };
  constexpr Estimate PointDepthError::*quantities[] = {&PointDepthError::linear_mde_m,
                                                       &PointDepthError::linear_rmse_m,
                                                       &PointDepthError::circular_rmse_m};
  // Wraps dominate the linear error, wrong lobes the circular error in dim light; rounds are
  // merged.
  for (const Case& its :
       {Case{3e3, 600, 0.0, false}, Case{3e4, 400, 0.0, true}, Case{3e3, 200, 0.1, false}}) {
    SCOPED_TRACE(testing::Message() << its.signal_e_per_s << " e/s, target " << its.target);
    Camera camera = camera_at(its.signal_e_per_s, 1e3);
    if (its.is_poisson) camera.sensor.noise = NoiseModel::poisson;
    const CodeSet code = build_family("hamiltonian-k3", camera);
    const PointDepthError truth =
        evaluate(code, camera, {.trials = 400000, .seed = 999, .bounds = false}).points[0];
    std::array<RunningStatistics, 3> values, variance;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
      const PointDepthError error = evaluate(code, camera,
                                             {.trials = its.trials,
                                              .seed = seed,
                                              .target_standard_error = its.target,
                                              .bounds = false})
                                        .points[0];
      for (std::size_t q = 0; q < 3; ++q) {
        const Estimate& found = error.*quantities[q];
        values[q].add(found.value);
        variance[q].add(found.standard_error * found.standard_error);
      }
    }
    for (std::size_t q = 0; q < 3; ++q) {
      const Estimate& is = truth.*quantities[q];
      // For normal values, the relative standard error of a variance of 200 values is about 1/8.
      EXPECT_NEAR(variance[q].mean() / values[q].variance(), 1.0, 0.45) << q;
      // A root is biased by -variance / (2 * root) to first order.
      const bool is_mean = q == 0;
      const double bias_m = is_mean ? 0.0 : values[q].variance() / (2 * is.value);
      const double slack_m = is_mean && its.target == 0.0 ? 0.0 : 0.01 * is.value;
      EXPECT_NEAR(values[q].mean() + bias_m, is.value,
                  4 * std::hypot(values[q].standard_error(), is.standard_error) + slack_m)
          << q;
    }
  }
}

TEST(AdaptiveTrials, RejectInvalidTargets) {
  const Camera camera = camera_at(1e4, 1e4);
  const CodeSet code = build_family("hamiltonian-k3", camera);
  for (const double target : {-0.1, 1.0, std::nan("")})
    EXPECT_THROW(evaluate(code, camera, {.target_standard_error = target}), std::invalid_argument);
  EXPECT_THROW(evaluate(code, camera, {.target_standard_error = 0.1, .max_trials = 1}),
               std::invalid_argument);
}

std::size_t lanes_of(std::int64_t target) {
  if (target == HWY_SCALAR) return 1;
  if (target == HWY_AVX3) return 8;
  return target == HWY_AVX2 ? 4 : 2;
}

TEST(TrialKernel, SumsErrorsInVectorOrderWithEveryHighwayVersion) {
  constexpr std::size_t pairs = 8;
  std::array<double, 2 * pairs> true_bin{}, decoded_bin{};
  std::array<double, pairs> pair_sum{};
  for (std::size_t i = 0; i < pairs; ++i) {  // values whose sum depends on the order
    const double a = std::exp(1.7 * static_cast<double>(i)) / 3e4, b = 0.1 * a;
    decoded_bin[2 * i] = a;
    decoded_bin[2 * i + 1] = b;
    pair_sum[i] = a + b;
  }
  for_each_target([&](std::int64_t target) {
    const std::size_t lanes = lanes_of(target);
    std::array<double, pairs> sum{};
    for (std::size_t i = 0; i < pairs; ++i) sum[i % lanes] += pair_sum[i];
    for (std::size_t half = lanes / 2; half > 0; half /= 2)
      for (std::size_t i = 0; i < half; ++i) sum[i] += sum[i + half];
    const TileSums sums = sum_errors(true_bin.data(), decoded_bin.data(), 2 * pairs, 1000.0, 1e9);
    EXPECT_EQ(sums.linear.sum, sum[0]);
  });
}

}  // namespace

}  // namespace tofsmith
