// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/progress.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/shared/shared_progress.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

void RemainingTime::add(double passed_s, double fraction) {
  constexpr double min_step_s = 0.05, min_share = 0.02;
  now_ = {passed_s, fraction};
  const double last_s = past_.back().passed_s;
  if (passed_s - last_s >= std::max(min_step_s, min_share * last_s)) past_.push_back(now_);
}

std::optional<double> RemainingTime::seconds() const {
  constexpr double soon_s = 3.0, long_s = 30.0;
  constexpr double little = 0.03;  // fraction of the work, unless it takes long
  constexpr double agreement = 1.5;
  const auto [passed_s, fraction] = now_;
  if (passed_s < soon_s || (fraction < little && passed_s < long_s)) return std::nullopt;
  const double whole_per_s = fraction / passed_s;
  const double half_per_s = (fraction - fraction_at(passed_s / 2)) / (passed_s / 2);
  if (!(half_per_s > 0.0) || half_per_s > agreement * whole_per_s ||
      whole_per_s > agreement * half_per_s)
    return std::nullopt;
  return (1.0 - fraction) / half_per_s;
}

double RemainingTime::fraction_at(double passed_s) const {
  const auto after =
      std::upper_bound(past_.begin(), past_.end(), passed_s,
                       [](const auto& value, const auto& item) { return value < item.passed_s; });
  const Moment before = *std::prev(after);
  const Moment next = after == past_.end() ? now_ : *after;
  const double step_s = next.passed_s - before.passed_s;
  const double along = step_s > 0.0 ? (passed_s - before.passed_s) / step_s : 0.0;
  return before.fraction + along * (next.fraction - before.fraction);
}

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

SharedProgress::SharedProgress(Progress progress, double pieces, std::string step)
    : progress_(std::move(progress)), pieces_(pieces), step_(std::move(step)) {
  report(progress_, 0.0, step_);
}

void SharedProgress::add(double pieces) {
  if (!progress_) return;
  double done = done_.load(std::memory_order_relaxed);  // libc++ 14 lacks fetch_add for doubles
  while (!done_.compare_exchange_weak(done, done + pieces, std::memory_order_relaxed)) {
  }
  done += pieces;
  if (is_stopped_.load(std::memory_order_relaxed)) throw Interrupted();
  if (std::this_thread::get_id() != caller_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - reported_at_ < std::chrono::milliseconds(50)) return;
  reported_at_ = now;
  if (progress_(std::min(1.0, done / pieces_), step_)) return;
  is_stopped_.store(true, std::memory_order_relaxed);
  throw Interrupted();
}

}  // namespace tofsmith
