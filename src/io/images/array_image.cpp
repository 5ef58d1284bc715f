// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/images/array_image.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "io/image_limits.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/image_file.hpp"

namespace tofsmith {

Image<float> image_from_array(const NpyArray& array, std::string_view file) {
  require_floats(array, file);
  if (array.axes() != 2)
    throw IoError(file, fmt::format("found an array of shape {}; expected (H, W)",
                                    describe_shape(array.shape())));
  check_image_size(file, array.shape()[0], array.shape()[1]);
  Image<float> image;
  image.height = static_cast<int>(array.shape()[0]);
  image.width = static_cast<int>(array.shape()[1]);
  image.pixels = array.to_floats();
  return image;
}

std::string name_called_or_only(const NpzReader& archive, std::string_view name,
                                std::string_view file) {
  if (archive.contains(name)) return std::string(name);
  if (archive.names().size() == 1) return archive.names()[0];
  throw IoError(file, fmt::format("found the arrays {}; expected one called '{}', or only one",
                                  fmt::join(archive.names(), ", "), name));
}

NpyArray array_called_or_only(const NpzReader& archive, std::string_view name,
                              std::string_view file) {
  return archive.read(name_called_or_only(archive, name, file));
}

void require_floats(const NpyArray& array, std::string_view file) {
  if (is_float(array.type())) return;
  throw IoError(file, fmt::format("found items of type {}; expected float16, float32 or float64",
                                  name_of(array.type())));
}

Image<float> image_from_pfm(PfmImage pfm, std::string_view file) {
  if (pfm.channels != 1)
    throw IoError(file, "found a colour image; expected one number per pixel ('Pf')");
  Image<float> image;
  image.height = pfm.height;
  image.width = pfm.width;
  image.pixels = std::move(pfm.values);
  return image;
}

void require_pixels(const Image<float>& image) {
  require(image.height >= 1, "height", image.height, "must be >= 1");
  require(image.width >= 1, "width", image.width, "must be >= 1");
  const std::size_t expected =
      static_cast<std::size_t>(image.height) * static_cast<std::size_t>(image.width);
  require(image.size() == expected, "number of pixels", image.size(),
          fmt::format("must be height x width = {}", expected));
}

namespace {

NpyArray array_of(const PngImage& png, const std::string& file) {
  if (png.channels != 1)
    throw IoError(file, fmt::format("found {} channels; expected a grey image", png.channels));
  const NpyShape shape = {static_cast<std::size_t>(png.height),
                          static_cast<std::size_t>(png.width)};
  if (png.bit_depth == 16) return NpyArray::of<std::uint16_t>(shape, png.values);
  std::vector<std::uint8_t> bytes(png.values.size());
  std::transform(png.values.begin(), png.values.end(), bytes.begin(),
                 [](std::uint16_t value) { return static_cast<std::uint8_t>(value); });
  return NpyArray::of<std::uint8_t>(shape, bytes);
}

}  // namespace

bool is_grey_image(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".png" || extension == ".tif" || extension == ".tiff" || extension == ".pgm";
}

NpyArray read_grey_image(const std::filesystem::path& path) {
  const std::string extension = known_extension(path, {".png", ".tif", ".tiff", ".pgm"});
  if (extension == ".png") return array_of(read_png(path), path.string());
  const std::vector<std::byte> content = read_binary_file(path);
  return extension == ".pgm" ? parse_pgm(content, path.string())
                             : parse_tiff(content, path.string());
}

double linear_from_srgb(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

}  // namespace tofsmith
