// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/decoded_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "io/images/depth_kind_fields.hpp"
#include "io/images/exr.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/point_cloud.hpp"

namespace tofsmith {

Undistortion::Undistortion(const PinholeView& view) {
  const PixelRays rays(view);
  const PinholeView ideal = view.ideal();
  const auto width = static_cast<std::size_t>(view.width);
  source_.assign(static_cast<std::size_t>(view.height) * width, -1);
  radial_ratio_.assign(source_.size(), 1.0f);
  parallel_for(view.height, [&](std::int64_t line) {
    const int row = static_cast<int>(line);
    for (int column = 0; column < view.width; ++column) {
      const auto seen_at = view.pixel_of(ideal.ray(row, column));
      if (!seen_at) continue;
      const double at_row = std::round(seen_at->y()), at_column = std::round(seen_at->x());
      if (!(at_row >= 0.0 && at_row < view.height && at_column >= 0.0 && at_column < view.width))
        continue;
      const int source_row = static_cast<int>(at_row), source_column = static_cast<int>(at_column);
      const std::size_t pixel =
          static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
      source_[pixel] = source_row * view.width + source_column;
      radial_ratio_[pixel] = static_cast<float>(ideal.radial_per_z(row, column) /
                                                rays.radial_per_z(source_row, source_column));
    }
  });
}

std::size_t Undistortion::bytes() const {
  constexpr std::size_t largest_item = sizeof(float);
  return source_.size() * (sizeof(std::int32_t) + sizeof(float) + largest_item);
}

void Undistortion::turn_radial(Image<float>& depth_m) const {
  for (std::size_t i = 0; i < radial_ratio_.size(); ++i) depth_m.pixels[i] *= radial_ratio_[i];
}

std::string_view help_of_outputs() {
  static const std::string text = [] {
    std::string all = "planes to write; others are not computed";
    for (const PlaneDescription& described : plane_descriptions)
      all +=
          fmt::format("{}{}{}: {}", described.plane == DecodedPlane{} ? ". " : "; ", described.word,
                      described.unit.empty() ? "" : fmt::format(" [{}]", described.unit),
                      help_of(described.plane));
    return all;
  }();
  return text;
}

std::string_view default_of_outputs() {
  static const std::string text = [] {
    const std::vector<DecodedPlane> planes = usual_planes();
    std::string all(name_of(planes.front()));
    for (const DecodedPlane plane : std::span(planes).subspan(1))
      all += fmt::format("{}{}", plane == planes.back() ? " and " : ", ", name_of(plane));
    return all + ", if the format supports them";
  }();
  return text;
}

NpyType type_of(DecodedPlane plane) {
  static const DepthImage types;
  return with_plane(
      plane,
      []<typename Value>(const Image<Value>&) {
        if constexpr (std::is_enum_v<Value>)
          return npy_type_of<std::underlying_type_t<Value>>;
        else
          return npy_type_of<Value>;
      },
      types);
}

std::size_t bytes_per_pixel(const std::vector<DecodedPlane>& planes) {
  std::size_t bytes = 0;
  for (const DecodedPlane plane : planes) bytes += item_size(type_of(plane));
  return bytes;
}

void undistort(DepthImage& image, const Undistortion& undistortion, bool as_z) {
  for_each_plane(
      [&]<typename Value>(Image<Value>& plane) {
        if (!plane.empty()) undistortion.apply(plane, no_value<Value>);
      },
      image);
  if (!as_z && !image.depth_m.empty()) undistortion.turn_radial(image.depth_m);
}

namespace {

/// Statuses become their codes.
Image<float> floats_of(const DepthImage& image, DecodedPlane plane) {
  return with_plane(
      plane,
      [](const auto& values) {
        Image<float> floats(values.height, values.width);
        std::ranges::transform(values.pixels, floats.pixels.begin(),
                               [](auto value) { return static_cast<float>(value); });
        return floats;
      },
      image);
}

}  // namespace

std::span<const std::byte> items_of(const DepthImage& image, DecodedPlane plane, int rows) {
  return with_plane(
      plane,
      [rows](const auto& values) {
        const std::size_t count =
            static_cast<std::size_t>(rows) * static_cast<std::size_t>(values.width);
        return std::as_bytes(std::span(values.pixels).first(count));
      },
      image);
}

void turn_into_z(float* depth_m, int first_row, int rows, const PixelRays& pixel_rays) {
  const int width = pixel_rays.view().width;
  parallel_for(rows, [&](std::int64_t row) {
    float* depth = depth_m + row * width;
    for (int column = 0; column < width; ++column)
      depth[column] = static_cast<float>(
          depth[column] *
          (1.0 / pixel_rays.radial_per_z(first_row + static_cast<int>(row), column)));
  });
}

namespace {

NpzArrays arrays(const DepthImage& decoded, const std::vector<DecodedPlane>& planes,
                 DepthKind kind) {
  NpzArrays result;
  if (std::ranges::count(planes, DecodedPlane::depth) > 0) add_depth_kind(kind, result);
  for (const DecodedPlane plane : planes) {
    const auto [height, width] = with_plane(
        plane, [](const auto& image) { return std::pair(image.height, image.width); }, decoded);
    NpyArray array(type_of(plane),
                   {static_cast<std::size_t>(height), static_cast<std::size_t>(width)});
    std::ranges::copy(items_of(decoded, plane, height), array.bytes().begin());
    result.emplace(name_of(plane), std::move(array));
  }
  return result;
}

/// @param organized  include pixels without points as NaN
PointCloud cloud(const DepthImage& decoded, const std::vector<DecodedPlane>& planes,
                 const PixelRays& pixel_rays, bool all_points, bool organized) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  PointCloud result;
  std::vector<std::size_t> kept;
  result.points_m.reserve(decoded.depth_m.size());  // growing needs twice the memory temporarily
  kept.reserve(decoded.depth_m.size());
  for (int row = 0; row < decoded.depth_m.height; ++row)
    for (int column = 0; column < decoded.depth_m.width; ++column) {
      const float depth_m = decoded.depth_m(row, column);
      const Eigen::Vector3d point = pixel_rays.ray(row, column) * static_cast<double>(depth_m);
      const bool has_point =
          point.allFinite() && (all_points || decoded.status(row, column) == PixelStatus::ok);
      if (!has_point && !organized) continue;
      if (has_point)
        result.points_m.push_back({static_cast<float>(point.x()), static_cast<float>(point.y()),
                                   static_cast<float>(point.z())});
      else
        result.points_m.push_back({nan, nan, nan});
      kept.push_back(static_cast<std::size_t>(row) *
                         static_cast<std::size_t>(decoded.depth_m.width) +
                     static_cast<std::size_t>(column));
    }
  for (const DecodedPlane plane : planes) {
    const Image<float> values = floats_of(decoded, plane);
    PointScalar scalar{std::string(name_of(plane)), {}};
    scalar.values.reserve(kept.size());
    for (const std::size_t i : kept) scalar.values.push_back(values.pixels[i]);
    result.scalars.push_back(std::move(scalar));
  }
  return result;
}

std::filesystem::path with_suffix(std::filesystem::path path, const std::string& suffix) {
  path.replace_filename(path.stem().string() + suffix + path.extension().string());
  return path;
}

/// name.npy for depth, name-PLANE.npy for others.
std::filesystem::path stack_path(const std::filesystem::path& path, DecodedPlane plane) {
  return plane == DecodedPlane::depth ? path : with_suffix(path, "-" + std::string(name_of(plane)));
}

/// Temporary memory of write_planes(), in addition to the planes [bytes per pixel]; an upper limit
/// except for .npy.
std::size_t writing_bytes_per_pixel(std::string_view extension,
                                    const std::vector<DecodedPlane>& planes) {
  const std::size_t held = bytes_per_pixel(planes), depth = sizeof(float);
  if (extension == ".npz") return held;  // copies as arrays
  // Kept pixels, and the points with their scalars as lists and as a file.
  if (extension == ".ply" || extension == ".pcd")
    return sizeof(std::size_t) + 2 * (3 + planes.size()) * sizeof(float);
  if (extension == ".exr") return 2 * planes.size() * sizeof(float);
  return 2 * depth;  // .pfm, .png: converted, and the file
}

/// Fails early if write_planes() cannot write to this path. @throws IoError
void check_decoded_output(const std::filesystem::path& path, OutputPolicy policy) {
  const std::string extension = path.extension().string();
  constexpr std::array<std::string_view, 7> known{".npy", ".npz", ".exr", ".pfm",
                                                  ".png", ".ply", ".pcd"};
  if (std::ranges::find(known, extension) == known.end())
    throw IoError(path.string(),
                  fmt::format("unknown extension \"{}\"; expected .npy, .npz, .exr, .pfm, .png "
                              "(16 bits, mm), .ply or .pcd",
                              extension));
  const AtomicFile probe(path, policy);  // never committed
}

}  // namespace

