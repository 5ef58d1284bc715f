// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/judge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "camera/shared/depth_prior.hpp"
#include "core/shared/shared_progress.hpp"
#include "design/baselines.hpp"
#include "design/exposure_split.hpp"
#include "simulate/shared/camera_bounds.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

CodeSet signed_by(CodeSet code, const std::string& method, const Camera& camera,
                  std::uint64_t seed) {
  code.provenance.method = method;
  code.provenance.camera = camera.name;
  code.provenance.seed = seed;
  code.provenance.version = TOFSMITH_VERSION;
  return code;
}

std::vector<MeasurementReport> reports_of(const CodeSet& code, const std::string& start) {
  std::vector<MeasurementReport> reports;
  for (int i = 0; i < code.measurements(); ++i) {
    const Waveform &demodulation = code.demodulation(i), &modulation = code.modulation_of(i);
    reports.push_back({.demodulation_duty = demodulation.mean(),
                       .modulation_duty = modulation.duty(),
                       .peak = modulation.peak(),
                       .edges = modulation.edges() + demodulation.edges(),
                       .start = start});
  }
  return reports;
}

namespace {

BrokenRule why_no_candidate(const Camera& camera, const DesignOptions& options,
                            const std::vector<std::string>& left_out) {
  if (camera.light.peak_factor <= 1.0)
    return broken("light.peak_factor", camera.light.peak_factor,
                  "allows only constant light, which cannot measure depth");
  const std::size_t listed = camera.exposure_s.each_s.size();
  const std::size_t ordered = camera.playback ? camera.playback->order.size() : 0;
  if (listed > 0 && ordered > 0 && listed != ordered)
    return broken("number of exposure_s", listed,
                  fmt::format("must equal the {} exposures of playback.order", ordered));
  const bool has_rows = camera.sensor.readout == Readout::rows;
  const std::size_t exposures = std::max(listed, ordered);
  const char* const which = listed > 0 ? "number of exposure_s" : "number of playback.order";
  if (has_rows && exposures > 1)
    return broken(which, exposures, "must be 1: rows are sums of the light of one exposure");
  const int per_exposure = camera.sensor.readout == Readout::difference ? 1 : camera.sensor.taps;
  const int measurements = static_cast<int>(exposures) * per_exposure;
  if (exposures > 0 && !has_rows && measurements < (camera.sensor.subtracts() ? 2 : 3))
    return broken(which, exposures,
                  fmt::format("gives {} measurement{}; signal, ambient light and depth are three "
                              "unknowns",
                              measurements, measurements == 1 ? "" : "s"));
  if (options.method == DesignMethod::atlas && (exposures > 0 || camera.sensor.taps > 2)) {
    constexpr const char* none =
        "has no code in the atlas that measures depth on this camera; use an effort above 0 to "
        "search for one";
    return exposures > 0 ? broken(which, exposures, none)
                         : broken("sensor.taps", camera.sensor.taps, none);
  }
  constexpr std::size_t max_reasons = 3;
  std::string reasons = fmt::format(
      "{}", fmt::join(left_out.begin(),
                      left_out.begin() +
                          static_cast<std::ptrdiff_t>(std::min(max_reasons, left_out.size())),
                      "; "));
  if (left_out.size() > max_reasons)
    reasons += fmt::format("; and {} more reasons", left_out.size() - max_reasons);
  return broken("codes that measure depth", "none",
                fmt::format("no candidate can be used on this camera: {}", reasons));
}

/// An error only if no candidate is left.
void leave_out_what_tells_no_depth(const Camera& camera, const DesignOptions& options,
                                   DesignResult& result) {
  std::erase_if(result.candidates, [&](const Candidate& c) {
    const std::optional<std::string> reason = why_no_depth(c.code, camera);
    if (!reason) return false;
    const std::string message = c.message.empty() ? "" : fmt::format(" ({})", c.message);
    leave_out(result, c.code.name() + message, *reason);
    return true;
  });
  if (result.candidates.empty()) require(why_no_candidate(camera, options, result.left_out));
}

EvaluateOptions judging_options(const DesignOptions& options) {
  return {.trials = options.trials,
          .seed = options.seed,
          .outlier_threshold_m = options.outlier_threshold_m};
}

void evaluate_candidate(Candidate& candidate, const Camera& camera, const EvaluateOptions& judging,
                        CameraBounds& bounds, const Progress& progress) {
  candidate.error = evaluate(candidate.code, camera, judging, bounds, progress);
  candidate.code.provenance.depth_error_m =
      geometric_mean_error_m(candidate.error, camera.operating.measure());
}

void judge_one(Candidate& candidate, const Camera& camera, const DesignOptions& options,
               CameraBounds& bounds, const Progress& progress) {
  choose_exposure_order(camera, candidate);
  const EvaluateOptions judging = judging_options(options);
  const auto& later = camera.operating.multipath;
  const bool has_others = camera.operating.interference.has_value();
  const ProgressParts parts(progress,
                            {50, later ? 10.0 : 50.0, later ? 40.0 : 0.0, has_others ? 50.0 : 0.0});
  if (rotates(camera, options)) {
    // Fewer trials suffice, because the error changes little around the best rotation.
    constexpr std::int64_t trials_of_all_points = 125000;
    const auto points = static_cast<std::int64_t>(camera.operating.points().size());
    EvaluateOptions search = judging;
    search.trials =
        std::min(judging.trials, std::max(judging.trials / 4, trials_of_all_points / points));
    search.seed = search_seed(options);
    const int moved_bin = best_rotation(candidate.code, camera, search, parts[0]).rotation_bin;
    candidate.code = candidate.code.rotated(moved_bin);
    candidate.rotation_bin = (candidate.rotation_bin + moved_bin) % camera.samples;
  }
  evaluate_candidate(candidate, camera, judging, bounds, parts[1]);
  if (later)
    candidate.multipath =
        operating_multipath_report(candidate.code, camera, *later, judging, parts[2]);
  if (has_others)
    candidate.interference = interference_error(candidate.code, camera, judging, parts[3]);
}

/// Returns the candidates with a requested number of exposures, or all if there are none.
std::vector<Candidate*> possible_winners(std::vector<Candidate>& candidates,
                                         const std::vector<int>& requested) {
  std::vector<Candidate*> all, possible;
  for (Candidate& candidate : candidates) {
    all.push_back(&candidate);
    if (requested.empty() || std::find(requested.begin(), requested.end(),
                                       candidate.code.exposures()) != requested.end())
      possible.push_back(&candidate);
  }
  return possible.empty() ? all : possible;
}

/// Evaluates codes again, with more trials, if their errors do not differ significantly from the
/// smallest. Linear errors have standard errors of some percent, more than designs differ.
void judge_contenders(const Camera& camera, const DesignOptions& options, CameraBounds& bounds,
                      const std::vector<Candidate*>& possible, const Progress& progress) {
  constexpr double significant = 2.0;   // standard errors of the difference
  constexpr double negligible = 0.005;  // relative difference
  // The last round evaluates codes that became close to the best in the round before.
  const std::vector<int> trial_factors = {3, 12, 12};
  const ProgressParts rounds(progress, {20, 60, 20});
  const auto error_of = [&](const Candidate* candidate) {
    return candidate->error.of(camera.operating.measure()).geometric_mean_m;
  };
  for (std::size_t round = 0; round < trial_factors.size(); ++round) {
    EvaluateOptions judging = judging_options(options);
    judging.trials *= trial_factors[round];
    Candidate* const best = *std::min_element(possible.begin(), possible.end(),
                                              [&](const Candidate* a, const Candidate* b) {
                                                return error_of(a).value < error_of(b).value;
                                              });
    const Estimate least = error_of(best);
    std::vector<Candidate*> close;
    std::copy_if(possible.begin(), possible.end(), std::back_inserter(close),
                 [&](const Candidate* candidate) {
                   const Estimate error = error_of(candidate);
                   const double margin =
                       significant * std::hypot(error.standard_error, least.standard_error);
                   return candidate != best && error.value - least.value <= margin &&
                          margin > negligible * least.value;
                 });
    if (close.empty()) return;
    close.push_back(best);
    std::erase_if(close, [&](const Candidate* candidate) {
      return candidate->error.trials >= judging.trials;
    });
    const ProgressParts parts(rounds[round], close.size());
    for (std::size_t i = 0; i < close.size(); ++i)
      evaluate_candidate(*close[i], camera, judging, bounds, parts[i]);
  }
}

void judge_robustness(Candidate& candidate, const Camera& camera, const DesignOptions& options,
                      const Progress& progress) {
  constexpr int max_trials = 4000;  // sufficient for ratios with common trials
  candidate.robustness =
      robustness(candidate.code, camera,
                 {.trials = std::min(options.trials, max_trials), .seed = options.seed}, progress);
}

/// Returns ranking errors, multiplied by two-return error / limit, clipped to [1, 1.25]; by 1.25 if
/// two returns cannot be decoded; by 1 if this is true of all initial codes. The limit is relative
/// to the best initial code.
std::vector<double> ranking_of(const std::vector<Candidate>& candidates, const Camera& camera,
                               const DesignOptions& options) {
  constexpr double max_excess = 1.25;
  double min_m = infinity;
  for (const Candidate& c : candidates)
    if (!c.is_designed() && c.multipath && c.multipath->two_return)
      min_m = std::min(min_m, c.multipath->two_return->circular_m.value);
  const double limit_m = options.optimize.max_two_return_loss * min_m;
  std::vector<double> ranking_m;
  for (const Candidate& c : candidates) {
    double excess = 1.0;
    if (c.multipath && min_m < infinity)
      excess =
          c.multipath->two_return
              ? std::clamp(c.multipath->two_return->circular_m.value / limit_m, 1.0, max_excess)
              : max_excess;
    ranking_m.push_back(excess * ranking_error_m(c, camera, options));
  }
  return ranking_m;
}

/// Keeps the best candidate of each name, then finds the winner, with a requested number of
/// exposures if possible.
void keep_best_of_each_name(const std::vector<double>& ranking_m, const std::vector<int>& requested,
                            DesignResult& result) {
  std::vector<Candidate> kept;
  std::vector<double> kept_m;
  for (std::size_t i = 0; i < result.candidates.size(); ++i) {
    Candidate& candidate = result.candidates[i];
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const auto& item) {
      return item.code.name() == candidate.code.name();
    });
    const auto at = static_cast<std::size_t>(same - kept.begin());
    if (same == kept.end()) {
      kept.push_back(std::move(candidate));
      kept_m.push_back(ranking_m[i]);
    } else if (ranking_m[i] < kept_m[at]) {
      kept[at] = std::move(candidate);
      kept_m[at] = ranking_m[i];
    }
  }
  result.candidates = std::move(kept);
  const auto index = [&](const Candidate* c) {
    return static_cast<std::size_t>(c - result.candidates.data());
  };
  const std::vector<Candidate*> possible = possible_winners(result.candidates, requested);
  const auto best = std::min_element(
      possible.begin(), possible.end(),
      [&](const Candidate* a, const Candidate* b) { return kept_m[index(a)] < kept_m[index(b)]; });
  result.best = best == possible.end() ? 0 : index(*best);
}

}  // namespace

