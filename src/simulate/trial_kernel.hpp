// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/shared/random_tile.hpp"
#include "decode/output/shared/trial_decoder.hpp"
#include "decode/search/shared/pixel_tile.hpp"
#include "simulate/trial_model.hpp"

namespace tofsmith {

static_assert(trials_per_tile == pixels_per_tile);

/// Trial n of a round is in the n-th of equal slices of the range.
struct DepthSlices {
  std::int64_t first = 0;     ///< of a tile's first trial within the round
  double rows_per_trial = 0;  ///< length of a slice, in rows of the records
  bool on_bins = false;       ///< rounded down to a bin
};

/// Workspace, in rows of trials_per_tile.
struct TrialTile {
  alignas(64) std::uint32_t words[4 * trials_per_tile];
  alignas(64) float normals[max_measurements * trials_per_tile];
  alignas(64) std::int32_t row[trials_per_tile];  ///< of the records, at or below the depth
  alignas(64) float share[trials_per_tile];       ///< fraction of the distance to the next row
  alignas(64) float signal[trials_per_tile];      ///< S times albedo [e/s]
  alignas(64) double true_bin[trials_per_tile];   ///< in [0, N)
  alignas(64) double decoded_bin[trials_per_tile];
  alignas(64) float taps[max_measurements * trials_per_tile];  ///< electrons, then raw numbers
  PixelTile pixels;
};

/// Noise in the plane of ZNCC at one ambient light, in single precision. The vector is
///   q = offset + sum_k weight_k mean_k + L normals,   L L^T = floor + sum_k products_k shot_k
struct PlaneNoise {
  PlaneNoise(const TrialModel& model, const PlaneMap& map, double ambient_e_per_s);

  int rank;
  std::vector<float> mean_floor_e, shot_floor_e2;  // (taps)
  std::vector<float> weight;                       // [taps][rank]
  std::vector<float> products;                     // [taps][rank (rank + 1) / 2], w_j w_l, l <= j
  std::vector<float> offset;                       // (rank)
  std::vector<float> floor;                        // same layout as products
};

/// Fills row, share and true_bin: the lowest bytes of words 1 and 3 of block 0 give a 16-bit
/// position in the slice.
void place_depths(const TrialModel& model, const DepthSlices& slices, int trials, TrialTile& tile);

/// Fills pixels.plane; `rank` rows of normals.
void draw_plane(const TrialModel& model, const PlaneNoise& noise, int trials, TrialTile& tile);

/// Fills taps with expected electrons; for a mixer followed by their shot noise [e^2].
void expect_electrons(const TrialModel& model, const std::vector<float>& mean_floor_e,
                      const std::vector<float>& shot_floor_e2, int trials, TrialTile& tile);

/// Adds normal noise to expected electrons, or read noise to Poisson counts; then clips and
/// converts.
/// @param max_e  limit of electrons before read-out, for a mixer of both signs (taps); empty: none
void read_out_taps(const TrialModel& model, const std::vector<float>& max_e, int trials,
                   TrialTile& tile);

/// Sums over pairs a, b of trials 2 i, 2 i + 1, sorted by depth slice.
struct PairSums {
  double sum = 0.0;                 ///< of a + b
  double squared_difference = 0.0;  ///< of (a - b)^2
  double squared_sum = 0.0;         ///< of (a + b)^2
  double squared_product = 0.0;     ///< of (a^2 - b^2)^2

  void merge(const PairSums& other);
  /// Sum of a^2 + b^2.
  double of_squares() const { return 0.5 * (squared_difference + squared_sum); }
};

struct TileSums {
  PairSums linear, circular;
  double outliers = 0.0, outlier_squared_difference = 0.0;

  void merge(const TileSums& other);
};

/// Sums the errors [bin] of an even number of trials.
TileSums sum_errors(const double* true_bin, const double* decoded_bin, int trials, double samples,
                    double threshold_bin);

}  // namespace tofsmith
