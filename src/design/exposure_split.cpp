// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "design/baselines.hpp"
#include "design/exposure_bound.hpp"
#include "design/exposure_shares.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/edge_polish.hpp"
#include "design/optimize/optimize_starts.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

constexpr std::uint64_t share_descent_key = 106;
/// Multiples of the usual number of trials of tried_error_m(), because the differences are small.
constexpr int choosing_trials = 4, confirming_trials = 20;
/// Smaller gains may be due to chance.
constexpr double min_gain = 1.003;

struct TriedCode {
  CodeSet code;
  double error_m = infinity;
};

CodeSet with_shares(const CodeSet& code, const Eigen::VectorXd& shares) {
  const Eigen::VectorXd normalized = shares / shares.sum();  // corrects rounding errors
  return code.with_exposure_shares({normalized.begin(), normalized.end()});
}

/// Descends from the shares of the code. None if the soft decoder does not support the camera.
std::optional<Eigen::VectorXd> shares_by_soft_error(const CodeSet& code, Camera camera,
                                                    const DesignOptions& options) {
  constexpr int max_samples = 480;
  // Without band limit, only optimized waveforms require a shortest pulse.
  if (!camera.band_limited() && !camera.sensor.shortest_pulse_s)
    camera.sensor.shortest_pulse_s = suggested_shortest_pulse_s(camera);
  const int steps = options.optimize.polish ? options.optimize.polish_steps : 0;
  if (steps == 0 || why_not_optimizable(judged_camera(camera), code.exposures()))
    return std::nullopt;
  const DesignProblem problem =
      make_design_problem({&camera, 1}, code.exposures(), std::min(camera.samples, max_samples));
  const CodeSet taps = code.is_signed() ? code.buckets_of_signed() : code;
  SampledCode sampled = sampled_on(problem.space, taps);
  sampled.shares = shares_of(code);
  return descend_shares(problem, std::move(sampled), steps, options.optimize.trials_per_step,
                        options.seed, share_descent_key);
}

/// Returns the best of the proposed shares in few trials.
CodeSet with_chosen_shares(const CodeSet& code, const Camera& camera,
                           const DesignOptions& options) {
  TriedCode best{code, tried_error_m(code, camera, options, choosing_trials)};
  const auto try_shares = [&](const Eigen::VectorXd& shares) {
    TriedCode tried{with_shares(code, shares)};
    tried.error_m = tried_error_m(tried.code, camera, options, choosing_trials);
    if (tried.error_m < best.error_m) best = std::move(tried);
  };
  const Eigen::VectorXd bound = ExposureBound(code, camera).best_shares();
  try_shares(bound);
  try_shares(bound.cwiseSqrt());  // half way, by ratios
  if (const auto soft = shares_by_soft_error(best.code, camera, options)) try_shares(*soft);
  return best.code;
}

/// Uses trials that did not choose the shares.
double confirmed_error_m(const CodeSet& code, const Camera& camera, DesignOptions options) {
  ++options.seed;
  return tried_error_m(code, camera, options, confirming_trials);
}

bool is_split(const Candidate& candidate) { return !candidate.code.exposure_shares().empty(); }

/// Only codes of optimization and factorization.
bool may_split(const Candidate& candidate) {
  return (candidate.method == "optimize" || candidate.method == "factorize") &&
         candidate.code.exposures() > 1;
}

}  // namespace

CodeSet with_split_exposures(const CodeSet& code, const Camera& camera,
                             const DesignOptions& options) {
  const CodeSet split = with_chosen_shares(code, camera, options);
  if (split.exposure_shares().empty()) return code;
  const double gain =
      confirmed_error_m(code, camera, options) / confirmed_error_m(split, camera, options);
  return gain >= min_gain ? split : code;
}

void add_split_exposures(const Camera& camera, const DesignOptions& options, DesignResult& result,
                         const Progress& progress) {
  if (!camera.exposure_s.each_s.empty()) return;
  std::vector<Candidate> kept, split;
  std::vector<double> kept_m;
  const std::size_t count = result.candidates.size();
  for (std::size_t i = 0; i < count; ++i) {
    report(progress, static_cast<double>(i) / static_cast<double>(count), "exposure times");
    Candidate& candidate = result.candidates[i];
    if (is_split(candidate) && may_split(candidate)) {
      split.push_back(std::move(candidate));
      continue;
    }
    double error_m = infinity;
    if (may_split(candidate)) {
      error_m = confirmed_error_m(candidate.code, camera, options);
      Candidate copy = candidate;
      copy.code = with_chosen_shares(copy.code, camera, options);
      if (is_split(copy)) split.push_back(std::move(copy));
    }
    kept.push_back(std::move(candidate));
    kept_m.push_back(error_m);
  }
  const std::size_t equal = kept.size();
  for (Candidate& candidate : split) {
    std::size_t best = equal;  // with the same name and equal shares
    for (std::size_t i = 0; i < equal; ++i)
      if (kept[i].code.name() == candidate.code.name() &&
          (best == equal || kept_m[i] < kept_m[best]))
        best = i;
    if (best == equal) continue;
    const double gain = kept_m[best] / confirmed_error_m(candidate.code, camera, options);
    if (!(gain >= min_gain)) continue;
    const ExposureBound bound(kept[best].code, camera);
    candidate.message += fmt::format(
        "; exposures of different length: {:.3f} times smaller error (bound: {:.3f} times)", gain,
        bound.gain(bound.best_shares()));
    kept.push_back(std::move(candidate));
  }
  result.candidates = std::move(kept);
}

}  // namespace tofsmith
