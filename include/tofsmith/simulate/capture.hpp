// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/scene/bounced_light.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// Options of a simulated capture.
struct CaptureOptions {
  double signal_e_per_s = 1e4;
  double ambient_e_per_s = 1e4;
  double reference_distance_m = 1.0;
  bool falloff = true;  ///< S = signal albedo cosine / (d / d_ref)^2; else signal albedo
  std::uint64_t seed = 1;
  int frames = 1;

  /// @throws std::invalid_argument
  void validate() const;
};
auto fields_of(ConstOrNot<CaptureOptions> auto& o) {
  return std::tuple(
      Field("signal_e_per_s", o.signal_e_per_s, at_least(0),
            Help{"signal of a white surface that faces the camera at the reference distance"}),
      Field("ambient_e_per_s", o.ambient_e_per_s, at_least(0), Help{"ambient light"}),
      Field("reference_distance_m", o.reference_distance_m, above(0),
            Help{"distance that the signal refers to"}),
      Field("falloff", o.falloff, Help{"reduce the signal with distance and angle"}),
      Field("seed", o.seed, Help{"seed of all noise"}),
      Field("frames", o.frames, closed(1, 100000),
            Help{"number of frames, each with independent noise"}));
}

/// Signal of a pixel at a gate that is always open [e/s]; 0 without a return.
double pixel_signal_e_per_s(const SceneImage& scene, int row, int column,
                            const CaptureOptions& options);

/// Simulates raw measurements of a scene, (F, H, W, K), in electrons, or counts if the sensor has
/// an ADC. Depth beyond the unambiguous range wraps; pixels without a return receive only ambient
/// light. A lens (Camera::blur) blurs image pixels; see also capture_staged().
/// @throws std::invalid_argument if the arguments are invalid or do not fit; Interrupted
/// @note noise depends only on (seed, pixel, frame): same bits for any number of threads
RawFrames capture(const SceneImage& scene, const CodeSet& code, const Camera& camera,
                  const CaptureOptions& options = {}, const Progress& progress = {});

/// Indirect light in a scene. Multipath returns and a tail are added to the direct return; a
/// transient replaces it.
struct SceneLight {
  MultipathReturns returns;
  std::optional<ExponentialTail> tail;  ///< added to every direct return
  /// One for all pixels, or one per pixel; may be empty.
  std::vector<Transient> transients;
  /// Kernel of StrayLight (decode/stray_light.hpp), also for ambient light; may be empty.
  Image<float> stray_light;

  bool is_direct_only() const { return returns.empty() && !tail && transients.empty(); }

  /// @throws std::invalid_argument if it does not fit the scene or the camera's range, or combines
  ///         transients with returns or a tail
  void validate(const SceneImage& scene, const Camera& camera) const;
};

/// As above with indirect light; without it, the frames have the same bits.
RawFrames capture(const SceneImage& scene, const SceneLight& light, const CodeSet& code,
                  const Camera& camera, const CaptureOptions& options = {},
                  const Progress& progress = {});

/// True light of a capture.
struct MultipathTruth {
  Image<float> direct_m;               ///< NaN: none
  Image<float> direct_e_per_s;         ///< with a transient, the total signal
  std::vector<std::int64_t> first{0};  ///< see MultipathReturns
  std::vector<float> distance_m;       ///< of every multipath return
  std::vector<float> signal_e_per_s;   ///< of every multipath return
};
MultipathTruth multipath_truth(const SceneImage& scene, const SceneLight& light,
                               const CaptureOptions& options);

}  // namespace tofsmith