std::uint64_t search_seed(const DesignOptions& options) { return options.seed + 1; }

bool rotates(const Camera& camera, const DesignOptions& options) {
  return options.best_rotation &&
         (camera.operating.error == DepthErrorKind::linear || !DepthPrior(camera).is_uniform());
}

void require_judgeable(const Camera& camera, const DesignOptions& options) {
  options.validate();
  camera.validate();
  require(!options.robust || !camera.operating.multipath, "DesignOptions::robust", "true",
          "must be false with operating.multipath");
  require(!options.robust || !camera.operating.interference, "DesignOptions::robust", "true",
          "must be false with operating.interference");
  const bool needs_mae =
      options.robust || camera.operating.multipath || camera.operating.interference;
  require(!needs_mae || camera.operating.statistic == ErrorStatistic::mae, "operating.statistic",
          "rmse",
          options.robust ? "must be \"mae\" with robust designs, which are ranked by mean errors"
                         : "must be \"mae\" with operating.multipath or operating.interference, "
                           "whose errors are means");
}

std::optional<std::string> why_no_depth(const CodeSet& code, const Camera& camera) {
  if (auto reason = why_not_playable(code, camera)) return reason;
  return why_not_decodable(CodeOnCamera(code, camera).table);
}

std::optional<CodeOnCamera> if_it_has_depth(const CodeSet& code, const Camera& camera) {
  if (why_not_playable(code, camera)) return std::nullopt;
  std::optional<CodeOnCamera> on(std::in_place, code, camera);
  if (why_not_decodable(on->table)) on.reset();
  return on;
}

