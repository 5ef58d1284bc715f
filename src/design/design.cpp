// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/design.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "design/explanation.hpp"
#include "design/factorized_code.hpp"
#include "design/judge.hpp"
#include "design/optimized_code.hpp"
#include "design/searched_code.hpp"
#include "design/shortest_run.hpp"
#include "design/two_return_limit.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/design/standard_chip_codes.hpp"

namespace tofsmith {

namespace {

/// A code that is yet to be designed.
struct Task {
  DesignMethod method;
  std::string name;
  double effort;  ///< share of the time, to show progress by
  std::function<Candidate(const Progress&)> run;
};

bool includes(DesignMethod asked, DesignMethod method) {
  return asked == method || asked == DesignMethod::best;
}

constexpr int samples_of_standard_codes = 360;

/// Notes why something does not compete, once for all that share the reason.
void leave_out(DesignResult& result, const std::string& name, const std::string& reason) {
  const std::string ending = ": " + reason;
  for (std::string& line : result.left_out)
    if (line.ends_with(ending)) {
      const std::string names = line.substr(0, line.size() - ending.size());
      if (names != name) line = fmt::format("{}, {}{}", names, name, ending);
      return;
    }
  result.left_out.push_back(name + ending);
}

/// Lets a code compete as it is, if the camera can play it.
template <typename MakeCode>
void add_baseline(const std::string& name, const std::string& method, const Camera& camera,
                  DesignResult& result, MakeCode&& make_code) {
  try {
    CodeSet code = make_code();
    require_fits(code, camera);
    if (!keeps_shortest_run(code, camera))
      return leave_out(result, name, "has pulses or gaps below sensor.shortest_pulse_s");
    result.candidates.push_back({.code = std::move(code), .method = method});
  } catch (const std::invalid_argument& error) {
    leave_out(result, name, error.what());
  }
}

/// Codes that compete as they are: families, what a sensor of exclusive taps plays if nobody
/// searches, and the naive code of every target.
void add_baselines(const Camera& camera, const DesignOptions& options,
                   const std::vector<TargetSet>& targets, DesignResult& result) {
  for (const std::string& name : options.baselines)
    add_baseline(name, "family", camera, result, [&] { return build_family(name, camera); });
  if (camera.sensor.taps >= 3)
    for (const StandardCode& standard : standard_chip_codes(camera, samples_of_standard_codes))
      if (standard.code.taps() == camera.sensor.taps)
        add_baseline(standard.name, "reference", camera, result,
                     [&] { return standard.code.resampled(camera.samples); });
  for (const TargetSet& target : targets) {
    if (!options.target && result.find(target.name)) continue;  // that family is the naive code
    if (auto code = naive_code(target, camera))
      result.candidates.push_back({.code = std::move(*code), .method = "naive"});
  }
}

/// Where a method cannot serve a camera: a refusal if it was asked for, a note if all were.
template <typename Action>
void where_it_serves(DesignMethod method, const DesignOptions& options, DesignResult& result,
                     Action&& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    if (options.method == method) throw;
    leave_out(result, std::string(name_of(method)), error.what());
  }
}

/// What to design: a code for every target, then for every number of exposures. Tasks refer to all
/// four arguments.
std::vector<Task> tasks_for(const Camera& camera, const DesignOptions& options,
                            const std::vector<TargetSet>& targets, DesignResult& result) {
  std::vector<Task> tasks;
  for (const TargetSet& target : targets)
    tasks.push_back(
        {DesignMethod::factorize, target.name + "-factorized", 1.0, [&](const Progress& part) {
           return factorized_candidate(target, camera, options, part);
         }});
  if (includes(options.method, DesignMethod::search))
    where_it_serves(DesignMethod::search, options, result, [&] {
      for (const int exposures : searchable_exposures(camera, options))
        tasks.push_back({DesignMethod::search, searched_name(exposures), 3.0,
                         [&, exposures](const Progress& part) {
                           return searched_candidate(camera, exposures, options, part);
                         }});
    });
  if (includes(options.method, DesignMethod::optimize))
    where_it_serves(DesignMethod::optimize, options, result, [&] {
      for (const int exposures : optimizable_exposures(camera, options))
        tasks.push_back({DesignMethod::optimize, optimized_name(exposures), 3.0,
                         [&, exposures](const Progress& part) {
                           return optimized_candidate(camera, exposures, options, result.candidates,
                                                      part);
                         }});
    });
  return tasks;
}

/// The code of a task: kept from an earlier run, or designed now.
Candidate run_or_load(const Task& task, const DesignStore& store, const Progress& progress) {
  if (store.load)
    if (std::optional<Candidate> kept = store.load(task.name)) return std::move(*kept);
  Candidate candidate = task.run(progress);
  if (store.save) store.save(candidate);
  return candidate;
}

/// A target may be such that no choice of pairs can tell depth: that is a result, not a failure.
void leave_out_what_tells_no_depth(const Camera& camera, DesignResult& result) {
  std::erase_if(result.candidates, [&](const Candidate& c) {
    if (!c.is_designed()) return false;
    try {
      make_decoding_table(ForwardModel(c.code, camera), camera).validate();
      return false;
    } catch (const std::invalid_argument& error) {
      result.left_out.push_back(fmt::format("{} ({}): {}", c.code.name(), c.message, error.what()));
      return true;
    }
  });
}

/// Judges all candidates, finds the best and judges it on perturbed cameras too.
void judge_all(const Camera& camera, const DesignOptions& options, DesignResult& result,
               const Progress& progress) {
  const ProgressParts parts(progress, {90, options.robust ? 0.0 : 10.0});  // the winner: at last
  const ProgressParts of_candidates(parts[0], result.candidates.size());
  for (std::size_t i = 0; i < result.candidates.size(); ++i) {
    const ProgressParts its(of_candidates[i], {15, options.robust ? 85.0 : 0.0});
    judge(result.candidates[i], camera, options, its[0]);
    if (options.robust) judge_robustness(result.candidates[i], camera, options, its[1]);
  }
  TwoReturnLimit two_returns(options.optimize.most_two_return_loss);
  for (const Candidate& c : result.candidates)
    if (!c.is_designed()) two_returns.add_given(c.second_returns);
  const auto judged_m = [&](const Candidate& c) {
    return two_returns.excess(c.second_returns) * choice_error_m(c, camera, options);
  };
  for (std::size_t i = 1; i < result.candidates.size(); ++i)
    if (judged_m(result.candidates[i]) < judged_m(result.winner())) result.best = i;
  Candidate& winner = result.candidates[result.best];
  if (!winner.robustness) judge_robustness(winner, camera, options, parts[1]);
}

}  // namespace

