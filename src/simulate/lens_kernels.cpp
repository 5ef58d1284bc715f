// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/lens_kernels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr double smallest_radius_px = 0.01, largest_radius_px = 64.0;
constexpr double step = 0.02;

double distribution_integral(double x, double sigma) {
  const double u = x / sigma;
  const double density = std::exp(-0.5 * u * u) / std::sqrt(2.0 * std::numbers::pi);
  return x * 0.5 * std::erfc(-u / std::numbers::sqrt2) + sigma * density;
}

void scale_to_sum_1(std::vector<double>& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
}

/// Part of the disc with x <= a and y <= b.
double area_below(double radius, double a, double b) {
  a = std::clamp(a, -radius, radius);
  b = std::clamp(b, -radius, radius);
  const double square = radius * radius, whole = std::numbers::pi * square;
  const auto chord = [&](double at) { return std::sqrt(std::max(square - at * at, 0.0)); };
  const auto left_of = [&](double at) {
    return whole - square * std::acos(at / radius) + at * chord(at);
  };
  if (a * a + b * b >= square) {
    if (a < 0.0 && b < 0.0) return 0.0;
    if (a < 0.0) return left_of(a);
    if (b < 0.0) return left_of(b);
    return left_of(a) + left_of(b) - whole;
  }
  // From the corner to (-chord(b), b), along the circle to (a, -chord(a)), and back.
  const double qx = -chord(b), py = -chord(a);
  double angle = std::atan2(py, a) - std::atan2(b, qx);
  if (angle < 0.0) angle += 2.0 * std::numbers::pi;
  return 0.5 * (a * b - b * qx + square * angle + a * b - py * a);
}

DiscKernel disc_kernel(double radius_px, double row_px, double column_px) {
  DiscKernel kernel;
  kernel.reach = static_cast<int>(std::ceil(radius_px));
  for (int row = -kernel.reach; row <= kernel.reach; ++row)
    for (int column = -kernel.reach; column <= kernel.reach; ++column) {
      const double y = row - row_px, x = column - column_px;
      kernel.weights.push_back(
          std::max(0.0, disc_area(radius_px, x - 0.5, x + 0.5, y - 0.5, y + 0.5)));
    }
  scale_to_sum_1(kernel.weights);
  kernel.largest = *std::max_element(kernel.weights.begin(), kernel.weights.end());
  return kernel;
}

}  // namespace

AxisKernel::AxisKernel(double sigma_px, int samples) {
  if (sigma_px > 0.0) reach = static_cast<int>(std::ceil(5.0 * sigma_px * samples));
  for (int ray = -reach; ray < samples + reach; ++ray) {
    if (!(sigma_px > 0.0)) {
      weights.push_back(1.0);
      continue;
    }
    const double from = -0.5 + static_cast<double>(ray) / samples, to = from + 1.0 / samples;
    const auto integral = [&](double x) { return distribution_integral(x, sigma_px); };
    weights.push_back(std::max(0.0, integral(0.5 - from) - integral(0.5 - to) -
                                        integral(-0.5 - from) + integral(-0.5 - to)));
  }
  scale_to_sum_1(weights);
}

double disc_area(double radius, double x0, double x1, double y0, double y1) {
  return area_below(radius, x1, y1) - area_below(radius, x0, y1) - area_below(radius, x1, y0) +
         area_below(radius, x0, y0);
}

DiscKernels::DiscKernels(const LensBlur& blur, int samples, std::span<const float> distances_m)
    : blur_(blur), samples_(samples), point_{0, {1.0}, 1.0} {
  std::set<int> used;
  for (const float distance_m : distances_m) {
    const double radius_px = blur.disc_radius_px(distance_m);
    require(
        radius_px <= largest_radius_px, "lens.f_number", blur.f_number,
        fmt::format("at {:.4g} m, the disc of confusion is {:.4g} pixels wide; must be <= {:.4g}",
                    distance_m, 2.0 * radius_px, 2.0 * largest_radius_px));
    used.insert(step_of(distance_m));
  }
  used.erase(sharp);
  if (used.empty()) return;
  first_step_ = *used.begin();
  steps_.resize(static_cast<std::size_t>(std::ptrdiff_t{*used.rbegin()} - first_step_ + 1));
  const std::vector<int> all(used.begin(), used.end());
  parallel_for(static_cast<std::int64_t>(all.size()), [&](std::int64_t i) {
    const int its = all[static_cast<std::size_t>(i)];
    const double radius_px = smallest_radius_px * std::exp(step * its);
    for (int row = 0; row < samples; ++row)
      for (int column = 0; column < samples; ++column)
        steps_[static_cast<std::size_t>(its - first_step_)].push_back(
            disc_kernel(radius_px, (row + 0.5) / samples - 0.5, (column + 0.5) / samples - 0.5));
  });
  // Relative to its own pixel's centre, a disc extends at most half a pixel beyond its radius.
  for (const auto& kernels : steps_)
    if (!kernels.empty()) reach_ = std::max(reach_, kernels.front().reach);
}

int DiscKernels::step_of(float distance_m) const {
  const double radius_px = blur_.disc_radius_px(distance_m);
  if (!(radius_px > smallest_radius_px)) return sharp;
  return static_cast<int>(std::lround(std::log(radius_px / smallest_radius_px) / step));
}

const DiscKernel& DiscKernels::of(float distance_m, int row, int column) const {
  const int its = step_of(distance_m);
  if (its == sharp) return point_;
  return steps_[static_cast<std::size_t>(its - first_step_)]
               [static_cast<std::size_t>(std::ptrdiff_t{row} * samples_ + column)];
}

}  // namespace tofsmith
