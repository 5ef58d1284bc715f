// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "simulate/lens_light.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/stray_light.hpp"
#include "tofsmith/simulate/staged_capture.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

const LensBlur gaussian{.kind = LensBlur::Kind::gaussian, .blur_sigma_px = 0.5, .pixel_samples = 3};
const LensBlur disc{.kind = LensBlur::Kind::disc,
                    .focal_length_m = 8e-3,
                    .f_number = 1.2,
                    .focus_distance_m = 2.0,
                    .pixel_pitch_m = 10e-6,
                    .pixel_samples = 2};

/// Shot and read noise are far below every tolerance.
Camera quiet_camera(const LensBlur& blur) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.noise = NoiseModel::gaussian;
  camera.sensor.read_noise_e = 0.0;
  camera.exposure_s.total_s = 1e12;
  camera.blur = blur;
  return camera;
}

CodeSet code_of(const Camera& camera) { return build_family("hamiltonian-k4", camera); }

RawFrames captured(const SceneImage& scene, const Camera& camera) {
  return capture(scene, code_of(camera), camera, {.ambient_e_per_s = 0.0, .falloff = false});
}

SceneImage image_of(int height, int width, const std::function<float(int, int)>& depth_m) {
  SceneImage scene(height, width);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      scene.depth_m(row, column) = depth_m(row, column);
  return scene;
}

double largest_relative_difference(const RawFrames& a, const RawFrames& b) {
  const float scale = *std::max_element(b.values.begin(), b.values.end());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(a.values[i]) - b.values[i]) / scale);
  return largest;
}

TEST(Lens, KernelsDistributeAllLight) {
  for (const double sigma_px : {0.0, 0.1, 0.5, 3.0})
    for (const int samples : {1, 2, 3, 5}) {
      const AxisKernel kernel(sigma_px, samples);
      ASSERT_EQ(kernel.weights.size(), static_cast<std::size_t>(samples + 2 * kernel.reach));
      // The rays at one position within their pixels distribute their light exactly once.
      for (int place = 0; place < samples; ++place) {
        double sum = 0.0;
        for (std::size_t i = 0; i < kernel.weights.size(); ++i)
          if ((static_cast<int>(i) - kernel.reach - place) % samples == 0) sum += kernel.weights[i];
        EXPECT_NEAR(sum, 1.0 / samples, 1e-6) << sigma_px << " " << samples;
      }
    }
}

TEST(Lens, AreasOfADiscWithinSquaresEqualFineSums) {
  for (const double radius : {0.3, 1.0, 2.7}) {
    EXPECT_NEAR(disc_area(radius, -radius, radius, -radius, radius),
                std::numbers::pi * radius * radius, 1e-12);
    for (const auto& [x, y] : {std::pair(0.0, 0.0), {0.2, -0.6}, {-1.1, 0.4}, {2.0, 1.5}}) {
      constexpr int parts = 400;
      int inside = 0;
      for (int i = 0; i < parts; ++i)
        for (int j = 0; j < parts; ++j)
          inside += std::hypot(x + (i + 0.5) / parts - 0.5, y + (j + 0.5) / parts - 0.5) < radius;
      EXPECT_NEAR(disc_area(radius, x - 0.5, x + 0.5, y - 0.5, y + 0.5),
                  static_cast<double>(inside) / (parts * parts), 2e-3);
    }
  }
}

TEST(Lens, DoesNotChangeAUniformWall) {
  const SceneImage wall = image_of(21, 17, [](int, int) { return 1.5f; });
  const RawFrames sharp = captured(wall, quiet_camera({}));
  for (LensBlur blur : {gaussian, disc}) {
    EXPECT_LT(largest_relative_difference(captured(wall, quiet_camera(blur)), sharp), 1e-6);
    blur.blur_sigma_px = 6.0;  // wider than the image with its mirror images
    blur.focus_distance_m = 0.3;
    EXPECT_LT(largest_relative_difference(captured(wall, quiet_camera(blur)), sharp), 1e-6);
  }
}

