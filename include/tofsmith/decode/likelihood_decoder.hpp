// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
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
/// Immutable and thread-safe.
/// @see docs/decoding.md
class LikelihoodDecoder {
 public:
  /// @throws InvalidArgument for invalid arguments
  explicit LikelihoodDecoder(DecodingTable table, const DecodeOptions& options = {});
  ~LikelihoodDecoder();
  LikelihoodDecoder(LikelihoodDecoder&&) noexcept;
  LikelihoodDecoder& operator=(LikelihoodDecoder&&) noexcept;

  const DecodingTable& table() const;
  const DecodeOptions& options() const;
  int measurements() const { return table().measurements(); }
  int samples() const { return table().bin_count(); }

  /// Decodes one frame as Decoder::decode(), except for
  ///   signal and ambient: the most likely ones;
  ///   deviation: from the Fisher information on (z, S, A) at the estimate, without the constraint
  ///     A >= 0, so it may be too large in the dark;
  ///   confidence: posterior probability of the main lobe around the most likely depth, with the
  ///     noise at the initial estimate.
  void decode(const RawView& raw, const DecodedView& decoded, const Progress& progress = {}) const;
  /// See Decoder.
  void decode_within(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress = {}) const;
  DepthImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// See Decoder::decode_depth_bins().
  /// @note single-threaded; allocates N numbers per call, nothing per pixel
  void decode_depth_bins(const float* measurements, std::int64_t pixels, double* depth_bin) const;
  /// Nearest bins in [0, N); -1 if a measurement is NaN or infinite.
  void decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace tofsmith
