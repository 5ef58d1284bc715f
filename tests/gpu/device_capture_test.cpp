// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What a device captures against what this computer captures: the same bits.
#include "gpu/device_capture.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "device_setup.hpp"
#include "rows_setup.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/simulate/staged_capture.hpp"

namespace tofsmith {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Depths from a hand's breadth to beyond the range, some without return, all albedos and angles.
SceneImage any_scene(int height, int width, double range_m, std::uint64_t seed = 3) {
  SceneImage scene(height, width);
  scene.ambient_scale = Image<float>(height, width);
  RandomStream random(seed, 0);
  for (std::size_t i = 0; i < scene.depth_m.size(); ++i) {
    scene.depth_m.pixels[i] =
        i % 11 == 4 ? nan : static_cast<float>(range_m * (0.02 + 1.3 * random.uniform()));
    scene.albedo.pixels[i] = static_cast<float>(i % 7 == 2 ? 0.0 : random.uniform());
    scene.cosine.pixels[i] = static_cast<float>(random.uniform());
    scene.ambient_scale.pixels[i] = static_cast<float>(i % 5 == 1 ? 0.0 : 2.0 * random.uniform());
  }
  return scene;
}

void expect_same_frames(const RawFrames& a, const RawFrames& b) {
  ASSERT_EQ(a.values.size(), b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i)
    ASSERT_EQ(std::memcmp(&a.values[i], &b.values[i], sizeof(float)), 0)
        << "value " << i << ": " << a.values[i] << " and " << b.values[i];
}

/// Weights between -1 and 1, where electrons are smaller than one.
CodeSet analog_code(int samples) {
  std::vector<Waveform> light(4, rectangular_pulse(1.0 / 12));
  Eigen::MatrixXd weights(samples, 4);
  for (int e = 0; e < 4; ++e)
    for (int n = 0; n < samples; ++n)
      weights(n, e) = std::cos(2 * std::numbers::pi * ((n + 0.5) / samples - e / 4.0));
  return CodeSet::create_signed("analog", std::move(light), weights);
}

/// A code and a camera that capture.
struct CaptureSetup {
  std::string name;
  Camera camera;
  CodeSet code;
};

CaptureSetup setup_of(const std::string& code, Camera camera) {
  CodeSet built = build_family(code, camera);
  return {code, std::move(camera), std::move(built)};
}

std::vector<CaptureSetup> all_setups() {
  std::vector<CaptureSetup> setups;
  for (const NoiseModel noise : {NoiseModel::gaussian, NoiseModel::poisson})
    for (const double read_noise_e : {0.0, 20.0}) {
      Camera camera = built_in_camera("paper-10f0");
      camera.sensor.noise = noise;
      camera.sensor.read_noise_e = read_noise_e;
      camera.sensor.dark_current_e_per_s = 30.0;
      setups.push_back(setup_of("hamiltonian-k4", camera));
      Camera counts = camera;
      counts.sensor.full_well_e = 30000.0;
      counts.sensor.adc_bits = 12;
      counts.sensor.gain_e_per_dn = 4.0;
      counts.sensor.black_level_dn = 40.0;
      setups.push_back(setup_of("multifrequency-k5", counts));
      counts.sensor.taps = camera.sensor.taps = 2;
      setups.push_back(setup_of("square-k4", counts));
      counts.sensor.readout = camera.sensor.readout = Readout::difference;
      setups.push_back(setup_of("square-k4", counts));
      setups.push_back(setup_of("sinusoid-k4", camera));
      for (Camera mixer : {camera, counts}) {
        mixer.sensor.taps = 1;
        mixer.sensor.readout = Readout::separate;
        mixer.sensor.demodulation = Demodulation::weight;
        mixer.sensor.black_level_dn.reset();
        mixer.sensor.modulation_contrast = 0.7;
        setups.push_back(setup_of("hamiltonian-k4", mixer));
        setups.push_back({"analog", mixer, analog_code(mixer.samples)});
      }
    }
  return setups;
}

std::vector<CaptureOptions> all_lights() {
  return {{.signal_e_per_s = 1e5, .ambient_e_per_s = 1e4, .seed = 1, .frames = 2},
          {.signal_e_per_s = 30.0, .ambient_e_per_s = 5.0, .falloff = false, .seed = 7},
          {.signal_e_per_s = 1e7,
           .ambient_e_per_s = 1e11,
           .reference_distance_m = 0.7,
           .seed = 0x123456789abcdef0u},
          {.signal_e_per_s = 0.0, .ambient_e_per_s = 0.0}};
}

using DeviceCaptures = OnDevice;

TEST_F(DeviceCaptures, HaveTheBitsOfTheProcessor) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  const DeviceCapture there(device());
  for (const CaptureSetup& setup : all_setups()) {
    const SceneImage scene = any_scene(31, 45, setup.camera.range_m());
    for (const CaptureOptions& options : all_lights()) {
      SCOPED_TRACE(testing::Message()
                   << setup.name << ", " << setup.camera.sensor.read_noise_e << " e of read noise, "
                   << setup.camera.sensor.taps << " taps, S = " << options.signal_e_per_s);
      expect_same_frames(capture(scene, setup.code, setup.camera, options, {}, there.expose_by()),
                         capture(scene, setup.code, setup.camera, options));
    }
  }
}

