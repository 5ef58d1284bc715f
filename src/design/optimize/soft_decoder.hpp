// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "design/optimize/sampled_camera.hpp"

namespace tofsmith {

/// The soft decoder weights chord j of the curve by
///   exp(sharpness S_j) / sum,  S_j = 1/2 max(<y, p>, 0)^2 / |p|^2 at the best point of the chord.
struct SoftQuestion {
  double true_bin = 0.0;
  double sharpness = 1.0;  ///< divided by the variance of y [1/e^2]
  bool circular = false;   ///< errors wrap around the period
  bool is_signed = false;  ///< signed error, > 0 beyond true_bin
};

/// Decodes by zero-mean normalized cross-correlation on all chords. Use one object per thread.
template <typename Value>
class SoftDecoderOf {
 public:
  explicit SoftDecoderOf(const DecodingCurveOf<Value>& curve);

  /// Returns the best position on the two chords at the best bin [bin], for electrons (R).
  double decode(const DecodingCurveOf<Value>& curve, const Value* electrons);

  /// Returns the expected error [bin].
  /// @param gradient  unless null, adds `weight` times the gradient w.r.t. the curve, and writes
  ///   the unweighted gradient w.r.t. the electrons (R)
  double expected_error(const DecodingCurveOf<Value>& curve, const Value* electrons,
                        const SoftQuestion& question, Value weight = 0,
                        CurveGradientOf<Value>* gradient = nullptr, Value* by_electrons = nullptr);

  struct Scratch {
    explicit Scratch(int stride);
    Aligned<Value> match, ratio, score, place, free, share, error, by_match, by_next_match;
    std::vector<int> active;  ///< first points of vectors with a gradient
  };

 private:
  Scratch scratch_;
};
using SoftDecoder = SoftDecoderOf<float>;

}  // namespace tofsmith
