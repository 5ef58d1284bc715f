// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "report/colour_axis.hpp"
#include "report/plotly_json.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using plotly::Json;

constexpr double left_margin_px = 8;

/// Every n-th pixel of both directions, so that no side is longer than `max_side`.
int thinning_step(const Image<float>& pixels, int max_side) {
  const int longest = std::max(pixels.height, pixels.width);
  return (longest + max_side - 1) / max_side;
}

/// What one trace draws.
struct Picture {
  std::vector<float> values;
  int panel = 0;
  std::string side, name;  ///< of a slider; empty: none
};

std::vector<float> every_nth_pixel(const Image<float>& pixels, int step) {
  std::vector<float> kept;
  for (int row = 0; row < pixels.height; row += step)
    for (int column = 0; column < pixels.width; column += step) kept.push_back(pixels(row, column));
  return kept;
}

}  // namespace

Figure image_figure(FigureText text, const std::vector<ValueImage>& images,
                    const ColourScale& colours, const ImageFigureOptions& options) {
  require(!images.empty(), "images.size", images.size(), "must be >= 1");
  require(options.columns >= 1, "ImageFigureOptions::columns", options.columns, "must be >= 1");
  require(options.max_side >= 1, "ImageFigureOptions::max_side", options.max_side, "must be >= 1");
  const Image<float>& first = images.front().pixels;
  require(!first.empty(), "images[0].size", first.size(), "must be >= 1");
  const auto check_size = [&](const char* name, const Image<float>& pixels) {
    require(pixels.height == first.height && pixels.width == first.width, name,
            fmt::format("{} x {}", pixels.height, pixels.width),
            fmt::format("must be {} x {} like the first", first.height, first.width));
  };
  for (const ValueImage& image : images) {
    check_size("ValueImage::pixels", image.pixels);
    if (!image.before.empty()) check_size("ValueImage::before", image.before);
  }

  const int step = thinning_step(first, options.max_side);
  const auto height = static_cast<std::size_t>((first.height + step - 1) / step);
  const auto width = static_cast<std::size_t>((first.width + step - 1) / step);
  std::vector<Picture> pictures;
  std::vector<float> all_values;
  for (int p = 0; p < std::ssize(images); ++p) {
    const ValueImage& image = images[static_cast<std::size_t>(p)];
    const bool slides = !image.before.empty();
    if (slides)
      pictures.push_back({every_nth_pixel(image.before, step), p, "left", options.before_name});
    pictures.push_back({every_nth_pixel(image.pixels, step), p, slides ? "right" : "",
                        slides ? options.after_name : ""});
  }
  for (const Picture& picture : pictures)
    all_values.insert(all_values.end(), picture.values.begin(), picture.values.end());
  const plotly::ColourAxis colour_axis(colours, all_values);
  const plotly::PanelLayout panels(static_cast<int>(images.size()), options.columns, 0.02);
  // The height of the pictures follows the width of the page; titles between them do not. Their
  // share of the height is made large enough for a narrow page.
  const double per_width = panels.rows() * panels.panel_width() * static_cast<double>(height) /
                           static_cast<double>(width);
  const double gaps_px = plotly::panel_title_px * (panels.rows() - 1);
  const double row_gap =
      plotly::panel_title_px / (gaps_px + per_width * (620 - plotly::colour_bar_px));

  Json data = Json::array();
  Json layout = {{"coloraxis", colour_axis.layout()}, {"annotations", Json::array()}};
  for (Picture& picture : pictures) {
    for (float& value : picture.values)
      value = static_cast<float>(colour_axis.to_trace(static_cast<double>(value)));
    data.push_back(
        {{"type", "heatmap"},
         {"z", plotly::typed_array(picture.values, {height, width}, colour_axis.resolution())},
         {"dx", step},
         {"dy", step},
         {"x0", 0},
         {"y0", 0},
         {"hoverongaps", false},
         {"hovertemplate",
          fmt::format("column %{{x}}, row %{{y}}: {}<extra></extra>", colour_axis.hover("z"))},
         {"coloraxis", "coloraxis"},
         {"xaxis", plotly::axis_name("x", picture.panel)},
         {"yaxis", plotly::axis_name("y", picture.panel)}});
    if (!picture.side.empty())
      data.back()["meta"] = {{"slider", picture.side}, {"name", picture.name}};
  }
  for (int p = 0; p < std::ssize(images); ++p) {
    Json x = {{"visible", false}, {"constrain", "domain"}};
    Json y = {{"visible", false},
              {"constrain", "domain"},
              {"autorange", "reversed"},
              {"scaleanchor", plotly::axis_name("x", p)}};
    if (p > 0) x["matches"] = "x";  // zooming into one picture zooms all
    if (p > 0) y["matches"] = "y";
    panels.place(layout, p, row_gap, images[static_cast<std::size_t>(p)].title, x, y);
  }
  layout["margin"] = {
      {"l", left_margin_px}, {"r", plotly::colour_bar_px}, {"t", plotly::panel_title_px}, {"b", 8}};
  if (step > 1)
    text.caption += fmt::format(" Shown at every {}{} pixel of {} x {}.", step,
                                step == 2   ? "nd"
                                : step == 3 ? "rd"
                                            : "th",
                                first.width, first.height);
  return plotly::figure(std::move(text), data, layout,
                        {.fixed_px = gaps_px + plotly::panel_title_px + 8 -
                                     per_width * (left_margin_px + plotly::colour_bar_px),
                         .per_width = per_width,
                         .min_width_px = 180.0 * panels.columns() + plotly::colour_bar_px});
}

}  // namespace tofsmith
