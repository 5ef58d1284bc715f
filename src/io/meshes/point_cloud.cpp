// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/point_cloud.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "io/shared/byte_order.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

bool is_word(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

void check(const PointCloud& cloud) {
  const auto same_length = [&](std::size_t length, const std::string& list) {
    require(length == cloud.points_m.size(), "number of " + list, length,
            fmt::format("must equal that of points_m, {}", cloud.points_m.size()));
  };
  std::set<std::string> taken = {"x", "y", "z", "red", "green", "blue"};
  for (const PointScalar& scalar : cloud.scalars) {
    require(is_word(scalar.name), "scalar name", scalar.name,
            "must be letters, digits and underscores");
    require(taken.insert(scalar.name).second, "scalar name", scalar.name, "must be unique");
    same_length(scalar.values.size(), scalar.name);
  }
  if (!cloud.colours.empty()) same_length(cloud.colours.size(), "colours");
}

std::string ply_header(const PointCloud& cloud) {
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n",
      cloud.points_m.size());
  for (const PointScalar& scalar : cloud.scalars)
    text += fmt::format("property float {}\n", scalar.name);
  if (!cloud.colours.empty())
    text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  return text + "end_header\n";
}

std::string pcd_header(const PointCloud& cloud, int height, int width) {
  std::string names = "x y z", sizes = "4 4 4", types = "F F F", counts = "1 1 1";
  for (const PointScalar& scalar : cloud.scalars) {
    names += " " + scalar.name;
    sizes += " 4";
    types += " F";
    counts += " 1";
  }
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\n"
      "COUNT {}\nWIDTH {}\nHEIGHT {}\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      names, sizes, types, counts, width, height, cloud.points_m.size());
}

/// Writes x, y, z, the scalars and the colour of every point after the header.
std::vector<std::byte> with_points(const std::string& header, const PointCloud& cloud) {
  const std::size_t row_bytes =
      sizeof(float) * (3 + cloud.scalars.size()) + (cloud.colours.empty() ? 0 : 3);
  std::vector<std::byte> content(header.size() + row_bytes * cloud.points_m.size());
  std::ranges::copy(std::as_bytes(std::span(header)), content.begin());

  std::byte* at = content.data() + header.size();
  const auto put = [&at](float value) {
    store_little_endian(value, at);
    at += sizeof(float);
  };
  for (std::size_t i = 0; i < cloud.points_m.size(); ++i) {
    for (const float coordinate : cloud.points_m[i]) put(coordinate);
    for (const PointScalar& scalar : cloud.scalars) put(scalar.values[i]);
    if (!cloud.colours.empty())
      for (const std::uint8_t part : cloud.colours[i]) *at++ = static_cast<std::byte>(part);
  }
  return content;
}

}  // namespace

std::vector<std::byte> serialize_ply(const PointCloud& cloud) {
  check(cloud);
  return with_points(ply_header(cloud), cloud);
}

void write_ply(const std::filesystem::path& path, const PointCloud& cloud, OutputPolicy policy) {
  write_file_atomically(path, serialize_ply(cloud), policy);
}

void write_pcd(const std::filesystem::path& path, const PointCloud& cloud, int height, int width,
               OutputPolicy policy) {
  write_file_atomically(path, with_points(pcd_header(cloud, height, width), cloud), policy);
}

}  // namespace tofsmith
