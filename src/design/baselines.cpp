// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/baselines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "code/shared/family_members.hpp"
#include "design/atlas/nearest_codes.hpp"
#include "design/chips/chip_candidates.hpp"
#include "design/factorize/factorized_code.hpp"
#include "design/judge.hpp"
#include "design/rows/tone_rows.hpp"
#include "design/run_lengths.hpp"
#include "simulate/shared/error_by_rotation.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

int useful_harmonics(const Camera& camera) {
  if (!camera.band_limited()) return 0;
  const int highest = 4 * camera.samples;
  const Eigen::VectorXcd transfer = camera.transfer(highest);
  // A Hann response equals this value at its f_max, up to rounding.
  constexpr double end_of_band = (1.0 - 1e-9) / 25.0;
  int last = 1;
  while (last < highest && std::abs(transfer[last + 1]) >= end_of_band) ++last;
  return last;
}

std::vector<int> suggested_exposures(const Camera& camera, DesignMethod method) {
  const std::size_t listed = camera.exposure_s.each_s.size();
  const std::size_t ordered = camera.playback ? camera.playback->order.size() : 0;
  if (listed > 0 || ordered > 0) return {static_cast<int>(std::max(listed, ordered))};
  const int taps = camera.sensor.taps;
  if (method == DesignMethod::factorize) return {3, 4, 5};
  if (method == DesignMethod::search) return {1, 2};
  if (taps >= 3) return {1, 2, 3};
  if (taps == 2) return {2, 3, 4};
  const int harmonics = useful_harmonics(camera);
  if (harmonics == 0 || harmonics > 15) return {4, 5, 6};
  return {3, 4, 5};
}

