// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "core/shared/random.hpp"
#include "report/colour_axis.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using plotly::Json;

/// Plotly draws a 3D marker of size 1 this wide.
constexpr double plotly_size_unit_px = 4;

/// The values, with the first one again at the end.
Json closed_column(const Eigen::VectorXd& column) {
  std::vector<double> values = to_values(column);
  values.push_back(values.front());
  return plotly::numbers(values);
}

/// `wanted` of the indices 0 .. count - 1, in order and each with the same chance.
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

std::string with_thousands(std::int64_t value) {
  std::string digits = std::to_string(value);
  for (auto place = std::ssize(digits) - 3; place > 0; place -= 3)
    digits.insert(static_cast<std::size_t>(place), 1, ',');
  return digits;
}

/// What is drawn of a cloud.
struct ShownPoints {
  std::array<std::vector<float>, 3> xyz;
  std::vector<float> values;
  std::int64_t finite = 0;  ///< points that could be drawn

  /// The longest side of the box around them.
  double largest_extent() const {
    float extent = 0;
    for (const std::vector<float>& values_along : xyz) {
      if (values_along.empty()) continue;
      const auto [low, high] = std::minmax_element(values_along.begin(), values_along.end());
      extent = std::max(extent, *high - *low);
    }
    return static_cast<double>(extent);
  }
};

ShownPoints shown_points(const ColouredPoints& cloud, int max_points) {
  require(cloud.points.rows() == cloud.values.size(), "ColouredPoints::values.size",
          cloud.values.size(), fmt::format("must equal points.rows = {}", cloud.points.rows()));
  std::vector<Eigen::Index> finite;
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i)
    if (cloud.points.row(i).allFinite() && std::isfinite(cloud.values[i])) finite.push_back(i);
  ShownPoints shown{.xyz = {}, .values = {}, .finite = std::ssize(finite)};
  for (const Eigen::Index place : selection_sample(shown.finite, max_points)) {
    const Eigen::Index i = finite[static_cast<std::size_t>(place)];
    for (std::size_t axis = 0; axis < 3; ++axis)
      shown.xyz[axis].push_back(cloud.points(i, static_cast<Eigen::Index>(axis)));
    shown.values.push_back(cloud.values[i]);
  }
  return shown;
}

}  // namespace

Figure curve_3d_figure(FigureText text, const std::vector<Curve3d>& curves,
                       const std::array<Axis, 3>& axes, const ColourScale& colours) {
  require(!curves.empty(), "curves.size", curves.size(), "must be >= 1");
  std::vector<float> all_values;
  for (const Curve3d& curve : curves) {
    require(curve.points.rows() > 0 && curve.points.rows() == curve.values.size(),
            "Curve3d::values.size", curve.values.size(),
            fmt::format("must equal points.rows = {} and be >= 1", curve.points.rows()));
    for (const double value : curve.values) all_values.push_back(static_cast<float>(value));
  }
  const plotly::ColourAxis colour_axis(colours, all_values);
  const int count = static_cast<int>(curves.size());

  Json data = Json::array();
  Json layout = {{"coloraxis", colour_axis.layout()},
                 {"annotations", Json::array()},
                 {"showlegend", false},
                 {"margin", {{"l", 0}, {"r", 88}, {"t", 28}, {"b", 0}}}};
  for (int c = 0; c < count; ++c) {
    const Curve3d& curve = curves[static_cast<std::size_t>(c)];
    const std::string scene = c == 0 ? "scene" : fmt::format("scene{}", c + 1);
    Eigen::VectorXd shown(curve.values.size());
    for (Eigen::Index i = 0; i < shown.size(); ++i)
      shown[i] = colour_axis.to_trace(curve.values[i]);
    data.push_back(
        {{"type", "scatter3d"},
         {"mode", "lines"},
         {"name", plotly::text(curve.title)},
         {"x", closed_column(curve.points.col(0))},
         {"y", closed_column(curve.points.col(1))},
         {"z", closed_column(curve.points.col(2))},
         {"line", {{"width", 5}, {"color", closed_column(shown)}, {"coloraxis", "coloraxis"}}},
         {"hovertemplate", colour_axis.hover("line.color") + "<extra></extra>"},
         {"scene", scene}});
    const double left = static_cast<double>(c) / count;
    const double right = static_cast<double>(c + 1) / count;
    layout[scene] = {{"domain", {{"x", {plotly::number(left), plotly::number(right)}}}},
                     {"aspectmode", "cube"},
                     {"camera", {{"eye", {{"x", 1.35}, {"y", 1.35}, {"z", 0.95}}}}},
                     {"xaxis", plotly::axis(axes[0])},
                     {"yaxis", plotly::axis(axes[1])},
                     {"zaxis", plotly::axis(axes[2])}};
    if (!curve.title.empty())
      layout["annotations"].push_back(plotly::panel_title(curve.title, (left + right) / 2, 1));
  }
  return plotly::figure(
      std::move(text), data, layout,
      {.fixed_px = count == 1 ? 460.0 : 380.0, .min_width_px = 260.0 * count + 88});
}

