// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/lens_light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/stray_light.hpp"

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
  parallel_for_indices(all.size(), [&](std::size_t at) {
    const int its = all[at];
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

namespace {

/// Smallest relative weight of a ray that a pixel sees.
constexpr double seen_share = 0.02;

/// Continues indices by reflection.
int mirrored(int i, int size) {
  const int period = 2 * size;
  const int place = ((i % period) + period) % period;
  return place < size ? place : period - 1 - place;
}

int floor_division(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/// Channels are the tap values of the range, and ambient light if it varies.
class Band {
 public:
  Band(const RowCapture& rays, int samples, TapRange range, int first_row, int rows)
      : rays_(rays),
        samples_(samples),
        range_(range),
        has_ambient_(range.first == 0 && !rays.scene().ambient_scale.empty()),
        first_row_(first_row),
        rows_(rows),
        width_(rays.scene().width() / samples),
        channels_(range.count + (has_ambient_ ? 1 : 0)),
        sums_(values(rows * width_), 0.0),
        near_m_(rows, width_, std::numeric_limits<float>::infinity()),
        far_m_(rows, width_, 0.0f),
        line_(values(rays.scene().width())),
        work_(static_cast<std::size_t>(rays.tap_values())),
        light_(work_.size()) {}

  void read_rays(int row) {
    if (row == row_read_) return;
    row_read_ = row;
    double* out = line_.data();
    for (int column = 0; column < rays_.scene().width(); ++column, out += channels_) {
      rays_.light_at(row, column, work_, light_);
      std::copy_n(light_.begin() + range_.first, range_.count, out);
      if (has_ambient_) out[range_.count] = rays_.ambient_e_per_s(row, column);
    }
  }

  /// Uses one kernel for both axes; `row` may be outside the image.
  void add_row(int row, const AxisKernel& kernel) {
    const int ray_row = mirrored(row, rays_.scene().height());
    read_rays(ray_row);
    gather_row(ray_row, kernel);
    const int rays_of_kernel = static_cast<int>(kernel.weights.size());
    for (int r = 0; r < rows_; ++r) {
      const int place = row - (first_row_ + r) * samples_ + kernel.reach;
      if (place < 0 || place >= rays_of_kernel) continue;
      const double weight = kernel.weights[static_cast<std::size_t>(place)];
      double* out = sums_.data() + values(r * width_);
      for (std::size_t i = 0; i < gathered_.size(); ++i) out[i] += weight * gathered_[i];
      if (is_seen(kernel, place))
        for (int column = 0; column < width_; ++column)
          see(r, column, gathered_near_m_[static_cast<std::size_t>(column)],
              gathered_far_m_[static_cast<std::size_t>(column)]);
    }
  }

  void add_row(int row, const DiscKernels& kernels) {
    const int ray_row = mirrored(row, rays_.scene().height());
    read_rays(ray_row);
    const double share = 1.0 / (samples_ * samples_);
    const int pixel_row = floor_division(row, samples_);
    const int beyond = (kernels.reach() + 1) * samples_;
    for (int column = -beyond; column < rays_.scene().width() + beyond; ++column) {
      const int ray_column = mirrored(column, rays_.scene().width());
      const float depth_m = rays_.scene().depth_m(ray_row, ray_column);
      const int pixel_column = floor_division(column, samples_);
      const DiscKernel& kernel =
          kernels.of(depth_m, row - pixel_row * samples_, column - pixel_column * samples_);
      const double* light = line_.data() + values(ray_column);
      const double least = seen_share * kernel.largest;
      const int top = std::max(pixel_row - kernel.reach, first_row_);
      const int bottom = std::min(pixel_row + kernel.reach, first_row_ + rows_ - 1);
      const int left = std::max(pixel_column - kernel.reach, 0);
      const int right = std::min(pixel_column + kernel.reach, width_ - 1);
      for (int r = top; r <= bottom; ++r)
        for (int c = left; c <= right; ++c) {
          const double part = kernel.at(r - pixel_row, c - pixel_column);
          double* out = sums_.data() + values((r - first_row_) * width_ + c);
          for (int i = 0; i < channels_; ++i) out[i] += share * part * light[i];
          if (part >= least) see(r - first_row_, c, depth_m, depth_m);
        }
    }
  }

  void write_to(CollectedLight& light) const {
    for (int r = 0; r < rows_; ++r)
      for (int c = 0; c < width_; ++c) {
        const auto pixel =
            static_cast<std::size_t>(first_row_ + r) * static_cast<std::size_t>(width_) +
            static_cast<std::size_t>(c);
        const double* sum = sums_.data() + values(r * width_ + c);
        std::copy_n(
            sum, range_.count,
            light.taps.data() + pixel * static_cast<std::size_t>(light.tap_values) + range_.first);
        if (has_ambient_) light.ambient[pixel] = sum[range_.count];
        if (std::isinf(near_m_(r, c))) continue;
        light.near_m.pixels[pixel] = std::fmin(light.near_m.pixels[pixel], near_m_(r, c));
        light.far_m.pixels[pixel] = std::fmax(light.far_m.pixels[pixel], far_m_(r, c));
      }
  }

 private:
  std::size_t values(int places) const {
    return static_cast<std::size_t>(places) * static_cast<std::size_t>(channels_);
  }

  bool is_seen(const AxisKernel& kernel, int place) const {
    const double heaviest = kernel.weights[kernel.weights.size() / 2];
    return kernel.weights[static_cast<std::size_t>(place)] >= seen_share * heaviest;
  }

  void see(int row, int column, float near_m, float far_m) {
    if (near_m < near_m_(row, column)) near_m_(row, column) = near_m;  // false for NaN
    if (far_m > far_m_(row, column)) far_m_(row, column) = far_m;
  }

  void gather_row(int ray_row, const AxisKernel& kernel) {
    gathered_.assign(values(width_), 0.0);
    gathered_near_m_.assign(static_cast<std::size_t>(width_),
                            std::numeric_limits<float>::infinity());
    gathered_far_m_.assign(static_cast<std::size_t>(width_), 0.0f);
    const int rays_of_kernel = static_cast<int>(kernel.weights.size());
    for (int column = 0; column < width_; ++column) {
      double* out = gathered_.data() + values(column);
      for (int place = 0; place < rays_of_kernel; ++place) {
        const int ray = mirrored(column * samples_ - kernel.reach + place, rays_.scene().width());
        const double weight = kernel.weights[static_cast<std::size_t>(place)];
        const double* light = line_.data() + values(ray);
        for (int i = 0; i < channels_; ++i) out[i] += weight * light[i];
        if (!is_seen(kernel, place)) continue;
        const float depth_m = rays_.scene().depth_m(ray_row, ray);
        auto& near_m = gathered_near_m_[static_cast<std::size_t>(column)];
        auto& far_m = gathered_far_m_[static_cast<std::size_t>(column)];
        if (depth_m < near_m) near_m = depth_m;
        if (depth_m > far_m) far_m = depth_m;
      }
    }
  }

  const RowCapture& rays_;
  int samples_;
  TapRange range_;
  bool has_ambient_;
  int first_row_, rows_, width_, channels_;
  std::vector<double> sums_;  // (rows, W, channels)
  Image<float> near_m_, far_m_;
  std::vector<double> line_;  // (rays of a row, channels)
  int row_read_ = -1;
  std::vector<double> gathered_;  // (W, channels)
  std::vector<float> gathered_near_m_, gathered_far_m_;
  std::vector<double> work_, light_;
};

/// Each band needs `reach_rays` rows of rays above and below.
template <typename Kernel>
void add_by(const Kernel& kernel, int reach_rays, const RowCapture& rays, int samples,
            TapRange range, CollectedLight& light) {
  // Bands are taller for large kernels, because they read rows near their border twice.
  const int rows_of_band = std::max(8, 2 * reach_rays / samples);
  parallel_for_blocks(light.height, rows_of_band, [&](IndexRange rows) {
    const int first = static_cast<int>(rows.begin), end = static_cast<int>(rows.end);
    Band band(rays, samples, range, first, end - first);
    for (int row = first * samples - reach_rays; row < end * samples + reach_rays; ++row)
      band.add_row(row, kernel);
    band.write_to(light);
  });
}

}  // namespace

CollectedLight::CollectedLight(int height_, int width_, int tap_values_)
    : height(height_),
      width(width_),
      tap_values(tap_values_),
      taps(static_cast<std::size_t>(height_) * static_cast<std::size_t>(width_) *
           static_cast<std::size_t>(tap_values_)),
      near_m(height_, width_, std::numeric_limits<float>::quiet_NaN()),
      far_m(near_m) {}

void add_light(const RowCapture& rays, const LensBlur& blur, int samples, TapRange range,
               CollectedLight& light) {
  const SceneImage& scene = rays.scene();
  require(scene.height() == light.height * samples && scene.width() == light.width * samples,
          "size of the image of rays", fmt::format("{} x {}", scene.height(), scene.width()),
          fmt::format("must be {0} x {1}, {2} x {2} for each pixel", light.height * samples,
                      light.width * samples, samples));
  if (range.first == 0 && !scene.ambient_scale.empty())
    light.ambient.assign(light.near_m.size(), 0.0);
  if (blur.kind == LensBlur::Kind::disc) {
    const DiscKernels kernels(blur, samples, scene.depth_m.pixels);
    return add_by(kernels, (kernels.reach() + 1) * samples, rays, samples, range, light);
  }
  const AxisKernel kernel(blur.kind == LensBlur::Kind::gaussian ? blur.blur_sigma_px : 0.0,
                          samples);
  add_by(kernel, kernel.reach, rays, samples, range, light);
}

void scatter_light(const Image<float>& kernel, double ambient_e_per_s, CollectedLight& light) {
  if (kernel.empty()) return;
  if (light.ambient.empty()) light.ambient.assign(light.near_m.size(), ambient_e_per_s);
  StrayLight stray(kernel);
  Image<float> plane(light.height, light.width);
  const auto scatter = [&](double* values, std::size_t stride) {
    for (std::size_t i = 0; i < plane.size(); ++i)
      plane.pixels[i] = static_cast<float>(values[i * stride]);
    const Image<float> seen = stray.scatter(plane);
    for (std::size_t i = 0; i < plane.size(); ++i)
      values[i * stride] = std::max(0.0, static_cast<double>(seen.pixels[i]));
  };
  for (int t = 0; t < light.tap_values; ++t)
    scatter(light.taps.data() + t, static_cast<std::size_t>(light.tap_values));
  scatter(light.ambient.data(), 1);
}

}  // namespace tofsmith
