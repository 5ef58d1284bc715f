// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/frequencies/frequency_design.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <functional>

#include "core/shared/text_numbers.hpp"
#include "design/baselines.hpp"
#include "design/exposure_shares.hpp"
#include "design/frequencies/frequency_search.hpp"
#include "design/judge.hpp"

namespace tofsmith {

namespace {

constexpr std::size_t estimated = 32;
constexpr std::size_t varied = 6;  ///< codes that are tried with more phases
constexpr std::size_t finalists = 3;
constexpr int max_phases = 4;

/// Error of a code in trials [m].
using TriedError = std::function<double(const SquareCode& code)>;

void sort_by_error(std::vector<RatedCode>& tried) {
  std::stable_sort(tried.begin(), tried.end(),
                   [](const RatedCode& a, const RatedCode& b) { return a.error_m < b.error_m; });
}

bool have_same_frequencies(const SquareCode& a, const SquareCode& b) {
  return std::equal(
      a.tones.begin(), a.tones.end(), b.tones.begin(), b.tones.end(),
      [](const SquareTone& x, const SquareTone& y) { return x.frequency == y.frequency; });
}

/// Adds phases to one frequency or to all, within the allowed numbers of exposures.
std::vector<SquareCode> with_more_phases(const SquareCode& code, const FrequencyChoice& choice) {
  std::vector<SquareCode> all;
  const auto add = [&](const SquareCode& changed) {
    if (changed.exposures() != code.exposures() &&
        std::binary_search(choice.exposures.begin(), choice.exposures.end(), changed.exposures()))
      all.push_back(changed);
  };
  for (int phases = choice.min_phases + 1; phases <= max_phases; ++phases) {
    SquareCode every = code;
    for (std::size_t i = 0; i < code.tones.size(); ++i) {
      SquareCode one = code;
      one.tones[i].phases = std::max(phases, one.tones[i].phases);
      every.tones[i].phases = one.tones[i].phases;
      add(one);
    }
    if (code.tones.size() > 1) add(every);
  }
  return all;
}

void try_more_phases(const Camera& camera, const FrequencyChoice& choice, const TriedError& error_m,
                     std::vector<RatedCode>& tried) {
  const std::size_t count = std::min(varied, tried.size());
  for (std::size_t i = 0; i < count; ++i) {
    const SquareErrorEstimate estimate(camera, tried[i].code.duty, choice.frequencies.front());
    for (const SquareCode& code : with_more_phases(tried[i].code, choice)) {
      const RatedCode split = with_best_split(code, choice, estimate);
      if (split.error_m < infinity) tried.push_back({split.code, error_m(split.code)});
    }
  }
  sort_by_error(tried);
}

/// Returns true if a frequency has at most twice the smallest time. A code without it is about as
/// good.
bool has_idle_frequency(const SquareCode& code) {
  return std::any_of(code.tones.begin(), code.tones.end(), [](const SquareTone& tone) {
    return tone.share < 2.0 * min_exposure_share * tone.phases;
  });
}

/// Each has different frequencies.
std::vector<RatedCode> finalists_of(const std::vector<RatedCode>& tried,
                                    const FrequencyChoice& choice, const TriedError& error_m) {
  std::vector<RatedCode> best;
  for (const RatedCode& its : tried) {
    if (best.size() == finalists || !(its.error_m < infinity)) break;
    const bool is_new = std::none_of(best.begin(), best.end(), [&](const RatedCode& other) {
      return have_same_frequencies(its.code, other.code);
    });
    if (!is_new || (!best.empty() && has_idle_frequency(its.code))) continue;
    best.push_back(its);
    if (choice.time_shares.empty())
      for (const double moved : {0.25, 0.1}) improve_split(best.back(), moved, error_m);
  }
  sort_by_error(best);
  return best;
}

SearchRecord record_of(const FrequencySearch& search, const FrequencyChoice& choice) {
  return {.work_unit = "sets of frequencies",
          .error_name = "estimated error",
          .steps = {{static_cast<double>(search.sets), search.best.front().error_m}},
          .proved = true,
          .account = fmt::format(
              "Of all {} sets of 1 to {} of {} frequencies with {} {}, {} repeat within the "
              "working distance and {} have a lower bound above the best {} estimates. The others "
              "were estimated with exposure times optimized by descent. No other set has a better "
              "estimate; trials selected the result among the best {}.",
              search.sets, choice.max_frequencies, choice.frequencies.size(), choice.duties.size(),
              choice.duties.size() == 1 ? "duty" : "duties", search.ambiguous,
              search.pruned_by_bound, search.best.size(), search.best.size())};
}

/// "120 MHz: 2 phases, 55 % of the time, ...; duty 0.5".
std::string in_words(const SquareCode& code, const Camera& camera) {
  std::vector<std::string> tones;
  for (const SquareTone& tone : code.tones)
    tones.push_back(fmt::format("{:.6g} MHz: {} phases, {:.3g} % of the time",
                                1e-6 * tone.frequency * camera.fundamental_frequency_hz,
                                tone.phases, 100.0 * tone.share));
  return fmt::format("{}; duty {:.3g}", fmt::join(tones, ", "), code.duty);
}

Candidate candidate_of(const SquareCode& code, const Camera& camera, const DesignOptions& options) {
  return {.code = signed_by(to_code_set(code, camera), "frequencies", camera, options.seed),
          .method = "frequencies",
          .message = in_words(code, camera)};
}

BrokenRule nothing_found(const Camera& camera, const FrequencySearch& search,
                         const FrequencyChoice& choice) {
  if (search.ambiguous < search.sets)
    return broken("sensor.integration_times_s", list_text(*camera.sensor.integration_times_s),
                  fmt::format("must add up to exposure_s = {:.6g} for a set of frequencies with "
                              "equal times of its phases and at most {} exposures",
                              camera.exposure_s.total_s, choice.exposures.back()));
  std::vector<double> frequencies_hz;
  for (const int frequency : choice.frequencies)
    frequencies_hz.push_back(frequency * camera.fundamental_frequency_hz);
  return broken(
      "light.frequencies_hz", list_text(frequencies_hz),
      fmt::format(
          "must contain a set of at most {} frequencies whose common unambiguous range covers "
          "{:.6g} m; raise fundamental_frequency_hz or reduce operating.working_distance_m",
          choice.max_frequencies, camera.range_m() / choice.max_repetitions));
}

std::vector<std::string> binary_families(const Camera& camera, const DesignOptions& options) {
  std::vector<std::string> names = suggested_baselines(camera, options);
  for (std::string& name : other_families(camera, options)) names.push_back(std::move(name));
  std::erase_if(names, [&](const std::string& name) {
    return why_no_family(name, camera) || !build_family(name, camera).is_binary();
  });
  return names;
}

/// Returns the camera with the shortest unambiguous range that covers its working distance, for a
/// fair comparison.
Camera with_shortest_range(Camera camera, const DesignOptions& options) {
  constexpr int min_samples = 240;
  const int factor = frequency_choice(camera, options).max_repetitions;
  if (camera.operating.multipath || camera.light.generator || camera.sensor.generator)
    return camera;
  camera.fundamental_frequency_hz *= factor;
  camera.samples = std::max(std::min(min_samples, camera.samples), camera.samples / factor);
  return camera;
}

void leave_out_frequencies(const Camera& camera, const FrequencyChoice& choice,
                           DesignResult& result) {
  for (const double frequency_hz : choice.left_out_hz)
    leave_out(result, fmt::format("{:.6g} MHz", 1e-6 * frequency_hz),
              fmt::format("is not a multiple of fundamental_frequency_hz = {:.9g}, or has pulses "
                          "below sensor.shortest_pulse_s",
                          camera.fundamental_frequency_hz));
}

}  // namespace

void add_frequency_candidates(const Camera& camera, const DesignOptions& options,
                              DesignResult& result, const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  const FrequencyChoice choice = frequency_choice(camera, options);
  leave_out_frequencies(camera, choice, result);
  const ProgressParts parts(progress, {50, 50});

  const FrequencySearch search = search_frequencies(camera, choice, estimated, parts[0]);
  if (search.best.empty()) require(nothing_found(camera, search, choice));
  std::optional<SquareCode> usual;  // has equal times, which listed times may not contain
  if (choice.time_shares.empty()) usual = rule_of_thumb(choice);

  const auto error_m = [&](const SquareCode& code) {
    return tried_error_m(to_code_set(code, camera), camera, options);
  };
  std::vector<RatedCode> tried;
  for (const RatedCode& its : search.best) tried.push_back({its.code, error_m(its.code)});
  if (usual) tried.push_back({*usual, error_m(*usual)});
  sort_by_error(tried);
  try_more_phases(camera, choice, error_m, tried);
  report(parts[1], 0.5, "frequencies");
  const std::vector<RatedCode> best = finalists_of(tried, choice, error_m);

  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  for (const RatedCode& its : best) {
    Candidate candidate = candidate_of(its.code, camera, options);
    candidate.seconds = elapsed.count();
    candidate.search = record_of(search, choice);
    candidate.per_measurement = reports_of(candidate.code, "frequencies");
    result.candidates.push_back(std::move(candidate));
  }
  if (usual) {
    Candidate candidate = candidate_of(*usual, camera, options);
    candidate.method = "reference";
    candidate.code = candidate.code.renamed("rule-of-thumb-" + candidate.code.name());
    result.candidates.push_back(std::move(candidate));
  }
}

std::optional<std::string> price_of_frequencies(const Camera& camera, const DesignOptions& options,
                                                const DesignResult& result,
                                                const Progress& progress) {
  const Camera wide = with_shortest_range(camera, options);
  DesignOptions usual = options;
  usual.method = DesignMethod::atlas;
  usual.exposures.clear();
  std::vector<Candidate> binary;
  for (const Contenders& contenders :
       {contending_atlas_codes(wide, usual),
        contending_families(binary_families(wide, usual), wide, search_seed(options))}) {
    const auto first = std::find_if(contenders.codes.begin(), contenders.codes.end(),
                                    [](const CodeSet& code) { return code.is_binary(); });
    if (first != contenders.codes.end()) binary.push_back({.code = *first, .method = "reference"});
  }
  if (binary.empty()) return std::nullopt;
  const DesignResult judged = judge(wide, std::move(binary), usual, progress);
  const std::string& name = judged.winner().code.name();
  const double ratio = ranking_error_m(result.winner(), camera, options) /
                       ranking_error_m(judged.winner(), wide, options);
  constexpr const char* known = "binary code of the atlas or the families for this bandwidth";
  if (ratio < 1.0)
    return fmt::format("No {} is better: {} has {:.2f} times the error.", known, name, 1.0 / ratio);
  return fmt::format(
      "Square waves at these frequencies have {:.2f} times the error of {}, the best {}.", ratio,
      name, known);
}

}  // namespace tofsmith
