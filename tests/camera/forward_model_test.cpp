// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/forward_model.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "code/shared/family_members.hpp"
#include "core/shared/periodic.hpp"
#include "refusal.hpp"
#include "rows_setup.hpp"
#include "tofsmith/code/families.hpp"

namespace tofsmith {

namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Reference: Equation (3) on a fine grid, by plain sums.
Eigen::VectorXd correlation_by_sums(const Waveform& d, const Waveform& m, int points) {
  return circular_correlation(d.cell_averages(points), m.cell_averages(points)) / points;
}

TEST(CorrelationFunction, IsExactBetweenBins) {
  const CodeSet code = make_family("hamiltonian-k4", {.samples = 240, .peak_factor = 7.0});
  for (int k = 0; k < 4; ++k) {
    const CorrelationFunction chi(code.demodulation(k), code.modulation(k));
    const Eigen::VectorXd fine =
        correlation_by_sums(code.demodulation(k), code.modulation(k), 8400);
    for (int j = 0; j < 8400; j += 7) EXPECT_NEAR(chi(j / 8400.0), fine[j], 1e-9);
    EXPECT_LT((chi.table(8400) - fine).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(CorrelationFunction, IdealHamiltonianCodeMovesFromVertexToVertex) {
  const auto walk = hamiltonian_walk(3);
  const Camera camera = built_in_camera("paper-30x");
  const ForwardModel model(build_family("hamiltonian-k3", camera), camera);
  // Peak 30 does not shorten the pulse: the ideal pulse of K = 3 needs a peak of 6 only.
  for (int n = 0; n < 6; ++n)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(model.correlation(40.0 * n)[k], (walk[static_cast<std::size_t>(n)] >> k) & 1,
                  1e-9);
}

TEST(ForwardModel, TheTableContainsTheFunctionAtItsBins) {
  for (const char* camera_name : {"paper-30x", "paper-10f0"}) {
    const Camera camera = built_in_camera(camera_name);
    const ForwardModel model(build_family("hamiltonian-k5", camera), camera);
    const Eigen::MatrixXd table = model.correlation_table(480);
    for (int j = 0; j < 480; j += 13)
      EXPECT_LT((table.row(j).transpose() - model.correlation(j * 0.5)).cwiseAbs().maxCoeff(),
                1e-9);
  }
}

TEST(ForwardModel, OutputsRespectTheBoundsOfTheInputs) {
  const Camera camera = built_in_camera("paper-5f0");
  for (const char* name : {"hamiltonian-k5", "square-k4", "sinusoid-k3"}) {
    const Eigen::MatrixXd table =
        ForwardModel(build_family(name, camera), camera).correlation_table(960);
    EXPECT_GE(table.minCoeff(), -1e-9) << name;
    EXPECT_LE(table.maxCoeff(), 1 + 1e-9) << name;
  }
}

TEST(ForwardModel, ReturnsAreAdditive) {
  const Camera camera = built_in_camera("paper-10f0");
  const ForwardModel model(build_family("hamiltonian-k3", camera), camera);
  const Return first{1e4, 33.3}, second{3e3, 80.0};
  const Return both[] = {first, second};
  const Eigen::VectorXd sum = model.expected_electrons(std::span(&first, 1), 1e3) +
                              model.expected_electrons(std::span(&second, 1), 1e3) -
                              model.expected_electrons({}, 1e3);
  EXPECT_LT((model.expected_electrons(both, 1e3) - sum).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(ForwardModel, MeanFollowsEquationFour) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.dark_current_e_per_s = 50.0;
  const ForwardModel model(build_family("hamiltonian-k3", camera), camera);
  const Return r{2e4, 77.7};
  const Eigen::VectorXd expected = 0.1 * (2e4 * model.correlation(77.7).array() + 1e3 * 0.5 + 50.0);
  EXPECT_LT((model.expected_electrons(std::span(&r, 1), 1e3) - expected).cwiseAbs().maxCoeff(),
            1e-9);
  const Eigen::VectorXd variance = expected.array() + 20.0 * 20.0;
  EXPECT_LT((model.variance_e2(std::span(&r, 1), 1e3) - variance).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(ForwardModel, DifferenceCancelsTheAmbientMeanButNotItsNoise) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  camera.sensor.readout = Readout::difference;
  const ForwardModel model(build_family("hamiltonian-k4", camera), camera);
  EXPECT_EQ(model.measurements(), 4);
  EXPECT_LT(model.expected_electrons({}, 1e5).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(model.variance_e2({}, 1e5)[0], 1e5 * 0.3 / 4 + 2 * 400.0, 1e-6);
}

TEST(ForwardModel, ContrastMixesTaps) {
  Camera camera = built_in_camera("paper-30x");
  camera.sensor.taps = 2;
  camera.sensor.modulation_contrast = 0.6;
  const ForwardModel model(build_family("hamiltonian-k3", camera), camera);
  const Eigen::MatrixXd chi = model.correlation_table(240);
  EXPECT_NEAR(chi.maxCoeff(), 0.8, 1e-9);
  EXPECT_NEAR(chi.minCoeff(), 0.2, 1e-9);
}

TEST(ForwardModel, ContrastMayDifferPerExposureOrPerFrequency) {
  Camera camera = built_in_camera("paper-30x");
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  camera.sensor.taps = 2;
  camera.sensor.readout = Readout::difference;
  const auto amplitudes = [&](std::vector<double> contrasts) {
    camera.sensor.modulation_contrasts = std::move(contrasts);
    const ForwardModel model(build_family("multifrequency-1x3-5x2", camera), camera);
    return model.correlation_table(480).colwise().maxCoeff().eval();
  };
  const Eigen::RowVectorXd full = amplitudes({});
  const Eigen::RowVectorXd expected =
      full.cwiseProduct((Eigen::RowVectorXd(5) << 0.9, 0.9, 0.9, 0.4, 0.4).finished());
  EXPECT_LT((amplitudes({0.9, 0.4}) - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((amplitudes({0.9, 0.9, 0.9, 0.4, 0.4}) - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_THAT(refusal_of([&] {
                amplitudes({0.9, 0.8, 0.7});
              }),
              HasSubstr("5 exposures or the 2 frequencies"));
}

TEST(ForwardModel, OffsetMayDifferPerExposureOrPerFrequency) {
  Camera camera = built_in_camera("paper-30x");
  camera.sensor.taps = 2;
  camera.sensor.readout = Readout::difference;
  const CodeSet code = build_family("multifrequency-1x3-5x2", camera);
  const auto correlation = [&](const Playback& playback, double depth_bin) {
    camera.playback = playback;
    return ForwardModel(code, camera).correlation(depth_bin);
  };
  // 24 bins are a tenth of the range; 5 f0 has a fifth of the period.
  const double bin_m = camera.bin_m();
  const Eigen::VectorXd first = correlation({}, 100.0 + 24.0),
                        second = correlation({}, 100.0 - 6.0);
  Eigen::VectorXd expected(5);
  expected << first.head(3), second.tail(2);
  const double turn = 2 * std::numbers::pi;
  for (const Playback& playback :
       {Playback{.offsets_m = {24 * bin_m, -6 * bin_m}},
        Playback{.offsets_m = {24 * bin_m, 24 * bin_m, 24 * bin_m, -6 * bin_m, -6 * bin_m}},
        Playback{.offset_rad = {0.1 * turn, -0.125 * turn}},
        Playback{.offset_counts = {409.6, -512}},
        Playback{.offset_counts = {100, -125}, .counts_per_period = 1000}})
    EXPECT_LT((correlation(playback, 100.0) - expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_THAT(refusal_of([&] {
                correlation({.offset_rad = {1, 2, 3}}, 0.0);
              }),
              HasSubstr("number of playback.offset_rad = 3; must equal the 5 exposures or the 2 "
                        "frequencies"));
  EXPECT_THAT(refusal_of([&] {
                correlation({.offset_m = 1.0, .offset_rad = {1, 2}}, 0.0);
              }),
              HasSubstr("must be the only one of offset_m, offset_rad and offset_counts"));
}

TEST(ForwardModel, WithoutADrainEveryElectronGoesToATap) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  camera.sensor.drain = false;
  EXPECT_NO_THROW(ForwardModel(build_family("hamiltonian-k3", camera), camera));
  const Waveform half = square_wave(1, 0.0), quarter = Waveform::binary({{0.5, 0.75}});
  const CodeSet leaky =
      CodeSet::create("leaky", camera.samples, 2, {rectangular_pulse(0.1)}, {half, quarter});
  EXPECT_THROW(require_fits(leaky, camera), std::invalid_argument);
  camera.sensor.drain = true;
  EXPECT_NO_THROW(require_fits(leaky, camera));
}

TEST(WhyNotPlayable, ReturnsTheMessageOfTheCheck) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet fits = build_family("hamiltonian-k3", camera);
  Camera two_taps = camera, coarse = camera, gentle = camera, listed = camera, slow = camera;
  two_taps.sensor.taps = 2;
  coarse.samples = 120;
  gentle.light.peak_factor = 1.5;
  listed.exposure_s.each_s = {0.1, 0.1};
  slow.light.generator = Generator{.sample_rate_hz = 2 * camera.fundamental_frequency_hz};
  EXPECT_EQ(why_not_playable(fits, camera), std::nullopt);
  for (const Camera& other : {two_taps, coarse, gentle, listed, slow}) {
    const std::optional<std::string> why = why_not_playable(fits, other);
    EXPECT_TRUE(why.has_value());
    EXPECT_EQ(why, refusal_of([&] { require_fits(fits, other); }));
    EXPECT_EQ(why, refusal_of([&] { ForwardModel(fits, other); }));
  }
}

TEST(WhyNoFamily, ReturnsTheMessageOfBuilding) {
  Camera camera = built_in_camera("paper-10f0");
  for (const char* name : {"hamiltonian-k4", "hamiltonian-k5", "hamiltonian-k11", "hamiltonean-k3",
                           "gray-k3", "gray-k9", "square-k7", "sinusoid-k1", "multifrequency-k5",
                           "multifrequency-0x3", "pulsed-multifrequency-k5-q1", "single-ramp-k3"})
    EXPECT_EQ(why_no_family(name, camera).value_or("accepted"),
              refusal_of([&] { build_family(name, camera); }))
        << name;
  EXPECT_EQ(why_no_family("hamiltonian-k4", camera), std::nullopt);
  EXPECT_NE(why_no_family("hamiltonian-k11", camera), std::nullopt);
  camera.sensor.taps = 3;
  EXPECT_EQ(why_no_family("gray-k3", camera), refusal_of([&] { build_family("gray-k3", camera); }));
}

TEST(ImpulseResponse, HannAttenuatesByFiveAtItsLimit) {
  ImpulseResponse hann{.kind = ImpulseResponse::Kind::hann, .f_max_hz = 150e6};
  EXPECT_NEAR(hann.transfer(150e6).real(), 0.2, 1e-12);
  EXPECT_NEAR(hann.transfer(0).real(), 1.0, 1e-12);
}

TEST(ImpulseResponse, CutoffIsMinusThreeDecibels) {
  for (const auto kind : {ImpulseResponse::Kind::gaussian, ImpulseResponse::Kind::lowpass}) {
    const ImpulseResponse response{.kind = kind, .cutoff_hz = 80e6};
    EXPECT_NEAR(std::norm(response.transfer(80e6)), 0.5, 1e-12);
  }
}

TEST(ImpulseResponse, MeasuredExponentialIsALowPass) {
  ImpulseResponse measured{.kind = ImpulseResponse::Kind::file, .time_step_s = 1e-12};
  const double time_constant_s = 2e-9;
  for (int i = 0; i < 40000; ++i)
    measured.samples.push_back(std::exp(-i * 1e-12 / time_constant_s));
  const ImpulseResponse lowpass{.kind = ImpulseResponse::Kind::lowpass,
                                .cutoff_hz = 1 / (2 * M_PI * time_constant_s)};
  for (const double f : {0.0, 15e6, 60e6, 150e6})
    EXPECT_LT(std::abs(measured.transfer(f) - lowpass.transfer(f)), 2e-3);
}

TEST(ImpulseResponse, MeasuredSamplesPassNothingAboveHalfTheirRate) {
  // A triangle of 10 ns, sampled as coarsely as by an oscilloscope.
  ImpulseResponse measured{.kind = ImpulseResponse::Kind::file, .time_step_s = 1e-9};
  for (int i = 0; i <= 10; ++i) measured.samples.push_back(i <= 5 ? i : 10 - i);
  for (const double f : {0.51e9, 1e9, 2e9, 10e9})
    EXPECT_EQ(std::abs(measured.transfer(f)), 0.0) << f;
  // The transform of a triangle is a squared sinc.
  for (const double f : {15e6, 60e6, 150e6}) {
    const double x = M_PI * f * 5e-9;
    EXPECT_NEAR(std::abs(measured.transfer(f)), std::pow(std::sin(x) / x, 2), 1e-9) << f;
  }
}

TEST(Camera, NamesTheFieldTheValueAndTheRule) {
  const auto message = [](auto change) {
    Camera camera = built_in_camera("paper-10f0");
    change(camera);
    return refusal_of([&] { camera.validate(); });
  };
  EXPECT_EQ(
      message([](Camera& c) { c.light.peak_factor = 0.5; }),
      "light.peak_factor = 0.5; must be finite and >= 1: the peak is never below the average");
  EXPECT_EQ(message([](Camera& c) { c.sensor.read_noise_e = -1; }),
            "sensor.read_noise_e = -1; must be finite and >= 0");
  EXPECT_EQ(message([](Camera& c) { c.sensor.impulse_response.f_max_hz = 0; }),
            "sensor.impulse_response.f_max_hz = 0; must be finite and > 0");
  EXPECT_EQ(
      message([](Camera& c) { c.fundamental_frequency_hz = std::nan(""); }),
      "fundamental_frequency_hz = nan; must be finite and >= 1000: it is in Hz, 20 MHz are 20e6");
  EXPECT_EQ(message([](Camera& c) { c.sensor.adc_bits = 12; }),
            "sensor.adc_bits = 12; requires sensor.gain_e_per_dn");
  EXPECT_EQ(message([](Camera& c) { c.operating.ambient_e_per_s.clear(); }),
            "operating.ambient_e_per_s = []; must list at least one level");
}

TEST(Camera, RangeFollowsTheFrequency) {
  EXPECT_NEAR(built_in_camera("paper-10f0").range_m(), 9.993, 1e-3);
}

TEST(RowsModel, BinsTogetherContainAllLight) {
  for (const auto kind : {ImpulseResponse::Kind::none, ImpulseResponse::Kind::gaussian}) {
    Camera camera = rows_camera();
    camera.light.impulse_response.kind = kind;
    camera.sensor.dark_current_e_per_s = 50.0;
    const ForwardModel model(build_family("hamiltonian-k4", camera), camera);
    EXPECT_EQ(model.tap_values(), 60);
    for (const double depth_bin : {0.0, 3.3, 59.9})
      EXPECT_NEAR(bins_e(model, depth_bin, 700.0, 200.0).sum(), 950.0, 1e-6);
  }
}

TEST(RowsModel, BinsAreTheConvolvedLight) {
  Camera camera = rows_camera(64);
  camera.light.impulse_response.kind = ImpulseResponse::Kind::none;
  const CodeSet code = build_family("gray-k3", camera);
  const ForwardModel model(code, camera);
  const Eigen::VectorXd light = code.modulation(0).cell_averages(64) / 64;
  for (const int depth : {0, 5, 63})
    EXPECT_LT((bins_e(model, depth, 1.0, 0.0) - circular_shift(light, depth)).norm(), 1e-12);
}

TEST(RowsModel, MeasurementsAreWeightedSumsOfTheBins) {
  Camera camera = rows_camera();
  camera.sensor.read_noise_e = 3.0;
  camera.sensor.dark_current_e_per_s = 50.0;
  for (const char* name : {"fourier-k6", "histogram-k5", "hamiltonian-k3", "single-ramp-k3"}) {
    if (why_no_family(name, camera)) continue;
    const CodeSet code = build_family(name, camera);
    const ForwardModel model(code, camera);
    const Eigen::MatrixXd weights = code.demodulation_samples();
    for (const double depth_bin : {0.0, 7.25, 58.7}) {
      const Return seen{900.0, depth_bin};
      const Eigen::VectorXd h = bins_e(model, depth_bin, 900.0, 300.0);
      const Eigen::VectorXd mean = weights.transpose() * h;
      Eigen::MatrixXd covariance = weights.transpose() * h.asDiagonal() * weights;
      covariance.diagonal().array() += 9.0;
      EXPECT_LT((model.expected_electrons({&seen, 1}, 300.0) - mean).norm(), 1e-6 * mean.norm());
      EXPECT_LT((model.covariance_e2({&seen, 1}, 300.0) - covariance).norm(), 1e-9);
      EXPECT_LT((model.variance_e2({&seen, 1}, 300.0) - covariance.diagonal()).norm(), 1e-9);
      // Correlations of rows and bins are both computed from harmonics.
      EXPECT_LT((900.0 * model.correlation(depth_bin) + 300.0 * model.ambient_gain() +
                 model.dark_electrons() - mean)
                    .norm(),
                1e-6 * mean.norm());
    }
  }
}

TEST(RowsModel, TheCovarianceTableIsTheCovarianceAtItsPoints) {
  Camera camera = rows_camera();
  camera.sensor.read_noise_e = 2.0;
  const ForwardModel model(build_family("hamiltonian-k4", camera), camera);
  const RowCovariance table = row_covariance(model, 240);
  for (const int j : {0, 1, 7, 120, 239}) {
    const Return seen{500.0, 0.25 * j};
    EXPECT_LT((table.at(j, 500.0, 100.0) - model.covariance_e2({&seen, 1}, 100.0)).norm(), 1e-8);
  }
}

TEST(RowsModel, ADelayedDetectionAppearsFartherAway) {
  Camera camera = rows_camera();
  camera.sensor.impulse_response = {.kind = ImpulseResponse::Kind::lowpass, .cutoff_hz = 10e6};
  const CodeSet code = build_family("fourier-k4", camera);
  const Eigen::VectorXd slow = bins_e(ForwardModel(code, camera), 10.0, 1.0, 0.0);
  camera.sensor.impulse_response = {};
  const Eigen::VectorXd fast = bins_e(ForwardModel(code, camera), 10.0, 1.0, 0.0);
  const Eigen::VectorXd bins = Eigen::VectorXd::LinSpaced(60, 0, 59);
  EXPECT_GT(bins.dot(slow), bins.dot(fast) + 1.0);
}

TEST(RowsModel, RowsAndTapsAreNotInterchangeable) {
  const Camera rows = rows_camera(), taps = built_in_camera("paper-10f0");
  const CodeSet code = build_family("fourier-k4", rows);
  EXPECT_EQ(
      why_not_playable(code.resampled(240), taps),
      "code fourier-k4 receiver = rows of one exposure; requires a camera with sensor.readout = "
      "\"rows\"");
  EXPECT_TRUE(why_no_family("fourier-k4", taps));
  EXPECT_TRUE(why_not_playable(make_family("hamiltonian-k4", {.samples = 60}), rows));
  EXPECT_FALSE(why_no_family("hamiltonian-k4", rows));
  EXPECT_TRUE(why_no_family("multifrequency-k5", rows));  // its light differs between exposures
}

TEST(RowsModel, ReportsWhyNoFamilyCanBeBuilt) {
  Camera camera = rows_camera();
  camera.exposure_s.each_s = {0.1, 0.1};
  EXPECT_EQ(why_no_family("hamiltonian-k4", camera),
            "number of exposure_s = 2; must equal the 1 exposures of code hamiltonian-k4");
}

TEST(RowsModel, UnsupportedSettingsAreRejectedByName) {
  struct BadCamera {
    void (*change)(Camera&);
    const char* field;
  };
  for (const BadCamera& bad :
       {BadCamera{[](Camera& c) { c.sensor.taps = 2; }, "sensor.taps"},
        BadCamera{[](Camera& c) { c.sensor.tap_mismatch = 0.1; }, "sensor.tap_mismatch"},
        BadCamera{[](Camera& c) { c.sensor.full_well_e = 1e4; }, "sensor.full_well_e"},
        BadCamera{[](Camera& c) { c.sensor.adc_bits = 8, c.sensor.gain_e_per_dn = 1.0; },
                  "sensor.adc_bits"},
        BadCamera{[](Camera& c) { c.sensor.generator = Generator{}; }, "sensor.generator"},
        BadCamera{[](Camera& c) { c.samples = 8192; }, "samples"},
        BadCamera{[](Camera& c) { c.playback = Playback{.inverted = true}; }, "playback"}}) {
    Camera camera = rows_camera();
    bad.change(camera);
    EXPECT_THAT(refusal_of([&] { camera.validate(); }),
                StartsWith(fmt::format("{} = ", bad.field)));
  }
}

}  // namespace

}  // namespace tofsmith
