// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

/// Weights with which the depths from the individual frequencies are averaged. Circular mean depth
/// errors of multifrequency-k5 at S = 1e5, A = 1e2 e/s:
///   band limit  amplitude of 7 f0  ZNCC     variance  frequency
///   none        all                7.8 mm   7.9 mm    7.9 mm
///   10 f0       a quarter          25.7 mm  26.2 mm   33.2 mm
///   5 f0        almost none        44.9 mm  44.9 mm   351 mm
enum class UnwrapWeights {
  variance,   ///< inverse variance of the depth, computed with the camera's transfer function
  frequency,  ///< f^2, as if all phases had the same noise: the classical choice
};

constexpr std::array<std::string_view, 2> words_of(UnwrapWeights /*any*/) {
  return {"variance", "frequency"};
}
/// "variance", "frequency".
std::string_view name_of(UnwrapWeights weights);
/// @throws std::invalid_argument for any other word
UnwrapWeights parse_unwrap_weights(std::string_view name);

/// Options of phase unwrapping, and the thresholds of a pixel's status.
struct UnwrapOptions {
  DecodeOptions status_thresholds;
  UnwrapWeights weights = UnwrapWeights::variance;
  /// Upper limit, in [0, 1], for the share of a correlation function's variance that is not in its
  /// strongest harmonic. Functions above the limit are rejected, because they are no sinusoids and
  /// other harmonics cause depth errors.
  double largest_other_energy = 1e-3;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// Decodes depth by phase unwrapping, the classical decoder of multi-frequency sinusoids:
///   1. Fit offset, cosine and sine of each frequency by least squares; compute its phase.
///   2. Compute the candidate depths of each frequency f, z_f = (phase_f + n) / f with wraps n = 0,
///      ..., f - 1. Phases are in periods, depths in shares of the range.
///   3. Choose one candidate per frequency to minimize sum_f w_f (z_f - z)^2. All combinations of
///      wraps are compared.
///   4. z is their weighted mean.
/// Frequencies and phase offsets are determined from the correlation functions, so that delay and
/// attenuation of the camera are compensated.
///
/// Unlike ZNCC, the method ignores the information in the amplitudes, which follow from a signal
/// that is the same for all frequencies. Weights by frequency also ignore that a camera attenuates
/// high frequencies.
///
/// Immutable and thread-safe.
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 5, which compares with this decoder
class UnwrapDecoder {
 public:
  /// @throws std::invalid_argument if the table or the options are invalid, a correlation function
  ///         is not a sinusoid, a frequency is measured in fewer than two phases, the offset cannot
  ///         be determined, or the frequencies have a common divisor. In the last case, the message
  ///         contains the unambiguous range.
  explicit UnwrapDecoder(DecodingTable table, const UnwrapOptions& options = {});
  ~UnwrapDecoder();
  UnwrapDecoder(UnwrapDecoder&&) noexcept;
  UnwrapDecoder& operator=(UnwrapDecoder&&) noexcept;

  const DecodingTable& table() const;
  const UnwrapOptions& options() const;
  int measurements() const { return table().measurements(); }
  int samples() const { return table().bin_count(); }
  /// Frequencies in multiples of f0, ascending.
  const std::vector<int>& frequencies() const;
  /// Weights w_f of the frequencies, with sum 1.
  const std::vector<double>& weights() const;

  /// Decodes one frame as Decoder::decode(), except for
  ///   predicted standard deviation: noise at the estimate, propagated through phases and weights;
  ///   confidence: posterior probability of the main lobe around the depth of the chosen wraps,
  ///     from all measurements.
  void decode(const RawView& raw, const DecodedView& decoded, const Progress& progress = {}) const;
  /// See Decoder::decode_within().
  void decode_within(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress = {}) const;
  /// Decodes frame `frame` of a stack (F, H, W, K) into a new image.
  DepthImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// Computes the positions of many pixels in [0, N); see Decoder::decode_depth_bins().
  /// @note single-threaded; allocates nothing
  void decode_depth_bins(const float* measurements, std::int64_t pixels, double* depth_bin) const;
  /// Computes the nearest bins in [0, N); -1 if a measurement is NaN or infinite.
  void decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace tofsmith
