// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/depth_error_loss.hpp"

#include <gtest/gtest.h>

#include "design/optimize/design_problem.hpp"
#include "design/optimize/optimize_pool.hpp"
#include "design/optimize/optimize_starts.hpp"
#include "each_target.hpp"
#include "reference_depth_loss.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/families.hpp"

namespace tofsmith {

namespace {

/// A camera, a smooth code of unequal duties on a small grid, and trials.
struct Setting {
  explicit Setting(int taps = 1, Readout readout = Readout::separate, double contrast = 1.0)
      : camera(built_in_camera("paper-10f0")) {
    camera.sensor.taps = taps;
    camera.sensor.readout = readout;
    camera.sensor.modulation_contrast = contrast;
    camera.sensor.dark_current_e_per_s = 50.0;
    camera.exposure_s.each_s = {0.05, 0.1, 0.07, 0.08};
    const int exposures = 4, samples = 24;
    RandomStream random(3, 1);
    code.modulation = Eigen::MatrixXd(samples, exposures);
    code.demodulation = Eigen::MatrixXd(samples, exposures * taps);
    for (double& m : code.modulation.reshaped()) m = 2.0 * random.uniform();
    for (double& d : code.demodulation.reshaped()) d = random.uniform() / taps;
    for (int e = 0; e < exposures; ++e)
      for (int n = 0; n < samples; ++n)
        code.demodulation(n, e * taps) += (n * (e + 1) / 12 + e) % 2 == 0 ? 0.4 : 0.0;
  }
  SampledCamera sampled() const { return {camera, code.samples(), 4}; }

