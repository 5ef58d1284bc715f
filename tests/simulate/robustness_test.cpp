// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/robustness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tofsmith/code/families.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

namespace {

constexpr RobustnessOptions nothing{
    .bandwidth = 0.0, .peak = 0.0, .edge_jitter_s = 0.0, .tap_mismatch = 0.0};

Camera small_camera(const char* name = "paper-10f0") {
  Camera camera = built_in_camera(name);
  camera.samples = 60;
  camera.operating.signal_e_per_s = {1e5};
  camera.operating.ambient_e_per_s = {1e3, 1e4};
  return camera;
}

const PerturbedCamera& find(const std::vector<PerturbedCamera>& cameras, const std::string& name) {
  for (const PerturbedCamera& camera : cameras)
    if (camera.name == name) return camera;
  throw std::runtime_error("no camera " + name);
}

PerturbedCamera with_peak(const Camera& camera, double peak) { return {"peak", camera, peak}; }

CodeSet code_of(const Camera& camera, const Waveform& modulation) {
  return CodeSet::create("one", camera.samples, 1, {3, modulation},
                         {square_wave(1, 0.0), square_wave(1, 0.33), square_wave(1, 0.66)});
}

TEST(Perturbations, ChangeOnePropertyEach) {
  const Camera camera = small_camera();
  const auto cameras = perturbations(camera);
  ASSERT_EQ(cameras.size(), 6u);
  for (const PerturbedCamera& p : cameras) EXPECT_NE(p.camera, camera) << p.name;

  Camera wider = camera;
  wider.light.impulse_response.f_max_hz *= 1.2;
  wider.sensor.impulse_response.f_max_hz *= 1.2;
  EXPECT_EQ(find(cameras, "bandwidth +20 %").camera, wider);
  Camera brighter = camera;
  brighter.light.peak_factor *= 1.1;
  EXPECT_EQ(find(cameras, "peak power +10 %").camera, brighter);
  EXPECT_EQ(find(cameras, "peak power +10 %").peak, 1.1);
  Camera jittered = camera;
  jittered.light.edge_jitter_s = jittered.sensor.edge_jitter_s = 50e-12;
  EXPECT_EQ(find(cameras, "edge jitter 50 ps").camera, jittered);
  Camera uneven = camera;
  uneven.sensor.tap_mismatch = 0.02;
  EXPECT_EQ(find(cameras, "tap mismatch 2 %").camera, uneven);
}

TEST(Perturbations, OfBandwidthRequireALimitedCamera) {
  const auto cameras = perturbations(small_camera("paper-30x"));
  EXPECT_EQ(cameras.size(), 4u);
  for (const PerturbedCamera& p : cameras) EXPECT_FALSE(p.name.starts_with("bandwidth")) << p.name;
}

TEST(Perturbations, StretchMeasuredResponsesInTime) {
  Camera camera = small_camera();
  camera.sensor.impulse_response = {
      .kind = ImpulseResponse::Kind::file, .samples = {0.2, 1.0, 0.3}, .time_step_s = 1e-9};
  const ImpulseResponse wider =
      find(perturbations(camera), "bandwidth +20 %").camera.sensor.impulse_response;
  for (const double f_hz : {1e7, 5e7, 2e8})
    EXPECT_NEAR(
        std::abs(wider.transfer(1.2 * f_hz) - camera.sensor.impulse_response.transfer(f_hz)), 0.0,
        1e-12);
}

TEST(Perturbations, AddJitterInQuadrature) {
  Camera camera = small_camera();
  camera.light.edge_jitter_s = 30e-12;
  const Camera jittered =
      find(perturbations(camera, {.edge_jitter_s = 40e-12}), "edge jitter 40 ps").camera;
  EXPECT_NEAR(jittered.light.edge_jitter_s, 50e-12, 1e-20);
  EXPECT_EQ(jittered.sensor.edge_jitter_s, 40e-12);
}

TEST(Perturbations, RejectInvalidOptions) {
  EXPECT_THROW(perturbations(small_camera(), {.bandwidth = 1.0}), std::invalid_argument);
  EXPECT_THROW(perturbations(small_camera(), {.peak = -0.1}), std::invalid_argument);
  EXPECT_THROW(perturbations(small_camera(), {.edge_jitter_s = NAN}), std::invalid_argument);
  EXPECT_THROW(
      robustness(build_family("sinusoid-k4", small_camera()), small_camera(), {.trials = 1}),
      std::invalid_argument);
}

TEST(PerturbedCode, KeepsPowerAndCentresOfPulses) {
  const Camera camera = small_camera();
  const Waveform pulses = Waveform::binary({{0.1, 0.2}, {0.5, 0.53}, {0.95, 1.02}}, 5.0);
  for (const double peak : {0.9, 1.1}) {
    const CodeSet code = perturbed_code(code_of(camera, pulses), with_peak(camera, peak));
    const Waveform& m = code.modulation(1);
    EXPECT_NEAR(m.mean(), pulses.mean(), 1e-12);
    EXPECT_NEAR(m.peak(), 5.0 * peak, 1e-12);
    ASSERT_EQ(m.on_intervals().size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const OnInterval &was = pulses.on_intervals()[i], &is = m.on_intervals()[i];
      EXPECT_NEAR(is.rise + is.fall, was.rise + was.fall, 1e-12);
      EXPECT_NEAR((is.fall - is.rise) * peak, was.fall - was.rise, 1e-12);
    }
    EXPECT_EQ(code.demodulation(2), square_wave(1, 0.66));
  }
}

TEST(PerturbedCode, MergesOverlappingPulses) {
  const Camera camera = small_camera();
  const PerturbedCamera dimmer = with_peak(camera, 0.9);
  // Inside the period and across its end; long pulses covering short ones; a full period.
  const Waveform close = Waveform::binary({{0.0, 0.3}, {0.31, 0.6}, {0.7, 0.99}}, 1.1);
  const Waveform m = perturbed_code(code_of(camera, close), dimmer).modulation(0);
  EXPECT_EQ(m.on_intervals().size(), 1u);
  EXPECT_LT(m.mean(), close.mean());
  EXPECT_NEAR(m.peak(), 0.99, 1e-12);
  const Waveform swallowed = Waveform::binary({{0.0, 0.9}, {0.91, 0.911}}, 1.05);
  const Waveform always =
      perturbed_code(code_of(camera, swallowed), with_peak(camera, 0.8)).modulation(0);
  EXPECT_EQ(always.duty(), 1.0);
  // A pulse at the start of the period extends across it.
  const Waveform first = Waveform::binary({{0.0, 0.5}}, 2.0);
  EXPECT_NEAR(perturbed_code(code_of(camera, first), dimmer).modulation(0).mean(), 1.0, 1e-12);
}

TEST(PerturbedCode, OfAnalogLightKeepsPowerAndScalesThePeak) {
  const Camera camera = small_camera();
  Eigen::VectorXd samples(60);
  for (int n = 0; n < 60; ++n) samples[n] = 1.0 + 0.5 * std::sin(0.1047197551 * n);
  const CodeSet code = code_of(camera, Waveform::sampled(samples));
  for (const double peak : {0.9, 1.1}) {
    const Waveform m = perturbed_code(code, with_peak(camera, peak)).modulation(0);
    EXPECT_NEAR(m.mean(), samples.mean(), 1e-12);
    EXPECT_NEAR(m.peak(), peak * samples.maxCoeff(), 1e-12);
  }
  // Clipped at 0, with unchanged power.
  const Waveform deep = perturbed_code(code, with_peak(camera, 2.0)).modulation(0);
  EXPECT_GE(deep.minimum(), 0.0);
  EXPECT_NEAR(deep.mean(), samples.mean(), 1e-12);
}

TEST(Robustness, OfNoPerturbationEqualsTheDepthError) {
  const Camera camera = small_camera();
  const CodeSet code = build_family("hamiltonian-k4", camera);
  RobustnessOptions options = nothing;
  options.trials = 999;
  options.seed = 3;
  const RobustnessReport report = robustness(code, camera, options);
  const DepthErrorReport error = evaluate(code, camera, {.trials = 999, .seed = 3});
  EXPECT_EQ(report.nominal_m.value, error.linear.geometric_mean_m.value);
  EXPECT_EQ(report.nominal_m.standard_error, error.linear.geometric_mean_m.standard_error);
  EXPECT_EQ(report.trials, error.trials);
  EXPECT_TRUE(report.perturbed.empty());
  EXPECT_EQ(report.worst_calibrated_m().value, report.nominal_m.value);
}

TEST(Robustness, CalibratedEqualsTheDepthErrorOfThePerturbedCamera) {
  Camera camera = small_camera();
  camera.operating.error = DepthErrorKind::circular;
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const RobustnessReport report = robustness(code, camera, {.trials = 1000});
  EXPECT_EQ(report.kind, DepthErrorKind::circular);
  const auto cameras = perturbations(camera);
  ASSERT_EQ(report.perturbed.size(), cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const DepthErrorReport error =
        evaluate(perturbed_code(code, cameras[i]), cameras[i].camera, {.trials = 1000});
    EXPECT_EQ(report.perturbed[i].name, cameras[i].name);
    EXPECT_EQ(report.perturbed[i].calibrated_m.value, error.circular.geometric_mean_m.value);
    EXPECT_LE(report.perturbed[i].calibrated_m.value, report.worst_calibrated_m().value);
    EXPECT_LE(report.perturbed[i].uncalibrated_m.value, report.worst_uncalibrated_m().value);
  }
}

/// Ambient light cancels if the taps are equal.
CodeSet two_differences(const Camera& camera) {
  const Waveform light = rectangular_pulse(0.1);
  const auto gate = [](double begin) { return square_wave(1, begin); };
  return CodeSet::create("two", camera.samples, 2, {light, light},
                         {gate(0.0), gate(0.5), gate(0.25), gate(0.75)});
}

TEST(Robustness, UsesTheNominalDecoderIfThePerturbedCameraMeasuresNoDepth) {
  Camera camera = small_camera();
  camera.sensor.taps = 2;
  camera.sensor.readout = Readout::difference;
  camera.operating.ambient_e_per_s = {1e7};
  const RobustnessReport report = robustness(two_differences(camera), camera, {.trials = 1000});
  const auto mismatched =
      std::find_if(report.perturbed.begin(), report.perturbed.end(),
                   [](const PerturbedError& p) { return p.name.starts_with("tap mismatch"); });
  ASSERT_NE(mismatched, report.perturbed.end());
  EXPECT_EQ(mismatched->calibrated_m.value, mismatched->uncalibrated_m.value);
  EXPECT_GT(mismatched->calibrated_m.value, report.nominal_m.value);
}

TEST(Robustness, ExcludesPerturbationsBeyondTheGenerator) {
  Camera camera = small_camera();
  camera.light.generator = Generator{.sample_rate_hz = 12 * camera.fundamental_frequency_hz};
  // The first point is on if the pulse covers its middle, at 0.5 / 12 of the period.
  const CodeSet code = code_of(camera, Waveform::binary({{0.499 / 12, 0.6 / 12}}, 15.0));
  ASSERT_EQ(why_not_playable(code, camera), std::nullopt);
  std::vector<std::string> names;
  for (const PerturbedError& p : robustness(code, camera, {.trials = 1000}).perturbed)
    names.push_back(p.name);
  EXPECT_EQ(std::count(names.begin(), names.end(), "peak power -10 %"), 1);
  EXPECT_EQ(std::count(names.begin(), names.end(), "peak power +10 %"), 0);
}

TEST(Robustness, ADecoderForAnotherCameraHasLargerErrors) {
  // In very bright light the remaining error is bias. Jitter is excluded, because it blurs
  // symmetrically and causes almost no bias.
  Camera camera = small_camera();
  camera.operating.signal_e_per_s = {1e9};
  camera.operating.ambient_e_per_s = {0.0};
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const RobustnessReport report = robustness(code, camera, {.edge_jitter_s = 0.0, .trials = 400});
  for (const PerturbedError& p : report.perturbed)
    EXPECT_GT(p.uncalibrated_m.value, p.calibrated_m.value) << p.name;
}

TEST(Robustness, IncreasesWithThePerturbation) {
  const Camera camera = small_camera();
  const CodeSet code = build_family("hamiltonian-k4", camera);
  double last = 0.0;
  for (const double mismatch : {0.001, 0.05, 0.2}) {
    RobustnessOptions options = nothing;
    options.tap_mismatch = mismatch;
    options.trials = 1000;
    const RobustnessReport report = robustness(code, camera, options);
    ASSERT_EQ(report.perturbed.size(), 1u);
    const double ratio = report.perturbed[0].uncalibrated_m.value / report.nominal_m.value;
    EXPECT_GT(ratio, last);
    last = ratio;
    if (mismatch == 0.001) {
      EXPECT_NEAR(ratio, 1.0, 0.02);
    }
  }
  EXPECT_GT(last, 1.2);
}

TEST(Robustness, StopsOnRequest) {
  const Camera camera = small_camera();
  EXPECT_ANY_THROW(robustness(build_family("hamiltonian-k3", camera), camera, {},
                              [](double fraction, std::string_view) { return fraction < 0.3; }));
}

// Clock, droop and combined perturbations.

PerturbedCamera of_clock(const Camera& camera, double clock_s) {
  return {.name = "clock", .camera = camera, .clock_s = clock_s};
}

TEST(Perturbations, TogetherCombineAllOfThem) {
  const Camera camera = built_in_camera("paper-10f0");
  RobustnessOptions options = nothing;
  options.bandwidth = 0.2;
  options.peak = 0.1;
  options.edge_jitter_s = 50e-12;
  options.tap_mismatch = 0.02;
  options.clock_s = 1e-9;
  options.droop = 0.03;
  options.together = true;
  const auto cameras = perturbations(camera, options);
  ASSERT_EQ(cameras.size(), 9u);
  const PerturbedCamera& all = cameras.back();
  EXPECT_EQ(all.name, "all together");
  EXPECT_NEAR(all.camera.light.impulse_response.f_max_hz,
              0.8 * camera.light.impulse_response.f_max_hz, 1.0);
  EXPECT_NEAR(all.peak, 0.9, 1e-12);
  EXPECT_EQ(all.camera.sensor.edge_jitter_s, 50e-12);
  EXPECT_EQ(all.camera.sensor.tap_mismatch, 0.02);
  EXPECT_EQ(all.clock_s, 1e-9);
  EXPECT_EQ(all.droop, 0.03);
}

TEST(PerturbedCode, SwitchesOnClockTicks) {
  const Camera camera = built_in_camera("paper-10f0");  // period 66.7 ns
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const double clock_s = 5e-9;
  const double points = std::floor(1.0 / (camera.fundamental_frequency_hz * clock_s));
  const CodeSet actual = perturbed_code(code, of_clock(camera, clock_s));
  const auto on_points = [&](const Waveform& w, const Waveform& nominal) {
    ASSERT_EQ(w.on_intervals().size(), nominal.on_intervals().size());
    for (std::size_t i = 0; i < w.on_intervals().size(); ++i) {
      const double rise = w.on_intervals()[i].rise * points;
      EXPECT_NEAR(rise, std::round(rise), 1e-9);
    }
  };
  for (int k = 0; k < 4; ++k) {
    on_points(actual.demodulation(k), code.demodulation(k));
    on_points(actual.modulation(k), code.modulation(k));
    EXPECT_LE(actual.modulation(k).mean(), 1.0 + 1e-12);
  }
  EXPECT_THROW(perturbed_code(code, of_clock(camera, 60e-9)), std::invalid_argument);
}

TEST(PerturbedCode, DroopsAfterEveryRise) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet square = build_family("square-k4", camera);  // on for half the period
  const PerturbedCamera droopy{.name = "droop", .camera = camera, .droop = 0.1};
  const CodeSet actual = perturbed_code(square, droopy);
  const Waveform& nominal = square.modulation(0);
  ASSERT_TRUE(nominal.is_binary());
  const double length = nominal.on_intervals()[0].fall - nominal.on_intervals()[0].rise;
  const double rate = -std::log(0.9) / 0.5;
  EXPECT_NEAR(actual.modulation(0).mean(), nominal.level() * (1 - std::exp(-rate * length)) / rate,
              1e-12);
  EXPECT_LT(actual.modulation(0).peak(), nominal.level());
  EXPECT_EQ(actual.demodulation(0), square.demodulation(0));
  // The last cell of a pulse of half a period is 10 % lower.
  const CodeSet half = CodeSet::create("half", 240, 1, {Waveform::binary({{0.0, 0.5}}, 2.0)},
                                       {Waveform::binary({{0.0, 0.5}})});
  const Eigen::VectorXd cells = perturbed_code(half, droopy).modulation(0).samples();
  EXPECT_NEAR(cells[119] / cells[0], 0.9, 1e-3);
  EXPECT_EQ(cells[120], 0.0);
}

