// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chips/chip_judge.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

// Gauss-Legendre nodes and weights on [0, 1].
constexpr std::array<double, nodes_per_chip> node_position = {
    0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
constexpr std::array<double, nodes_per_chip> node_weight = {
    0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};

bool repeats(const ChipCode& code) {
  std::array<std::array<int, max_chip_measurements>, max_chips> corners{};
  for (int s = 0; s < code.chips; ++s) {
    auto& corner = corners[static_cast<std::size_t>(s)];
    for (int i = 0; i < code.measurements(); ++i)
      corner[static_cast<std::size_t>(i)] = code.correlation(i, s);
    for (int u = 0; u < s; ++u)
      if (corners[static_cast<std::size_t>(u)] == corner) return true;
  }
  return false;
}

/// Adds one exposure at all nodes (4 n).
void add_exposure(ChipWord modulation, const ChipWord* taps, int tap_count, const ChipLight& light,
                  FisherMatrix* nodes) {
  const double electrons = light.electrons_of(std::popcount(modulation));
  for (int i = 0; i < tap_count; ++i) {
    const double open = std::popcount(taps[i]);
    const double dark_e2 = light.ambient_e * open + light.constant_e2;
    double here = std::popcount(taps[i] & modulation);
    FisherMatrix* node = nodes;
    for (int s = 0; s < light.chips; ++s) {
      const double next = std::popcount(taps[i] & delayed_chips(modulation, s + 1, light.chips));
      const double slope = electrons * (next - here);
      for (int q = 0; q < nodes_per_chip; ++q, ++node) {
        const double signal =
            electrons * (here + (next - here) * node_position[static_cast<std::size_t>(q)]);
        const double weight = 1.0 / (signal + dark_e2);
        node->zz += weight * slope * slope;
        node->ss += weight * signal * signal;
        if (!light.is_known) {
          node->zs += weight * slope * signal;
          node->za += weight * slope * open;
        }
        node->sa += weight * signal * open;
        node->aa += weight * open * open;
      }
      here = next;
    }
  }
}

/// Returns gamma [chips^2], the mean of depth_variance() over depth; stops above `limit`.
double mean_depth_variance(const FisherMatrix* nodes, int chips, double limit) {
  const double stop = limit * chips;
  double sum = 0.0;
  for (int s = 0; s < chips; ++s) {
    for (int q = 0; q < nodes_per_chip; ++q)
      sum +=
          node_weight[static_cast<std::size_t>(q)] * nodes[s * nodes_per_chip + q].depth_variance();
    if (!(sum <= stop)) break;
  }
  return sum / chips;
}

}  // namespace

FisherMatrix& FisherMatrix::operator+=(const FisherMatrix& other) {
  zz += other.zz;
  zs += other.zs;
  ss += other.ss;
  za += other.za;
  sa += other.sa;
  aa += other.aa;
  return *this;
}

double FisherMatrix::depth_variance() const {
  if (zs == 0.0 && za == 0.0) return zz > 0.0 ? 1.0 / zz : infinity;  // such as for known light
  // Schur complements: eliminate ambient light, then signal.
  const double per_ambient = 1.0 / aa;
  const double signal = ss - sa * sa * per_ambient;
  constexpr double rounding = 1e-12;
  if (!(signal > rounding * ss)) return infinity;
  const double across = zs - za * sa * per_ambient;
  const double depth = zz - za * za * per_ambient - across * across / signal;
  return depth > rounding * zz ? 1.0 / depth : infinity;
}

FisherMatrix largest_tap_fisher(int correlation, int next, int open_chips,
                                double electrons_per_chip, const ChipLight& light) {
  const double slope = electrons_per_chip * (next - correlation);
  const double signal = electrons_per_chip * correlation, open = open_chips;
  const double weight = 1.0 / (electrons_per_chip * std::min(correlation, next) +
                               light.ambient_e * open + light.constant_e2);
  return {.zz = weight * slope * slope,
          .zs = light.is_known ? 0.0 : weight * slope * signal,
          .ss = weight * signal * signal,
          .za = light.is_known ? 0.0 : weight * slope * open,
          .sa = weight * signal * open,
          .aa = weight * open * open};
}

ChipJudge::ChipJudge(const Camera& camera, const ChipSearchOptions& options)
    : chips_(chips_of(camera)),
      taps_(camera.sensor.taps),
      equal_duty_(options.equal_duty),
      drain_(camera.sensor.drain),
      metric_(options.metric),
      separation_periods_(options.separation_periods) {
  for (const OperatingPoint& point : camera.operating.points())
    lights_.emplace_back(camera, point, chips_, options.exposures, options.metric);
  asked_sigma_.assign(lights_.size(), options.margin_sigma);
}

