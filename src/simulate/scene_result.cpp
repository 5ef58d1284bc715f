// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/scene_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

Image<float> wrapped_depth_m(const SceneImage& scene, const Camera& camera) {
  Image<float> wrapped = scene.depth_m;
  for (float& depth : wrapped.pixels)
    if (std::isfinite(depth)) depth = static_cast<float>(wrap(depth, camera.range_m()));
  return wrapped;
}

Image<float> depth_difference_m(const Image<float>& decoded_m, const SceneImage& scene,
                                const Camera& camera, DepthErrorKind kind) {
  require(decoded_m.height == scene.height() && decoded_m.width == scene.width(),
          "size of the decoded depth", fmt::format("{} x {}", decoded_m.height, decoded_m.width),
          fmt::format("must equal the scene's {} x {}", scene.height(), scene.width()));
  const Image<float> truth = wrapped_depth_m(scene, camera);
  Image<float> difference(decoded_m.height, decoded_m.width,
                          std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double d = decoded_m.pixels[i], t = truth.pixels[i];
    if (!std::isfinite(d) || !std::isfinite(t)) continue;
    difference.pixels[i] = static_cast<float>(
        kind == DepthErrorKind::linear ? d - t : circular_difference(d, t, camera.range_m()));
  }
  return difference;
}

SceneError scene_error(const Image<float>& decoded_m, const SceneImage& scene, const Camera& camera,
                       DepthErrorKind kind, double outlier_threshold_m) {
  const Image<float> difference = depth_difference_m(decoded_m, scene, camera, kind);
  SceneError error{.outlier_threshold_m = outlier_threshold_m};
  std::vector<double> sizes;
  std::int64_t outliers = 0;
  for (std::size_t i = 0; i < difference.size(); ++i) {
    if (!std::isfinite(scene.depth_m.pixels[i])) continue;
    ++error.pixels;
    const double size = std::abs(static_cast<double>(difference.pixels[i]));
    if (std::isfinite(size)) {
      sizes.push_back(size);
      error.mean_m += size;
    }
    if (!(size <= outlier_threshold_m)) ++outliers;
  }
  if (error.pixels == 0) return error;
  error.outlier_rate = static_cast<double>(outliers) / static_cast<double>(error.pixels);
  error.decoded_share = static_cast<double>(sizes.size()) / static_cast<double>(error.pixels);
  if (sizes.empty()) return error;
  error.mean_m /= static_cast<double>(sizes.size());
  error.median_m = median_of(std::move(sizes));
  return error;
}

