// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/motion_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tofsmith/core/error.hpp"
#include "tofsmith/simulate/staged_capture.hpp"

namespace tofsmith {

namespace {

Camera timed_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.exposure_s.total_s = 40e-3;
  camera.sensor.readout_gap_s = 2e-3;
  camera.sensor.frame_period_s = 60e-3;
  return camera;
}

CodeSet code_of(const Camera& camera) { return build_family("hamiltonian-k4", camera); }

StagedScene approaching_wall(double velocity_m_per_s) {
  StagedScene scene{.shapes = {Plane{.point = {0, 0, 3.0}, .texture = {.image = {}}}},
                    .view = PinholeView::centred(6, 4, 0.5)};
  scene.shape_motions = {Motion{.velocity_m_per_s = {0, 0, -velocity_m_per_s}}};
  return scene;
}

TEST(Motion, ExposuresFollowOneAnotherWithTheirGaps) {
  Camera camera = timed_camera();
  EXPECT_DOUBLE_EQ(camera.exposure_middle_s(0, 0, 4), 5e-3);
  EXPECT_DOUBLE_EQ(camera.exposure_middle_s(0, 3, 4), 41e-3);
  EXPECT_DOUBLE_EQ(camera.exposure_middle_s(2, 1, 4), 137e-3);
  EXPECT_DOUBLE_EQ(camera.frame_middle_s(0, 4), 23e-3);
  camera.sensor.frame_period_s.reset();
  EXPECT_DOUBLE_EQ(camera.frame_period_s(4), 48e-3);
  camera.sensor.readout_gap_s.reset();
  EXPECT_DOUBLE_EQ(camera.frame_period_s(4), 40e-3);
  camera.exposure_s.each_s = {1e-3, 2e-3, 3e-3, 4e-3};
  EXPECT_DOUBLE_EQ(camera.exposure_middle_s(1, 2, 4), 14.5e-3);
  camera.sensor.frame_period_s = 9e-3;
  EXPECT_THROW(camera.frame_period_s(4), InvalidArgument);
}

TEST(Motion, AShapeIsDisplacedByItsVelocityInTheMiddleOfEachFrame) {
  const Camera camera = timed_camera();
  const StagedCapture made = capture(approaching_wall(2.0), code_of(camera), camera, {.frames = 3});
  ASSERT_EQ(made.truth.size(), 3u);
  for (int frame = 0; frame < 3; ++frame) {
    const double z_m = 3.0 - 2.0 * (23e-3 + frame * 60e-3);
    const PinholeView view = approaching_wall(0.0).view;
    const auto at = static_cast<std::size_t>(frame);
    EXPECT_NEAR(made.truth[at].depth_m(1, 2), z_m * view.radial_per_z(1, 2), 1e-5);
    EXPECT_NEAR(made.far_m[at](1, 2) - made.near_m[at](1, 2), 2.0 * 36e-3 * view.radial_per_z(1, 2),
                1e-5);
  }
}

TEST(Motion, EveryExposureSeesTheSceneAtItsTime) {
  Camera camera = timed_camera();
  camera.sensor.taps = 2;
  const CodeSet code = code_of(camera);
  const StagedScene scene = approaching_wall(3.0);
  const CaptureOptions options{.seed = 5};
  const StagedCapture made = capture(scene, code, camera, options);
  ASSERT_EQ(made.raw.measurements, 8);
  for (int exposure = 0; exposure < 4; ++exposure) {
    // A static capture of the scene at this time has the same light in this exposure's taps. Its
    // normal noise uses the same place of the same random stream.
    const StagedScene then = scene.at(camera.exposure_middle_s(0, exposure, 4));
    const StagedCapture still = capture(then, code, camera, options);
    for (std::size_t pixel = 0; pixel < 24; ++pixel)
      for (int tap = 2 * exposure; tap < 2 * exposure + 2; ++tap) {
        const std::size_t i = 8 * pixel + static_cast<std::size_t>(tap);
        EXPECT_EQ(made.raw.values[i], still.raw.values[i]);
      }
    EXPECT_NE(made.raw.values, still.raw.values);
  }
}

TEST(Motion, RotatesAboutItsMovingCentre) {
  const double quarter = 2.0 * std::atan(1.0);
  const Motion motion{.velocity_m_per_s = {0, 0, 1.0},
                      .turn_rad_per_s = {0, 0, quarter},
                      .turn_centre_m = {1.0, 0, 0}};
  const Eigen::Vector3d moved_point = motion.at(1.0) * Eigen::Vector3d(2.0, 0.0, 0.0);
  EXPECT_NEAR((moved_point - Eigen::Vector3d(1.0, 1.0, 1.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((motion.at(2.0) * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 0, 2)).norm(), 0.0,
              1e-12);
  EXPECT_TRUE(motion.at(0.0).isApprox(Eigen::Isometry3d::Identity()));
}

TEST(Motion, EveryKindOfShapeMovesRigidly) {
  // Moving a body is equivalent to moving the camera inversely.
  const Motion motion{.velocity_m_per_s = {0.3, -0.2, 0.5},
                      .turn_rad_per_s = {0.4, 0.9, -0.3},
                      .turn_centre_m = {0.1, 0.2, 2.0}};
  TriangleMesh pyramid{.vertices = {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}},
                       .triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}},
                       .texture_coordinates = {}};
  Mesh mesh{.triangles = pyramid, .scale_m = 0.5, .texture = {.image = {}}};
  mesh.mesh_to_world.translation() = Eigen::Vector3d(0, 0, 2);
  const PinholeView view = PinholeView::centred(24, 18, 1.2);
  for (const Shape& shape :
       {Shape(Plane{.point = {0, 0, 2}, .normal = {0.2, 0.1, -1}, .texture = {.image = {}}}),
        Shape(Box{.centre = {0, 0, 2}, .size_m = {0.8, 0.5, 0.3}, .texture = {.image = {}}}),
        Shape(Sphere{.centre = {0.2, 0, 2}, .radius_m = 0.4, .texture = {.image = {}}}),
        Shape(Capsule{.start = {0, 0, 2}, .end = {0.3, 0.4, 2.2}, .texture = {.image = {}}}),
        Shape(mesh)}) {
    StagedScene shape_moves{.shapes = {shape}, .view = view};
    shape_moves.shape_motions = {motion};
    const StagedScene now = shape_moves.at(0.4);
    const SceneImage seen = ray_cast(now.shapes, view, now.camera_to_world);
    const std::vector<Shape> unmoved{shape};
    const SceneImage other = ray_cast(unmoved, view, motion.at(0.4).inverse());
    int differ = 0, hits = 0;
    for (std::size_t i = 0; i < seen.depth_m.size(); ++i) {
      const float a = seen.depth_m.pixels[i], b = other.depth_m.pixels[i];
      hits += !std::isnan(a);
      differ += std::isnan(a) != std::isnan(b) || std::abs(a - b) > 1e-4f;
    }
    EXPECT_GT(hits, 5) << shape.index();
    EXPECT_LE(differ, 1) << shape.index();  // an edge may fall on either side
  }
}

