// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/optimize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <utility>

#include "core/shared/shared_progress.hpp"
#include "design/judge.hpp"
#include "design/optimize/edge_polish.hpp"
#include "design/optimize/optimize_pool.hpp"
#include "design/optimize/optimize_starts.hpp"
#include "design/optimize/optimized_code.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {

namespace {

constexpr std::uint64_t polish_key = 103, judging_key = 104, split_key = 105, precise_key = 106,
                        best_judging_key = 107;

bool separates_two_returns(const CodeSet& code, const Camera& camera) {
  return !TwoReturnDecoder::why_not_decodable(
      make_decoding_table(ForwardModel(code, camera), camera));
}

/// Returns the best entries and, with operating multipath, the best others whose two returns can be
/// decoded.
std::vector<PoolEntry> entries_to_finish(const DesignProblem& problem, const OptimizePool& pool,
                                         const Camera& camera, const PoolStage& stage,
                                         const Sharpness& sharpness) {
  constexpr std::ptrdiff_t max_others = 3;
  const std::vector<PoolEntry>& all = pool.entries();
  std::vector<PoolEntry> chosen, others;
  const std::vector<std::size_t> best =
      best_of_starts(all, static_cast<std::size_t>(stage.refined), 2);
  for (const std::size_t i : best) chosen.push_back(all[i]);
  if (!camera.operating.multipath) return chosen;
  for (std::size_t i = 0; i < all.size() && std::ssize(others) < max_others; ++i) {
    if (std::find(best.begin(), best.end(), i) != best.end()) continue;
    const SwitchedCode code =
        binarized(problem, render(problem.space, all[i].parameters, sharpness));
    if (separates_two_returns(code_set("optimized", problem.space, code, camera.samples), camera))
      others.push_back(all[i]);
  }
  chosen.insert(chosen.end(), others.begin(), others.end());
  return chosen;
}

/// Twice the effort repeats all of the default search first, so that it does not lose its code.
std::vector<PoolStage> stages_of(const OptimizeOptions& options) {
  constexpr int starts_per_refined = 6;
  const OptimizeOptions usual;
  std::vector<PoolStage> stages;
  for (int times = 1;
       options.starts >= 2 * times * usual.starts && options.hops >= 2 * times * usual.hops &&
       options.refinement_steps >= 2 * times * usual.refinement_steps;
       times *= 2)
    stages.push_back({times * usual.starts, times * usual.hops, times * usual.refinement_steps});
  stages.push_back({options.starts, options.hops, options.refinement_steps});
  for (PoolStage& stage : stages)
    stage.refined = std::min(options.refined, 1 + stage.starts / starts_per_refined);
  return stages;
}

SearchRecord record_of(const OptimizePool& pool) {
  return {.work_unit = "descents",
          .error_name = "smallest depth error found, in trials of the search",
          .steps = pool.history(),
          .account = fmt::format("{} gradient steps", pool.steps())};
}

/// Judges finished codes by trials that did not select them.
struct FinalJudges {
  FinalJudges(const DesignProblem& problem, const OptimizeOptions& options)
      : of_all(problem, 2 * trials_per_level(problem, options), options.seed, judging_key),
        of_best(problem, 4 * trials_per_level(problem, options), options.seed, best_judging_key) {}

