// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "decode/ambient_projection.hpp"
#include "decode/multipath/multipath_search.hpp"
#include "decode/output/pixel_output.hpp"
#include "decode/raw_scale.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith {

/// Posterior of the direct depth, averaged over the prior of multipath returns.
struct DepthPosterior {
  double median = 0.0;     ///< [fine points], in [0, points)
  double deviation = 0.0;  ///< [fine points]
};

/// Posterior of direct depth around a single fit, under a prior on the second return or on the
/// ratio of the tail.
class ReturnPosterior {
 public:
  ReturnPosterior(const MultipathCurve& curve, const ReturnPrior& prior, double range_m,
                  const DelayBounds& delays);

  /// @param position  of the single fit [fine points]
  DepthPosterior around(const MultipathCurve& curve, const PixelGroup& pixels, int lane,
                        double position) const;

 private:
  double single_probability_;
  int reach_;                  // [fine points]
  std::vector<int> delay_;     // with equal probabilities [fine points]; a single 0 for a tail
  std::vector<double> ratio_;  // with equal probabilities
};

/// Light in addition to the direct return.
enum class MultipathKind { second_return, tail };

/// Decodes up to two returns: a search finds a second return in pixels that a single fit does not
/// explain.
class MultipathEngine {
 public:
  /// @throws std::invalid_argument if table or options are invalid or the code is not sufficient
  MultipathEngine(DecodingTable table, const MultipathOptions& options, MultipathKind later);

  const DecodingTable& table() const { return single_.table(); }
  MultipathKind kind() const { return kind_; }

  /// @param parts  parts of the range for the direct returns, one per pixel; null: anywhere
  void decode(const RawView& raw, const RangePart* parts, const DecodedView& decoded,
              const Progress& progress) const;
  void decode_depth_bins(const float* measurements, std::int64_t pixels, double* depth_bin) const;

 private:
  struct Queue;
  void decode_block(const RawBlock& raw, const RangePart* parts, const DecodedView& decoded) const;
  void load(const RawBlock& raw, std::int64_t pixel, float depth_m, int lane,
            PixelGroup& group) const;
  void load_part(const RangePart& part, int lane, PixelGroup& group) const;
  void search(Queue& queue, const RawBlock& raw, const RangePart* parts,
              const DecodedView& decoded) const;
  bool is_within(const PixelGroup& group, double position, int lane) const;
  void store(std::int64_t pixel, const PixelGroup& group, const PairFits& fits, int lane,
             const DecodedView& decoded) const;
  double ambient_e_per_s(const PixelGroup& group, const PairFits& fits, int lane) const;
  void replace_light(const PixelGroup& group, const PairFits& fits, int lane, std::size_t at,
                     const DecodedView& decoded) const;
  bool is_single(float chi2) const { return !(chi2 > static_cast<float>(options_.threshold)); }

  MultipathEngine(DecodingTable table, const MultipathOptions& options, MultipathKind later,
                  const AmbientProjection& projection);

  MultipathOptions options_;
  MultipathKind kind_;
  Decoder single_;
  RawScale scale_;
  ExpectedNoise noise_;
  bool has_own_shot_noise_;  // from light that cancels in the measurements
  Eigen::VectorXd ambient_;
  RowMajorMatrix gated_, gated_tail_;
  MultipathCurve curve_;
  DelayBounds delays_;
  float unexplained_chi2_;  // upper limit for a single return
  int freedom_;
  double consistent_chi2_ = std::numeric_limits<double>::infinity();  // upper limit for both
  std::optional<ReturnPosterior> posterior_;
};

/// Checks that there are enough independent means for the unknowns (5; for a tail of known delay 4)
/// and one more to test the fit. Returns an error with a remedy; none if they suffice.
std::optional<BrokenRule> missing_support(const AmbientProjection& projection, MultipathKind later);

}  // namespace tofsmith