namespace {

constexpr int samples_of_standard_codes = 360;
constexpr const char* short_runs = "has pulses or gaps below sensor.shortest_pulse_s";

/// Quick screening: a first evaluation with fewer trials excludes poor codes.
constexpr int min_trials_per_point = 1000, trials_of_all_points = 25000, first_look_divisor = 20;
constexpr double contending = 1.12, far = 1.5;
constexpr std::size_t max_contenders = 8, max_atlas_codes = 4;

int trials_per_point(const Camera& camera) {
  const auto points = static_cast<int>(camera.operating.points().size());
  return std::max(min_trials_per_point, trials_of_all_points / std::max(1, points));
}

/// With the light of other cameras, if the camera has operating.interference.
double circular_error_m(const CodeOnCamera& on, const Camera& camera,
                        const EvaluateOptions& options) {
  if (camera.operating.interference)
    return interference_error(on.code, camera, options).circular.geometric_mean_m.value;
  return geometric_mean_error_m(evaluate(on, options),
                                {DepthErrorKind::circular, camera.operating.statistic});
}

double first_error_m(const CodeOnCamera& on, const Camera& camera, int trials, std::uint64_t seed) {
  const EvaluateOptions options{.trials = trials, .seed = seed, .bounds = false};
  // Circular errors with interference are the same at every origin.
  if (camera.operating.interference || !rotates(camera, {}))
    return circular_error_m(on, camera, options);
  // Without smoothing, the least error of a poor code is often less by chance.
  const std::vector<double> of_rotation =
      smoothed_over_rotations(best_rotation(on, options).linear_geometric_mean_m);
  return *std::min_element(of_rotation.begin(), of_rotation.end());
}

using Reasons = std::vector<std::optional<std::string>>;

/// Infinite for null pointers and for codes with a reason.
/// @param reasons  why codes do not compete; receives the reason of each code without depth
std::vector<double> first_errors_m(const std::vector<const CodeSet*>& codes, const Camera& camera,
                                   int trials, std::uint64_t seed, Reasons& reasons) {
  std::vector<double> errors_m(codes.size(), infinity);
  parallel_for_indices(codes.size(), [&](std::size_t at) {
    if (!codes[at] || reasons[at]) return;
    const CodeOnCamera on(*codes[at], camera);
    reasons[at] = why_not_decodable(on.table);
    if (!reasons[at]) errors_m[at] = first_error_m(on, camera, trials, seed);
  });
  return errors_m;
}

std::vector<double> errors_of_contenders_m(std::vector<const CodeSet*> codes, const Camera& camera,
                                           std::uint64_t seed, Reasons& reasons) {
  const int trials = trials_per_point(camera);
  std::vector<double> errors_m =
      first_errors_m(codes, camera, std::max(1, trials / first_look_divisor), seed, reasons);
  if (errors_m.empty()) return errors_m;
  const double least = *std::min_element(errors_m.begin(), errors_m.end());
  for (std::size_t i = 0; i < codes.size(); ++i)
    if (!(errors_m[i] <= far * least)) codes[i] = nullptr;
  const std::vector<double> by_all_m = first_errors_m(codes, camera, trials, seed, reasons);
  for (std::size_t i = 0; i < codes.size(); ++i)
    if (codes[i]) errors_m[i] = by_all_m[i];
  return errors_m;
}

/// Returns errors or, with operating.interference, errors relative to the least: the smaller of the
/// ratios with and without interference, so that the best codes of both kinds compete.
/// @param errors_on  errors on a camera, infinite for codes that do not compete
template <typename ErrorsOn>
std::vector<double> competing_errors(const Camera& camera, const ErrorsOn& errors_on) {
  std::vector<double> with = errors_on(camera);
  if (!camera.operating.interference || with.empty()) return with;
  Camera alone = camera;
  alone.operating.interference.reset();
  const std::vector<double> without = errors_on(alone);
  const double least_with = *std::min_element(with.begin(), with.end());
  const double least_without = *std::min_element(without.begin(), without.end());
  for (std::size_t i = 0; i < with.size(); ++i)
    if (with[i] < infinity) with[i] = std::min(with[i] / least_with, without[i] / least_without);
  return with;
}

/// Returns why a code cannot compete, apart from why_not_decodable().
std::optional<std::string> why_not_comparable(const CodeSet& code, const Camera& camera) {
  if (auto reason = why_not_playable(code, camera)) return reason;
  if (!keeps_shortest_run(code, camera)) return short_runs;
  return std::nullopt;
}

/// Atlas entries share some waveforms.
std::size_t first_like(const std::vector<CodeSet>& codes, std::size_t i) {
  const auto alike = [&](const CodeSet& code) { return has_same_waveforms(code, codes[i]); };
  return static_cast<std::size_t>(std::find_if(codes.begin(), codes.end(), alike) - codes.begin());
}

/// judge() later excludes codes that do not determine depth.
void add_baseline(CodeSet code, const std::string& method, const Camera& camera,
                  DesignResult& result) {
  if (const auto reason = why_not_playable(code, camera))
    return leave_out(result, code.name(), *reason);
  if (!keeps_shortest_run(code, camera)) return leave_out(result, code.name(), short_runs);
  result.candidates.push_back({.code = std::move(code), .method = method});
}

std::string brief_list(const std::vector<std::string>& names, const char* kind) {
  constexpr std::size_t listed = 4;
  if (names.size() <= listed + 1) return fmt::format("{}", fmt::join(names, ", "));
  return fmt::format("{} and {} other {}", fmt::join(names.begin(), names.begin() + listed, ", "),
                     names.size() - listed, kind);
}

void leave_out(DesignResult& result, const Contenders& contenders, const char* kind) {
  for (const auto& [reason, names] : contenders.left_out)
    leave_out(result, brief_list(names, kind), reason);
}

}  // namespace

bool has_same_waveforms(const CodeSet& a, const CodeSet& b) {
  if (a.taps() != b.taps() || a.exposures() != b.exposures()) return false;
  for (int e = 0; e < a.exposures(); ++e)
    if (a.modulation(e) != b.modulation(e)) return false;
  for (int k = 0; k < a.measurements(); ++k)
    if (a.demodulation(k) != b.demodulation(k)) return false;
  return true;
}

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