TEST(Lens, ConservesTheLightOfTheImage) {
  SceneImage scene = image_of(24, 31, [](int row, int column) {
    return (row * column) % 7 == 0 ? std::nanf("") : 0.8f + 0.1f * static_cast<float>(row % 9);
  });
  for (std::size_t i = 0; i < scene.albedo.size(); ++i)
    scene.albedo.pixels[i] = 0.1f * static_cast<float>(i % 11);
  const auto totals = [&](const LensBlur& blur) {
    const RawFrames raw = captured(scene, quiet_camera(blur));
    std::vector<double> sums(4);
    for (std::size_t i = 0; i < raw.values.size(); ++i) sums[i % 4] += raw.values[i];
    return sums;
  };
  const std::vector<double> sharp = totals({});
  for (const LensBlur& blur : {gaussian, disc}) {
    const std::vector<double> blurred = totals(blur);
    const double scale = *std::max_element(sharp.begin(), sharp.end());
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(blurred[k], sharp[k], 1e-6 * scale);
  }
}

/// A near half-plane in front of a far wall, with its edge within a pixel.
StagedScene edge_scene(int width, int height) {
  return {.shapes = {Box{.centre = {-1.03, 0.0, 1.0},
                         .size_m = {2.0, 4.0, 0.001},
                         .texture = {.albedo = 0.9, .image = {}}},
                     Plane{.point = {0, 0, 3.0}, .texture = {.albedo = 0.6, .image = {}}}},
          .view = PinholeView::centred(width, height, 0.6)};
}

/// Reference without kernels on rays: a supersampled view, summed over its pixels with the weights
/// of the point spread function.
RawFrames by_brute_force(const StagedScene& scene, const Camera& camera, int parts, int margin_px) {
  Camera sharp = camera;
  sharp.blur.reset();
  const LensBlur& blur = *camera.blur;
  const SceneImage fine = ray_cast(scene.shapes, scene.view.divided(parts));
  const RawFrames rays = captured(fine, sharp);
  RawFrames raw{1, scene.view.height, scene.view.width, rays.measurements, {}};
  raw.values.assign(raw.pixels_per_frame() * static_cast<std::size_t>(raw.measurements), 0.0f);
  const auto mirrored = [](int i, int size) {
    return i < 0 ? -1 - i : i >= size ? 2 * size - 1 - i : i;
  };
  const auto share = [&](double x_px, double y_px, float depth_m) {
    if (blur.kind == LensBlur::Kind::gaussian) {
      const auto along = [&](double u) {
        const double scale = blur.blur_sigma_px * std::numbers::sqrt2;
        return 0.5 * (std::erf((u + 0.5) / scale) - std::erf((u - 0.5) / scale));
      };
      return along(x_px) * along(y_px);
    }
    const double radius = std::max(blur.disc_radius_px(depth_m), 1e-3);
    return disc_area(radius, x_px - 0.5, x_px + 0.5, y_px - 0.5, y_px + 0.5) /
           (std::numbers::pi * radius * radius);
  };
  std::vector<double> sums(static_cast<std::size_t>(raw.measurements));
  for (int row = 0; row < raw.height; ++row)
    for (int column = 0; column < raw.width; ++column) {
      std::fill(sums.begin(), sums.end(), 0.0);
      const int reach = margin_px * parts;
      for (int v = row * parts - reach; v < (row + 1) * parts + reach; ++v)
        for (int u = column * parts - reach; u < (column + 1) * parts + reach; ++u) {
          const int ray_row = mirrored(v, fine.height()), ray = mirrored(u, fine.width());
          const double weight = share((u + 0.5) / parts - 0.5 - column,
                                      (v + 0.5) / parts - 0.5 - row, fine.depth_m(ray_row, ray)) /
                                (parts * parts);
          for (std::size_t k = 0; k < sums.size(); ++k)
            sums[k] +=
                weight *
                rays.values[(static_cast<std::size_t>(ray_row) * fine.width() + ray) * sums.size() +
                            k];
        }
      for (std::size_t k = 0; k < sums.size(); ++k)
        raw.values[(static_cast<std::size_t>(row) * raw.width + column) * sums.size() + k] =
            static_cast<float>(sums[k]);
    }
  return raw;
}

