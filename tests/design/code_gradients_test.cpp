// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/sampled_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/shared/random.hpp"
#include "each_target.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/design/code_gradients.hpp"
#include "tofsmith/simulate/bounds.hpp"

namespace tofsmith {

namespace {

// Values of CodeGradients, compared with the library, and their adjoints with finite differences.

constexpr int samples = 24, exposures = 3, pixels = 70;
constexpr int odd = 25;  // 100 depths, not a multiple of the vector length 8

std::vector<Waveform> waveforms_of(const Eigen::MatrixXd& columns) {
  std::vector<Waveform> waveforms;
  for (const auto& column : columns.colwise()) waveforms.push_back(Waveform::sampled(column));
  return waveforms;
}

CodeSet code_set(const Eigen::MatrixXd& modulation, const Eigen::MatrixXd& demodulation) {
  return CodeSet::create("code", static_cast<int>(modulation.rows()),
                         static_cast<int>(demodulation.cols() / modulation.cols()),
                         waveforms_of(modulation), waveforms_of(demodulation));
}

Camera camera_of(const char* name, Readout readout) {
  Camera camera = built_in_camera(name);
  camera.samples = samples;
  camera.sensor.taps = 2;
  camera.sensor.drain = false;
  camera.sensor.readout = readout;
  camera.sensor.dark_current_e_per_s = 500.0;
  return camera;
}

std::vector<Camera> cameras() {
  return {camera_of("paper-10f0", Readout::separate), camera_of("paper-10f0", Readout::difference),
          camera_of("paper-30x", Readout::separate)};
}

struct Setting {
  explicit Setting(const Camera& its)
      : camera(its),
        steps(camera, camera.samples, exposures),
        modulation(camera.samples, exposures),
        demodulation(camera.samples, 2 * exposures) {
    const int samples = camera.samples;
    RandomStream random(5, 1);
    for (int e = 0; e < exposures; ++e)
      for (int n = 0; n < samples; ++n) {
        const double turn = 2.0 * 3.14159265358979 * (double(n) / samples - e / 3.0);
        modulation(n, e) = std::exp(3.0 * std::cos(turn)) * (1.0 + 0.2 * random.uniform());
        demodulation(n, 2 * e) = 0.4 + 0.35 * std::cos(turn - 1.0) * (0.9 + 0.1 * random.uniform());
        demodulation(n, 2 * e + 1) = 1.0 - demodulation(n, 2 * e);
      }
    for (int e = 0; e < exposures; ++e) modulation.col(e) /= modulation.col(e).mean();
    table = steps.measure(modulation, demodulation);
    for (int p = 0; p < pixels; ++p) {
      depth_bin.push_back(samples * random.uniform());
      signal.push_back(1e5 * (0.5 + random.uniform()));
      ambient.push_back(1e4 * random.uniform());
      weight.push_back(random.uniform() - 0.5);
    }
  }
  PixelLight light() const { return {depth_bin, signal, ambient}; }

