// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/motion_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// A camera with four exposures of 5 ms and gaps of 1 ms between them.
Camera quick_camera(int taps = 1) {
  Camera camera = built_in_camera("paper-10f0");
  camera.exposure_s.total_s = 20e-3;
  camera.sensor.readout_gap_s = 1e-3;
  camera.sensor.taps = taps;
  camera.operating.signal_e_per_s = {1e8};
  camera.operating.ambient_e_per_s = {1e6};
  camera.operating.error = DepthErrorKind::circular;
  return camera;
}

MotionBias bias_of(const CodeSet& code, const Camera& camera) {
  return MotionBias(ForwardModel(code, camera), camera);
}

TEST(MotionError, ShiftsAreRelativeToTheMiddleOfTheFrame) {
  const Camera camera = quick_camera();
  const Eigen::VectorXd shift_m =
      exposure_shifts_m(build_family("sinusoid-k4", camera), camera, 2.0);
  ASSERT_EQ(shift_m.size(), 4);
  EXPECT_TRUE(shift_m.isApprox(Eigen::Vector4d(-18e-3, -6e-3, 6e-3, 18e-3), 1e-12));
}

TEST(MotionError, BiasIsOddInVelocityAndReversingTheExposuresNegatesIt) {
  const Camera camera = quick_camera();
  for (const char* name : {"sinusoid-k4", "square-k4", "hamiltonian-k4", "hamiltonian-k5"}) {
    const CodeSet code = build_family(name, camera);
    std::vector<int> order;
    for (int e = code.exposures(); e-- > 0;) order.push_back(e);
    const CodeSet reversed = code.with_exposure_order(order);
    const MotionBias bias = bias_of(code, camera), reversed_bias = bias_of(reversed, camera);
    const Eigen::VectorXd away_m = exposure_shifts_m(code, camera, 1.0);
    const Eigen::VectorXd towards_m = exposure_shifts_m(code, camera, -1.0);
    EXPECT_GT(bias.rms_m(away_m), 0.0) << name;
    EXPECT_DOUBLE_EQ(bias.mean_m(towards_m), -bias.mean_m(away_m)) << name;
    EXPECT_DOUBLE_EQ(bias.rms_m(towards_m), bias.rms_m(away_m)) << name;
    EXPECT_NEAR(reversed_bias.mean_m(away_m), -bias.mean_m(away_m), 1e-12) << name;
    EXPECT_NEAR(reversed_bias.rms_m(away_m), bias.rms_m(away_m), 1e-12) << name;
  }
}

TEST(MotionError, EqualShiftsOfAllExposuresShiftTheDepth) {
  const Camera camera = quick_camera();
  const MotionBias bias = bias_of(build_family("hamiltonian-k5", camera), camera);
  const Eigen::VectorXd equal_m = Eigen::VectorXd::Constant(5, 0.01);
  EXPECT_NEAR(bias.mean_m(equal_m), 0.01, 1e-12);
  EXPECT_NEAR(bias.rms_m(equal_m), 0.01, 1e-12);
}

TEST(MotionError, FourPhasesInSymmetricalOrderHaveNoBias) {
  const Camera camera = quick_camera();
  const CodeSet code = build_family("sinusoid-k4", camera);
  const Eigen::VectorXd shift_m = exposure_shifts_m(code, camera, 1.0);
  // The weights of the four phases are sin^2, cos^2, sin^2, cos^2, each divided by 2.
  EXPECT_NEAR(bias_of(code, camera).rms_m(shift_m), 6e-3 / std::sqrt(8.0), 1e-6);
  EXPECT_NEAR(bias_of(code.with_exposure_order({0, 1, 3, 2}), camera).rms_m(shift_m), 0.0, 1e-6);
}

TEST(MotionError, OneExposureHasNeitherBiasNorEdges) {
  const Camera camera = quick_camera(4);
  const CodeSet code = build_family("sinusoid-k4", camera);
  ASSERT_EQ(code.exposures(), 1);
  const MotionReport report = motion_error(code, camera, 5.0, {.trials = 1000});
  EXPECT_EQ(report.rms_bias_m, 0.0);
  EXPECT_TRUE(report.edge.points.empty());
}

