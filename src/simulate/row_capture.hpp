// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulate/pixel_capture.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// A scene in front of a camera, captured row by row. The scene must outlive it.
class RowCapture {
 public:
  /// @throws std::invalid_argument if scene or options are invalid
  RowCapture(const SceneImage& scene, const ForwardModel& model, const Camera& camera,
             const CaptureOptions& options);

  int measurements() const { return pixel_.measurements(); }
  /// Raw measurements of one row of one frame, (W, K).
  void row(int frame, int row, float* raw) const;

 private:
  const SceneImage& scene_;
  CaptureOptions options_;
  PixelCapture pixel_;
};

}  // namespace tofsmith
