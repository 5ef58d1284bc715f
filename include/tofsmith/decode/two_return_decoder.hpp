// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/raw_view.hpp"
#include "tofsmith/decode/multipath_image.hpp"
#include "tofsmith/decode/multipath_options.hpp"

namespace tofsmith {

/// Direct depth of pixels into which light may come back twice:
///   y' = electrons - dark = T o (S1 chi(z) + S2 chi(z + delta) + A kappa) + noise,  S1 >= S2 >= 0.
///
/// The fast Decoder fits one return. Its chi^2, weighted by the noise of the measurements and
/// counted in the dimensions the code spans (what ambient light explains left out), is all that a
/// second return could explain: up to the threshold the pixel is single and keeps what Decoder
/// says. Else two returns are fitted by weighted least squares, the likelihood of normal noise: all
/// pairs of coarse places are tried in closed form, the best three followed by Levenberg-Marquardt
/// on (z, delta). Two returns are accepted if chi^2 falls by more than the threshold below the best
/// single return's anywhere. S2 <= S1 is needed: without it a phantom early return explains pixels
/// of one return.
///
/// The noise of a measurement is taken from itself: max(y', 0) + dark + constant variance. Curves
/// between bins are drawn by cubics where that foretells the table better than chords do.
///
/// Immutable and safe to use from many threads at once.
/// @see docs/multipath.md
class TwoReturnDecoder {
 public:
  /// @throws std::invalid_argument if table or options are invalid, or the code holds too few
  ///         independent means: fewer than 6 (5 where ambient light cancels), as codes of two
  ///         frequencies do
  explicit TwoReturnDecoder(DecodingTable table, const MultipathOptions& options = {});
  ~TwoReturnDecoder();
  TwoReturnDecoder(TwoReturnDecoder&&) noexcept;
  TwoReturnDecoder& operator=(TwoReturnDecoder&&) noexcept;

  const DecodingTable& table() const;
  const MultipathOptions& options() const;
  int measurements() const { return table().measurements(); }
  int samples() const { return table().samples(); }

  /// Decodes one frame on all threads into the caller's planes; as Decoder::decode for single and
  /// unresolved pixels. For two returns
  ///   depth, signal: of the direct return; ambient light: least squares beside both;
  ///   predicted standard deviation: from the Fisher information on (z, delta, S1, S2, A); S1 >= S2
  ///   is
  ///     not counted as knowledge;
  ///   confidence: posterior probability against the best other fit at another direct depth;
  ///   delay, ratio: of the second return, NaN where there is none;
  ///   returns: ReturnStatus; PixelStatus stays what Decoder says.
  /// With a prior, depth and deviation are the posterior's where one return does not explain the
  /// pixel.
  /// @throws std::invalid_argument if the shape does not fit; Interrupted if progress says so
  /// @note the same bits for any number of threads; processors without fused multiply-add differ in
  ///       the last ones
  void decode(const RawView& raw, const DecodedView& decoded, const Progress& progress = {}) const;
  /// The same for frame `frame` of several (F, H, W, K), into a new image.
  MultipathImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// Positions in [0, N) of many pixels; see Decoder::decode_depth_bins. NaN also without return.
  void decode_depth_bins(const float* measurements, std::int64_t pixels, double* depth_bin) const;
  /// The nearest bins in [0, N), -1 where there is none.
  void decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace tofsmith
