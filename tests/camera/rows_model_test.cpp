// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/shared/periodic.hpp"
#include "rows_setup.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

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

TEST(RowsModel, ComplementaryGatesMeasureLikeExclusiveTaps) {
  Camera camera = rows_camera();
  camera.light.impulse_response = {.kind = ImpulseResponse::Kind::lowpass, .cutoff_hz = 20e6};
  camera.sensor.read_noise_e = 3.0;
  const CodeSet gates = build_family("histogram-k4", camera);
  Camera with_taps = camera;
  with_taps.sensor.readout = Readout::separate;
  with_taps.sensor.taps = 4;
  const CodeSet taps = CodeSet::create(
      "taps", 60, 4, {gates.modulation(0)},
      {gates.demodulation(0), gates.demodulation(1), gates.demodulation(2), gates.demodulation(3)});
  const ForwardModel rows(gates, camera), exclusive(taps, with_taps);
  for (const double depth_bin : {0.0, 7.25, 58.7}) {
    const Return seen{900.0, depth_bin};
    const Eigen::VectorXd expected = exclusive.expected_electrons({&seen, 1}, 300.0);
    EXPECT_LT((rows.expected_electrons({&seen, 1}, 300.0) - expected).norm(), 1e-6);
    const Eigen::MatrixXd variance = exclusive.variance_e2({&seen, 1}, 300.0).asDiagonal();
    EXPECT_LT((rows.covariance_e2({&seen, 1}, 300.0) - variance).norm(), 1e-6);
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

struct BadCamera {
  void (*change)(Camera&);
  const char* field;
};

TEST(RowsModel, UnsupportedSettingsAreRejectedByName) {
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
    try {
      camera.validate();
      FAIL() << bad.field;
    } catch (const InvalidArgument& error) {
      EXPECT_EQ(error.field(), bad.field);
    }
  }
}

}  // namespace
}  // namespace tofsmith
