// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/surface_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/shared/decompositions.hpp"
#include "core/shared/random.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

namespace {

using Points = std::vector<Eigen::Vector3d>;
constexpr double degenerate = 1e-9;  // relative extent below which points span one direction less

Eigen::Vector3d centroid(const Points& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

double distance_to(const Plane& plane, const Eigen::Vector3d& point) {
  return std::abs(plane.normal.dot(point - plane.point));
}
double distance_to(const Sphere& sphere, const Eigen::Vector3d& point) {
  return std::abs((point - sphere.centre).norm() - sphere.radius_m);
}

/// Total least squares; none if the points lie on a line.
std::optional<Plane> plane_through(const Points& points) {
  const Eigen::Vector3d centre = centroid(points);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) scatter += (p - centre) * (p - centre).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  const Eigen::Vector3d extent = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();  // increasing
  if (!(extent[1] > degenerate * extent[2])) return std::nullopt;
  return Plane{.point = centre, .normal = solver.eigenvectors().col(0), .texture = {}};
}

/// Gauss-Newton on the orthogonal distances.
Sphere refined(Sphere sphere, const Points& points) {
  const auto count = static_cast<Eigen::Index>(points.size());
  constexpr int max_steps = 30;
  for (int step = 0; step < max_steps; ++step) {
    Eigen::MatrixXd jacobian(count, 4);
    Eigen::VectorXd residual(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector3d arm = points[static_cast<std::size_t>(i)] - sphere.centre;
      const double length = arm.norm();
      if (length == 0.0) return sphere;
      jacobian.row(i) << -arm.transpose() / length, -1.0;
      residual[i] = length - sphere.radius_m;
    }
    const Eigen::Vector4d change = least_squares(jacobian, -residual);
    if (!change.allFinite() || sphere.radius_m + change[3] <= 0.0) return sphere;
    sphere.centre += change.head<3>();
    sphere.radius_m += change[3];
    if (change.norm() < 1e-13 * (1.0 + sphere.radius_m)) break;
  }
  return sphere;
}

/// |p|^2 = 2 c p + k about the centroid, linear in centre c and k = r^2 - |c|^2; none if the points
/// lie in a plane.
std::optional<Sphere> algebraic_sphere(const Points& points) {
  const Eigen::Vector3d middle = centroid(points);
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd system(count, 4);
  Eigen::VectorXd squares(count);
  double extent = 0.0;
  for (const Eigen::Vector3d& p : points) extent = std::max(extent, (p - middle).norm());
  if (extent == 0.0) return std::nullopt;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d p = (points[static_cast<std::size_t>(i)] - middle) / extent;
    system.row(i) << 2.0 * p.transpose(), 1.0;
    squares[i] = p.squaredNorm();
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(system);
  qr.setThreshold(degenerate);
  if (qr.rank() < 4) return std::nullopt;
  const Eigen::Vector4d solution = qr.solve(squares);
  const double radius_squared = solution[3] + solution.head<3>().squaredNorm();
  if (!(radius_squared > 0.0)) return std::nullopt;
  return Sphere{.centre = middle + extent * solution.head<3>(),
                .radius_m = extent * std::sqrt(radius_squared),
                .texture = {}};
}

std::optional<Sphere> sphere_through(const Points& points) {
  const std::optional<Sphere> start = algebraic_sphere(points);
  if (!start) return std::nullopt;
  return refined(*start, points);
}

template <typename Surface>
std::vector<double> distances_to(const Surface& surface, const Points& points) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const Eigen::Vector3d& p : points) distances.push_back(distance_to(surface, p));
  return distances;
}

