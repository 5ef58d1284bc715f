// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "camera/shared/depth_prior.hpp"
#include "core/shared/shared_progress.hpp"
#include "decode/output/shared/trial_decoder.hpp"
#include "simulate/trial_kernel.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Measurements of rows of one exposure. Poisson noise is drawn for every time bin and weighted by
/// the rows; normal noise has the covariance at that depth and light.
class RowTrials {
 public:
  static constexpr int points_per_bin = 16;  // same as in TrialModel

  RowTrials(const ForwardModel& model, const Camera& camera);

  int measurements() const { return measurements_; }
  /// Fills `taps` with raw numbers, [K][trials_per_tile], from row, share, signal and K rows of
  /// normals.
  void draw(const TrialStreams& streams, double ambient_e_per_s, int trials, TrialTile& tile) const;

 private:
  /// Electrons and variances without the signal, in the layout of of_signal_.
  std::vector<double> beside_signal(double ambient_e_per_s) const;
  void draw_poisson_rows(const TrialStreams& streams, double ambient_e_per_s, int trials,
                         TrialTile& tile) const;
  void draw_normal_rows(double ambient_e_per_s, int trials, TrialTile& tile) const;

  int measurements_, samples_, points_;
  bool is_poisson_;
  double read_noise_e_;
  std::vector<double> of_signal_;
  std::vector<double> of_ambient_, of_dark_;  // per unit of A; without light
  std::vector<float> weights_;
};

/// True and decoded positions [bin], in [0, N), of an even number of trials.
struct TrialBlock {
  std::span<const double> true_bin;
  std::span<const double> decoded_bin;
};

/// Trials first to first + trials - 1 of an operating point, one per equally probable slice of the
/// range.
struct TrialRound {
  std::size_t point = 0;
  std::int64_t first = 0;
  std::int64_t trials = 0;  ///< even
};

/// The Monte Carlo loop of all depth errors. Random numbers of a trial depend only on the seed, its
/// point and its number.
class DepthTrials {
 public:
  DepthTrials(const ForwardModel& model, const Camera& camera, const EvaluateOptions& options);
  DepthTrials(const ForwardModel& model, const Camera& camera, const EvaluateOptions& options,
              DecodingTable believed);
  DepthTrials(const DecodingTable& table, const OperatingPoint& light,
              const EvaluateOptions& options);

  int samples() const { return model_.samples(); }
  int measurements() const { return model_.measurements(); }
  const std::vector<OperatingPoint>& points() const { return points_; }
  bool draws_in_plane() const { return !plane_noise_.empty(); }

  std::vector<TrialRound> first_rounds() const;

  /// Accumulates rounds by `add(sums, block)` on all threads, and merges runs of trials in order by
  /// `merge(other)`, independent of the threads.
  /// @param runs_at_once  number of sums in memory
  template <typename Sums, typename Add>
  std::vector<Sums> sum(std::span<const TrialRound> rounds, const Sums& none, const Add& add,
                        const Progress& progress, std::int64_t runs_at_once = 512) const;

  /// Requires an even number of trials, at most trials_per_tile.
  TrialBlock run(const TrialRound& round, IndexRange trials, TrialTile& tile) const;

 private:
  static constexpr std::int64_t trials_per_run = 4 * trials_per_tile;

  void draw_signal(const TrialStreams& streams, std::size_t point, int trials,
                   TrialTile& tile) const;
  void draw_normals(const TrialStreams& streams, int count, int trials, TrialTile& tile) const;
  void draw_signed(const TrialStreams& streams, int trials, TrialTile& tile) const;
  void draw_measurements(const TrialStreams& streams, std::size_t point, int trials,
                         TrialTile& tile) const;

  EvaluateOptions options_;
  bool uniform_albedo_ = false;
  double albedo_ = 1.0;
  DepthPrior depths_;
  std::vector<OperatingPoint> points_;
  TrialModel model_;
  std::optional<RowTrials> rows_;
  DecodingTable believed_;
  TrialDecoder decoder_;
  std::vector<PlaneNoise> plane_noise_;
  std::vector<std::vector<float>> mean_floor_e_, shot_floor_e2_, max_e_;  // per point: (taps)
};

template <typename Sums, typename Add>
std::vector<Sums> DepthTrials::sum(std::span<const TrialRound> rounds, const Sums& none,
                                   const Add& add, const Progress& progress,
                                   std::int64_t runs_at_once) const {
  struct Run {
    std::size_t round;
    IndexRange trials;
  };
  std::vector<Sums> total(rounds.size(), none);
  std::vector<Run> runs;
  std::vector<Sums> of_run;
  std::int64_t all = 0;
  for (const TrialRound& round : rounds) all += round.trials;
  SharedProgress shared(progress, static_cast<double>(all), "depth error");
  const auto finish = [&] {
    of_run.assign(runs.size(), none);
    parallel_for_indices(runs.size(), [&](std::size_t at) {
      const Run& run_of = runs[at];
      Sums& sums = of_run[at];
      TrialTile tile;
      for (std::int64_t begin = run_of.trials.begin; begin < run_of.trials.end;
           begin += trials_per_tile) {
        const std::int64_t end = std::min<std::int64_t>(run_of.trials.end, begin + trials_per_tile);
        add(sums, run(rounds[run_of.round], {begin, end}, tile));
        shared.add(static_cast<double>(end - begin));
      }
    });
    for (std::size_t i = 0; i < runs.size(); ++i) total[runs[i].round].merge(of_run[i]);
    runs.clear();
  };
  for (std::size_t r = 0; r < rounds.size(); ++r)
    for (std::int64_t begin = 0; begin < rounds[r].trials; begin += trials_per_run) {
      runs.push_back({r, {begin, std::min(rounds[r].trials, begin + trials_per_run)}});
      if (std::ssize(runs) == runs_at_once) finish();
    }
  if (!runs.empty()) finish();
  return total;
}

}  // namespace tofsmith
