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

/// What TwoReturnDecoder and TailDecoder share: a model of one return, and one of light that comes
/// later too for the pixels that one return does not explain.
///
/// Immutable and safe to use from many threads at once.
class MultipathDecoder {
 public:
  ~MultipathDecoder();
  MultipathDecoder(MultipathDecoder&&) noexcept;
  MultipathDecoder& operator=(MultipathDecoder&&) noexcept;

  const DecodingTable& table() const;
  const MultipathOptions& options() const;
  int measurements() const { return table().measurements(); }
  int samples() const { return table().samples(); }

  /// Decodes one frame on all threads into the caller's planes; as Decoder::decode for single and
  /// unresolved pixels. Where later light was found
  ///   depth, signal: of the direct return; ambient light: least squares beside both;
  ///   predicted standard deviation: from the Fisher information on (z, delta, S1, S2, A); S1 >= S2
  ///     is not counted as knowledge;
  ///   confidence: posterior probability against the best other fit at another direct depth;
  ///   delay, ratio: of the second return or of the tail, NaN where there is none;
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

 protected:
  struct Plan;
  explicit MultipathDecoder(std::unique_ptr<const Plan> plan);

 private:
  std::unique_ptr<const Plan> plan_;
};

}  // namespace tofsmith