TEST(Lens, AnEdgeMixesBothSides) {
  const StagedScene scene = edge_scene(16, 6);
  for (LensBlur blur : {gaussian, disc}) {
    blur.pixel_samples = 16;  // locates the edge to 1/32 of a pixel
    const Camera camera = quiet_camera(blur);
    const StagedCapture made =
        capture(scene, code_of(camera), camera, {.ambient_e_per_s = 0.0, .falloff = false});
    const RawFrames expected = by_brute_force(scene, camera, 32, 4);
    EXPECT_LT(largest_relative_difference(made.raw, expected), 0.02);
    Camera sharp = camera;
    sharp.blur.reset();
    EXPECT_GT(
        largest_relative_difference(captured(ray_cast(scene.shapes, scene.view), sharp), expected),
        0.1);
  }
}

TEST(Lens, AnImageOfTwoDepthsMixesByPixelArea) {
  const SceneImage scene =
      image_of(1, 12, [](int, int column) { return column < 6 ? 1.0f : 3.0f; });
  const Camera camera = quiet_camera(gaussian);
  const RawFrames mixed = captured(scene, camera), sharp = captured(scene, quiet_camera({}));
  // Integral of the blurred indicator of a pixel over an adjacent pixel.
  const auto integral = [](double x) {
    const double s = gaussian.blur_sigma_px;
    return 0.5 * x * (1.0 + std::erf(x / (s * std::numbers::sqrt2))) +
           s * std::exp(-0.5 * x * x / (s * s)) / std::sqrt(2.0 * std::numbers::pi);
  };
  const double far_share = integral(0.0) - integral(-1.0);  // beyond an edge half a pixel away
  for (std::size_t k = 0; k < 4; ++k) {
    const double expected =
        (1.0 - far_share) * sharp.values[k] + far_share * sharp.values[11 * 4 + k];
    EXPECT_NEAR(mixed.values[5 * 4 + k] / expected, 1.0, 1e-5);
  }
}

TEST(Lens, ReportsTheDepthsThatAPixelMixes) {
  const StagedScene scene = edge_scene(16, 6);
  const Camera camera = quiet_camera(gaussian);
  const StagedCapture made = capture(scene, code_of(camera), camera, {});
  const Image<float>&near_m = made.near_m.front(), &far_m = made.far_m.front();
  int mixed = 0;
  for (int column = 0; column < 16; ++column) {
    EXPECT_LE(near_m(2, column), made.truth.front().depth_m(2, column));
    EXPECT_GE(far_m(2, column), made.truth.front().depth_m(2, column));
    mixed += far_m(2, column) - near_m(2, column) > 1.0f;
  }
  EXPECT_GE(mixed, 2);
  EXPECT_LE(mixed, 4);
}

TEST(Lens, WithoutBlurShapesAndDepthImagesAreCapturedAlike) {
  Camera camera = built_in_camera("paper-10f0");
  const StagedScene scene = built_in_scene("table-top", 32, 24);
  const SceneImage image = ray_cast(scene.shapes, scene.view, scene.camera_to_world);
  const CaptureOptions options{.seed = 3, .frames = 2};
  const RawFrames without = capture(image, code_of(camera), camera, options);
  EXPECT_EQ(capture(scene, code_of(camera), camera, options).raw.values, without.values);
  camera.blur = LensBlur{};
  EXPECT_EQ(capture(scene, code_of(camera), camera, options).raw.values, without.values);
  camera.blur->pixel_samples = 4;
  EXPECT_EQ(capture(image, code_of(camera), camera, options).values, without.values);
}

