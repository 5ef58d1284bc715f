// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// What a capture of shapes needs beside them.
struct StagedSetup {
  MeshSearchMaker search_of;  ///< how meshes are searched: see RayCaster
  /// Light that comes back by longer ways; empty: direct light alone. Asked with the scene whose
  /// view has the rays as pixels, and with what they see.
  std::function<SceneLight(const StagedScene& scene, const SceneImage& rays)> light;
  Image<float> ambient_scale;  ///< of the pixels, as in SceneImage; empty: 1
  /// Over the pixels, as in SceneLight; that of `light` is not used.
  Image<float> stray_light = {};
};

/// Raw measurements of a scene of shapes, with what is true of them.
struct StagedCapture {
  RawFrames raw;
  /// Through centres of pixels: one for all frames of a scene that stands still; else one for each,
  /// as the scene is in the frame's middle (Camera::frame_middle_s).
  std::vector<SceneImage> truth;
  /// Nearest and farthest distance [m] of the rays that a pixel sees, those that weigh at least
  /// 2 % of its heaviest along both axes (of a disc: of the disc's heaviest part); NaN: no return.
  /// Of all exposures of a frame; as many as `truth`. Where they differ by much, the pixel's light
  /// is mixed.
  std::vector<Image<float>> near_m, far_m;
};

/// Captures shapes through the camera's lens (Camera::blur): light of pixel_samples^2 rays for each
/// pixel is blurred, summed on pixels, and noise is drawn once for each. Where something moves,
/// each exposure sees the scene as it is in that exposure's middle (Camera::exposure_middle_s),
/// with all of its taps; what moves within an exposure does not smear. Without a lens that blurs
/// and without motion the frames are those of the other capture(), bit by bit.
/// @throws std::invalid_argument as capture() and ray_cast(), if a disc of confusion is wider than
///         128 pixels, motions or times do not fit (StagedScene::at, Camera::frame_period_s), or
///         ambient_scale is not of the view's size; Interrupted if progress says so
/// @note same bits for any number of threads
StagedCapture capture(const StagedScene& scene, const CodeSet& code, const Camera& camera,
                      const CaptureOptions& options, const StagedSetup& setup = {},
                      const Progress& progress = {});

}  // namespace tofsmith
