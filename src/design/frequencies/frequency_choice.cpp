// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/frequencies/frequency_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/shared/list_text.hpp"

namespace tofsmith {

namespace {

constexpr int default_max_exposures = 8;
constexpr int most_frequencies = 4;
constexpr int duties_of_range = 9;

std::vector<double> duties_of(const SquareLight& square) {
  if (!square.duties.empty()) return square.duties;
  if (!square.duty_range) return {square.duty};
  const auto [low, high] = *square.duty_range;
  std::vector<double> duties;
  for (int i = 0; i < duties_of_range; ++i)
    duties.push_back(low + (high - low) * i / (duties_of_range - 1));
  return duties;
}

/// Returns 0 if the frequency is no multiple.
int multiple_of(double frequency_hz, double fundamental_hz) {
  constexpr double tolerance = 1e-6;
  const double ratio = frequency_hz / fundamental_hz;
  const double nearest = std::round(ratio);
  return std::abs(ratio - nearest) <= tolerance * nearest ? static_cast<int>(nearest) : 0;
}

bool keeps_shortest_pulse(double frequency_hz, const std::vector<double>& duties,
                          const Camera& camera) {
  if (!camera.sensor.shortest_pulse_s) return true;
  double shortest = 0.5;
  for (const double duty : duties) shortest = std::min({shortest, duty, 1.0 - duty});
  return shortest / frequency_hz >= *camera.sensor.shortest_pulse_s * (1.0 - 1e-9);
}

std::vector<int> allowed_exposures(const Camera& camera, const DesignOptions& options) {
  std::vector<int> exposures = options.exposures;
  if (camera.playback && !camera.playback->order.empty())
    exposures = {static_cast<int>(camera.playback->order.size())};
  const int most = camera.sensor.max_exposures.value_or(default_max_exposures);
  if (exposures.empty())
    for (int e = 1; e <= most; ++e) exposures.push_back(e);
  std::erase_if(exposures, [&](int e) { return e > most; });
  std::sort(exposures.begin(), exposures.end());
  return exposures;
}

int repetitions_within_distance(const Camera& camera) {
  if (!camera.operating.working_distance_m) return 1;
  const double farthest_m = (*camera.operating.working_distance_m)[1];
  return std::max(1, static_cast<int>(std::floor(camera.range_m() / farthest_m * (1.0 + 1e-9))));
}

std::optional<BrokenRule> why_wrong_camera(const Camera& camera) {
  if (!camera.light.square)
    return broken("light.frequencies_hz", "none",
                  "must list the modulation frequencies that the chip can generate; or give "
                  "light.clock_hz and light.dividers");
  if (camera.sensor.readout == Readout::rows)
    return broken("sensor.readout", "rows",
                  "must be \"separate\" or \"difference\" for square waves");
  if (camera.sensor.taps > 2)
    return broken("sensor.taps", camera.sensor.taps, "must be 1 or 2 for square waves");
  if (!camera.exposure_s.each_s.empty())
    return broken("exposure_s", list_text(camera.exposure_s.each_s),
                  "must be one total, which the design splits between the exposures");
  return std::nullopt;
}

FrequencyChoice choice_for(const Camera& camera, const DesignOptions& options) {
  const SquareLight& square = *camera.light.square;
  FrequencyChoice choice;
  choice.duties = duties_of(square);
  const std::vector<double> all_hz = square.modulation_frequencies_hz();
  for (const double frequency_hz : all_hz) {
    const int multiple = multiple_of(frequency_hz, camera.fundamental_frequency_hz);
    if (multiple > 0 && keeps_shortest_pulse(frequency_hz, choice.duties, camera))
      choice.frequencies.push_back(multiple);
    else
      choice.left_out_hz.push_back(frequency_hz);
  }
  std::sort(choice.frequencies.begin(), choice.frequencies.end(), std::greater<>());
  choice.exposures = allowed_exposures(camera, options);
  choice.first_phases = camera.sensor.mixes_taps() ? 2 : 3;
  choice.max_repetitions = repetitions_within_distance(camera);
  if (camera.sensor.integration_times_s)
    for (const double time_s : *camera.sensor.integration_times_s)
      choice.time_shares.push_back(time_s / camera.exposure_s.total_s);
  while (choice.max_frequencies < most_frequencies &&
         !choice.exposures_of(choice.max_frequencies + 1).empty())
    ++choice.max_frequencies;
  return choice;
}

}  // namespace

std::vector<int> FrequencyChoice::exposures_of(int frequencies_of_code) const {
  const int needed = first_phases + (frequencies_of_code - 1) * min_phases;
  return {std::lower_bound(exposures.begin(), exposures.end(), needed), exposures.end()};
}

std::optional<BrokenRule> why_no_frequencies(const Camera& camera, const DesignOptions& options) {
  if (auto wrong = why_wrong_camera(camera)) return wrong;
  const FrequencyChoice choice = choice_for(camera, options);
  if (choice.frequencies.empty())
    return broken("light.frequencies_hz", list_text(choice.left_out_hz),
                  fmt::format("must contain multiples of fundamental_frequency_hz = {:.9g}{}",
                              camera.fundamental_frequency_hz,
                              camera.sensor.shortest_pulse_s
                                  ? " with pulses of at least sensor.shortest_pulse_s"
                                  : ""));
  if (choice.exposures_of(1).empty())
    return broken(
        "sensor.max_exposures", camera.sensor.max_exposures.value_or(default_max_exposures),
        fmt::format(
            "must allow {0} exposures, and --exposures, if given, must list a number >= {0}",
            choice.first_phases));
  return std::nullopt;
}

FrequencyChoice frequency_choice(const Camera& camera, const DesignOptions& options) {
  require(why_no_frequencies(camera, options));
  return choice_for(camera, options);
}

SquareCode with_exposures(SquareCode code, const FrequencyChoice& choice, int exposures) {
  for (SquareTone& tone : code.tones) tone.phases = choice.min_phases;
  code.tones.front().phases = choice.first_phases;
  for (std::size_t i = 0; code.exposures() < exposures; i = (i + 1) % code.tones.size())
    ++code.tones[i].phases;
  for (SquareTone& tone : code.tones)
    tone.share = static_cast<double>(tone.phases) / code.exposures();
  return code;
}

std::optional<SquareCode> rule_of_thumb(const FrequencyChoice& choice) {
  std::optional<SquareCode> best;
  const auto sum_of = [](const SquareCode& code) {
    int sum = 0;
    for (const SquareTone& tone : code.tones) sum += tone.frequency;
    return sum;
  };
  const auto consider = [&](const SquareCode& code) {
    if (choice.covers_working_distance(code) && (!best || sum_of(code) > sum_of(*best)))
      best = code;
  };
  const double duty =
      *std::min_element(choice.duties.begin(), choice.duties.end(),
                        [](double a, double b) { return std::abs(a - 0.5) < std::abs(b - 0.5); });
  const std::vector<int>& all = choice.frequencies;
  if (choice.max_frequencies >= 2)
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j)
        consider({.duty = duty, .tones = {{.frequency = all[i]}, {.frequency = all[j]}}});
  for (std::size_t i = 0; i < all.size() && !best; ++i)
    consider({.duty = duty, .tones = {{.frequency = all[i]}}});
  if (!best) return std::nullopt;
  const std::vector<int> possible = choice.exposures_of(static_cast<int>(best->tones.size()));
  const auto usual =
      std::upper_bound(possible.begin(), possible.end(), 4 * static_cast<int>(best->tones.size()));
  return with_exposures(*best, choice, usual == possible.begin() ? possible.front() : usual[-1]);
}

}  // namespace tofsmith
