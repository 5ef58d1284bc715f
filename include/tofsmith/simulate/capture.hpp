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
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// Light of a simulated capture.
struct CaptureOptions {
  double signal_e_per_s = 1e4;
  double ambient_e_per_s = 1e4;
  double reference_distance_m = 1.0;
  bool falloff = true;  ///< S = signal albedo cosine / (d / d_ref)^2; else signal albedo
  std::uint64_t seed = 1;
  int frames = 1;  ///< F

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<CaptureOptions> auto& o) {
  return std::tuple(Field("signal_e_per_s", o.signal_e_per_s, at_least(0),
                          Help{"signal of albedo 1 facing the camera at the reference distance"}),
                    Field("ambient_e_per_s", o.ambient_e_per_s, at_least(0), Help{"ambient light"}),
                    Field("reference_distance_m", o.reference_distance_m, above(0),
                          Help{"distance at which the signal is as given"}),
                    Field("falloff", o.falloff, Help{"reduce the signal with distance and angle"}),
                    Field("seed", o.seed, Help{"seed of all noise"}),
                    Field("frames", o.frames, closed(1, 100000),
                          Help{"frames one after another, each with its own noise"}));
}

/// Signal of a pixel, were the sensor fully open [e/s]; 0 where nothing returns (NaN depth).
double pixel_signal_e_per_s(const SceneImage& scene, int row, int column,
                            const CaptureOptions& options);

/// Raw measurements of a scene, (F, H, W, K): electrons, or counts if the sensor has an ADC.
/// Depth beyond the unambiguous range wraps, as in a camera. A pixel without return sees ambient
/// light only. A lens (Camera::blur) blurs over the image's pixels; staged_capture.hpp casts rays.
/// @throws std::invalid_argument if scene, camera or options are invalid, or the code does not fit
///         the camera; Interrupted if progress says so
/// @note the noise of a pixel depends on (seed, pixel, frame) alone: same bits for any number of
///       threads
RawFrames capture(const SceneImage& scene, const CodeSet& code, const Camera& camera,
                  const CaptureOptions& options = {}, const Progress& progress = {});

/// How light comes to the pixels of a scene, beside its one direct way. Multipath returns and
/// a tail add to the direct return; a transient takes its place: the pixel's signal is shared out
/// over the histogram.
struct SceneLight {
  MultipathReturns returns;             ///< empty: none
  std::optional<ExponentialTail> tail;  ///< behind every direct return
  /// One for all pixels, or one for each, row by row; empty: none.
  std::vector<Transient> transients;
  /// What the lens then scatters over the image, ambient light too: the kernel of StrayLight
  /// (decode/stray_light.hpp); empty: nothing.
  Image<float> stray_light;

  bool is_direct_only() const { return returns.empty() && !tail && transients.empty(); }

  /// @throws std::invalid_argument naming what does not fit the scene or the camera's range;
  ///         transients together with returns or a tail
  void validate(const SceneImage& scene, const Camera& camera) const;
};

/// As capture() of direct light, with light that comes back by longer ways too. Without such light
/// the frames are the same, bit by bit; with it pixels draw from the same streams.
RawFrames capture(const SceneImage& scene, const SceneLight& light, const CodeSet& code,
                  const Camera& camera, const CaptureOptions& options = {},
                  const Progress& progress = {});

/// Truth of a capture: where each pixel's light came from. Tails and transients are in what made
/// them.
struct MultipathTruth {
  Image<float> direct_m;               ///< depth of the direct return; NaN: none
  Image<float> direct_e_per_s;         ///< its signal, with a transient all of the pixel's
  std::vector<std::int64_t> first{0};  ///< as MultipathReturns
  std::vector<float> distance_m;       ///< of every multipath return [m]
  std::vector<float> signal_e_per_s;   ///< of every multipath return [e/s]
};
MultipathTruth multipath_truth(const SceneImage& scene, const SceneLight& light,
                               const CaptureOptions& options);

}  // namespace tofsmith
