// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/image_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "io/image_limits.hpp"
#include "io/images/array_image.hpp"
#include "io/shared/file_kind.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// Alpha is ignored.
Image<float> luminance(int height, int width, int channels, std::span<const float> values) {
  Image<float> image(height, width);
  for (std::size_t i = 0; i < image.size(); ++i) {
    const float* pixel = values.data() + i * static_cast<std::size_t>(channels);
    image.pixels[i] = channels < 3
                          ? pixel[0]
                          : static_cast<float>(luminance_rec709(pixel[0], pixel[1], pixel[2]));
  }
  return image;
}

Image<float> albedo_from_png(const PngImage& png, Transfer transfer) {
  std::vector<float> light(static_cast<std::size_t>(png.max_value()) + 1);
  for (std::size_t value = 0; value < light.size(); ++value) {
    const double level = static_cast<double>(value) / png.max_value();
    light[value] = static_cast<float>(transfer == Transfer::srgb ? linear_from_srgb(level) : level);
  }
  std::vector<float> values;
  values.reserve(png.values.size());
  for (const std::uint16_t value : png.values) values.push_back(light[value]);
  return luminance(png.height, png.width, png.channels, values);
}

Image<float> albedo_from_array(const NpyArray& array, const std::string& file) {
  const bool colour = array.axes() == 3 && array.shape()[2] == 3;
  if (array.axes() != 2 && !colour)
    throw IoError(file, fmt::format("found an array of shape {}; expected (H, W) or (H, W, 3)",
                                    describe_shape(array.shape())));
  if (!colour) return image_from_array(array, file);
  require_floats(array, file);
  check_image_size(file, array.shape()[0], array.shape()[1]);
  return luminance(static_cast<int>(array.shape()[0]), static_cast<int>(array.shape()[1]), 3,
                   array.to_floats());
}

Image<float> albedo_from_planes(const ExrPlanes& planes, const std::string& file) {
  if (const auto grey = planes.find("Y"); grey != planes.end()) return grey->second;
  if (planes.size() == 1) return planes.begin()->second;
  const auto red = planes.find("R"), green = planes.find("G"), blue = planes.find("B");
  if (red == planes.end() || green == planes.end() || blue == planes.end()) {
    std::vector<std::string> names;
    for (const auto& entry : planes) names.push_back(entry.first);
    throw IoError(file, fmt::format("found the channels {}; expected Y, or R, G and B",
                                    fmt::join(names, ", ")));
  }
  Image<float> image(red->second.height, red->second.width);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.pixels[i] = static_cast<float>(
        luminance_rec709(red->second.pixels[i], green->second.pixels[i], blue->second.pixels[i]));
  return image;
}

void require_light(const Image<float>& picture, std::string_view file) {
  for (int row = 0; row < picture.height; ++row)
    for (int column = 0; column < picture.width; ++column)
      if (const float value = picture(row, column); !(value >= 0.0f) || !std::isfinite(value))
        throw IoError(file,
                      fmt::format("row {}, column {}: found {}; expected a finite number >= 0", row,
                                  column, value));
}

}  // namespace

Image<float> read_albedo(const std::filesystem::path& path, Transfer png_transfer) {
  const std::string file = path.string();
  const std::string extension = known_extension(path, {".png", ".npy", ".exr", ".pfm"});
  if (extension == ".png") return albedo_from_png(read_png(path), png_transfer);
  if (extension == ".npy") return albedo_from_array(read_npy(path), file);
  if (extension == ".exr") return albedo_from_planes(read_exr(path), file);
  const PfmImage pfm = read_pfm(path);
  return luminance(pfm.height, pfm.width, pfm.channels, pfm.values);
}

Image<float> albedo_of_picture(Image<float> picture, std::string_view file,
                               const Image<float>& depth_m) {
  for (std::size_t i = 0; i < std::min(picture.size(), depth_m.size()); ++i)
    if (std::isnan(depth_m.pixels[i]) && std::isnan(picture.pixels[i])) picture.pixels[i] = 0.0f;
  require_light(picture, file);
  const float brightest = *std::max_element(picture.pixels.begin(), picture.pixels.end());
  if (brightest > 1.0f)
    for (float& value : picture.pixels) value /= brightest;
  return picture;
}

Image<float> read_ambient_scale(const std::filesystem::path& path, Transfer png_transfer) {
  Image<float> picture = read_albedo(path, png_transfer);
  require_light(picture, path.string());
  return picture;
}

}  // namespace tofsmith
