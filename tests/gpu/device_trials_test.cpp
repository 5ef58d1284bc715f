// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Trials that a device runs against those that this computer runs.
#include "gpu/device_trials.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "device_setup.hpp"
#include "each_target.hpp"
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
  EvaluateOptions options{.trials = 20000, .bounds = false};

  CodeSet built() const { return build_family(code, camera); }
  std::string text() const {
    const Sensor& sensor = camera.sensor;
    return fmt::format("{}, {}, {} taps, {}, read noise {} e, {}{}", code,
                       sensor.noise == NoiseModel::poisson ? "Poisson" : "normal", sensor.taps,
                       sensor.subtracts() ? "difference" : "each", sensor.read_noise_e,
                       sensor.adc_bits ? "counts" : "electrons",
                       sensor.is_signed() ? ", mixer" : "");
  }
};

/// One tap, two, their difference and a mixer.
std::vector<TrialSetup> of_all_readouts(Camera camera, const char* one, const char* two) {
  std::vector<TrialSetup> setups{{one, camera}};
  Camera mixer = camera;
  mixer.sensor.demodulation = Demodulation::weight;
  mixer.sensor.black_level_dn.reset();
  setups.push_back({one, mixer});
  camera.sensor.taps = 2;
  setups.push_back({two, camera});
  camera.sensor.readout = Readout::difference;
  setups.push_back({two, camera});
  return setups;
}

/// Drawn where ZNCC looks.
std::vector<TrialSetup> linear_setups() {
  std::vector<TrialSetup> setups =
      of_all_readouts(judged_at(1e5, 1e4), "hamiltonian-k4", "square-k4");
  for (const char* code : {"hamiltonian-k3", "hamiltonian-k5"})
    setups.push_back({code, judged_at(1e5, 1e4)});
  setups.push_back({"hamiltonian-k7", judged_at(1e5, 1e3)});
  setups.back().camera.samples = 252;
  TrialSetup other = setups[0];
  other.camera.operating.uniform_albedo = true;
  other.camera.sensor.dark_current_e_per_s = 300.0;
  other.options.seed = 0x123456789abcdef0u;
  setups.push_back(other);
  other = setups[0];
  other.options.depth = DepthSampling::bins;
  setups.push_back(other);
  other.options.sub_bin = false;
  setups.push_back(other);
  return setups;
}

/// Of which every measurement is drawn.
std::vector<TrialSetup> measured_setups() {
  std::vector<TrialSetup> setups;
  for (const NoiseModel noise : {NoiseModel::gaussian, NoiseModel::poisson})
    for (const bool counts : {false, true}) {
      Camera camera = judged_at(1e5, 1e4);
      camera.sensor.noise = noise;
      camera.sensor.read_noise_e = counts ? 20.0 : 0.0;
      camera.sensor.dark_current_e_per_s = 30.0;
      if (counts) {
        camera.sensor.full_well_e = 30000.0;
        camera.sensor.adc_bits = 12;
        camera.sensor.gain_e_per_dn = 4.0;
        camera.sensor.black_level_dn = 40.0;
      } else if (noise == NoiseModel::gaussian) {
        camera.sensor.full_well_e = 5000.0;
      }
      for (const TrialSetup& setup : of_all_readouts(camera, "hamiltonian-k4", "square-k4"))
        setups.push_back(setup);
      setups.push_back({counts ? "hamiltonian-k3" : "multifrequency-k5", camera});
    }
  setups.push_back({"hamiltonian-k7", judged_at(1e5, 1e3)});
  setups.back().camera.samples = 252;
  setups.back().camera.sensor.noise = NoiseModel::poisson;
  setups.push_back({"hamiltonian-k4", judged_at(30.0, 5.0)});  // of few electrons
  setups.back().camera.sensor.noise = NoiseModel::poisson;
  setups.push_back({"hamiltonian-k4", judged_at(1e9, 1e12)});  // of many
  setups.back().camera.sensor.noise = NoiseModel::poisson;
  for (TrialSetup setup : of_all_readouts(judged_at(1e5, 1e4), "hamiltonian-k5", "square-k4")) {
    setup.options.clip_to_open_sensor = true;
    setups.push_back(setup);
  }
  setups.push_back({"hamiltonian-k3", judged_at(1e5, 1e4)});
  setups.back().options.draw_every_measurement = true;
  setups.back().options.sub_bin = false;
  setups.back().camera.operating.uniform_albedo = true;
  return setups;
}

