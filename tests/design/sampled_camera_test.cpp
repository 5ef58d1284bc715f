// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/sampled_camera.hpp"

#include <gtest/gtest.h>

#include "core/shared/random.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {
namespace {

Camera camera_with(int taps, Readout readout, double contrast, const char* name = "paper-10f0") {
  Camera camera = built_in_camera(name);
  camera.samples = 40;
  camera.sensor.taps = taps;
  camera.sensor.readout = readout;
  camera.sensor.modulation_contrast = contrast;
  return camera;
}

SampledCode random_code(int samples, int exposures, int taps) {
  RandomStream random(9, 0);
  SampledCode code{Eigen::MatrixXd(samples, exposures), Eigen::MatrixXd(samples, exposures * taps)};
  for (double& m : code.modulation.reshaped()) m = 2 * random.uniform();
  for (Eigen::Index e = 0; e < exposures; ++e)
    code.modulation.col(e) /= code.modulation.col(e).mean();
  for (double& d : code.demodulation.reshaped()) d = random.uniform() / taps;
  return code;
}

CodeSet code_set(const SampledCode& code, int taps) {
  std::vector<Waveform> m, d;
  for (Eigen::Index e = 0; e < code.modulation.cols(); ++e)
    m.push_back(Waveform::sampled(code.modulation.col(e)));
  for (Eigen::Index i = 0; i < code.demodulation.cols(); ++i)
    d.push_back(Waveform::sampled(code.demodulation.col(i)));
  return CodeSet::create("random", code.samples(), taps, m, d);
}

Camera uneven(Camera camera) {
  camera.sensor.tap_mismatch = 0.08;
  return camera;
}

TEST(SampledCamera, AgreesWithTheForwardModel) {
  for (const Camera& camera :
       {camera_with(1, Readout::separate, 1.0), camera_with(2, Readout::difference, 0.7),
        camera_with(3, Readout::separate, 0.6, "paper-30x"),
        uneven(camera_with(1, Readout::separate, 1.0)),
        uneven(camera_with(2, Readout::difference, 0.7))}) {
    const SampledCode code = random_code(40, 3, camera.sensor.taps);
    const ForwardModel model(code_set(code, camera.sensor.taps), camera);
    const SampledCamera sampled(camera, 40, 3);
    const MeasurementTable table = sampled.measure(code).table;
    EXPECT_LT((table.correlation - model.correlation_table(40)).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT((table.ambient_gain - model.ambient_gain()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((sampled.exposure_s() - model.exposure_s()).cwiseAbs().maxCoeff(), 1e-15);
    const Return light{3e4, 17.0};
    const Eigen::VectorXd variance =
        sampled.exposure_s().cwiseProduct(3e4 * table.shot().row(17).transpose() +
                                          2e4 * table.shot_ambient()) +
        sampled.constant_variance_e2();
    EXPECT_LT((variance - model.variance_e2({&light, 1}, 2e4)).cwiseAbs().maxCoeff(), 0.02);
  }
}

TEST(SampledCamera, AccountsForAmbientLightLeakedByUnevenBuckets) {
  Camera camera = camera_with(2, Readout::difference, 1.0);
  EXPECT_FALSE(SampledCamera(camera, 40, 3).ambient_unknown());
  EXPECT_TRUE(SampledCamera(uneven(camera), 40, 3).ambient_unknown());
  // As in a decoder, leakage well below the noise is ignored.
  camera.sensor.tap_mismatch = 1e-5;
  EXPECT_FALSE(SampledCamera(camera, 40, 3).ambient_unknown());
  for (const double mismatch : {1e-5, 0.08}) {
    camera.sensor.tap_mismatch = mismatch;
    const ForwardModel model(build_family("square-k4", camera), camera);
    EXPECT_EQ(sees_ambient(camera, 4), !unknown_ambient_gain(model, camera).isZero(0.0));
  }
}

/// Weights of a mixer as two buckets.
SampledCode random_weights(int samples, int exposures) {
  SampledCode code = random_code(samples, exposures, 2);
  for (int e = 0; e < exposures; ++e)
    code.demodulation.col(2 * e + 1) = 1.0 - code.demodulation.col(2 * e).array();
  return code;
}

Camera analog_mixer() {
  Camera camera = camera_with(1, Readout::separate, 0.7);
  camera.sensor.demodulation = Demodulation::weight;
  camera.sensor.modulation_contrast = 0.7;
  camera.sensor.dark_current_e_per_s = 400.0;
  camera.sensor.binary = false;
  return camera;
}

TEST(SampledCamera, AgreesWithTheForwardModelForAMixer) {
  const Camera camera = analog_mixer();
  const SampledCode code = random_weights(40, 3);
  const ForwardModel model(code_set(code, 2).signed_of_buckets(), camera);
  const SampledCamera sampled(camera, 40, 3);
  const MeasurementTable table = sampled.measure(code).table;
  EXPECT_LT((table.correlation - model.correlation_table(40)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((table.ambient_gain - model.ambient_gain()).cwiseAbs().maxCoeff(), 1e-12);
  const Return light{3e4, 17.0};
  const Eigen::VectorXd variance =
      sampled.exposure_s().cwiseProduct(3e4 * table.shot().row(17).transpose() +
                                        2e4 * table.shot_ambient()) +
      sampled.constant_variance_e2();
  EXPECT_LT((variance - model.variance_e2({&light, 1}, 2e4)).cwiseAbs().maxCoeff(), 0.02);
}

TEST(SampledCamera, GradientIncludesTheSquaresOfWeights) {
  const SampledCamera sampled(analog_mixer(), 40, 3);
  SampledCode code = random_weights(40, 3), direction = code;
  MeasurementTable weights = sampled.measure(code).table;
  RandomStream random(3, 0);
  for (Eigen::MatrixXd* m : {&weights.correlation, &weights.shot_correlation, &direction.modulation,
                             &direction.demodulation})
    for (double& v : m->reshaped()) v = random.normal();
  const auto value = [&](double step) {
    SampledCode moved = code;
    moved.modulation += step * direction.modulation;
    moved.demodulation += step * direction.demodulation;
    const MeasurementTable t = sampled.measure(moved).table;
    return t.correlation.cwiseProduct(weights.correlation).sum() +
           t.shot_correlation.cwiseProduct(weights.shot_correlation).sum() +
           t.ambient_gain.dot(weights.ambient_gain) +
           t.shot_ambient_gain.dot(weights.shot_ambient_gain);
  };
  const SampledCode gradient = sampled.pull_back(sampled.measure(code), weights);
  constexpr double step = 1e-4;
  EXPECT_NEAR(gradient.modulation.cwiseProduct(direction.modulation).sum() +
                  gradient.demodulation.cwiseProduct(direction.demodulation).sum(),
              (value(step) - value(-step)) / (2 * step), 1e-6);
}

TEST(SampledCamera, GradientIsTheDerivativeAlongEveryDirection) {
  const Camera camera = camera_with(2, Readout::difference, 0.7);
  const SampledCamera sampled(camera, 40, 3);
  SampledCode code = random_code(40, 3, 2), direction = code;
  MeasurementTable weights = sampled.measure(code).table;
  RandomStream random(2, 0);
  for (Eigen::MatrixXd* m : {&weights.correlation, &weights.shot_correlation, &direction.modulation,
                             &direction.demodulation})
    for (double& v : m->reshaped()) v = random.normal();
  for (Eigen::VectorXd* m : {&weights.ambient_gain, &weights.shot_ambient_gain})
    for (double& v : m->reshaped()) v = random.normal();
  const auto value = [&](double step) {
    SampledCode moved = code;
    moved.modulation += step * direction.modulation;
    moved.demodulation += step * direction.demodulation;
    const MeasurementTable t = sampled.measure(moved).table;
    return t.correlation.cwiseProduct(weights.correlation).sum() +
           t.shot_correlation.cwiseProduct(weights.shot_correlation).sum() +
           t.ambient_gain.dot(weights.ambient_gain) +
           t.shot_ambient_gain.dot(weights.shot_ambient_gain);
  };
  const SampledCode gradient = sampled.pull_back(sampled.measure(code), weights);
  // Bilinear in the waveforms: central differences are exact.
  EXPECT_NEAR(gradient.modulation.cwiseProduct(direction.modulation).sum() +
                  gradient.demodulation.cwiseProduct(direction.demodulation).sum(),
              (value(0.5) - value(-0.5)), 1e-9);
}

}  // namespace
}  // namespace tofsmith
