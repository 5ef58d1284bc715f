// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Trials that a device runs against those that this computer runs.
#include "gpu/device_trials.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "device_setup.hpp"
#include "rows_setup.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Camera judged_at(double signal_e_per_s, double ambient_e_per_s) {
  Camera camera = built_in_camera("paper-10f0");
  camera.operating.signal_e_per_s = {1e3, signal_e_per_s};
  camera.operating.ambient_e_per_s = {ambient_e_per_s};
  return camera;
}

/// A code on a camera, and what is asked of its trials.
struct TrialSetup {
  std::string code;
  Camera camera;
  EvaluateOptions options;

  CodeSet built() const { return build_family(code, camera); }
};

std::vector<TrialSetup> trial_setups() {
  const EvaluateOptions options{.trials = 20000, .bounds = false};
  std::vector<TrialSetup> setups;
  for (const char* code : {"hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5", "square-k4"})
    setups.push_back({code, judged_at(1e5, 1e4), options});
  setups.push_back({"hamiltonian-k7", judged_at(1e5, 1e3), options});
  setups.back().camera.samples = 252;
  TrialSetup other = setups[1];
  other.camera.operating.uniform_albedo = true;
  other.camera.sensor.dark_current_e_per_s = 300.0;
  other.options.seed = 0x123456789abcdef0u;
  setups.push_back(other);
  other = setups[1];
  other.options.depth = DepthSampling::bins;
  setups.push_back(other);
  other.options.sub_bin = false;
  setups.push_back(other);
  other = setups[3];
  other.camera.sensor.taps = 2;
  setups.push_back(other);
  other.camera.sensor.readout = Readout::difference;
  other.camera.sensor.dark_current_e_per_s = 300.0;
  setups.push_back(other);
  other = setups[1];
  other.camera.sensor.demodulation = Demodulation::weight;
  setups.push_back(other);
  return setups;
}

using DeviceTrialsOf = OnDevice;

TEST_F(DeviceTrialsOf, LieAndAreFoundWhereThoseOfTheProcessorAre) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  for (const TrialSetup& setup : trial_setups()) {
    SCOPED_TRACE(testing::Message() << setup.code << ", " << setup.camera.sensor.taps << " taps");
    const DepthTrials trials(ForwardModel(setup.built(), setup.camera), setup.camera,
                             setup.options);
    ASSERT_TRUE(trials.draws_in_plane());
    const auto there = std::make_unique<TrialDevice>(device(), trials, DeviceOptions());
    const auto work = std::make_unique<TrialTile>();
    const double samples = trials.samples();
    int apart = 0, near = 0;
    for (const TrialRound& round : {TrialRound{1, 0, 30000}, TrialRound{0, 20000, 60000}}) {
      std::vector<double> true_bin(20000), decoded_bin(20000);
      const IndexRange range{200, 20200};
      there->run({round, range, true_bin.data(), decoded_bin.data()});
      for (std::int64_t begin = range.begin; begin < range.end; begin += 250) {
        const TrialBlock block = trials.run(round, {begin, begin + 250}, *work);
        for (std::size_t i = 0; i < 250; ++i) {
          const std::size_t at = static_cast<std::size_t>(begin - range.begin) + i;
          ASSERT_EQ(true_bin[at], block.true_bin[i]) << at;
          ASSERT_GE(decoded_bin[at], 0.0);
          ASSERT_LT(decoded_bin[at], samples);
          const double error = std::abs(decoded_bin[at] - block.decoded_bin[i]);
          near += std::min(error, samples - error) <= 2e-6 * samples ? 1 : 0;
          // Where noise all but cancels the signal, its direction is less sure.
          apart += std::min(error, samples - error) > 2e-5 * samples ? 1 : 0;
        }
      }
    }
    EXPECT_LE(apart, 1);
    EXPECT_GE(near, 39980);
    EXPECT_LT(there->by_processor(), 400);
  }
}

