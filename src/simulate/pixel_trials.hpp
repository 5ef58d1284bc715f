// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "camera/shared/depth_prior.hpp"
#include "core/shared/random.hpp"
#include "simulate/pixel_capture.hpp"
#include "simulate/shared/depth_information.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/wrong_shares.hpp"

namespace tofsmith {

/// Depths that count as correct in a trial.
using TrueDepths = std::array<double, 2>;

/// Results of the trials at one operating point. Errors are differences from the nearest true
/// depth; circular ones are wrapped.
struct PixelSums {
  RunningStatistics linear_m, circular_m, circular_square_m2, bias_m;
  std::int64_t wrong = 0, wrong_ok = 0, wrong_inconsistent = 0, inconsistent = 0;

  void add(const TrueDepths& true_m, double depth_m, double deviation_m, PixelStatus status,
           double range_m);
  Estimate circular_rmse_m() const;
  WrongShares shares() const;
};

/// Means over operating points.
WrongShares mean_shares(const std::vector<WrongShares>& shares);

/// Draws single pixels at the operating points of a camera, and decodes them.
class PixelTrials {
 public:
  /// @param camera  see judged_camera()
  PixelTrials(const CodeSet& code, const Camera& camera, const EvaluateOptions& options);

  const ForwardModel& model() const { return model_; }
  const PixelCapture& pixel() const { return pixel_; }
  double range_m() const { return camera_.range_m(); }
  /// Surface at a quantile of the depths: (depth, signal).
  std::pair<double, double> draw_surface(double quantile, double signal_e_per_s,
                                         RandomStream& random) const;

  /// @param first_stream  number of the random stream of the first operating point
  /// @param draw  measures a trial: (random, quantile of its depth, operating point, raw), and
  ///   returns the true depths
  template <typename Draw>
  std::vector<PixelSums> run(std::size_t first_stream, const Draw& draw, const char* what,
                             const Progress& progress) const;

 private:
  void add_decoded(const RawFrames& raw, const std::vector<TrueDepths>& true_m,
                   PixelSums& sums) const;

  const Camera& camera_;
  const EvaluateOptions& options_;
  DepthPrior depths_;
  ForwardModel model_;
  PixelCapture pixel_;
  std::unique_ptr<const DepthDecoder> decoder_;
};

template <typename Draw>
std::vector<PixelSums> PixelTrials::run(std::size_t first_stream, const Draw& draw,
                                        const char* what, const Progress& progress) const {
  constexpr std::int64_t trials_at_once = 1 << 16;
  const std::vector<OperatingPoint> points = camera_.operating.points();
  const std::int64_t trials = options_.trials;
  std::vector<PixelSums> results(points.size());
  const ProgressParts parts(progress, points.size());
  for (std::size_t p = 0; p < points.size(); ++p)
    for (std::int64_t begin = 0; begin < trials; begin += trials_at_once) {
      report(parts[p], static_cast<double>(begin) / static_cast<double>(trials), what);
      const std::int64_t count = std::min(trials_at_once, trials - begin);
      RawFrames raw = empty_frames(1, 1, static_cast<int>(count), pixel_.measurements());
      std::vector<TrueDepths> true_m(static_cast<std::size_t>(count));
      parallel_for_blocks(count, 256, [&](IndexRange block) {
        for (std::int64_t i = block.begin; i < block.end; ++i) {
          const std::int64_t trial = begin + i;
          RandomStream random(options_.seed, first_stream + p, static_cast<std::uint32_t>(trial));
          const double quantile =
              (static_cast<double>(trial) + random.uniform()) / static_cast<double>(trials);
          true_m[static_cast<std::size_t>(i)] =
              draw(random, quantile, points[p], raw.values.data() + i * pixel_.measurements());
        }
      });
      add_decoded(raw, true_m, results[p]);
    }
  report(progress, 1.0, what);
  return results;
}

}  // namespace tofsmith