TEST(MotionError, TrialsAgreeWithTheClosedForm) {
  Camera differences = quick_camera(2), mixer = quick_camera();
  differences.sensor.readout = Readout::difference;
  mixer.sensor.demodulation = Demodulation::weight;
  for (const char* name : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k5"})
    for (Camera camera : {quick_camera(1), quick_camera(2), differences, mixer})
      for (const double nearest_m : {0.1, 3.0, 5.0}) {
        camera.operating.working_distance_m = {{nearest_m, nearest_m + 0.2}};
        const CodeSet code = build_family(name, camera);
        const MotionReport report = motion_error(code, camera, 0.5, {.trials = 20000});
        const Estimate& bias_m = report.surface.points.front().bias_m;
        EXPECT_NEAR(bias_m.value, report.mean_bias_m, 4.0 * bias_m.standard_error)
            << name << ", " << camera.sensor.taps << " taps, " << nearest_m << " m";
        EXPECT_GT(report.rms_bias_m, 10.0 * bias_m.standard_error) << name;
      }
}

TEST(MotionError, WithoutVelocityIsThatOfEvaluate) {
  Camera camera = quick_camera();
  const CodeSet code = build_family("hamiltonian-k5", camera);
  const EvaluateOptions options{.trials = 20000, .bounds = false};
  const DepthErrorReport still = evaluate(code, camera, options);
  const MotionReport report = motion_error(code, camera, 0.0, options);
  const Estimate &expected = still.points.front().circular_mde_m,
                 &error_m = report.surface.points.front().circular_mde_m;
  EXPECT_NEAR(error_m.value, expected.value,
              4.0 * std::hypot(error_m.standard_error, expected.standard_error));
  EXPECT_LT(report.surface.shares.inconsistent, 0.003) << "false alarm rate: 0.001";
  camera.operating.velocity_m_per_s = 3.0;
  EXPECT_EQ(evaluate(code, camera, options).circular.geometric_mean_m.value,
            still.circular.geometric_mean_m.value);
}

TEST(MotionError, TakesNoTimeFromNeighboursThatAFilterAdds) {
  Camera camera = quick_camera();
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const double single_m = motion_error(code, camera, 1.0, {.trials = 100}).rms_bias_m;
  camera.operating.neighbours = 9;
  EXPECT_DOUBLE_EQ(motion_error(code, camera, 1.0, {.trials = 100}).rms_bias_m, single_m);
}

TEST(MotionError, MostWrongDepthsAtAnEdgeAreInconsistentIfTheCodeHasSpareMeasurements) {
  const Camera camera = quick_camera(2);
  const MotionReport spare =
      motion_error(build_family("hamiltonian-k5", camera), camera, 0.0, {.trials = 4000});
  const WrongShares& shares = spare.edge.shares;
  EXPECT_GT(shares.wrong, 0.5);
  EXPECT_LE(shares.wrong_ok + shares.wrong_inconsistent, shares.wrong);
  EXPECT_LE(shares.wrong_inconsistent, shares.inconsistent);
  EXPECT_GT(*shares.detected(), 0.9);
  const Camera one_tap = quick_camera(1);
  const MotionReport exact =
      motion_error(build_family("sinusoid-k3", one_tap), one_tap, 0.0, {.trials = 4000});
  EXPECT_EQ(*exact.edge.shares.detected(), 0.0) << "three measurements have no residual";
}

TEST(MotionError, RejectsFramesThatAreShorterThanTheirExposures) {
  Camera camera = quick_camera();
  camera.sensor.frame_period_s = 1e-3;
  EXPECT_THROW(motion_error(build_family("sinusoid-k4", camera), camera, 1.0), InvalidArgument);
}

}  // namespace
}  // namespace tofsmith