/// Whose rows are read out.
std::vector<TrialSetup> row_setups() {
  std::vector<TrialSetup> setups;
  for (const NoiseModel noise : {NoiseModel::gaussian, NoiseModel::poisson})
    for (const char* code : {"fourier-k5", "histogram-k6"}) {
      setups.push_back({code, rows_camera()});
      setups.back().camera.sensor.noise = noise;
      setups.back().camera.sensor.read_noise_e = setups.size() % 2 == 1 ? 2.0 : 0.0;
      setups.back().camera.operating.signal_e_per_s = {1e2, 1e3};
    }
  return setups;
}

std::vector<TrialSetup> trial_setups() {
  std::vector<TrialSetup> setups = linear_setups();
  for (const std::vector<TrialSetup>& more : {measured_setups(), row_setups()})
    setups.insert(setups.end(), more.begin(), more.end());
  std::vector<TrialSetup> weighed{setups[0], setups[1], setups.back()};  // how often depths occur
  for (TrialSetup& setup : weighed) {
    const double range_m = setup.camera.range_m();
    setup.camera.operating.working_distance_m = {0.2 * range_m, 0.7 * range_m};
    setups.push_back(setup);
    setup.camera.operating.depths = {3.0, 1.0, 0.0, 2.0};
    setups.push_back(setup);
    setup.options.depth = DepthSampling::bins;
    setup.camera.operating.working_distance_m.reset();
    setups.push_back(setup);
  }
  return setups;
}

/// Trials [200, 200 + count) of two rounds of a setup, there and here.
template <typename Compare>
void for_both(const TrialSetup& setup, const DepthTrials& trials, TrialDevice& there, int count,
              const Compare& compare) {
  const auto work = std::make_unique<TrialTile>();
  for (const TrialRound& round : {TrialRound{1, 0, 30000}, TrialRound{0, 20000, 60000}}) {
    if (round.point >= trials.points().size()) continue;
    std::vector<double> true_bin(static_cast<std::size_t>(count)), decoded_bin(true_bin.size());
    there.run({round, {200, 200 + count}, true_bin.data(), decoded_bin.data()});
    for (int first = 0; first < count; first += 250) {
      const TrialBlock block = trials.run(round, {200 + first, 450 + first}, *work);
      for (std::size_t i = 0; i < 250; ++i) {
        const std::size_t at = static_cast<std::size_t>(first) + i;
        ASSERT_EQ(true_bin[at], block.true_bin[i]) << setup.text() << ", trial " << at;
        compare(decoded_bin[at], block.decoded_bin[i]);
      }
    }
  }
}

using DeviceTrialsOf = OnDevice;

TEST_F(DeviceTrialsOf, HaveTheBitsOfTheProcessor) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  const bool has_same_bits = device().info().divides_as_processor;
  for (const TrialSetup& setup : trial_setups()) {
    SCOPED_TRACE(setup.text());
    const DepthTrials trials(ForwardModel(setup.built(), setup.camera), setup.camera,
                             setup.options);
    const auto there = std::make_unique<TrialDevice>(device(), trials, DeviceOptions());
    const double samples = trials.samples();
    const int count = trials.rows() ? 2000 : 10000;
    int apart = 0;
    for_both(setup, trials, *there, count, [&](double found, double expected) {
      if (has_same_bits) {
        apart += found == expected ? 0 : 1;
      } else {
        const double error = std::abs(found - expected);
        apart += std::min(error, samples - error) <= 1e-6 ? 0 : 1;
      }
    });
    EXPECT_EQ(apart, 0);
    // Of very many electrons the last bits of doubles decide more often.
    EXPECT_LE(there->drawn_here(), trials.points().front().ambient_e_per_s > 1e10 ? 400 : 2);
    if (!trials.rows()) {
      EXPECT_LT(there->decoded_here(), count / 50);
    }
  }
}

TEST_F(DeviceTrialsOf, HaveTheBitsOfEveryInstructionSet) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  std::vector<TrialSetup> setups{linear_setups().front()};
  const std::vector<TrialSetup> measured = measured_setups();
  for (std::size_t i = 0; i < measured.size(); i += 3) setups.push_back(measured[i]);
  setups.push_back(row_setups().front());
  for_each_target([&] {
    for (const TrialSetup& setup : setups) {
      const DepthTrials trials(ForwardModel(setup.built(), setup.camera), setup.camera,
                               setup.options);
      const auto there = std::make_unique<TrialDevice>(device(), trials, DeviceOptions());
      for_both(setup, trials, *there, 500, [&](double found, double expected) {
        if (device().info().divides_as_processor) {
          EXPECT_EQ(found, expected);
        } else {
          EXPECT_NEAR(found, expected, 1e-6);
        }
      });
    }
  });
}