std::string_view name_of(DesignMethod method) {
  switch (method) {
    case DesignMethod::factorize:
      return "factorize";
    case DesignMethod::optimize:
      return "optimize";
    case DesignMethod::search:
      return "search";
    case DesignMethod::best:
      return "best";
  }
  return "";
}

const Candidate* DesignResult::find(std::string_view name) const {
  for (const Candidate& c : candidates)
    if (c.code.name() == name) return &c;
  return nullptr;
}

double choice_error_m(const Candidate& candidate, const Camera& camera,
                      const DesignOptions& options) {
  if (options.robust && candidate.robustness)
    return candidate.robustness->worst_calibrated_m().value;
  const DepthErrorKind kind = camera.operating.error;
  const double error_m = chosen_error_m(candidate.error, kind);
  if (!camera.operating.multipath || !candidate.second_returns) return error_m;
  return camera.operating.multipath->weighed(error_m,
                                             candidate.second_returns->single_path.of(kind).value);
}

double chosen_error_m(const DepthErrorReport& report, DepthErrorKind kind) {
  return report.of(kind).geometric_mean_m.value;
}

std::vector<const Candidate*> by_chosen_error(const DesignResult& result, DepthErrorKind kind) {
  std::vector<const Candidate*> order;
  for (const Candidate& c : result.candidates) order.push_back(&c);
  std::ranges::stable_sort(order, {},
                           [&](const Candidate* c) { return chosen_error_m(c->error, kind); });
  return order;
}

Estimate gain_over(const DesignResult& result, const Candidate& other, DepthErrorKind kind) {
  const Estimate best = result.winner().error.of(kind).geometric_mean_m;
  const Estimate its = other.error.of(kind).geometric_mean_m;
  const double ratio = its.value / best.value;
  return {ratio,
          ratio * std::hypot(its.standard_error / its.value, best.standard_error / best.value)};
}

DesignResult design(const Camera& camera, const DesignOptions& options, const Progress& progress,
                    const DesignStore& store) {
  options.validate();
  camera.validate();
  require(!options.robust || !camera.operating.multipath, "DesignOptions::robust", "true",
          "must be false where operating.multipath says to reckon with second returns");
  DesignResult result;

  // 1. What there is to factorize; baselines compete as they are.
  std::vector<TargetSet> targets;
  if (includes(options.method, DesignMethod::factorize))
    where_it_serves(DesignMethod::factorize, options, result,
                    [&] { targets = targets_for(camera, options); });
  add_baselines(camera, options, targets, result);

  // 2. Design codes. What is there by then is where the direct optimization starts, and what it has
  //    to beat.
  const std::vector<Task> tasks = tasks_for(camera, options, targets, result);
  std::vector<double> efforts;
  for (const Task& task : tasks) efforts.push_back(task.effort);
  const ProgressParts parts(progress, {80, 20});
  const ProgressParts of_tasks(parts[0], efforts);
  for (std::size_t i = 0; i < tasks.size(); ++i)
    where_it_serves(tasks[i].method, options, result, [&] {
      result.candidates.push_back(run_or_load(tasks[i], store, of_tasks[i]));
    });
  leave_out_what_tells_no_depth(camera, result);
  require(!result.candidates.empty(), "target", fmt::format("{}", fmt::join(result.left_out, "; ")),
          "nothing that was designed can tell depth, and the camera can play no baseline");

  // 3. Judge all with the same fresh random numbers and pick by the camera's depth error.
  judge_all(camera, options, result, parts[1]);
  result.explanation = explain(camera, result);
  report(progress, 1.0, "done");
  return result;
}

}  // namespace tofsmith
