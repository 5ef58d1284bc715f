// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/shared/enum_words.hpp"
#include "decode/mixed/mixed_pixel_fit.hpp"
#include "decode/output/pixel_output.hpp"
#include "decode/raw_scale.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/decode/depth_image.hpp"

namespace tofsmith {

namespace {

constexpr EnumWords<MixedPixels, all_mixed_pixels.size()> mixed_words("MixedPixels", "mixed",
                                                                      "label", "snap", "drop");

constexpr int reach = 3;
constexpr int window_pixels = (2 * reach + 1) * (2 * reach + 1);
/// A pixel is of a surface if so many of the 8 around it have its depth: more than
/// in a ribbon of mixed pixels, or on an object one pixel wide.
constexpr int least_neighbours = 6;
constexpr int least_pixels = 2;
constexpr int most_surfaces = 4;
/// Depths are the same within so many standard deviations, and within this share of the range: less
/// is no edge.
constexpr double same_sigma = 2.0, same_share = 0.002;
/// Standard deviation of a surface's slope where its pixels do not tell, as a share of the range
/// for each pixel.
constexpr double slope_share = 0.0025;

struct WindowPixel {
  double depth_m = 0.0, variance_m2 = 0.0;
  int dx = 0, dy = 0;
  std::size_t index = 0;
  int distance() const { return dx * dx + dy * dy; }
};

/// A surface around a pixel.
struct Surface {
  SurfaceDepth here;
  std::size_t nearest = 0;  ///< its nearest pixel; of several the one that is farther to the front
  std::size_t pixels = 0;
};

/// What is known of a frame before any pixel of it is marked.
class Surroundings {
 public:
  Surroundings(const DecodedView& decoded, int height, int width, double range_m)
      : height_(height),
        width_(width),
        same_m_(same_share * range_m),
        slope_m_(slope_share * range_m),
        depth_(decoded.depth_m, decoded.depth_m + size()),
        deviation_(decoded.predicted_standard_deviation_m,
                   decoded.predicted_standard_deviation_m + size()),
        status_(decoded.status, decoded.status + size()),
        is_firm_(size(), 0) {
    parallel_for(height_, [&](std::int64_t row) {
      for (int x = 0; x < width_; ++x)
        is_firm_[at(static_cast<int>(row), x)] = has_neighbours(static_cast<int>(row), x);
    });
  }

  std::size_t size() const {
    return static_cast<std::size_t>(height_) * static_cast<std::size_t>(width_);
  }
  std::size_t at(int row, int x) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  float depth_m(std::size_t i) const { return depth_[i]; }
  float deviation_m(std::size_t i) const { return deviation_[i]; }
  /// Whether it may be mixed at all.
  bool is_decoded(std::size_t i) const {
    return std::isfinite(depth_[i]) &&
           (status_[i] == PixelStatus::ok || status_[i] == PixelStatus::low_signal ||
            status_[i] == PixelStatus::ambiguous);
  }

  /// The surfaces around a pixel, largest first; none if there are not two.
  void find_surfaces(int row, int x, std::vector<Surface>& surfaces) const {
    surfaces.clear();
    std::array<WindowPixel, window_pixels> pixels;
    const auto count = static_cast<std::size_t>(firm_pixels(row, x, pixels));
    const auto end = pixels.begin() + static_cast<std::ptrdiff_t>(count);
    if (count < 2 * least_pixels) return;
    const auto [low, high] = std::minmax_element(
        pixels.begin(), end, [](const auto& a, const auto& b) { return a.depth_m < b.depth_m; });
    if (!parts(*low, *high)) return;
    std::sort(pixels.begin(), end, [](const WindowPixel& a, const WindowPixel& b) {
      return a.depth_m != b.depth_m ? a.depth_m < b.depth_m : a.index < b.index;
    });
    for (auto first = pixels.begin(); first != end;) {
      auto last = first + 1;
      while (last != end && !parts(*(last - 1), *last)) ++last;
      if (last - first >= least_pixels) surfaces.push_back(surface_of(&*first, last - first));
      first = last;
    }
    std::stable_sort(surfaces.begin(), surfaces.end(),
                     [](const Surface& a, const Surface& b) { return a.pixels > b.pixels; });
    if (surfaces.size() > most_surfaces) surfaces.resize(most_surfaces);
  }

