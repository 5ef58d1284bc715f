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

#include "decode/mixed/mixed_pixel_fit.hpp"
#include "decode/output/pixel_output.hpp"
#include "decode/raw_scale.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/decode/depth_image.hpp"

namespace tofsmith {

namespace {

constexpr int reach = 4;
constexpr int window_pixels = (2 * reach + 1) * (2 * reach + 1);
/// Number of 8 neighbours with the same depth in a surface. Ribbons of mixed pixels and objects one
/// pixel wide have fewer.
constexpr int least_neighbours = 6;
constexpr int least_pixels = 2;
constexpr int most_surfaces = 4;
/// Depths within this many standard deviations or this fraction of the range are equal.
constexpr double same_sigma = 1.3, same_share = 0.002;
/// Steps on both sides that differ by more are not one slope.
constexpr double slope_sigma = 2.0, parts_sigma = 1.7;
/// Prior standard deviation of slopes, as a fraction of the range per pixel.
constexpr double slope_share = 0.0025;

struct WindowPixel {
  double depth_m = 0.0, variance_m2 = 0.0;
  double here_m = 0.0;  ///< extrapolated along the slope to the central pixel
  int dx = 0, dy = 0;
  std::size_t index = 0;
  int distance() const { return dx * dx + dy * dy; }
};

/// Depth difference between adjacent pixels [m].
struct Slope {
  float x = 0.0f, y = 0.0f;
};

struct Surface {
  SurfaceDepth here;
  std::size_t nearest = 0;  ///< in case of ties the one closer to the camera
  std::size_t pixels = 0;
};

/// Depths, slopes and surfaces of a frame before any pixel is marked.
class Surroundings {
 public:
  /// @param mixed  (H, W) or empty: nonzero pixels belong to no surface
  Surroundings(const DecodedView& decoded, const Image<std::uint8_t>& mixed, int height, int width,
               double range_m)
      : height_(height),
        width_(width),
        same_m_(same_share * range_m),
        slope_m_(slope_share * range_m),
        depth_(decoded.depth_m, decoded.depth_m + size()),
        deviation_(decoded.deviation_m, decoded.deviation_m + size()),
        status_(decoded.status, decoded.status + size()),
        slope_(size()),
        is_firm_(size(), 0) {
    for (std::size_t i = 0; i < mixed.size(); ++i)
      if (mixed.pixels[i] != 0) status_[i] = PixelStatus::mixed;
    parallel_for(height_, [&](std::int64_t row) {
      for (int x = 0; x < width_; ++x)
        slope_[at(static_cast<int>(row), x)] = slope_at(static_cast<int>(row), x);
    });
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
  bool was_mixed(std::size_t i) const { return status_[i] == PixelStatus::mixed; }
  bool is_decoded(std::size_t i) const {
    return was_mixed(i) ||
           (std::isfinite(depth_[i]) &&
            (status_[i] == PixelStatus::ok || status_[i] == PixelStatus::low_signal ||
             status_[i] == PixelStatus::inconsistent || status_[i] == PixelStatus::ambiguous));
  }

  /// Returns the surfaces around a pixel, largest first; none if there is only one.
  void find_surfaces(int row, int x, std::vector<Surface>& surfaces) const {
    surfaces.clear();
    std::array<WindowPixel, window_pixels> pixels;
    const auto count = static_cast<std::size_t>(firm_pixels(row, x, pixels));
    const auto end = pixels.begin() + static_cast<std::ptrdiff_t>(count);
    if (count < 2 * least_pixels) return;
    const auto [low, high] = std::minmax_element(
        pixels.begin(), end, [](const auto& a, const auto& b) { return a.here_m < b.here_m; });
    if (!parts(*low, *high)) return;
    std::sort(pixels.begin(), end, [](const WindowPixel& a, const WindowPixel& b) {
      return a.here_m != b.here_m ? a.here_m < b.here_m : a.index < b.index;
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

  /// The tolerance is half of that for joining pixels, because a little light of another surface
  /// shifts the depth by a similar amount.
  bool lies_on(std::size_t i, const Surface& surface) const {
    return std::abs(depth_[i] - surface.here.depth_m) <=
           0.5 *
               std::max(same_m_, same_sigma * std::hypot(deviation_[i], surface.here.deviation_m));
  }

 private:
  bool is_usable(std::size_t i) const {
    // Model errors make pixels inconsistent, but surfaces remain.
    return (status_[i] == PixelStatus::ok || status_[i] == PixelStatus::inconsistent) &&
           std::isfinite(depth_[i]) && std::isfinite(deviation_[i]);
  }

  /// Returns the slope of a pixel from both neighbours, reduced by its noise: the mean of both
  /// steps, or the smaller one if the larger one is an edge.
  float slope_along(std::size_t before, std::size_t i, std::size_t after) const {
    if (!is_usable(before) || !is_usable(after)) return 0.0f;
    const float down = depth_[i] - depth_[before], up = depth_[after] - depth_[i];
    const float ends = std::hypot(deviation_[before], deviation_[after]);
    float step = (up + down) / 2.0f, noise = ends / 2.0f;
    if (std::abs(up - down) >
        static_cast<float>(slope_sigma) * std::hypot(ends, 2.0f * deviation_[i])) {
      const bool is_up = std::abs(up) < std::abs(down);
      step = is_up ? up : down;
      noise = std::hypot(deviation_[i], deviation_[is_up ? after : before]);
    }
    return std::copysign(std::max(0.0f, std::abs(step) - noise), step);
  }
  Slope slope_at(int row, int x) const {
    const std::size_t i = at(row, x);
    if (!is_usable(i)) return {};
    const auto below = static_cast<std::size_t>(width_);
    return {.x = x > 0 && x + 1 < width_ ? slope_along(i - 1, i, i + 1) : 0.0f,
            .y = row > 0 && row + 1 < height_ ? slope_along(i - below, i, i + below) : 0.0f};
  }
  /// The smaller slope; 0 if the signs differ.
  static double shared(float a, float b) {
    return a * b > 0.0f ? (std::abs(a) < std::abs(b) ? a : b) : 0.0;
  }
  /// Expected depth difference of pixels on a common surface.
  double rise_m(std::size_t i, std::size_t j, int dx, int dy) const {
    return dx * shared(slope_[i].x, slope_[j].x) + dy * shared(slope_[i].y, slope_[j].y);
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
        const double rise = rise_m(i, j, c - x, y - row);
        count += std::abs(depth_[j] - depth_[i] - rise) <= same ? 1 : 0;
      }
    return count >= least_neighbours;
  }

  int firm_pixels(int row, int x, std::array<WindowPixel, window_pixels>& pixels) const {
    int count = 0;
    for (int y = std::max(0, row - reach); y <= std::min(height_ - 1, row + reach); ++y)
      for (int c = std::max(0, x - reach); c <= std::min(width_ - 1, x + reach); ++c) {
        const std::size_t j = at(y, c);
        if (!is_firm_[j] || (y == row && c == x)) continue;
        const int dx = c - x, dy = y - row;
        pixels[static_cast<std::size_t>(count++)] = {
            .depth_m = depth_[j],
            .variance_m2 = static_cast<double>(deviation_[j]) * deviation_[j],
            .here_m = depth_[j] - dx * static_cast<double>(slope_[j].x) -
                      dy * static_cast<double>(slope_[j].y),
            .dx = dx,
            .dy = dy,
            .index = j};
      }
    return count;
  }

  bool parts(const WindowPixel& a, const WindowPixel& b) const {
    return b.here_m - a.here_m >
           std::max(2 * same_m_, parts_sigma * std::sqrt(a.variance_m2 + b.variance_m2));
  }

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
  std::vector<Slope> slope_;
  std::vector<std::uint8_t> is_firm_;
};

/// Returns false if a value is not finite.
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
  for_each_plane(
      [i]<typename Value>(Value* plane) {
        if constexpr (std::is_same_v<Value, float>)
          if (plane) plane[i] = no_value<float>;
      },
      decoded);
}

struct MixedPixel {
  std::optional<Surface> stronger;  ///< none if no surface remains
};

class MixedPixelSearch {
 public:
  MixedPixelSearch(const DecodingTable& table, const RawView& raw, const Surroundings& around,
                   const PixelMaps& maps, const UnfilteredPixels& unfiltered)
      : fit_(table),
        scale_(table),
        around_(around),
        offset_m_(maps.delay_offset_m),
        decoded_(raw),
        own_(unfiltered.measured) {}

  int rank() const { return fit_.rank(); }

  /// Returns none if the pixel does not see two surfaces.
  std::optional<MixedPixel> at(int row, int x, std::vector<Surface>& surfaces) const {
    const std::size_t i = around_.at(row, x);
    if (!around_.is_decoded(i)) return std::nullopt;
    around_.find_surfaces(row, x, surfaces);
    if (around_.was_mixed(i)) {
      if (surfaces.size() == 1) return MixedPixel{surfaces.front()};
      return MixedPixel{stronger_of_two(own_ ? *own_ : decoded_, row, x, surfaces)};
    }
    auto stronger = stronger_of_two(decoded_, row, x, surfaces);
    if (!stronger && own_) stronger = stronger_of_two(*own_, row, x, surfaces);
    return stronger ? std::optional(MixedPixel{stronger}) : std::nullopt;
  }

 private:
  /// Returns the surface with more light of the two that explain a pixel best; none if one
  /// suffices.
  std::optional<Surface> stronger_of_two(const RawView& raw, int row, int x,
                                         const std::vector<Surface>& surfaces) const {
    std::array<double, max_measurements> electrons;
    if (surfaces.size() < 2 || !read_electrons(raw, scale_, row, x, electrons)) return std::nullopt;
    const std::size_t pixel = around_.at(row, x);
    const double averaged = raw.averaged ? raw.averaged[pixel] : 1.0;
    const double offset_m = offset_m_.empty() ? 0.0 : offset_m_.pixels[pixel];
    const bool has_depth_of_one =
        std::any_of(surfaces.begin(), surfaces.end(),
                    [&](const Surface& surface) { return around_.lies_on(pixel, surface); });
    std::optional<Surface> stronger;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < surfaces.size(); ++i)
      for (std::size_t j = i + 1; j < surfaces.size(); ++j) {
        SurfaceDepth first = surfaces[i].here, second = surfaces[j].here;
        first.depth_m += offset_m, second.depth_m += offset_m;
        const auto found = fit_.explain(electrons.data(), averaged,
                                        around_.depth_m(pixel) + offset_m, first, second);
        const bool is_mixed = has_depth_of_one ? found.is_no_single : found.is_two;
        if (!(is_mixed || around_.was_mixed(pixel)) || !(found.chi2 < best)) continue;
        best = found.chi2;
        stronger = found.first_e_per_s >= found.second_e_per_s ? surfaces[i] : surfaces[j];
      }
    return stronger;
  }

  MixedPixelFit fit_;
  RawScale scale_;
  const Surroundings& around_;
  const Image<float>& offset_m_;
  const RawView& decoded_;
  const RawView* own_;
};

void check(const DecodingTable& table, const RawView& raw, const DecodedView& decoded,
           const PixelMaps& maps, const UnfilteredPixels& unfiltered) {
  require_measurements(raw, table.measurements());
  require(raw.height > 0 && raw.width > 0, "raw height and width", std::min(raw.height, raw.width),
          "must be > 0");
  require(decoded.depth_m && decoded.deviation_m && decoded.status, "decoded", "a null plane",
          "must have depth, predicted standard deviation and status");
  maps.validate(raw.height, raw.width);
  const auto fits = [&](const char* field, int height, int width) {
    require(height == raw.height && width == raw.width, field,
            std::to_string(height) + " x " + std::to_string(width),
            "must have the size of the frame");
  };
  if (const RawView* own = unfiltered.measured) {
    require_measurements(*own, table.measurements());
    fits("unfiltered.measured", own->height, own->width);
  }
  if (!unfiltered.mixed.empty())
    fits("unfiltered.mixed", unfiltered.mixed.height, unfiltered.mixed.width);
}

}  // namespace

std::int64_t mark_mixed_pixels(const DecodingTable& table, const RawView& stored, MixedPixels mixed,
                               const DecodedView& decoded, const PixelMaps& maps,
                               const Progress& progress, const UnfilteredPixels& unfiltered) {
  table.validate();
  require_exposures(table, "the detection of mixed pixels");
  check(table, stored, decoded, maps, unfiltered);
  const MarkedRaw marked_raw(stored, table.marking);
  const RawView& raw = marked_raw.view();
  report(progress, 0.0, "detecting mixed pixels");
  const Surroundings around(decoded, unfiltered.mixed, raw.height, raw.width, table.range_m);
  const MixedPixelSearch search(table, raw, around, maps, unfiltered);
  if (search.rank() < 3) return 0;
  std::vector<std::int64_t> marked(static_cast<std::size_t>(raw.height), 0);
  parallel_for(raw.height, [&](std::int64_t y) {
    const int row = static_cast<int>(y);
    std::vector<Surface> surfaces;
    for (int x = 0; x < raw.width; ++x) {
      const auto found = search.at(row, x, surfaces);
      if (!found) continue;
      ++marked[static_cast<std::size_t>(row)];
      const std::size_t i = around.at(row, x);
      decoded.status[i] = PixelStatus::mixed;
      if (mixed == MixedPixels::drop) drop(decoded, i);
      if (mixed == MixedPixels::snap && found->stronger) {
        decoded.depth_m[i] = around.depth_m(found->stronger->nearest);
        decoded.deviation_m[i] = around.deviation_m(found->stronger->nearest);
      }
    }
  });
  report(progress, 1.0, "detecting mixed pixels");
  std::int64_t sum = 0;
  for (const std::int64_t count : marked) sum += count;
  return sum;
}

}  // namespace tofsmith
