// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_order.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "code/shared/exposure_groups.hpp"
#include "tofsmith/simulate/motion_error.hpp"

namespace tofsmith {

namespace {

constexpr std::size_t max_exposures_of_all_orders = 8;

bool lists_values_of_exposures(const Camera& camera) {
  return !camera.exposure_s.each_s.empty() || !camera.sensor.modulation_contrasts.empty() ||
         (camera.sensor.taps == 1 && camera.sensor.tap_mismatch != 0.0) ||
         (camera.playback && (camera.playback->has_list() || !camera.playback->order.empty()));
}

/// Computes the error of every order of the exposures of a code.
class OrderSearch {
 public:
  OrderSearch(const CodeSet& code, const Camera& camera, double velocity_m_per_s)
      : code_(code),
        velocity_m_per_s_(velocity_m_per_s),
        bias_(ForwardModel(code, camera), camera),
        times_s_(exposure_times_s(code, camera)),
        timed_(camera) {
    result_.order.resize(times_s_.size());
    std::iota(result_.order.begin(), result_.order.end(), 0);
    max_runs_ = runs(result_.order);
    result_.rms_bias_m = result_.given_rms_bias_m = rms_m(result_.order);
  }

  ExposureOrder best() {
    if (times_s_.size() <= max_exposures_of_all_orders)
      try_all();
    else
      exchange_pairs();
    return result_;
  }
  const ExposureOrder& given() const { return result_; }

 private:
  void try_all() {
    std::vector<int> order = result_.order;
    while (std::next_permutation(order.begin(), order.end())) keep_if_better(order);
  }

  void exchange_pairs() {
    for (bool is_improved = true; is_improved;) {
      is_improved = false;
      for (std::size_t i = 0; i < times_s_.size(); ++i)
        for (std::size_t j = i + 1; j < times_s_.size(); ++j) {
          std::vector<int> order = result_.order;
          std::swap(order[i], order[j]);
          is_improved |= keep_if_better(order);
        }
    }
  }

  bool keep_if_better(const std::vector<int>& order) {
    if (runs(order) > max_runs_) return false;
    constexpr double rounding = 1e-6;  // smaller differences are not due to the order
    const double error_m = rms_m(order);
    if (!(error_m < result_.rms_bias_m - rounding * result_.given_rms_bias_m)) return false;
    result_.order = order;
    result_.rms_bias_m = error_m;
    return true;
  }

  /// Returns the number of runs of exposures with the same modulation.
  std::ptrdiff_t runs(const std::vector<int>& order) const {
    std::ptrdiff_t count = 1;
    for (std::size_t i = 1; i < order.size(); ++i)
      count += !(code_.modulation(order[i]) == code_.modulation(order[i - 1]));
    return count;
  }

  double rms_m(const std::vector<int>& order) {
    std::vector<double>& in_order_s = timed_.exposure_s.each_s;
    in_order_s.clear();
    for (const int e : order) in_order_s.push_back(times_s_[static_cast<std::size_t>(e)]);
    const Eigen::VectorXd by_place_m = exposure_shifts_m(timed_, velocity_m_per_s_);
    Eigen::VectorXd shift_m(by_place_m.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      shift_m[order[i]] = by_place_m[static_cast<Eigen::Index>(i)];
    return bias_.rms_m(shift_m);
  }

  const CodeSet& code_;
  double velocity_m_per_s_;
  MotionBias bias_;
  std::vector<double> times_s_;  // of the code's exposures
  Camera timed_;                 // with the times of the order that is tried
  std::ptrdiff_t max_runs_ = 0;
  ExposureOrder result_;
};

}  // namespace

ExposureOrder best_exposure_order(const CodeSet& code, const Camera& camera,
                                  double velocity_m_per_s) {
  OrderSearch search(code, camera, velocity_m_per_s);
  return lists_values_of_exposures(camera) ? search.given() : search.best();
}

void choose_exposure_order(const Camera& camera, Candidate& candidate) {
  if (!camera.operating.velocity_m_per_s) return;
  const CodeSet& code = candidate.code;
  ExposureOrder found = best_exposure_order(code, camera, *camera.operating.velocity_m_per_s);
  if (candidate.target.cols() == code.exposures())
    candidate.target = candidate.target(Eigen::all, found.order).eval();
  candidate.per_measurement = in_exposure_order(candidate.per_measurement, found.order);
  candidate.code = code.with_exposure_order(found.order);
  candidate.exposure_order = std::move(found);
}

}  // namespace tofsmith
