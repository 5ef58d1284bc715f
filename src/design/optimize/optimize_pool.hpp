// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/shared/random.hpp"
#include "core/shared/shared_progress.hpp"
#include "design/optimize/code_score.hpp"
#include "design/optimize/design_problem.hpp"
#include "tofsmith/design/optimize.hpp"

namespace tofsmith {

/// Stochastic gradient descent whose steps are scaled by running means of the gradient and of its
/// square.
/// @see Kingma and Ba, "Adam: a method for stochastic optimization", ICLR 2015
class Adam {
 public:
  /// Steps `values` against `gradient`, of the same shape at every call; entries that are not
  /// finite count as 0.
  void step(Eigen::MatrixXd& values, const Eigen::MatrixXd& gradient, double rate);

 private:
  static constexpr double mean_decay_ = 0.9, square_decay_ = 0.99;
  Eigen::ArrayXXd mean_, square_;
  double mean_power_ = 1.0, square_power_ = 1.0;
};

/// How waveforms go downhill. Waveforms and decoder begin soft and sharpen on the way.
struct DescentSchedule {
  int steps = 300;
  int trials_per_step = 360;  ///< over all light levels
  double rate = 0.08;         ///< of the parameters, where waveforms are soft
  Sharpness final_sharpness{6.0, 8.0};
  double soft_share = 0.4;  ///< of the steps, before waveforms begin to sharpen
  double decision_sharpness_begin = 1.0,
         decision_sharpness_end = 3.0;  ///< sharpness of decisions per log likelihood
};

/// Parameters of lower error. Draws from the streams (seed, work item, step).
/// @param progress called at every step
WaveformParameters descend(const DesignProblem& problem, WaveformParameters parameters,
                           const DescentSchedule& schedule, std::uint64_t seed,
                           std::uint64_t work_item, SharedProgress* progress = nullptr);

/// A code that descents have found.
struct PoolEntry {
  WaveformParameters parameters;
  CodeScore score;
  std::string start;  ///< where it began
};

/// A jump out of a basin of the error: one of the best of the pool, softened, with one pair of
/// waveforms replaced (by a random one, or by one of another entry) or its gates rotated against
/// its light, and noise on all.
/// @param pool  best first, not empty
/// @return parameters to descend from, and where they began
PoolEntry hop(const DesignProblem& problem, const std::vector<PoolEntry>& pool,
              RandomStream& random);

/// Parameters no further from soft than `limit`, so that a descent can change them again.
WaveformParameters softened(WaveformParameters parameters, double limit);

/// How much is tried of one stage of a search: in all, with the stages before it.
struct PoolStage {
  int starts = 0, hops = 0;
  int refinement_steps = 0;  ///< of this stage alone
};

/// Codes that descents from many starts lead to, best first, with what happened on the way. A stage
/// after others goes on where they ended.
class OptimizePool {
 public:
  OptimizePool(const DesignProblem& problem, const OptimizeOptions& options, double bin_m);

  /// Descends from all starts.
  void run_starts(const PoolStage& stage, std::span<const CodeSet> also, const Progress& progress);
  /// Descends from changed copies of the best, until hops or patience end.
  void run_hops(const PoolStage& stage, const Progress& progress);
  /// Descends once more, from softened copies of the best; keeps the better of each.
  void refine(const PoolStage& stage, const Progress& progress);

  const std::vector<PoolEntry>& entries() const { return entries_; }
  /// The least error so far after every descent.
  const std::vector<SearchStep>& history() const { return history_; }
  std::int64_t steps() const { return steps_; }
  bool ended_early() const { return ended_early_; }
  const CodeJudge& judge() const { return judge_; }
  /// Adds a descent to the history.
  void record(double log_error_bin);

 private:
  void descend_all(std::vector<PoolEntry>& entries, int steps, double rate, std::uint64_t phase,
                   std::size_t first_item, SharedProgress& progress) const;
  void keep(std::vector<PoolEntry> entries);

  const DesignProblem* problem_;
  OptimizeOptions options_;
  double bin_m_;
  CodeJudge judge_;
  std::vector<PoolEntry> entries_;
  std::vector<SearchStep> history_;
  std::int64_t steps_ = 0;
  std::size_t starts_done_ = 0, hops_done_ = 0, refinements_done_ = 0;
  bool ended_early_ = false;
};

}  // namespace tofsmith
