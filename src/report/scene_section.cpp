// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/scene_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/shared/depth_error_scale.hpp"
#include "report/shared/level_text.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

namespace {

std::string light_text(const SceneCapture& capture) {
  return fmt::format("{} light (S = {} e/s, A = {} e/s)", capture.light,
                     level_text(capture.point.signal_e_per_s),
                     level_text(capture.point.ambient_e_per_s));
}

/// Smallest and largest true depth, with a little room.
ValueRange depth_range(const SceneResult& scene, const Camera& camera) {
  ValueRange range{1e9, -1e9};
  for (const float depth : wrapped_depth_m(scene.truth, camera).pixels) {
    if (!std::isfinite(depth)) continue;
    range.low = std::min<double>(range.low, depth);
    range.high = std::max<double>(range.high, depth);
  }
  if (range.low > range.high) return {0.0, camera.range_m()};
  const double room = 0.02 * (range.high - range.low) + 0.01;
  return {std::max(0.0, range.low - room), std::min(camera.range_m(), range.high + room)};
}

Figure true_scene_figure(const SceneResult& scene, const Camera& camera) {
  ColourScale colours{.label = "depth", .unit = "m", .range = depth_range(scene, camera)};
  return image_figure({.id = "true-depth",
                       .title = "The scene",
                       .caption = "True distance along each ray; pixels without return are left "
                                  "empty.",
                       .alt_text = "Map of true depth"},
                      {{.title = "true depth", .pixels = wrapped_depth_m(scene.truth, camera)}},
                      colours);
}

Figure albedo_figure(const SceneResult& scene) {
  ColourScale colours{.label = "albedo", .map = ColourMap::cividis, .range = ValueRange{0.0, 1.0}};
  return image_figure({.id = "albedo",
                       .title = "Albedo",
                       .caption = "Share of light that each surface returns.",
                       .alt_text = "Map of albedo"},
                      {{.title = "albedo", .pixels = scene.truth.albedo}}, colours);
}

Figure decoded_figure(const SceneResult& scene, const SceneCapture& capture, const Camera& camera) {
  std::vector<ValueImage> images;
  for (const SceneDecoding& d : capture.decodings)
    images.push_back({.title = d.code, .pixels = d.depth_m});
  return image_figure({.id = figure_id("decoded", capture.light),
                       .title = fmt::format("Decoded depth, {}", light_text(capture)),
                       .caption = "All codes on one colour scale, the scene's; errors beyond it "
                                  "take the colours of its ends.",
                       .alt_text = "Maps of decoded depth"},
                      images, {.label = "depth", .unit = "m", .range = depth_range(scene, camera)});
}

Figure error_figure(const SceneResult& scene, const SceneCapture& capture, const Camera& camera) {
  std::vector<ValueImage> images;
  double scale_m = 0.0;
  for (const SceneDecoding& d : capture.decodings) {
    images.push_back(
        {.title = fmt::format("{}: {:.1f} mm", d.code, 1e3 * d.error.mean_m),
         .pixels = scaled(
             depth_difference_m(d.depth_m, scene.truth, camera, DepthErrorKind::circular), 1e3)});
    scale_m = std::max(scale_m, d.error.median_m);
  }
  const double limit_mm = std::max(1.0, 4e3 * scale_m);
  return image_figure(
      {.id = figure_id("error", capture.light),
       .title = fmt::format("Depth error, {}", light_text(capture)),
       .caption = "Decoded minus true depth, the shorter way round the range; its mean size beside "
                  "each code's name.",
       .alt_text = "Maps of depth error"},
      images, depth_error_scale(limit_mm));
}

Table error_table(const SceneResult& scene) {
  double threshold_m = 0.0;  // the same for all
  for (const SceneCapture& capture : scene.captures)
    for (const SceneDecoding& d : capture.decodings) threshold_m = d.error.outlier_threshold_m;
  Table table{.id = "scene-errors",
              .caption = fmt::format("Depth errors on the scene; outliers are off by more than "
                                     "{:.3g} m or have no depth.",
                                     threshold_m),
              .columns = {{"light"},
                          {"code"},
                          {"mean (mm)", true},
                          {"median (mm)", true},
                          {"outliers (%)", true},
                          {"pixels with depth (%)", true}}};
  for (const SceneCapture& capture : scene.captures)
    for (const SceneDecoding& d : capture.decodings)
      table.rows.push_back({capture.light, d.code, fmt::format("{:.2f}", 1e3 * d.error.mean_m),
                            fmt::format("{:.2f}", 1e3 * d.error.median_m),
                            fmt::format("{:.2f}", 100 * d.error.outlier_rate),
                            fmt::format("{:.2f}", 100 * d.error.decoded_share)});
  return table;
}

Figure cloud_figure(const SceneResult& scene, const SceneCapture& capture,
                    const SceneDecoding& decoding, const Camera& camera) {
  const std::size_t count = decoding.depth_m.size();
  Eigen::MatrixX3f points(static_cast<Eigen::Index>(count), 3);
  Eigen::VectorXf values(static_cast<Eigen::Index>(count));
  Eigen::Index i = 0;
  for (int row = 0; row < decoding.depth_m.height; ++row)
    for (int column = 0; column < decoding.depth_m.width; ++column, ++i) {
      const float depth_m = decoding.depth_m(row, column);
      points.row(i) =
          (scene.view.ray(row, column) * static_cast<double>(depth_m)).cast<float>().transpose();
      values[i] = depth_m;
    }
  return point_cloud_figure(
      {.id = "point-cloud",
       .title = fmt::format("Point cloud, {}, {} light", decoding.code, capture.light),
       .caption = "Every decoded pixel at its place in front of the camera. Drag to turn.",
       .alt_text = "Point cloud of the decoded scene"},
      points, values, {.label = "depth", .unit = "m", .range = depth_range(scene, camera)});
}

}  // namespace

Section scene_section(const SceneResult& scene, const Camera& camera,
                      const std::string& best_code) {
  Section section{.title = "A scene: " + scene.name};
  section.blocks.push_back(Paragraph{
      fmt::format("The scene is captured in simulation at each light level and decoded with every "
                  "code. The signal S is that of albedo 1 facing the camera at {:.2f} m and falls "
                  "with the square of distance.",
                  scene.reference_distance_m)});
  section.blocks.push_back(true_scene_figure(scene, camera));
  section.blocks.push_back(albedo_figure(scene));
  for (const SceneCapture& capture : scene.captures) {
    if (capture.decodings.empty()) continue;
    section.blocks.push_back(decoded_figure(scene, capture, camera));
    section.blocks.push_back(error_figure(scene, capture, camera));
  }
  if (scene.captures.empty()) return section;
  section.blocks.push_back(error_table(scene));
  const SceneCapture& brightest = scene.captures.back();
  for (const SceneDecoding& d : brightest.decodings)
    if (d.code == best_code) section.blocks.push_back(cloud_figure(scene, brightest, d, camera));
  return section;
}

}  // namespace tofsmith
