// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/factorize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/shared/shared_progress.hpp"
#include "design/factorize/alternation.hpp"
#include "design/factorize/edge_refinement.hpp"
#include "design/run_lengths.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

Waveform as_waveform(const Eigen::VectorXd& samples, bool binary, double level) {
  if (!binary) return Waveform::sampled(samples);
  return Waveform::binary_from_samples(samples, level > 0.0 ? level : 1.0);
}

WaveformPair playable_pair(const PairModel& model, const SampledPair& p) {
  return {as_waveform(p.modulation, model.binary_modulation(), p.modulation.maxCoeff()),
          as_waveform(p.demodulation, model.binary_demodulation(), 1.0)};
}

struct StartResult {
  PairCandidate candidate;
  std::vector<FactorizeIteration> history;
};

StartResult run_start(const PairModel& model, const FactorizeOptions& options, int index) {
  CirculantTvSolver solver(model.samples());
  const AlternationStart start = random_start(model, options.seed, index);
  const double weight = options.total_variation_weights[static_cast<std::size_t>(index) %
                                                        options.total_variation_weights.size()];
  AlternationResult found = alternate(model, start.pair, weight, options, solver);
  WaveformPair pair = playable_pair(model, found.playable);
  const double residual = model.residual_rms(pair);
  return {{std::move(pair), residual, start.name, static_cast<int>(found.history.size())},
          std::move(found.history)};
}

bool by_residual(const PairCandidate& a, const PairCandidate& b) {
  return a.residual_rms < b.residual_rms;
}

void refine_best(const PairModel& model, const FactorizeOptions& options,
                 std::vector<PairCandidate>& candidates, const Progress& progress) {
  const auto count = std::min<std::int64_t>(options.refined, std::ssize(candidates));
  SharedProgress shared(progress, static_cast<double>(count), "refining switching times");
  parallel_for(count, [&](std::int64_t i) {
    shared.add();
    PairCandidate& c = candidates[static_cast<std::size_t>(i)];
    if (c.residual_rms < 1e-9 || c.start == "naive")
      return;  // already exact, or must stay unchanged
    const auto refined = refine_edges(model, c.pair);
    if (!refined) return;
    const WaveformPair pair = settle_on_points(model, *refined).value_or(*refined);
    const double residual = model.residual_rms(pair);
    if (residual >= c.residual_rms) return;
    c.pair = pair;
    c.residual_rms = residual;
  });
}

/// Waveforms with equal residuals are delayed versions of one another.
void drop_repeats(std::vector<PairCandidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), by_residual);
  const auto last = std::unique(
      candidates.begin(), candidates.end(), [](const PairCandidate& a, const PairCandidate& b) {
        return b.start != "naive" &&
               b.residual_rms - a.residual_rms < 1e-6 * a.residual_rms + 1e-12;
      });
  candidates.erase(last, candidates.end());
}

/// Returns true if some pairs remain; keeps all if all pairs violate the shortest pulse.
bool drop_short_pulses(const PairModel& model, std::vector<PairCandidate>& candidates) {
  const auto too_short = [&](const PairCandidate& c) {
    return !keeps_shortest_run(c.pair.modulation, model.shortest_run()) ||
           !keeps_shortest_run(c.pair.demodulation, model.shortest_run());
  };
  if (std::all_of(candidates.begin(), candidates.end(), too_short)) return false;
  std::erase_if(candidates, too_short);
  return true;
}

void check_target(const CorrelationTarget& target, const Camera& camera) {
  camera.validate();
  require(target.samples.size() == camera.samples, "length of the target", target.samples.size(),
          fmt::format("must equal the camera's samples = {}", camera.samples));
  require(target.samples.allFinite(), "target", "not finite", "must be finite");
}

std::string describe(const Factorization& f, const CorrelationTarget& target) {
  if (f.exact()) return "reached exactly";
  const double share = f.best().residual_rms / std::max(f.target_variation_rms, 1e-300);
  std::string message = fmt::format("residual {:.4g} rms, {:.0f} % of the target's variation",
                                    f.best().residual_rms, 100 * share);
  if (target.samples.minCoeff() < -1e-9 || target.samples.maxCoeff() > 1 + 1e-9)
    message += "; the target exceeds [0, 1], which no correlation function can reach";
  else if (share > 0.5)
    message += "; this camera cannot reach the target";
  return message;
}

}  // namespace

void FactorizeOptions::validate() const {
  require(!total_variation_weights.empty(), "FactorizeOptions::total_variation_weights", "[]",
          "must list at least one weight");
  check_fields(*this, "FactorizeOptions::");
  require(random_starts > 0 || structured_starts, "FactorizeOptions::random_starts", random_starts,
          "must be >= 1 without structured starts");
}

Factorization factorize(const CorrelationTarget& target, const Camera& camera,
                        const FactorizeOptions& options, const Progress& progress) {
  options.validate();
  check_target(target, camera);

  const PairModel model(target, camera);
  Factorization result;
  result.target_variation_rms =
      std::sqrt((target.samples.array() - target.samples.mean()).square().mean());

  std::vector<StartResult> runs(static_cast<std::size_t>(options.random_starts));
  const ProgressParts parts(progress, {60, 40});
  SharedProgress shared(parts[0], options.random_starts, "alternating convex steps");
  parallel_for_indices(runs.size(), [&](std::size_t at) {
    shared.add();
    runs[at] = run_start(model, options, static_cast<int>(at));
  });
  for (const StartResult& run : runs) {
    result.candidates.push_back(run.candidate);
    result.iterations_per_start.push_back(run.candidate.iterations);
  }
  report(parts[0], 1.0, "alternating convex steps");

  if (options.structured_starts)
    for (auto&& one : structured_starts(model)) result.candidates.push_back(std::move(one));
  drop_repeats(result.candidates);

  if (options.refine_edges) refine_best(model, options, result.candidates, parts[1]);
  if (options.keep_naive)
    for (auto&& one : naive_start(model)) result.candidates.push_back(std::move(one));
  const bool playable = drop_short_pulses(model, result.candidates);
  drop_repeats(result.candidates);
  report(progress, 1.0, "refining switching times");

  std::vector<PairCandidate> kept;
  for (PairCandidate& c : result.candidates)
    if (std::ssize(kept) < options.kept || c.start == "naive") kept.push_back(std::move(c));
  result.candidates = std::move(kept);
  if (!runs.empty())
    result.history = std::min_element(runs.begin(), runs.end(), [&](const auto& a, const auto& b) {
                       return by_residual(a.candidate, b.candidate);
                     })->history;
  result.message = describe(result, target);
  if (!playable) result.message += "; no pair satisfies the sensor's shortest_pulse_s";
  return result;
}

Alternation alternate(const CorrelationTarget& target, const Camera& camera, int start,
                      double total_variation_weight, const FactorizeOptions& options) {
  options.validate();
  check_target(target, camera);
  require(start >= 0, "start", start, "must be >= 0");
  require(total_variation_weight >= 0.0 && std::isfinite(total_variation_weight),
          "total_variation_weight", total_variation_weight, "must be finite and >= 0");

  const PairModel model(target, camera);
  CirculantTvSolver solver(model.samples());
  AlternationResult found = alternate(model, random_start(model, options.seed, start).pair,
                                      total_variation_weight, options, solver);
  return {
      {Waveform::sampled(found.relaxed.modulation), Waveform::sampled(found.relaxed.demodulation)},
      playable_pair(model, found.playable),
      std::move(found.history)};
}

}  // namespace tofsmith
