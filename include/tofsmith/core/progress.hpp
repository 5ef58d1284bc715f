// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Progress callback, called occasionally from the thread that started the work.
/// @param fraction  completed fraction of the work, in [0, 1]
/// @param step      short description of the current step
/// @return false to cancel; the work then throws Interrupted
using Progress = std::function<bool(double fraction, std::string_view step)>;

/// Calls `progress` unless it is empty.
/// @throws Interrupted if the callback cancels
void report(const Progress& progress, double fraction, std::string_view step);

/// Splits progress among consecutive parts of a task. Each part reports progress from 0 to 1 and
/// can be split again.
class ProgressParts {
 public:
  /// `count` parts of equal duration.
  ProgressParts(Progress whole, std::size_t count);
  /// One part per weight, its relative duration: >= 0, not all 0.
  ProgressParts(Progress whole, const std::vector<double>& weights);

  /// Returns the progress callback of part `i`, which maps to its share of [0, 1]. May outlive this
  /// object.
  Progress operator[](std::size_t i) const;

 private:
  Progress whole_;
  std::vector<double> ends_;  ///< fraction at the end of each part
};

/// Estimates the remaining time of a task. Because steps differ in speed, the estimate uses the
/// last half of the elapsed time. There is no estimate while this half disagrees with the whole, or
/// while there is little data.
class RemainingTime {
 public:
  /// @param passed_s  elapsed seconds, not decreasing
  /// @param fraction  completed fraction
  void add(double passed_s, double fraction);

  /// Remaining seconds; none if uncertain.
  std::optional<double> seconds() const;

 private:
  struct Moment {
    double passed_s, fraction;
  };
  double fraction_at(double passed_s) const;

  Moment now_{0.0, 0.0};
  std::vector<Moment> past_{now_};  // thinned out: the spacing grows with the elapsed time
};

}  // namespace tofsmith
