// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include "core/shared/shared_progress.hpp"
#include "simulate/lens_light.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

RawFrames empty_frames(int frames, int height, int width, int measurements) {
  RawFrames raw{frames, height, width, measurements, {}};
  raw.values.resize(raw.pixels_per_frame() * static_cast<std::size_t>(measurements) *
                    static_cast<std::size_t>(frames));
  return raw;
}

RawFrames captured_frames(const RowCapture& source, const CollectedLight* light, int height,
                          int width, int frames, const Progress& progress,
                          const ExposeBy& expose_by) {
  RawFrames raw = empty_frames(frames, height, width, source.measurements());
  const UnexposedFrames unexposed{source, light, height, width, 0, frames, raw.frame(0)};
  expose_by ? expose_by(unexposed, progress) : expose_here(unexposed, progress);
  report(progress, 1.0, "capture");
  return raw;
}

void expose_here(const UnexposedFrames& frames, const Progress& progress) {
  const std::int64_t row_values = std::int64_t{frames.width} * frames.source.measurements();
  SharedProgress shared(progress, static_cast<double>(frames.frames) * frames.height, "capture");
  for (int f = 0; f < frames.frames; ++f) {
    const int frame = frames.first_frame + f;
    parallel_for(frames.height, [&](std::int64_t row) {
      float* const raw = frames.raw + (std::int64_t{f} * frames.height + row) * row_values;
      if (frames.light) {
        std::vector<std::int64_t> pixels(static_cast<std::size_t>(frames.width));
        std::iota(pixels.begin(), pixels.end(), row * frames.width);
        expose_pixels(frames, frame, pixels, raw);
      } else {
        frames.source.row(frame, static_cast<int>(row), raw);
      }
      shared.add();
    });
  }
}

void expose_pixels(const UnexposedFrames& frames, int frame, std::span<const std::int64_t> pixels,
                   float* raw) {
  const RowCapture& source = frames.source;
  const CollectedLight* const collected = frames.light;
  const auto taps = static_cast<std::ptrdiff_t>(source.tap_values());
  std::vector<double> work(static_cast<std::size_t>(taps)), light(work.size());
  for (const std::int64_t pixel : pixels) {
    const auto row = static_cast<int>(pixel / frames.width),
               column = static_cast<int>(pixel % frames.width);
    double ambient_e_per_s = source.ambient_e_per_s();
    if (!collected) {
      source.light_at(row, column, work, light);
      ambient_e_per_s = source.ambient_e_per_s(row, column);
    } else {
      std::copy_n(collected->taps.begin() + pixel * taps, taps, light.begin());
      if (!collected->ambient.empty())
        ambient_e_per_s = collected->ambient[static_cast<std::size_t>(pixel)];
    }
    source.expose(frame, static_cast<std::uint64_t>(pixel), ambient_e_per_s, light, raw);
    raw += source.measurements();
  }
}

}  // namespace tofsmith
