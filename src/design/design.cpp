// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/design.hpp"

#include <fmt/format.h>

#include <chrono>

#include "design/pair_choice.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/code/hamiltonian.hpp"
#include "tofsmith/core/error.hpp"

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

Eigen::MatrixXd target_table(const TargetSet& targets) {
  Eigen::MatrixXd table(targets.samples(), std::ssize(targets.measurements));
  for (Eigen::Index k = 0; k < table.cols(); ++k)
    table.col(k) = targets.measurements[static_cast<std::size_t>(k)].samples;
  return table;
}

/// The circular error does not depend on the origin.
bool rotates(const Camera& camera, const DesignOptions& options) {
  return options.best_rotation && camera.operating.error == DepthErrorKind::linear;
}

/// How near the correlation functions are to their targets, in one line.
std::string describe_residuals(const std::vector<MeasurementReport>& reports,
                               const std::vector<Factorization>& factorizations) {
  std::string residuals, unreachable;
  bool exact = true;
  for (std::size_t k = 0; k < reports.size(); ++k) {
    exact = exact && reports[k].residual_rms < 1e-6;
    residuals += fmt::format("{}{:.3g}", k ? ", " : "", reports[k].residual_rms);
    if (reports[k].residual_rms > 0.5 * factorizations[k].target_variation_rms)
      unreachable += fmt::format("{}{}", unreachable.empty() ? "" : ", ", k + 1);
  }
  if (exact) return "all targets reached exactly";
  std::string text = "residuals " + residuals + " rms";
  if (!unreachable.empty())
    text += fmt::format("; target {} out of reach of this camera", unreachable);
  return text;
}

MeasurementReport measurement_report(const Factorization& f, const PairCandidate& chosen) {
  return {.residual_rms = chosen.residual_rms,
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
  search.seed = options.seed;
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

/// Judges a candidate with fresh random numbers, at its best origin if asked.
void judge(Candidate& candidate, const Camera& camera, const DesignOptions& options,
           const Progress& progress) {
  EvaluateOptions judging;
  judging.trials = options.trials;
  judging.seed = options.seed + 1;  // not the numbers it was chosen by
  if (rotates(camera, options)) {
    EvaluateOptions search;
    search.trials = options.trials;
    search.seed = options.seed;
    candidate.rotation_bin =
        best_rotation(candidate.code, camera, search, part_of(progress, 0.0, 0.5)).rotation_bin;
    candidate.code = candidate.code.rotated(candidate.rotation_bin);
  }
  candidate.error = evaluate(candidate.code, camera, judging, part_of(progress, 0.5, 1.0));
  candidate.code.provenance.depth_error_m = chosen_error_m(candidate.error, camera.operating.error);
}

}  // namespace

void DesignOptions::validate() const {
  for (const int e : exposures)
    require(e >= 3 && e <= 6, "DesignOptions::exposures", e, "each must be in [3, 6]");
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
  DesignResult result;

  // 1. Baselines compete as they are.
  for (const std::string& name : options.baselines) {
    try {
      result.candidates.push_back({.code = build_family(name, camera), .method = "family"});
    } catch (const std::invalid_argument& error) {
      result.left_out.push_back(fmt::format("{}: {}", name, error.what()));
    }
  }

  // 2. Design a code for every target.
  const std::vector<TargetSet> targets = targets_for(camera, options);
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
