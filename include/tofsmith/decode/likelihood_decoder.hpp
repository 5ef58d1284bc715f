// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tofsmith/core/hidden.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

/// Decodes depth by maximum likelihood. With y' = electrons - dark, expected value and variance
///   mu_i(z, S, A) = T_i (S chi_i(z) + A kappa_i)
///   v_i(z, S, A)  = T_i (S shot_chi_i(z) + A shot_kappa_i) + shot_dark_i + constant_i,
/// and normal noise, the most likely depth z, signal S >= 0 and ambient light A >= 0 minimize
///   cost(z, S, A) = sum_i (y'_i - mu_i)^2 / v_i + log v_i.
/// The correlation functions are chords between bins: at a share t of the way to the next bin, mu
/// and v are linear in S (1 - t), S t and A. v_i is at least 1e-4 of the mean |y'_i|. If ambient
/// light cancels, A is 0. Among depths whose costs differ by less than 1e-9, the lowest is
/// returned.
///
/// Fisher scoring minimizes the cost from all bins at which a least squares fit, weighted by the
/// ZNCC estimate, has a local optimum. Iteratively reweighted least squares, in which the variance
/// is not part of the fit, is up to 2 % worse (ramps).
///
/// Planes of decode() are as from Decoder, except for
///   signal and ambient: the most likely ones;
///   deviation: from the Fisher information on (z, S, A) at the estimate, without the constraint
///     A >= 0, so it may be too large in the dark;
///   confidence: posterior probability of the main lobe around the most likely depth, with the
///     noise at the initial estimate.
///
/// Immutable and thread-safe.
/// @see docs/decoding.md
class LikelihoodDecoder final : public DepthDecoder {
 public:
  /// @throws InvalidArgument for invalid arguments
  explicit LikelihoodDecoder(DecodingTable table, const DecodeOptions& options = {});

  DecodeMethod method() const override { return DecodeMethod::ml; }
  const DecodingTable& table() const override;
  /// Allocates N numbers per call.
  void decode_depth_bins(const float* measurements, std::int64_t pixels,
                         double* depth_bin) const override;

 private:
  void decode_pixels(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress) const override;

  struct Plan;
  Hidden<const Plan> plan_;
};

}  // namespace tofsmith
