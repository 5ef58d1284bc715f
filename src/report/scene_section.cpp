// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/design_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

namespace {

std::string light_text(const SceneCapture& capture) {
  return fmt::format("{} light (S = {} e/s, A = {} e/s)", capture.light,
                     level_text(capture.point.signal_e_per_s),
                     level_text(capture.point.ambient_e_per_s));
}

Figure true_scene_figure(const SceneResult& scene, const Camera& camera) {
  ColourScale colours{.label = "depth", .unit = "m", .range = depth_range(scene.truth, camera)};
  return image_figure({.id = "true-depth",
                       .title = "The scene",
                       .caption = "True distance along each ray; pixels without return are left "
                                  "empty.",
                       .alt_text = "Map of true depth"},
                      {{.pixels = wrapped_depth_m(scene.truth, camera)}}, colours);
}

Figure albedo_figure(const SceneResult& scene) {
  ColourScale colours{.label = "albedo", .map = ColourMap::cividis, .range = ValueRange{0.0, 1.0}};
  return image_figure({.id = "albedo",
                       .title = "Albedo",
                       .caption = "Share of light that each surface returns.",
                       .alt_text = "Map of albedo"},
                      {{.pixels = scene.truth.albedo}}, colours);
}

/// "hamiltonian-k4: 12.1 mm", or with a filter "hamiltonian-k4: 12.1, filtered 4.0 mm".
std::string title_of(const SceneDecoding& decoding) {
  std::string title = fmt::format("{}: {:.1f}", decoding.code, 1e3 * decoding.error.mean_m);
  if (decoding.filtered)
    title += fmt::format(", filtered {:.1f}", 1e3 * decoding.filtered->error.mean_m);
  return title + " mm";
}

/// With a filter, a slider separates unfiltered depth (left) from filtered depth (right).
Figure decoded_figure(const SceneResult& scene, const SceneCapture& capture, const Camera& camera) {
  std::vector<ValueImage> images;
  double scale_m = 0.0;
  for (const SceneDecoding& d : capture.decodings) {
    scale_m = std::max(scale_m, d.error.median_m);
    images.push_back(
        {.title = title_of(d), .pixels = d.filtered ? d.filtered->depth_m : d.depth_m});
    if (d.filtered) images.back().before = d.depth_m;
  }
  return image_figure({.id = figure_id("decoded", capture.light),
                       .title = fmt::format("Decoded depth, {}", light_text(capture)),
                       .caption = "Titles contain mean errors; all errors are circular.",
                       .alt_text = "Maps of decoded depth and its error"},
                      images,
                      {.label = "depth", .unit = "m", .range = depth_range(scene.truth, camera)},
                      {.max_side = 160,
                       .before_name = "unfiltered",
                       .after_name = "filtered",
                       .reference = error_reference(scene.truth, camera, 4e3 * scale_m)});
}

const SceneDecoding* decoding_of(const SceneCapture& capture, const std::string& code) {
  const auto found = std::ranges::find(capture.decodings, code, &SceneDecoding::code);
  return found == capture.decodings.end() ? nullptr : &*found;
}

/// Number of averaged measurements at every light level; none without a filter.
std::optional<Figure> averaged_figure(const SceneResult& scene, const std::string& best_code) {
  std::vector<ValueImage> images;
  for (const SceneCapture& capture : scene.captures)
    if (const SceneDecoding* const d = decoding_of(capture, best_code); d && d->filtered)
      images.push_back({.title = capture.light + " light", .pixels = d->filtered->averaged});
  if (images.empty()) return std::nullopt;
  return image_figure(
      {.id = "averaged",
       .title = "Averaged measurements",
       .caption = "Effective number of averaged measurements of each pixel: ratio of the noise "
                  "variances before and after filtering. It is smallest at edges and where no "
                  "light returns.",
       .alt_text = "Maps of the number of averaged measurements"},
      images, {.label = "measurements", .map = ColourMap::cividis, .logarithmic = true},
      {.max_side = 160});  // smooth images
}

std::vector<std::string> error_row(const std::string& light, const std::string& code,
                                   const SceneError& error) {
  return {light,
          code,
          fmt::format("{:.2f}", 1e3 * error.mean_m),
          fmt::format("{:.2f}", 1e3 * error.median_m),
          fmt::format("{:.2f}", 100 * error.outlier_rate),
          fmt::format("{:.2f}", 100 * error.decoded_share)};
}

Table error_table(const SceneResult& scene) {
  Table table{.id = "scene-errors",
              .caption = {},
              .columns = {{"light"},
                          {"code"},
                          {"mean (mm)", true},
                          {"median (mm)", true},
                          {"outliers (%)", true},
                          {"pixels with depth (%)", true}}};
  double outlier_threshold_m = 0.0;
  const auto add = [&](const std::string& light, const std::string& code, const auto& decoding) {
    outlier_threshold_m = decoding.error.outlier_threshold_m;
    table.rows.push_back(error_row(light, code, decoding.error));
  };
  for (const SceneCapture& capture : scene.captures)
    for (const SceneDecoding& d : capture.decodings) {
      add(capture.light, d.code, d);
      if (d.filtered) add(capture.light, d.code + ", filtered", *d.filtered);
    }
  table.caption = fmt::format(
      "Depth errors on the scene; outliers are off by more than {:.3g} m or have no depth.",
      outlier_threshold_m);
  return table;
}

Figure cloud_figure(const SceneResult& scene, const SceneCapture& capture,
                    const SceneDecoding& decoding, const Camera& camera) {
  std::vector<ColouredPoints> clouds;
  clouds.push_back(cloud_of(scene.view, decoding.filtered ? "unfiltered" : "", decoding.depth_m));
  if (decoding.filtered)
    clouds.push_back(cloud_of(scene.view, "filtered", decoding.filtered->depth_m));
  return point_cloud_figure(
      {.id = "point-cloud",
       .title = fmt::format("Point cloud, {}, {} light", decoding.code, capture.light),
       .caption = "All decoded pixels in three dimensions. Drag to rotate.",
       .alt_text = decoding.filtered ? "Point clouds of the decoded scene, unfiltered and filtered"
                                     : "Point cloud of the decoded scene"},
      clouds, {.label = "depth", .unit = "m", .range = depth_range(scene.truth, camera)},
      {.max_points = 20000});
}

std::string name_with_error(const SceneDecoding& decoding) {
  return fmt::format("{}: {:.0f} mm", decoding.code, 1e3 * decoding.error.mean_m);
}

}  // namespace

