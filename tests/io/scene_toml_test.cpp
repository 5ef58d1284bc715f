// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/scene_toml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <ostream>

#include "damaged_directory.hpp"
#include "damaged_files.hpp"
#include "io/shared/read_file.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/mesh_file.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {

namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr std::string_view every_shape = R"([view]
width_px = 64
height_px = 48
horizontal_angle_deg = 90

[camera]
position_m = [0, -1, 0]
rotation_deg = [0, 90, 0]

[[plane]]
point_m = [0, 0, 4]
normal = [0, 0, -2]
albedo = 0.25

[[box]]
centre_m = [1, 0, 3]
size_m = [0.1, 0.2, 0.3]
rotation_deg = [0, 0, 90]
texture = { pattern = "checker", albedo = 0.8, other_albedo = 0.2, period_m = 0.05 }

[[sphere]]
centre_m = [0, 0, 3]
radius_m = 0.2

[[sphere]]
centre_m = [0, 1, 3]
radius_m = 0.3

[[capsule]]
start_m = [0, 0, 3]
end_m = [0, 1, 3]
radius_m = 0.05
)";

template <typename S>
const S& first(const StagedScene& scene) {
  for (const Shape& shape : scene.shapes)
    if (const S* found = std::get_if<S>(&shape)) return *found;
  throw std::runtime_error("no such shape");
}

