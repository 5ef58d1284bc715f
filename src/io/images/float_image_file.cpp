// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/image_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>

#include "io/images/array_image.hpp"
#include "io/shared/file_kind.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/stray_light.hpp"

namespace tofsmith {
namespace {

// OpenEXR's convention for distance along the viewing axis.
std::string exr_channel(std::string_view name) { return name == "depth" ? "Z" : std::string(name); }

/// NaN equals NaN.
bool same_pixels(const Image<float>& a, const Image<float>& b) {
  return std::memcmp(a.pixels.data(), b.pixels.data(), a.size() * sizeof(float)) == 0;
}

/// Renderers use several names for depth, or write it to R, G and B.
Image<float> only_plane(ExrPlanes planes, std::string_view name, const std::string& file) {
  for (const std::string& usual : {std::string(name), std::string("Z"), std::string("Y")})
    if (const auto found = planes.find(usual); found != planes.end())
      return std::move(found->second);
  if (planes.size() == 1) return std::move(planes.begin()->second);
  const auto red = planes.find("R"), green = planes.find("G"), blue = planes.find("B");
  const bool coloured = red != planes.end() && green != planes.end() && blue != planes.end();
  if (coloured && same_pixels(red->second, green->second) && same_pixels(red->second, blue->second))
    return std::move(red->second);

  std::vector<std::string> names;
  for (const auto& entry : planes) names.push_back(entry.first);
  throw IoError(file, fmt::format("found the channels {}; expected '{}', Z or Y, or only one",
                                  fmt::join(names, ", "), name));
}

}  // namespace

Image<float> read_float_image(const std::filesystem::path& path, std::string_view name) {
  const std::string file = path.string();
  const std::string extension = known_extension(path, {".npy", ".npz", ".exr", ".pfm"});
  if (extension == ".npy") return image_from_array(read_npy(path), file);
  if (extension == ".npz")
    return image_from_array(array_called_or_only(NpzReader(path), name, file), file);
  if (extension == ".exr") return only_plane(read_exr(path), name, file);
  return image_from_pfm(read_pfm(path), file);
}

Image<float> read_stray_light(const std::filesystem::path& path) {
  Image<float> kernel = read_float_image(path, "kernel");
  try {
    static_cast<void>(StrayLight(kernel));
  } catch (const std::invalid_argument& error) {
    throw IoError(path.string(), error.what());
  }
  return kernel;
}

void write_float_image(const std::filesystem::path& path, const Image<float>& image,
                       std::string_view name, OutputPolicy policy) {
  const std::string extension = known_extension(path, {".npy", ".npz", ".exr", ".pfm"});
  require_pixels(image);
  if (extension == ".npy") write_npy(path, array_from_image(image), policy);
  if (extension == ".npz") write_npz(path, {{std::string(name), array_from_image(image)}}, policy);
  if (extension == ".exr") write_exr(path, {{exr_channel(name), image}}, policy);
  if (extension == ".pfm")
    write_pfm(path, PfmImage{image.height, image.width, 1, 1.0, image.pixels}, policy);
}

}  // namespace tofsmith
