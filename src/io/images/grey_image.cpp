// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/images/grey_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/shared/file_kind.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/image_file.hpp"

namespace tofsmith {

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

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

}  // namespace tofsmith
