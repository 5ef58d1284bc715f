// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/design.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>

#include "design/pair_choice.hpp"
#include "design/pair_model.hpp"
#include "design/start_pool.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/code/hamiltonian.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

/// Ideal correlation functions to aim at: the user's, or Hamiltonian ones.
std::vector<TargetSet> targets_for(const Camera& camera, const DesignOptions& options) {
  if (options.target) return {*options.target};
  std::vector<TargetSet> targets;
  for (const int exposures : options.exposures)
    targets.push_back(targets_of(hamiltonian_code(exposures, {.samples = camera.samples})));
  return targets;
}

/// Whether codes for these targets can be played at all, before time is spent on them.
void require_designable(const TargetSet& targets, const Camera& camera) {
  require(camera.sensor.taps <= 2, "sensor.taps", camera.sensor.taps,
          "must be 1 or 2 to factorize correlation functions");
  require(targets.samples() == camera.samples, "length of the target", targets.samples(),
          fmt::format("must equal the camera's samples = {}", camera.samples));
  const std::size_t values = targets.measurements.size() * camera.sensor.taps;
  require(values >= 3 || camera.sensor.readout == Readout::difference,
          "number of correlation functions", targets.measurements.size(),
          fmt::format("must be >= {}: signal, ambient light and depth are unknown",
                      camera.sensor.taps == 2 ? 2 : 3));
  const std::size_t listed = camera.exposure_s.each_s.size();
  require(
      listed == 0 || listed == targets.measurements.size(), "number of exposure_s", listed,
      fmt::format("must equal the {} exposures of {}", targets.measurements.size(), targets.name));
}

/// What a designer would play for the targets without optimization: the ideal demodulation with one
/// pulse each. None if that is not known or cannot be played.
std::optional<CodeSet> naive_code(const TargetSet& targets, const Camera& camera) {
  std::vector<Factorization> pairs;
  for (const CorrelationTarget& target : targets.measurements) {
    pairs.push_back({.candidates = naive_start(PairModel(target, camera))});
    if (pairs.back().candidates.empty()) return std::nullopt;
  }
  CodeSet code = assemble(targets.name + "-naive", pairs, PairChoice(pairs.size(), 0), camera);
  code.provenance.method = "naive";
  code.provenance.camera = camera.name;
  return code;
}

Eigen::MatrixXd target_table(const TargetSet& targets) {
  Eigen::MatrixXd table(targets.samples(), std::ssize(targets.measurements));
  for (Eigen::Index k = 0; k < table.cols(); ++k)
    table.col(k) = targets.measurements[static_cast<std::size_t>(k)].samples;
  return table;
}

/// Codes and origins are chosen by other random numbers than they are judged by. The judge's are
/// those of evaluate() with the same seed.
std::uint64_t search_seed(const DesignOptions& options) { return options.seed + 1; }

/// The circular error does not depend on the origin.
bool rotates(const Camera& camera, const DesignOptions& options) {
  return options.best_rotation && camera.operating.error == DepthErrorKind::linear;
}

/// How near the correlation functions are to their targets, in one line. Whether a target is within
/// reach is a matter of the pair that comes closest, not of the one that measures depth best.
std::string describe_residuals(const std::vector<MeasurementReport>& reports,
                               const std::vector<Factorization>& factorizations) {
  std::string residuals, smallest, unreachable;
  bool exact = true, closest = true;
  for (std::size_t k = 0; k < reports.size(); ++k) {
    exact = exact && reports[k].residual_rms < 1e-6;
    residuals += fmt::format("{}{:.3g}", k ? ", " : "", reports[k].residual_rms);
    smallest += fmt::format("{}{:.3g}", k ? ", " : "", reports[k].smallest_residual_rms);
    closest = closest && reports[k].residual_rms < 1.01 * reports[k].smallest_residual_rms + 1e-9;
    if (reports[k].smallest_residual_rms > 0.5 * factorizations[k].target_variation_rms)
      unreachable += fmt::format("{}{}", unreachable.empty() ? "" : ", ", k + 1);
  }
  if (exact) return "all targets reached exactly";
  std::string text = fmt::format("residuals {} rms", residuals);
  if (!closest) text += fmt::format(" (chosen by depth error; smallest found {})", smallest);
  if (!unreachable.empty())
    text += fmt::format("; target {} out of reach of this camera", unreachable);
  return text;
}