/// Of surfaces through a few random points each, the one with the least median distance.
template <typename Surface, typename Through>
std::optional<Surface> first_guess(const Points& points, std::size_t minimal, Through&& through,
                                   const SurfaceFitOptions& options) {
  std::optional<Surface> best;
  double min_median = std::numeric_limits<double>::infinity();
  for (int i = 0; i < options.samplings; ++i) {
    RandomStream random(options.seed, static_cast<std::uint64_t>(i));
    Points sample;
    for (std::size_t j = 0; j < minimal; ++j)
      sample.push_back(
          points[static_cast<std::size_t>(random.uniform() * static_cast<double>(points.size()))]);
    const std::optional<Surface> surface = through(sample);
    if (!surface) continue;
    const double median = median_of(distances_to(*surface, points));
    if (median < min_median) {
      min_median = median;
      best = surface;
    }
  }
  return best;
}

template <typename Surface, typename Through>
SurfaceFit<Surface> fit(const Points& given, std::size_t minimal, Through&& through,
                        const SurfaceFitOptions& options, std::string_view degenerate_rule) {
  options.validate();
  Points points;
  for (const Eigen::Vector3d& p : given)
    if (p.allFinite()) points.push_back(p);
  require(points.size() >= minimal, "number of finite points", points.size(),
          "must be >= " + std::to_string(minimal));
  std::optional<Surface> surface = first_guess<Surface>(points, minimal, through, options);
  if (!surface) surface = through(points);
  require(surface.has_value(), "points", points.size(), degenerate_rule);

  Points kept;
  constexpr int max_rounds = 50;  // it takes 3 to 10
  for (int round = 0; round < max_rounds; ++round) {
    const std::vector<double> distances = distances_to(*surface, points);
    double extent = 0.0;
    for (const Eigen::Vector3d& p : points) extent = std::max(extent, p.norm());
    // Points on the surface but for rounding all stay.
    const double limit =
        std::isinf(options.trim_sigma)
            ? options.trim_sigma
            : std::max(options.trim_sigma * 1.4826 * median_of(distances), 1e-12 * extent);
    Points near;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (distances[i] <= limit) near.push_back(points[i]);
    require(near.size() >= minimal, "trim_sigma", options.trim_sigma,
            "must be larger: it leaves out nearly every point");
    if (near == kept) break;
    kept = std::move(near);
    const std::optional<Surface> next = through(kept);
    require(next.has_value(), "points", kept.size(), degenerate_rule);
    surface = next;
  }
  double squares = 0.0;
  for (const double d : distances_to(*surface, kept)) squares += d * d;
  return {*surface, static_cast<int>(kept.size()),
          std::sqrt(squares / static_cast<double>(kept.size()))};
}

template <typename Surface>
std::vector<double> residuals(const Surface& surface, const Points& points) {
  std::vector<double> result;
  result.reserve(points.size());
  for (const Eigen::Vector3d& p : points) {
    result.push_back(std::numeric_limits<double>::quiet_NaN());
    const double distance_m = p.norm();
    if (!(distance_m > 0.0) || !std::isfinite(distance_m)) continue;
    if (const auto hit = intersect(surface, {Eigen::Vector3d::Zero(), p / distance_m}))
      result.back() = distance_m - hit->distance_m;
  }
  return result;
}

}  // namespace

void SurfaceFitOptions::validate() const {
  require(trim_sigma > 0.0, "trim_sigma", trim_sigma, "must be > 0");
  require(samplings >= 1, "samplings", samplings, "must be >= 1");
}

SurfaceFit<Plane> fit_plane(const Points& points, const SurfaceFitOptions& options) {
  return fit<Plane>(points, 3, plane_through, options,
                    "must not all lie on a line: many planes hold it");
}

SurfaceFit<Sphere> fit_sphere(const Points& points, const SurfaceFitOptions& options) {
  return fit<Sphere>(points, 4, sphere_through, options,
                     "must not all lie in a plane: many spheres hold a circle");
}

std::vector<double> residuals_along_rays(const Plane& plane, const Points& points) {
  return residuals(plane, points);
}
std::vector<double> residuals_along_rays(const Sphere& sphere, const Points& points) {
  return residuals(sphere, points);
}

}  // namespace tofsmith
