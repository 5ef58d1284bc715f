// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/decode/range_part.hpp"

namespace tofsmith {

struct DecoderParts;

/// Thresholds that determine the status of a pixel.
struct DecodeOptions {
  double low_signal_sigma = 3.0;
  /// Lower limit on the posterior probability of the main lobe.
  double min_confidence = 0.9;
  double false_alarm_rate = 1e-3;
  /// Root mean square error of the expected measurements, relative to their part that is due to the
  /// signal.
  double model_error_percent = 0.0;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<DecodeOptions> auto& o) {
  return std::tuple(Field("low_signal_sigma", o.low_signal_sigma, at_least(0),
                          Help{"signal below which a pixel is marked low_signal"}),
                    Field("min_confidence", o.min_confidence, closed(0, 1),
                          Help{"confidence below which a pixel is marked ambiguous"}),
                    Field("false_alarm_rate", o.false_alarm_rate, right_open(0, 1),
                          Help{"share of consistent pixels that are marked inconsistent; 0: none"}),
                    Field("model_error_percent", o.model_error_percent, closed(0, 100),
                          Help{"tolerated error of the camera model, such as wiggling, relative to "
                               "the signal; a larger value of the table replaces it"}));
}

/// Decodes depth by zero-mean normalized cross-correlation, with the ambient component projected
/// out instead of the mean:
///   y' = electrons - dark,  a = T o kappa,  x(z) = T o chi(z),  P = I - a a^T / |a|^2
///   z_hat = argmax_z (P y') . (P x(z)) / |P x(z)|
/// o is the element-wise product. Terms of the table are explained in DecodingTable. The maximum is
/// taken over all rows with contrast. Scores within 1e-11 |P y'| of the best score are ties, which
/// the lowest row wins. The depth is then refined between rows. In a smooth table, it is the
/// maximum of the pixel's own correlation. Otherwise, it is the best point on the chords, the
/// straight lines from x(z_hat) to both adjacent rows. The bin always equals the result of double
/// precision arithmetic. It does not depend on the type of the raw numbers, the processor or the
/// number of threads.
///
/// Immutable and thread-safe.
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 3; deviates: projects out ambient, not the mean
class Decoder {
 public:
  /// @throws std::invalid_argument if the table or the options are invalid
  explicit Decoder(DecodingTable table, const DecodeOptions& options = {});
  ~Decoder();
  Decoder(Decoder&&) noexcept;
  Decoder& operator=(Decoder&&) noexcept;

  const DecodingTable& table() const;
  const DecodeOptions& options() const;
  int measurements() const { return table().measurements(); }
  int samples() const { return table().bin_count(); }
  /// Dimension of the space that P x(z) spans, 2 to K.
  int rank() const;

  /// Decodes one frame on all threads into the caller's planes. Allocates no planes.
  ///   bin: the best bin, as in decode_bins();
  ///   signal and ambient: least squares fit of y' to x(z_hat) and a;
  ///   predicted standard deviation: noise of the measurements, propagated through the least
  ///     squares problem in (z, S, A) that z_hat solves. The variance of the noise is that of the
  ///     estimated light, mu_i + constant variance. Each chord is divided into quarters, and the
  ///     noise at the middle of the estimate's quarter is used;
  ///   confidence: posterior probability that the depth lies in the main lobe. A priori, all depths
  ///     are equally likely, the ambient light may have any value, and the density of the signal is
  ///     proportional to 1/S from a tenth of its standard deviation upwards. The noise is that at
  ///     the best bin. The main lobe is the run of bins around the best one along which the score
  ///     of noiseless measurements at the best bin decreases. It extends at most 5 % of the range
  ///     to either side. The confidence is 1 if a bound proves that the probability of all other
  ///     depths is at most about 1e-3;
  ///   residual: chi-square, per degree of freedom, of the difference between the measurements and
  ///     those expected for the decoded light;
  ///   status: see PixelStatus. A pixel is inconsistent if its residual exceeds the chi-square
  ///     quantile of false_alarm_rate by more than a model error of model_error_percent can cause.
  ///     low_signal depends on the noise at the best bin. If the measurements without the ambient
  ///     component are below 1e-12 of sum_i |y'_i|, they count as 0 and the pixel is no_return.
  /// All planes except `bin` are computed in single precision. The rounding error of depth is about
  /// 1e-7 / (angle between adjacent bins) bins. That of signal and ambient light is about 1e-6 of
  /// the brightest measurement. Pixels that are invalid or have no return are NaN in all planes of
  /// floats; the bin is -1 only for invalid pixels.
  /// @param raw      electrons or counts, with as many measurements as the table
  /// @param decoded  planes of the same height and width; null planes are skipped and do not affect
  ///                 the values of the others
  /// @throws std::invalid_argument if the shape does not match; Interrupted if `progress` requests
  ///         it
  /// @note the same bits for any number of threads, any layout of the raw numbers and any processor
  void decode(const RawView& raw, const DecodedView& decoded, const Progress& progress = {}) const;
  /// Decodes as decode(), with only the depths within a part of the range as candidates. Candidates
  /// are maxima of the correlation (in other methods: minima of the cost), so that depths do not
  /// accumulate at the ends of a part. The confidence assumes that depths outside the part are 100
  /// times less frequent. Pixels without a candidate, and pixels whose depth lies outside the part
  /// with a probability of at least 0.9, are no_return.
  /// @param parts  one per pixel, row by row
  void decode_within(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
                     const Progress& progress = {}) const;
  /// Decodes frame `frame` of a stack (F, H, W, K) into a new image.
  DepthImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// Computes the positions of many pixels in [0, N), refined between bins in double precision.
  /// Intended for Monte Carlo loops. Returns the best position even if its score is not positive.
  /// @param measurements  raw numbers (pixels, K); measurements of a pixel are contiguous
  /// @param depth_bin     (pixels); NaN if a measurement is NaN or infinite
  /// @note single-threaded; allocates nothing
  void decode_depth_bins(const float* measurements, std::int64_t pixels, double* depth_bin) const;
  /// Computes the best bins in [0, N), without refinement. The best bin is not always the one
  /// nearest to the refined position. -1 if a measurement is NaN or infinite.
  void decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const;

 private:
  friend DecoderParts parts_of(const Decoder& decoder);

  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace tofsmith