MeasurementReport measurement_report(const Factorization& f, const PairCandidate& chosen) {
  return {.residual_rms = chosen.residual_rms,
          .smallest_residual_rms = f.best().residual_rms,
          .demodulation_duty = chosen.pair.demodulation.mean(),
          .modulation_duty = chosen.pair.modulation.duty(),
          .peak = chosen.pair.modulation.peak(),
          .edges = chosen.pair.modulation.edges() + chosen.pair.demodulation.edges(),
          .start = chosen.start,
          .history = f.history};
}

/// Steps 1 to 3 for one target; not judged yet.
Candidate factorized_candidate(const TargetSet& targets, const Camera& camera,
                               const DesignOptions& options, const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  // 1. Factorize every measurement by itself.
  std::vector<Factorization> factorizations;
  const double count = static_cast<double>(targets.measurements.size());
  for (const CorrelationTarget& target : targets.measurements) {
    const double done = static_cast<double>(factorizations.size());
    factorizations.push_back(
        factorize(target, camera, options.factorize,
                  part_of(progress, 0.7 * done / count, 0.7 * (done + 1) / count)));
  }
  // 2. Choose among the pairs by the depth error of the whole code.
  EvaluateOptions search;
  search.trials = options.search_trials;
  search.seed = search_seed(options);
  const PairChoice choice = choose_by_depth_error(
      factorizations, camera, search, rotates(camera, options), part_of(progress, 0.7, 1.0));
  // 3. Put the code together and say how near its target it is.
  Candidate candidate{
      .code = assemble(targets.name + "-factorized", factorizations, choice, camera),
      .method = "factorize",
      .target = target_table(targets)};
  Provenance& provenance = candidate.code.provenance;
  provenance.method = "factorize";
  provenance.camera = camera.name;
  provenance.seed = options.seed;
  provenance.version = TOFSMITH_VERSION;
  for (std::size_t k = 0; k < choice.size(); ++k) {
    const Factorization& f = factorizations[k];
    candidate.per_measurement.push_back(measurement_report(f, f.candidates[choice[k]]));
    provenance.residuals.push_back(candidate.per_measurement.back().residual_rms);
    for (const int iterations : f.iterations_per_start) candidate.iterations += iterations;
  }
  candidate.message = describe_residuals(candidate.per_measurement, factorizations);
  candidate.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return candidate;
}

/// Judges a candidate with random numbers it was not chosen by, at its best origin if asked.
void judge(Candidate& candidate, const Camera& camera, const DesignOptions& options,
           const Progress& progress) {
  EvaluateOptions judging;
  judging.trials = options.trials;
  judging.seed = options.seed;
  if (rotates(camera, options)) {
    EvaluateOptions search = judging;
    search.seed = search_seed(options);
    candidate.rotation_bin =
        best_rotation(candidate.code, camera, search, part_of(progress, 0.0, 0.5)).rotation_bin;
    candidate.code = candidate.code.rotated(candidate.rotation_bin);
  }
  candidate.error = evaluate(candidate.code, camera, judging, part_of(progress, 0.5, 1.0));
  candidate.code.provenance.depth_error_m = chosen_error_m(candidate.error, camera.operating.error);
}

}  // namespace

