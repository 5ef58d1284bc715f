// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "design/baselines.hpp"
#include "design/chips/chip_candidates.hpp"
#include "design/exposure_split.hpp"
#include "design/factorize/factorized_code.hpp"
#include "design/frequencies/frequency_design.hpp"
#include "design/judge.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/optimized_code.hpp"
#include "design/rows/dim_light.hpp"
#include "design/rows/tone_rows.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

void DesignOptions::validate() const {
  check_fields(*this, "DesignOptions::");
  for (const int e : exposures) {
    require(std::count(exposures.begin(), exposures.end(), e) == 1, "DesignOptions::exposures", e,
            "must be listed once");
    require(method != DesignMethod::factorize || (e >= 3 && e <= 6), "DesignOptions::exposures", e,
            "must be in [3, 6] for Hamiltonian targets");
  }
  if (baselines)
    for (const std::string& name : *baselines)
      require(std::count(baselines->begin(), baselines->end(), name) == 1,
              "DesignOptions::baselines", name, "must be listed once");
  require(!target || !target->measurements.empty(), "DesignOptions::target", "[]",
          "must contain at least one correlation function");
  factorize.validate();
  optimize.validate();
  search.validate();
}

DesignOptions with_effort(DesignOptions options, double effort) {
  require(effort == 0.0 || (effort >= 0.01 && effort <= 100.0), "effort", effort,
          "must be 0 or in [0.01, 100]");
  if (effort == 0.0) {
    require(options.method == DesignMethod::best || options.method == DesignMethod::atlas, "effort",
            effort, "must be > 0 for methods that only search");
    options.method = DesignMethod::atlas;
    return options;
  }
  scale_by_effort(options, effort);
  return options;
}

namespace {

struct Task {
  DesignMethod method;
  std::string name;
  double effort;
  std::optional<BrokenRule> why_not;
  std::function<std::vector<Candidate>(const Progress&)> run;
};

BrokenRule no_code_found(const std::string& name) {
  return broken(name, "none", "no code on the camera's chip clock distinguishes all depths");
}

bool includes(DesignMethod asked, DesignMethod method) {
  return asked == method || asked == DesignMethod::best;
}

/// Throws if this method was requested; otherwise records the reason.
bool serves(DesignMethod method, const std::optional<BrokenRule>& why_not,
            const DesignOptions& options, DesignResult& result) {
  if (options.method == method) require(why_not);
  if (why_not) leave_out(result, std::string(name_of(method)), why_not->text());
  return !why_not;
}

std::vector<CodeSet> starts_of(const std::vector<CodeSet>& atlas_codes,
                               const DesignResult& result) {
  std::vector<CodeSet> starts = atlas_codes;
  for (const Candidate& c : result.candidates)
    if (c.method != "atlas") starts.push_back(c.code);
  return starts;
}

/// One task per target, then one per number of exposures. Tasks keep references to all arguments.
std::vector<Task> tasks_for(const Camera& camera, const DesignOptions& options,
                            const std::vector<TargetSet>& targets, const Contenders& atlas,
                            DesignResult& result) {
  std::vector<Task> tasks;
  for (const TargetSet& target : targets)
    tasks.push_back({DesignMethod::factorize, target.name + "-factorized", 1.0, std::nullopt,
                     [&](const Progress& part) -> std::vector<Candidate> {
                       return {factorized_candidate(target, camera, options, part)};
                     }});
  const bool has_rows = camera.sensor.readout == Readout::rows;
  if (has_rows && includes(options.method, DesignMethod::optimize))
    for (const int rows : designable_rows(options))
      tasks.push_back({DesignMethod::optimize, rows_name(rows), 3.0,
                       why_no_row_design(camera, rows), [&, rows](const Progress& part) {
                         return row_candidates(camera, rows, options, part);
                       }});
  // With `best`, search only if the camera has a shortest pulse, which defines its chips.
  const bool searches = options.method == DesignMethod::search ||
                        (options.method == DesignMethod::best && camera.sensor.shortest_pulse_s);
  if (!has_rows && searches &&
      serves(DesignMethod::search, why_nothing_to_search(camera, options), options, result))
    for (const int exposures : searchable_exposures(camera, options))
      tasks.push_back({DesignMethod::search, searched_name(exposures), 3.0,
                       why_not_searchable(camera, exposures), [&, exposures](const Progress& part) {
                         return searched_candidates(camera, exposures, options, part);
                       }});
  if (!has_rows && includes(options.method, DesignMethod::optimize))
    for (const int exposures : optimizable_exposures(camera, options, atlas))
      tasks.push_back(
          {DesignMethod::optimize, optimized_name(exposures), 3.0,
           why_not_optimizable(camera, exposures), [&, exposures](const Progress& part) {
             return optimized_candidates(camera, exposures, options, starts_of(atlas.codes, result),
                                         error_to_beat_m(camera, options, result.candidates), part);
           }});
  std::erase_if(
      tasks, [&](const Task& task) { return !serves(task.method, task.why_not, options, result); });
  return tasks;
}

std::vector<Candidate> run_or_load(const Task& task, const DesignStore& store,
                                   const Progress& progress) {
  if (store.load)
    if (std::vector<Candidate> kept = store.load(task.name); !kept.empty()) return kept;
  std::vector<Candidate> candidates = task.run(progress);
  if (store.save && !candidates.empty()) store.save(task.name, candidates);
  return candidates;
}

}  // namespace

