// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/shared/shared_progress.hpp"
#include "simulate/pixel_capture.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// Captures a scene, which must outlive this object, row by row.
class RowCapture {
 public:
  /// @throws std::invalid_argument if scene or options are invalid
  RowCapture(const SceneImage& scene, const ForwardModel& model, const Camera& camera,
             const CaptureOptions& options);
  RowCapture(const SceneImage& scene, const SceneLight& light, const ForwardModel& model,
             const Camera& camera, const CaptureOptions& options);

  /// Changes to another scene with the same camera.
  /// @param light  validated; both must outlive this object
  void see(const SceneImage& scene, const SceneLight& light, const ForwardModel& model,
           const Camera& camera);

  int measurements() const { return pixel_.measurements(); }
  int tap_values() const { return pixel_.tap_values(); }
  const SceneImage& scene() const { return *scene_; }
  /// Returns one row of one frame, (W, K).
  void row(int frame, int row, float* raw) const;

  // In two steps, for pixels that receive the light of several rays.

  /// Computes S chi of every tap value, for all returns.
  /// @param work, light  (tap values), overwritten
  void light_at(int row, int column, std::vector<double>& work, std::vector<double>& light) const;
  double ambient_e_per_s(int row, int column) const;
  double ambient_e_per_s() const { return options_.ambient_e_per_s; }
  /// @param pixel  index in the frame
  /// @param light  overwritten
  void expose(int frame, std::uint64_t pixel, double ambient_e_per_s, std::vector<double>& light,
              float* raw) const;

 private:
  void add_all_light(int row, int column, std::vector<double>& work,
                     std::vector<double>& light) const;

  const SceneImage* scene_;
  const SceneLight* light_ = nullptr;  // null: direct light only
  double bin_m_;
  CaptureOptions options_;
  PixelCapture pixel_;
  std::optional<FineCorrelation> tail_, transient_;
};

/// Light on the pixels of a frame before noise [e/s], and the distances of its sources.
struct CollectedLight {
  int height = 0, width = 0;
  int tap_values = 0;
  std::vector<double> taps;     ///< (H, W, tap values): S chi
  std::vector<double> ambient;  ///< (H, W); empty: uniform
  Image<float> near_m, far_m;   ///< of contributing distances; NaN: none

  CollectedLight(int height_, int width_, int tap_values_);
};

/// @param light  null: the direct light of the source's scene, one ray per pixel
/// @param raw  (H, W, K)
/// @param shared  advances by 1 per row
void expose_frame(const RowCapture& source, const CollectedLight* light, int frame, float* raw,
                  SharedProgress& shared);

/// Exposes frames under the same light, each with independent noise.
/// @throws Interrupted if `progress` cancels
RawFrames captured_frames(const RowCapture& source, const CollectedLight* light, int frames,
                          const Progress& progress);

}  // namespace tofsmith