  Camera camera;
  CodeGradients steps;
  Eigen::MatrixXd modulation, demodulation;
  MeasurementTable table;
  std::vector<double> depth_bin, signal, ambient, weight;
};

/// Compares the slope of `value` along a random direction with the gradient. Functions linear in
/// the table allow large steps.
template <typename Value>
void expect_gradient(const MeasurementTable& table, const MeasurementTable& gradient,
                     const Value& value, double step = 3e-7) {
  RandomStream random(9, 2);
  for (int trial = 0; trial < 5; ++trial) {
    MeasurementTable ahead = table, behind = table;
    double slope = 0.0;
    const auto move = [&](auto& forward, auto& backward, const auto& by) {
      for (Eigen::Index i = 0; i < by.size(); ++i) {
        const double direction = random.uniform() - 0.5;
        forward.reshaped()[i] += step * direction;
        backward.reshaped()[i] -= step * direction;
        slope += by.reshaped()[i] * direction;
      }
    };
    move(ahead.correlation, behind.correlation, gradient.correlation);
    move(ahead.ambient_gain, behind.ambient_gain, gradient.ambient_gain);
    move(ahead.shot_correlation, behind.shot_correlation, gradient.shot_correlation);
    move(ahead.shot_ambient_gain, behind.shot_ambient_gain, gradient.shot_ambient_gain);
    const double difference = (value(ahead) - value(behind)) / (2.0 * step);
    EXPECT_NEAR(difference, slope, 1e-4 * std::abs(slope) + 1e-5 * std::abs(value(table)));
  }
}

TEST(CodeGradients, ValuesMatchTheLibrary) {
  for_each_target([] {
    for (const Camera& camera : cameras()) {
      const Setting setting(camera);
      const ForwardModel model(code_set(setting.modulation, setting.demodulation), camera);
      CodeGradients::Rows mean, variance;
      setting.steps.electrons(setting.table, setting.light(), mean, variance);
      for (int p = 0; p < pixels; ++p) {
        const auto at = static_cast<std::size_t>(p);
        const Return light{setting.signal[at], setting.depth_bin[at]};
        const Eigen::VectorXd expected = model.expected_electrons({&light, 1}, setting.ambient[at]);
        EXPECT_LT((mean.row(p).transpose() - expected).norm(), 1e-8 * expected.norm());
        const Eigen::VectorXd noise = model.variance_e2({&light, 1}, setting.ambient[at]);
        EXPECT_LT((variance.row(p).transpose() - noise).norm(), 1e-8 * noise.norm());
      }
      const OperatingPoint points[] = {{1e5, 1e4}, {1e4, 0.0}};
      const Eigen::MatrixXd deviation_m = setting.steps.depth_deviation_m(setting.table, points);
      const CramerRaoBound bound(model, camera, NoiseInformation::mean, 4);
      for (int l = 0; l < 2; ++l)
        EXPECT_TRUE(deviation_m.col(l).isApprox(bound.sigma_m(points[l]), 1e-8));
    }
  });
}

TEST(CodeGradients, AdjointsMatchFiniteDifferences) {
  for (const Camera& camera : cameras()) {
    const Setting setting(camera);
    const CodeGradients& steps = setting.steps;
    const int K = steps.measurements();
    RandomStream random(6, 3);
    CodeGradients::Rows by_mean(pixels, K), by_variance(pixels, K);
    for (double& w : by_mean.reshaped()) w = random.uniform() - 0.5;
    for (double& w : by_variance.reshaped()) w = random.uniform() - 0.5;
    const auto electrons = [&](const MeasurementTable& table) {
      CodeGradients::Rows mean, variance;
      steps.electrons(table, setting.light(), mean, variance);
      return mean.cwiseProduct(by_mean).sum() + variance.cwiseProduct(by_variance).sum();
    };
    expect_gradient(
        setting.table,
        steps.pull_back_electrons(setting.table, setting.light(), by_mean, by_variance).table,
        electrons, 1e-3);

    CodeGradients::Rows y, variance;
    steps.electrons(setting.table, setting.light(), y, variance);
    const std::span<const double> measured(y.data(), static_cast<std::size_t>(y.size()));
    const std::vector<double> temperature(pixels, 1e7);
    for (const bool circular : {false, true}) {
      const SoftDecoding decoding{temperature, circular};
      const auto decoded = [&](const MeasurementTable& table) {
        const auto depth_bin = steps.soft_decode(table, measured, decoding);
        double sum = 0.0;
        for (std::size_t p = 0; p < pixels; ++p) sum += setting.weight[p] * depth_bin[p];
        return sum;
      };
      expect_gradient(
          setting.table,
          steps.pull_back_decoded(setting.table, measured, decoding, {}, setting.weight).table,
          decoded);
    }

    const OperatingPoint points[] = {{1e5, 1e4}, {3e4, 1e3}};
    Eigen::MatrixXd by_deviation(4 * samples, 2);
    for (double& w : by_deviation.reshaped()) w = random.uniform();
    const auto bound = [&](const MeasurementTable& table) {
      return steps.depth_deviation_m(table, points).cwiseProduct(by_deviation).sum();
    };
    expect_gradient(setting.table,
                    steps.pull_back_depth_deviation(setting.table, points, by_deviation).table,
                    bound);
  }
}

TEST(CodeGradients, DepthsThatDoNotFillAVectorAreHandled) {
  for_each_target([] {
    Camera camera = cameras().front();
    camera.samples = odd;
    const Setting setting(camera);
    const CodeGradients& steps = setting.steps;
    const ForwardModel model(code_set(setting.modulation, setting.demodulation), camera);
    const CramerRaoBound bound(model, camera, NoiseInformation::mean, 4);
    const OperatingPoint points[] = {{1e5, 1e4}, {0.0, 1e4}};
    const Eigen::MatrixXd deviation_m = steps.depth_deviation_m(setting.table, points);
    ASSERT_EQ(deviation_m.rows(), 4 * odd);
    EXPECT_TRUE(deviation_m.col(0).isApprox(bound.sigma_m(points[0]), 1e-8));
    EXPECT_TRUE((deviation_m.col(1).array() == INFINITY).all()) << "no light tells no depth";
    const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(4 * odd, 2);
    const PixelGradient by = steps.pull_back_depth_deviation(setting.table, points, ones);
    expect_gradient(setting.table, by.table, [&](const MeasurementTable& moved) {
      return steps.depth_deviation_m(moved, points).col(0).sum();
    });
    EXPECT_EQ(by.signal_e_per_s[1], 0.0);
    EXPECT_EQ(by.ambient_e_per_s[1], 0.0);
  });
}

TEST(CodeGradients, RejectsCamerasWithoutGradient) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.tap_mismatch = 0.1;
  camera.sensor.taps = 2;
  EXPECT_THROW(CodeGradients(camera, samples, exposures), InvalidArgument);
  EXPECT_THROW(CodeGradients(built_in_camera("prototype"), samples, exposures), InvalidArgument);
  EXPECT_THROW(CodeGradients(built_in_camera("paper-10f0"), samples, 0), InvalidArgument);
}

// The camera that gradients use, compared with ForwardModel.

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

Camera uneven(Camera camera) {
  camera.sensor.tap_mismatch = 0.08;
  return camera;
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

TEST(SampledCamera, AgreesWithTheForwardModel) {
  for (const Camera& camera :
       {camera_with(1, Readout::separate, 1.0), camera_with(2, Readout::difference, 0.7),
        camera_with(3, Readout::separate, 0.6, "paper-30x"),
        uneven(camera_with(1, Readout::separate, 1.0)),
        uneven(camera_with(2, Readout::difference, 0.7)), analog_mixer()}) {
    const bool is_mixer = camera.sensor.demodulation == Demodulation::weight;
    const SampledCode code =
        is_mixer ? random_weights(40, 3) : random_code(40, 3, camera.sensor.taps);
    const CodeSet set = code_set(code.modulation, code.demodulation);
    const ForwardModel model(is_mixer ? set.signed_of_buckets() : set, camera);
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

/// Compares the derivative along a random direction with a central difference.
void expect_derivative(const SampledCamera& sampled, const SampledCode& code, double step,
                       double tolerance) {
  SampledCode direction = code;
  MeasurementTable weights = sampled.measure(code).table;
  RandomStream random(2, 0);
  for (Eigen::MatrixXd* m : {&weights.correlation, &weights.shot_correlation, &direction.modulation,
                             &direction.demodulation})
    for (double& v : m->reshaped()) v = random.normal();
  for (Eigen::VectorXd* m : {&weights.ambient_gain, &weights.shot_ambient_gain})
    for (double& v : m->reshaped()) v = random.normal();
  const auto value = [&](double by) {
    SampledCode moved = code;
    moved.modulation += by * direction.modulation;
    moved.demodulation += by * direction.demodulation;
    const MeasurementTable t = sampled.measure(moved).table;
    return t.correlation.cwiseProduct(weights.correlation).sum() +
           t.shot_correlation.cwiseProduct(weights.shot_correlation).sum() +
           t.ambient_gain.dot(weights.ambient_gain) +
           t.shot_ambient_gain.dot(weights.shot_ambient_gain);
  };
  const SampledCode gradient = sampled.pull_back(sampled.measure(code), weights);
  EXPECT_NEAR(gradient.modulation.cwiseProduct(direction.modulation).sum() +
                  gradient.demodulation.cwiseProduct(direction.demodulation).sum(),
              (value(step) - value(-step)) / (2.0 * step), tolerance);
}

TEST(SampledCamera, GradientIsTheDerivativeAlongEveryDirection) {
  // Bilinear in the waveforms: central differences are exact.
  expect_derivative(SampledCamera(camera_with(2, Readout::difference, 0.7), 40, 3),
                    random_code(40, 3, 2), 0.5, 1e-9);
  // The gradient of a mixer includes the squares of its weights.
  expect_derivative(SampledCamera(analog_mixer(), 40, 3), random_weights(40, 3), 1e-4, 1e-6);
}

}  // namespace

}  // namespace tofsmith
