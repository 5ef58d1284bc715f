// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/capture.hpp"

#include <cmath>

#include "core/shared/shared_progress.hpp"
#include "simulate/shared/row_capture.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

void CaptureOptions::validate() const { check_fields(*this); }

double pixel_signal_e_per_s(const SceneImage& scene, int row, int column,
                            const CaptureOptions& options) {
  const double depth_m = scene.depth_m(row, column);
  if (std::isnan(depth_m)) return 0.0;
  const double reflected = options.signal_e_per_s * scene.albedo(row, column);
  if (!options.falloff) return reflected;
  const double distance = depth_m / options.reference_distance_m;
  return reflected * scene.cosine(row, column) / (distance * distance);
}

RawFrames captured_rows(const RowCapture& source, int height, int width, int frames,
                        const Progress& progress) {
  RawFrames raw;
  raw.frames = frames;
  raw.height = height;
  raw.width = width;
  raw.measurements = source.measurements();
  const auto row_values =
      static_cast<std::size_t>(raw.width) * static_cast<std::size_t>(raw.measurements);
  raw.values.resize(row_values * static_cast<std::size_t>(raw.height) *
                    static_cast<std::size_t>(raw.frames));

  const auto capture_row = [&](int frame, int row) {
    source.row(frame, row, raw.frame(frame) + static_cast<std::size_t>(row) * row_values);
  };

  SharedProgress shared(progress, static_cast<double>(raw.frames) * raw.height, "capture");
  for (int frame = 0; frame < raw.frames; ++frame)
    parallel_for(raw.height, [&](std::int64_t row) {
      capture_row(frame, static_cast<int>(row));
      shared.add();
    });
  report(progress, 1.0, "capture");
  return raw;
}

RawFrames capture(const SceneImage& scene, const CodeSet& code, const Camera& camera,
                  const CaptureOptions& options, const Progress& progress) {
  return captured_rows(RowCapture(scene, ForwardModel(code, camera), camera, options),
                       scene.height(), scene.width(), options.frames, progress);
}

}  // namespace tofsmith
