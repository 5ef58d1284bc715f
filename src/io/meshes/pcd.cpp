// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/meshes/pcd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "io/shared/byte_order.hpp"

namespace tofsmith {

void write_pcd(const std::filesystem::path& path, const PointCloud& cloud, int height, int width,
               OutputPolicy policy) {
  std::string names = "x y z", sizes = "4 4 4", types = "F F F", counts = "1 1 1";
  for (const PointScalar& scalar : cloud.scalars) {
    names += " " + scalar.name;
    sizes += " 4";
    types += " F";
    counts += " 1";
  }
  const std::string header = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\n"
      "COUNT {}\nWIDTH {}\nHEIGHT {}\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      names, sizes, types, counts, width, height, cloud.points_m.size());
  std::vector<std::byte> content(header.size() + sizeof(float) * (3 + cloud.scalars.size()) *
                                                     cloud.points_m.size());
  std::ranges::copy(std::as_bytes(std::span(header)), content.begin());
  std::byte* at = content.data() + header.size();
  const auto put = [&at](float value) {
    store_little_endian(value, at);
    at += sizeof(float);
  };
  for (std::size_t i = 0; i < cloud.points_m.size(); ++i) {
    for (const float coordinate : cloud.points_m[i]) put(coordinate);
    for (const PointScalar& scalar : cloud.scalars) put(scalar.values[i]);
  }
  write_file_atomically(path, content, policy);
}

}  // namespace tofsmith
