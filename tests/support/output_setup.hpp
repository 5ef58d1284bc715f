// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <vector>

#include "decode/direction_table.hpp"
#include "decode/output_kernel.hpp"
#include "decode/pixel_output.hpp"
#include "decode/raw_scale.hpp"
#include "decode_setup.hpp"

namespace tofsmith {

inline constexpr auto tile_size = static_cast<std::size_t>(pixels_per_tile);

/// Runs `body` once for every instruction set this machine offers.
template <typename Body>
void for_each_target(const Body& body) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    SCOPED_TRACE(hwy::TargetName(target));
    body();
  }
  hwy::SetSupportedTargetsForTest(0);
}

/// All planes of a row of pixels.
struct Outputs {
  explicit Outputs(std::size_t pixels)
      : bin(pixels, -7),
        depth_m(pixels, -7.0f),
        signal(pixels, -7.0f),
        ambient(pixels, -7.0f),
        confidence(pixels, -7.0f),
        deviation_m(pixels, -7.0f),
        status(pixels, static_cast<PixelStatus>(77)) {}

  DecodedView view() {
    return {bin.data(),        depth_m.data(),     signal.data(), ambient.data(),
            confidence.data(), deviation_m.data(), status.data()};
  }

  std::vector<std::int32_t> bin;
  std::vector<float> depth_m, signal, ambient, confidence, deviation_m;
  std::vector<PixelStatus> status;
};

/// Whether floats are the same bits; NaN equals NaN.
inline testing::AssertionResult same(const std::vector<float>& a, const std::vector<float>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::memcmp(&a[i], &b[i], sizeof(float)) != 0)
      return testing::AssertionFailure() << a[i] << " != " << b[i] << " of pixel " << i;
  return testing::AssertionSuccess();
}

/// A code's kernel, and pixels matched to bins in plain double arithmetic.
class Matched {
 public:
  Matched(const DecodingTable& table, const std::vector<float>& raw,
          const DecodeOptions& options = {})
      : table_(table),
        options_(options),
        projection_(table),
        directions_(projection_),
        model_(table, projection_),
        kernel_(table, projection_, options),
        scale_(table),
        raw_(raw),
        pixels_(raw.size() / k_count()) {
    const std::size_t tiles = (pixels_ + tile_size - 1) / tile_size;
    plane_.resize(tiles * rank() * tile_size);
    electrons_.resize(tiles * k_count() * tile_size);
    bin_.assign(tiles * tile_size, std::numeric_limits<std::int32_t>::max());
    rival_ = bin_;
    saturated_.resize(bin_.size());
    for (std::size_t i = 0; i < pixels_; ++i) match(i);
  }

  std::size_t pixels() const { return pixels_; }
  const OutputKernel& kernel() const { return kernel_; }

  MatchedTile tile(std::size_t first) const {
    return {static_cast<int>(std::min(pixels_ - first, tile_size)),
            &plane_[first * rank()],
            &electrons_[first * k_count()],
            &bin_[first],
            &rival_[first],
            &saturated_[first]};
  }

  void write(const DecodedView& planes) const {
    for (std::size_t first = 0; first < pixels_; first += tile_size)
      kernel_.write(tile(first), planes.from(first));
  }
  Outputs outputs() const {
    Outputs result(pixels_);
    write(result.view());
    return result;
  }

  /// The definition: PixelModel and store_pixel.
  Outputs expected() const {
    Outputs result(pixels_);
    for (std::size_t i = 0; i < pixels_; ++i) {
      if (bin_[i] < 0) {
        store_invalid(i, result.view());
        continue;
      }
      const PixelDecoding decoding = decoding_of(i);
      store_pixel(table_, options_, &raw_[i * k_count()], decoding, i, result.view());
    }
    return result;
  }

  PixelDecoding decoding_of(std::size_t i) const {
    std::array<double, max_measurements> variance_e2;
    const Eigen::VectorXd y = electrons(i), q = plane_of(y);
    const Position position = model_.refine(q.data(), bin_[i]);
    PixelDecoding decoding{position.in_bins(table_.samples()),
                           model_.estimate(y.data(), q.data(), position, variance_e2.data()), 1.0};
    if (rival_[i] >= 0) {
      const Eigen::VectorXd apart = direction(bin_[i]) - direction(rival_[i]);
      decoding.confidence =
          confidence_of(apart.dot(q), model_.deviation_along(apart.data(), variance_e2.data()));
    }
    return decoding;
  }

