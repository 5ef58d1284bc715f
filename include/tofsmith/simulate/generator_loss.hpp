// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// What the limits of a camera's generators do to a code. All three errors are of the same depths
/// and the same noise, without bounds.
struct GeneratorLoss {
  DepthErrorReport told;          ///< on the camera without generators
  DepthErrorReport played;        ///< with them, by a decoder that knows what is played
  DepthErrorReport uncalibrated;  ///< with them, by a decoder that believes what was told
  /// Rms difference of the correlation functions told and played, per measurement (K), over the rms
  /// of the one told about its mean.
  std::vector<double> correlation_change;

  /// Geometric mean over the operating points [m], of the kind the camera is judged by.
  Estimate told_m(DepthErrorKind kind) const { return told.of(kind).geometric_mean_m; }
  /// played / told
  double ratio(DepthErrorKind kind) const;
  /// uncalibrated / told
  double uncalibrated_ratio(DepthErrorKind kind) const;
};

/// @param camera  with generators; the camera without them is what was told
/// @throws std::invalid_argument as evaluate(); Interrupted if progress says so
/// @note same bits for any number of threads
GeneratorLoss generator_loss(const CodeSet& code, const Camera& camera,
                             const EvaluateOptions& options = {}, const Progress& progress = {});

}  // namespace tofsmith
