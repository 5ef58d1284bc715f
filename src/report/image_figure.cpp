// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

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

}  // namespace tofsmith