Figure point_cloud_figure(FigureText text, const std::vector<ColouredPoints>& clouds,
                          const ColourScale& colours, const PointCloudOptions& options) {
  require(!clouds.empty(), "clouds.size", clouds.size(), "must be >= 1");
  require(options.max_points >= 1, "PointCloudOptions::max_points", options.max_points,
          "must be >= 1");
  std::vector<ShownPoints> shown;
  std::vector<float> all_values;
  for (const ColouredPoints& cloud : clouds) {
    shown.push_back(shown_points(cloud, options.max_points));
    const std::vector<float>& values = shown.back().values;
    all_values.insert(all_values.end(), values.begin(), values.end());
  }
  const plotly::ColourAxis colour_axis(colours, all_values);
  const std::size_t count = clouds.size();
  Json data = Json::array();
  Json layout = {{"coloraxis", colour_axis.layout()},
                 {"annotations", Json::array()},
                 {"showlegend", false},
                 {"margin", {{"l", 0}, {"r", 88}, {"t", count == 1 ? 8 : 28}, {"b", 0}}}};
  for (std::size_t c = 0; c < count; ++c) {
    ShownPoints& points = shown[c];
    for (float& value : points.values)
      value = static_cast<float>(colour_axis.to_trace(static_cast<double>(value)));
    const std::string scene = c == 0 ? "scene" : fmt::format("scene{}", c + 1);
    const std::vector<std::size_t> shape = {points.values.size()};
    const double resolution = points.largest_extent() / 4096;  // a screen has fewer pixels
    data.push_back(
        {{"type", "scatter3d"},
         {"mode", "markers"},
         {"x", plotly::typed_array(points.xyz[0], shape, resolution)},
         {"y", plotly::typed_array(points.xyz[1], shape, resolution)},
         {"z", plotly::typed_array(points.xyz[2], shape, resolution)},
         {"marker",
          {{"size", options.point_size_px / plotly_size_unit_px},
           {"color", plotly::typed_array(points.values, shape, colour_axis.resolution())},
           {"coloraxis", "coloraxis"}}},
         {"hovertemplate", fmt::format("(%{{x:.3f}}, %{{y:.3f}}, %{{z:.3f}}) m: {}<extra></extra>",
                                       colour_axis.hover("marker.color"))},
         {"scene", scene}});
    const double left = static_cast<double>(c) / static_cast<double>(count);
    const double right = static_cast<double>(c + 1) / static_cast<double>(count);
    // Seen from behind the camera's right shoulder: y points down, z away.
    layout[scene] = {{"domain", {{"x", {plotly::number(left), plotly::number(right)}}}},
                     {"aspectmode", "data"},
                     {"camera",
                      {{"up", {{"x", 0}, {"y", -1}, {"z", 0}}},
                       {"eye", {{"x", 0.9}, {"y", -0.85}, {"z", -1.6}}},
                       {"center", {{"x", 0}, {"y", 0.1}, {"z", 0}}}}},
                     {"xaxis", plotly::axis({.label = "x", .unit = "m"})},
                     {"yaxis", plotly::axis({.label = "y", .unit = "m"})},
                     {"zaxis", plotly::axis({.label = "z", .unit = "m"})}};
    if (!clouds[c].title.empty())
      layout["annotations"].push_back(plotly::panel_title(clouds[c].title, (left + right) / 2, 1));
    if (std::ssize(points.values) < points.finite)
      text.caption +=
          fmt::format(" Shown{}: {} of {} points.",
                      count > 1 && !clouds[c].title.empty() ? " of " + clouds[c].title : "",
                      with_thousands(std::ssize(points.values)), with_thousands(points.finite));
  }
  return plotly::figure(
      std::move(text), data, layout,
      {.fixed_px = count == 1 ? 520.0 : 420.0,
       .min_width_px = count == 1 ? 0.0 : 300.0 * static_cast<double>(count) + 88});
}

Figure point_cloud_figure(FigureText text, const Eigen::MatrixX3f& points,
                          const Eigen::VectorXf& values, const ColourScale& colours,
                          const PointCloudOptions& options) {
  return point_cloud_figure(std::move(text), std::vector<ColouredPoints>{{"", points, values}},
                            colours, options);
}

}  // namespace tofsmith