TEST_F(DeviceCaptures, OfRowsHaveTheBitsOfTheProcessor) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  const DeviceCapture there(device());
  for (const NoiseModel noise : {NoiseModel::gaussian, NoiseModel::poisson})
    for (const double read_noise_e : {0.0, 2.0}) {
      Camera camera = rows_camera();
      camera.sensor.noise = noise;
      camera.sensor.read_noise_e = read_noise_e;
      const CodeSet code = build_family(read_noise_e > 0.0 ? "fourier-k5" : "histogram-k6", camera);
      const SceneImage scene = any_scene(9, 20, camera.range_m());
      const CaptureOptions options{.signal_e_per_s = 1e3, .ambient_e_per_s = 1e3, .frames = 2};
      expect_same_frames(capture(scene, code, camera, options, {}, there.expose_by()),
                         capture(scene, code, camera, options));
    }
}

TEST_F(DeviceCaptures, OfLongerWaysLensesAndMotionHaveTheBitsOfTheProcessor) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  const DeviceCapture there(device());
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const SceneImage scene = any_scene(12, 17, camera.range_m());
  const CaptureOptions options{.signal_e_per_s = 1e5, .ambient_e_per_s = 1e4, .frames = 2};
  SceneLight returns, tail, transient, scattered;
  returns.returns = behind_every_pixel(scene, std::vector<MultipathReturn>{{1.5f, 0.3f}});
  tail.tail = ExponentialTail{1.0, 0.4};
  transient.transients = {{.light = {0.0, 3.0, 2.0, 1.0}, .bin_m = 0.3, .first_m = 0.1}};
  scattered.stray_light = Image<float>(3, 3, 0.02f);
  for (const SceneLight& light : {returns, tail, transient, scattered})
    expect_same_frames(capture(scene, light, code, camera, options, {}, there.expose_by()),
                       capture(scene, light, code, camera, options));

  Camera blurred = camera;
  blurred.blur =
      LensBlur{.kind = LensBlur::Kind::gaussian, .blur_sigma_px = 0.7, .pixel_samples = 2};
  StagedScene wall{.shapes = {Plane{.point = {0, 0, 3.0}, .texture = {.image = {}}}},
                   .view = PinholeView::centred(9, 7, 0.5)};
  StagedSetup setup;
  setup.expose_by = there.expose_by();
  for (const Camera& seen_by : {camera, blurred})
    for (const bool moves : {false, true}) {
      wall.shape_motions.clear();
      if (moves) wall.shape_motions = {Motion{.velocity_m_per_s = {0, 0, -0.5}}};
      expect_same_frames(capture(wall, code, seen_by, options, setup).raw,
                         capture(wall, code, seen_by, options).raw);
    }
}

