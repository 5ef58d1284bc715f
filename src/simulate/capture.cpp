// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/capture.hpp"
#include "tofsmith/simulate/staged_capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/shared/shared_progress.hpp"
#include "simulate/lens_light.hpp"
#include "simulate/pixel_capture.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

void SceneLight::validate(const SceneImage& scene, const Camera& camera) const {
  const double range_m = camera.range_m();
  if (!returns.empty()) returns.validate(scene, range_m);
  if (tail) tail->validate(range_m);
  if (transients.empty()) return;
  require(returns.empty() && !tail, "transients", transients.size(),
          "must not be combined with multipath returns or a tail, which they already contain");
  require(
      transients.size() == 1 || transients.size() == scene.depth_m.size(), "transients",
      transients.size(),
      "must be one, or one for each of the " + std::to_string(scene.depth_m.size()) + " pixels");
  for (const Transient& transient : transients) transient.validate(range_m);
}

RawFrames empty_frames(int frames, int height, int width, int measurements) {
  RawFrames raw{frames, height, width, measurements, {}};
  raw.values.resize(raw.pixels_per_frame() * static_cast<std::size_t>(measurements) *
                    static_cast<std::size_t>(frames));
  return raw;
}

namespace {

/// @param raw  (W, K)
void expose_row(const RowCapture& source, const CollectedLight& collected, int frame,
                std::int64_t row, float* raw) {
  const auto taps = static_cast<std::ptrdiff_t>(source.tap_values());
  std::vector<double> light(static_cast<std::size_t>(taps));
  for (std::int64_t pixel = row * collected.width; pixel < (row + 1) * collected.width; ++pixel) {
    std::copy_n(collected.taps.begin() + pixel * taps, taps, light.begin());
    const double ambient_e_per_s = collected.ambient.empty()
                                       ? source.ambient_e_per_s()
                                       : collected.ambient[static_cast<std::size_t>(pixel)];
    source.expose(frame, static_cast<std::uint64_t>(pixel), ambient_e_per_s, light, raw);
    raw += source.measurements();
  }
}

/// @param light  null: the direct light of the source's scene, one ray per pixel
/// @param shared  advances by 1 per row
void expose_frame(const RowCapture& source, const CollectedLight* light, int frame, RawFrames& raw,
                  SharedProgress& shared) {
  const std::int64_t row_values = std::int64_t{raw.width} * raw.measurements;
  float* const values = raw.frame(frame);
  parallel_for(raw.height, [&](std::int64_t row) {
    if (light)
      expose_row(source, *light, frame, row, values + row * row_values);
    else
      source.row(frame, static_cast<int>(row), values + row * row_values);
    shared.add();
  });
}

/// Exposes frames under the same light, each with independent noise.
/// @throws Interrupted if `progress` cancels
RawFrames captured_frames(const RowCapture& source, const CollectedLight* light, int frames,
                          const Progress& progress) {
  const int height = light ? light->height : source.scene().height(),
            width = light ? light->width : source.scene().width();
  RawFrames raw = empty_frames(frames, height, width, source.measurements());
  SharedProgress shared(progress, static_cast<double>(frames) * height, "capture");
  for (int frame = 0; frame < frames; ++frame) expose_frame(source, light, frame, raw, shared);
  report(progress, 1.0, "capture");
  return raw;
}

}  // namespace

RawFrames capture(const SceneImage& scene, const SceneLight& light, const CodeSet& code,
                  const Camera& camera, const CaptureOptions& options, const Progress& progress) {
  light.validate(scene, camera);
  const RowCapture source(scene, light, ForwardModel(code, camera), camera, options);
  const LensBlur blur = camera.blur.value_or(LensBlur());
  if (blur.kind == LensBlur::Kind::none && light.stray_light.empty())
    return captured_frames(source, nullptr, options.frames, progress);
  CollectedLight blurred(scene.height(), scene.width(), source.tap_values());
  add_light(source, blur, 1, {0, source.tap_values()}, blurred);
  scatter_light(light.stray_light, options.ambient_e_per_s, blurred);
  return captured_frames(source, &blurred, options.frames, progress);
}

