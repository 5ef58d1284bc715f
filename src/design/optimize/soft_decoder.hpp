// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "design/optimize/decoding_curve.hpp"

namespace tofsmith {

/// How the soft decoder decides: chord j of the curve is chosen with probability
///   exp(sharpness S_j) / sum,  S_j = 1/2 max(<y, p>, 0)^2 / |p|^2 at the best point of the chord.
struct SoftQuestion {
  double true_bin = 0.0;
  double sharpness = 1.0;  ///< times the inverse variance of y [1/e^2]
  bool circular = false;   ///< errors go the shorter way round
  bool is_signed = false;  ///< asks for the error itself, > 0 beyond true_bin, not for its size
};

/// Decodes measurements by zero-mean normalized cross-correlation, on all chords of the curve.
/// Keeps scratch memory: one per thread.
template <typename Value>
class SoftDecoderOf {
 public:
  explicit SoftDecoderOf(const DecodingCurveOf<Value>& curve);

  /// Position of the best point for the electrons (R), on the chords beside the best bin [bin].
  double decode(const DecodingCurveOf<Value>& curve, const Value* electrons);

  /// Expected error [bin]. With a gradient, adds `weight` times its own by the curve, and writes
  /// that by the electrons (R), unweighted.
  double expected_error(const DecodingCurveOf<Value>& curve, const Value* electrons,
                        const SoftQuestion& question);
  double expected_error(const DecodingCurveOf<Value>& curve, const Value* electrons,
                        const SoftQuestion& question, Value weight,
                        CurveGradientOf<Value>& gradient, Value* by_electrons);

  /// Lanes of scratch: one value per chord.
  struct Scratch {
    explicit Scratch(int stride);
    Aligned<Value> match, ratio, score, place, free, share, error, by_match, by_next_match;
  };

 private:
  Scratch scratch_;
};
using SoftDecoder = SoftDecoderOf<float>;

}  // namespace tofsmith
