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

/// Direct depth of pixels behind whose return light trails off, as in haze and translucent things:
///   y' = T o (S1 chi(z) + S2 integral_0^inf exp(-u / L) / L chi(z + u) du + A kappa) + noise,
/// S1 >= S2 >= 0, with the mean delay L = MultipathOptions::tail_m known. All else is as in
/// TwoReturnDecoder; a place tried is one depth with its tail, and only depth goes downhill.
///
/// Immutable and safe to use from many threads at once.
class TailDecoder {
 public:
  /// @throws std::invalid_argument if table or options are invalid, or the code holds too few
  ///         independent means: fewer than 5 (4 where ambient light cancels)
  explicit TailDecoder(DecodingTable table, const MultipathOptions& options = {});
  ~TailDecoder();
  TailDecoder(TailDecoder&&) noexcept;
  TailDecoder& operator=(TailDecoder&&) noexcept;

  const DecodingTable& table() const;
  const MultipathOptions& options() const;
  int measurements() const { return table().measurements(); }
  int samples() const { return table().samples(); }

  /// As TwoReturnDecoder::decode; delay is tail_m where a tail was found, ratio the light of all of
  /// the tail beside the direct return's.
  void decode(const RawView& raw, const DecodedView& decoded, const Progress& progress = {}) const;
  MultipathImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;
  void decode_depth_bins(const float* measurements, std::int64_t pixels, double* depth_bin) const;
  void decode_bins(const float* measurements, std::int64_t pixels, std::int32_t* bin) const;

 private:
  struct Plan;
  std::unique_ptr<const Plan> plan_;
};

}  // namespace tofsmith
