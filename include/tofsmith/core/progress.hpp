// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Progress callback, called from the thread that started the work.
/// @param fraction  completed, in [0, 1]
/// @param step      short description of the current step
/// @return false to cancel; the work then throws Interrupted
using Progress = std::function<bool(double fraction, std::string_view step)>;

/// Calls `progress` unless it is empty.
/// @throws Interrupted if the callback cancels
void report(const Progress& progress, double fraction, std::string_view step);

/// Splits progress among consecutive parts of a task, each from 0 to 1. Parts can be split again.
class ProgressParts {
 public:
  /// `count` parts of equal duration.
  ProgressParts(Progress whole, std::size_t count);
  /// Weights are relative durations: >= 0, not all 0.
  ProgressParts(Progress whole, const std::vector<double>& weights);

  /// Returns the callback of part `i`, which may outlive this object.
  Progress operator[](std::size_t i) const;

 private:
  Progress whole_;
  std::vector<double> ends_;
};

/// Estimates the remaining time of a task from the last half of the elapsed time, because steps
/// differ in speed. There is no estimate while this half disagrees with the whole, or while there
/// is little data.
class RemainingTime {
 public:
  /// @param passed_s  elapsed, not decreasing
  /// @param fraction  completed
  void add(double passed_s, double fraction);

  /// Empty if uncertain.
  std::optional<double> seconds() const;

 private:
  struct Moment {
    double passed_s, fraction;
  };
  double fraction_at(double passed_s) const;

  Moment now_{0.0, 0.0};
  std::vector<Moment> past_{now_};  // thinned out: the spacing grows with time
};

}  // namespace tofsmith
