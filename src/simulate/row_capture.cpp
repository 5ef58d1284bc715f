// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/row_capture.hpp"

namespace tofsmith {

RowCapture::RowCapture(const SceneImage& scene, const ForwardModel& model, const Camera& camera,
                       const CaptureOptions& options)
    : scene_(scene), options_(options), pixel_(model, camera) {
  scene.validate();
  options.validate();
}

void RowCapture::row(int frame, int row, float* raw) const {
  std::vector<double> work(static_cast<std::size_t>(pixel_.tap_values()));
  const int width = scene_.width();
  for (int column = 0; column < width; ++column, raw += measurements()) {
    const auto item = static_cast<std::uint64_t>(row) * static_cast<std::uint64_t>(width) +
                      static_cast<std::uint64_t>(column);
    RandomStream random(options_.seed, item, static_cast<std::uint32_t>(frame));
    const double ambient_scale =
        scene_.ambient_scale.empty() ? 1.0 : scene_.ambient_scale(row, column);
    pixel_(scene_.depth_m(row, column), pixel_signal_e_per_s(scene_, row, column, options_),
           options_.ambient_e_per_s * ambient_scale, random, work, raw);
  }
}

}  // namespace tofsmith
