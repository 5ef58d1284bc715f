// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/image_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "io/arrays/shared/array_matrix.hpp"
#include "io/image_limits.hpp"
#include "io/images/array_image.hpp"
#include "io/images/depth_kind_fields.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/stray_light.hpp"
#include "tofsmith/io/depth_file.hpp"

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

namespace {

constexpr double m_per_mm = 1e-3;
constexpr int max_png_mm = 65535;

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

constexpr const char* array_of_kind = "depth_is_z";
constexpr const char* exr_attribute_of_kind = "depthKind";

std::optional<DepthKind> kind_of_word(std::string_view word) {
  const auto& words = all_words<DepthKind>;
  const auto found = std::ranges::find(words, word);
  if (found == words.end()) return std::nullopt;
  return static_cast<DepthKind>(found - words.begin());
}

PngImage png_from_depth(const Image<float>& depth_m, DepthKind kind, const std::string& file) {
  PngImage png{depth_m.height, depth_m.width, 1, 16, {}};
  png.depth_kind = name_of(kind);
  png.values.reserve(depth_m.size());
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const double mm = std::nearbyint(static_cast<double>(depth_m.pixels[i]) / m_per_mm);
    const bool returned = std::isfinite(mm);
    if (returned && (mm < 0.0 || mm > max_png_mm))
      throw IoError(file, fmt::format("row {}, column {}: found a depth of {} m; expected 0 to {} "
                                      "m, the range of 16-bit millimetres (use .npy, .exr or .pfm)",
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

std::string depth_extension(const std::filesystem::path& path) {
  return known_extension(path, {".npy", ".npz", ".exr", ".pfm", ".png"});
}

Image<float> read_depth(const std::filesystem::path& path) {
  const bool millimetres = depth_extension(path) == ".png";
  Image<float> depth_m =
      millimetres ? depth_from_png(read_png(path), path.string()) : read_float_image(path, "depth");
  mark_no_return(depth_m);
  return depth_m;
}

std::optional<DepthKind> stored_depth_kind(const std::filesystem::path& path) {
  const std::string extension = depth_extension(path);
  if (extension == ".png") return kind_of_word(read_png(path).depth_kind);
  if (extension == ".exr") return kind_of_word(read_exr_text(path, exr_attribute_of_kind));
  if (extension != ".npz") return std::nullopt;
  const NpzReader archive(path);
  if (!archive.contains(array_of_kind)) return std::nullopt;
  const std::vector<double> is_z = archive.read(array_of_kind).to_doubles();
  return !is_z.empty() && is_z.front() != 0.0 ? DepthKind::z : DepthKind::radial;
}

DepthKind depth_kind_of(const std::filesystem::path& path, std::optional<DepthKind> requested,
                        DepthKind fallback) {
  const std::optional<DepthKind> stored = stored_depth_kind(path);
  if (stored && requested && *stored != *requested)
    throw IoError(path.string(),
                  fmt::format("states that its depth is of kind {}; expected {}, as requested "
                              "(omit the kind to use that of the file)",
                              name_of(*stored), name_of(*requested)));
  return stored.value_or(requested.value_or(fallback));
}

void add_depth_kind(DepthKind kind, NpzArrays& arrays) {
  const std::array is_z = {static_cast<std::uint8_t>(kind == DepthKind::z)};
  arrays.emplace(array_of_kind, NpyArray::of<std::uint8_t>({1}, is_z));
}

ExrText exr_text_of(DepthKind kind) { return {exr_attribute_of_kind, std::string(name_of(kind))}; }

void write_depth(const std::filesystem::path& path, const Image<float>& depth_m,
                 OutputPolicy policy, DepthKind kind) {
  const std::string extension = depth_extension(path);
  require_pixels(depth_m);
  if (extension == ".png") {
    write_png(path, png_from_depth(depth_m, kind, path.string()), policy);
  } else if (extension == ".npz") {
    NpzArrays arrays = {{"depth", array_of(depth_m)}};
    add_depth_kind(kind, arrays);
    write_npz(path, arrays, policy);
  } else if (extension == ".exr") {
    write_exr(path, {{"Z", depth_m}}, policy, exr_text_of(kind));
  } else {
    write_float_image(path, depth_m, "depth", policy);
  }
}

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
  if (extension == ".npy") write_npy(path, array_of(image), policy);
  if (extension == ".npz") write_npz(path, {{std::string(name), array_of(image)}}, policy);
  if (extension == ".exr") write_exr(path, {{exr_channel(name), image}}, policy);
  if (extension == ".pfm")
    write_pfm(path, PfmImage{image.height, image.width, 1, 1.0, image.pixels}, policy);
}

}  // namespace tofsmith
