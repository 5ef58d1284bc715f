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
#include "simulate/depth_trials.hpp"
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

/// Calls use(cell, mass, by_depth, part) for the cells of the range in which depth can be decoded:
/// with the probability of the cell, the derivative of the measurements with respect to depth, and
/// its component orthogonal to the derivatives with respect to signal and ambient light.
/// @param camera  the camera of `model`
/// @param cells  from default_cells_per_bin()
template <typename Use>
void for_each_depth_cell(const ForwardModel& model, const Camera& camera, Eigen::Index cells,
                         const Use& use) {
  Eigen::MatrixXd signal, slope;
  middles_and_slopes(
      model.correlation_table(static_cast<int>(2 * cells)) * model.exposure_s().asDiagonal(),
      signal, slope);
  const Eigen::VectorXd ambient =
      model.exposure_s().cwiseProduct(unknown_ambient_gain(model, camera));
  const Eigen::VectorXd masses = DepthPrior(camera).masses(cells);
  for (Eigen::Index j = 0; j < cells; ++j) {
    const Eigen::VectorXd by_depth = slope.row(j);
    const DepthPart<Eigen::VectorXd> part(by_depth, signal.row(j), ambient);
    if (part.length > 0.0)
      use(j, masses.size() > 0 ? masses[j] : 1.0 / static_cast<double>(cells), by_depth, part);
  }
}

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

/// Sums over pairs of trials in neighbouring slices, for means and mean squares with variances
/// (collapsed strata).
struct ErrorSums {
  TileSums sums;
  std::int64_t trials = 0;

  void merge(const ErrorSums& other);
  Estimate linear(double bin_m) const;
  Estimate circular(double bin_m) const;
  Estimate linear_rms(double bin_m) const;
  Estimate circular_rms(double bin_m) const;
  Estimate outlier_rate() const;
};

/// Outliers are circular errors beyond the threshold.
std::vector<ErrorSums> sum_errors(const DepthTrials& trials, std::span<const TrialRound> rounds,
                                  double threshold_bin, const Progress& progress);

template <typename Point>
DepthErrorMean mean_over_points(const std::vector<Point>& points, Estimate Point::*error) {
  std::vector<Estimate> errors;
  for (const Point& point : points) errors.push_back(point.*error);
  return {geometric_mean_of(errors), mean_of(errors)};
}

/// Returns depth errors without bounds.
/// @param code, camera  of the trials
DepthErrorReport trial_errors(const DepthTrials& trials, const CodeSet& code, const Camera& camera,
                              const EvaluateOptions& options, const Progress& progress);

}  // namespace tofsmith
