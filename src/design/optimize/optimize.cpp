// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/optimize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "core/shared/shared_progress.hpp"
#include "design/designed_code.hpp"
#include "design/optimize/binarization.hpp"
#include "design/optimize/edge_polish.hpp"
#include "design/optimize/optimize_pool.hpp"
#include "design/optimize/optimize_starts.hpp"
#include "design/optimize/optimized_code.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith {

namespace {

constexpr std::uint64_t polish_key = 103;

bool tells_two_returns(const CodeSet& code, const Camera& camera) {
  return !TwoReturnDecoder::why_not_decodable(
      make_decoding_table(ForwardModel(code, camera), camera));
}

/// Selects the best entries and, with operating multipath, the best few others for which two
/// returns can be decoded.
std::vector<PoolEntry> playable_entries(const DesignProblem& problem, const OptimizePool& pool,
                                        const Camera& camera, const OptimizeOptions& options,
                                        const Sharpness& sharpness) {
  constexpr std::size_t max_others = 3;
  const std::vector<PoolEntry>& all = pool.entries();
  const std::size_t best = std::min(static_cast<std::size_t>(options.refined), all.size());
  std::vector<PoolEntry> chosen(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(best));
  if (!camera.operating.multipath) return chosen;
  for (std::size_t k = best; k < all.size() && chosen.size() < best + max_others; ++k) {
    const SwitchedCode code =
        binarized(problem, render(problem.space, all[k].parameters, sharpness), pool.judge());
    if (tells_two_returns(code_set("optimized", problem.space, code, camera.samples), camera))
      chosen.push_back(all[k]);
  }
  return chosen;
}

/// A search with twice the default effort starts with all of the default search, and so on, so more
/// effort never gives a worse code.
std::vector<PoolStage> stages_of(const OptimizeOptions& options) {
  const OptimizeOptions usual;
  std::vector<PoolStage> stages;
  for (int times = 1;
       options.starts >= 2 * times * usual.starts && options.hops >= 2 * times * usual.hops &&
       options.refinement_steps >= 2 * times * usual.refinement_steps;
       times *= 2)
    stages.push_back({times * usual.starts, times * usual.hops, times * usual.refinement_steps});
  stages.push_back({options.starts, options.hops, options.refinement_steps});
  return stages;
}

SearchRecord record_of(const OptimizePool& pool, std::int64_t steps) {
  return {.work_unit = "descents",
          .error_name = "smallest depth error found, in trials of the search",
          .steps = pool.history(),
          .account = fmt::format("{} gradient steps", steps)};
}

/// Converts the best entries to feasible codes, with and without optimized edges.
/// @param before  number of codes from earlier stages
std::vector<Candidate> playable_candidates(const DesignProblem& problem, OptimizePool& pool,
                                           const Camera& camera, const OptimizeOptions& options,
                                           std::uint64_t before, const Progress& progress) {
  const WaveformSpace& space = problem.space;
  Sharpness sharpness{6.0, 8.0};
  if (!problem.binary_modulation) sharpness.modulation = 1.0;
  if (!problem.binary_demodulation) sharpness.demodulation = 1.0;
  const std::vector<PoolEntry> entries =
      playable_entries(problem, pool, camera, options, sharpness);
  const auto count = std::ssize(entries);
  std::vector<SwitchedCode> codes(2 * static_cast<std::size_t>(count));
  SharedProgress shared(progress, static_cast<double>(count) * options.polish_steps, "edges");
  parallel_for(count, [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    codes[2 * k] =
        binarized(problem, render(space, entries[k].parameters, sharpness), pool.judge());
    codes[2 * k + 1] = codes[2 * k];
    if (options.polish)
      codes[2 * k + 1] = polish_edges(
          problem, codes[2 * k], options.polish_steps, options.trials_per_step, options.seed,
          combine_keys(polish_key, before + static_cast<std::uint64_t>(i)), &shared);
  });
  const std::string name = optimized_name(space.exposures);
  std::vector<Candidate> candidates;
  for (std::size_t k = 0; k < codes.size(); ++k) {
    const bool polished = k % 2 == 1;
    if (polished && !options.polish) continue;
    const std::string& start = entries[k / 2].start;
    pool.record(pool.judge().score(sampled_on(space, codes[k])).log_error_bin);
    Candidate candidate{.code = signed_by(code_set(name, space, codes[k], camera.samples),
                                          "optimize", camera, options.seed),
                        .method = "optimize"};
    candidate.message =
        fmt::format("gradient descent from {}{}{}", start, polished ? ", with refined edges" : "",
                    pool.ended_early() ? "; stopped early without further gain" : "");
    candidate.per_measurement = reports_of(candidate.code, start);
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

}  // namespace

void OptimizeOptions::validate() const { check_fields(*this, "OptimizeOptions::"); }

namespace {

std::vector<Candidate> search_codes(std::span<const Camera> variants, int exposures,
                                    const OptimizeOptions& options, std::span<const CodeSet> also,
                                    const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  const DesignProblem problem =
      make_design_problem(variants, exposures, options.samples, options.two_return_weight);
  const Camera camera = in_buckets(variants.front());  // whose codes are searched

  // For every stage:
  // 1. Descend from many codes, from perturbed copies of the best, and again from the best.
  // 2. Convert the best to feasible codes.
  OptimizePool pool(problem, options, camera.range_m() / problem.space.samples());
  const std::vector<PoolStage> stages = stages_of(options);
  std::vector<double> weights;
  for (const PoolStage& stage : stages) weights.push_back(stage.starts);
  const ProgressParts of_stages(progress, weights);
  std::vector<Candidate> candidates;
  for (std::size_t s = 0; s < stages.size(); ++s) {
    const ProgressParts parts(of_stages[s], {40, 35, 10, 15});
    pool.run_starts(stages[s], also, parts[0]);
    pool.run_hops(stages[s], parts[1]);
    pool.refine(stages[s], parts[2]);
    std::vector<Candidate> made =
        playable_candidates(problem, pool, camera, options, candidates.size(), parts[3]);
    std::move(made.begin(), made.end(), std::back_inserter(candidates));
  }

  // 3. Add the record of the search.
  const std::int64_t polished =
      options.polish ? std::ssize(candidates) / 2 * options.polish_steps : 0;
  const std::int64_t steps = pool.steps() + polished;
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (Candidate& c : candidates) {
    c.iterations = static_cast<int>(std::min<std::int64_t>(steps, std::numeric_limits<int>::max()));
    c.seconds = seconds;
    c.search = record_of(pool, steps);
  }
  return candidates;
}

/// Search for analog arms. Codes for binary arms compete and provide one more start.
std::vector<Candidate> search_analog(std::span<const Camera> variants, int exposures,
                                     const OptimizeOptions& options, std::span<const CodeSet> also,
                                     const Progress& progress) {
  const ProgressParts parts(progress, {50, 50});
  std::vector<Camera> switching(variants.begin(), variants.end());
  for (Camera& camera : switching) camera.light.binary = camera.sensor.binary = true;
  std::vector<Candidate> switched = search_codes(switching, exposures, options, also, parts[0]);
  std::vector<CodeSet> starts{switched.back().code.renamed("what switches")};
  starts.insert(starts.end(), also.begin(), also.end());
  std::vector<Candidate> analog = search_codes(variants, exposures, options, starts, parts[1]);
  std::vector<Candidate> candidates = std::move(switched);
  std::move(analog.begin(), analog.end(), std::back_inserter(candidates));
  return candidates;
}

}  // namespace

std::vector<Candidate> optimize(std::span<const Camera> variants, int exposures,
                                const OptimizeOptions& options, std::span<const CodeSet> also,
                                const Progress& progress) {
  options.validate();
  require(!variants.empty(), "variants", variants.size(), "must contain at least one camera");
  const Camera& camera = variants.front();
  const bool is_signed = camera.sensor.is_signed();
  std::vector<CodeSet> starts;
  for (const CodeSet& code : also)
    starts.push_back(code.is_signed() ? code.buckets_of_signed() : code);
  const bool switches = camera.light.binary && camera.sensor.binary;
  std::vector<Candidate> candidates =
      switches ? search_codes(variants, exposures, options, starts, progress)
               : search_analog(variants, exposures, options, starts, progress);
  if (is_signed)
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

std::vector<Candidate> optimize(const Camera& camera, int exposures, const OptimizeOptions& options,
                                std::span<const CodeSet> also, const Progress& progress) {
  return optimize(std::span<const Camera>(&camera, 1), exposures, options, also, progress);
}

}  // namespace tofsmith
