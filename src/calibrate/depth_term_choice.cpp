// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/depth_term_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tofsmith {

namespace {

constexpr int slabs = 4, checkers = 2;

/// Assigns samples to cells for cross-validation: colour of a checkerboard and quarter of the
/// range.
std::vector<int> cells_of(const DepthFit& fit) {
  const auto at_m = each(fit.samples, [](const auto& s) { return s.reference_m; });
  std::array<double, slabs - 1> border_m{};
  for (int q = 1; q < slabs; ++q)
    border_m[static_cast<std::size_t>(q - 1)] = quantile_of(at_m, static_cast<double>(q) / slabs);
  const int block_rows = std::max(1, fit.height / 8), block_columns = std::max(1, fit.width / 8);
  std::vector<int> cell;
  for (const ReferenceSample& s : fit.samples) {
    const int slab = static_cast<int>(
        std::ranges::count_if(border_m, [&](double border) { return s.reference_m > border; }));
    const int colour = (s.row / block_rows + s.column / block_columns + s.frame) % checkers;
    cell.push_back(slab * checkers + colour);
  }
  return cell;
}

/// rms that a choice leaves on folds of cells held out in turn.
double held_out_rms_m(const std::vector<NormalSums>& sums, const TermChoice& choice,
                      bool by_range) {
  const std::vector<int> columns = choice.columns();
  double left = 0.0, weight = 0.0;
  for (int fold = 0; fold < (by_range ? slabs : checkers); ++fold) {
    NormalSums kept, out;
    for (std::size_t c = 0; c < sums.size(); ++c) {
      const int its = static_cast<int>(c);
      (((by_range ? its / checkers : its % checkers) == fold) ? out : kept).add(sums[c]);
    }
    if (!(out.weight > 0.0) || !(kept.weight > 0.0)) continue;
    left += out.left(columns, kept.solve(columns));
    weight += out.weight;
  }
  return std::sqrt(left / std::max(1e-300, weight));
}

/// Returns true if the terms are as small as depth errors can be. Terms that the depths of the
/// reference cannot separate are far larger and cancel each other.
bool is_plausible(const NormalSums& all, const TermChoice& choice, double range_m) {
  constexpr double largest_share = 0.1;
  return all.solve(choice.columns()).lpNorm<Eigen::Infinity>() < largest_share * range_m;
}

/// Returns true if the signal varies independently of the other terms. On targets of one albedo it
/// is a function of depth, and terms in signal and depth would cancel each other and be wrong in
/// other scenes.
bool signal_varies(const NormalSums& all, int highest_harmonic, int degree) {
  constexpr double least_share = 0.02;
  const std::vector<int> others = TermChoice{(1u << highest_harmonic) - 1u, degree, 0}.columns();
  const int signal = TermChoice{0, 0, 1}.columns().back();
  const NormalSums of_signal{all.gram, all.gram.col(signal), all.gram(signal, signal), all.weight};
  const auto left = [&](const std::vector<int>& columns) {
    return of_signal.left(columns, of_signal.solve(columns));
  };
  return left(others) > least_share * left({0});
}

/// Returns sets of harmonics that are common in cameras; for k equally spaced phases, k and 2 k.
std::vector<unsigned> harmonic_sets(int highest) {
  const auto set = [](std::initializer_list<int> list) {
    unsigned bits = 0;
    for (const int h : list) bits |= 1u << (h - 1);
    return bits;
  };
  std::vector<unsigned> sets;
  for (const unsigned bits :
       {0u, set({1}), set({2}), set({3}), set({4}), set({1, 2}), set({2, 4}), set({3, 6}),
        set({4, 8}), set({1, 2, 3}), set({1, 2, 4}), set({1, 2, 3, 4}), set({2, 4, 6, 8}),
        set({1, 2, 3, 4, 8}), set({1, 2, 3, 4, 5, 6}), set({1, 2, 3, 4, 5, 6, 7, 8})})
    if (bits < (1u << highest)) sets.push_back(bits);
  return sets;
}

}  // namespace

double quantile_of(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Chosen choose(const DepthFit& fit, int highest_harmonic, int max_degree, bool prefer_few) {
  const std::vector<NormalSums> sums =
      sums_of(fit.terms, fit.error_m, fit.weight, cells_of(fit), slabs * checkers);
  struct Candidate {
    TermChoice choice;
    double near_m, far_m;
  };
  NormalSums all;
  for (const NormalSums& cell : sums) all.add(cell);
  const int max_signal = signal_varies(all, highest_harmonic, max_degree) ? max_error_signal : 0;
  std::vector<Candidate> candidates;
  for (const unsigned harmonics : harmonic_sets(highest_harmonic))
    for (int degree = 0; degree <= max_degree; ++degree)
      for (int signal = 0; signal <= max_signal; ++signal) {
        const TermChoice choice{harmonics, degree, signal};
        if (choice.size() > 1 && !is_plausible(all, choice, fit.range_m)) continue;
        candidates.push_back(
            {choice, held_out_rms_m(sums, choice, false), held_out_rms_m(sums, choice, true)});
      }
  const auto& near = *std::ranges::min_element(candidates, {}, &Candidate::near_m);
  const auto& far = *std::ranges::min_element(candidates, {}, &Candidate::far_m);
  // Include terms in the signal only if they improve the prediction. Of the other terms, use the
  // most that predict equally well, since omitting a term biases others.
  constexpr double shows = 1.01, as_well = 1.005;
  int signal = near.choice.signal;
  for (const Candidate& c : candidates)
    if (c.near_m <= shows * near.near_m) signal = std::min(signal, c.choice.signal);
  double least_m = std::numeric_limits<double>::infinity();
  for (const Candidate& c : candidates)
    if (c.choice.signal == signal) least_m = std::min(least_m, c.near_m);
  const Candidate* best = nullptr;
  for (const Candidate& c : candidates)
    if (c.choice.signal == signal && c.near_m <= as_well * least_m &&
        (!best || (prefer_few ? c.choice.size() < best->choice.size()
                              : c.choice.size() > best->choice.size())))
      best = &c;
  return {best->choice, far.choice, best->near_m, far.far_m};
}

}  // namespace tofsmith