ValueRange depth_range(const SceneImage& truth, const Camera& camera) {
  ValueRange range{1e9, -1e9};
  for (const float depth : wrapped_depth_m(truth, camera).pixels) {
    if (!std::isfinite(depth)) continue;
    range.low = std::min<double>(range.low, depth);
    range.high = std::max<double>(range.high, depth);
  }
  if (range.low > range.high) return {0.0, camera.range_m()};
  const double room = 0.02 * (range.high - range.low) + 0.01;
  return {std::max(0.0, range.low - room), std::min(camera.range_m(), range.high + room)};
}

ImageReference error_reference(const SceneImage& truth, const Camera& camera, double limit_mm) {
  const double end_mm = std::max(1.0, limit_mm);
  return {.name = "error",
          .values = wrapped_depth_m(truth, camera),
          .period = camera.range_m(),
          .factor = 1e3,
          .colours = {.label = "decoded minus true",
                      .unit = "mm",
                      .map = ColourMap::diverging,
                      .range = ValueRange{-end_mm, end_mm}}};
}

ColouredPoints cloud_of(const PinholeView& view, std::string title, const Image<float>& depth_m) {
  const auto count = static_cast<Eigen::Index>(depth_m.size());
  ColouredPoints cloud{.title = std::move(title),
                       .points = Eigen::MatrixX3f(count, 3),
                       .values = Eigen::VectorXf(count)};
  Eigen::Index i = 0;
  for (int row = 0; row < depth_m.height; ++row)
    for (int column = 0; column < depth_m.width; ++column, ++i) {
      const auto depth = static_cast<double>(depth_m(row, column));
      cloud.points.row(i) = (view.ray(row, column) * depth).cast<float>().transpose();
      cloud.values[i] = depth_m(row, column);
    }
  return cloud;
}

std::optional<Figure> before_after_figure(const SceneResult& scene, const Camera& camera,
                                          const std::string& best_code) {
  if (scene.captures.empty()) return std::nullopt;
  const SceneCapture& capture = scene.captures[scene.captures.size() / 2];
  const SceneDecoding* const best = decoding_of(capture, best_code);
  const auto standard = std::ranges::find_if(
      capture.decodings, [&](const SceneDecoding& d) { return d.code != best_code; });
  if (best == nullptr || standard == capture.decodings.end()) return std::nullopt;
  return image_figure(
      {.id = "before-after",
       .title = fmt::format("Depth of the scene {}", scene.name),
       .caption = fmt::format("{}. Labels: mean errors, unfiltered.", light_text(capture)),
       .alt_text = fmt::format("Depth decoded with {} on the left and {} on the right",
                               standard->code, best_code)},
      {{.title = "", .pixels = best->depth_m, .before = standard->depth_m}},
      {.label = "depth", .unit = "m", .range = depth_range(scene.truth, camera)},
      {.before_name = name_with_error(*standard), .after_name = name_with_error(*best)});
}

Section scene_section(const SceneResult& scene, const Camera& camera,
                      const std::string& best_code) {
  Section section{.title = "A scene: " + scene.name};
  section.blocks.push_back(Paragraph{fmt::format(
      "The scene is captured in simulation at each light level and decoded with every "
      "code. S is the signal from a surface of albedo 1 that faces the camera at {:.2f} m; "
      "the signal decreases with the square of the distance. A is the ambient light.",
      scene.reference_distance_m)});
  const auto is_filtered = [](const SceneCapture& capture) {
    return std::ranges::any_of(capture.decodings,
                               [](const SceneDecoding& d) { return d.filtered.has_value(); });
  };
  if (std::ranges::any_of(scene.captures, is_filtered))
    section.blocks.push_back(
        Paragraph{"Filtered: measurements of neighbouring pixels whose depths agree within the "
                  "noise are averaged before decoding."});
  section.blocks.push_back(true_scene_figure(scene, camera));
  section.blocks.push_back(albedo_figure(scene));
  for (const SceneCapture& capture : scene.captures) {
    if (capture.decodings.empty()) continue;
    section.blocks.push_back(decoded_figure(scene, capture, camera));
  }
  if (auto averaged = averaged_figure(scene, best_code))
    section.blocks.push_back(std::move(*averaged));
  if (scene.captures.empty()) return section;
  section.blocks.push_back(error_table(scene));
  const SceneCapture& brightest = scene.captures.back();
  if (const SceneDecoding* const d = decoding_of(brightest, best_code))
    section.blocks.push_back(cloud_figure(scene, brightest, *d, camera));
  return section;
}

}  // namespace tofsmith