TEST_F(DeviceTrialsOf, GiveTheErrorsOfTheProcessor) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  for (const DeviceOptions& how : {DeviceOptions{}, DeviceOptions{.memory_mb = 0.1}}) {
    const DeviceTrials there(device(), how);
    for (TrialSetup setup : trial_setups()) {
      SCOPED_TRACE(setup.code);
      if (setup.options.seed != 1) setup.options.target_standard_error = 0.01;
      const DepthErrorReport found =
          evaluate(setup.built(), setup.camera, setup.options, {}, there.trials_by());
      const DepthErrorReport expected = evaluate(setup.built(), setup.camera, setup.options);
      ASSERT_EQ(found.points.size(), expected.points.size());
      for (std::size_t p = 0; p < found.points.size(); ++p) {
        const PointDepthError &a = found.points[p], &b = expected.points[p];
        EXPECT_NEAR(static_cast<double>(a.trials), static_cast<double>(b.trials),
                    0.02 * static_cast<double>(b.trials));
        // A trial or so may have two depths as likely.
        EXPECT_NEAR(a.circular_mde_m.value, b.circular_mde_m.value,
                    1e-5 * b.circular_mde_m.value + 0.5 * b.circular_mde_m.standard_error);
        EXPECT_NEAR(a.linear_mde_m.value, b.linear_mde_m.value,
                    1e-5 * b.linear_mde_m.value + 0.5 * b.linear_mde_m.standard_error);
        EXPECT_NEAR(a.circular_rmse_m.value, b.circular_rmse_m.value,
                    1e-5 * b.circular_rmse_m.value + 0.5 * b.circular_rmse_m.standard_error);
        EXPECT_NEAR(a.linear_rmse_m.value, b.linear_rmse_m.value,
                    1e-5 * b.linear_rmse_m.value + 0.5 * b.linear_rmse_m.standard_error);
        EXPECT_NEAR(a.linear_mde_m.standard_error, b.linear_mde_m.standard_error,
                    0.1 * b.linear_mde_m.standard_error);
        EXPECT_NEAR(a.outlier_rate.value, b.outlier_rate.value, 2e-4);
      }
    }
  }
}

TEST_F(DeviceTrialsOf, OtherKindsAreTheProcessors) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  const DeviceTrials there(device());
  std::vector<TrialSetup> setups(5, {"hamiltonian-k4", judged_at(1e5, 1e4), {.trials = 2000}});
  setups[0].camera.sensor.noise = NoiseModel::poisson;
  setups[1].camera.sensor.full_well_e = 1e4;
  setups[2].options.clip_to_open_sensor = true;
  setups[3].options.draw_every_measurement = true;
  setups[4].camera.operating.working_distance_m = {2.0, 6.0};
  setups.push_back({"histogram-k6", rows_camera(), {.trials = 200}});
  setups.push_back({"sinusoid-k4", judged_at(1e5, 1e4), {.trials = 2000}});
  setups.back().options.method = DecodeMethod::unwrap;
  for (const TrialSetup& setup : setups) {
    const std::optional<BrokenRule> why_not = why_not_on_device(setup.camera, setup.options);
    ASSERT_TRUE(why_not);
    EXPECT_THROW(device_trials("0", setup.camera, setup.options), InvalidArgument);
    EXPECT_FALSE(device_trials("auto", setup.camera, setup.options));
    const DepthErrorReport found =
        evaluate(setup.built(), setup.camera, setup.options, {}, there.trials_by());
    const DepthErrorReport expected = evaluate(setup.built(), setup.camera, setup.options);
    for (std::size_t p = 0; p < found.points.size(); ++p)
      EXPECT_EQ(found.points[p].linear_mde_m.value, expected.points[p].linear_mde_m.value);
  }
  for (const TrialSetup& setup : trial_setups())
    EXPECT_FALSE(why_not_on_device(setup.camera, setup.options));
}

TEST_F(DeviceTrialsOf, RunOnTheDeviceThatIsNamed) {
  const Camera camera = judged_at(1e5, 1e4);
  EXPECT_FALSE(device_trials("cpu", camera, {}));
  EXPECT_FALSE(device_trials("auto", camera, {.trials = 1000}));
  EXPECT_THROW(device_trials("no such device", camera, {}), IoError);
  if (device().info().has_doubles) {
    EXPECT_EQ(device_trials("0", camera, {})->device().info().name, device().info().name);
    EXPECT_THAT([&] { DeviceTrials(device(), {.memory_mb = 0.0}); },
                ThrowsMessage<InvalidArgument>(HasSubstr("memory_mb = 0")));
  } else {
    EXPECT_THAT([&] { device_trials("0", camera, {}); },
                ThrowsMessage<InvalidArgument>(HasSubstr("must have doubles for trials")));
  }
}

}  // namespace
}  // namespace tofsmith