const Candidate* DesignResult::find(std::string_view name) const {
  for (const Candidate& c : candidates)
    if (c.code.name() == name) return &c;
  return nullptr;
}

std::vector<const Candidate*> by_geometric_mean_error(const DesignResult& result,
                                                      DepthErrorMeasure measure) {
  std::vector<const Candidate*> order;
  for (const Candidate& c : result.candidates) order.push_back(&c);
  std::stable_sort(order.begin(), order.end(), [&](const Candidate* a, const Candidate* b) {
    return geometric_mean_error_m(a->error, measure) < geometric_mean_error_m(b->error, measure);
  });
  return order;
}

Estimate gain_over(const DesignResult& result, const Candidate& other, DepthErrorMeasure measure) {
  return ratio_of(other.error.of(measure).geometric_mean_m,
                  result.winner().error.of(measure).geometric_mean_m);
}

namespace {

void require_exposures(const Camera& camera, const DesignOptions& options) {
  constexpr int max_exposures = 8;
  if (camera.sensor.readout == Readout::rows) {
    for (const int rows : options.exposures)
      require(rows >= min_designed_rows && rows <= max_exposure_rows, "DesignOptions::exposures",
              rows,
              fmt::format(
                  "must be in [{}, {}] for a camera that reads rows: the number of rows to design",
                  min_designed_rows, max_exposure_rows));
    return;
  }
  for (const int exposures : options.exposures)
    require(exposures <= max_exposures, "DesignOptions::exposures", exposures,
            fmt::format("must be in [1, {}]; up to {} are rows of one exposure", max_exposures,
                        max_exposure_rows));
}

DesignResult design_frequencies(const Camera& camera, const DesignOptions& options,
                                const Progress& progress) {
  DesignResult result;
  DesignOptions named = options;
  named.baselines = options.baselines.value_or(std::vector<std::string>());
  add_baselines(camera, named, {}, result);
  const ProgressParts parts(progress, {60, 20, 20});
  add_frequency_candidates(camera, options, result, parts[0]);
  judge_candidates(camera, options, result, parts[1]);
  if (auto price = price_of_frequencies(camera, options, result, parts[2]))
    result.explanation.push_back(std::move(*price));
  report(progress, 1.0, "done");
  return result;
}

}  // namespace

DesignResult design(const Camera& camera, const DesignOptions& options, const Progress& progress,
                    const DesignStore& store) {
  require_judgeable(camera, options);
  require_exposures(camera, options);
  if (options.method == DesignMethod::frequencies)
    return design_frequencies(camera, options, progress);
  DesignResult result;

  std::vector<TargetSet> targets;
  if (includes(options.method, DesignMethod::factorize) &&
      serves(DesignMethod::factorize, why_not_factorizable(camera, options), options, result))
    targets = targets_for(camera, options);
  add_baselines(camera, options, targets, result);
  const Contenders atlas = contending_atlas_codes(camera, options);
  add_atlas_codes(atlas, result);

  const std::vector<Task> tasks = tasks_for(camera, options, targets, atlas, result);
  std::vector<double> efforts;
  for (const Task& task : tasks) efforts.push_back(task.effort);
  const ProgressParts parts(progress, {80, options.split_exposures ? 10.0 : 0.0, 20});
  const ProgressParts of_tasks(parts[0], efforts);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    std::vector<Candidate> made = run_or_load(tasks[i], store, of_tasks[i]);
    if (made.empty()) serves(tasks[i].method, no_code_found(tasks[i].name), options, result);
    std::move(made.begin(), made.end(), std::back_inserter(result.candidates));
  }

  if (options.split_exposures) add_split_exposures(camera, options, result, parts[1]);

  // Judge all with the same fresh random numbers.
  judge_candidates(camera, options, result, parts[2]);
  if (camera.sensor.readout == Readout::rows)
    if (auto note = dim_light_note(camera, result, options))
      result.explanation.push_back(std::move(*note));
  report(progress, 1.0, "done");
  return result;
}

}  // namespace tofsmith
