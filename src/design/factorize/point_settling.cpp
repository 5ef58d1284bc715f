// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/factorize/point_settling.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "design/shortest_run.hpp"

namespace tofsmith {

namespace {

constexpr int delays_per_point = 4;
constexpr int max_settling_rounds = 8;
constexpr int fine_points = 4;  // per bin; finer grids are not rounded

/// Points per period of a generator; 0 if rounding is negligible.
int coarse_points(const std::optional<Generator>& generator, const PairModel& model) {
  if (!generator) return 0;
  const int points = generator->points_per_period(model.camera().fundamental_frequency_hz);
  return points < fine_points * model.samples() ? points : 0;
}

struct RoundedArm {
  Waveform waveform;
  std::vector<char> on = {};  ///< empty: not rounded
  double most_level = 1.0;    ///< maximum of 1 / duty for light; 1 for gates

  RoundedArm(const Waveform& nominal, int points, double most_level_)
      : waveform(nominal), most_level(most_level_) {
    if (points == 0) return;
    const Eigen::VectorXd shares =
        Waveform::binary(nominal.on_intervals(), 1.0).cell_averages(points);
    for (const double share : shares) on.push_back(share > 0.5);
    render();
  }

  std::ptrdiff_t points_on() const { return std::count(on.begin(), on.end(), 1); }

  bool is_playable() const {
    const auto count = points_on();
    return count > 0 && count < std::ssize(on) &&
           (most_level == 1.0 || static_cast<double>(std::ssize(on)) <=
                                     most_level * (1 + 1e-9) * static_cast<double>(count));
  }

  void render() {
    if (!is_playable()) return;
    const auto points = static_cast<double>(on.size());
    const std::size_t first =
        static_cast<std::size_t>(std::find(on.begin(), on.end(), 0) - on.begin());
    std::vector<OnInterval> intervals;
    for (std::size_t i = 1; i <= on.size(); ++i) {  // once around, starting at an off point
      const std::size_t at = (first + i) % on.size();
      const bool was_on = on[(first + i - 1) % on.size()] != 0;
      if (on[at] != 0 && !was_on) intervals.push_back({static_cast<double>(at) / points, 0.0});
      if (on[at] != 0) continue;
      if (was_on) {
        double fall = static_cast<double>(at) / points;
        if (fall <= intervals.back().rise) fall += 1.0;
        intervals.back().fall = fall;
      }
    }
    std::sort(intervals.begin(), intervals.end(),
              [](const OnInterval& a, const OnInterval& b) { return a.rise < b.rise; });
    waveform = Waveform::binary(
        std::move(intervals), most_level == 1.0 ? 1.0 : points / static_cast<double>(points_on()));
  }
};

struct Settled {
  RoundedArm modulation, demodulation;
  double residual_rms = std::numeric_limits<double>::infinity();

  WaveformPair pair() const { return {modulation.waveform, demodulation.waveform}; }
};

bool is_valid(const Settled& one, const PairModel& model) {
  for (const RoundedArm* arm : {&one.modulation, &one.demodulation})
    if ((!arm->on.empty() && !arm->is_playable()) ||
        !keeps_shortest_run(arm->waveform, model.shortest_run()))
      return false;
  return true;
}

/// Moves each switching time by one point if that reduces the residual; returns true if one moved.
bool move_edges(RoundedArm Settled::*which, const PairModel& model, Settled& best) {
  bool is_better = false;
  const std::size_t points = (best.*which).on.size();
  for (std::size_t i = 0; i < points; ++i)
    for (const std::size_t flipped : {i, (i + points - 1) % points}) {
      const std::vector<char>& on = (best.*which).on;
      if (on[i] == on[(i + points - 1) % points]) break;  // no edge
      Settled moved = best;
      RoundedArm& arm = moved.*which;
      arm.on[flipped] = arm.on[flipped] == 0;
      arm.render();
      if (!is_valid(moved, model)) continue;
      moved.residual_rms = model.residual_rms(moved.pair());
      if (moved.residual_rms >= best.residual_rms * (1 - 1e-9)) continue;
      best = std::move(moved);
      is_better = true;
    }
  return is_better;
}

}  // namespace

std::optional<WaveformPair> settle_on_points(const PairModel& model, const WaveformPair& pair) {
  const int m_points = coarse_points(model.camera().light.generator, model),
            d_points = coarse_points(model.camera().sensor.generator, model);
  if (m_points + d_points == 0 || !pair.modulation.is_binary() || !pair.demodulation.is_binary())
    return std::nullopt;

  std::optional<Settled> best;
  for (int i = 0; i < delays_per_point; ++i) {
    const double delay = static_cast<double>(i) / delays_per_point / std::max(m_points, d_points);
    Settled rounded{RoundedArm(pair.modulation.delayed(delay), m_points, model.peak_factor()),
                    RoundedArm(pair.demodulation.delayed(delay), d_points, 1.0)};
    if (!is_valid(rounded, model)) continue;
    rounded.residual_rms = model.residual_rms(rounded.pair());
    if (!best || rounded.residual_rms < best->residual_rms) best = std::move(rounded);
  }
  if (!best) return std::nullopt;
  bool is_better = true;
  for (int round = 0; is_better && round < max_settling_rounds; ++round) {
    is_better = move_edges(&Settled::modulation, model, *best);
    is_better = move_edges(&Settled::demodulation, model, *best) || is_better;
  }
  return best->pair();
}

}  // namespace tofsmith
