// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/shared/periodic.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

namespace {

constexpr double first_radius_px = 3.0, radius_step = 1.5;
constexpr int guard_px = 2;  // excludes the blurred edge of the target
constexpr int target_rounds = 3;

/// Means over frames, (H W, K); NaN if any value is NaN.
Eigen::MatrixXd mean_of(const RawFrames& raw) {
  const auto pixels = static_cast<Eigen::Index>(raw.pixels_per_frame());
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(pixels, raw.measurements);
  for (int f = 0; f < raw.frames; ++f) {
    const float* number = raw.frame(f);
    for (Eigen::Index p = 0; p < pixels; ++p)
      for (int k = 0; k < raw.measurements; ++k)
        mean(p, k) += static_cast<double>(*number++) / raw.frames;
  }
  return mean;
}

/// Light scattered to a distance for a unit share at a node. r^2 times the kernel is piecewise
/// linear in log r between nodes; below the first node the kernel is constant.
double basis(const std::vector<double>& nodes, std::size_t node, double radius_px) {
  if (radius_px < 0.5) return 0.0;
  const double r = std::max(radius_px, nodes.front());
  if (r > nodes.back()) return 0.0;
  const double at = std::log(r / nodes.front()) / std::log(radius_step);
  const double distance = std::abs(at - static_cast<double>(node));
  return distance >= 1.0 ? 0.0 : (1.0 - distance) * std::pow(nodes[node] / r, 2);
}

Image<float> kernel_of(const std::vector<double>& nodes, const std::vector<double>& shares,
                       int reach_px) {
  Image<float> kernel(2 * reach_px + 1, 2 * reach_px + 1);
  for (int v = -reach_px; v <= reach_px; ++v)
    for (int u = -reach_px; u <= reach_px; ++u) {
      double value = 0.0;
      for (std::size_t j = 0; j < nodes.size(); ++j)
        value += shares[j] * basis(nodes, j, std::hypot(v, u));
      kernel(v + reach_px, u + reach_px) = static_cast<float>(std::max(0.0, value));
    }
  return kernel;
}

struct Scene {
  int height = 0, width = 0;
  std::vector<double> light;  // relative to the target's mean
  std::vector<std::size_t> target;
  std::vector<std::size_t> around;  // at a sufficient distance
};

std::vector<double> along(const Eigen::MatrixXd& numbers, const Eigen::VectorXd& direction) {
  const Eigen::VectorXd light = numbers * direction / direction.squaredNorm();
  return {light.begin(), light.end()};
}

Scene scene_of(const Eigen::MatrixXd& numbers, const Eigen::MatrixXd& seen, double clipped,
               int height, int width) {
  Scene scene{.height = height, .width = width};
  Eigen::Index brightest = -1;
  double most = 0.0;
  for (Eigen::Index p = 0; p < numbers.rows(); ++p)
    if (const double norm = numbers.row(p).norm(); std::isfinite(norm) && norm > most)
      most = norm, brightest = p;
  require(brightest >= 0, "frames", "dark", "must show a bright target on a black background");
  const std::vector<double> first = along(numbers, numbers.row(brightest));
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(numbers.cols());
  for (std::size_t p = 0; p < first.size(); ++p)
    if (first[p] >= 0.5) {
      scene.target.push_back(p);
      mean += numbers.row(static_cast<Eigen::Index>(p)).transpose();
      require(seen.row(static_cast<Eigen::Index>(p)).maxCoeff() < clipped, "target",
              fmt::format("pixel ({}, {}) saturated", p / static_cast<std::size_t>(width),
                          p % static_cast<std::size_t>(width)),
              "must not be saturated; reduce the exposure and average more frames");
    }
  const double share = static_cast<double>(scene.target.size()) / static_cast<double>(first.size());
  require(scene.target.size() >= 4, "target", fmt::format("{} pixels", scene.target.size()),
          "must be at least 4 pixels");
  require(share <= 0.25, "target", fmt::format("{:.0f} % of the image", 100.0 * share),
          "must be at most a quarter of the image: a small bright target on a black background");
  scene.light = along(numbers, mean / static_cast<double>(scene.target.size()));

  Image<std::uint8_t> near(height, width);
  for (const std::size_t p : scene.target) {
    const int row = static_cast<int>(p) / width, column = static_cast<int>(p) % width;
    for (int v = std::max(0, row - guard_px); v <= std::min(height - 1, row + guard_px); ++v)
      for (int u = std::max(0, column - guard_px); u <= std::min(width - 1, column + guard_px); ++u)
        near(v, u) = 1;
  }
  for (std::size_t p = 0; p < scene.light.size(); ++p)
    if (near.pixels[p] == 0 && std::isfinite(scene.light[p])) scene.around.push_back(p);
  require(scene.around.size() >= 100, "pixels around the target", scene.around.size(),
          "must be at least 100");
  return scene;
}

/// Distances up to the farthest surrounding pixel from the target's centre.
std::vector<double> nodes_of(const Scene& scene) {
  const auto place_of = [&](std::size_t pixel) {
    const int row = static_cast<int>(pixel) / scene.width;
    return Eigen::Vector2d(row, static_cast<int>(pixel) % scene.width);
  };
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const std::size_t p : scene.target)
    middle += place_of(p) / static_cast<double>(scene.target.size());
  double farthest = 0.0;
  for (const std::size_t p : scene.around)
    farthest = std::max(farthest, (place_of(p) - middle).norm());
  std::vector<double> nodes;
  for (double r = first_radius_px; nodes.empty() || nodes.back() < farthest; r *= radius_step)
    nodes.push_back(r);
  require(nodes.size() >= 2, "image", fmt::format("{} x {}", scene.height, scene.width),
          "must extend farther around the target");
  return nodes;
}

