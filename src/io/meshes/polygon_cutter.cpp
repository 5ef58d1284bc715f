// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/meshes/polygon_cutter.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

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

}  // namespace tofsmith