double tried_error_m(const CodeSet& code, const Camera& camera, const DesignOptions& options,
                     int more) {
  const std::optional<CodeOnCamera> on = if_it_has_depth(code, camera);
  if (!on) return infinity;
  const int trials = more * trials_per_point(camera);
  const std::uint64_t seed = search_seed(options);
  if (camera.operating.error == DepthErrorKind::linear)
    return first_error_m(*on, camera, trials, seed);
  return circular_error_m(*on, camera, {.trials = trials, .seed = seed, .bounds = false});
}

Contenders contending_families(const std::vector<std::string>& names, const Camera& camera,
                               std::uint64_t seed) {
  Contenders found;
  Reasons reasons(names.size());
  std::vector<std::optional<CodeSet>> codes(names.size());
  parallel_for_indices(names.size(), [&](std::size_t at) {
    reasons[at] = why_no_family(names[at], camera);
    if (reasons[at]) return;
    codes[at] = build_family(names[at], camera);
    reasons[at] = why_not_comparable(*codes[at], camera);
  });
  std::vector<const CodeSet*> comparable(names.size(), nullptr);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!reasons[i]) comparable[i] = &*codes[i];
  const std::vector<double> errors = competing_errors(camera, [&](const Camera& on) {
    return errors_of_contenders_m(comparable, on, seed, reasons);
  });
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (reasons[i])
      found.left_out[*reasons[i]].push_back(names[i]);
    else
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return errors[a] < errors[b]; });
  const std::string worse = fmt::format(
      "in {} or {} trials per operating point, the error is more than {} times the error of the "
      "best standard code",
      trials_per_point(camera) / first_look_divisor, trials_per_point(camera), contending);
  const std::string beside = fmt::format("{} other codes have smaller errors", max_contenders);
  for (const std::size_t i : order)
    if (!(errors[i] <= contending * errors[order.front()]))
      found.left_out[worse].push_back(names[i]);
    else if (found.codes.size() == max_contenders)
      found.left_out[beside].push_back(names[i]);
    else
      found.codes.push_back(std::move(*codes[i]));
  return found;
}

Contenders contending_atlas_codes(const Camera& camera, const DesignOptions& options,
                                  std::optional<int> trials) {
  constexpr std::size_t max_of_exposures = 3;
  // Similar entries have similar errors in the same trials.
  constexpr double alike = 1.0005;
  Contenders found;
  if (options.atlas_cameras == 0 || options.method == DesignMethod::factorize ||
      options.method == DesignMethod::search)
    return found;
  const std::vector<CodeSet> codes =
      nearest_atlas_codes(code_atlas(), camera, options.exposures, options.atlas_cameras);
  Reasons reasons(codes.size());
  std::vector<const CodeSet*> comparable(codes.size(), nullptr);
  parallel_for_indices(codes.size(), [&](std::size_t at) {
    if (first_like(codes, at) != at) return;
    reasons[at] = why_not_comparable(codes[at], camera);
    if (!reasons[at]) comparable[at] = &codes[at];
  });
  std::vector<double> errors = competing_errors(camera, [&](const Camera& on) {
    return first_errors_m(comparable, on, trials.value_or(trials_per_point(on)),
                          search_seed(options), reasons);
  });
  for (std::size_t i = 0; i < codes.size(); ++i) errors[i] = errors[first_like(codes, i)];
  const auto note = [](const std::string& name, std::vector<std::string>& names) {
    if (names.empty() || names.back() != name) names.push_back(name);
  };
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < codes.size(); ++i)
    if (reasons[i])
      note(codes[i].name(), found.left_out[*reasons[i]]);
    else if (errors[i] < infinity)
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return errors[a] < errors[b]; });
  std::map<int, std::vector<double>> kept_errors;  // by number of exposures
  for (const std::size_t i : order) {
    std::vector<double>& kept = kept_errors[codes[i].exposures()];
    if (kept.size() >= max_of_exposures || (!kept.empty() && errors[i] < alike * kept.back()))
      continue;
    kept.push_back(errors[i]);
    found.codes.push_back(codes[i]);
  }
  return found;
}

