// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/factorize/factorized_code.hpp"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "camera/shared/depth_prior.hpp"
#include "camera/shared/listed_exposures.hpp"
#include "code/shared/family_members.hpp"
#include "core/shared/random.hpp"
#include "design/factorize/alternation.hpp"
#include "design/judge.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr std::uint32_t random_choices = 8;

double search_error_m(const CodeSet& code, const Camera& camera, const EvaluateOptions& options,
                      bool at_best_rotation) {
  const std::optional<CodeOnCamera> on = if_it_has_depth(code, camera);
  if (!on) return std::numeric_limits<double>::infinity();
  if (at_best_rotation && !DepthPrior(camera).is_uniform()) {
    const BestRotation best = best_rotation(*on, options);
    return best.linear_geometric_mean_m[static_cast<std::size_t>(best.rotation_bin)];
  }
  const DepthErrorKind kind = at_best_rotation ? DepthErrorKind::circular : camera.operating.error;
  return geometric_mean_error_m(evaluate(*on, options), kind);
}

/// Errors of choices, each of which is evaluated once.
class ErrorsOfChoices {
 public:
  explicit ErrorsOfChoices(std::function<double(const PairChoice&)> error_of)
      : error_of_(std::move(error_of)) {}

  void evaluate(const std::vector<PairChoice>& choices) {
    std::vector<PairChoice> fresh;
    for (const PairChoice& choice : choices)
      if (!known_.contains(choice)) fresh.push_back(choice);
    std::vector<double> errors_m(fresh.size());
    parallel_for_indices(fresh.size(), [&](std::size_t i) { errors_m[i] = error_of_(fresh[i]); });
    for (std::size_t i = 0; i < fresh.size(); ++i) known_[fresh[i]] = errors_m[i];
  }
  double operator()(const PairChoice& choice) {
    evaluate({choice});
    return known_.at(choice);
  }

 private:
  std::function<double(const PairChoice&)> error_of_;
  std::map<PairChoice, double> known_;
};

PairChoice bettered(PairChoice best, const std::vector<Factorization>& factorizations,
                    ErrorsOfChoices& error_of, const Progress& progress) {
  constexpr int rounds = 3;
  bool improved = true;
  for (int round = 0; improved && round < rounds; ++round) {
    improved = false;
    for (std::size_t k = 0; k < best.size(); ++k) {
      const double done = round + static_cast<double>(k) / static_cast<double>(best.size());
      report(progress, done / rounds, "selecting pairs by depth error");
      std::vector<PairChoice> trials(factorizations[k].candidates.size(), best);
      for (std::size_t i = 0; i < trials.size(); ++i) trials[i][k] = i;
      error_of.evaluate(trials);
      for (const PairChoice& trial : trials) {
        if (error_of(trial) >= error_of(best)) continue;
        best = trial;
        improved = true;
      }
    }
  }
  return best;
}

/// Returns 0 if there is no naive pair.
std::size_t naive_index(const Factorization& factorization) {
  for (std::size_t i = 0; i < factorization.candidates.size(); ++i)
    if (factorization.candidates[i].start == "naive") return i;
  return 0;
}

}  // namespace

CodeSet assemble(const std::string& name, const std::vector<Factorization>& factorizations,
                 const PairChoice& choice, const Camera& camera) {
  std::vector<Waveform> modulation, demodulation;
  for (std::size_t k = 0; k < choice.size(); ++k) {
    const WaveformPair& pair = factorizations[k].candidates[choice[k]].pair;
    modulation.push_back(pair.modulation);
    demodulation.push_back(pair.demodulation);
  }
  const CodeSet code =
      CodeSet::create(name, camera.samples, 1, std::move(modulation), std::move(demodulation));
  return camera.sensor.taps == 2 ? code.with_two_buckets() : code;
}

PairChoice choose_by_depth_error(const std::vector<Factorization>& factorizations,
                                 const Camera& camera, const EvaluateOptions& options,
                                 bool at_best_rotation, const Progress& progress) {
  ErrorsOfChoices error_of([&](const PairChoice& choice) {
    return search_error_m(assemble("candidate", factorizations, choice, camera), camera, options,
                          at_best_rotation);
  });

  // Individually good pairs need not be the best combination.
  std::vector<PairChoice> starts{PairChoice(factorizations.size(), 0), {}};
  for (const Factorization& f : factorizations) starts[1].push_back(naive_index(f));
  for (std::uint32_t i = 0; i < random_choices; ++i) {
    RandomStream random(options.seed, 0xc401ce, i);
    PairChoice& start = starts.emplace_back();
    for (const Factorization& f : factorizations)
      start.push_back(
          static_cast<std::size_t>(random.uniform() * static_cast<double>(f.candidates.size())));
  }
  const ProgressParts parts(progress, starts.size());
  PairChoice best = starts[0];
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const PairChoice found = bettered(starts[i], factorizations, error_of, parts[i]);
    if (error_of(found) < error_of(best)) best = found;
  }
  return best;
}

