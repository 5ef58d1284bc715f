// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "tofsmith/camera/second_returns.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/random.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/decode/two_return_decoder.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/fine_correlation.hpp"
#include "tofsmith/simulate/noise.hpp"

namespace tofsmith {

/// True and decoded positions of some trials, [bin] in [0, N).
struct TrialBlock {
  std::int64_t block = 0;  ///< number of the block, 0 .. blocks() - 1
  std::span<const double> true_bin;
  std::span<const double> decoded_bin;
};

/// The Monte Carlo loop behind every depth error: draw depth and noise, decode.
class DepthTrials {
 public:
  DepthTrials(const ForwardModel& model, const Camera& camera, const EvaluateOptions& options);
  /// Decoded by what a decoder believes of the camera, of as many measurements and samples.
  DepthTrials(const ForwardModel& model, const Camera& camera, const EvaluateOptions& options,
              DecodingTable believed);

  /// From now on every trial has a second return, too.
  void add_second_returns(const SecondReturns& later) { later_ = later; }
  /// From now on trials are decoded as two returns.
  void decode_as(TwoReturnDecoder decoder) { two_return_.emplace(std::move(decoder)); }

  int samples() const { return samples_; }
  int measurements() const { return noise_.measurements(correlation_.tap_values()); }
  std::int64_t trials() const { return options_.trials; }
  std::int64_t blocks() const;
  const std::vector<OperatingPoint>& points() const { return points_; }

  /// Runs all trials of a point on all threads and hands them over block by block, an even number
  /// of trials in each; blocks may come at the same time and in any order.
  void run(std::size_t point, const std::function<void(const TrialBlock&)>& use,
           const Progress& progress) const;

 private:
  void run_block(std::size_t point, IndexRange trials, std::vector<double>& true_bin,
                 std::vector<double>& decoded_bin) const;
  void add_second_return(double true_bin, RandomStream& random, std::vector<double>& value,
                         std::vector<double>& second) const;
  void decode(const std::vector<float>& raw, std::vector<double>& decoded_bin) const;

  EvaluateOptions options_;
  int samples_;
  bool uniform_albedo_;
  double albedo_;
  double dark_e_per_s_;
  std::vector<OperatingPoint> points_;
  FineCorrelation correlation_;
  PixelNoise noise_;
  AnyDecoder decoder_;
  std::optional<TwoReturnDecoder> two_return_;  ///< instead of decoder_
  std::optional<SecondReturns> later_;
  double range_m_;
  Eigen::VectorXd exposure_s_, ambient_gain_;  // of the tap values
};

}  // namespace tofsmith