namespace {

double share(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

/// Crops and bins to the sensor area that an Azure Kinect uses for this image size.
/// @see Azure Kinect Sensor SDK, src/transformation/mode_specific_calibration.c
void take_azure_kinect_mode(PinholeView& view) {
  struct Mode {
    int width, height, binning, first_column, first_row;
  };
  constexpr Mode modes[] = {{640, 576, 1, 192, 180}, {320, 288, 2, 96, 90}, {512, 512, 2, 0, 0}};
  for (const auto& [width, height, binning, first_column, first_row] : modes) {
    if (view.width != width || view.height != height) continue;
    view.fx_px /= binning;
    view.fy_px /= binning;
    view.cx_px = (view.cx_px + 0.5) / binning - 0.5 - first_column;
    view.cy_px = (view.cy_px + 0.5) / binning - 0.5 - first_row;
  }
}

}  // namespace

PinholeView view_of(const std::optional<Lens>& lens, int width, int height) {
  if (!lens || !lens->rays.empty())
    return PinholeView::centred(width, height, std::numbers::pi / 3);
  if (lens->width_px && lens->height_px)
    require(*lens->width_px == width && *lens->height_px == height, "image size",
            fmt::format("{} x {}", height, width),
            fmt::format("must be {} x {}, as specified by lens.height_px and lens.width_px",
                        *lens->height_px, *lens->width_px));
  PinholeView view{lens->fx_px, lens->fy_px, lens->cx_px,     lens->cy_px,
                   width,       height,      lens->distortion};
  if (lens->frame_modes) take_azure_kinect_mode(view);
  return view;
}

Lens lens_of(const PinholeView& view) {
  return {.fx_px = view.fx_px,
          .fy_px = view.fy_px,
          .cx_px = view.cx_px,
          .cy_px = view.cy_px,
          .distortion = view.distortion};
}

double SceneExtent::no_return_share() const { return share(pixels - returns, pixels); }
double SceneExtent::beyond_range_share() const { return share(beyond_range, returns); }

SceneExtent scene_extent(const SceneImage& scene, const Camera& camera) {
  SceneExtent extent{.pixels = static_cast<std::int64_t>(scene.depth_m.size()),
                     .range_m = camera.range_m()};
  std::vector<double> depths_m;
  for (const float depth_m : scene.depth_m.pixels)
    if (std::isfinite(depth_m)) depths_m.push_back(depth_m);
  extent.returns = static_cast<std::int64_t>(depths_m.size());
  if (depths_m.empty()) return extent;
  const Image<std::uint8_t> beyond = beyond_range(scene, camera);
  extent.beyond_range =
      std::accumulate(beyond.pixels.begin(), beyond.pixels.end(), std::int64_t{0});
  const auto [nearest, farthest] = std::minmax_element(depths_m.begin(), depths_m.end());
  extent.nearest_m = *nearest;
  extent.farthest_m = *farthest;
  extent.median_m = median_of(std::move(depths_m));
  return extent;
}

Image<std::uint8_t> beyond_range(const SceneImage& scene, const Camera& camera) {
  Image<std::uint8_t> beyond(scene.height(), scene.width());
  for (std::size_t i = 0; i < beyond.size(); ++i)
    beyond.pixels[i] = scene.depth_m.pixels[i] >= camera.range_m() ? 1 : 0;
  return beyond;
}

void capture_and_decode(SceneResult& scene, std::span<const CodeSet> codes, const Camera& camera,
                        std::span<const NamedLight> lights, std::uint64_t seed,
                        const std::optional<FilterOptions>& filter, const Progress& progress) {
  scene.captures.clear();
  std::vector<Decoder> decoders;
  std::vector<Filter> filters;
  for (const CodeSet& code : codes) {
    decoders.emplace_back(make_decoding_table(ForwardModel(code, camera), camera));
    if (filter) filters.emplace_back(decoders.back().table(), *filter);
  }
  FilteredFrame filtered;
  const ProgressParts parts(progress, codes.size() * lights.size());
  for (const NamedLight& light : lights) {
    SceneCapture capture_result{light.name, light.point, {}};
    for (std::size_t i = 0; i < codes.size(); ++i) {
      report(parts[scene.captures.size() * codes.size() + i], 0.0,
             fmt::format("{} at {} light", codes[i].name(), light.name));
      const CaptureOptions options{.signal_e_per_s = light.point.signal_e_per_s,
                                   .ambient_e_per_s = light.point.ambient_e_per_s,
                                   .reference_distance_m = scene.reference_distance_m,
                                   .seed = seed};
      const RawFrames raw = capture(scene.truth, codes[i], camera, options);
      SceneDecoding decoding{codes[i].name(), decoders[i].decode(raw).depth_m, {}};
      const auto error_of = [&](const Image<float>& depth_m) {
        return scene_error(depth_m, scene.truth, camera, DepthErrorKind::circular);
      };
      decoding.error = error_of(decoding.depth_m);
      if (filter) {
        filters[i].apply(view_of_frame(raw, 0), filtered);
        FilteredSceneDecoding& result = decoding.filtered.emplace();
        result.depth_m = Image<float>(raw.height, raw.width);
        result.averaged = filtered.averaged();
        decoders[i].decode(filtered.view(), {.depth_m = result.depth_m.pixels.data()});
        result.error = error_of(result.depth_m);
      }
      capture_result.decodings.push_back(std::move(decoding));
    }
    scene.captures.push_back(std::move(capture_result));
  }
  report(progress, 1.0, "scene decoded");
}

double median_depth_m(const SceneImage& scene) {
  std::vector<double> depths;
  for (const float depth : scene.depth_m.pixels)
    if (std::isfinite(depth)) depths.push_back(depth);
  return depths.empty() ? 1.0 : median_of(std::move(depths));
}

}  // namespace tofsmith
