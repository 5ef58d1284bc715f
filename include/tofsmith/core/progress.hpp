// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace tofsmith {

/// How far long work has come. Called now and then, from the thread that started the work.
/// @param fraction  share of the work that is done, in [0, 1]
/// @param step      what is being done, in a few words
/// @return false to stop: the work then throws Interrupted
using Progress = std::function<bool(double fraction, std::string_view step)>;

/// Reports to `progress` if there is one.
/// @throws Interrupted if the callback asks to stop
void report(const Progress& progress, double fraction, std::string_view step);

/// Splits progress among the parts of a work, which follow one another; each part is reported as a
/// progress of its own, from 0 to 1, and may be split again.
class ProgressParts {
 public:
  /// `count` parts that take equally long.
  ProgressParts(Progress whole, std::size_t count);
  /// One part for each of `weights`, which say how long each takes: >= 0, of any unit, not all 0.
  ProgressParts(Progress whole, const std::vector<double>& weights);

  /// Part `i`: its progress reaches the whole in its share of [0, 1]. May outlive this object.
  Progress operator[](std::size_t i) const;

 private:
  Progress whole_;
  std::vector<double> ends_;  ///< share of the whole that is done with each part
};

/// How long work still takes, judged by how far it had come when. Steps of a work differ in speed,
/// so the last half of the time so far counts; and nothing is said while that half and the whole
/// disagree, or while there is too little to go by.
class RemainingTime {
 public:
  /// @param passed_s  seconds since the work began, no less than before
  /// @param fraction  share of the work that is done
  void add(double passed_s, double fraction);

  /// Seconds that are left; nothing while that would be a guess.
  std::optional<double> seconds() const;

 private:
  struct Moment {
    double passed_s, fraction;
  };
  double fraction_at(double passed_s) const;

  Moment now_{0.0, 0.0};
  std::vector<Moment> past_{now_};  // thinned out: each is later than the one before by its share
};

}  // namespace tofsmith
