// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
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

/// Splits progress among the parts of a work, which follow one another; each part is told as a
/// progress of its own, from 0 to 1, and may be split again.
class ProgressParts {
 public:
  /// `count` parts that take equally long.
  ProgressParts(Progress whole, std::size_t count);
  /// One part for each of `weights`, which say how long each takes: >= 0, of any unit, not all 0.
  ProgressParts(Progress whole, const std::vector<double>& weights);

  /// Part `i`: what it tells reaches the whole in its share of [0, 1]. May outlive this object.
  Progress operator[](std::size_t i) const;

 private:
  Progress whole_;
  std::vector<double> ends_;  ///< share of the whole that is done with each part
};

}  // namespace tofsmith
