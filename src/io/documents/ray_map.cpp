// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>

#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

/// Returns x/z and y/z of all pixels, row by row; NaN for pixels without a ray.
std::vector<Eigen::Vector2d> read_ray_map(const std::filesystem::path& path, int height,
                                          int width) {
  if (path.extension() != ".npy")
    throw IoError(path.string(), "expected a map of rays as .npy, (H, W, 2) or (H, W, 3)");
  const NpyArray array = read_npy(path);
  const NpyShape& shape = array.shape();
  const auto rows = static_cast<std::size_t>(height), columns = static_cast<std::size_t>(width);
  if (shape.size() != 3 || shape[0] != rows || shape[1] != columns ||
      (shape[2] != 2 && shape[2] != 3))
    throw IoError(path.string(),
                  fmt::format("found shape ({}); expected ({}, {}, 2), x/z and y/z of each pixel's "
                              "ray, or ({}, {}, 3), its direction",
                              fmt::join(shape, ", "), height, width, height, width));
  const std::vector<double> numbers = array.to_doubles();
  const std::size_t axes = shape[2];
  std::vector<Eigen::Vector2d> slopes(rows * columns);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const double* const ray = numbers.data() + i * axes;
    const double z = axes == 3 ? ray[2] : 1.0;
    if (z <= 0.0)
      throw IoError(path.string(), fmt::format("found the ray ({}, {}, {}) of pixel ({}, {}); "
                                               "expected z > 0, or NaN for a pixel without a ray",
                                               ray[0], ray[1], z, i / columns, i % columns));
    slopes[i] = {ray[0] / z, ray[1] / z};
    if (!slopes[i].allFinite()) slopes[i].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return slopes;
}

}  // namespace

PixelRays rays_of(const std::optional<Lens>& lens, const PinholeView& view) {
  if (!lens || lens->rays.empty()) return PixelRays(view);
  return {view, read_ray_map(lens->rays, view.height, view.width)};
}

}  // namespace tofsmith