TEST_F(DeviceCaptures, LeaveFewPixelsToTheProcessorAndHaveTheSameBitsWhateverTheyLeave) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  for (const NoiseModel noise : {NoiseModel::gaussian, NoiseModel::poisson}) {
    Camera camera = built_in_camera("paper-10f0");
    camera.sensor.noise = noise;
    camera.sensor.adc_bits = 12;
    camera.sensor.gain_e_per_dn = 4.0;
    const CodeSet code = build_family("hamiltonian-k4", camera);
    const SceneImage scene = any_scene(64, 80, camera.range_m());
    const CaptureOptions options{.signal_e_per_s = 1e5, .ambient_e_per_s = 1e4};
    const RawFrames expected = capture(scene, code, camera, options);
    DeviceCapture::Plan there(device(), {});
    std::int64_t left = 0;
    const ExposeBy count = [&](const UnexposedFrames& frames, const Progress& progress) {
      left = there.expose(frames, progress);
    };
    std::int64_t before = 0;
    for (const double margin : {1.0, 1e11, 1e13}) {
      there.margin = margin;
      expect_same_frames(capture(scene, code, camera, options, {}, count), expected);
      EXPECT_GE(left, before);
      if (margin == 1.0) {
        EXPECT_LE(left, 2);
      } else {
        EXPECT_GT(left, margin == 1e11 ? 50 : 2500);
      }
      before = left;
    }
  }
}

TEST_F(DeviceCaptures, GoInPartsAndLeaveSmallFramesToTheProcessor) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  const SceneImage scene = any_scene(70, 71, camera.range_m());
  const CaptureOptions options{.frames = 3};
  const RawFrames expected = capture(scene, code, camera, options);
  for (const DeviceOptions& how :
       {DeviceOptions{.memory_mb = 1e-3}, DeviceOptions{.memory_mb = 0.1},
        DeviceOptions{.min_pixels = 4970}, DeviceOptions{.min_pixels = 4971}})
    expect_same_frames(
        capture(scene, code, camera, options, {}, DeviceCapture(device(), how).expose_by()),
        expected);
  DeviceCapture::Plan plan(device(), {.min_pixels = 4971});
  std::int64_t left = 0;
  capture(scene, code, camera, options, {},
          [&](const UnexposedFrames& frames, const Progress& progress) {
            left = plan.expose(frames, progress);
          });
  EXPECT_EQ(left, 3 * 4970);
}

TEST_F(DeviceCaptures, OfSeveralThreadsWaitForOneAnother) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  const DeviceCapture there(device());
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  std::vector<RawFrames> frames(8);
  const auto scene_of = [&](std::size_t i) {
    return any_scene(20 + static_cast<int>(i), 30, camera.range_m(), i);
  };
  parallel_for(8, [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    frames[at] = capture(scene_of(at), code, camera, {}, {}, there.expose_by());
  });
  for (std::size_t i = 0; i < frames.size(); ++i)
    expect_same_frames(frames[i], capture(scene_of(i), code, camera, {}));
}

TEST_F(DeviceCaptures, StopWhenProgressSaysSoAndRefuseBadOptions) {
  if (!device().info().has_doubles) GTEST_SKIP() << "the device has no doubles";
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const SceneImage scene = any_scene(30, 40, camera.range_m());
  const DeviceCapture there(device());
  const CaptureOptions options{.frames = 5};
  EXPECT_THROW(capture(
                   scene, code, camera, options,
                   [](double done, std::string_view) { return done < 0.5; }, there.expose_by()),
               Interrupted);
  expect_same_frames(capture(scene, code, camera, options, {}, there.expose_by()),
                     capture(scene, code, camera, options));
  EXPECT_THAT([&] { DeviceCapture(device(), {.memory_mb = 0.0}); },
              ThrowsMessage<InvalidArgument>(HasSubstr("memory_mb = 0")));
}

TEST_F(DeviceCaptures, AreMadeForTheDeviceThatIsNamed) {
  EXPECT_FALSE(device_capture("cpu"));
  EXPECT_THROW(device_capture("no such device"), IoError);
  EXPECT_EQ(device_capture("auto").has_value(), Device::first_gpu().has_value());
  if (device().info().has_doubles) {
    EXPECT_EQ(device_capture("0")->device().info().name, device().info().name);
  } else {
    EXPECT_THAT([] { device_capture("0"); },
                ThrowsMessage<InvalidArgument>(HasSubstr("must have doubles for captures")));
  }
}

}  // namespace
}  // namespace tofsmith
