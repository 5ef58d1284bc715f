// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chips/chip_margin.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "decode/multipath/shared/bounded_quadratic.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

std::optional<BrokenRule> why_not_plain(const Camera& camera) {
  if (camera.band_limited())
    return broken(
        "impulse_response", "given",
        "must be none, because the search on a chip clock requires rectangular waveforms");
  if (camera.light.generator || camera.sensor.generator)
    return broken("generator", "given", "must be none with a chip clock, which replaces it");
  const auto& contrasts = camera.sensor.modulation_contrasts;
  if (camera.sensor.modulation_contrast != 1.0 || !contrasts.empty())
    return broken("sensor.modulation_contrast",
                  contrasts.empty() ? camera.sensor.modulation_contrast : contrasts.front(),
                  "must be 1 to search codes on a chip clock");
  if (camera.sensor.is_signed())
    return broken("sensor.demodulation", "signed",
                  "must be \"gain\" to search codes of exclusive taps");
  if (camera.sensor.readout != Readout::separate)
    return broken("sensor.readout", camera.sensor.readout == Readout::rows ? "rows" : "difference",
                  "must be separate to search codes on a chip clock");
  const auto& times = camera.exposure_s.each_s;
  if (std::any_of(times.begin(), times.end(),
                  [&](double time_s) { return time_s != times.front(); }))
    return broken("exposure_s", "of different lengths",
                  "must be equal to search codes on a chip clock");
  return std::nullopt;
}

ChipLight::ChipLight(const Camera& camera, const OperatingPoint& point, int code_chips,
                     int exposures, ChipMetric metric)
    : peak_factor(camera.light.peak_factor),
      chips(code_chips),
      chip_m(camera.range_m() / code_chips),
      is_known(metric == ChipMetric::known_light) {
  camera.validate();
  require(why_not_plain(camera));
  require(camera.exposure_s.each_s.empty() ||
              camera.exposure_s.each_s.size() == static_cast<std::size_t>(exposures),
          "number of exposure_s", camera.exposure_s.each_s.size(), "must equal the exposures");
  const double time_s = camera.exposure_s.of(0, exposures);
  signal_e = time_s * point.signal_e_per_s / chips;
  ambient_e = time_s * point.ambient_e_per_s / chips;
  constexpr double min_e2 = 1e-9;  // avoids division by zero
  constant_e2 = std::max(
      min_e2, constant_variance_e2_of(camera.sensor) + time_s * camera.sensor.dark_current_e_per_s);
}

struct ChipMargin::Whitening {
  int size;
  Values weight, weighted_open;
  double per_open2;

  double product(const Values& a, const Values& b) const {
    double sum = 0.0, open_a = 0.0, open_b = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) {
      sum += weight[i] * a[i] * b[i];
      open_a += weighted_open[i] * a[i];
      open_b += weighted_open[i] * b[i];
    }
    return sum - open_a * open_b * per_open2;
  }
};

ChipMargin::ChipMargin(const ChipCode& code, const ChipLight& light, double separation_periods)
    : chips_(code.chips),
      measurements_(code.measurements()),
      separation_chips_(separation_periods * code.chips),
      constant_e2_(light.constant_e2),
      signal_e_(static_cast<std::size_t>(code.chips) + 1) {
  for (int i = 0; i < measurements_; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double electrons =
        light.electrons_of(std::popcount(code.modulation[static_cast<std::size_t>(i / code.taps)]));
    open_[k] = std::popcount(code.demodulation[k]);
    ambient_e_[k] = light.ambient_e * open_[k];
    for (int s = 0; s <= chips_; ++s)
      signal_e_[static_cast<std::size_t>(s)][k] = electrons * code.correlation(i, s);
  }
}

ChipMargin::Values ChipMargin::values_at(int chip, double place) const {
  const Values& here = signal_e_[static_cast<std::size_t>(chip)];
  const Values& next = signal_e_[static_cast<std::size_t>(chip) + 1];
  Values values{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(measurements_); ++i)
    values[i] = here[i] + place * (next[i] - here[i]);
  return values;
}

ChipMargin::Values ChipMargin::variance_at(int chip, double place) const {
  Values variance = values_at(chip, place);
  for (std::size_t i = 0; i < static_cast<std::size_t>(measurements_); ++i)
    variance[i] += ambient_e_[i] + constant_e2_;
  return variance;
}

ChipMargin::Whitening ChipMargin::whitening(const Values& variance) const {
  Whitening whitening{.size = measurements_, .weight = {}, .weighted_open = {}, .per_open2 = 0.0};
  double open2 = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(measurements_); ++i) {
    whitening.weight[i] = 1.0 / variance[i];
    whitening.weighted_open[i] = open_[i] / variance[i];
    open2 += open_[i] * whitening.weighted_open[i];
  }
  whitening.per_open2 = open2 > 0.0 ? 1.0 / open2 : 0.0;
  return whitening;
}

/// Returns the parts of `chip` at least the separation away from some depth in [first, last].
ChipMargin::Stretches ChipMargin::alternatives(double first, double last, int chip) const {
  Stretches stretches;
  stretches.add({chip, 0.0, 1.0});
  for (const int turn : {-chips_, 0, chips_}) {
    const double begin = last - separation_chips_ + turn - chip;
    const double end = first + separation_chips_ + turn - chip;
    if (begin >= end || end <= 0.0 || begin >= 1.0) continue;
    Stretches left;
    for (const Stretch& s : stretches) {
      if (s.begin < std::min(s.end, begin)) left.add({chip, s.begin, std::min(s.end, begin)});
      if (std::max(s.begin, end) < s.end) left.add({chip, std::max(s.begin, end), s.end});
    }
    stretches = left;
  }
  return stretches;
}