/// Stray light around the target for a unit share of each node (pixels, nodes).
Eigen::MatrixXd made_by_nodes(const Scene& scene, const std::vector<double>& nodes,
                              const Image<float>& target, int reach_px) {
  Eigen::MatrixXd made(static_cast<Eigen::Index>(scene.around.size()),
                       static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    std::vector<double> alone(nodes.size(), 0.0);
    alone[j] = 1.0;
    const Image<float> stray =
        PaddedConvolution(kernel_of(nodes, alone, reach_px), scene.height, scene.width)
            .apply(target);
    for (std::size_t i = 0; i < scene.around.size(); ++i)
      made(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          static_cast<double>(stray.pixels[scene.around[i]]);
  }
  return made;
}

double limit_of(const Camera& camera) {
  if (camera.sensor.subtracts()) return INFINITY;
  return static_cast<double>(saturation_level_of(camera.sensor).value_or(INFINITY));
}

}  // namespace

CalibratedStrayLight calibrate_stray_light(const RawFrames& frames, const RawFrames& dark,
                                           const Camera& camera, const Progress& progress) {
  camera.validate();
  require(frames.frames >= 1, "frames", frames.frames, "must be at least 1");
  require(dark.frames == 0 || (dark.height == frames.height && dark.width == frames.width &&
                               dark.measurements == frames.measurements),
          "dark size", fmt::format("({}, {}, {})", dark.height, dark.width, dark.measurements),
          fmt::format("must be ({}, {}, {}), like the frames", frames.height, frames.width,
                      frames.measurements));
  const Eigen::MatrixXd seen = mean_of(frames);
  Eigen::MatrixXd numbers = seen;
  if (dark.frames > 0)
    numbers -= mean_of(dark);
  else if (camera.sensor.readout == Readout::separate)
    numbers.array() -= camera.sensor.black_level_dn.value_or(0.0);
  const Scene scene = scene_of(numbers, seen, limit_of(camera), frames.height, frames.width);
  const std::vector<double> nodes = nodes_of(scene);
  const int reach_px = std::min(static_cast<int>(std::ceil(nodes.back())),
                                std::max(frames.height, frames.width) - 1);

  CalibratedStrayLight result;
  result.radius_px = nodes;
  result.target_pixels = static_cast<std::int64_t>(scene.target.size());
  result.pixels = static_cast<std::int64_t>(scene.around.size());
  Eigen::VectorXd observed(result.pixels);
  for (std::size_t i = 0; i < scene.around.size(); ++i)
    observed[static_cast<Eigen::Index>(i)] = scene.light[scene.around[i]];

  // The light of the target depends slightly on the kernel.
  Image<float> target(scene.height, scene.width);
  for (const std::size_t p : scene.target) target.pixels[p] = static_cast<float>(scene.light[p]);
  Eigen::VectorXd shares;
  Eigen::MatrixXd covariance;
  const ProgressParts parts(progress, target_rounds);
  for (int round = 0; round < target_rounds; ++round) {
    const Eigen::MatrixXd made = made_by_nodes(scene, nodes, target, reach_px);
    const Eigen::LLT<Eigen::MatrixXd> normal(made.transpose() * made);
    require(normal.info() == Eigen::Success, "pixels around the target", result.pixels,
            "cannot separate the distances");
    shares = normal.solve(made.transpose() * observed);
    // Noise differs between pixels: residuals corrected for leverage (HC3 of MacKinnon and White
    // 1985).
    const Eigen::ArrayXd followed =
        (made * normal.solve(Eigen::MatrixXd::Identity(made.cols(), made.cols())))
            .cwiseProduct(made)
            .rowwise()
            .sum();
    const Eigen::ArrayXd left = (observed - made * shares).array() / (1.0 - followed).max(0.1);
    const Eigen::MatrixXd scored = made.array().colwise() * left;
    covariance = normal.solve(normal.solve(scored.transpose() * scored).transpose());
    result.kernel = kernel_of(nodes, {shares.begin(), shares.end()}, reach_px);
    double sum = 0.0;
    for (const float value : result.kernel.pixels) sum += static_cast<double>(value);
    require(sum < 0.5, "light scattered", sum,
            "must be < 0.5 of all light: the surroundings of the target are not black");
    const Image<float> stray =
        PaddedConvolution(result.kernel, scene.height, scene.width).apply(target);
    for (const std::size_t p : scene.target)
      target.pixels[p] =
          static_cast<float>((scene.light[p] - static_cast<double>(stray.pixels[p])) / (1.0 - sum));
    report(parts[static_cast<std::size_t>(round)], 1.0, "fitting");
  }

  Eigen::VectorXd weights = Eigen::VectorXd::Zero(shares.size());
  for (int v = -reach_px; v <= reach_px; ++v)
    for (int u = -reach_px; u <= reach_px; ++u)
      for (std::size_t j = 0; j < nodes.size(); ++j)
        weights[static_cast<Eigen::Index>(j)] += basis(nodes, j, std::hypot(v, u));
  result.total = {weights.dot(shares), std::sqrt(weights.dot(covariance * weights))};
  for (Eigen::Index j = 0; j < shares.size(); ++j)
    result.share.push_back({shares[j], std::sqrt(covariance(j, j))});
  int negative = 0;
  for (const Estimate& share : result.share)
    if (share.value < -3.0 * share.standard_error) ++negative;
  if (negative > 0)
    result.notes.push_back(fmt::format(
        "{} of {} distances have significantly negative light; check the dark frames (--dark)",
        negative, nodes.size()));
  if (result.total.value < 3.0 * result.total.standard_error)
    result.notes.emplace_back("the stray light is not significant");
  return result;
}

}  // namespace tofsmith
