// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/depth_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "io/images/array_image.hpp"
#include "io/shared/file_kind.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/image_file.hpp"

namespace tofsmith {
namespace {

constexpr double m_per_mm = 1e-3;
constexpr int max_png_mm = 65535;

std::string depth_extension(const std::filesystem::path& path) {
  return known_extension(path, {".npy", ".npz", ".exr", ".pfm", ".png"});
}

Image<float> depth_from_png(const PngImage& png, const std::string& file) {
  if (png.channels != 1 || png.bit_depth != 16)
    throw IoError(file, fmt::format("found {} channels of {} bits; expected 16-bit grey, depth in "
                                    "millimetres",
                                    png.channels, png.bit_depth));
  Image<float> depth_m(png.height, png.width);
  for (std::size_t i = 0; i < depth_m.size(); ++i)
    depth_m.pixels[i] = static_cast<float>(png.values[i] * m_per_mm);
  return depth_m;
}

PngImage png_from_depth(const Image<float>& depth_m, const std::string& file) {
  PngImage png{depth_m.height, depth_m.width, 1, 16, {}};
  png.values.reserve(depth_m.size());
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const double mm = std::nearbyint(static_cast<double>(depth_m.pixels[i]) / m_per_mm);
    const bool returned = std::isfinite(mm);
    if (returned && (mm < 0.0 || mm > max_png_mm))
      throw IoError(file,
                    fmt::format("row {}, column {}: found a depth of {} m; expected 0 .. {} m, "
                                "all that 16 bits of millimetres hold (write .npy, .exr or .pfm)",
                                i / depth_m.width, i % depth_m.width, depth_m.pixels[i],
                                max_png_mm * m_per_mm));
    png.values.push_back(returned ? static_cast<std::uint16_t>(mm) : std::uint16_t{0});
  }
  return png;
}

void mark_no_return(Image<float>& depth_m) {
  for (float& depth : depth_m.pixels)
    if (!std::isfinite(depth) || depth == 0.0f) depth = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

Image<float> read_depth(const std::filesystem::path& path) {
  const bool millimetres = depth_extension(path) == ".png";
  Image<float> depth_m =
      millimetres ? depth_from_png(read_png(path), path.string()) : read_float_image(path, "depth");
  mark_no_return(depth_m);
  return depth_m;
}

void write_depth(const std::filesystem::path& path, const Image<float>& depth_m,
                 OutputPolicy policy) {
  const bool millimetres = depth_extension(path) == ".png";
  require_pixels(depth_m);
  if (millimetres)
    write_png(path, png_from_depth(depth_m, path.string()), policy);
  else
    write_float_image(path, depth_m, "depth", policy);
}

}  // namespace tofsmith
