// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chips/chip_candidates.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "code/shared/on_intervals.hpp"
#include "design/chips/chip_margin.hpp"
#include "design/judge.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

ChipWord repeated_pulse(int begin, int width, int period, int chips) {
  ChipWord word = 0;
  for (int k = 0; k < chips; ++k)
    if (((k - begin) % period + period) % period < width) word |= ChipWord{1} << k;
  return word;
}

struct MultiPhase {
  ChipWord light = 0;
  std::vector<ChipWord> taps;
};

std::vector<MultiPhase> multi_phase_exposures(int chips, int taps) {
  std::vector<MultiPhase> all;
  for (int period = taps; period <= chips; ++period) {
    if (chips % period != 0) continue;
    const int open = period / taps;
    std::vector<ChipWord> words;
    for (int i = 0; i < taps; ++i)
      words.push_back(repeated_pulse(i * period / taps, open, period, chips));
    std::vector<int> widths = {open, period / 2, (period + 1) / 2};
    std::sort(widths.begin(), widths.end());
    widths.erase(std::unique(widths.begin(), widths.end()), widths.end());
    for (const int width : widths)
      if (width < period) all.push_back({repeated_pulse(0, width, period, chips), words});
  }
  return all;
}

void add_combinations(const std::vector<MultiPhase>& exposures, std::size_t from, int left,
                      ChipCode& code, std::vector<ChipCode>& all) {
  if (left == 0) {
    if (!is_ambiguous(code)) all.push_back(code);
    return;
  }
  for (std::size_t i = from; i < exposures.size(); ++i) {
    const ChipCode before = code;
    code.modulation.push_back(exposures[i].light);
    code.demodulation.insert(code.demodulation.end(), exposures[i].taps.begin(),
                             exposures[i].taps.end());
    add_combinations(exposures, i, left - 1, code, all);
    code = before;
  }
}

Waveform pulse_of(double duty) { return Waveform::binary({{0.0, duty}}, 1.0); }

Waveform gate(double rise, double duty) { return Waveform::binary({{rise, rise + duty}}); }

CodeSet hamiltonian_in_turn(int samples) {
  const Waveform light = pulse_of(1.0 / 6);
  return CodeSet::create("hamiltonian-k3-in-turn", samples, 1, {light, light, light},
                         {gate(0, 0.5), gate(1.0 / 3, 0.5), gate(2.0 / 3, 0.5)});
}

CodeSet double_ramp_in_turn(int samples) {
  const CodeSet ramps = double_ramp_code({.samples = samples});
  const Waveform light = pulse_of(1.0 / 60);
  return CodeSet::create("double-ramp-in-turn", samples, 1, {light, light, Waveform::constant(0.0)},
                         {ramps.demodulation(0), ramps.demodulation(1), ramps.demodulation(2)});
}

}  // namespace

std::vector<ChipCode> multi_phase_codes(int chips, int taps, int exposures) {
  std::vector<ChipCode> all;
  ChipCode code{chips, taps, {}, {}};
  add_combinations(multi_phase_exposures(chips, taps), 0, exposures, code, all);
  return all;
}

std::vector<StandardCode> standard_chip_codes(const Camera& camera, int samples) {
  require(samples > 0 && samples % 36 == 0, "samples", samples, "must be a multiple of 36");
  Camera three_taps = camera;
  three_taps.samples = samples;
  three_taps.sensor.taps = 3;
  const ChipCode square{
      3, 3, {chip_word("100")}, {chip_word("100"), chip_word("010"), chip_word("001")}};
  ChipCode pair{12, 3, {}, {}};
  for (const int period : {3, 4}) {
    pair.modulation.push_back(repeated_pulse(0, (period + 1) / 2, period, 12));
    for (int i = 0; i < 3; ++i) pair.demodulation.push_back(repeated_pulse(i, 1, period, 12));
  }
  pair.modulation.front() = repeated_pulse(0, 1, 3, 12);
  return {{"hamiltonian-k3-in-turn", hamiltonian_in_turn(samples)},
          {"three-phase-square", to_code_set(square, three_taps, "three-phase-square")},
          {"double-ramp-in-turn", double_ramp_in_turn(samples)},
          {"coprime-three-phase", to_code_set(pair, three_taps, "coprime-three-phase")}};
}

namespace {

SearchRecord record_of(const ChipSearchResult& found) {
  const ChipSearchCounts& c = found.log.counts;
  SearchRecord record{
      .work_unit = "% of the search",
      .error_name = "smallest rms error found: root of the minimized variance",
      .proved = found.proved,
      .account = fmt::format(
          "{} Of {:.4g} codes, {:.4g} after symmetry, {} were examined (a few symmetric ones "
          "twice). Excluded: {} whose coding curve reverses its turn, {} with too small a slope, "
          "{} with a worse metric ({} evaluations), {} ambiguous, {} below the margin. {} improved "
          "on the best code found before.",
          found.proof, c.raw, c.after_symmetry, c.examined, c.pruned_by_turning, c.pruned_by_bound,
          c.pruned_by_metric, c.metric_evaluations, c.ambiguous, c.below_margin, c.kept)};
  for (const ChipImprovement& i : found.log.improvements)
    record.steps.push_back({100.0 * i.share, i.rms_m});
  return record;
}

std::string proof_of(const ChipSearchResult& found, std::size_t place) {
  if (!found.proved) return "not proven";
  return place == 0 ? "proven optimal" : fmt::format("proven rank {} of all codes", place + 1);
}

}  // namespace

std::optional<BrokenRule> why_nothing_to_search(const Camera& camera,
                                                const DesignOptions& options) {
  if (auto reason = why_no_chip_clock(camera)) return reason;
  if (searchable_exposures(camera, options).empty())
    return broken("sensor.taps", camera.sensor.taps,
                  "has too few taps to search codes of one or two exposures; specify --exposures");
  return std::nullopt;
}

std::vector<int> searchable_exposures(const Camera& camera, const DesignOptions& options) {
  if (!options.exposures.empty()) return options.exposures;
  std::vector<int> searchable;
  for (const int exposures : suggested_exposures(camera, DesignMethod::search))
    if (exposures * camera.sensor.taps >= 3) searchable.push_back(exposures);
  return searchable;
}

std::string searched_name(int exposures) { return fmt::format("searched-k{}", exposures); }

std::vector<Candidate> searched_candidates(const Camera& camera, int exposures,
                                           const DesignOptions& options, const Progress& progress) {
  ChipSearchOptions search = options.search;
  search.exposures = exposures;
  search.seed = search_seed(options);
  const ChipSearchResult found = search_chip_codes(camera, search, progress);
  std::vector<Candidate> candidates;
  for (std::size_t place = 0; place < found.finalists.size(); ++place) {
    const ChipFinalist& its = found.finalists[place];
    candidates.push_back(
        {.code = signed_by(to_code_set(its.code, camera, searched_name(exposures)), "search",
                           camera, options.seed),
         .method = "search",
         .seconds = found.log.seconds,
         .search = record_of(found),
         .message = fmt::format("{}: {} mm rms, {}", its.code.text(),
                                plain_number(1e3 * its.rms_m, 4), proof_of(found, place))});
    if (search.metric == ChipMetric::known_light)
      candidates.back().message += ", for known signal and ambient light";
    candidates.back().per_measurement = reports_of(candidates.back().code, "search");
  }
  return candidates;
}

}  // namespace tofsmith
