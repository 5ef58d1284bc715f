// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/scene_views.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace tofsmith {

std::string short_name(std::string_view code) {
  if (code.starts_with("hamiltonian-k") && code.ends_with("-redesigned"))
    return fmt::format("redesigned K={}", code[std::string_view("hamiltonian-k").size()]);
  if (code.starts_with("sinusoid")) return "sinusoid";
  if (code.starts_with("multifrequency")) return "multi-frequency";
  return std::string(code);
}

NpyArray stack(const NpyShape& axes, const std::vector<Image<float>>& images) {
  std::vector<float> values;
  for (const Image<float>& image : images)
    values.insert(values.end(), image.pixels.begin(), image.pixels.end());
  NpyShape shape = axes;
  shape.push_back(static_cast<std::size_t>(images.front().height));
  shape.push_back(static_cast<std::size_t>(images.front().width));
  return NpyArray::of<float>(shape, values);
}

Image<float> where_known(Image<float> image, const Image<float>& known) {
  for (std::size_t i = 0; i < image.size(); ++i)
    if (!std::isfinite(known.pixels[i])) image.pixels[i] = std::numeric_limits<float>::quiet_NaN();
  return image;
}

std::vector<Eigen::Vector3d> points_of(const Image<float>& depth_m, const PinholeView& view,
                                       const Image<std::uint8_t>& wanted) {
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < depth_m.height; ++row)
    for (int column = 0; column < depth_m.width; ++column)
      if (wanted(row, column) != 0)
        points.push_back(view.ray(row, column) * static_cast<double>(depth_m(row, column)));
  return points;
}

Figure cloud_of(FigureText text, const Image<float>& depth_m, const PinholeView& view,
                ValueRange shown_m) {
  std::vector<Eigen::Vector3f> kept;
  std::vector<float> depths;
  int left_out = 0;
  for (int row = 0; row < depth_m.height; ++row)
    for (int column = 0; column < depth_m.width; ++column) {
      const float depth = depth_m(row, column);
      if (!std::isfinite(depth)) continue;
      if (depth < shown_m.low || depth > shown_m.high) {
        ++left_out;
        continue;
      }
      kept.push_back((view.ray(row, column) * static_cast<double>(depth)).cast<float>());
      depths.push_back(depth);
    }
  Eigen::MatrixX3f points(static_cast<Eigen::Index>(kept.size()), 3);
  for (std::size_t i = 0; i < kept.size(); ++i)
    points.row(static_cast<Eigen::Index>(i)) = kept[i].transpose();
  const Eigen::VectorXf values =
      Eigen::Map<const Eigen::VectorXf>(depths.data(), static_cast<Eigen::Index>(depths.size()));
  text.caption += fmt::format(" {} of {} points lie outside {:g} to {:g} m and are left out.",
                              left_out, left_out + std::ssize(kept), shown_m.low, shown_m.high);
  return point_cloud_figure(std::move(text), points, values,
                            {.label = "depth", .unit = "m", .range = shown_m});
}

}  // namespace tofsmith
