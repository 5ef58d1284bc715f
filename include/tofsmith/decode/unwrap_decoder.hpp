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

/// How much the depth of each frequency counts. Measured on multifrequency-k5 (S = 1e5, A = 1e2
/// e/s; circular mean depth error): without band limit both are within 2 % of ZNCC (7.9 against
/// 7.8 mm); at 10 f0, where a quarter of the amplitude of 7 f0 is left, ZNCC has 25.7 mm,
/// variance 26.2 and frequency 33.2; at 5 f0, where next to nothing is, 44.9, 44.9 and 351 mm.
enum class UnwrapWeights {
  variance,   ///< by the inverse variance of its depth, through the camera's transfer function
  frequency,  ///< by f^2, as if all phases were equally noisy: the classical choice
};

constexpr std::array<std::string_view, 2> words_of(UnwrapWeights /*any*/) {
  return {"variance", "frequency"};
}
/// "variance", "frequency".
std::string_view name_of(UnwrapWeights weights);
/// @throws std::invalid_argument for any other word
UnwrapWeights parse_unwrap_weights(std::string_view name);

/// How phases become depths, and the thresholds of a pixel's status.
struct UnwrapOptions {
  DecodeOptions status_thresholds;
  UnwrapWeights weights = UnwrapWeights::variance;
  /// A correlation function is a sinusoid if no more than this share of its variance is outside its
  /// strongest harmonic; in [0, 1]. What is there turns into an error of depth.
  double largest_other_energy = 1e-3;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// Depth by phase unwrapping, the classical decoder of multi-frequency sinusoids:
///   1. the phase of each frequency, by least squares over offset, cosine and sine;
///   2. candidate depths of each frequency, z_f = (phase_f + n) / f of the range, n = 0 .. f - 1;
///   3. the candidates, one per frequency, of the least weighted distance sum_f w_f (z_f - z)^2;
///   4. z = their weighted mean.
/// Frequencies are found in the correlation functions, and phases are calibrated by them, so that
/// delay and attenuation of the camera are taken out. All choices of wraps are compared.
///
/// Against ZNCC on the same code it ignores that all frequencies see the same signal: amplitudes
/// are not used. Weights by frequency also ignore that a camera attenuates high frequencies.
///
/// Immutable and safe to use from many threads at once.
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 5, which compares with it
class UnwrapDecoder {
 public:
  /// @throws std::invalid_argument if the table or the options are invalid; if a correlation
  ///         function is no sinusoid; if a frequency is not measured in two phases, or the offset
  ///         in none; if the frequencies share a divisor, with the range that is unambiguous
  explicit UnwrapDecoder(DecodingTable table, const UnwrapOptions& options = {});
  ~UnwrapDecoder();
  UnwrapDecoder(UnwrapDecoder&&) noexcept;
  UnwrapDecoder& operator=(UnwrapDecoder&&) noexcept;

  const DecodingTable& table() const;
  const UnwrapOptions& options() const;
  int measurements() const { return table().measurements(); }
  int samples() const { return table().bin_count(); }
  /// In multiples of f0, ascending.
  const std::vector<int>& frequencies() const;
  /// w_f of each frequency, scaled to sum 1.
  const std::vector<double>& weights() const;

  /// Decodes one frame on all threads into the caller's planes; as Decoder::decode, but for
  ///   predicted standard deviation: noise at the estimate, carried through phases and weights;
  ///   confidence: posterior probability of the main lobe around the depth of the chosen wraps,
  ///     from all measurements.
  void decode(const RawView& raw, const DecodedView& decoded, const Progress& progress = {}) const;
  /// As Decoder::decode_within().
  void decode_within(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress = {}) const;
  /// The same for frame `frame` of several (F, H, W, K), into a new image.
  DepthImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// Positions in [0, N) of many pixels; see Decoder::decode_depth_bins.
  /// @note single-threaded; allocates nothing
  void decode_depth_bins(const float* measurements, std::int64_t pixels, double* depth_bin) const;
  /// The nearest bins in [0, N), -1 where a measurement is NaN or infinite.
  void decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace tofsmith
