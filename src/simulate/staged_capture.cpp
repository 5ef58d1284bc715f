// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/staged_capture.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "simulate/lens_light.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

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
      : scene_(scene),
        setup_(setup),
        samples_(samples),
        centres_(scene.view),
        parts_(samples == 1 ? PixelRays() : PixelRays(scene.view.divided(samples))) {
    if (scene.shapes_are_still()) still_.emplace(scene.shapes, setup.search_of);
  }

  SceneImage rays_at(const StagedScene& now) const {
    return samples_ == 1 ? centres_at(now) : see(parts_, now, samples_);
  }
  SceneImage centres_at(const StagedScene& now) const { return see(centres_, now, 1); }
  StagedScene at(double time_s) const { return scene_.at(time_s); }

 private:
  SceneImage see(const PixelRays& pixel_rays, const StagedScene& now, int samples) const {
    if (still_) return rays_of(*still_, pixel_rays, now, setup_, samples);
    return rays_of(RayCaster(now.shapes, setup_.search_of), pixel_rays, now, setup_, samples);
  }

  const StagedScene& scene_;
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
      const StagedScene now = view.at(timed.exposure_middle_s(frame, exposure, exposures));
      rays = view.rays_at(now);
      light = light_of(now, rays, setup, samples);
      light.validate(rays, camera);
      source.see(rays, light, model, camera);
      add_light(source, blur, samples, {exposure * taps, taps}, pixels);
    }
    scatter_light(setup.stray_light, options.ambient_e_per_s, pixels);
    SharedProgress none({}, height, "capture");
    expose_frame(source, &pixels, frame, result.raw.frame(frame), none);
    result.truth.push_back(view.centres_at(view.at(timed.frame_middle_s(frame, exposures))));
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
