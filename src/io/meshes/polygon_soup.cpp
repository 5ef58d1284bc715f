// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/meshes/polygon_soup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

#include "io/meshes/polygon_cutter.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

void check(const PolygonSoup& soup, std::string_view file) {
  for (std::size_t v = 0; v < soup.positions.size(); ++v) {
    const auto& [x, y, z] = soup.positions[v];
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z))
      throw IoError(
          file, fmt::format("vertex {}: found ({}, {}, {}); expected finite numbers", v, x, y, z));
  }
  std::size_t begin = 0;
  for (std::size_t f = 0; f < soup.face_end.size(); ++f) {
    const std::size_t end = soup.face_end[f];
    if (end - begin < 3)
      throw IoError(file,
                    fmt::format("face {}: found {} corners; expected 3 or more", f, end - begin));
    for (; begin < end; ++begin)
      if (soup.position_of[begin] >= soup.positions.size())
        throw IoError(file, fmt::format("face {}: found the vertex index {}; expected 0 to {}", f,
                                        static_cast<std::int32_t>(soup.position_of[begin]),
                                        static_cast<std::int64_t>(soup.positions.size()) - 1));
  }
  if (soup.face_end.empty()) throw IoError(file, "found no faces; expected triangles or polygons");
}

using Corner = std::array<float, 5>;  // x, y, z, u, v
struct HashOfCorner {
  std::size_t operator()(const Corner& corner) const {
    return std::hash<std::string_view>()(
        {reinterpret_cast<const char*>(corner.data()), sizeof(Corner)});
  }
};

class Collector {
 public:
  explicit Collector(const PolygonSoup& soup)
      : soup_(soup),
        with_texture_(std::ranges::find(soup.texture_of, PolygonSoup::none) ==
                      soup.texture_of.end()) {}

  void add(std::size_t begin, std::size_t end) {
    corners_.clear();
    for (std::size_t c = begin; c < end; ++c)
      corners_.push_back(soup_.positions[soup_.position_of[c]]);
    cut_.clear();
    cut_into_triangles(corners_, cut_);
    for (const auto& triangle : cut_) {
      auto& added = mesh.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) added[k] = vertex_of(begin + triangle[k]);
    }
  }

  TriangleMesh mesh;

 private:
  std::uint32_t vertex_of(std::size_t corner) {
    const auto& p = soup_.positions[soup_.position_of[corner]];
    const std::array<float, 2> uv =
        with_texture_ ? soup_.textures[soup_.texture_of[corner]] : std::array<float, 2>{};
    // Adding 0 converts -0 to 0.
    const Corner key{p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f, uv[0] + 0.0f, uv[1] + 0.0f};
    const auto [known, is_new] =
        vertex_of_.emplace(key, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      mesh.vertices.emplace_back(p[0], p[1], p[2]);
      if (with_texture_) mesh.texture_coordinates.emplace_back(uv[0], uv[1]);
    }
    return known->second;
  }

  const PolygonSoup& soup_;
  bool with_texture_;
  std::vector<std::array<float, 3>> corners_;
  std::vector<std::array<std::uint32_t, 3>> cut_;
  std::unordered_map<Corner, std::uint32_t, HashOfCorner> vertex_of_;
};

}  // namespace

std::string_view next_word(std::string_view& line) {
  constexpr std::string_view blanks = " \t\r\v\f";
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

TriangleMesh triangles_of(const PolygonSoup& soup, std::string_view file) {
  check(soup, file);
  Collector collector(soup);
  std::size_t begin = 0;
  for (const std::size_t end : soup.face_end) {
    collector.add(begin, end);
    begin = end;
  }
  try {
    collector.mesh.validate();
  } catch (const std::invalid_argument& error) {
    throw IoError(file, error.what());
  }
  return std::move(collector.mesh);
}

}  // namespace tofsmith