namespace {

constexpr int min_exposures = 3, max_exposures = 6;  // of Hamiltonian targets

std::vector<int> factorizable_exposures(const Camera& camera, const DesignOptions& options) {
  std::vector<int> exposures = options.exposures;
  if (exposures.empty()) exposures = suggested_exposures(camera, DesignMethod::factorize);
  std::erase_if(exposures,
                [](int count) { return count < min_exposures || count > max_exposures; });
  return exposures;
}

FamilyOptions ideal_on(const Camera& camera) { return {.samples = camera.samples}; }

std::optional<BrokenRule> why_not_designable(const TargetSet& targets, const Camera& on) {
  if (on.sensor.is_signed() && on.sensor.tap_mismatch != 0.0)
    return broken("sensor.tap_mismatch", on.sensor.tap_mismatch,
                  "must be 0 to factorize for sensor.demodulation = \"signed\"");
  const Camera camera = in_buckets(on);
  if (camera.sensor.readout == Readout::rows)
    return broken("sensor.readout", "rows",
                  "must be separate or difference to factorize correlation functions");
  if (camera.sensor.taps > 2)
    return broken("sensor.taps", camera.sensor.taps,
                  "must be 1 or 2 to factorize correlation functions");
  if (targets.samples() != camera.samples)
    return broken("length of the target", targets.samples(),
                  fmt::format("must equal the camera's samples = {}", camera.samples));
  const std::size_t values = targets.measurements.size() * camera.sensor.taps;
  if (values < 3 && camera.sensor.readout != Readout::difference)
    return broken(
        "number of correlation functions", targets.measurements.size(),
        fmt::format("must be >= {}: there are three unknowns, signal, ambient light and depth",
                    camera.sensor.taps == 2 ? 2 : 3));
  return other_exposures_listed(camera, static_cast<int>(targets.measurements.size()),
                                " of " + targets.name);
}

Eigen::MatrixXd target_table(const TargetSet& targets) {
  Eigen::MatrixXd table(targets.samples(), std::ssize(targets.measurements));
  for (Eigen::Index k = 0; k < table.cols(); ++k)
    table.col(k) = targets.measurements[static_cast<std::size_t>(k)].samples;
  return table;
}

/// The pair with the smallest residual shows whether a target is reachable.
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
    text += fmt::format("; this camera cannot reach target {}", unreachable);
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

}  // namespace

std::optional<BrokenRule> why_not_factorizable(const Camera& camera, const DesignOptions& options) {
  if (!options.target)
    for (const int count : factorizable_exposures(camera, options))
      if (auto reason = hamiltonian_misfit(count, ideal_on(camera))) return reason;
  for (const TargetSet& target : targets_for(camera, options))
    if (auto reason = why_not_designable(target, camera)) return reason;
  return std::nullopt;
}

std::vector<TargetSet> targets_for(const Camera& camera, const DesignOptions& options) {
  if (options.target) return {*options.target};
  std::vector<TargetSet> targets;
  for (const int count : factorizable_exposures(camera, options))
    targets.push_back(targets_of(hamiltonian_code(count, ideal_on(camera))));
  return targets;
}

std::optional<CodeSet> naive_code(const TargetSet& targets, const Camera& camera) {
  if (camera.sensor.is_signed()) {
    const auto code = naive_code(targets, in_buckets(camera));
    return code ? std::optional(code->signed_of_buckets()) : std::nullopt;
  }
  std::vector<Factorization> pairs;
  for (const CorrelationTarget& target : targets.measurements) {
    pairs.push_back({.candidates = naive_start(PairModel(target, camera))});
    if (pairs.back().candidates.empty()) return std::nullopt;
  }
  constexpr std::uint64_t no_seed = 0;  // nothing is searched
  return signed_by(assemble(targets.name + "-naive", pairs, PairChoice(pairs.size(), 0), camera),
                   "naive", camera, no_seed);
}

Candidate factorized_candidate(const TargetSet& targets, const Camera& on,
                               const DesignOptions& options, const Progress& progress) {
  const Camera camera = in_buckets(on);
  const ProgressParts parts(progress, {40, 60});
  const auto begin = std::chrono::steady_clock::now();
  FactorizeOptions factorizing_options = options.factorize;
  factorizing_options.seed = options.seed;
  std::vector<Factorization> factorizations;
  const ProgressParts of_targets(parts[0], targets.measurements.size());
  for (const CorrelationTarget& target : targets.measurements)
    factorizations.push_back(
        factorize(target, camera, factorizing_options, of_targets[factorizations.size()]));
  const EvaluateOptions search{
      .trials = options.search_trials, .seed = search_seed(options), .bounds = false};
  const PairChoice choice =
      choose_by_depth_error(factorizations, camera, search, rotates(camera, options), parts[1]);
  CodeSet code = assemble(targets.name + "-factorized", factorizations, choice, camera);
  if (on.sensor.is_signed()) code = code.signed_of_buckets();
  Candidate candidate{.code = signed_by(std::move(code), "factorize", camera, options.seed),
                      .method = "factorize",
                      .target = target_table(targets)};
  for (std::size_t k = 0; k < choice.size(); ++k) {
    const Factorization& f = factorizations[k];
    candidate.per_measurement.push_back(measurement_report(f, f.candidates[choice[k]]));
    candidate.code.provenance.residuals.push_back(candidate.per_measurement.back().residual_rms);
    for (const int iterations : f.iterations_per_start) candidate.iterations += iterations;
  }
  candidate.message = describe_residuals(candidate.per_measurement, factorizations);
  candidate.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return candidate;
}

}  // namespace tofsmith
