// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "simulate/lens_light.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

/// @param raw  (W, K)
void expose_row(const RowCapture& source, const CollectedLight& collected, int frame,
                std::int64_t row, float* raw) {
  const auto taps = static_cast<std::ptrdiff_t>(source.tap_values());
  std::vector<double> light(static_cast<std::size_t>(taps));
  for (std::int64_t pixel = row * collected.width; pixel < (row + 1) * collected.width; ++pixel) {
    std::copy_n(collected.taps.begin() + pixel * taps, taps, light.begin());
    const double ambient_e_per_s = collected.ambient.empty()
                                       ? source.ambient_e_per_s()
                                       : collected.ambient[static_cast<std::size_t>(pixel)];
    source.expose(frame, static_cast<std::uint64_t>(pixel), ambient_e_per_s, light, raw);
    raw += source.measurements();
  }
}

}  // namespace

RawFrames empty_frames(int frames, int height, int width, int measurements) {
  RawFrames raw{frames, height, width, measurements, {}};
  raw.values.resize(raw.pixels_per_frame() * static_cast<std::size_t>(measurements) *
                    static_cast<std::size_t>(frames));
  return raw;
}

RawFrames captured_frames(const RowCapture& source, const CollectedLight* light, int frames,
                          const Progress& progress) {
  const SceneImage& scene = source.scene();
  const int height = light ? light->height : scene.height(),
            width = light ? light->width : scene.width();
  RawFrames raw = empty_frames(frames, height, width, source.measurements());
  SharedProgress shared(progress, static_cast<double>(frames) * height, "capture");
  for (int frame = 0; frame < frames; ++frame)
    expose_frame(source, light, frame, raw.frame(frame), shared);
  report(progress, 1.0, "capture");
  return raw;
}

void expose_frame(const RowCapture& source, const CollectedLight* light, int frame, float* raw,
                  SharedProgress& shared) {
  const SceneImage& scene = source.scene();
  const int height = light ? light->height : scene.height(),
            width = light ? light->width : scene.width();
  const std::int64_t row_values = std::int64_t{width} * source.measurements();
  parallel_for(height, [&](std::int64_t row) {
    if (light)
      expose_row(source, *light, frame, row, raw + row * row_values);
    else
      source.row(frame, static_cast<int>(row), raw + row * row_values);
    shared.add();
  });
}

}  // namespace tofsmith