TEST(Motion, MovingTheCameraEqualsMovingTheWall) {
  const Camera camera = timed_camera();
  StagedScene rides = approaching_wall(0.0);
  rides.camera_motion.velocity_m_per_s = {0, 0, 2.0};
  const CaptureOptions options{.frames = 2};
  const StagedCapture a = capture(rides, code_of(camera), camera, options);
  const StagedCapture b = capture(approaching_wall(2.0), code_of(camera), camera, options);
  for (std::size_t i = 0; i < a.raw.values.size(); ++i)
    EXPECT_NEAR(a.raw.values[i] / b.raw.values[i], 1.0, 1e-5);
}

TEST(Motion, StaticScenesAreUnchanged) {
  const Camera plain = built_in_camera("paper-10f0");
  Camera timed = plain;
  timed.sensor.readout_gap_s = 1e-3;
  timed.sensor.frame_period_s = 1.0;
  StagedScene scene = built_in_scene("table-top", 24, 18);
  const CaptureOptions options{.frames = 2};
  const RawFrames image = capture(ray_cast(scene.shapes, scene.view, scene.camera_to_world),
                                  code_of(plain), plain, options);
  scene.shape_motions.assign(scene.shapes.size(), Motion{.turn_centre_m = {1, 2, 3}});
  const StagedCapture made = capture(scene, code_of(plain), timed, options);
  EXPECT_EQ(made.raw.values, image.values);
  EXPECT_EQ(made.truth.size(), 1u);
  // A negligible motion uses the code for moving scenes and gives the same values.
  scene.camera_motion.velocity_m_per_s = {1e-30, 0, 0};
  EXPECT_EQ(capture(scene, code_of(plain), timed, options).raw.values, image.values);
}

TEST(Motion, IndirectLightIsThatOfEachTime) {
  const Camera camera = timed_camera();
  int asked = 0;
  const StagedSetup setup{.search_of = {},
                          .light =
                              [&](const StagedScene& scene, const SceneImage& rays) {
                                ++asked;
                                EXPECT_EQ(scene.view.width, rays.width());
                                const std::vector<MultipathReturn> behind{{0.5f, 0.2f}};
                                SceneLight light;
                                light.returns = behind_every_pixel(rays, behind);
                                return light;
                              },
                          .ambient_scale = {}};
  const StagedCapture with = capture(approaching_wall(1.0), code_of(camera), camera, {}, setup);
  EXPECT_EQ(asked, 4);
  EXPECT_NE(with.raw.values,
            capture(approaching_wall(1.0), code_of(camera), camera, {}).raw.values);
}

TEST(Motion, RejectsInvalidMotions) {
  const Camera camera = timed_camera();
  StagedScene scene = approaching_wall(1.0);
  scene.shape_motions.emplace_back();
  EXPECT_THROW(capture(scene, code_of(camera), camera, {}), InvalidArgument);
  scene.shape_motions = {Motion{.velocity_m_per_s = {std::nan(""), 0, 0}}};
  EXPECT_THROW(capture(scene, code_of(camera), camera, {}), InvalidArgument);
  Camera hasty = camera;
  hasty.sensor.frame_period_s = 10e-3;
  EXPECT_THROW(capture(approaching_wall(1.0), code_of(hasty), hasty, {}), InvalidArgument);
  EXPECT_THROW(motion_error(code_of(hasty), hasty, 1.0), InvalidArgument);
}

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

}  // namespace

}  // namespace tofsmith
