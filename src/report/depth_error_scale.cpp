// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/depth_error_scale.hpp"

#include "report/shared/level_text.hpp"

namespace tofsmith {

HeatMap operating_map(const OperatingRange& range, const DepthErrorReport& error,
                      const std::function<double(const PointDepthError&)>& value) {
  HeatMap map{.title = error.code};
  map.values.resize(std::ssize(range.signal_e_per_s), std::ssize(range.ambient_e_per_s));
  for (Eigen::Index s = 0; s < map.values.rows(); ++s)
    for (Eigen::Index a = 0; a < map.values.cols(); ++a)
      map.values(s, a) = value(error.points[static_cast<std::size_t>(s * map.values.cols() + a)]);
  return map;
}

Figure operating_maps(FigureText text, const OperatingRange& range,
                      const std::vector<HeatMap>& maps, const ColourScale& colours) {
  CategoryAxis x{.label = "ambient", .unit = "e/s"}, y{.label = "signal", .unit = "e/s"};
  for (const double a : range.ambient_e_per_s) x.ticks.push_back(level_text(a));
  for (const double s : range.signal_e_per_s) y.ticks.push_back(level_text(s));
  return heat_map_figure(std::move(text), maps, x, y, colours);
}

ColourScale depth_error_scale(double limit_mm) {
  return {.label = "decoded minus true",
          .unit = "mm",
          .map = ColourMap::diverging,
          .range = ValueRange{-limit_mm, limit_mm}};
}

}  // namespace tofsmith