std::vector<FisherMatrix> ChipJudge::nodes_of(const ChipCode& code, int exposures) const {
  const auto nodes_per_point = static_cast<std::size_t>(chips_) * nodes_per_chip;
  std::vector<FisherMatrix> nodes(lights_.size() * nodes_per_point);
  for (std::size_t p = 0; p < lights_.size(); ++p)
    for (int e = 0; e < exposures; ++e)
      add_exposure(code.modulation[static_cast<std::size_t>(e)], code.taps_of(e), taps_, lights_[p],
                   nodes.data() + p * nodes_per_point);
  return nodes;
}

double ChipJudge::score(const ChipCode& code) const {
  return score_with_last(code, nodes_of(code, code.exposures() - 1), infinity);
}

double ChipJudge::score_with_last(const ChipCode& code, const std::vector<FisherMatrix>& nodes,
                                  double limit) const {
  const auto nodes_per_point = static_cast<std::size_t>(chips_) * nodes_per_chip;
  std::array<FisherMatrix, std::size_t{max_chips} * nodes_per_chip> sum;
  double log_sum = 0.0;
  for (std::size_t p = 0; p < lights_.size(); ++p) {
    const auto begin = nodes.begin() + static_cast<std::ptrdiff_t>(p * nodes_per_point);
    std::copy(begin, begin + static_cast<std::ptrdiff_t>(nodes_per_point), sum.begin());
    add_exposure(code.modulation.back(), code.taps_of(code.exposures() - 1), taps_, lights_[p],
                 sum.data());
    const double gamma =
        mean_depth_variance(sum.data(), chips_, lights_.size() == 1 ? limit : infinity);
    if (lights_.size() == 1) return gamma;
    log_sum += std::log(gamma);
  }
  return std::exp(log_sum / static_cast<double>(lights_.size()));
}

bool ChipJudge::is_safe(const ChipCode& code, ChipSearchCounts& counts) const {
  if (repeats(code)) {
    ++counts.ambiguous;
    return false;
  }
  for (std::size_t p = 0; p < lights_.size(); ++p) {
    const ChipMargin margin(code, lights_[p], separation_periods_);
    if (margin.sampled_sigma(1, asked_sigma_[p]) < asked_sigma_[p]) {
      ++counts.below_margin;
      return false;
    }
  }
  if (is_ambiguous(code)) {
    ++counts.ambiguous;
    return false;
  }
  for (std::size_t p = 0; p < lights_.size(); ++p) {
    if (!ChipMargin(code, lights_[p], separation_periods_).reaches(asked_sigma_[p])) {
      ++counts.below_margin;
      return false;
    }
  }
  return true;
}

double ChipJudge::sampled_margin_share(const ChipCode& code) const {
  double share = 1.0;
  for (std::size_t p = 0; p < lights_.size(); ++p)
    if (asked_sigma_[p] > 0.0)
      share = std::min(share, ChipMargin(code, lights_[p], separation_periods_).sampled_sigma(2) /
                                  asked_sigma_[p]);
  return share;
}

double ChipJudge::proven_margin_sigma(const ChipCode& code) const {
  double sigma = 0.0, min_share = infinity;
  for (std::size_t p = 0; p < lights_.size(); ++p) {
    const double here = ChipMargin(code, lights_[p], separation_periods_).proven_sigma();
    const double share = here / std::max(1e-9, asked_sigma_[p]);
    if (share < min_share) {
      min_share = share;
      sigma = here;
    }
  }
  return sigma;
}

void ChipJudge::ask_no_more_than(const std::vector<ChipCode>& codes) {
  std::vector<double> asked;
  double largest_share = 0.0;
  for (const ChipCode& code : codes) {
    if (largest_share == 1.0) return;
    if (is_ambiguous(code)) continue;
    std::vector<double> kept = asked_sigma_;
    double share = 1.0;
    for (std::size_t p = 0; p < lights_.size() && share > largest_share; ++p) {
      const ChipMargin margin(code, lights_[p], separation_periods_);
      if (margin.reaches(kept[p])) continue;
      kept[p] = margin.proven_sigma();
      share = std::min(share, kept[p] / asked_sigma_[p]);
    }
    if (share <= largest_share) continue;
    largest_share = share;
    asked = std::move(kept);
  }
  if (!asked.empty()) asked_sigma_ = std::move(asked);
}

double ChipJudge::rms_m(double score) const { return lights_.front().chip_m * std::sqrt(score); }

bool ChipJudge::is_allowed(const ChipCode& code) const {
  for (int e = 0; e < code.exposures(); ++e) {
    const ChipWord light = code.modulation[static_cast<std::size_t>(e)];
    if (light == 0 || light == all_chips(chips_)) return false;
    ChipWord taken = 0;
    for (int i = 0; i < taps_; ++i) {
      const ChipWord word = code.taps_of(e)[i];
      if (word == 0 || (taken & word) != 0) return false;
      if (equal_duty_ && std::popcount(word) != std::popcount(code.taps_of(e)[0])) return false;
      taken |= word;
    }
    if (!drain_ && taken != all_chips(chips_)) return false;
  }
  return true;
}

}  // namespace tofsmith
