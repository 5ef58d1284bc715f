// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <type_traits>
#include <vector>

#include "decode/output/lobe_posterior.hpp"
#include "decode/output/output_kernel.hpp"
#include "decode/output/pixel_model.hpp"
#include "decode/raw_scale.hpp"
#include "decode_setup.hpp"
#include "each_target.hpp"
#include "reference_decoder.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

/// The planes that every decoder fills, starting with the bin.
inline const std::vector<DecodedPlane> decoder_planes = [] {
  std::vector<DecodedPlane> planes{DecodedPlane::bin};
  for (const PlaneDescription& described : plane_descriptions)
    if (described.is_of_every_decoder() && described.plane != DecodedPlane::bin)
      planes.push_back(described.plane);
  return planes;
}();

/// Returns the bit of a plane in a mask of decoder_planes.
inline unsigned bit_of(DecodedPlane plane) {
  return 1u << (std::ranges::find(decoder_planes, plane) - decoder_planes.begin());
}

/// The planes of `decoder_planes` for one row of pixels, initialized to values no decoder writes.
struct Outputs : DepthImage {
  explicit Outputs(std::size_t pixels) : DepthImage(decoder_planes, 1, static_cast<int>(pixels)) {
    for_each_plane(
        []<typename Value>(Image<Value>& plane) {
          std::ranges::fill(plane.pixels, static_cast<Value>(std::is_enum_v<Value> ? 77 : -7));
        },
        *this);
  }

  /// @param planes  bit p requests plane p of decoder_planes
  DecodedView view(unsigned planes = ~0u) {
    DecodedView wanted;
    for (std::size_t p = 0; p < decoder_planes.size(); ++p)
      if (planes >> p & 1u)
        with_plane(
            decoder_planes[p], [](auto*& to, auto& from) { to = from.pixels.data(); }, wanted,
            *this);
    return wanted;
  }
};

/// NaN equals NaN.
template <typename Value>
testing::AssertionResult same(const std::vector<Value>& a, const std::vector<Value>& b) {
  if (a.size() != b.size()) return testing::AssertionFailure() << "sizes differ";
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::memcmp(&a[i], &b[i], sizeof(Value)) != 0)
      return testing::AssertionFailure()
             << static_cast<double>(a[i]) << " != " << static_cast<double>(b[i]) << " of pixel "
             << i;
  return testing::AssertionSuccess();
}

/// Expects that requested planes are equal in `all` and that the other planes are unchanged.
/// @param planes  bit mask of Outputs::view()
inline void expect_only(const Outputs& some, const Outputs& all, unsigned planes) {
  const Outputs none(all.bin.size());
  for (std::size_t p = 0; p < decoder_planes.size(); ++p)
    with_plane(
        decoder_planes[p],
        [&](const auto& its, const auto& expected) {
          EXPECT_TRUE(same(its.pixels, expected.pixels)) << name_of(decoder_planes[p]);
        },
        some, planes >> p & 1u ? all : none);
}
inline void expect_same(const Outputs& a, const Outputs& b) { expect_only(a, b, ~0u); }

/// Reference implementation in double: matches pixels to bins and computes their outputs.
class Matched {
 public:
  Matched(const DecodingTable& table, const std::vector<float>& raw,
          const DecodeOptions& options = {})
      : table_(table),
        options_(options),
        projection_(table),
        model_(table, projection_),
        posterior_(table, projection_),
        residuals_(table, projection_, options),
        scale_(table),
        raw_(raw),
        pixels_(raw.size() / k_count()) {
    const ReferenceDecoder reference(table);
    for (std::size_t i = 0; i < pixels_; ++i)
      bin_.push_back(electrons(i).allFinite() ? reference.row(&raw[i * k_count()]) : -1);
  }

  const DecodingTable& table() const { return table_; }
  std::size_t pixels() const { return pixels_; }
  double brightest_e_per_s() const {
    return *std::max_element(raw_.begin(), raw_.end()) / table_.exposure_s.minCoeff();
  }

  Outputs expected() const {
    Outputs result(pixels_);
    for (std::size_t i = 0; i < pixels_; ++i) {
      if (bin_[i] < 0) {
        store_invalid(i, result.view());
        continue;
      }
      const PixelDecoding decoding = decoding_of(i);
      store_pixel(table_, options_, &raw_[i * k_count()], decoding, i, result.view());
      result.bin.pixels[i] = bin_[i];  // the best bin may differ from the nearest one
    }
    return result;
  }

