// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// What the depths of many frames are compared with, and how.
struct RepeatedDepthOptions {
  Image<float> reference_m;  ///< [m], (H, W), NaN = unknown; empty: the scene's, wrapped
  DepthErrorKind error = DepthErrorKind::linear;
  double outlier_threshold_m = 0.3;  ///< errors beyond are outliers [m], >= 0
  DecodeMethod method = DecodeMethod::zncc;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// Statistics of every pixel's depth over many frames, (H, W) each; NaN where the scene returns
/// nothing or, for what depends on it, the reference is unknown.
struct RepeatedDepth {
  int frames = 0;
  Image<float> mean_m;                ///< mean decoded depth
  Image<float> standard_deviation_m;  ///< of decoded depths around their mean, unbiased
  Image<float> mean_abs_error_m;      ///< mean |decoded - reference|
  Image<float> outlier_rate;          ///< share of errors beyond the threshold
};

/// Captures a scene `capture.frames` times, decodes each frame and keeps its statistics: a point
/// scan that takes several estimates per point. Every estimate counts, however poor: the best
/// position is taken even where a decoder would report no return.
///
/// The frames are those of capture() with the same options, and they are never held: memory is that
/// of the result.
/// @throws std::invalid_argument if scene, camera or options are invalid, or the code does not fit
///         the camera; Interrupted if progress says so
/// @note same bits for any number of threads
RepeatedDepth repeated_depth(const SceneImage& scene, const CodeSet& code, const Camera& camera,
                             const CaptureOptions& capture,
                             const RepeatedDepthOptions& options = {},
                             const Progress& progress = {});

}  // namespace tofsmith
