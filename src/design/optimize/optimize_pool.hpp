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
#include "design/optimize/depth_error_loss.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/optimize_starts.hpp"
#include "design/optimize/trial_batch.hpp"
#include "tofsmith/design/optimize.hpp"

namespace tofsmith {

struct CodeScore {
  double log_error_bin = 0.0;  ///< mean over light levels, for the worst variant
  int rotation_bin = 0;        ///< rotation of this error; 0 if irrelevant
};

/// Evaluates codes by the error of the hard decoder, on common trials. For the linear error or
/// weighted depths, one set of trials determines the best rotation and another one the error there.
class CodeJudge {
 public:
  /// @param trials  per light level
  CodeJudge(const DesignProblem& problem, int trials, std::uint64_t seed, std::uint64_t work_item);

  CodeScore score(const SampledCode& code) const;

 private:
  double log_error(const SampledCode& code) const;
  int best_rotation(const SampledCode& code) const;

  const DesignProblem* problem_;
  std::vector<TrialBatch> judging_;
  std::vector<TrialBatch> rotating_;  // uniform depths, for the rotation
};

/// Stochastic gradient descent with steps scaled by running means of the gradient and its square.
/// @see Kingma and Ba, "Adam: a method for stochastic optimization", ICLR 2015
class Adam {
 public:
  /// Non-finite gradients count as 0.
  void step(Eigen::MatrixXd& values, const Eigen::MatrixXd& gradient, double rate);

 private:
  static constexpr double mean_decay_ = 0.9, square_decay_ = 0.99;
  Eigen::ArrayXXd mean_, square_;
  double mean_power_ = 1.0, square_power_ = 1.0;
};

/// Waveforms and decoder become sharper.
struct DescentSchedule {
  int steps = 300;
  int trials_per_step = 360;  ///< over all light levels
  double rate = 0.08;         ///< of the parameters, while waveforms are soft
  Sharpness final_sharpness{6.0, 8.0};
};

/// Returns parameters with a lower error; uses random streams (seed, work item, step).
WaveformParameters descend(const DesignProblem& problem, WaveformParameters parameters,
                           const DescentSchedule& schedule, std::uint64_t seed,
                           std::uint64_t work_item, SharedProgress* progress = nullptr);

/// Returns the sharpness of waveforms at the end of descents: 1 for arms that are not binary.
Sharpness final_sharpness(const DesignProblem& problem);

/// Returns up to `count` mixtures of different frequencies with the smallest errors, best first.
std::vector<OptimizeStart> best_mixtures(const DesignProblem& problem, std::ptrdiff_t count,
                                         std::uint64_t seed, const Progress& progress = {});

struct PoolEntry {
  WaveformParameters parameters;
  CodeScore score;
  std::string start;            ///< name; random starts share one
  std::size_t start_index = 0;  ///< differs between all starts
};

/// Returns the indices of up to `count` entries, best first, with at most `of_each` from the same
/// start. Without this limit, most entries are from the best start.
std::vector<std::size_t> best_of_starts(const std::vector<PoolEntry>& pool, std::size_t count,
                                        std::ptrdiff_t of_each);

int trials_per_level(const DesignProblem& problem, const OptimizeOptions& options);

/// Starts and hops include earlier stages.
struct PoolStage {
  int starts = 0, hops = 0;
  int refinement_steps = 0;  ///< of this stage only
  int refined = 0;           ///< entries that are continued and refined
};

/// Codes from descents, best first, with the history of the search.
class OptimizePool {
 public:
  /// @param also  starts, if they fit the space
  OptimizePool(const DesignProblem& problem, const OptimizeOptions& options,
               std::span<const CodeSet> also, double bin_m);

  /// Descends from known codes and then from random ones, ten at a time, until the best of them is
  /// too poor for the remaining steps to make it better than `rival_m`.
  /// @param rival_m  smallest error of another search for the same camera, or infinity
  void run_starts(const PoolStage& stage, double rival_m, const Progress& progress);
  /// Descends from the best entries and then from perturbed copies, until hops or patience are used
  /// up, or until the best entry is unlikely to become better than `rival_m`.
  void run_hops(const PoolStage& stage, double rival_m, const Progress& progress);
  /// Descends from softened copies of the best entries; keeps the better of each.
  void refine(const PoolStage& stage, const Progress& progress);
  /// Descends from softened copies of the best entries, jointly over waveforms and exposure shares,
  /// from equal shares. The results do not become entries.
  std::vector<PoolEntry> with_free_shares(const PoolStage& stage, const Progress& progress);

  const std::vector<PoolEntry>& entries() const { return entries_; }
  const std::vector<SearchStep>& history() const { return history_; }
  std::int64_t steps() const { return steps_; }
  void add_steps(std::int64_t steps) { steps_ += steps; }
  bool ended_early() const { return ended_early_; }
  bool lost_to_rival() const { return lost_to_rival_; }
  void record(double log_error_bin);

 private:
  void descend_all(std::vector<PoolEntry>& entries, int steps, double rate, std::uint64_t phase,
                   std::size_t first_item, SharedProgress& progress);
  void keep(std::vector<PoolEntry> entries);
  double error_m(double log_error_bin) const;
  double best_error_m() const { return error_m(entries_.front().score.log_error_bin); }

  const DesignProblem* problem_;
  OptimizeOptions options_;
  double bin_m_;
  CodeJudge judge_;
  std::vector<CodeSet> codes_;           ///< starts
  std::vector<OptimizeStart> mixtures_;  ///< starts after the codes
  std::vector<PoolEntry> entries_;       ///< best first
  std::vector<PoolEntry> continued_;  ///< entries after the starts, which the first hops continue
  std::vector<SearchStep> history_;
  std::int64_t steps_ = 0;
  std::size_t starts_done_ = 0, hops_done_ = 0, refinements_done_ = 0, splits_done_ = 0;
  bool ended_early_ = false, lost_to_rival_ = false;
};

}  // namespace tofsmith