void add_atlas_codes(const Contenders& contenders, DesignResult& result) {
  for (std::size_t i = 0; i < std::min(max_atlas_codes, contenders.codes.size()); ++i)
    result.candidates.push_back({.code = contenders.codes[i], .method = "atlas"});
  leave_out(result, contenders, "atlas codes");
}

void add_baselines(const Camera& camera, const DesignOptions& options,
                   const std::vector<TargetSet>& targets, DesignResult& result) {
  for (const std::string& name :
       options.baselines ? *options.baselines : suggested_baselines(camera, options))
    if (const auto reason = why_no_family(name, camera))
      leave_out(result, name, *reason);
    else
      add_baseline(build_family(name, camera), "family", camera, result);
  if (!options.baselines && options.method != DesignMethod::factorize) {
    Contenders others =
        contending_families(other_families(camera, options), camera, search_seed(options));
    for (CodeSet& code : others.codes) add_baseline(std::move(code), "family", camera, result);
    leave_out(result, others, "standard codes");
  }
  if (camera.sensor.taps >= 3)
    for (const StandardCode& standard : standard_chip_codes(camera, samples_of_standard_codes))
      if (standard.code.taps() == camera.sensor.taps)
        add_baseline(standard.code.resampled(camera.samples), "reference", camera, result);
  for (const TargetSet& target : targets) {
    if (!options.target && result.find(target.name)) continue;  // that family is the naive code
    if (auto code = naive_code(target, camera))
      result.candidates.push_back({.code = std::move(*code), .method = "naive"});
  }
}

std::vector<std::string> suggested_baselines(const Camera& camera, const DesignOptions& options) {
  if (camera.sensor.readout == Readout::rows) {
    std::vector<std::string> names{"hamiltonian-k4", "hamiltonian-k5", "gray-k5", "gray-k6"};
    for (const int rows : designable_rows(options)) {
      names.push_back(fmt::format("fourier-k{}", rows));
      names.push_back(fmt::format("histogram-k{}", rows));
    }
    return names;
  }
  if (camera.sensor.taps > 2)
    return {fmt::format("sinusoid-k{}", camera.sensor.taps),
            fmt::format("square-k{}", camera.sensor.taps)};
  if (options.method != DesignMethod::factorize)
    return {"sinusoid-k3",    "sinusoid-k4",    "square-k4",      "multifrequency-k5",
            "hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5", "pulsed-multifrequency-k5"};
  std::vector<int> exposures = options.exposures;
  if (exposures.empty() && !options.target)
    exposures = suggested_exposures(camera, DesignMethod::factorize);
  std::vector<std::string> names;
  for (const int e : exposures) names.push_back(fmt::format("hamiltonian-k{}", e));
  return names;
}

std::vector<std::string> other_families(const Camera& camera, const DesignOptions& options) {
  constexpr int highest_without_limit = 15, highest_tried = 30;
  // All families of such receivers are suggested baselines.
  if (camera.sensor.taps > 2 || camera.sensor.readout == Readout::rows) return {};
  const int harmonics = useful_harmonics(camera);
  const std::vector<std::string> shown = suggested_baselines(camera, options);
  std::vector<std::string> names;
  for (std::string& name :
       family_members({.samples = camera.samples, .peak_factor = camera.light.peak_factor},
                      harmonics == 0 ? highest_without_limit : std::min(harmonics, highest_tried)))
    if (std::find(shown.begin(), shown.end(), name) == shown.end())
      names.push_back(std::move(name));
  return names;
}

}  // namespace tofsmith