  Camera camera;
  SampledCode code;
  OperatingPoint point{2e4, 1e4};
};

TrialBatch trials_for(const Setting& setting, int count, bool ends_matter = false,
                      bool later = false, const DepthPrior& depths = {}) {
  RandomStream random(7, 2);
  OperatingRange range;
  range.uniform_albedo = true;
  const MultipathTrials second{{}, setting.camera.range_m()};
  return draw_trials(count, setting.sampled().measurements(), range, ends_matter, random, nullptr,
                     later ? &second : nullptr, depths);
}

TrialBatch only(TrialBatch batch, std::size_t t) {
  const double* normals = batch.normals_of(t);
  batch.normals = std::vector<double>(normals, normals + batch.measurements);
  batch.trials = {batch.trials[t]};
  return batch;
}

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all = {Setting(), Setting(2),
                                           Setting(2, Readout::difference, 0.8), Setting(3)};
  return all;
}

TEST(DepthErrorLoss, EqualsTheReferenceOnEveryTarget) {
  for_each_target([] {
    for (const Setting& setting : settings())
      for (const DepthErrorKind kind : {DepthErrorKind::linear, DepthErrorKind::circular}) {
        const SampledCamera camera = setting.sampled();
        const MeasurementTable table = camera.measure(setting.code).table;
        const TrialBatch batch = trials_for(setting, 40, kind == DepthErrorKind::linear,
                                            kind == DepthErrorKind::circular);
        DepthErrorLoss loss(camera, table, kind);
        const double sharpness = 1.5 / loss.mean_variance_e2(setting.point);
        const double expected = reference_soft_error(camera, table, setting.point, batch, sharpness,
                                                     kind == DepthErrorKind::circular);
        EXPECT_NEAR(loss.soft_error(setting.point, batch, sharpness), expected, 2e-4 * expected);
        EXPECT_NEAR(loss.soft_error(setting.point, batch, sharpness, 0.5), expected,
                    2e-4 * expected);
      }
  });
}

TEST(DepthErrorLoss, DecodesToTheBestPointNextToTheBestBin) {
  for_each_target([] {
    for (const Setting& setting : settings()) {
      const SampledCamera camera = setting.sampled();
      const MeasurementTable table = camera.measure(setting.code).table;
      DepthErrorLoss loss(camera, table, DepthErrorKind::circular);
      TrialBatch batch = trials_for(setting, 100);
      std::vector<double> decoded;
      loss.decode(setting.point, batch, decoded);
      for (std::size_t t = 0; t < decoded.size(); ++t) {
        const TrialBatch one = only(batch, t);
        double expected = 0.0;
        reference_soft_error(camera, table, setting.point, one, 1.0, true, &expected);
        EXPECT_NEAR(decoded[t], expected, 5e-3);  // single precision, at a flat maximum
      }
    }
  });
}

/// Compares the gradient with central differences along random directions of light, of gates, and
/// of both.
template <typename ErrorOf>
void expect_slopes(const Setting& setting, const SampledCode& gradient, ErrorOf&& error_of) {
  RandomStream random(11, 5);
  for (int direction = 0; direction < 4; ++direction) {
    SampledCode along = setting.code;
    for (double& m : along.modulation.reshaped()) m = random.normal();
    for (double& d : along.demodulation.reshaped()) d = random.normal();
    if (direction == 0) along.modulation.setZero();
    if (direction == 1) along.demodulation.setZero();
    const double slope = gradient.modulation.cwiseProduct(along.modulation).sum() +
                         gradient.demodulation.cwiseProduct(along.demodulation).sum();
    const double scale = gradient.modulation.norm() * along.modulation.norm() +
                         gradient.demodulation.norm() * along.demodulation.norm();
    constexpr double step = 1e-6;
    const auto at = [&](double s) {
      SampledCode moved = setting.code;
      moved.modulation += s * along.modulation;
      moved.demodulation += s * along.demodulation;
      return error_of(moved);
    };
    EXPECT_NEAR(slope, (at(step) - at(-step)) / (2 * step), 1e-3 * scale);
  }
}

TEST(DepthErrorLoss, GradientWithRespectToWaveformsMatchesFiniteDifferences) {
  for (const Setting& setting : settings())
    for (const auto& [circular, depths] : {std::pair(false, DepthPrior()),
                                           {true, DepthPrior()},
                                           {false, DepthPrior({3, 0, 1, 2})}}) {
      const SampledCamera camera = setting.sampled();
      const auto measured = camera.measure(setting.code);
      const TrialBatch batch = trials_for(setting, 20, !circular, circular, depths);
      DepthErrorLoss loss(camera, measured.table,
                          circular ? DepthErrorKind::circular : DepthErrorKind::linear);
      const double sharpness = 1.2 / loss.mean_variance_e2(setting.point);
      loss.soft_error(setting.point, batch, sharpness, 1.0);
      const SampledCode gradient = camera.pull_back(measured, loss.gradient());
      expect_slopes(setting, gradient, [&](const SampledCode& code) {
        return reference_soft_error(camera, camera.measure(code).table, setting.point, batch,
                                    sharpness, circular);
      });
    }
}

TEST(DepthErrorLoss, GradientWithRespectToSharesMatchesFiniteDifferences) {
  const double total_s = 0.3;
  const Eigen::VectorXd shares{{0.2, 0.4, 0.15, 0.25}};
  for (Setting setting : settings())
    for (const bool circular : {false, true}) {
      const auto split_by = [&](const Eigen::VectorXd& by) {
        setting.camera.exposure_s.each_s.clear();
        for (const double share : by) setting.camera.exposure_s.each_s.push_back(total_s * share);
        return setting.sampled();
      };
      const SampledCamera camera = split_by(shares);
      SampledCode code = setting.code;
      code.shares = shares;
      const SampledCamera::Measured measured =
          split_by(Eigen::VectorXd::Constant(4, 0.25)).measure(code);
      EXPECT_TRUE(measured.times.exposure_s.isApprox(camera.exposure_s()));
      EXPECT_TRUE(measured.times.constant_variance_e2.isApprox(camera.constant_variance_e2()));
      const TrialBatch batch = trials_for(setting, 20, !circular, circular);
      DepthErrorLoss loss(camera, measured.table, measured.times,
                          circular ? DepthErrorKind::circular : DepthErrorKind::linear);
      const double sharpness = 1.2 / loss.mean_variance_e2(setting.point);
      loss.soft_error(setting.point, batch, sharpness, 1.0);
      Eigen::VectorXd by_exposure_s = Eigen::VectorXd::Zero(camera.measurements());
      loss.gradient(&by_exposure_s);
      const Eigen::VectorXd gradient = camera.pull_back_times(by_exposure_s);
      constexpr double step = 1e-6;
      for (Eigen::Index e = 0; e < shares.size(); ++e) {
        const auto error_at = [&](double share) {
          Eigen::VectorXd moved = shares;
          moved[e] = share;
          return reference_soft_error(split_by(moved), measured.table, setting.point, batch,
                                      sharpness, circular);
        };
        EXPECT_NEAR(gradient[e],
                    (error_at(shares[e] + step) - error_at(shares[e] - step)) / (2 * step),
                    2e-3 * gradient.norm());
      }
    }
}

TEST(DepthErrorLoss, WeightsAndPointsAdd) {
  const Setting setting;
  const SampledCamera camera = setting.sampled();
  const MeasurementTable table = camera.measure(setting.code).table;
  const TrialBatch batch = trials_for(setting, 10);
  DepthErrorLoss once(camera, table, DepthErrorKind::circular), twice = once;
  once.soft_error(setting.point, batch, 1e-3, 3.0);
  twice.soft_error(setting.point, batch, 1e-3, 1.0);
  twice.soft_error(setting.point, batch, 1e-3, 2.0);
  EXPECT_LT((once.gradient().correlation - twice.gradient().correlation).norm(),
            1e-4 * once.gradient().correlation.norm());
}

TrialBatch two_return_trials(const Setting& setting, int count, TwoReturnGrid grid) {
  RandomStream random(7, 3);
  const MultipathTrials later{{{0.2, 0.9}, {1.0, 4.0}}, setting.camera.range_m(), grid};
  return draw_trials(count, setting.sampled().measurements(), {}, true, random, nullptr, &later);
}

/// Grids as fine as the curve, and coarser.
constexpr TwoReturnGrid grids[] = {{24, {2, 9}}, {12, {1, 11}}};

TEST(TwoReturnLoss, EqualsTheReferenceOnEveryTarget) {
  for_each_target([] {
    for (const Setting& setting : settings())
      for (const TwoReturnGrid& grid : grids) {
        const SampledCamera camera = setting.sampled();
        const MeasurementTable table = camera.measure(setting.code).table;
        const TrialBatch batch = two_return_trials(setting, 15, grid);
        DepthErrorLoss loss(camera, table, DepthErrorKind::linear);
        const double sharpness = 0.5 / loss.mean_variance_e2(setting.point);
        const double expected =
            reference_two_return_error(camera, table, setting.point, batch, sharpness);
        EXPECT_NEAR(loss.soft_error(setting.point, batch, sharpness), expected, 2e-3 * expected);
        EXPECT_NEAR(loss.soft_error(setting.point, batch, sharpness, 0.5), expected,
                    2e-3 * expected);
      }
  });
}

TEST(TwoReturnLoss, DecodesToTheFirstReturnOfTheBestPair) {
  const Setting setting(2);
  const SampledCamera camera = setting.sampled();
  const MeasurementTable table = camera.measure(setting.code).table;
  for (const TwoReturnGrid& grid : grids) {
    const TrialBatch batch = two_return_trials(setting, 20, grid);
    DepthErrorLoss loss(camera, table, DepthErrorKind::circular);
    std::vector<double> decoded;
    loss.decode(setting.point, batch, decoded);
    for (std::size_t t = 0; t < decoded.size(); ++t) {
      const TrialBatch one = only(batch, t);
      double expected = 0.0;
      reference_two_return_error(camera, table, setting.point, one, 1.0, &expected);
      EXPECT_EQ(decoded[t], expected) << t;
    }
  }
}

TEST(TwoReturnLoss, GradientWithRespectToWaveformsMatchesFiniteDifferences) {
  for (const Setting& setting : settings())
    for (const TwoReturnGrid& grid : grids) {
      const SampledCamera camera = setting.sampled();
      const auto measured = camera.measure(setting.code);
      const TrialBatch batch = two_return_trials(setting, 10, grid);
      DepthErrorLoss loss(camera, measured.table, DepthErrorKind::circular);
      const double sharpness = 0.5 / loss.mean_variance_e2(setting.point);
      loss.soft_error(setting.point, batch, sharpness, 1.0);
      const SampledCode gradient = camera.pull_back(measured, loss.gradient());
      expect_slopes(setting, gradient, [&](const SampledCode& code) {
        return reference_two_return_error(camera, camera.measure(code).table, setting.point, batch,
                                          sharpness);
      });
    }
}

TEST(DrawTrials, DrawsDepthsWithTheirWeights) {
  for (const bool ends_matter : {false, true}) {
    RandomStream random(7, 3);
    const TrialBatch batch = draw_trials(40000, 3, {}, ends_matter, random, nullptr, nullptr,
                                         DepthPrior({4.0, 0.0, 1.0, 3.0}));
    Eigen::Vector4d share = Eigen::Vector4d::Zero();
    for (const DepthTrial& trial : batch.trials)
      share[static_cast<int>(4 * trial.depth_periods)] += trial.weight / 40000;
    EXPECT_TRUE(share.isApprox(Eigen::Vector4d(0.5, 0.0, 0.125, 0.375), 0.01)) << share.transpose();
  }
}

TEST(DrawTrials, EqualWeightsOfDepthsGiveTheSameBitsAsNoWeights) {
  for (const bool ends_matter : {false, true}) {
    RandomStream random(7, 3), again(7, 3);
    const TrialBatch none = draw_trials(100, 3, {}, ends_matter, random);
    const TrialBatch even =
        draw_trials(100, 3, {}, ends_matter, again, nullptr, nullptr, DepthPrior({0.3, 0.3, 0.3}));
    for (std::size_t t = 0; t < none.trials.size(); ++t) {
      EXPECT_EQ(none.trials[t].depth_periods, even.trials[t].depth_periods);
      EXPECT_EQ(none.trials[t].weight, even.trials[t].weight);
    }
    EXPECT_EQ(none.normals, even.normals);
  }
}

Camera camera_with(int taps, Readout readout = Readout::separate) {
  Camera camera = built_in_camera("paper-10f0");
  camera.light.peak_factor = 6.0;
  camera.sensor.taps = taps;
  camera.sensor.readout = readout;
  camera.operating.signal_e_per_s = {1e4};
  camera.operating.ambient_e_per_s = {1e4};
  camera.operating.multipath = OperatingMultipath{{0.2, 0.5}, {0.5, 3.0}, 0.2};
  return camera;
}

DesignProblem problem_of(const Camera& camera, int exposures, double two_return_weight) {
  return make_design_problem(std::span(&camera, 1), exposures, 48, two_return_weight);
}

/// The direct depth is decoded as the first of two returns.
double two_return_error_bin(const DesignProblem& problem, const WaveformParameters& parameters) {
  const SampledCamera& camera = problem.variants.front().camera;
  const SampledCode code = render(problem.space, parameters, {6.0, 8.0});
  DepthErrorLoss loss(camera, camera.measure(code).table, DepthErrorKind::circular);
  RandomStream random(5, 1);
  const TrialBatch batch = draw_trials(300, camera.measurements(), problem.operating, false, random,
                                       nullptr, &*problem.multipath_as_two);
  const OperatingPoint& point = problem.variants.front().levels.front().point;
  return loss.soft_error(point, batch, 3.0 / loss.mean_variance_e2(point));
}

TEST(TwoReturnDescent, SeparatesAmbiguousPairs) {
  // With two frequencies, different pairs of returns can give equal measurements.
  const Camera camera = camera_with(2);
  const DesignProblem blind = problem_of(camera, 5, 1e-9), seeing = problem_of(camera, 5, 1.0);
  const CodeSet code = make_family("pulsed-multifrequency-k5", {.samples = 240, .peak_factor = 6.0})
                           .with_two_buckets();
  RandomStream random(1, 1);
  const WaveformParameters start =
      optimize_start(seeing, std::span(&code, 1), {}, 0, random).parameters;
  DescentSchedule schedule;
  schedule.steps = 150;
  schedule.trials_per_step = 60;
  const double of_blind = two_return_error_bin(seeing, descend(blind, start, schedule, 1, 1));
  const double of_seeing = two_return_error_bin(seeing, descend(seeing, start, schedule, 1, 1));
  EXPECT_LT(of_seeing, 0.8 * of_blind);
}

TEST(TwoReturnProblem, UsesTwoReturnsIfThereAreEnoughMeasurements) {
  const auto has_them = [](const Camera& camera, int exposures) {
    const DesignProblem problem = problem_of(camera, exposures, 0.1);
    const CameraVariant& variant = problem.variants.front();
    EXPECT_EQ(variant.usual_levels(), 2u);
    EXPECT_EQ(variant.levels.size() > 2, problem.multipath_as_two.has_value());
    return problem.multipath_as_two.has_value();
  };
  EXPECT_TRUE(has_them(camera_with(2), 5));
  EXPECT_FALSE(has_them(camera_with(2), 4));
  EXPECT_TRUE(has_them(camera_with(1), 6));
  EXPECT_FALSE(has_them(camera_with(1), 5));
  EXPECT_TRUE(has_them(camera_with(2, Readout::difference), 5));
  EXPECT_TRUE(has_them(camera_with(4), 2));
  EXPECT_FALSE(problem_of(camera_with(2), 5, 0.0).multipath_as_two);
}

TEST(TwoReturnProblem, UsesALimitedGridOfReturns) {
  Camera camera = camera_with(2);
  camera.samples = 960;
  for (const int samples : {48, 120, 480, 960}) {
    const DesignProblem problem =
        make_design_problem(std::span<const Camera>(&camera, 1), 5, samples, 0.1);
    const TwoReturnGrid grid = *problem.multipath_as_two->decoded_as_two;
    EXPECT_LE(grid.bins, 160);
    EXPECT_EQ(problem.space.samples() % grid.bins, 0);
    EXPECT_GE(grid.delays.shortest, 1);
    EXPECT_LT(grid.delays.longest, grid.bins);
    EXPECT_LT(grid.delays.shortest, grid.delays.longest);
  }
}

}  // namespace

}  // namespace tofsmith
