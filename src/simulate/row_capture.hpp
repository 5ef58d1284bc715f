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

/// A scene in front of a camera, captured row by row. The scene must outlive it.
class RowCapture {
 public:
  /// @throws std::invalid_argument if scene or options are invalid
  RowCapture(const SceneImage& scene, const ForwardModel& model, const Camera& camera,
             const CaptureOptions& options);
  /// @param light  validated; must outlive the capture
  RowCapture(const SceneImage& scene, const SceneLight& light, const ForwardModel& model,
             const Camera& camera, const CaptureOptions& options);

  /// From now on, another scene of the same camera. @param light  validated; both must outlive it
  void see(const SceneImage& scene, const SceneLight& light, const ForwardModel& model,
           const Camera& camera);

  int measurements() const { return pixel_.measurements(); }
  int tap_values() const { return pixel_.tap_values(); }
  const SceneImage& scene() const { return *scene_; }
  /// Raw measurements of one row of one frame, (W, K).
  void row(int frame, int row, float* raw) const;

  // The same in two steps, for what falls on pixels in other ways than one ray on each.

  /// S chi of every tap value, of all ways by which light comes back to a place of the scene.
  /// @param work, light  (tap values), overwritten
  void light_at(int row, int column, std::vector<double>& work, std::vector<double>& light) const;
  double ambient_e_per_s(int row, int column) const;
  /// Where ambient light is the same everywhere.
  double ambient_e_per_s() const { return options_.ambient_e_per_s; }
  /// Raw measurements of a pixel, the i-th of its frame. @param light  overwritten
  void expose(int frame, std::uint64_t pixel, double ambient_e_per_s, std::vector<double>& light,
              float* raw) const;

 private:
  void add_all_light(int row, int column, std::vector<double>& work,
                     std::vector<double>& light) const;

  const SceneImage* scene_;
  const SceneLight* light_ = nullptr;  // none: direct light alone
  double bin_m_;
  CaptureOptions options_;
  PixelCapture pixel_;
  std::optional<FineCorrelation> tail_, transient_;  // of what is the same for all pixels
};

/// Light on the pixels of one frame before noise [e/s], and the depths it comes from.
struct CollectedLight {
  int height = 0, width = 0;
  int tap_values = 0;
  std::vector<double> taps;     ///< (H, W, tap values): S chi
  std::vector<double> ambient;  ///< (H, W); empty: the same everywhere
  Image<float> near_m, far_m;   ///< of what brings a pixel light; NaN: nothing does

  CollectedLight(int height_, int width_, int tap_values_);
};

/// Exposes one frame on all threads.
/// @param light  null: the direct light of the source's scene, one ray per pixel
/// @param raw    (H, W, K)
/// @param shared  advances by 1 per row
void expose_frame(const RowCapture& source, const CollectedLight* light, int frame, float* raw,
                  SharedProgress& shared);

/// Exposes the first `frames` frames under the same light, each with independent noise.
/// @throws Interrupted if progress says so
RawFrames captured_frames(const RowCapture& source, const CollectedLight* light, int frames,
                          const Progress& progress);

}  // namespace tofsmith
