// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "design/optimize/depth_error_loss.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/optimize_pool.hpp"
#include "design/optimize/optimize_starts.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/families.hpp"

namespace tofsmith {
namespace {

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
      optimize_start(seeing, std::span(&code, 1), 0, random).parameters;
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
