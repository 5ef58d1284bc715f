// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/optimize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "design/binarization.hpp"
#include "design/edge_polish.hpp"
#include "design/optimize_pool.hpp"
#include "design/optimize_starts.hpp"
#include "design/two_return_limit.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/people_text.hpp"
#include "tofsmith/core/shared_progress.hpp"
#include "tofsmith/decode/two_return_decoder.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

constexpr std::uint64_t validation_key = 101, rotation_key = 102, polish_key = 103;

/// A code with a name for the history, on its way to the final choice.
struct Finalist {
  CodeSet code;
  std::string start;
  Estimate error_m;
  std::optional<SecondReturnReport> second_returns = {};  ///< if the camera reckons with them
};

/// What finalists are compared by [m]: the error, with second returns weighed in.
double choice_m(const Finalist& finalist, const Camera& camera) {
  if (!finalist.second_returns) return finalist.error_m.value;
  return camera.operating.multipath->weighed(
      finalist.error_m.value,
      finalist.second_returns->single_path.of(camera.operating.error).value);
}

/// Whether two returns can be told apart, well or badly.
bool tells_two_returns(const CodeSet& code, const Camera& camera) {
  try {
    const TwoReturnDecoder decoder(make_decoding_table(ForwardModel(code, camera), camera));
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

/// Which of the pool are made playable: the best and, on cameras that reckon with second returns,
/// the best few of the others that can be decoded as two returns.
std::vector<PoolEntry> entries_to_play(const DesignProblem& problem, const OptimizePool& pool,
                                       const Camera& camera, const OptimizeOptions& options,
                                       const Sharpness& sharpness) {
  constexpr std::size_t most_others = 3;
  const std::vector<PoolEntry>& all = pool.entries();
  const std::size_t best = std::min(static_cast<std::size_t>(options.refined), all.size());
  std::vector<PoolEntry> chosen(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(best));
  if (!camera.operating.multipath) return chosen;
  for (std::size_t k = best; k < all.size() && chosen.size() < best + most_others; ++k) {
    const SwitchedCode code =
        binarized(problem, render(problem.space, all[k].parameters, sharpness), pool.judge());
    if (tells_two_returns(code_set("optimized", problem.space, code, camera.samples), camera))
      chosen.push_back(all[k]);
  }
  return chosen;
}

/// The best of the pool as codes that can be played: switched, and with polished edges too.
std::vector<Finalist> playable_finalists(const DesignProblem& problem, OptimizePool& pool,
                                         const Camera& camera, const OptimizeOptions& options,
                                         const Progress& progress) {
  const WaveformSpace& space = problem.space;
  Sharpness sharpness{6.0, 8.0};
  if (!problem.binary_modulation) sharpness.modulation = 1.0;
  if (!problem.binary_demodulation) sharpness.demodulation = 1.0;
  const std::vector<PoolEntry> entries = entries_to_play(problem, pool, camera, options, sharpness);
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
          combine_keys(polish_key, static_cast<std::uint64_t>(i)), &shared);
  });
  std::vector<Finalist> finalists;
  for (std::size_t k = 0; k < codes.size(); ++k) {
    const bool polished = k % 2 == 1;
    if (polished && !options.polish) continue;
    const std::string& start = entries[k / 2].start;
    pool.record(polished ? "polish" : "binary", start,
                pool.judge().score(sampled_on(space, codes[k])).log_error_bin);
    finalists.push_back({code_set("optimized", space, codes[k], camera.samples), start, {}});
  }
  return finalists;
}

/// Those of the codes given that the camera can play.
std::vector<Finalist> given_finalists(std::span<const CodeSet> also, const Camera& camera) {
  std::vector<Finalist> finalists;
  for (const CodeSet& code : also) {
    try {
      require_fits(code, camera);
      finalists.push_back({code, "given", {}});
    } catch (const std::invalid_argument&) {
      continue;
    }
  }
  return finalists;
}

/// Error on fresh trials, at the rotation that other trials chose; of the worst variant.
void validate_finalist(Finalist& finalist, std::span<const Camera> variants,
                       const OptimizeOptions& options, const Progress& progress) {
  const Camera& camera = variants.front();
  EvaluateOptions evaluation;
  const auto points = static_cast<std::int64_t>(camera.operating.points().size());
  evaluation.trials = std::clamp<std::int64_t>(options.validation_trials / points, 3000, 40000);
  const ProgressParts parts(progress, 2);
  if (camera.operating.error == DepthErrorKind::linear) {
    evaluation.seed = combine_keys(options.seed, rotation_key);
    std::vector<double> log_error;
    for (const double error_m :
         best_rotation(finalist.code, camera, evaluation, parts[0]).linear_geometric_mean_m)
      log_error.push_back(std::log(std::max(1e-12, error_m)));
    finalist.code = finalist.code.rotated(smoothed_minimum(log_error));
  }
  evaluation.seed = combine_keys(options.seed, validation_key);
  const ProgressParts of_variants(parts[1], variants.size());
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const DepthErrorReport report =
        evaluate(finalist.code, variants[i], evaluation, of_variants[i]);
    const Estimate error_m = report.of(camera.operating.error).geometric_mean_m;
    if (error_m.value > finalist.error_m.value) finalist.error_m = error_m;
  }
}