  /// Whether a pixel's depth is that of a surface.
  bool lies_on(std::size_t i, const Surface& surface) const {
    return std::abs(depth_[i] - surface.here.depth_m) <=
           std::max(same_m_, same_sigma * std::hypot(deviation_[i], surface.here.deviation_m));
  }

 private:
  bool is_usable(std::size_t i) const {
    return status_[i] == PixelStatus::ok && std::isfinite(depth_[i]) &&
           std::isfinite(deviation_[i]);
  }

  bool has_neighbours(int row, int x) const {
    const std::size_t i = at(row, x);
    if (!is_usable(i)) return false;
    int count = 0;
    for (int y = std::max(0, row - 1); y <= std::min(height_ - 1, row + 1); ++y)
      for (int c = std::max(0, x - 1); c <= std::min(width_ - 1, x + 1); ++c) {
        const std::size_t j = at(y, c);
        if (j == i || !is_usable(j)) continue;
        const double same =
            std::max(same_m_, same_sigma * std::hypot(deviation_[i], deviation_[j]));
        count += std::abs(depth_[i] - depth_[j]) <= same ? 1 : 0;
      }
    return count >= least_neighbours;
  }

  int firm_pixels(int row, int x, std::array<WindowPixel, window_pixels>& pixels) const {
    int count = 0;
    for (int y = std::max(0, row - reach); y <= std::min(height_ - 1, row + reach); ++y)
      for (int c = std::max(0, x - reach); c <= std::min(width_ - 1, x + reach); ++c) {
        const std::size_t j = at(y, c);
        if (!is_firm_[j] || (y == row && c == x)) continue;
        pixels[static_cast<std::size_t>(count++)] = {
            .depth_m = depth_[j],
            .variance_m2 = static_cast<double>(deviation_[j]) * deviation_[j],
            .dx = c - x,
            .dy = y - row,
            .index = j};
      }
    return count;
  }

  /// Whether nothing joins two depths, one after the other.
  bool parts(const WindowPixel& a, const WindowPixel& b) const {
    return b.depth_m - a.depth_m >
           std::max(2 * same_m_, same_sigma * std::sqrt(a.variance_m2 + b.variance_m2));
  }

  /// A plane through some pixels, where the window's own pixel is.
  Surface surface_of(const WindowPixel* pixels, std::ptrdiff_t count) const {
    const auto n = static_cast<double>(count);
    double mean = 0.0, variance = 0.0;
    const WindowPixel* nearest = pixels;
    for (const WindowPixel* p = pixels; p != pixels + count; ++p) {
      mean += p->depth_m / n, variance += p->variance_m2 / n;
      if (p->distance() < nearest->distance()) nearest = p;
    }
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const WindowPixel* p = pixels; p != pixels + count; ++p) {
      const Eigen::Vector3d place(1.0, p->dx, p->dy);
      normal += place * place.transpose();
      right += (p->depth_m - mean) * place;
    }
    const double stiff = std::max(variance, 1e-6 * same_m_ * same_m_) / (slope_m_ * slope_m_);
    normal(1, 1) += stiff, normal(2, 2) += stiff;
    const auto solver = normal.ldlt();
    const Eigen::Vector3d plane = solver.solve(right);
    double squares = 0.0;
    for (const WindowPixel* p = pixels; p != pixels + count; ++p) {
      const double off = p->depth_m - mean - plane.dot(Eigen::Vector3d(1.0, p->dx, p->dy));
      squares += off * off / n;
    }
    const double at_origin = solver.solve(Eigen::Vector3d::UnitX())[0];
    return {.here = {.depth_m = mean + plane[0],
                     .deviation_m = std::sqrt(std::max(variance, squares) * at_origin)},
            .nearest = nearest->index,
            .pixels = static_cast<std::size_t>(count)};
  }