void write_planes(const std::filesystem::path& path, const DepthImage& decoded,
                  const std::vector<DecodedPlane>& planes, DepthKind kind,
                  const PixelRays& pixel_rays, bool all_points, OutputPolicy policy) {
  const std::string extension = path.extension().string();
  if (extension == ".npz") {
    write_npz(path, arrays(decoded, planes, kind), policy);
  } else if (extension == ".ply") {
    write_ply(path, cloud(decoded, planes, pixel_rays, all_points, false), policy);
  } else if (extension == ".pcd") {
    write_pcd(path, cloud(decoded, planes, pixel_rays, all_points, true), decoded.depth_m.height,
              decoded.depth_m.width, policy);
  } else if (extension == ".exr") {
    ExrPlanes channels;
    for (const DecodedPlane plane : planes)
      channels[plane == DecodedPlane::depth ? "Z" : std::string(name_of(plane))] =
          floats_of(decoded, plane);
    write_exr(path, channels, policy, channels.contains("Z") ? exr_text_of(kind) : ExrText());
  } else {
    write_depth(path, decoded.depth_m, policy, kind);
  }
}

void write_decoded(const std::filesystem::path& path, const DepthImage& image,
                   const std::vector<DecodedPlane>& planes, const PinholeView& view,
                   OutputPolicy policy, bool all_points) {
  for (const DecodedPlane plane : planes)
    require(!with_plane(
                plane, [](const auto& values) { return values.empty(); }, image),
            "planes", name_of(plane), "must be planes that the image has");
  check_decoded_output(path, policy);
  write_planes(path, image, planes, DepthKind::radial,
               holds_points(path) ? PixelRays(view) : PixelRays(), all_points, policy);
}

