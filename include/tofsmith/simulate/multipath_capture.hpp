// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tofsmith/camera/returns.hpp"
#include "tofsmith/scene/later_returns.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// How light comes back to the pixels of a scene, beside its one direct way. Later returns and a
/// tail add to the direct return; a transient takes its place: the pixel's signal is shared out
/// over the histogram.
struct SceneLight {
  LaterReturns returns;                 ///< empty: none
  std::optional<ExponentialTail> tail;  ///< behind every direct return
  /// One for all pixels, or one for each, row by row; empty: none.
  std::vector<Transient> transients;

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
struct ReturnsTruth {
  Image<float> direct_m;               ///< depth of the direct return; NaN: none
  Image<float> direct_e_per_s;         ///< its signal, with a transient all of the pixel's
  std::vector<std::int64_t> first{0};  ///< as LaterReturns
  std::vector<float> distance_m;       ///< of every later return [m]
  std::vector<float> signal_e_per_s;   ///< of every later return [e/s]
};
ReturnsTruth returns_truth(const SceneImage& scene, const SceneLight& light,
                           const CaptureOptions& options);

}  // namespace tofsmith
