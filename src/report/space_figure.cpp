// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
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
