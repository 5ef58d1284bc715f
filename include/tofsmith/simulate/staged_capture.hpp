// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// Additional inputs of capture().
struct StagedSetup {
  MeshSearchMaker search_of;  ///< see RayCaster
  /// Returns indirect light; empty: none. `scene` has a view with one pixel per ray, which `rays`
  /// shows.
  std::function<SceneLight(const StagedScene& scene, const SceneImage& rays)> light;
  Image<float> ambient_scale;  ///< as in SceneImage; empty: 1
  /// As SceneLight::stray_light, which is ignored.
  Image<float> stray_light = {};
};

/// Raw measurements with the truth.
struct StagedCapture {
  RawFrames raw;
  /// Through pixel centres: one image for a static scene; otherwise one per frame, at its middle.
  std::vector<SceneImage> truth;
  /// Distances [m] of the rays that contribute to a pixel over all exposures of a frame, as many
  /// images as in `truth`; NaN: no return. A ray contributes if its weight is at least 2 % of the
  /// largest.
  std::vector<Image<float>> near_m, far_m;
};

/// Captures shapes through the camera's lens (Camera::blur): the light of pixel_samples^2 rays per
/// pixel is blurred and summed, and noise is drawn once per pixel. In moving scenes, all taps of an
/// exposure see the scene at its middle, without motion blur. Without lens blur and motion, frames
/// are bit-identical to the other capture().
/// @throws std::invalid_argument as capture() and ray_cast(), if a disc of confusion is wider than
///         128 pixels, motions or times do not fit (StagedScene::at, Camera::frame_period_s), or
///         the size of ambient_scale differs; Interrupted
StagedCapture capture(const StagedScene& scene, const CodeSet& code, const Camera& camera,
                      const CaptureOptions& options, const StagedSetup& setup = {},
                      const Progress& progress = {});

}  // namespace tofsmith