TEST(SceneToml, ReadsEveryShape) {
  const StagedScene scene = parse_scene_toml(every_shape);
  ASSERT_EQ(scene.shapes.size(), 5u);
  EXPECT_EQ(scene.view.width, 64);
  EXPECT_NEAR(scene.view.fx_px, 32.0, 1e-12);
  EXPECT_EQ(first<Plane>(scene).texture.albedo, 0.25);
  EXPECT_EQ(first<Plane>(scene).point, Eigen::Vector3d(0, 0, 4));
  const Box& box = first<Box>(scene);
  EXPECT_TRUE((box.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_EQ(box.texture.pattern, Texture::Pattern::checker);
  EXPECT_EQ(box.texture.other_albedo, 0.2);
  EXPECT_EQ(first<Sphere>(scene).radius_m, 0.2);
  EXPECT_EQ(first<Capsule>(scene).end, Eigen::Vector3d(0, 1, 3));
  EXPECT_EQ(scene.camera_to_world.translation(), Eigen::Vector3d(0, -1, 0));
  EXPECT_TRUE((scene.camera_to_world.linear() * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d::UnitX(), 1e-12))
      << "the camera looks to the right";
}

TEST(SceneToml, ThePointLookedAtIsInTheImageCentre) {
  const StagedScene scene = parse_scene_toml(
      "[view]\nwidth_px = 65\nheight_px = 49\n[camera]\nposition_m = [1, -2, 0]\n"
      "look_at_m = [0, 0, 3]\n[[sphere]]\ncentre_m = [0, 0, 3]\nradius_m = 0.5\n");
  const SceneImage image =
      ray_cast(scene.shapes, scene.view, scene.camera_to_world, embree_search());
  EXPECT_NEAR(image.depth_m(24, 32), std::sqrt(14.0) - 0.5, 1e-5);
  EXPECT_NEAR(scene.camera_to_world.linear().determinant(), 1.0, 1e-12);
  EXPECT_NEAR(scene.camera_to_world.linear()(1, 0), 0.0, 1e-12) << "rows are level";
  EXPECT_GT(scene.camera_to_world.linear()(1, 1), 0.0) << "down stays down";
}

TEST(SceneToml, ValuesOfShapesHaveUnits) {
  const StagedScene scene = parse_scene_toml(
      "[view]\nwidth_px = 64\nheight_px = 48\n[[sphere]]\ncentre_m = [0, \"5 cm\", \"3 m\"]\n"
      "radius_m = \"50 cm\"\n");
  const Sphere sphere = first<Sphere>(scene);
  EXPECT_EQ(sphere.radius_m, 0.5);
  EXPECT_EQ(sphere.centre, Eigen::Vector3d(0, 0.05, 3));
}

TEST(SceneToml, TheFocalLengthDefaultsToACentredPinhole) {
  const StagedScene scene = parse_scene_toml(
      "[view]\nwidth_px = 64\nheight_px = 48\nfx_px = 50\ncy_px = 20\n[[sphere]]\ncentre_m = "
      "[0, 0, 3]\nradius_m = 0.5\n");
  EXPECT_EQ(scene.view.fy_px, 50.0);
  EXPECT_EQ(scene.view.cx_px, 31.5);
  EXPECT_EQ(scene.view.cy_px, 20.0);
}

TEST(SceneToml, SettingsReplaceKeys) {
  const std::vector<std::string> settings = {"view.width_px=10"};
  EXPECT_EQ(parse_scene_toml(every_shape, "s.toml", settings).view.width, 10);
}

TEST(SceneToml, FilesAreFoundNextToTheScene) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "t.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  Image<float> cover(2, 2, 2.0f);
  cover(0, 0) = 0.5f;
  write_float_image(directory / "cover.npy", cover, "cover", OutputPolicy::refuse_existing);
  std::ofstream(directory / "s.toml")
      << "[[mesh]]\nfile = \"t.obj\"\nscale_m = 0.5\nposition_m = [0, 0, 2]\n"
         "rotation_deg = [0, 180, 0]\ntexture = { image = \"cover.npy\", period_m = 0.3 }\n";
  const StagedScene scene = read_scene_toml(directory / "s.toml");
  const Mesh& mesh = first<Mesh>(scene);
  EXPECT_EQ(mesh.scale_m, 0.5);
  EXPECT_TRUE((mesh.mesh_to_world * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(-1, 0, 2)));
  EXPECT_EQ(mesh.texture.image(0, 0), 0.25f) << "scaled to at most 1";
  EXPECT_EQ(mesh.texture.albedo, 1.0);
}

TEST(SceneToml, ShapesAndTheCameraRotateAboutTheirCentres) {
  const StagedScene scene = parse_scene_toml(
      "[camera]\nposition_m = [0, -1, 0]\nturn_deg_per_s = [0, 90, 0]\n"
      "[[plane]]\npoint_m = [0, 0, 4]\nnormal = [0, 0, -1]\n"
      "[[box]]\ncentre_m = [1, 0, 3]\nsize_m = [1, 1, 1]\nturn_deg_per_s = [0, 0, 180]\n"
      "[[capsule]]\nstart_m = [0, 0, 2]\nend_m = [0, 1, 2]\nradius_m = 0.1\n"
      "velocity_m_per_s = [1, 0, 0]\nturn_deg_per_s = [0, 0, 9]\nturn_centre_m = [0, 0, 2]\n");
  constexpr double pi = std::numbers::pi;
  ASSERT_EQ(scene.shape_motions.size(), 3u);
  EXPECT_TRUE(scene.shape_motions[0].is_still());
  EXPECT_TRUE(scene.shape_motions[1].turn_centre_m.isApprox(Eigen::Vector3d(1, 0, 3)));
  EXPECT_TRUE(scene.shape_motions[1].turn_rad_per_s.isApprox(Eigen::Vector3d(0, 0, pi)));
  EXPECT_TRUE(scene.shape_motions[2].turn_centre_m.isApprox(Eigen::Vector3d(0, 0, 2)));
  EXPECT_TRUE(scene.shape_motions[2].velocity_m_per_s.isApprox(Eigen::Vector3d(1, 0, 0)));
  const StagedScene later = scene.at(1.0);
  EXPECT_TRUE(later.camera_to_world.translation().isApprox(Eigen::Vector3d(0, -1, 0)));
  EXPECT_TRUE((later.camera_to_world.linear() * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(first<Box>(later).centre.isApprox(Eigen::Vector3d(1, 0, 3)));
  EXPECT_TRUE(first<Capsule>(later).start.isApprox(Eigen::Vector3d(1, 0, 2)));
}

TEST(SceneToml, StaticShapesHaveNoMotions) {
  const StagedScene scene = parse_scene_toml(every_shape);
  EXPECT_TRUE(scene.is_still());
  EXPECT_TRUE(scene.shape_motions.empty());
}

struct BadScene {
  const char* text;
  const char* message;
};

// Names the case in the list of tests; the default prints the two addresses.
void PrintTo(const BadScene& scene, std::ostream* out) { *out << scene.message; }

class SceneTomlRefuses : public testing::TestWithParam<BadScene> {};

TEST_P(SceneTomlRefuses, WithPlaceAndWhatWasExpected) {
  const std::string message = io_error_of([] { parse_scene_toml(GetParam().text, "s.toml"); });
  EXPECT_THAT(message, StartsWith(std::string("s.toml:") + GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, SceneTomlRefuses,
    testing::Values(
        BadScene{"", " found no shapes; expected [[plane]]"},
        BadScene{
            "[[sphere]]\nradius_m = 1",
            "1:1: found no sphere[0].centre_m; expected a line such as `centre_m = [0, 0, 2]`"},
        BadScene{"[[sphere]]\ncentre_m = [0, 0, 2]\nradius_m = 0",
                 "3:12: sphere[0].radius_m: found 0; expected a number > 0"},
        BadScene{"[[sphere]]\ncentre_m = [0, 0, 2]\nradius_m = 1\n[[sphere]]\ncentre_m = [0, 2]",
                 "5:12: sphere[1].centre_m: found 2 numbers; expected a list of three"},
        BadScene{"[[sphere]]\ncentre_m = [0, 0, nan]\nradius_m = 1",
                 "2:19: sphere[0].centre_m[2]: found nan; expected a finite number"},
        BadScene{"[[sphere]]\ncentre_m = [0, 0, 2]\nradius_m = 1\nradius_mm = 5",
                 "4:1: unknown key sphere[0].radius_mm; did you mean sphere[0].radius_m, in m?"},
        BadScene{"[[shpere]]\ncentre_m = [0, 0, 2]",
                 "1:3: unknown key shpere; did you mean sphere?"},
        BadScene{"[sphere]\ncentre_m = [0, 0, 2]",
                 "1:1: sphere: found a table; expected tables that begin with [[sphere]]"},
        BadScene{"sphere = [1]", "1:11: sphere[0]: found 1; expected tables"},
        BadScene{"[[plane]]\npoint_m = [0, 0, 2]\nnormal = [0, 0, 0]",
                 "3:10: plane[0].normal: has no length; expected a direction"},
        BadScene{"[[box]]\ncentre_m = [0, 0, 2]\nsize_m = [1, -1, 1]",
                 "3:10: box[0].size_m: found -1; expected edges > 0"},
        BadScene{"[[capsule]]\nstart_m = [0, 0, 2]\nend_m = [0, 0, 2]\nradius_m = -1",
                 "4:12: capsule[0].radius_m: found -1; expected a number > 0"},
        BadScene{"[[mesh]]\nfile = \"absent.obj\"",
                 "2:8: mesh[0].file: absent.obj: there is no such file"},
        BadScene{"[[mesh]]\nfile = \"hand.fbx\"",
                 "2:8: mesh[0].file: hand.fbx: found the extension '.fbx'"}));

constexpr std::string_view ball = "[[sphere]]\ncentre_m = [0, 0, 2]\nradius_m = 1\n";

class SceneTomlRefusesBesideABall : public testing::TestWithParam<BadScene> {};

TEST_P(SceneTomlRefusesBesideABall, WithPlaceAndWhatWasExpected) {
  const std::string text = std::string(ball) + GetParam().text;
  EXPECT_THAT(io_error_of([&] { parse_scene_toml(text, "s.toml"); }),
              StartsWith(std::string("s.toml:") + GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Textures, SceneTomlRefusesBesideABall,
    testing::Values(
        BadScene{"turn_centre_m = [0, 0, 1]",
                 "4:17: sphere[0].turn_centre_m: is only valid with turn_deg_per_s"},
        BadScene{"velocity = [1, 2, 3]",
                 "4:1: unknown key sphere[0].velocity; expected centre_m, radius_m, texture"},
        BadScene{"albedo = -0.1",
                 "4:10: sphere[0].albedo: found -0.1; expected a number in [0, 1]"},
        BadScene{"albedo = 0.5\ntexture = { pattern = \"uniform\" }",
                 "4:10: sphere[0].albedo: is only valid with no texture"},
        BadScene{"texture = { pattern = \"cheker\" }",
                 "4:23: sphere[0].texture.pattern: found \"cheker\"; expected one of \"uniform\", "
                 "\"checker\", \"stripes\"; did you mean \"checker\"?"},
        BadScene{"texture = { pattern = \"stripes\" }",
                 "4:11: found no sphere[0].texture.other_albedo"},
        BadScene{"texture = { pattern = \"stripes\", other_albedo = -1 }",
                 "4:49: sphere[0].texture.other_albedo: found -1"},
        BadScene{"texture = { pattern = \"stripes\", other_albedo = 1, period_m = 0 }",
                 "4:63: sphere[0].texture.period_m: found 0; expected a number > 0"},
        BadScene{"texture = { image = \"absent.png\" }",
                 "4:21: sphere[0].texture.image: absent.png: there is no such file"},
        BadScene{"texture = { image = \"a.png\", pattern = \"checker\" }",
                 "4:40: sphere[0].texture.pattern: is only valid with"}));

INSTANTIATE_TEST_SUITE_P(
    Views, SceneTomlRefusesBesideABall,
    testing::Values(
        BadScene{"[view]\nwidth_px = 0", "5:12: view.width_px: found 0; expected 1 to 65536"},
        BadScene{"[view]\nwidth_px = 60000\nheight_px = 60000", "6:13: view.height_px: "},
        BadScene{"[view]\nhorizontal_angle_deg = 180",
                 "5:24: view.horizontal_angle_deg: found 180; expected more than 0 and"},
        BadScene{"[view]\nfx_px = 5\nhorizontal_angle_deg = 18",
                 "6:24: view.horizontal_angle_deg: is only valid with no fx_px"},
        BadScene{"[view]\nfx_px = 200\ndistortion = [-0.6, 0, 0, 0]",
                 "6:14: view.distortion: found [-0.6, 0, 0, 0]; must not fold back inside"},
        BadScene{"[view]\ndistortion = [0, 0, 0, 0]",
                 "5:14: view.distortion: is only valid with fx_px"},
        BadScene{"[view]\ncx_px = 5", "5:9: view.cx_px: is only valid with fx_px"},
        BadScene{"[camera]\nposition_m = [1, 2, 3]\nlook_at_m = [1, 2, 3]",
                 "6:13: camera.look_at_m: is the position of the camera"},
        BadScene{"[camera]\nlook_at_m = [0, 1, 0]",
                 "5:13: camera.look_at_m: is directly above or below"},
        BadScene{"[camera]\nlook_at_m = [0, 1, 1]\nrotation_deg = [0, 0, 0]",
                 "6:16: camera.rotation_deg: is only valid with no look_at_m"}));

TEST(SceneToml, DamagedTexturesAreReportedWithTheirPixel) {
  const TemporaryDirectory directory;
  Image<float> cover(2, 3, 0.5f);
  cover(1, 2) = -0.25f;
  write_float_image(directory / "c.npy", cover, "cover", OutputPolicy::refuse_existing);
  const std::string path = (directory / "s.toml").string();
  std::ofstream(path) << ball << "texture = { image = \"c.npy\" }\n";
  const std::string message = io_error_of([&] { read_scene_toml(path); });
  EXPECT_THAT(message, StartsWith(path + ":4:21: sphere[0].texture.image: "));
  EXPECT_THAT(message, HasSubstr("row 1, column 2: found -0.25; expected a finite number >= 0"));
}

namespace fs = std::filesystem;

SceneResult scene() {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  SceneResult scene{.name = "a scene", .truth = SceneImage(2, 3)};
  scene.truth.depth_m.pixels = {1.0f, 2.0f, 3.0f, none, 4.0f, 5.0f};
  scene.truth.albedo.pixels = {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f};
  scene.truth.cosine.pixels = {1.0f, 0.9f, 0.8f, 0.7f, 0.6f, 0.5f};
  scene.view = PinholeView::centred(3, 2, 1.0);
  scene.reference_distance_m = 2.5;
  const SceneError error{.mean_m = 0.1,
                         .median_m = 0.2,
                         .outlier_rate = 0.3,
                         .decoded_share = 0.4,
                         .pixels = 5,
                         .outlier_threshold_m = 0.6};
  for (const char* light : {"low", "high"}) {
    SceneCapture capture{light, {1e3, 1e4}, {}};
    for (const char* code : {"hamiltonian-k4", "../a/b \xc3\xbc"})
      capture.decodings.push_back({code, scene.truth.depth_m, error});
    capture.decodings.back().filtered = {scene.truth.depth_m, scene.truth.albedo, error};
    scene.captures.push_back(capture);
  }
  return scene;
}

void expect_same_image(const Image<float>& a, const Image<float>& b) {
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.width, b.width);
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint32_t>(a.pixels[i]), std::bit_cast<std::uint32_t>(b.pixels[i]));
}

void expect_same_error(const SceneError& a, const SceneError& b) {
  EXPECT_EQ(a.mean_m, b.mean_m);
  EXPECT_EQ(a.median_m, b.median_m);
  EXPECT_EQ(a.outlier_rate, b.outlier_rate);
  EXPECT_EQ(a.decoded_share, b.decoded_share);
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_EQ(a.outlier_threshold_m, b.outlier_threshold_m);
}

TEST(SceneDirectory, ReadingUndoesWriting) {
  const TemporaryDirectory place;
  EXPECT_FALSE(holds_scene_result(place / "scene"));
  write_scene_result(place / "scene", scene(), OutputPolicy::refuse_existing);
  EXPECT_TRUE(holds_scene_result(place / "scene"));
  EXPECT_EQ(place.files(), 1);
  const SceneResult read = read_scene_result(place / "scene"), written = scene();
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.reference_distance_m, written.reference_distance_m);
  EXPECT_EQ(read.view.fx_px, written.view.fx_px);
  EXPECT_EQ(read.view.cy_px, written.view.cy_px);
  EXPECT_EQ(read.view.width, 3);
  expect_same_image(read.truth.depth_m, written.truth.depth_m);
  expect_same_image(read.truth.albedo, written.truth.albedo);
  expect_same_image(read.truth.cosine, written.truth.cosine);
  ASSERT_EQ(read.captures.size(), 2u);
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_EQ(read.captures[c].light, written.captures[c].light);
    EXPECT_EQ(read.captures[c].point, written.captures[c].point);
    ASSERT_EQ(read.captures[c].decodings.size(), 2u);
    for (std::size_t d = 0; d < 2; ++d) {
      const SceneDecoding &a = read.captures[c].decodings[d], &b = written.captures[c].decodings[d];
      EXPECT_EQ(a.code, b.code);
      expect_same_image(a.depth_m, b.depth_m);
      expect_same_error(a.error, b.error);
      ASSERT_EQ(a.filtered.has_value(), b.filtered.has_value());
      if (!a.filtered) continue;
      expect_same_image(a.filtered->depth_m, b.filtered->depth_m);
      expect_same_image(a.filtered->averaged, b.filtered->averaged);
      expect_same_error(a.filtered->error, b.filtered->error);
    }
  }
}

TEST(SceneDirectory, DamageIsReadOrRejectedWithTheFileName) {
  const TemporaryDirectory place;
  write_scene_result(place.path(), scene(), OutputPolicy::overwrite);
  for (const char* name : {"scene.json", "albedo.npy", "low-hamiltonian-k4.npy"})
    expect_damage_of_file_read_or_refused(place.path(), place / name, 200,
                                          [&] { read_scene_result(place.path()); });
  EXPECT_NO_THROW(read_scene_result(place.path()));
}

TEST(SceneDirectory, RejectsPlanesOfAnotherSizeAndFilesElsewhere) {
  const TemporaryDirectory place;
  write_scene_result(place.path(), scene(), OutputPolicy::overwrite);
  SceneResult larger{.name = "larger", .truth = SceneImage(4, 4)};
  larger.view = PinholeView::centred(4, 4, 1.0);
  write_scene_result(place / "larger", larger, OutputPolicy::overwrite);
  fs::copy_file(place / "larger" / "albedo.npy", place / "low-hamiltonian-k4.npy",
                fs::copy_options::overwrite_existing);
  EXPECT_THAT(io_error_of([&] { read_scene_result(place.path()); }),
              HasSubstr("found 4 x 4 pixels; expected the 2 x 3"));
  std::string json = read_text_file(place / "scene.json");
  const std::string from = "\"low-hamiltonian-k4.npy\"";
  json.replace(json.find(from), from.size(), "\"../elsewhere.npy\"");
  write_file_atomically(place / "scene.json", json, OutputPolicy::overwrite);
  EXPECT_THAT(io_error_of([&] { read_scene_result(place.path()); }),
              HasSubstr("/captures/0/decodings/0/file"));
}

}  // namespace

}  // namespace tofsmith
