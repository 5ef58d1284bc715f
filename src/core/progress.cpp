// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/progress.hpp"

#include <cmath>
#include <utility>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

void report(const Progress& progress, double fraction, std::string_view step) {
  if (progress && !progress(fraction, step)) throw Interrupted();
}

ProgressParts::ProgressParts(Progress whole, std::size_t count)
    : ProgressParts(std::move(whole), std::vector<double>(count, 1.0)) {}

ProgressParts::ProgressParts(Progress whole, const std::vector<double>& weights)
    : whole_(std::move(whole)) {
  double sum = 0.0, all = 0.0;
  for (const double weight : weights) {
    TOFSMITH_ASSERT_LE(0.0, weight);
    all += weight;
  }
  for (const double weight : weights) ends_.push_back((sum += weight) / all);
  if (!weights.empty()) TOFSMITH_ASSERT_LT(0.0, all);
}

Progress ProgressParts::operator[](std::size_t i) const {
  TOFSMITH_ASSERT_LT(i, ends_.size());
  if (!whole_) return {};
  return [whole = whole_, begin = i == 0 ? 0.0 : ends_[i - 1], end = ends_[i]](
             double fraction, std::string_view step) {
    return whole(std::lerp(begin, end, fraction), step);
  };
}

}  // namespace tofsmith
