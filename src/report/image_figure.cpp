// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/shared/random.hpp"
#include "report/figure_json.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

namespace {

using figure_json::Json;

std::vector<float> every_nth_pixel(const Image<float>& pixels, int step) {
  std::vector<float> kept;
  for (int row = 0; row < pixels.height; row += step)
    for (int column = 0; column < pixels.width; column += step) kept.push_back(pixels(row, column));
  return kept;
}

void check_sizes(const std::vector<ValueImage>& images, const ImageFigureOptions& options) {
  const Image<float>& first = images.front().pixels;
  require(!first.empty(), "images[0].size", first.size(), "must be >= 1");
  const auto check = [&](const char* name, const Image<float>& pixels) {
    require(pixels.height == first.height && pixels.width == first.width, name,
            fmt::format("{} x {}", pixels.height, pixels.width),
            fmt::format("must be {} x {} like the first", first.height, first.width));
  };
  for (const ValueImage& image : images) {
    check("ValueImage::pixels", image.pixels);
    if (!image.before.empty()) check("ValueImage::before", image.before);
  }
  if (options.reference) check("ImageReference::values", options.reference->values);
}

const char* ordinal_ending(int step) { return step == 2 ? "nd" : step == 3 ? "rd" : "th"; }

}  // namespace

Figure image_figure(FigureText text, const std::vector<ValueImage>& images,
                    const ColourScale& colours, const ImageFigureOptions& options) {
  require(!images.empty(), "images.size", images.size(), "must be >= 1");
  require(options.columns >= 1, "ImageFigureOptions::columns", options.columns, "must be >= 1");
  require(options.max_side >= 1, "ImageFigureOptions::max_side", options.max_side, "must be >= 1");
  check_sizes(images, options);
  const int height = images.front().pixels.height, width = images.front().pixels.width;
  const int step = (std::max(height, width) + options.max_side - 1) / options.max_side;
  const int shown_width = (width + step - 1) / step;
  Json json = {{"columns", options.columns},
               {"width", shown_width},
               {"height", (height + step - 1) / step},
               {"pixel_step", step},
               {"colours", figure_json::colours(colours)},
               {"before_name", options.before_name},
               {"after_name", options.after_name},
               {"panels", Json::array()}};
  const auto packed = [&](const Image<float>& pixels) {
    const std::vector<float> values = every_nth_pixel(pixels, step);
    return figure_json::packed(values, static_cast<std::size_t>(shown_width),
                               figure_json::resolution_of(colours, values));
  };
  for (const ValueImage& image : images) {
    json["panels"].push_back({{"title", image.title}, {"values", packed(image.pixels)}});
    if (!image.before.empty()) json["panels"].back()["before"] = packed(image.before);
  }
  if (const std::optional<ImageReference>& reference = options.reference)
    json["reference"] = {{"name", reference->name},
                         {"values", packed(reference->values)},
                         {"period", reference->period},
                         {"factor", reference->factor},
                         {"colours", figure_json::colours(reference->colours)}};
  if (step > 1)
    text.caption += fmt::format(" Shown at every {}{} pixel of {} x {}.", step,
                                ordinal_ending(step), width, height);
  return {std::move(text), "image", json.dump()};
}

namespace {

constexpr double point_resolution_m = 1e-3;  // finer details are not visible

/// Returns `wanted` of the indices 0 to count - 1, in order and with equal probability.
/// @see Knuth, The Art of Computer Programming, vol. 2, 3.4.2, algorithm S
std::vector<Eigen::Index> selection_sample(std::int64_t count, std::int64_t wanted) {
  RandomStream random(0, 0);
  std::vector<Eigen::Index> chosen;
  for (std::int64_t i = 0; i < count && wanted > 0; ++i) {
    if (random.uniform() * static_cast<double>(count - i) < static_cast<double>(wanted)) {
      chosen.push_back(i);
      --wanted;
    }
  }
  return chosen;
}

/// Finite points, thinned to `max_points`.
std::vector<Eigen::Index> shown_points(const ColouredPoints& cloud, int max_points,
                                       std::int64_t& finite_points) {
  std::vector<Eigen::Index> finite;
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i)
    if (cloud.points.row(i).allFinite() && std::isfinite(cloud.values[i])) finite.push_back(i);
  finite_points = std::ssize(finite);
  std::vector<Eigen::Index> shown;
  for (const Eigen::Index place : selection_sample(finite_points, max_points))
    shown.push_back(finite[static_cast<std::size_t>(place)]);
  return shown;
}

