// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "depth_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tofsmith/core/error.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/exr.hpp"
#include "tofsmith/io/npz.hpp"
#include "tofsmith/io/ply.hpp"

namespace tofsmith::apps {

namespace {

Image<float> plane(const DepthImage& image, const std::string& name) {
  if (name == "depth") return image.depth_m;
  if (name == "signal") return image.signal_e_per_s;
  if (name == "ambient") return image.ambient_e_per_s;
  if (name == "confidence") return image.confidence;
  if (name == "deviation") return image.predicted_standard_deviation_m;
  Image<float> status(image.height(), image.width());
  for (std::size_t i = 0; i < status.size(); ++i)
    status.pixels[i] = static_cast<float>(image.status.pixels[i]);
  return status;
}

NpyShape shape_of(const DepthImage& image) {
  return {static_cast<std::size_t>(image.height()), static_cast<std::size_t>(image.width())};
}

NpzArrays arrays(const DepthImage& image, const std::vector<std::string>& planes) {
  NpzArrays result;
  for (const std::string& name : planes) {
    if (name == "status") {
      std::vector<std::uint8_t> codes;
      for (const PixelStatus s : image.status.pixels) codes.push_back(static_cast<std::uint8_t>(s));
      result.emplace(name, NpyArray::of<std::uint8_t>(shape_of(image), codes));
    } else {
      const Image<float> values = plane(image, name);
      result.emplace(name, NpyArray::of<float>(shape_of(image), values.pixels));
    }
  }
  return result;
}

PointCloud cloud(const DepthImage& image, const std::vector<std::string>& planes,
                 const PinholeView& view) {
  PointCloud result;
  std::vector<std::size_t> kept;
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column) {
      const float depth_m = image.depth_m(row, column);
      if (!std::isfinite(depth_m)) continue;
      const Eigen::Vector3d point = view.ray(row, column) * static_cast<double>(depth_m);
      result.points_m.push_back({static_cast<float>(point.x()), static_cast<float>(point.y()),
                                 static_cast<float>(point.z())});
      kept.push_back(static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width()) +
                     static_cast<std::size_t>(column));
    }
  for (const std::string& name : planes) {
    const Image<float> values = plane(image, name);
    PointScalar scalar{name, {}};
    for (const std::size_t i : kept) scalar.values.push_back(values.pixels[i]);
    result.scalars.push_back(std::move(scalar));
  }
  return result;
}

}  // namespace

std::vector<std::string> plane_names() {
  return {"depth", "signal", "ambient", "confidence", "deviation", "status"};
}

void write_decoded(const std::filesystem::path& path, const DepthImage& image,
                   const std::vector<std::string>& planes, const PinholeView& view,
                   OutputPolicy policy) {
  const std::string extension = path.extension().string();
  if (extension == ".npz") {
    write_npz(path, arrays(image, planes), policy);
  } else if (extension == ".ply") {
    write_ply(path, cloud(image, planes, view), policy);
  } else if (extension == ".exr") {
    ExrPlanes channels;
    for (const std::string& name : planes)
      channels[name == "depth" ? "Z" : name] = plane(image, name);
    write_exr(path, channels, policy);
  } else {
    write_depth(path, image.depth_m, policy);
  }
}

void check_decoded_output(const std::filesystem::path& path, const Session& session) {
  const std::string extension = path.extension().string();
  constexpr std::array<std::string_view, 6> known{".npy", ".npz", ".exr", ".pfm", ".png", ".ply"};
  if (std::ranges::find(known, extension) == known.end())
    throw IoError(path.string(),
                  fmt::format("unknown extension \"{}\"; expected .npy, .npz, .exr, .pfm, .png "
                              "(16 bits, mm) or .ply",
                              extension));
  session.check_output(path);
}

std::string status_summary(const DepthImage& image) {
  std::map<PixelStatus, std::size_t> counts;
  for (const PixelStatus s : image.status.pixels) ++counts[s];
  std::string text;
  for (const auto& [status, count] : counts)
    text +=
        fmt::format("{}{} {:.2f} %", text.empty() ? "" : ", ", name_of(status),
                    100.0 * static_cast<double>(count) / static_cast<double>(image.status.size()));
  return text;
}

}  // namespace tofsmith::apps