  PixelDecoding decoding_of(std::size_t i) const {
    std::array<double, max_measurements> variance_e2;
    const Eigen::VectorXd y = electrons(i), q = plane_of(y);
    const Position position = model_.refine(q.data(), bin_[i]);
    PixelDecoding decoding{position.in_rows(table_.samples()),
                           model_.estimate(y.data(), q.data(), position, variance_e2.data()), 1.0};
    if (decoding.estimate.signal_e_per_s > 0.0)
      decoding.confidence = posterior_.probability(q.data(), variance_e2.data(), bin_[i]);
    decoding.residual = residuals_.residual(y.data(), decoding.estimate, position, 1.0);
    return decoding;
  }

 private:
  std::size_t k_count() const { return static_cast<std::size_t>(table_.measurements()); }

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

  DecodingTable table_;
  DecodeOptions options_;
  AmbientProjection projection_;
  PixelModel model_;
  LobePosterior posterior_;
  ResidualModel residuals_;
  RawScale scale_;
  std::vector<float> raw_;
  std::size_t pixels_;
  std::vector<std::int32_t> bin_;
};

inline double off_rows(float depth_m, double depth_row, const DecodingTable& table) {
  return std::abs(circular_difference(depth_m / table.row_m(), depth_row, table.samples()));
}

inline void expect_near(const std::vector<float>& values, const std::vector<float>& expected,
                        double share, double amount, const char* plane) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(std::isfinite(values[i]), std::isfinite(expected[i])) << plane << " of pixel " << i;
    if (!std::isfinite(expected[i])) continue;
    ASSERT_NEAR(values[i], expected[i], share * std::abs(expected[i]) + amount)
        << plane << " of pixel " << i;
  }
}

/// Compares deviations, residuals or values of other planes. The kernel evaluates the noise once
/// per quarter of a chord, which differs much within the quarter only for a bright pixel with
/// vanishing shot noise. At a bin, the residual may use the slope of either side.
inline void expect_similar(const std::vector<float>& values, const std::vector<float>& expected,
                           double others_share, const char* plane) {
  expect_near(values, expected, 1.0, 0.0, plane);
  double sum = 0.0;
  int finite = 0, others = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!std::isfinite(expected[i])) continue;
    const double share = std::abs(values[i] / expected[i] - 1.0);
    sum += share;
    ++finite;
    others += share > 0.1;
  }
  EXPECT_LE(sum, 0.01 * finite) << plane;
  EXPECT_LE(others, others_share * finite) << plane;
}

/// Compares all planes but bins and confidence; confidence differs more in single precision.
inline void expect_definition(const Outputs& outputs, const Matched& matched) {
  const DecodingTable& table = matched.table();
  const Outputs expected = matched.expected();
  const double float_error_bin = 1e-4 + 1.2e-7 * table.samples();
  int other_status = 0;
  for (std::size_t i = 0; i < matched.pixels(); ++i) {
    other_status += outputs.status.pixels[i] != expected.status.pixels[i];
    ASSERT_EQ(std::isnan(outputs.depth_m.pixels[i]), std::isnan(expected.depth_m.pixels[i])) << i;
    if (std::isnan(expected.depth_m.pixels[i])) continue;
    ASSERT_LE(off_rows(outputs.depth_m.pixels[i], matched.decoding_of(i).depth_row, table),
              float_error_bin)
        << i;
    ASSERT_GE(outputs.depth_m.pixels[i], 0.0f);
    ASSERT_LT(outputs.depth_m.pixels[i], static_cast<float>(table.range_m));
  }
  // The kernel evaluates the noise at the best bin, which shifts the status thresholds slightly.
  EXPECT_LE(other_status, 5 + static_cast<int>(matched.pixels()) / 500);
  const double brightest_e_per_s = matched.brightest_e_per_s();
  expect_near(outputs.signal_e_per_s.pixels, expected.signal_e_per_s.pixels, 2e-6,
              1e-6 * brightest_e_per_s, "signal");
  // If the best row is not the nearest one, the kernel extrapolates the signal slightly.
  expect_near(outputs.ambient_e_per_s.pixels, expected.ambient_e_per_s.pixels, 2e-6,
              4e-6 * brightest_e_per_s, "ambient");
  // Planes compared above, and confidence, which is not compared.
  const std::set others{DecodedPlane::depth, DecodedPlane::signal, DecodedPlane::ambient,
                        DecodedPlane::confidence};
  const auto plus = [](float added, std::vector<float> values) {
    for (float& value : values) value += added;
    return values;
  };
  for (const DecodedPlane plane : decoder_planes)
    with_plane(
        plane,
        [&]<typename Value>(const Image<Value>& values, const Image<Value>& defined) {
          if constexpr (std::is_same_v<Value, float>) {
            if (others.contains(plane)) return;
            const bool has_unit = !description_of(plane).unit.empty();
            const float added = has_unit ? 0.0f : 1.0f;
            expect_similar(plus(added, values.pixels), plus(added, defined.pixels),
                           has_unit ? 0.02 : 0.03, description_of(plane).member.data());
          }
        },
        outputs, expected);
}

}  // namespace tofsmith
