// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <functional>
#include <vector>

namespace tofsmith::benchmarks {

/// A function to be timed.
struct Contender {
  double pixels = 0.0;  ///< per call
  std::function<void()> work;
};

/// Seconds per pixel of contenders in alternation, so that other load affects all of them equally.
/// Only ratios are meaningful.
class Turns {
 public:
  /// @param clock  CLOCK_THREAD_CPUTIME_ID for a single thread, else CLOCK_MONOTONIC
  Turns(const std::vector<Contender>& contenders, int rounds,
        clockid_t clock = CLOCK_THREAD_CPUTIME_ID)
      : seconds_(contenders.size()) {
    for (const Contender& contender : contenders) contender.work();  // touches its memory
    for (int round = 0; round < rounds; ++round)
      for (std::size_t i = 0; i < contenders.size(); ++i) {
        const double start = now_s(clock);
        contenders[i].work();
        seconds_[i].push_back((now_s(clock) - start) / contenders[i].pixels);
      }
  }

  double min_s(std::size_t i) const {
    return *std::min_element(seconds_[i].begin(), seconds_[i].end());
  }
  double pixels_per_s(std::size_t i) const { return 1.0 / min_s(i); }
  /// Speed relative to contender `other`, both at their fastest.
  double speed_over(std::size_t i, std::size_t other) const { return min_s(other) / min_s(i); }
  /// Median over rounds of the speed ratio within a round.
  double median_speed_over(std::size_t i, std::size_t other) const {
    std::vector<double> ratios;
    for (std::size_t round = 0; round < seconds_[i].size(); ++round)
      ratios.push_back(seconds_[other][round] / seconds_[i][round]);
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
  }

 private:
  static double now_s(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  std::vector<std::vector<double>> seconds_;  // per pixel, contender and round
};

}  // namespace tofsmith::benchmarks