MultipathTruth multipath_truth(const SceneImage& scene, const SceneLight& light,
                               const CaptureOptions& options) {
  MultipathTruth truth;
  truth.direct_m = scene.depth_m;
  truth.direct_e_per_s = {scene.height(), scene.width()};
  for (int row = 0; row < scene.height(); ++row)
    for (int column = 0; column < scene.width(); ++column) {
      const double signal = pixel_signal_e_per_s(scene, row, column, options);
      truth.direct_e_per_s(row, column) = static_cast<float>(signal);
      if (!light.returns.empty())
        for (const MultipathReturn& later : light.returns.of(row, column)) {
          truth.distance_m.push_back(later.distance_m);
          truth.signal_e_per_s.push_back(static_cast<float>(signal * later.ratio));
        }
      truth.first.push_back(static_cast<std::int64_t>(truth.distance_m.size()));
    }
  return truth;
}

void CaptureOptions::validate() const { check_fields(*this); }

double pixel_signal_e_per_s(const SceneImage& scene, int row, int column,
                            const CaptureOptions& options) {
  const double depth_m = scene.depth_m(row, column);
  if (std::isnan(depth_m)) return 0.0;
  const double reflected = options.signal_e_per_s * scene.albedo(row, column);
  if (!options.falloff) return reflected;
  const double distance = depth_m / options.reference_distance_m;
  return reflected * scene.cosine(row, column) / (distance * distance);
}

RawFrames capture(const SceneImage& scene, const CodeSet& code, const Camera& camera,
                  const CaptureOptions& options, const Progress& progress) {
  return capture(scene, SceneLight(), code, camera, options, progress);
}

namespace {

Image<float> repeated(const Image<float>& image, int n) {
  Image<float> result(n * image.height, n * image.width);
  for (int row = 0; row < result.height; ++row)
    for (int column = 0; column < result.width; ++column)
      result(row, column) = image(row / n, column / n);
  return result;
}

/// @param pixel_rays  with each pixel divided samples x samples
SceneImage rays_of(const RayCaster& caster, const PixelRays& pixel_rays, const StagedScene& scene,
                   const StagedSetup& setup, int samples) {
  SceneImage rays = caster.see(pixel_rays, scene.camera_to_world).image;
  if (!setup.ambient_scale.empty()) rays.ambient_scale = repeated(setup.ambient_scale, samples);
  return rays;
}

SceneLight light_of(const StagedScene& scene, const SceneImage& rays, const StagedSetup& setup,
                    int samples) {
  if (!setup.light) return {};
  StagedScene divided = scene;
  divided.view = scene.view.divided(samples);
  return setup.light(divided, rays);
}

/// Computes the rays of pixels and the search structures of static meshes once.
class MovingView {
 public:
  /// @param samples  rays per pixel along each axis
  MovingView(const StagedScene& scene, const StagedSetup& setup, int samples)
      : setup_(setup),
        samples_(samples),
        centres_(scene.view),
        parts_(samples == 1 ? PixelRays() : PixelRays(scene.view.divided(samples))) {
    if (scene.shapes_are_still()) still_.emplace(scene.shapes, setup.search_of);
  }

  SceneImage rays_at(const StagedScene& now) const {
    return samples_ == 1 ? centres_at(now) : see(parts_, now, samples_);
  }
  SceneImage centres_at(const StagedScene& now) const { return see(centres_, now, 1); }

 private:
  SceneImage see(const PixelRays& pixel_rays, const StagedScene& now, int samples) const {
    if (still_) return rays_of(*still_, pixel_rays, now, setup_, samples);
    return rays_of(RayCaster(now.shapes, setup_.search_of), pixel_rays, now, setup_, samples);
  }