bool holds_points(const std::filesystem::path& path) {
  return path.extension() == ".ply" || path.extension() == ".pcd";
}

bool holds_depth_only(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".npy" || extension == ".pfm" || extension == ".png";
}

std::filesystem::path DecodeTarget::frame_path(int frame) const {
  if (frames == 1) return path;
  const std::size_t digits = std::to_string(first_frame + frames - 1).size();
  return with_suffix(path, fmt::format("-{:0{}}", frame, digits));
}

std::vector<std::filesystem::path> DecodeTarget::paths() const {
  std::vector<std::filesystem::path> all;
  if (stack)
    for (const DecodedPlane plane : planes) all.push_back(stack_path(path, plane));
  else
    for (int frame = first_frame; frame < first_frame + frames; ++frame)
      all.push_back(frame_path(frame));
  return all;
}

std::vector<DecodedPlane> DecodeTarget::needed_planes() const {
  std::vector<DecodedPlane> needed = planes;
  const auto need = [&](DecodedPlane plane) {
    if (std::ranges::find(needed, plane) == needed.end()) needed.push_back(plane);
  };
  if (holds_points(path)) {
    need(DecodedPlane::depth);
    if (!all_points) need(DecodedPlane::status);
  }
  if (count_statuses) need(DecodedPlane::status);
  for (const DecodedPlane plane : correction_planes) need(plane);
  return needed;
}

std::size_t DecodeTarget::writing_bytes() const {
  if (in_rows()) return 0;
  return static_cast<std::size_t>(view.height) * static_cast<std::size_t>(view.width) *
         writing_bytes_per_pixel(path.extension().string(), planes);
}

DecodeOutput::DecodeOutput(DecodeTarget target) : target_(std::move(target)) {
  const std::vector<std::filesystem::path> paths = target_.paths();
  target_.policy = policy_to_go_on(paths, target_.policy);
  for (const std::filesystem::path& path : paths) check_decoded_output(path, target_.policy);
}

void DecodeOutput::take(int frame, int first_row, int rows, const DepthImage& planes) {
  const bool first = first_row == 0, last = first_row + rows == target_.view.height;
  if (!target_.in_rows()) {
    if (last)
      write_planes(target_.frame_path(frame), planes, target_.planes,
                   target_.as_z ? DepthKind::z : DepthKind::radial, target_.pixel_rays,
                   target_.all_points, target_.policy);
    return;
  }
  if (first && !(target_.stack && frame > target_.first_frame)) open_files(frame);
  for (std::size_t i = 0; i < files_.size(); ++i)
    files_[i]->append(items_of(planes, target_.planes[i], rows));
  if (last && !target_.stack) finish();
}

void DecodeOutput::open_files(int frame) {
  const auto height = static_cast<std::size_t>(target_.view.height);
  const auto width = static_cast<std::size_t>(target_.view.width);
  NpyShape shape = {height, width};
  if (target_.stack) shape.insert(shape.begin(), static_cast<std::size_t>(target_.frames));
  for (const DecodedPlane plane : target_.planes)
    files_.push_back(std::make_unique<NpyItemWriter>(
        target_.stack ? stack_path(target_.path, plane) : target_.frame_path(frame), type_of(plane),
        shape, target_.policy));
}

void DecodeOutput::finish() {
  for (const auto& file : files_) file->commit();
  files_.clear();
}

}  // namespace tofsmith
