// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "code/shared/exposure_groups.hpp"
#include "design/baselines.hpp"
#include "design/exposure_shares.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/edge_polish.hpp"
#include "design/optimize/optimize_starts.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/simulate/motion_error.hpp"

namespace tofsmith {

namespace {

constexpr std::size_t max_exposures_of_all_orders = 8;

bool lists_values_of_exposures(const Camera& camera) {
  return !camera.exposure_s.each_s.empty() || !camera.sensor.modulation_contrasts.empty() ||
         (camera.sensor.taps == 1 && camera.sensor.tap_mismatch != 0.0) ||
         (camera.playback && (camera.playback->has_list() || !camera.playback->order.empty()));
}

/// Computes the error of every order of the exposures of a code.
class OrderSearch {
 public:
  OrderSearch(const CodeSet& code, const Camera& camera, double velocity_m_per_s)
      : code_(code),
        velocity_m_per_s_(velocity_m_per_s),
        bias_(ForwardModel(code, camera), camera),
        times_s_(exposure_times_s(code, camera)),
        timed_(camera) {
    result_.order.resize(times_s_.size());
    std::iota(result_.order.begin(), result_.order.end(), 0);
    max_runs_ = runs(result_.order);
    result_.rms_bias_m = result_.given_rms_bias_m = rms_m(result_.order);
  }

  ExposureOrder best() {
    if (times_s_.size() <= max_exposures_of_all_orders)
      try_all();
    else
      exchange_pairs();
    return result_;
  }
  const ExposureOrder& given() const { return result_; }

 private:
  void try_all() {
    std::vector<int> order = result_.order;
    while (std::next_permutation(order.begin(), order.end())) keep_if_better(order);
  }

  void exchange_pairs() {
    for (bool is_improved = true; is_improved;) {
      is_improved = false;
      for (std::size_t i = 0; i < times_s_.size(); ++i)
        for (std::size_t j = i + 1; j < times_s_.size(); ++j) {
          std::vector<int> order = result_.order;
          std::swap(order[i], order[j]);
          is_improved |= keep_if_better(order);
        }
    }
  }

  bool keep_if_better(const std::vector<int>& order) {
    if (runs(order) > max_runs_) return false;
    constexpr double rounding = 1e-6;  // smaller differences are not due to the order
    const double error_m = rms_m(order);
    if (!(error_m < result_.rms_bias_m - rounding * result_.given_rms_bias_m)) return false;
    result_.order = order;
    result_.rms_bias_m = error_m;
    return true;
  }

  /// Returns the number of runs of exposures with the same modulation.
  std::ptrdiff_t runs(const std::vector<int>& order) const {
    std::ptrdiff_t count = 1;
    for (std::size_t i = 1; i < order.size(); ++i)
      count += !(code_.modulation(order[i]) == code_.modulation(order[i - 1]));
    return count;
  }

  double rms_m(const std::vector<int>& order) {
    std::vector<double>& in_order_s = timed_.exposure_s.each_s;
    in_order_s.clear();
    for (const int e : order) in_order_s.push_back(times_s_[static_cast<std::size_t>(e)]);
    const Eigen::VectorXd by_place_m = exposure_shifts_m(timed_, velocity_m_per_s_);
    Eigen::VectorXd shift_m(by_place_m.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      shift_m[order[i]] = by_place_m[static_cast<Eigen::Index>(i)];
    return bias_.rms_m(shift_m);
  }

  const CodeSet& code_;
  double velocity_m_per_s_;
  MotionBias bias_;
  std::vector<double> times_s_;  // of the code's exposures
  Camera timed_;                 // with the times of the order that is tried
  std::ptrdiff_t max_runs_ = 0;
  ExposureOrder result_;
};

}  // namespace

ExposureOrder best_exposure_order(const CodeSet& code, const Camera& camera,
                                  double velocity_m_per_s) {
  OrderSearch search(code, camera, velocity_m_per_s);
  return lists_values_of_exposures(camera) ? search.given() : search.best();
}

void choose_exposure_order(const Camera& camera, Candidate& candidate) {
  if (!camera.operating.velocity_m_per_s) return;
  const CodeSet& code = candidate.code;
  ExposureOrder found = best_exposure_order(code, camera, *camera.operating.velocity_m_per_s);
  if (candidate.target.cols() == code.exposures())
    candidate.target = candidate.target(Eigen::all, found.order).eval();
  candidate.per_measurement = in_exposure_order(candidate.per_measurement, found.order);
  candidate.code = code.with_exposure_order(found.order);
  candidate.exposure_order = std::move(found);
}

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
    const Eigen::VectorXd normalized = shares / shares.sum();  // corrects rounding errors
    TriedCode tried{code.with_exposure_shares({normalized.begin(), normalized.end()})};
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