  const StagedSetup& setup_;
  int samples_;
  PixelRays centres_, parts_;
  std::optional<RayCaster> still_;
};

/// Captures each exposure from the scene at its middle.
StagedCapture capture_moving(const StagedScene& scene, const CodeSet& code, const Camera& camera,
                             const CaptureOptions& options, const StagedSetup& setup,
                             const Progress& progress) {
  options.validate();
  const ForwardModel model(code, camera);
  const Camera timed = timed_by(code, camera);
  const LensBlur blur = camera.blur.value_or(LensBlur());
  const int samples = blur.pixel_samples, exposures = code.exposures();
  const MovingView view(scene, setup, samples);
  const int height = scene.view.height, width = scene.view.width;
  SceneImage rays(samples * height, samples * width);
  SceneLight light;
  RowCapture source(rays, light, model, camera, options);
  const int taps = source.tap_values() / exposures;
  StagedCapture result;
  result.raw = empty_frames(options.frames, height, width, source.measurements());
  for (int frame = 0; frame < options.frames; ++frame) {
    CollectedLight pixels(height, width, source.tap_values());
    for (int exposure = 0; exposure < exposures; ++exposure) {
      report(progress, (frame + static_cast<double>(exposure) / exposures) / options.frames,
             "capture");
      const StagedScene now = scene.at(timed.exposure_middle_s(frame, exposure, exposures));
      rays = view.rays_at(now);
      light = light_of(now, rays, setup, samples);
      light.validate(rays, camera);
      source.see(rays, light, model, camera);
      add_light(source, blur, samples, {exposure * taps, taps}, pixels);
    }
    scatter_light(setup.stray_light, options.ambient_e_per_s, pixels);
    SharedProgress none({}, height, "capture");
    expose_frame(source, &pixels, frame, result.raw, none);
    result.truth.push_back(view.centres_at(scene.at(timed.frame_middle_s(frame, exposures))));
    result.near_m.push_back(std::move(pixels.near_m));
    result.far_m.push_back(std::move(pixels.far_m));
  }
  report(progress, 1.0, "capture");
  return result;
}

}  // namespace

StagedCapture capture(const StagedScene& scene, const CodeSet& code, const Camera& camera,
                      const CaptureOptions& options, const StagedSetup& setup,
                      const Progress& progress) {
  scene.view.validate();
  const Image<float>& ambient_scale = setup.ambient_scale;
  require(
      ambient_scale.empty() ||
          (ambient_scale.height == scene.view.height && ambient_scale.width == scene.view.width),
      "size of ambient_scale", fmt::format("{} x {}", ambient_scale.height, ambient_scale.width),
      fmt::format("must equal the view's, {} x {}", scene.view.height, scene.view.width));
  if (!scene.is_still()) return capture_moving(scene, code, camera, options, setup, progress);
  const RayCaster caster(scene.shapes, setup.search_of);
  StagedCapture result;
  result.truth = {rays_of(caster, PixelRays(scene.view), scene, setup, 1)};
  const SceneImage& truth = result.truth.front();
  const LensBlur blur = camera.blur.value_or(LensBlur());
  if (blur.is_sharp()) {
    SceneLight light = light_of(scene, truth, setup, 1);
    light.stray_light = setup.stray_light;
    result.raw = capture(truth, light, code, camera, options, progress);
    result.near_m = result.far_m = {truth.depth_m};
    return result;
  }
  const SceneImage rays = rays_of(caster, PixelRays(scene.view.divided(blur.pixel_samples)), scene,
                                  setup, blur.pixel_samples);
  const SceneLight light = light_of(scene, rays, setup, blur.pixel_samples);
  light.validate(rays, camera);
  const RowCapture source(rays, light, ForwardModel(code, camera), camera, options);
  CollectedLight pixels(truth.height(), truth.width(), source.tap_values());
  add_light(source, blur, blur.pixel_samples, {0, source.tap_values()}, pixels);
  scatter_light(setup.stray_light, options.ambient_e_per_s, pixels);
  result.raw = captured_frames(source, &pixels, options.frames, progress);
  result.near_m = {std::move(pixels.near_m)};
  result.far_m = {std::move(pixels.far_m)};
  return result;
}

}  // namespace tofsmith