Json packed_column(const Eigen::Ref<const Eigen::VectorXf>& column,
                   const std::vector<Eigen::Index>& shown, double resolution) {
  std::vector<float> values;
  for (const Eigen::Index i : shown) values.push_back(column[i]);
  return figure_json::packed(values, std::max<std::size_t>(values.size(), 1), resolution);
}

}  // namespace

Figure curve_3d_figure(FigureText text, const std::vector<Curve3d>& curves,
                       const std::array<Axis, 3>& axes, const ColourScale& colours) {
  require(!curves.empty(), "curves.size", curves.size(), "must be >= 1");
  Json json = {{"axes", Json::array()},
               {"colours", figure_json::colours(colours)},
               {"panels", Json::array()}};
  for (const Axis& axis : axes) json["axes"].push_back(figure_json::axis(axis));
  for (const Curve3d& curve : curves) {
    require(curve.points.rows() > 0 && curve.points.rows() == curve.values.size(),
            "Curve3d::values.size", curve.values.size(),
            fmt::format("must equal points.rows = {} and be >= 1", curve.points.rows()));
    json["panels"].push_back({{"title", curve.title},
                              {"x", figure_json::numbers(to_values(curve.points.col(0)))},
                              {"y", figure_json::numbers(to_values(curve.points.col(1)))},
                              {"z", figure_json::numbers(to_values(curve.points.col(2)))},
                              {"values", figure_json::numbers(to_values(curve.values))}});
  }
  return {std::move(text), "curves", json.dump()};
}

Figure point_cloud_figure(FigureText text, const std::vector<ColouredPoints>& clouds,
                          const ColourScale& colours, const PointCloudOptions& options) {
  require(!clouds.empty(), "clouds.size", clouds.size(), "must be >= 1");
  require(options.max_points >= 1, "PointCloudOptions::max_points", options.max_points,
          "must be >= 1");
  Json json = {{"colours", figure_json::colours(colours)},
               {"point_size_px", options.point_size_px},
               {"panels", Json::array()}};
  for (const ColouredPoints& cloud : clouds) {
    require(cloud.points.rows() == cloud.values.size(), "ColouredPoints::values.size",
            cloud.values.size(), fmt::format("must equal points.rows = {}", cloud.points.rows()));
    std::int64_t finite = 0;
    const std::vector<Eigen::Index> shown = shown_points(cloud, options.max_points, finite);
    Json panel = {{"title", cloud.title}};
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      panel[std::string(1, "xyz"[axis])] =
          packed_column(cloud.points.col(axis), shown, point_resolution_m);
    const std::span all(cloud.values.data(), static_cast<std::size_t>(cloud.values.size()));
    panel["values"] = packed_column(cloud.values, shown, figure_json::resolution_of(colours, all));
    json["panels"].push_back(std::move(panel));
    if (std::ssize(shown) < finite)
      text.caption +=
          fmt::format(" Shown{}: {} of {} points.", clouds.size() > 1 ? " of " + cloud.title : "",
                      shown.size(), finite);
  }
  return {std::move(text), "cloud", json.dump()};
}

Figure point_cloud_figure(FigureText text, const Eigen::MatrixX3f& points,
                          const Eigen::VectorXf& values, const ColourScale& colours,
                          const PointCloudOptions& options) {
  return point_cloud_figure(std::move(text), std::vector<ColouredPoints>{{"", points, values}},
                            colours, options);
}

}  // namespace tofsmith
