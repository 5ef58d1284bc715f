// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/run_lengths.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "code/shared/on_intervals.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

double shortest_run_periods(const Camera& camera) {
  return camera.sensor.shortest_pulse_s.value_or(0.0) * camera.fundamental_frequency_hz;
}

bool keeps_shortest_run(const Waveform& waveform, double shortest_run) {
  if (!waveform.is_binary()) return true;
  const std::vector<OnInterval>& on = waveform.on_intervals();
  for (std::size_t i = 0; i < on.size(); ++i) {
    const double next = i + 1 < on.size() ? on[i + 1].rise : on[0].rise + 1.0;
    const double gap = next - on[i].fall;
    constexpr double rounding = 1e-9;
    if (on[i].fall - on[i].rise < shortest_run - rounding) return false;
    if (gap > rounding && gap < shortest_run - rounding) return false;
  }
  return true;
}

bool keeps_shortest_run(const CodeSet& code, const Camera& camera) {
  const double shortest_run = shortest_run_periods(camera);
  for (int i = 0; i < code.measurements(); ++i)
    if (!keeps_shortest_run(code.modulation_of(i), shortest_run) ||
        !keeps_shortest_run(code.demodulation(i), shortest_run))
      return false;
  return true;
}

namespace {

/// Softmax of the entries first, first + stride, ..., with derivatives, in place.
void softmax(const Eigen::VectorXd& logits, Eigen::Index first, Eigen::Index stride,
             Eigen::VectorXd& shares, Eigen::MatrixXd& derivatives) {
  double largest = -1e300, sum = 0.0;
  for (Eigen::Index i = first; i < logits.size(); i += stride)
    largest = std::max(largest, logits[i]);
  for (Eigen::Index i = first; i < logits.size(); i += stride)
    sum += shares[i] = std::exp(logits[i] - largest);
  for (Eigen::Index i = first; i < logits.size(); i += stride) shares[i] /= sum;
  for (Eigen::Index i = first; i < logits.size(); i += stride)
    for (Eigen::Index j = first; j < logits.size(); j += stride)
      derivatives(i, j) = shares[i] * ((i == j ? 1.0 : 0.0) - shares[j]);
}

/// Removes short pulses before short gaps.
std::vector<OnInterval> without_short_runs(std::vector<OnInterval> on, double shortest_run) {
  std::erase_if(on, [&](const OnInterval& i) { return i.fall - i.rise < shortest_run; });
  std::vector<OnInterval> merged;
  for (const OnInterval& interval : on) {
    if (!merged.empty() && interval.rise - merged.back().fall < shortest_run)
      merged.back().fall = interval.fall;
    else
      merged.push_back(interval);
  }
  if (merged.size() > 1 && merged.front().rise + 1.0 - merged.back().fall < shortest_run) {
    merged.front().rise = merged.back().rise - 1.0;
    merged.pop_back();
  }
  return merged;
}

}  // namespace

RunLengths::RunLengths(const Waveform& waveform, double shortest_duty)
    : shortest_duty_(shortest_duty), runs_(2 * std::ssize(waveform.on_intervals())) {
  const std::vector<OnInterval>& on = waveform.on_intervals();
  constexpr double tiny = 1e-6;  // keeps logits finite
  parameters_ = Eigen::VectorXd::Zero(1 + runs_ + (shortest_duty > 0.0 ? 1 : 0));
  parameters_[0] = on.front().rise;
  for (std::size_t i = 0; i < on.size(); ++i) {
    const double next = i + 1 < on.size() ? on[i + 1].rise : on[0].rise + 1.0;
    const auto run = static_cast<Eigen::Index>(2 * i);
    parameters_[1 + run] = std::log(std::max(tiny, on[i].fall - on[i].rise));
    parameters_[2 + run] = std::log(std::max(tiny, next - on[i].fall));
  }
  if (shortest_duty > 0.0) {
    // t = 0 is stationary, so start slightly inside.
    const double excess =
        (waveform.duty() - shortest_duty) / (1.0 - std::min(shortest_duty, 0.999));
    parameters_[1 + runs_] = std::sqrt(std::clamp(excess, 1e-3, 0.98));
  }
}

void RunLengths::runs(const Eigen::VectorXd& parameters, Eigen::VectorXd& lengths,
                      Eigen::MatrixXd& derivatives) const {
  const Eigen::VectorXd logits = parameters.segment(1, runs_);
  Eigen::VectorXd shares(runs_);
  Eigen::MatrixXd share_derivatives = Eigen::MatrixXd::Zero(runs_, runs_);
  derivatives = Eigen::MatrixXd::Zero(runs_, parameters.size());
  if (shortest_duty_ <= 0.0) {
    softmax(logits, 0, 1, shares, share_derivatives);
    lengths = shares;
    derivatives.middleCols(1, runs_) = share_derivatives;
    return;
  }
  softmax(logits, 0, 2, shares, share_derivatives);
  softmax(logits, 1, 2, shares, share_derivatives);
  const double t = parameters[1 + runs_];
  const double duty = shortest_duty_ + (1.0 - shortest_duty_) * t * t;
  lengths.resize(runs_);
  for (Eigen::Index i = 0; i < runs_; ++i) {
    const bool on = i % 2 == 0;
    const double scale = on ? duty : 1.0 - duty;
    lengths[i] = scale * shares[i];
    derivatives.row(i).segment(1, runs_) = scale * share_derivatives.row(i);
    derivatives(i, 1 + runs_) = (on ? 1.0 : -1.0) * 2.0 * t * (1.0 - shortest_duty_) * shares[i];
  }
}

void RunLengths::edges(const Eigen::VectorXd& parameters, Eigen::VectorXd& times,
                       Eigen::MatrixXd& derivatives) const {
  Eigen::VectorXd lengths;
  Eigen::MatrixXd length_derivatives;
  runs(parameters, lengths, length_derivatives);
  times.resize(runs_);
  derivatives = Eigen::MatrixXd::Zero(runs_, parameters.size());
  times[0] = parameters[0];
  derivatives(0, 0) = 1.0;
  for (Eigen::Index i = 1; i < runs_; ++i) {
    times[i] = times[i - 1] + lengths[i - 1];
    derivatives.row(i) = derivatives.row(i - 1) + length_derivatives.row(i - 1);
  }
}

Waveform RunLengths::waveform(const Eigen::VectorXd& parameters, double shortest_run) const {
  Eigen::VectorXd times;
  Eigen::MatrixXd unused;
  edges(parameters, times, unused);
  std::vector<OnInterval> on;
  for (Eigen::Index i = 0; i < runs_; i += 2) on.push_back({times[i], times[i + 1]});
  on = without_short_runs(std::move(on), shortest_run);
  if (on.empty()) return Waveform::constant(0.0);
  double duty = 0.0;
  for (OnInterval& interval : on) {
    const double width = std::min(1.0, interval.fall - interval.rise);
    duty += width;
    interval.rise = wrap(interval.rise, 1.0);
    interval.fall = interval.rise + width;
  }
  const double level = shortest_duty_ > 0.0 ? 1.0 / std::max(duty, shortest_duty_) : 1.0;
  return Waveform::binary(within_period(std::move(on)), level);
}

}  // namespace tofsmith
