// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// Additional inputs for a capture of shapes.
struct StagedSetup {
  MeshSearchMaker search_of;  ///< see RayCaster
  /// Returns indirect light; empty: direct light only. Its arguments are the scene with a view that
  /// has one pixel per ray, and the image seen by these rays.
  std::function<SceneLight(const StagedScene& scene, const SceneImage& rays)> light;
  Image<float> ambient_scale;  ///< per pixel, as in SceneImage; empty: 1
  /// Stray light over the pixels, as in SceneLight; that of `light` is ignored.
  Image<float> stray_light = {};
};

/// Raw measurements of a scene of shapes, with the truth.
struct StagedCapture {
  RawFrames raw;
  /// Through the centres of pixels: one image for all frames of a static scene; otherwise one per
  /// frame, at the middle of the frame (Camera::frame_middle_s).
  std::vector<SceneImage> truth;
  /// Nearest and farthest distance [m] of the rays that contribute to a pixel, over all exposures
  /// of a frame; as many images as in `truth`; NaN: no return. A ray counts if its weight is at
  /// least 2 % of the pixel's largest along both axes (for a disc: of the disc's largest). If the
  /// distances differ much, the pixel's light is mixed.
  std::vector<Image<float>> near_m, far_m;
};

/// Captures shapes through the camera's lens (Camera::blur): the light of pixel_samples^2 rays per
/// pixel is blurred and summed over pixels, and noise is drawn once per pixel. If something moves,
/// each exposure with all its taps sees the scene at the middle of the exposure
/// (Camera::exposure_middle_s); there is no motion blur within an exposure. Without lens blur and
/// motion, frames are bit-identical to the other capture().
/// @throws std::invalid_argument as capture() and ray_cast(), if a disc of confusion is wider than
///         128 pixels, motions or times do not fit (StagedScene::at, Camera::frame_period_s), or
///         the size of ambient_scale differs from the view's; Interrupted if `progress` cancels
/// @note same bits for any number of threads
StagedCapture capture(const StagedScene& scene, const CodeSet& code, const Camera& camera,
                      const CaptureOptions& options, const StagedSetup& setup = {},
                      const Progress& progress = {});

}  // namespace tofsmith
