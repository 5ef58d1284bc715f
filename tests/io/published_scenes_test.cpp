// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// A rendered scene published by others; not part of this repository.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/mesh_file.hpp"
#include "tofsmith/scene/bounced_light.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/multipath_error.hpp"

namespace tofsmith {
namespace {

const std::filesystem::path groove_file = std::filesystem::path(TOFSMITH_SOURCE_DIR) /
                                          "../shared/data/vgroove_depth_rgb/vgroove_depth.npy";

struct FittedPlane {
  Eigen::Vector3d point, normal;
  double rms_m = 0.0;
};

FittedPlane fit(const Image<float>& depth_m, const PinholeView& view, int first, int last) {
  Eigen::MatrixX3d points(Eigen::Index{depth_m.height} * (last - first), 3);
  Eigen::Index i = 0;
  for (int row = 0; row < depth_m.height; ++row)
    for (int column = first; column < last; ++column)
      points.row(i++) = view.ray(row, column) * static_cast<double>(depth_m(row, column));
  const Eigen::Vector3d centre = points.colwise().mean();
  points.rowwise() -= centre.transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(points, Eigen::ComputeThinV);
  return {centre, svd.matrixV().col(2),
          svd.singularValues()[2] / std::sqrt(static_cast<double>(points.rows()))};
}

TEST(PublishedScenes, IndirectLightBendsTheWallsOfTheGrooveAsPredicted) {
  if (!std::filesystem::exists(groove_file)) GTEST_SKIP() << "needs " << groove_file;
  const Image<float> depth_m = read_depth(groove_file);
  const auto view = PinholeView::centred(depth_m.width, depth_m.height, std::numbers::pi / 3);
  const FittedPlane left = fit(depth_m, view, 0, 75), right = fit(depth_m, view, 90, 160);
  EXPECT_LT(std::max(left.rms_m, right.rms_m), 0.2e-3) << "half-precision numbers";
  EXPECT_NEAR(left.normal.dot(right.normal), 0.0, 1e-3) << "a right angle";

  const auto wall = [](const FittedPlane& its) {
    return Plane{.point = its.point, .normal = its.normal, .texture = {.albedo = 0.5}};
  };
  const StagedScene groove{.shapes = {wall(left), wall(right)}, .view = view};
  const SceneImage image = RayCaster(groove.shapes, embree_search()).see(view).image;
  float farthest_m = 0.0f;
  for (std::size_t i = 0; i < depth_m.size(); ++i)
    farthest_m = std::max(farthest_m, std::abs(image.depth_m.pixels[i] - depth_m.pixels[i]));
  EXPECT_LT(farthest_m, 2e-3f);

  // Indirect light arrives a few centimetres late, too close for any decoder to separate.
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  const MultipathReturns returns =
      bounced_light(groove, {.rays = 32, .range_m = camera.range_m()}, {}, embree_search());
  const MultipathScene scene = multipath_scene(
      "v-groove", image, view, returns, build_family("hamiltonian-k5", camera), camera,
      {.signal_e_per_s = 1e7, .ambient_e_per_s = 0.0, .reference_distance_m = 0.6});
  double law_m = 0.0;
  for (std::size_t i = 0; i < scene.multipath_ratio.size(); ++i)
    law_m += single_path_bias_m(scene.multipath_ratio.pixels[i], scene.multipath_delay_m.pixels[i]);
  law_m /= static_cast<double>(scene.multipath_ratio.size());
  EXPECT_GT(law_m, 0.01);
  EXPECT_LT(scene.all.bias_m[0], law_m) << "some light comes later than the law reaches";
  EXPECT_GT(scene.all.bias_m[0], 0.8 * law_m);
}

}  // namespace
}  // namespace tofsmith
