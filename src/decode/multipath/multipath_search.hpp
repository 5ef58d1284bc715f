// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/multipath/multipath_curve.hpp"

namespace tofsmith {

/// Pixels side by side, with the noise of their measurements and a first guess of their depth.
struct PixelGroup {
  alignas(64) float electrons[max_measurements][pixels_per_group];    ///< without dark ones [e]
  alignas(64) float variance_e2[max_measurements][pixels_per_group];  ///< each > 0
  alignas(64) float guess[pixels_per_group];                          ///< [fine points]
  /// Part of the range in which the direct return cannot lie: beginning and length [fine points].
  alignas(64) float excluded_from[pixels_per_group] = {};
  alignas(64) float excluded_length[pixels_per_group] = {};
};

/// What a single return leaves unexplained. chi^2 counts only what some set of returns could
/// explain: the dimensions of the curve, less what ambient light explains.
struct SingleFits {
  alignas(64) float position[pixels_per_group];  ///< [fine points], in [0, points)
  alignas(64) float chi2[pixels_per_group];
};

/// The best pair of returns, or of a return and its tail.
struct PairFits {
  alignas(64) float position[pixels_per_group];        ///< of the direct one [fine points]
  alignas(64) float delay[pixels_per_group];           ///< of the second [fine points]; tail: 0
  alignas(64) float signal_e_per_s[pixels_per_group];  ///< of the direct one, S1
  alignas(64) float second_e_per_s[pixels_per_group];  ///< S2, in [0, S1]
  alignas(64) float chi2[pixels_per_group];
  alignas(64) float single_chi2[pixels_per_group];  ///< of the best single return anywhere
  alignas(
      64) float second_best_chi2[pixels_per_group];  ///< of the best fit with another direct depth
  /// Of the direct position [fine points]; at most that of any depth at all.
  alignas(64) float deviation[pixels_per_group];
};

/// Bounds of the delay of a second return [fine points].
struct DelayBounds {
  float shortest = 0.0f;
  float longest = 0.0f;
};

/// Noise-weighted least squares of one return from each pixel's guess downhill, over position,
/// signal and ambient light.
/// @note deterministic, thread-safe; a pixel's numbers do not depend on those beside it
void fit_single(const MultipathCurve& curve, const PixelGroup& pixels, SingleFits& fits);

/// Noise-weighted least squares of two returns, S1 >= S2 >= 0, or of a return and its tail if the
/// curve has one: all pairs of coarse places are tried, the best few followed downhill. Searches
/// start outside the excluded part of the range, or at most one coarse step inside, but may end
/// inside.
/// @note as fit_single
void fit_pair(const MultipathCurve& curve, const DelayBounds& delays, const PixelGroup& pixels,
              PairFits& fits);

}  // namespace tofsmith