  int height_, width_;
  double same_m_, slope_m_;
  std::vector<float> depth_, deviation_;
  std::vector<PixelStatus> status_;
  std::vector<std::uint8_t> is_firm_;
};

/// One pixel's electrons without dark ones; false if a number is not finite.
bool read_electrons(const RawView& raw, const RawScale& scale, int row, int x,
                    std::array<double, max_measurements>& electrons) {
  return std::visit(
      [&](const auto* data) {
        const auto* number = data + row * raw.row_stride + x * raw.column_stride;
        bool is_finite = true;
        for (int k = 0; k < raw.measurements; ++k, number += raw.measurement_stride) {
          const double e = scale.electrons(static_cast<double>(*number), k);
          electrons[static_cast<std::size_t>(k)] = e;
          is_finite = is_finite && std::isfinite(e);
        }
        return is_finite;
      },
      raw.data);
}

void drop(const DecodedView& decoded, std::size_t i) {
  for (float* plane :
       {decoded.depth_m, decoded.signal_e_per_s, decoded.ambient_e_per_s, decoded.confidence,
        decoded.predicted_standard_deviation_m, decoded.delay_m, decoded.ratio})
    if (plane) plane[i] = std::numeric_limits<float>::quiet_NaN();
}

/// The stronger of two surfaces that a pixel sees; none if it does not see two.
std::optional<Surface> stronger_of_two(const MixedPixelFit& fit, const double* electrons,
                                       double averaged, double offset_m, double decoded_m,
                                       const std::vector<Surface>& surfaces) {
  std::optional<Surface> stronger;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    for (std::size_t j = i + 1; j < surfaces.size(); ++j) {
      SurfaceDepth first = surfaces[i].here, second = surfaces[j].here;
      first.depth_m += offset_m, second.depth_m += offset_m;
      const auto found = fit.explain(electrons, averaged, decoded_m + offset_m, first, second);
      if (!found.is_two || !(found.chi2 < best)) continue;
      best = found.chi2;
      stronger = found.first_e_per_s >= found.second_e_per_s ? surfaces[i] : surfaces[j];
    }
  return stronger;
}

void check(const DecodingTable& table, const RawView& raw, const DecodedView& decoded,
           const PixelMaps& maps) {
  require_measurements(raw, table.measurements());
  require(raw.height > 0 && raw.width > 0, "raw height and width", std::min(raw.height, raw.width),
          "must be > 0");
  require(decoded.depth_m && decoded.predicted_standard_deviation_m && decoded.status, "decoded",
          "a null plane", "must have depth, predicted standard deviation and status");
  maps.validate(raw.height, raw.width);
}

}  // namespace

std::string_view name_of(MixedPixels mixed) { return mixed_words.of(mixed); }

MixedPixels parse_mixed_pixels(std::string_view name) { return mixed_words.parse(name); }

std::int64_t mark_mixed_pixels(const DecodingTable& table, const RawView& raw, MixedPixels mixed,
                               const DecodedView& decoded, const PixelMaps& maps,
                               const Progress& progress) {
  table.validate();
  check(table, raw, decoded, maps);
  report(progress, 0.0, "looking for mixed pixels");
  const MixedPixelFit fit(table);
  if (fit.rank() < 3) return 0;
  const RawScale scale(table);
  const Surroundings around(decoded, raw.height, raw.width, table.range_m);
  std::vector<std::int64_t> marked(static_cast<std::size_t>(raw.height), 0);
  parallel_for(raw.height, [&](std::int64_t y) {
    const int row = static_cast<int>(y);
    std::vector<Surface> surfaces;
    std::array<double, max_measurements> electrons;
    for (int x = 0; x < raw.width; ++x) {
      const std::size_t i = around.at(row, x);
      if (!around.is_decoded(i)) continue;
      around.find_surfaces(row, x, surfaces);
      if (surfaces.size() < 2 ||
          std::any_of(surfaces.begin(), surfaces.end(),
                      [&](const Surface& surface) { return around.lies_on(i, surface); }))
        continue;
      if (!read_electrons(raw, scale, row, x, electrons)) continue;
      const double offset_m = maps.delay_offset_m.empty() ? 0.0 : maps.delay_offset_m.pixels[i];
      const auto stronger =
          stronger_of_two(fit, electrons.data(), raw.averaged ? raw.averaged[i] : 1.0, offset_m,
                          around.depth_m(i), surfaces);
      if (!stronger) continue;
      ++marked[static_cast<std::size_t>(row)];
      decoded.status[i] = PixelStatus::mixed;
      if (mixed == MixedPixels::drop) drop(decoded, i);
      if (mixed == MixedPixels::snap) {
        decoded.depth_m[i] = around.depth_m(stronger->nearest);
        decoded.predicted_standard_deviation_m[i] = around.deviation_m(stronger->nearest);
      }
    }
  });
  report(progress, 1.0, "looking for mixed pixels");
  std::int64_t sum = 0;
  for (const std::int64_t count : marked) sum += count;
  return sum;
}

}  // namespace tofsmith