TEST_F(DeviceTrialsOf, AreTheSameHoweverManyTheProcessorDraws) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  for (const TrialSetup& setup : trial_setups()) {
    if (setup.camera.sensor.noise != NoiseModel::poisson) continue;
    SCOPED_TRACE(setup.text());
    const DepthTrials trials(ForwardModel(setup.built(), setup.camera), setup.camera,
                             setup.options);
    std::int64_t before = 0;
    for (const double margin : {1e9, 1e11, 1e13}) {
      const auto there = std::make_unique<TrialDevice>(device(), trials, DeviceOptions());
      there->margin = margin;
      for_both(setup, trials, *there, 500,
               [&](double found, double expected) { EXPECT_NEAR(found, expected, 1e-6); });
      EXPECT_GE(there->drawn_here(), before);
      before = there->drawn_here();
    }
    EXPECT_GT(before, 100);
  }
}

TEST_F(DeviceTrialsOf, GiveTheErrorsOfTheProcessor) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  for (const DeviceOptions& how : {DeviceOptions{}, DeviceOptions{.memory_mb = 0.1}}) {
    const DeviceTrials there(device(), how);
    for (TrialSetup setup : trial_setups()) {
      SCOPED_TRACE(setup.text());
      setup.options.trials = setup.camera.sensor.readout == Readout::rows ? 1000 : 5000;
      if (setup.options.seed != 1) setup.options.target_standard_error = 0.01;
      const DepthErrorReport found =
          evaluate(setup.built(), setup.camera, setup.options, {}, there.trials_by());
      const DepthErrorReport expected = evaluate(setup.built(), setup.camera, setup.options);
      ASSERT_EQ(found.points.size(), expected.points.size());
      for (std::size_t p = 0; p < found.points.size(); ++p) {
        const PointDepthError &a = found.points[p], &b = expected.points[p];
        EXPECT_EQ(a.trials, b.trials);
        EXPECT_EQ(a.outlier_rate.value, b.outlier_rate.value);
        const double rounding = device().info().divides_as_processor ? 0.0 : 1e-6;
        for (const auto error :
             {&PointDepthError::linear_mde_m, &PointDepthError::circular_mde_m,
              &PointDepthError::linear_rmse_m, &PointDepthError::circular_rmse_m}) {
          EXPECT_NEAR((a.*error).value, (b.*error).value, rounding * (b.*error).value);
          EXPECT_NEAR((a.*error).standard_error, (b.*error).standard_error,
                      rounding * (b.*error).value);
        }
      }
    }
  }
}

TEST_F(DeviceTrialsOf, OtherMethodsAreTheProcessors) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  const DeviceTrials there(device());
  for (const DecodeMethod method : {DecodeMethod::unwrap, DecodeMethod::ml}) {
    TrialSetup setup{"sinusoid-k4", judged_at(1e5, 1e4), {.trials = 2000, .bounds = false}};
    setup.options.method = method;
    ASSERT_TRUE(why_not_on_device(setup.options));
    EXPECT_THROW(device_trials("0", setup.options), InvalidArgument);
    EXPECT_FALSE(device_trials("auto", setup.options));
    const DepthErrorReport found =
        evaluate(setup.built(), setup.camera, setup.options, {}, there.trials_by());
    const DepthErrorReport expected = evaluate(setup.built(), setup.camera, setup.options);
    for (std::size_t p = 0; p < found.points.size(); ++p)
      EXPECT_EQ(found.points[p].linear_mde_m.value, expected.points[p].linear_mde_m.value);
  }
  EXPECT_FALSE(why_not_on_device({}));
}

TEST_F(DeviceTrialsOf, RunOnTheDeviceThatIsNamed) {
  EXPECT_FALSE(device_trials("cpu", {}));
  EXPECT_FALSE(device_trials("auto", {.trials = 1000}));
  EXPECT_THROW(device_trials("no such device", {}), IoError);
  if (device().info().has_doubles) {
    EXPECT_EQ(device_trials("0", {})->device().info().name, device().info().name);
    EXPECT_THAT([&] { DeviceTrials(device(), {.memory_mb = 0.0}); },
                ThrowsMessage<InvalidArgument>(HasSubstr("memory_mb = 0")));
  } else {
    EXPECT_THAT([&] { device_trials("0", {}); },
                ThrowsMessage<InvalidArgument>(HasSubstr("must have doubles for trials")));
  }
}

}  // namespace
}  // namespace tofsmith
