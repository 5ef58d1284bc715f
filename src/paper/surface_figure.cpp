// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/surface_figure.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "report/shared/plotly_json.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using plotly::Json;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();  // ends a line

/// All rows and columns of a surface as one line with gaps.
struct Net {
  std::vector<double> x, y, z;

  Net(const Surface& surface, const std::vector<double>& columns, const std::vector<double>& rows) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c) add(surface, columns, rows, r, c);
      end_line();
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      for (std::size_t r = 0; r < rows.size(); ++r) add(surface, columns, rows, r, c);
      end_line();
    }
  }

 private:
  void add(const Surface& surface, const std::vector<double>& columns,
           const std::vector<double>& rows, std::size_t r, std::size_t c) {
    x.push_back(columns[c]);
    y.push_back(rows[r]);
    z.push_back(surface.values(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)));
  }
  void end_line() {
    for (auto* values : {&x, &y, &z}) values->push_back(nothing);
  }
};

Json rows_of(const Eigen::MatrixXd& values) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < values.rows(); ++r)
    rows.push_back(plotly::numbers(to_values(values.row(r).transpose())));
  return rows;
}

}  // namespace

Figure surface_figure(FigureText text, const std::vector<Surface>& surfaces,
                      const std::vector<double>& x, const std::vector<double>& y,
                      const std::array<Axis, 3>& axes) {
  require(!surfaces.empty(), "surfaces.size", surfaces.size(), "must be >= 1");
  Json data = Json::array();
  std::vector<double> heights;
  for (const Surface& surface : surfaces) {
    require(surface.values.rows() == std::ssize(y), "Surface::values.rows", surface.values.rows(),
            fmt::format("must equal y.size = {}", y.size()));
    require(surface.values.cols() == std::ssize(x), "Surface::values.cols", surface.values.cols(),
            fmt::format("must equal x.size = {}", x.size()));
    const std::string name = plotly::text(surface.name);
    const Net net(surface, x, y);
    heights.insert(heights.end(), net.z.begin(), net.z.end());
    // 1. The net, which stands in the legend; a click there hides both.
    Json line = plotly::line(surface.style);
    line["width"] = 4;
    data.push_back({{"type", "scatter3d"},
                    {"mode", "lines"},
                    {"name", name},
                    {"legendgroup", name},
                    {"x", plotly::numbers(net.x)},
                    {"y", plotly::numbers(net.y)},
                    {"z", plotly::numbers(net.z)},
                    {"line", line},
                    {"hovertemplate", "%{z:.3g}"}});
    // 2. What is between its lines.
    if (surface.style.dash != Dash::solid) continue;
    const std::string& colour = surface.style.colour;
    data.push_back({{"type", "surface"},
                    {"name", name},
                    {"legendgroup", name},
                    {"showlegend", false},
                    {"x", plotly::numbers(x)},
                    {"y", plotly::numbers(y)},
                    {"z", rows_of(surface.values)},
                    {"colorscale", {{0, colour}, {1, colour}}},
                    {"showscale", false},
                    {"opacity", 0.35},
                    {"hoverinfo", "skip"}});
  }
  const Json layout = {{"showlegend", true},
                       {"margin", {{"l", 0}, {"r", 0}, {"t", 8}, {"b", 0}}},
                       {"scene",
                        {{"aspectmode", "manual"},
                         {"aspectratio", {{"x", 1.15}, {"y", 1.15}, {"z", 0.85}}},
                         {"camera",
                          {{"eye", {{"x", 1.25}, {"y", -1.45}, {"z", 0.55}}},
                           {"center", {{"x", 0}, {"y", 0}, {"z", -0.22}}}}},
                         {"xaxis", plotly::axis(axes[0], x)},
                         {"yaxis", plotly::axis(axes[1], y)},
                         {"zaxis", plotly::axis(axes[2], heights)}}}};
  return plotly::figure(std::move(text), data, layout, {.fixed_px = 560});
}

}  // namespace tofsmith