void DesignOptions::validate() const {
  for (const int e : exposures) {
    require(e >= 3 && e <= 6, "DesignOptions::exposures", e, "each must be in [3, 6]");
    require(std::ranges::count(exposures, e) == 1, "DesignOptions::exposures", e,
            "must be listed once");
  }
  for (const std::string& name : baselines)
    require(std::ranges::count(baselines, name) == 1, "DesignOptions::baselines", name,
            "must be listed once");
  require(!target || !target->measurements.empty(), "DesignOptions::target", "[]",
          "must hold at least one correlation function");
  require(search_trials >= 100, "DesignOptions::search_trials", search_trials, "must be >= 100");
  require(trials >= 1000, "DesignOptions::trials", trials, "must be >= 1000");
  require(!exposures.empty() || target.has_value() || !baselines.empty(),
          "DesignOptions::exposures", "[]", "must list something to design");
  factorize.validate();
}

const Candidate* DesignResult::find(std::string_view name) const {
  for (const Candidate& c : candidates)
    if (c.code.name() == name) return &c;
  return nullptr;
}

double chosen_error_m(const DepthErrorReport& report, DepthErrorKind kind) {
  return report.of(kind).geometric_mean_m.value;
}

DesignResult design(const Camera& camera, const DesignOptions& options, const Progress& progress,
                    const DesignStore& store) {
  options.validate();
  camera.validate();
  const std::vector<TargetSet> targets = targets_for(camera, options);
  for (const TargetSet& target : targets) require_designable(target, camera);
  DesignResult result;

  // 1. Baselines compete as they are, and so does the naive code of every target.
  for (const std::string& name : options.baselines) {
    try {
      CodeSet code = build_family(name, camera);
      require_fits(code, camera);
      result.candidates.push_back({.code = std::move(code), .method = "family"});
    } catch (const std::invalid_argument& error) {
      result.left_out.push_back(fmt::format("{}: {}", name, error.what()));
    }
  }

  for (const TargetSet& target : targets) {
    if (!options.target && result.find(target.name)) continue;  // that family is the naive code
    if (auto code = naive_code(target, camera))
      result.candidates.push_back({.code = std::move(*code), .method = "naive"});
  }
  require(!result.candidates.empty() || !targets.empty(), "DesignOptions::baselines",
          fmt::format("{}", fmt::join(options.baselines, ", ")),
          "the camera can play none of them");

  // 2. Design a code for every target.
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const double count = static_cast<double>(targets.size());
    const Progress part = part_of(progress, 0.8 * static_cast<double>(t) / count,
                                  0.8 * static_cast<double>(t + 1) / count);
    std::optional<Candidate> kept;
    if (store.load) kept = store.load(targets[t].name + "-factorized");
    if (!kept) {
      kept = factorized_candidate(targets[t], camera, options, part);
      if (store.save) store.save(*kept);
    }
    result.candidates.push_back(std::move(*kept));
  }

  // A target may be such that no choice of pairs can tell depth: that is a result, not a failure.
  std::erase_if(result.candidates, [&](const Candidate& c) {
    if (c.method != "factorize") return false;
    try {
      make_decoding_table(ForwardModel(c.code, camera), camera).validate();
      return false;
    } catch (const std::invalid_argument& error) {
      result.left_out.push_back(fmt::format("{} ({}): {}", c.code.name(), c.message, error.what()));
      return true;
    }
  });
  require(!result.candidates.empty(), "target", fmt::format("{}", fmt::join(result.left_out, "; ")),
          "nothing that was designed can tell depth");

  // 3. Judge all with the same fresh random numbers and pick by the camera's depth error.
  for (std::size_t i = 0; i < result.candidates.size(); ++i) {
    const double count = static_cast<double>(result.candidates.size());
    judge(result.candidates[i], camera, options,
          part_of(progress, 0.8 + 0.2 * static_cast<double>(i) / count,
                  0.8 + 0.2 * static_cast<double>(i + 1) / count));
    if (chosen_error_m(result.candidates[i].error, camera.operating.error) <
        chosen_error_m(result.winner().error, camera.operating.error))
      result.best = i;
  }
  report(progress, 1.0, "done");
  return result;
}

}  // namespace tofsmith
