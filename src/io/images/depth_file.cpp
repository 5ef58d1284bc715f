// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/depth_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "io/images/array_image.hpp"
#include "io/images/depth_kind_fields.hpp"
#include "io/shared/file_kind.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/image_file.hpp"

namespace tofsmith {
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
  constexpr auto words = words_of(DepthKind{});
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
    NpzArrays arrays = {{"depth", array_from_image(depth_m)}};
    add_depth_kind(kind, arrays);
    write_npz(path, arrays, policy);
  } else if (extension == ".exr") {
    write_exr(path, {{"Z", depth_m}}, policy, exr_text_of(kind));
  } else {
    write_float_image(path, depth_m, "depth", policy);
  }
}

}  // namespace tofsmith