/// Errors behind second returns of the camera itself, once the code is at its rotation.
void validate_second_returns(Finalist& finalist, const Camera& camera,
                             const OptimizeOptions& options, const Progress& progress) {
  EvaluateOptions evaluation;
  const auto points = static_cast<std::int64_t>(camera.operating.points().size());
  evaluation.trials = std::clamp<std::int64_t>(options.validation_trials / points, 3000, 40000);
  evaluation.seed = combine_keys(options.seed, validation_key);
  finalist.second_returns = second_return_report(finalist.code, camera, *camera.operating.multipath,
                                                 evaluation, progress);
}

std::string describe_second_returns(const Finalist& best, const Finalist* best_given,
                                    DepthErrorKind kind) {
  const auto errors = [&](const Finalist& f) {
    const SecondReturnReport& behind = *f.second_returns;
    return fmt::format("{}, {}, {}", plain_number(1e3 * f.error_m.value, 4),
                       plain_number(1e3 * behind.single_path.of(kind).value, 4),
                       behind.two_return
                           ? plain_number(1e3 * behind.two_return->circular_m.value, 4) + " mm"
                           : "impossible");
  };
  std::string text =
      "of single returns, behind second ones, and those decoded as two: " + errors(best);
  if (best_given && best_given != &best)
    text += fmt::format("; {}: {}", best_given->code.name(), errors(*best_given));
  return text;
}

std::string describe(const Finalist& best, const Finalist* best_given, bool is_given,
                     bool ended_early, const Camera& camera) {
  std::string text;
  if (is_given)
    text = fmt::format("no better code found than {}", best.code.name());
  else if (!best_given)
    text = fmt::format("error {} mm", plain_number(1e3 * choice_m(best, camera), 4));
  else
    text = fmt::format("{:.3g} times better than {}, the best code given",
                       choice_m(*best_given, camera) / choice_m(best, camera),
                       best_given->code.name());
  if (best.second_returns)
    text += "; " + describe_second_returns(best, best_given, camera.operating.error);
  return text + (ended_early ? "; hops ended early, without gain" : "");
}

}  // namespace

void OptimizeOptions::validate() const {
  check_fields(*this, "OptimizeOptions::");
}

OptimizedCode optimize(std::span<const Camera> variants, int exposures,
                       const OptimizeOptions& options, std::span<const CodeSet> also,
                       const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  options.validate();
  const DesignProblem problem =
      make_design_problem(variants, exposures, options.samples, options.two_return_weight);
  const Camera& camera = variants.front();

  // 1. Go downhill from many codes, from changed copies of the best, and once more from the best.
  OptimizePool pool(problem, options, camera.range_m() / problem.space.samples());
  const ProgressParts parts(progress, {40, 35, 10, 5, 10});
  pool.run_starts(also, parts[0]);
  pool.run_hops(parts[1]);
  pool.refine(parts[2]);

  // 2. Make them playable, and let all codes given compete.
  std::vector<Finalist> finalists = playable_finalists(problem, pool, camera, options, parts[3]);
  const std::size_t optimized = finalists.size();
  for (Finalist& given : given_finalists(also, camera)) finalists.push_back(std::move(given));

  // 3. Judge all on the same fresh trials.
  const ProgressParts of_finalists(parts[4], finalists.size());
  for (std::size_t i = 0; i < finalists.size(); ++i) {
    const ProgressParts its(of_finalists[i], {30, camera.operating.multipath ? 70.0 : 0.0});
    validate_finalist(finalists[i], variants, options, its[0]);
    if (camera.operating.multipath) validate_second_returns(finalists[i], camera, options, its[1]);
  }
  TwoReturnLimit two_returns(options.most_two_return_loss);
  for (const Finalist& f : std::span(finalists).subspan(optimized))
    two_returns.add_given(f.second_returns);
  // What two-return decoding copes with badly counts as so many times worse.
  const auto less = [&](const Finalist& a, const Finalist& b) {
    return two_returns.excess(a.second_returns) * choice_m(a, camera) <
           two_returns.excess(b.second_returns) * choice_m(b, camera);
  };
  const auto first_given = finalists.begin() + static_cast<std::ptrdiff_t>(optimized);
  const auto best = std::min_element(finalists.begin(), finalists.end(), less);
  const auto best_given = std::min_element(first_given, finalists.end(), less);
  const Finalist* rival = best_given == finalists.end() ? nullptr : &*best_given;

  OptimizedCode result{.code = best->code, .error_m = best->error_m};
  result.is_given = best >= first_given;
  result.start = best->start;
  result.message = describe(*best, rival, result.is_given, pool.ended_early(), camera);
  for (const Finalist& finalist : finalists)
    result.candidates.push_back({finalist.code.name(), finalist.error_m, finalist.second_returns});
  result.history = std::move(pool.history());
  result.steps =
      pool.steps() +
      (options.polish ? static_cast<std::int64_t>(optimized / 2) * options.polish_steps : 0);
  if (!result.is_given) {
    Provenance& provenance = result.code.provenance;
    provenance.method = "optimize";
    provenance.camera = camera.name;
    provenance.seed = options.seed;
    provenance.version = TOFSMITH_VERSION;
    provenance.depth_error_m = best->error_m.value;
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report(progress, 1.0, "done");
  return result;
}

OptimizedCode optimize(const Camera& camera, int exposures, const OptimizeOptions& options,
                       std::span<const CodeSet> also, const Progress& progress) {
  return optimize(std::span<const Camera>(&camera, 1), exposures, options, also, progress);
}

}  // namespace tofsmith
