// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/progress.hpp"

namespace tofsmith {

struct WaveformPair {
  Waveform modulation;
  Waveform demodulation;
};
auto fields_of(ConstOrNot<WaveformPair> auto& p) {
  return std::tuple(Field("modulation", p.modulation), Field("demodulation", p.demodulation));
}

/// Desired correlation function of one measurement.
struct CorrelationTarget {
  Eigen::VectorXd samples;         ///< chi at the N bins, linear in between
  double demodulation_mean = 0.5;  ///< gain for ambient light
  /// Waveforms on an unlimited camera, if known.
  std::optional<WaveformPair> ideal;
};
auto fields_of(ConstOrNot<CorrelationTarget> auto& t) {
  return std::tuple(Field("samples", t.samples), Field("demodulation_mean", t.demodulation_mean),
                    Field("ideal", t.ideal));
}

struct TargetSet {
  std::string name;
  std::vector<CorrelationTarget> measurements;

  int samples() const { return static_cast<int>(measurements.front().samples.size()); }
};
auto fields_of(ConstOrNot<TargetSet> auto& t) {
  return std::tuple(Field("name", t.name), Field("measurements", t.measurements));
}

/// Returns the correlation functions of a one-tap code without impulse responses.
TargetSet targets_of(const CodeSet& code);

/// Returns the camera without the limits that prevent ideal codes: one tap, read separately, full
/// contrast and any peak. Pass families for this camera to targets_of().
Camera ideal_camera(const Camera& camera);

/// Creates targets from a table of correlation functions.
/// @param table  (rows, K), without the end point; resampled linearly to `samples` bins
/// @param normalize  rescales every column to [0, 1]
/// @throws InvalidArgument with column and row of a non-finite value
TargetSet targets_from_table(std::string name, const Eigen::MatrixXd& table, int samples,
                             bool normalize);

struct FactorizeOptions {
  /// lambda of problem (6). At 1e-2 the iteration collapses to constants.
  std::vector<double> total_variation_weights = {3e-4, 1e-5};
  int max_iterations = 12;
  double objective_tolerance = 1e-4;
  /// As in the paper; reaches zero error less often.
  bool feed_back_projection = false;
  int random_starts = 30;
  bool structured_starts = true;
  bool keep_naive = true;
  bool refine_edges = true;
  int refined = 24;
  int kept = 16;
  std::uint64_t seed = 1;

  /// @throws InvalidArgument
  void validate() const;
};
auto fields_of(ConstOrNot<FactorizeOptions> auto& o) {
  return std::tuple(
      Field("total_variation_weights", o.total_variation_weights, closed(1e-7, 1e-2),
            Help{"weights of total variation, used by the starts in turn; larger ones give fewer "
                 "edges"}),
      Field("max_iterations", o.max_iterations, at_least(1),
            Help{"pairs of convex steps per start"}),
      Field("objective_tolerance", o.objective_tolerance, at_least(0),
            Help{"relative change of the objective below which a start ends"}),
      Field(
          "feed_back_projection", o.feed_back_projection,
          Help{
              "continue each iteration from the binary projection instead of the relaxed iterate"}),
      Field("random_starts", o.random_starts, at_least(0), ByEffort{2}, Help{"random starts"}),
      Field("structured_starts", o.structured_starts,
            Help{"also start from the thresholded target with pulses and pulse trains"}),
      Field("keep_naive", o.keep_naive,
            Help{"keep the ideal demodulation with one pulse as a candidate"}),
      Field("refine_edges", o.refine_edges, Help{"refine switching times continuously"}),
      Field("refined", o.refined, at_least(1), Help{"number of best projections to refine"}),
      Field("kept", o.kept, at_least(1), Help{"number of distinct pairs to return"}),
      Field("seed", o.seed, FieldMark::from_above, Help{"seed of the random starts"}));
}

/// One pair of convex steps.
struct FactorizeIteration {
  double objective = 0.0;
  double relaxed_residual_rms = 0.0;
  double playable_residual_rms = 0.0;
};
auto fields_of(ConstOrNot<FactorizeIteration> auto& i) {
  return std::tuple(
      Field("objective", i.objective, Help{"residual + lambda (TV(d) + TV(m) / p)"}),
      Field("relaxed_residual_rms", i.relaxed_residual_rms, Help{"residual before projection"}),
      Field("playable_residual_rms", i.playable_residual_rms, Help{"residual after projection"}));
}

/// Feasible pair of waveforms.
struct PairCandidate {
  WaveformPair pair;
  double residual_rms = 0.0;  ///< over depth; the target is linear between bins
  std::string start;          ///< "random 3", "2 pulses 1/3 apart, duty 0.2", "naive"
  int iterations = 0;         ///< pairs of convex steps
};

struct Factorization {
  std::vector<PairCandidate> candidates;    ///< distinct, smallest residual first; never empty
  std::vector<FactorizeIteration> history;  ///< of the best random start, if any
  std::vector<int> iterations_per_start;    ///< of all starts with alternation
  double target_variation_rms = 0.0;        ///< of target minus mean
  std::string message;                      ///< reached, approached or out of reach

  const PairCandidate& best() const { return candidates.front(); }
  bool exact() const { return best().residual_rms < 1e-6; }
};

/// Finds waveforms whose correlation function on `camera` approximates `target`:
///   min over m, d of  rms(chi - (h_m * m) corr (h_d * d)) + lambda (TV(d) + TV(m) / p)
///   s.t.  mean m <= 1,  0 <= m <= p,  0 <= d <= 1
/// with m and d binary if the camera requires it. Unreachable targets yield a residual and a
/// message.
/// @throws InvalidArgument for invalid options or camera, or a target of length other than N
/// @see Gutierrez-Barragan et al., CVPR 2019, problems (6) and (7); differs: no feedback of the
///   projection by default, and refined switching times
Factorization factorize(const CorrelationTarget& target, const Camera& camera,
                        const FactorizeOptions& options = {}, const Progress& progress = {});

struct Alternation {
  WaveformPair relaxed;                     ///< last iterate (N samples)
  WaveformPair playable;                    ///< best projection
  std::vector<FactorizeIteration> history;  ///< per pair of convex steps
};

/// Runs the alternation of factorize() once, without refinement of switching times.
/// @param start  index of the random start, >= 0
/// @param total_variation_weight  lambda >= 0, replaces options.total_variation_weights
/// @param options  only max_iterations, objective_tolerance, feed_back_projection and seed
/// @throws InvalidArgument for invalid arguments, or a target of length other than N
Alternation alternate(const CorrelationTarget& target, const Camera& camera, int start,
                      double total_variation_weight, const FactorizeOptions& options = {});

}  // namespace tofsmith