 private:
  std::size_t k_count() const { return static_cast<std::size_t>(table_.measurements()); }
  std::size_t rank() const { return static_cast<std::size_t>(projection_.rank()); }

  Eigen::VectorXd electrons(std::size_t pixel) const {
    Eigen::VectorXd y(table_.measurements());
    for (int k = 0; k < y.size(); ++k)
      y[k] = scale_.electrons(raw_[pixel * k_count() + static_cast<std::size_t>(k)], k);
    return y;
  }
  Eigen::VectorXd plane_of(const Eigen::VectorXd& y) const {
    const Eigen::VectorXd q = projection_.basis.transpose() * y;
    return q.norm() <= nothing_left * y.lpNorm<1>() ? Eigen::VectorXd::Zero(q.size()).eval() : q;
  }
  Eigen::VectorXd direction(std::int32_t n) const {
    Eigen::VectorXd u(projection_.rank());
    for (int j = 0; j < u.size(); ++j) u[j] = directions_.direction(n, j);
    return u;
  }
  std::int32_t best_bin(const Eigen::VectorXd& q, std::int32_t begin, std::int32_t end) const {
    std::int32_t best = begin;
    double score = -std::numeric_limits<double>::infinity();
    for (std::int32_t n = begin; n < end; ++n) {
      const std::int32_t bin = n % table_.samples();
      if (projection_.curve.row(bin).isZero(0.0)) continue;
      if (direction(bin).dot(q) > score) best = bin, score = direction(bin).dot(q);
    }
    return best;
  }

  void match(std::size_t i) {
    const Eigen::VectorXd y = electrons(i);
    const Eigen::VectorXd q = plane_of(y);
    const std::size_t first = i / tile_size * tile_size, lane = i - first;
    for (std::size_t j = 0; j < rank(); ++j)
      plane_[first * rank() + j * tile_size + lane] = static_cast<float>(q[static_cast<int>(j)]);
    for (std::size_t k = 0; k < k_count(); ++k)
      electrons_[first * k_count() + k * tile_size + lane] =
          static_cast<float>(y[static_cast<int>(k)]);
    const float* raw = &raw_[i * k_count()];
    saturated_[i] = table_.saturation_level && std::any_of(raw, raw + k_count(), [&](float value) {
                      return value >= *table_.saturation_level;
                    });
    bin_[i] = rival_[i] = -1;
    if (!y.allFinite()) return;
    bin_[i] = best_bin(q, 0, table_.samples());
    const Lobe lobe = directions_.main_lobe(bin_[i]);
    if (lobe.end - lobe.begin < table_.samples())
      rival_[i] = best_bin(q, lobe.end, lobe.begin + table_.samples());
  }

  DecodingTable table_;
  DecodeOptions options_;
  AmbientProjection projection_;
  DirectionTable directions_;
  PixelModel model_;
  OutputKernel kernel_;
  RawScale scale_;
  std::vector<float> raw_;
  std::size_t pixels_;
  std::vector<float> plane_, electrons_;
  std::vector<std::int32_t> bin_, rival_;
  std::vector<std::uint8_t> saturated_;
};

inline std::vector<float> pixels_at_all_light_levels(const DecodingTable& table, int each) {
  std::vector<float> raw;
  std::uint64_t seed = 1;
  for (const auto& [signal, ambient] :
       {OperatingPoint{1e3, 1e5}, OperatingPoint{3e3, 1e3}, OperatingPoint{1e4, 1e4},
        OperatingPoint{1e5, 1e2}, OperatingPoint{1e7, 1e5}}) {
    const std::vector<float> more = noisy_pixels(table, signal, ambient, each, seed++);
    raw.insert(raw.end(), more.begin(), more.end());
  }
  return raw;
}

}  // namespace tofsmith
