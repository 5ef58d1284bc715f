// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/atlas/nearest_codes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "code/shared/on_intervals.hpp"
#include "design/baselines.hpp"
#include "design/run_lengths.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

/// Half the width of a Hann response with f_max = 1, and its width at half height.
constexpr double hann_half_width = 0.722;

struct AtlasPlace {
  double log_peak, log_bandwidth;
};

AtlasPlace place_of(double peak_factor, double bandwidth_f0) {
  return {std::log(peak_factor), std::log(bandwidth_f0)};
}
AtlasPlace place_of(const AtlasCamera& of) {
  const double band = of.bandwidth_f0 > 0.0 ? of.bandwidth_f0 : infinity;
  const double pulse =
      of.shortest_pulse_periods > 0.0 ? hann_half_width / of.shortest_pulse_periods : infinity;
  return place_of(of.peak_factor, std::min(band, pulse));
}

double place_distance(const AtlasPlace& a, const AtlasPlace& b) {
  return std::hypot(a.log_peak - b.log_peak, a.log_bandwidth - b.log_bandwidth);
}

AtlasPlace clamped_to(const std::vector<const AtlasEntry*>& entries, AtlasPlace place) {
  AtlasPlace low{infinity, infinity}, high{-infinity, -infinity};
  for (const AtlasEntry* entry : entries) {
    const AtlasPlace its = place_of(entry->of);
    low = {std::min(low.log_peak, its.log_peak), std::min(low.log_bandwidth, its.log_bandwidth)};
    high = {std::max(high.log_peak, its.log_peak), std::max(high.log_bandwidth, its.log_bandwidth)};
  }
  return {std::clamp(place.log_peak, low.log_peak, high.log_peak),
          std::clamp(place.log_bandwidth, low.log_bandwidth, high.log_bandwidth)};
}

/// Nearest first. All must have the same number of exposures.
std::vector<const AtlasEntry*> nearest_entries(std::vector<const AtlasEntry*> entries,
                                               const AtlasPlace& camera, int cameras) {
  const AtlasPlace place = clamped_to(entries, camera);
  std::stable_sort(entries.begin(), entries.end(), [&](const AtlasEntry* a, const AtlasEntry* b) {
    return place_distance(place_of(a->of), place) < place_distance(place_of(b->of), place);
  });
  std::set<std::pair<double, double>> places;
  std::vector<const AtlasEntry*> kept;
  for (const AtlasEntry* entry : entries) {
    const AtlasPlace its = place_of(entry->of);
    places.emplace(its.log_peak, its.log_bandwidth);
    if (std::ssize(places) > cameras) break;
    kept.push_back(entry);
  }
  return kept;
}

Waveform fitted_light(const Waveform& light, double from_peak_factor, double to_peak_factor) {
  constexpr double whole = 0.98;  // of the peak; lower levels are intentional
  const double level = light.level();
  const double wanted = level >= whole * from_peak_factor
                            ? to_peak_factor * level / from_peak_factor
                            : std::min(level, to_peak_factor);
  if (std::abs(wanted / level - 1.0) < 1e-9) return light;
  std::vector<OnInterval> on = stretched(light.on_intervals(), level / wanted);
  const double duty = Waveform::binary(on).mean();
  return Waveform::binary(std::move(on), std::min(wanted, 1.0 / duty));
}

}  // namespace

double effective_bandwidth_f0(const Camera& camera) {
  constexpr double end_of_band = (1.0 - 1e-9) / 25.0;
  double bandwidth = infinity;
  if (const int last = useful_harmonics(camera); last > 0) {
    const Eigen::VectorXcd transfer = camera.transfer(last + 1);
    const double inside = std::abs(transfer[last]), outside = std::abs(transfer[last + 1]);
    bandwidth = last;
    if (inside > end_of_band && outside < inside)
      bandwidth += std::min(1.0, (inside - end_of_band) / (inside - outside));
  }
  const double pulse = shortest_run_periods(camera);
  return pulse > 0.0 ? std::min(bandwidth, hann_half_width / pulse) : bandwidth;
}

CodeSet fitted_to_peak(const CodeSet& code, double from_peak_factor, double to_peak_factor) {
  std::vector<Waveform> modulation, demodulation;
  for (int e = 0; e < code.exposures(); ++e)
    modulation.push_back(fitted_light(code.modulation(e), from_peak_factor, to_peak_factor));
  for (int i = 0; i < code.measurements(); ++i) demodulation.push_back(code.demodulation(i));
  CodeSet result = CodeSet::create(code.name(), code.samples(), code.taps(), std::move(modulation),
                                   std::move(demodulation));
  result.provenance = code.provenance;
  return result;
}

std::vector<CodeSet> nearest_atlas_codes(const std::vector<AtlasEntry>& atlas, const Camera& camera,
                                         const std::vector<int>& exposures, int cameras) {
  std::vector<CodeSet> codes;
  if (camera.sensor.readout == Readout::rows || camera.sensor.is_signed() ||
      camera.light.peak_factor <= 1.0)
    return codes;
  std::map<int, std::vector<const AtlasEntry*>> by_exposures;
  for (const AtlasEntry& entry : atlas)
    if (entry.of.taps == camera.sensor.taps &&
        (exposures.empty() ||
         std::find(exposures.begin(), exposures.end(), entry.of.exposures) != exposures.end()))
      by_exposures[entry.of.exposures].push_back(&entry);
  const AtlasPlace place = place_of(camera.light.peak_factor, effective_bandwidth_f0(camera));
  for (const auto& [of_exposures, entries] : by_exposures) {
    std::vector<const AtlasEntry*> near = nearest_entries(entries, place, cameras);
    std::stable_partition(near.begin(), near.end(), [&](const AtlasEntry* entry) {
      return entry->of.error == camera.operating.error;
    });
    for (const AtlasEntry* entry : near) {
      const CodeSet code = entry->code.resampled(camera.samples);
      const CodeSet to_peak = fitted_to_peak(code, entry->of.peak_factor, camera.light.peak_factor);
      codes.push_back(to_peak);
      if (code.peak() < to_peak.peak()) codes.push_back(code);
    }
  }
  return codes;
}

}  // namespace tofsmith