TEST(PerturbedCode, WithoutAChangeEqualsTheCode) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  const CodeSet same = perturbed_code(code, {.name = "none", .camera = camera});
  for (int k = 0; k < 3; ++k) EXPECT_EQ(same.modulation(k), code.modulation(k));
}

TEST(Robustness, ReportsClockDroopAndCombination) {
  Camera camera = built_in_camera("paper-10f0");
  camera.operating.signal_e_per_s = {1e5};
  camera.operating.ambient_e_per_s = {1e4};
  RobustnessOptions options = nothing;
  options.clock_s = 2e-9;
  options.droop = 0.05;
  options.together = true;
  options.trials = 400;
  const RobustnessReport report =
      robustness(build_family("hamiltonian-k3", camera), camera, options);
  ASSERT_EQ(report.perturbed.size(), 3u);
  EXPECT_TRUE(report.perturbed[0].name.starts_with("clock 2.02 ns"));
  EXPECT_EQ(report.perturbed[1].name, "droop 5 %");
  for (const PerturbedError& p : report.perturbed) EXPECT_GT(p.calibrated_m.value, 0.0);
}

Camera full_resolution_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.operating.signal_e_per_s = {1e5};
  camera.operating.ambient_e_per_s = {1e3};
  return camera;
}

TEST(GeneratorLoss, IsZeroIfTheGeneratorReproducesTheCodeExactly) {
  Camera camera = full_resolution_camera();
  const CodeSet code = build_family("hamiltonian-k3", camera);
  camera.light.generator = camera.sensor.generator = Generator{.sample_rate_hz = 60 * 15e6};
  const GeneratorLoss loss = generator_loss(code, camera, {.trials = 400});
  EXPECT_NEAR(loss.ratio(DepthErrorKind::linear), 1.0, 1e-6);
  EXPECT_NEAR(loss.uncalibrated_ratio(DepthErrorKind::linear), 1.0, 1e-6);
  ASSERT_EQ(loss.correlation_change.size(), 3u);
  for (const double change : loss.correlation_change) EXPECT_LT(change, 1e-9);
}

TEST(GeneratorLoss, OfFewPointsEqualsThatOfEvaluateWithTheSameTrials) {
  Camera camera = full_resolution_camera();
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const EvaluateOptions options{.trials = 1000, .seed = 7};
  const double nominal_m = evaluate(code, camera, options).linear.geometric_mean_m.value;
  camera.light.generator = camera.sensor.generator = Generator{.sample_rate_hz = 16 * 15e6};
  const GeneratorLoss loss = generator_loss(code, camera, options);
  EXPECT_EQ(loss.nominal.linear.geometric_mean_m.value, nominal_m);
  EXPECT_EQ(loss.actual.linear.geometric_mean_m.value,
            evaluate(code, camera, options).linear.geometric_mean_m.value);
  EXPECT_GT(loss.uncalibrated_ratio(DepthErrorKind::linear), 1.05);
  EXPECT_GT(loss.uncalibrated_ratio(DepthErrorKind::linear), loss.ratio(DepthErrorKind::linear));
  for (const double change : loss.correlation_change) EXPECT_GT(change, 0.01);
}

}  // namespace

}  // namespace tofsmith
