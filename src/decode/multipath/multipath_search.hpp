// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// Maximum number of dimensions in which returns are separated; minor ones are omitted.
inline constexpr int max_span = 12;
inline constexpr int pixels_per_group = 16;

/// Curve of a decoding table in single precision. Positions are points with finer spacing than
/// bins.
struct MultipathCurve {
  /// @param tail_m  mean delay of the tail [m]; 0: no tail
  MultipathCurve(const DecodingTable& table, const AmbientProjection& projection, double tail_m);

  int measurements = 0;
  int span = 0;    ///< dimensions r without ambient light
  int points = 0;  ///< per period
  int points_per_row = 0;
  int coarse = 0;  ///< places at which pairs are tried first
  bool sees_ambient = false;
  /// Ambient direction if visible, then the decoding subspace, (K, dims()).
  std::vector<float> basis;
  std::vector<float> products;    ///< basis_a basis_b, a >= b, (K, pairs)
  std::vector<float> fine;        ///< p in the subspace, (points + 1, span), last row = first
  std::vector<float> tail;        ///< the same for a tail; empty without tail
  std::vector<float> coarse_row;  ///< every (points / coarse)-th row of `fine`
  std::vector<float> coarse_tail;

  int dims() const { return span + (sees_ambient ? 1 : 0); }
  int pairs() const { return dims() * (dims() + 1) / 2; }
};

/// Returns the number of dimensions with more than 1 % of the size of the main one.
int independent_directions(const AmbientProjection& projection);

/// Interpolates `factor` rows per row: by cubics through four rows, or linearly if that predicts
/// the table's rows better (ideal codes have corners).
RowMajorMatrix drawn_finer(const RowMajorMatrix& table, int factor);

/// Pixels that are searched together.
struct PixelGroup {
  alignas(64) float electrons[max_measurements][pixels_per_group];  ///< without dark electrons [e]
  alignas(64) float variance_e2[max_measurements][pixels_per_group];  ///< each > 0
  alignas(64) float guess[pixels_per_group];                          ///< [fine points]
  /// Beginning and length of the part excluded for the direct return [fine points].
  alignas(64) float excluded_from[pixels_per_group] = {};
  alignas(64) float excluded_length[pixels_per_group] = {};
};

/// chi^2 is restricted to the dimensions of the curve without the ambient component.
struct SingleFits {
  alignas(64) float position[pixels_per_group];  ///< [fine points], in [0, points)
  alignas(64) float chi2[pixels_per_group];
};

/// The best pair of returns, or return with a tail.
struct PairFits {
  alignas(64) float position[pixels_per_group];        ///< of the direct return [fine points]
  alignas(64) float delay[pixels_per_group];           ///< of the second one [fine points]; tail: 0
  alignas(64) float signal_e_per_s[pixels_per_group];  ///< of the direct return, S1
  alignas(64) float second_e_per_s[pixels_per_group];  ///< S2, in [0, S1]
  alignas(64) float chi2[pixels_per_group];
  alignas(64) float single_chi2[pixels_per_group];  ///< of the best single return
  alignas(
      64) float second_best_chi2[pixels_per_group];  ///< of the best fit with another direct depth
  /// Standard deviation of the direct position [fine points], at most that of a uniform depth.
  alignas(64) float deviation[pixels_per_group];
};

/// Bounds of the delay of a second return [fine points].
struct DelayBounds {
  float shortest = 0.0f;
  float longest = 0.0f;
};

/// Fits one return by noise-weighted least squares over position, signal and ambient light,
/// starting at each pixel's guess.
/// @note deterministic, thread-safe; results do not depend on neighbouring pixels
void fit_single(const MultipathCurve& curve, const PixelGroup& pixels, SingleFits& fits);

/// Fits two returns, S1 >= S2 >= 0, or a return and its tail if the curve has one, by
/// noise-weighted least squares: evaluates all pairs of coarse places and refines the best ones.
/// Searches start outside the excluded part, or at most one coarse step inside, but may end inside.
void fit_pair(const MultipathCurve& curve, const DelayBounds& delays, const PixelGroup& pixels,
              PairFits& fits);

}  // namespace tofsmith