TEST(Lens, NoiseIsDrawnOncePerPixelWithTheSameNumbers) {
  // A blur far below a pixel changes the light, and thus each value, by almost nothing.
  Camera camera = built_in_camera("paper-10f0");
  const SceneImage scene = image_of(9, 7, [](int, int) { return 1.0f; });
  const RawFrames sharp = capture(scene, code_of(camera), camera, {.frames = 2});
  camera.blur = gaussian;
  EXPECT_LT(
      largest_relative_difference(capture(scene, code_of(camera), camera, {.frames = 2}), sharp),
      1e-6);
}

TEST(Lens, VaryingAmbientLightIsBlurred) {
  Camera camera = quiet_camera(gaussian);
  SceneImage dark(1, 9);  // no return anywhere
  dark.ambient_scale = Image<float>(1, 9, 0.0f);
  dark.ambient_scale(0, 4) = 1.0f;
  const RawFrames raw = capture(dark, code_of(camera), camera, {.ambient_e_per_s = 100.0});
  const double total = raw.values[4 * 4] + 2.0 * raw.values[3 * 4] + 2.0 * raw.values[2 * 4];
  EXPECT_GT(raw.values[3 * 4] / total, 0.05);
  EXPECT_NEAR(raw.values[3 * 4] / raw.values[5 * 4], 1.0, 1e-5);
}

TEST(Lens, StrayLightIsTheScatteredImageOfEachMeasurement) {
  Image<float> kernel(5, 7, 0.004f);
  kernel(2, 5) = 0.02f;  // on one side only
  StagedScene moving = edge_scene(16, 6);
  moving.shape_motions = {Motion{.velocity_m_per_s = {0.1, 0, 0}}, Motion{}};
  for (const LensBlur& blur : {LensBlur{}, gaussian, disc})
    for (const bool moves : {false, true}) {
      Camera camera = quiet_camera(blur);
      if (moves) camera.exposure_s.total_s = 1.0;
      const auto seen_with = [&](const Image<float>& stray_light) {
        return capture(moves ? moving : edge_scene(16, 6), code_of(camera), camera,
                       {.signal_e_per_s = 1e12, .ambient_e_per_s = 1e11, .falloff = false},
                       {.stray_light = stray_light})
            .raw;
      };
      RawFrames expected = seen_with({});
      StrayLight stray(kernel);
      for (std::size_t k = 0; k < 4; ++k) {
        Image<float> plane(6, 16);
        for (std::size_t i = 0; i < plane.size(); ++i) plane.pixels[i] = expected.values[4 * i + k];
        const Image<float> scattered = stray.scatter(plane);
        for (std::size_t i = 0; i < plane.size(); ++i)
          expected.values[4 * i + k] = scattered.pixels[i];
      }
      EXPECT_LT(largest_relative_difference(seen_with(kernel), expected), 1e-5) << moves;
    }
  const SceneImage wall = image_of(4, 4, [](int, int) { return 1.0f; });
  const Camera camera = quiet_camera({});
  EXPECT_THROW(capture(wall, {.stray_light = Image<float>(2, 2)}, code_of(camera), camera),
               std::invalid_argument);
}

TEST(Lens, RejectsDiscsThatCoverTheImageAndTexturesOfAnotherSize) {
  const SceneImage close = image_of(4, 4, [](int, int) { return 0.01f; });
  const Camera camera = quiet_camera(disc);
  try {
    captured(close, camera);
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_EQ(error.field(), "lens.f_number");
    EXPECT_THAT(error.what(), HasSubstr("at 0.01 m, the disc of confusion"));
  }
  EXPECT_THROW(capture(edge_scene(8, 8), code_of(camera), camera, {},
                       {.search_of = {}, .light = {}, .ambient_scale = Image<float>(7, 8, 1.0f)}),
               std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