double ChipMargin::squared_distance(int chip, double place, const Stretch& alternative) const {
  const Whitening w = whitening(variance_at(chip, place));
  const Values truth = values_at(chip, place);
  const Values a = values_at(alternative.chip, alternative.begin),
               b = values_at(alternative.chip, alternative.end);
  Quadratic quadratic;
  quadratic.h[0] = {w.product(a, a), w.product(a, b), 0.0};
  quadratic.h[1] = {quadratic.h[0][1], w.product(b, b), 0.0};
  quadratic.g = {w.product(a, truth), w.product(b, truth), 0.0};
  return w.product(truth, truth) + 2.0 * minimize_bounded(quadratic, 2).value;
}

/// Lower bound of the squared distance of two intervals: with the largest variances, the distance
/// from the segment of the measurements to the cone of the alternative is a convex problem in three
/// unknowns.
double ChipMargin::lower_bound(int chip, double begin, double end,
                               const Stretch& alternative) const {
  Values variance = variance_at(chip, begin);
  const Values other = variance_at(chip, end);
  for (std::size_t i = 0; i < static_cast<std::size_t>(measurements_); ++i)
    variance[i] = std::max(variance[i], other[i]);
  const Whitening w = whitening(variance);
  const Values first = values_at(chip, begin), last = values_at(chip, end);
  const Values a = values_at(alternative.chip, alternative.begin),
               b = values_at(alternative.chip, alternative.end);
  Values step{};  // first - last; truth is first - x_0 step
  for (std::size_t i = 0; i < static_cast<std::size_t>(measurements_); ++i)
    step[i] = first[i] - last[i];

  Quadratic quadratic;
  const double aa = w.product(a, a), ab = w.product(a, b), bb = w.product(b, b);
  quadratic.h[0] = {w.product(step, step), w.product(step, a), w.product(step, b)};
  quadratic.h[1] = {quadratic.h[0][1], aa, ab};
  quadratic.h[2] = {quadratic.h[0][2], ab, bb};
  quadratic.g = {w.product(step, first), w.product(a, first), w.product(b, first)};
  const BoundedMinimum least = minimize_bounded(quadratic, 3);
  if (least.x[0] <= 1.0) return w.product(first, first) + 2.0 * least.value;
  // By convexity, the minimum is at the end of the interval.
  Quadratic at_end;
  at_end.h[0] = {aa, ab, 0.0};
  at_end.h[1] = {ab, bb, 0.0};
  at_end.g = {w.product(a, last), w.product(b, last), 0.0};
  return w.product(last, last) + 2.0 * minimize_bounded(at_end, 2).value;
}

double ChipMargin::nearest(int chip, double place) const {
  double least = infinity;
  for (int u = 0; u < chips_; ++u)
    for (const Stretch& alternative : alternatives(chip + place, chip + place, u))
      least = std::min(least, squared_distance(chip, place, alternative));
  return least;
}

/// Returns true if the squared distance of the interval from `alternative_chip` is at least factor
/// x least, proven by bisection. Smaller exact distances lower `least`.
bool ChipMargin::clears(int chip, double begin, double end, int alternative_chip, double& least,
                        double factor) const {
  constexpr double shortest_stretch = 1e-7;  // [chips]; the proof fails instead of bisecting it
  double bound = infinity;
  for (const Stretch& alternative : alternatives(chip + begin, chip + end, alternative_chip))
    bound = std::min(bound, lower_bound(chip, begin, end, alternative));
  if (bound >= factor * least) return true;
  const double middle = (begin + end) / 2;
  for (const Stretch& alternative : alternatives(chip + middle, chip + middle, alternative_chip))
    least = std::min(least, squared_distance(chip, middle, alternative));
  if (bound >= factor * least) return true;
  if (end - begin < shortest_stretch) return false;
  return clears(chip, begin, middle, alternative_chip, least, factor) &&
         clears(chip, middle, end, alternative_chip, least, factor);
}

double ChipMargin::sampled_sigma(int per_chip, double stop_below_sigma) const {
  double least = infinity;
  for (int s = 0; s < chips_; ++s)
    for (int q = 0; q < per_chip; ++q) {
      least = std::min(least, nearest(s, (q + 0.5) / per_chip));
      if (least < stop_below_sigma * stop_below_sigma) return std::sqrt(std::max(0.0, least));
    }
  return std::sqrt(std::max(0.0, least));
}

bool ChipMargin::reaches(double sigma) const {
  const double asked = sigma * sigma;
  if (sampled_sigma(1, sigma) < sigma) return false;
  for (int s = 0; s < chips_; ++s)
    for (int u = 0; u < chips_; ++u) {
      double least = asked;
      if (!clears(s, 0.0, 1.0, u, least, 1.0) || least < asked) return false;
    }
  return true;
}

double ChipMargin::proven_sigma() const {
  constexpr double factor = 0.999 * 0.999, negligible = 1e-6;
  const double sampled = sampled_sigma(2);
  double least = sampled * sampled;
  for (int s = 0; s < chips_; ++s)
    for (int u = 0; u < chips_; ++u)
      if (least < negligible || !clears(s, 0.0, 1.0, u, least, factor)) return 0.0;
  return least < negligible ? 0.0 : std::sqrt(factor * least);
}

}  // namespace tofsmith
