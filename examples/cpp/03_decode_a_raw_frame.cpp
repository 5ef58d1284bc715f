// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Decodes a raw frame from a file, which is simulated first.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/point_cloud.hpp"
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/simulate/capture.hpp"

using namespace tofsmith;

/// Returns the points of all pixels with a depth in camera coordinates, with their confidence.
PointCloud points_of(const DepthImage& image, const PinholeView& view) {
  PointCloud cloud;
  PointScalar confidence{.name = "confidence", .values = {}};
  for (int row = 0; row < image.height(); ++row) {
    for (int column = 0; column < image.width(); ++column) {
      const float depth_m = image.depth_m(row, column);
      if (!std::isfinite(depth_m)) continue;
      const Eigen::Vector3f point = depth_m * view.ray(row, column).cast<float>();
      cloud.points_m.push_back({point.x(), point.y(), point.z()});
      confidence.values.push_back(image.confidence(row, column));
    }
  }
  cloud.scalars.push_back(confidence);
  return cloud;
}

int main() {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const StagedScene staged = built_in_scene("table-top", 160, 120);
  const SceneImage scene = ray_cast(staged.shapes, staged.view, staged.camera_to_world);
  const CaptureOptions light{.signal_e_per_s = 1e6, .ambient_e_per_s = 1e4};
  write_raw_frames("raw.npy", capture(scene, code, camera, light), OutputPolicy::overwrite);

  const Decoder decoder(make_decoding_table(ForwardModel(code, camera), camera));  // reusable
  const DepthImage image = decoder.decode(read_raw_frames("raw.npy"));
  std::vector<float> error_m;
  for (std::size_t i = 0; i < image.depth_m.size(); ++i)
    if (std::isfinite(image.depth_m.pixels[i]))
      error_m.push_back(std::abs(image.depth_m.pixels[i] - scene.depth_m.pixels[i]));
  const auto middle = error_m.begin() + static_cast<std::ptrdiff_t>(error_m.size() / 2);
  std::nth_element(error_m.begin(), middle, error_m.end());
  const auto ok =
      std::count(image.status.pixels.begin(), image.status.pixels.end(), PixelStatus::ok);
  std::printf("%.1f%% of the pixels are ok, median error %.1f mm\n",
              100.0 * static_cast<double>(ok) / static_cast<double>(image.status.size()),
              1e3 * *middle);
  write_depth("depth.npy", image.depth_m, OutputPolicy::overwrite);
  write_ply("depth.ply", points_of(image, staged.view), OutputPolicy::overwrite);
}