void judge_candidates(const Camera& camera, const DesignOptions& options, DesignResult& result,
                      const Progress& progress) {
  leave_out_what_tells_no_depth(camera, options, result);
  CameraBounds bounds(camera);
  // Otherwise, another criterion than the error without disturbances ranks the codes.
  const bool has_contenders =
      !options.robust && !camera.operating.multipath && !camera.operating.interference;
  const ProgressParts parts(progress,
                            {60, has_contenders ? 30.0 : 0.0, options.robust ? 0.0 : 10.0});
  std::vector<Candidate>& all = result.candidates;
  SharedProgress shared(parts[0], static_cast<double>(all.size()), "codes");
  parallel_for_indices(all.size(), [&](std::size_t i) {
    double done = 0.0;
    const auto add = [&](double fraction, std::string_view) {
      shared.add(fraction - std::exchange(done, fraction));
      return true;
    };
    const ProgressParts its(add, {15, options.robust ? 85.0 : 0.0});
    judge_one(all[i], camera, options, bounds, its[0]);
    if (options.robust) judge_robustness(all[i], camera, options, its[1]);
    add(1.0, "");
  });
  std::vector<int> requested;  // any, for rows: DesignOptions::exposures is their number
  if (camera.sensor.readout != Readout::rows) requested = options.exposures;
  if (has_contenders)
    judge_contenders(camera, options, bounds, possible_winners(result.candidates, requested),
                     parts[1]);
  keep_best_of_each_name(ranking_of(result.candidates, camera, options), requested, result);
  Candidate& winner = result.candidates[result.best];
  if (!winner.robustness) judge_robustness(winner, camera, options, parts[2]);
  result.explanation = explain(camera, result, requested);
}

double geometric_mean_error_m(const DepthErrorReport& report, DepthErrorMeasure measure) {
  return report.of(measure).geometric_mean_m.value;
}

double ranking_error_m(const Candidate& candidate, const Camera& camera,
                       const DesignOptions& options) {
  if (options.robust && candidate.robustness)
    return candidate.robustness->worst_calibrated_m().value;
  const double error_m =
      camera.operating.interference && candidate.interference
          ? candidate.interference->of(camera.operating.error).geometric_mean_m.value
          : geometric_mean_error_m(candidate.error, camera.operating.measure());
  if (!camera.operating.multipath || !candidate.multipath) return error_m;
  return camera.operating.multipath->weighed(
      error_m, candidate.multipath->single_path.of(camera.operating.error).value);
}

DesignResult judge(const Camera& camera, std::vector<Candidate> candidates,
                   const DesignOptions& options, const Progress& progress) {
  require_judgeable(camera, options);
  for (const Candidate& c : candidates) require_fits(c.code, camera);
  DesignResult result{.candidates = std::move(candidates)};
  judge_candidates(camera, options, result, progress);
  report(progress, 1.0, "done");
  return result;
}

}  // namespace tofsmith