  CodeJudge of_all, of_best;
};

struct FinishedCode {
  SwitchedCode code;
  double log_error_bin = 0.0;
  std::string start;
};

void sort_by_error(std::span<FinishedCode> codes) {
  std::stable_sort(codes.begin(), codes.end(), [](const FinishedCode& a, const FinishedCode& b) {
    return a.log_error_bin < b.log_error_bin;
  });
}

/// Polishes the edges of all entries. Then polishes the two best results again, with less noise,
/// and judges them by more trials, unless another number of exposures is better.
/// @param key     of the random numbers
/// @param before  number of codes from earlier stages, for random numbers
/// @return best first; the errors of the best two are by `judges.of_best`, unless the search lost
std::vector<FinishedCode> finished_codes(const DesignProblem& problem, const FinalJudges& judges,
                                         const std::vector<PoolEntry>& entries, OptimizePool& pool,
                                         const OptimizeOptions& options, std::uint64_t key,
                                         std::uint64_t before, const Progress& progress) {
  constexpr std::size_t polished_again = 2;
  constexpr int more_trials = 4;
  const Sharpness sharpness = final_sharpness(problem);
  const int polish_steps = options.polish ? options.polish_steps : 0;
  const std::size_t again = pool.lost_to_rival() ? 0 : std::min(polished_again, entries.size());
  std::vector<FinishedCode> finished(entries.size());
  SharedProgress shared(progress, static_cast<double>(entries.size() + again) * polish_steps,
                        "edges");
  const auto polish = [&](SwitchedCode& code, int trials, std::uint64_t first_key, std::size_t i) {
    code = polish_edges(problem, std::move(code), polish_steps, trials, options.seed,
                        combine_keys(first_key, before + i), &shared);
  };
  const auto log_error = [&](const CodeJudge& judge, const SwitchedCode& code) {
    return judge.score(sampled_on(problem.space, code)).log_error_bin;
  };
  parallel_for_indices(entries.size(), [&](std::size_t i) {
    FinishedCode& its = finished[i];
    its.start = entries[i].start;
    its.code = binarized(problem, render(problem.space, entries[i].parameters, sharpness));
    polish(its.code, options.trials_per_step, key, i);
    its.log_error_bin = log_error(judges.of_all, its.code);
  });
  sort_by_error(finished);
  parallel_for_indices(again, [&](std::size_t i) {
    FinishedCode& its = finished[i];
    its.log_error_bin = log_error(judges.of_best, its.code);
    if (polish_steps == 0) return;
    FinishedCode precise = its;
    polish(precise.code, more_trials * options.trials_per_step, combine_keys(precise_key, key), i);
    precise.log_error_bin = log_error(judges.of_best, precise.code);
    if (precise.log_error_bin < its.log_error_bin) its = std::move(precise);
  });
  sort_by_error(std::span(finished).first(again));
  pool.add_steps(static_cast<std::int64_t>(entries.size() + again) * polish_steps);
  return finished;
}

std::string_view end_of(const OptimizePool& pool) {
  if (pool.lost_to_rival()) return "; stopped early, because another number of exposures is better";
  return pool.ended_early() ? "; stopped early without further gain" : "";
}

/// Returns the best code or, with operating multipath or interference, all of them, because the
/// optimized error does not contain the whole ranking criterion. Otherwise, judge() would need many
/// more trials to distinguish them.
std::vector<Candidate> candidates_of(const DesignProblem& problem, OptimizePool& pool,
                                     const Camera& camera, const OptimizeOptions& options,
                                     std::vector<FinishedCode> finished) {
  const WaveformSpace& space = problem.space;
  const bool has_other_criterion = camera.operating.multipath || camera.operating.interference;
  if (!has_other_criterion) finished.resize(1);
  std::vector<Candidate> candidates;
  for (const FinishedCode& its : finished) {
    pool.record(its.log_error_bin);
    const CodeSet code = code_set(optimized_name(space.exposures), space, its.code, camera.samples);
    const bool has_shares = !code.exposure_shares().empty();
    Candidate candidate{.code = signed_by(code, "optimize", camera, options.seed),
                        .method = "optimize"};
    candidate.message = fmt::format("gradient descent from {}{}{}{}", its.start,
                                    has_shares ? ", with exposure times" : "",
                                    options.polish ? ", with refined edges" : "", end_of(pool));
    candidate.per_measurement = reports_of(candidate.code, its.start);
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

enum class ExposureTimes { as_in_camera, free };

struct SearchTask {
  ExposureTimes times = ExposureTimes::as_in_camera;
  /// error_to_beat_m() of other numbers of exposures.
  double rival_m = infinity;
};

std::vector<Candidate> search_codes(std::span<const Camera> variants, int exposures,
                                    const OptimizeOptions& options, std::span<const CodeSet> also,
                                    const SearchTask& task, const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  const DesignProblem problem =
      make_design_problem(variants, exposures, options.samples, options.two_return_weight);
  const Camera camera = in_buckets(variants.front());

  // Each stage descends from many codes, from copies of the best codes, and again from the best
  // codes, which become feasible.
  OptimizePool pool(problem, options, also, camera.range_m() / problem.space.samples());
  const FinalJudges judges(problem, options);
  std::vector<PoolStage> stages = stages_of(options);
  std::vector<double> weights;
  for (const PoolStage& stage : stages) weights.push_back(stage.starts);
  const ProgressParts of_stages(progress, weights);
  std::vector<Candidate> candidates;
  std::uint64_t finished_before = 0, split_before = 0;
  const bool splits = task.times == ExposureTimes::free;
  const double splitting = splits ? 40.0 : 0.0;
  for (std::size_t s = 0; s < stages.size(); ++s) {
    const ProgressParts parts(of_stages[s], {40, 35, 10, 15, 0.6 * splitting, 0.4 * splitting});
    PoolStage& stage = stages[s];
    // Earlier stages repeat the search with half the effort, so they never end early.
    const double rival_m = s + 1 == stages.size() ? task.rival_m : infinity;
    pool.run_starts(stage, rival_m, parts[0]);
    pool.run_hops(stage, rival_m, parts[1]);
    if (pool.lost_to_rival())
      stage.refined = std::min(stage.refined, 2);
    else
      pool.refine(stage, parts[2]);
    std::vector<PoolEntry> entries =
        entries_to_finish(problem, pool, camera, stage, final_sharpness(problem));
    std::vector<FinishedCode> finished = finished_codes(problem, judges, entries, pool, options,
                                                        polish_key, finished_before, parts[3]);
    finished_before += finished.size();
    const double least = finished.front().log_error_bin;
    const auto add = [&](std::vector<FinishedCode> codes) {
      std::vector<Candidate> made = candidates_of(problem, pool, camera, options, std::move(codes));
      std::move(made.begin(), made.end(), std::back_inserter(candidates));
    };
    add(std::move(finished));
    if (!splits) continue;
    for (PoolEntry& entry : entries) entry.parameters.shares = Eigen::MatrixXd::Zero(exposures, 1);
    std::vector<PoolEntry> split = pool.with_free_shares(stage, parts[4]);
    std::move(split.begin(), split.end(), std::back_inserter(entries));
    finished =
        finished_codes(problem, judges, entries, pool, options, split_key, split_before, parts[5]);
    split_before += finished.size();
    if (finished.front().log_error_bin < least) add(std::move(finished));
  }

  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (Candidate& c : candidates) {
    c.iterations =
        static_cast<int>(std::min<std::int64_t>(pool.steps(), std::numeric_limits<int>::max()));
    c.seconds = seconds;
    c.search = record_of(pool);
  }
  return candidates;
}

/// Codes for binary arms also compete and provide one more start, so their search never loses to
/// other numbers of exposures.
std::vector<Candidate> search_analog(std::span<const Camera> variants, int exposures,
                                     const OptimizeOptions& options, std::span<const CodeSet> also,
                                     const SearchTask& task, const Progress& progress) {
  const ProgressParts parts(progress, {50, 50});
  std::vector<Camera> switching(variants.begin(), variants.end());
  for (Camera& camera : switching) camera.light.binary = camera.sensor.binary = true;
  std::vector<Candidate> switched =
      search_codes(switching, exposures, options, also, {.times = task.times}, parts[0]);
  std::vector<CodeSet> starts{switched.front().code.renamed("binary code")};
  starts.insert(starts.end(), also.begin(), also.end());
  std::vector<Candidate> analog =
      search_codes(variants, exposures, options, starts, task, parts[1]);
  std::move(analog.begin(), analog.end(), std::back_inserter(switched));
  return switched;
}

std::vector<Candidate> search(std::span<const Camera> variants, int exposures,
                              const OptimizeOptions& options, std::span<const CodeSet> also,
                              const SearchTask& task, const Progress& progress) {
  options.validate();
  require(!variants.empty(), "variants", variants.size(), "must contain at least one camera");
  const Camera& camera = variants.front();
  std::vector<CodeSet> starts;
  for (const CodeSet& code : also)
    starts.push_back(code.is_signed() ? code.buckets_of_signed() : code);
  const bool switches = camera.light.binary && camera.sensor.binary;
  std::vector<Candidate> candidates =
      switches ? search_codes(variants, exposures, options, starts, task, progress)
               : search_analog(variants, exposures, options, starts, task, progress);
  if (camera.sensor.is_signed())
    for (Candidate& c : candidates) {
      c.code = c.code.signed_of_buckets();
      std::vector<MeasurementReport> of_first_buckets;
      for (std::size_t k = 0; k < c.per_measurement.size(); k += 2)
        of_first_buckets.push_back(std::move(c.per_measurement[k]));
      c.per_measurement = std::move(of_first_buckets);
    }
  report(progress, 1.0, "done");
  return candidates;
}

/// With DesignOptions::robust, includes other bandwidths. Gradients do not model other
/// perturbations.
std::vector<Camera> variants_of(const Camera& camera, const DesignOptions& options) {
  std::vector<Camera> variants{camera};
  if (options.robust)
    for (PerturbedCamera& perturbed : perturbations(camera, {.peak = 0.0, .tap_mismatch = 0.0}))
      variants.push_back(std::move(perturbed.camera));
  return variants;
}

/// Returns whether codes are ranked by the error that the search minimizes, and nothing else.
bool minimizes_ranked_error(const Camera& camera, const DesignOptions& options) {
  const OperatingRange& range = camera.operating;
  const bool rounds_values = camera.light.generator || camera.sensor.generator ||
                             camera.sensor.full_well_e || camera.sensor.adc_bits;
  return !range.multipath && !range.interference && range.statistic == ErrorStatistic::mae &&
         !options.robust && !options.split_exposures && !rounds_values;
}

}  // namespace

void OptimizeOptions::validate() const { check_fields(*this, "OptimizeOptions::"); }

std::vector<Candidate> optimize(std::span<const Camera> variants, int exposures,
                                const OptimizeOptions& options, std::span<const CodeSet> also,
                                const Progress& progress) {
  return search(variants, exposures, options, also, {}, progress);
}

std::vector<Candidate> optimize_with_shares(std::span<const Camera> variants, int exposures,
                                            const OptimizeOptions& options,
                                            std::span<const CodeSet> also,
                                            const Progress& progress) {
  for (const Camera& camera : variants)
    require(camera.exposure_s.each_s.empty(), "exposure_s", "a list",
            "must be the total time to optimize exposure times");
  return search(variants, exposures, options, also, {.times = ExposureTimes::free}, progress);
}

std::vector<Candidate> optimize(const Camera& camera, int exposures, const OptimizeOptions& options,
                                std::span<const CodeSet> also, const Progress& progress) {
  return optimize(std::span<const Camera>(&camera, 1), exposures, options, also, progress);
}

std::vector<int> optimizable_exposures(const Camera& camera, const DesignOptions& options,
                                       const Contenders& atlas) {
  constexpr std::size_t max_tried = 3;
  if (!options.exposures.empty()) return options.exposures;
  // The atlas does not consider second returns.
  if (atlas.codes.empty() || camera.operating.multipath)
    return suggested_exposures(camera, DesignMethod::optimize);
  std::vector<int> exposures;
  for (const CodeSet& code : atlas.codes)
    if (exposures.size() < max_tried &&
        std::find(exposures.begin(), exposures.end(), code.exposures()) == exposures.end())
      exposures.push_back(code.exposures());
  return exposures;
}

std::string optimized_name(int exposures) { return fmt::format("optimized-k{}", exposures); }

double error_to_beat_m(const Camera& camera, const DesignOptions& options,
                       std::span<const Candidate> candidates) {
  double least_m = infinity;
  if (!minimizes_ranked_error(camera, options) || !options.exposures.empty()) return least_m;
  for (const Candidate& c : candidates)
    if (c.method == "optimize" && c.search && !c.search->steps.empty())
      least_m = std::min(least_m, c.search->steps.back().error_m);
  return least_m;
}

std::vector<Candidate> optimized_candidates(const Camera& camera, int exposures,
                                            const DesignOptions& options,
                                            const std::vector<CodeSet>& starts, double rival_m,
                                            const Progress& progress) {
  std::vector<CodeSet> also;
  for (const CodeSet& code : starts)
    if (code.exposures() == exposures) also.push_back(code);
  OptimizeOptions of_search = options.optimize;
  of_search.seed = search_seed(options);
  const std::vector<Camera> variants = variants_of(camera, options);
  std::vector<Candidate> candidates =
      options.split_exposures && camera.exposure_s.each_s.empty()
          ? optimize_with_shares(variants, exposures, of_search, also, progress)
          : search(variants, exposures, of_search, also, {.rival_m = rival_m}, progress);
  for (Candidate& c : candidates) c.code.provenance.seed = options.seed;
  return candidates;
}

}  // namespace tofsmith
