// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/meshes/polygon_soup.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

using Point = Eigen::Vector2d;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

double turn_of(const Point& a, const Point& b, const Point& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Projects along the (Newell) normal, counterclockwise.
std::vector<Point> flattened(std::span<const std::array<float, 3>> corners) {
  const auto at = [&](std::size_t i) -> Eigen::Vector3d {
    const auto& p = corners[i % corners.size()];
    return {p[0], p[1], p[2]};
  };
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += (at(i) - at(0)).cross(at(i + 1) - at(0));
  Eigen::Index drop = 2;
  normal.cwiseAbs().maxCoeff(&drop);
  const Eigen::Index u = (drop + 1) % 3, v = (drop + 2) % 3;
  std::vector<Point> points;
  for (std::size_t i = 0; i < corners.size(); ++i)
    points.emplace_back(normal[drop] < 0.0 ? Point(at(i)[v], at(i)[u]) : Point(at(i)[u], at(i)[v]));
  return points;
}

class Ring {
 public:
  explicit Ring(std::vector<Point> points) : points_(std::move(points)), left_(points_.size()) {
    for (std::uint32_t i = 0; i < left_; ++i) {
      next_.push_back((i + 1) % static_cast<std::uint32_t>(left_));
      last_.push_back((i + static_cast<std::uint32_t>(left_) - 1) %
                      static_cast<std::uint32_t>(left_));
    }
    for (std::uint32_t i = 0; i < left_; ++i)
      if (turn_at(i) < 0.0) standing_back_.push_back(i);
  }

  void cut(Triangles& triangles) {
    std::uint32_t at = 1;
    for (std::size_t misses = 0; left_ > 3 && misses <= left_ && tests_left_ > 0;) {
      if (!is_ear(at)) {
        ++misses;
        at = next_[at];
        continue;
      }
      triangles.push_back({last_[at], at, next_[at]});
      next_[last_[at]] = next_[at];
      last_[next_[at]] = last_[at];
      at = next_[at];
      --left_;
      misses = 0;
    }
    const std::uint32_t first = last_[at];
    for (; left_ > 2; --left_, at = next_[at]) triangles.push_back({first, at, next_[at]});
  }

 private:
  double turn_at(std::uint32_t i) const {
    return turn_of(points_[last_[i]], points_[i], points_[next_[i]]);
  }

  bool is_ear(std::uint32_t i) {
    const double area = turn_at(i);
    if (area < 0.0) return false;
    const Point &a = points_[last_[i]], &b = points_[i], &c = points_[next_[i]];
    for (const std::uint32_t other : standing_back_) {
      --tests_left_;
      const Point& p = points_[other];
      const bool is_corner = p == a || p == b || p == c;
      if (!is_corner && area > 0.0 && turn_of(a, b, p) >= 0.0 && turn_of(b, c, p) >= 0.0 &&
          turn_of(c, a, p) >= 0.0)
        return false;
    }
    return true;
  }

  std::vector<Point> points_;
  std::vector<std::uint32_t> next_, last_;
  std::vector<std::uint32_t> standing_back_;  // concave corners of the original polygon
  std::size_t left_;
  std::int64_t tests_left_ = 4096 * static_cast<std::int64_t>(left_);
};

}  // namespace

void cut_into_triangles(std::span<const std::array<float, 3>> corners, Triangles& triangles) {
  if (corners.size() == 3)
    triangles.push_back({0, 1, 2});
  else
    Ring(flattened(corners)).cut(triangles);
}

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
