// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "depth_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tofsmith/core/error.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/exr.hpp"
#include "tofsmith/io/npz.hpp"
#include "tofsmith/io/ply.hpp"

namespace tofsmith::apps {

namespace {

NpzArrays arrays(const DecodedPlanes& decoded, const std::vector<std::string>& planes) {
  NpzArrays result;
  for (const std::string& name : planes) {
    NpyArray array(type_of_plane(name), {static_cast<std::size_t>(decoded.height()),
                                         static_cast<std::size_t>(decoded.width())});
    std::ranges::copy(decoded.items(name, decoded.height()), array.bytes().begin());
    result.emplace(name, std::move(array));
  }
  return result;
}

PointCloud cloud(const DecodedPlanes& decoded, const std::vector<std::string>& planes,
                 const PinholeView& view) {
  PointCloud result;
  std::vector<std::size_t> kept;
  result.points_m.reserve(
      decoded.depth_m().size());  // growing would take twice as much for a while
  kept.reserve(decoded.depth_m().size());
  for (int row = 0; row < decoded.height(); ++row)
    for (int column = 0; column < decoded.width(); ++column) {
      const float depth_m = decoded.depth_m()(row, column);
      if (!std::isfinite(depth_m)) continue;
      const Eigen::Vector3d point = view.ray(row, column) * static_cast<double>(depth_m);
      result.points_m.push_back({static_cast<float>(point.x()), static_cast<float>(point.y()),
                                 static_cast<float>(point.z())});
      kept.push_back(static_cast<std::size_t>(row) * static_cast<std::size_t>(decoded.width()) +
                     static_cast<std::size_t>(column));
    }
  for (const std::string& name : planes) {
    const Image<float> values = decoded.floats(name);
    PointScalar scalar{name, {}};
    scalar.values.reserve(kept.size());
    for (const std::size_t i : kept) scalar.values.push_back(values.pixels[i]);
    result.scalars.push_back(std::move(scalar));
  }
  return result;
}

}  // namespace

void write_decoded(const std::filesystem::path& path, const DecodedPlanes& decoded,
                   const std::vector<std::string>& planes, const PinholeView& view,
                   OutputPolicy policy) {
  const std::string extension = path.extension().string();
  if (extension == ".npz") {
    write_npz(path, arrays(decoded, planes), policy);
  } else if (extension == ".ply") {
    write_ply(path, cloud(decoded, planes, view), policy);
  } else if (extension == ".exr") {
    ExrPlanes channels;
    for (const std::string& name : planes)
      channels[name == "depth" ? "Z" : name] = decoded.floats(name);
    write_exr(path, channels, policy);
  } else {
    write_depth(path, decoded.depth_m(), policy);
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

std::size_t writing_bytes_per_pixel(std::string_view extension,
                                    const std::vector<std::string>& planes) {
  const std::size_t held = bytes_per_pixel(planes), depth = sizeof(float);
  if (extension == ".npz") return held;  // as arrays
  // The list of kept pixels, and the points with their scalars twice: as lists and as a file.
  if (extension == ".ply") return sizeof(std::size_t) + 2 * (3 + planes.size()) * sizeof(float);
  // Channels of floats, and at worst the same again in the file.
  if (extension == ".exr") return 2 * planes.size() * sizeof(float);
  return 2 * depth;  // .pfm, .png: converted, and the file
}

}  // namespace tofsmith::apps
