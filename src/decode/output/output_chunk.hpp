// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "decode/search/shared/bin_records.hpp"

namespace tofsmith {

inline constexpr int pixels_per_chunk = 128;
/// Minimum variance relative to the largest of the pixel.
inline constexpr double least_variance_share = 1e-4;

/// Fields of ResidualModel::Limit, in blocks of four.
struct LimitLayout {
  static constexpr int variance = 0;  ///< per signal, per ambient light, and without light
  static constexpr int error = 3;
  static constexpr int end_of_bound = 4;
  static constexpr int root = 4;
  static constexpr int per_freedom = 5;
  static constexpr int end = 6, stride = 8;
};

struct OutputConstants {
  int samples = 0;
  float bin_m = 0.0f;
  float bin_high_m = 0.0f;  // bin_m = high + low; bin * high is exact
  float bin_low_m = 0.0f;
  float range_m = 0.0f;
  bool sees_ambient = false;
  std::vector<float> ambient_weight;  // a / |a|^2 (K)
  std::vector<float> shot_ambient;    // variance per ambient light (K)
  std::vector<float> floor_noise_e2;  // variance without light (K)
  float typical_ambient = 0.0f;       // typical_variance() per ambient light
  float typical_floor_e2 = 0.0f;      // without light
  // Minimum variances: per signal, per ambient light, and without light.
  float least_shot = 0.0f, least_shot_ambient = 0.0f, least_floor_e2 = 0.0f;
  float low_signal_sigma2 = 0.0f;
  float min_confidence = 0.0f;
  bool finds_inconsistent = false;
  float half_quantile = 0.0f;  // q / 2 of ResidualModel
  int off_plane_count = 0;
  std::vector<float> off_plane;          // see ResidualModel (count, K)
  std::vector<float> residual_basis;     // V, then off_plane_noise (K, rank + count)
  std::vector<float> ambient_direction;  // see ResidualModel (K)
};

/// Intermediate results that planes need.
struct OutputSteps {
  bool electrons = false;  // in addition to rows of `plane` and `bin`
  bool ambient = false;
  bool noise = false;
  bool confidence = false;
  bool residual = false;
  int fields = 0;
};

struct OutputChunk {
  int pixels = 0;
  const float* plane = nullptr;      // as in the tile
  const float* electrons = nullptr;  // as in the tile
  alignas(64) std::int32_t bin[pixels_per_chunk];
  alignas(64) std::uint32_t start[pixels_per_chunk];  // of the bins' records
  alignas(64) float signal[pixels_per_chunk];         // > 0 if the pixel has a depth
  alignas(64) float offset[pixels_per_chunk];         // depth minus bin [bin], in [-1, 1]
  alignas(64) float ambient[pixels_per_chunk];
  // Relative to a single measurement: 1 / averaged, also multiplied by NoiseRatios.
  alignas(64) float variance_share[pixels_per_chunk];
  alignas(64) float lobe_share[pixels_per_chunk];
  alignas(64) float residual_share[pixels_per_chunk];
  alignas(64) float signal_variance[pixels_per_chunk];
  alignas(64) float confidence[pixels_per_chunk];
  alignas(64) float residual[pixels_per_chunk];
  alignas(64) float inconsistent[pixels_per_chunk];
  alignas(64) std::uint32_t limit_start[pixels_per_chunk];
  alignas(64) float limit[LimitLayout::stride * pixels_per_chunk];
  alignas(64) float chord[ChordLayout::fields * pixels_per_chunk];
  alignas(64) float record[max_record_fields * pixels_per_chunk];

  const float* field(int f) const { return record + f * pixels_per_chunk; }
  const float* chord_field(int f) const { return chord + f * pixels_per_chunk; }
};

}  // namespace tofsmith
