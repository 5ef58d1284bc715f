// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "tofsmith/core/hidden.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

/// Weights with which the depths of the frequencies are averaged. On a camera that attenuates high
/// frequencies, `frequency` can cause several times the depth error of `variance`.
enum class UnwrapWeights {
  variance,   ///< inverse variance of the depth, with the camera's transfer function
  frequency,  ///< f^2, as if all phases had the same noise
};

constexpr auto words_of(UnwrapWeights /*any*/) { return word_list("variance", "frequency"); }
/// @throws InvalidArgument for other words
inline UnwrapWeights parse_unwrap_weights(std::string_view name) {
  return parse_word<UnwrapWeights>("unwrap weights", name);
}

/// Options of UnwrapDecoder.
struct UnwrapOptions {
  DecodeOptions status_thresholds;
  UnwrapWeights weights = UnwrapWeights::variance;
  /// Upper limit, in [0, 1], for the share of a correlation function's variance outside its
  /// strongest harmonic. Functions above it are rejected: they are no sinusoids, and other
  /// harmonics cause depth errors.
  double largest_other_energy = 1e-3;

  /// @throws InvalidArgument
  void validate() const;
};

/// Decodes depth by phase unwrapping, the classical decoder of multi-frequency sinusoids:
///   1. Fit the phase of each frequency f by least squares.
///   2. Compute the candidates z_f = (phase_f + n) / f, with wraps n = 0, ..., f - 1. Phases are in
///      periods, depths in shares of the range.
///   3. Choose the combination of wraps that minimizes sum_f w_f (z_f - z)^2, where z is the
///      weighted mean of the candidates.
/// Frequencies and phase offsets are determined from the correlation functions, so that delay and
/// attenuation of the camera are compensated. Amplitudes are ignored.
///
/// Planes of decode() are as from Decoder, except for
///   deviation: noise at the estimate, propagated through phases and weights;
///   confidence: posterior probability of the main lobe around the depth of the chosen wraps,
///     from all measurements.
///
/// Immutable and thread-safe.
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 5, which compares with this decoder
class UnwrapDecoder final : public DepthDecoder {
 public:
  /// @throws InvalidArgument if the table or the options are invalid, a correlation function is not
  ///         a sinusoid, a frequency is measured in fewer than two phases, the offset cannot be
  ///         determined, or the frequencies have a common divisor
  explicit UnwrapDecoder(DecodingTable table, const UnwrapOptions& options = {});

  DecodeMethod method() const override { return DecodeMethod::unwrap; }
  const DecodingTable& table() const override;
  /// In multiples of f0, ascending.
  const std::vector<int>& frequencies() const;
  /// w_f, with sum 1.
  const std::vector<double>& weights() const;
  /// Allocates nothing.
  void decode_depth_bins(const float* measurements, std::int64_t pixels,
                         double* depth_bin) const override;

 private:
  void decode_pixels(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress) const override;

  struct Plan;
  Hidden<const Plan> plan_;
};

}  // namespace tofsmith
