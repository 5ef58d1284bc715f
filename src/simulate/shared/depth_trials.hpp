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
#include "simulate/row_trials.hpp"
#include "simulate/trial_kernel.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// True and decoded positions of an even number of trials that follow one another, [bin] in [0, N).
struct TrialBlock {
  std::span<const double> true_bin;
  std::span<const double> decoded_bin;
};

/// Trials first .. first + trials - 1 of an operating point, one in each of as many slices of the
/// range, in each of which depths are equally likely.
struct TrialRound {
  std::size_t point = 0;
  std::int64_t first = 0;
  std::int64_t trials = 0;  ///< even
};

/// Trials of a round that are run elsewhere.
struct TrialRun {
  TrialRound round;
  IndexRange trials;               ///< of the round
  double *true_bin, *decoded_bin;  ///< room for them, [bin] in [0, N)
};

/// The Monte Carlo loop behind every depth error: draw depth and noise, decode. What a trial draws
/// depends on the seed, its point and its number alone. A tile of trials stays in the innermost
/// caches from its random numbers to its errors.
class DepthTrials {
 public:
  DepthTrials(const ForwardModel& model, const Camera& camera, const EvaluateOptions& options);
  /// Decoded by what a decoder believes of the camera, of as many measurements and samples.
  DepthTrials(const ForwardModel& model, const Camera& camera, const EvaluateOptions& options,
              DecodingTable believed);
  /// Of a table that is taken for the truth, at one light level.
  DepthTrials(const DecodingTable& table, const OperatingPoint& light,
              const EvaluateOptions& options);

  int samples() const { return model_.samples(); }
  int measurements() const { return model_.measurements(); }
  const std::vector<OperatingPoint>& points() const { return points_; }
  /// Whether noise is drawn in the plane in which the decoder looks, not by measurement.
  bool draws_in_plane() const { return !plane_noise_.empty(); }

  /// The trials that the options ask for at first, of every point.
  std::vector<TrialRound> first_rounds() const;

  /// What `add(sums, block)` makes of all trials of each round, on all threads. Blocks are added
  /// within runs of trials, and runs merged by `merge(other)`, in their order whatever the threads.
  /// @param runs_at_once  that many sums are kept
  template <typename Sums, typename Add>
  std::vector<Sums> sum(std::span<const TrialRound> rounds, const Sums& none, const Add& add,
                        const Progress& progress, std::int64_t runs_at_once = 512) const;

  /// From now on `sum` has them run elsewhere, if that can be done. Sums are added in the same
  /// order.
  void have_run_by(const TrialsBy& trials_by) {
    runner_ = trials_by ? trials_by(*this) : TrialRunner();
  }

  /// Runs trials [begin, end) of a round, at most trials_per_tile and an even number, in a
  /// workspace.
  TrialBlock run(const TrialRound& round, IndexRange trials, TrialTile& tile) const;

  // What it computes with, for other processors.
  const EvaluateOptions& options() const { return options_; }
  bool has_uniform_albedo() const { return uniform_albedo_; }
  double albedo() const { return albedo_; }
  const DepthPrior& depths() const { return depths_; }
  const TrialModel& model() const { return model_; }
  /// Null where taps are read out.
  const RowTrials* rows() const { return rows_ ? &*rows_ : nullptr; }
  const DecodingTable& believed() const { return believed_; }
  const TrialDecoder& decoder() const { return decoder_; }
  /// Of every point; none where draws_in_plane() is not so.
  const std::vector<PlaneNoise>& plane_noise() const { return plane_noise_; }
  /// Electrons of every tap at a point without signal, their shot noise, and where clipping to an
  /// open sensor begins; that is empty where there is none.
  const std::vector<float>& mean_floor_e(std::size_t point) const { return mean_floor_e_[point]; }
  const std::vector<float>& shot_floor_e2(std::size_t point) const { return shot_floor_e2_[point]; }
  const std::vector<float>& max_e(std::size_t point) const { return max_e_[point]; }

 private:
  static constexpr std::int64_t trials_per_run = 4 * trials_per_tile;

  /// What `sum` adds, of trials that `runner_` runs.
  template <typename Sums, typename Add>
  std::vector<Sums> sum_of_runner(std::span<const TrialRound> rounds, const Sums& none,
                                  const Add& add, const Progress& progress) const;

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
  std::optional<RowTrials> rows_;  // where they are read out
  DecodingTable believed_;
  TrialDecoder decoder_;
  std::vector<PlaneNoise> plane_noise_;  // of every point; none where it is not exact
  std::vector<std::vector<float>> mean_floor_e_, shot_floor_e2_, max_e_;  // of every point: (taps)
  TrialRunner runner_;                                                    // none: here
};

template <typename Sums, typename Add>
std::vector<Sums> DepthTrials::sum(std::span<const TrialRound> rounds, const Sums& none,
                                   const Add& add, const Progress& progress,
                                   std::int64_t runs_at_once) const {
  if (runner_) return sum_of_runner(rounds, none, add, progress);
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
    parallel_for(std::ssize(runs), [&](std::int64_t i) {
      const Run& run_of = runs[static_cast<std::size_t>(i)];
      Sums& sums = of_run[static_cast<std::size_t>(i)];
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

template <typename Sums, typename Add>
std::vector<Sums> DepthTrials::sum_of_runner(std::span<const TrialRound> rounds, const Sums& none,
                                             const Add& add, const Progress& progress) const {
  constexpr std::int64_t runs_at_once = 1024;
  std::vector<Sums> total(rounds.size(), none), of_run;
  std::vector<double> true_bin, decoded_bin;
  std::int64_t all = 0, done = 0;
  for (const TrialRound& round : rounds) all += round.trials;
  for (std::size_t r = 0; r < rounds.size(); ++r)
    for (std::int64_t begin = 0; begin < rounds[r].trials; begin += runs_at_once * trials_per_run) {
      const std::int64_t count = std::min(rounds[r].trials - begin, runs_at_once * trials_per_run);
      true_bin.resize(static_cast<std::size_t>(count));
      decoded_bin.resize(static_cast<std::size_t>(count));
      runner_({rounds[r], {begin, begin + count}, true_bin.data(), decoded_bin.data()});
      of_run.assign(static_cast<std::size_t>((count + trials_per_run - 1) / trials_per_run), none);
      parallel_for(std::ssize(of_run), [&](std::int64_t i) {
        const std::int64_t end = std::min(count, (i + 1) * trials_per_run);
        for (std::int64_t at = i * trials_per_run; at < end; at += trials_per_tile) {
          const auto size =
              static_cast<std::size_t>(std::min<std::int64_t>(end - at, trials_per_tile));
          add(of_run[static_cast<std::size_t>(i)],
              TrialBlock{{true_bin.data() + at, size}, {decoded_bin.data() + at, size}});
        }
      });
      for (const Sums& sums : of_run) total[r].merge(sums);
      done += count;
      report(progress, static_cast<double>(done) / static_cast<double>(all), "depth error");
    }
  return total;
}

}  // namespace tofsmith
