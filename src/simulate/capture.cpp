// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/capture.hpp"

#include <cmath>

#include "simulate/lens_light.hpp"
#include "simulate/row_capture.hpp"
#include "tofsmith/core/error.hpp"

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

}  // namespace tofsmith
