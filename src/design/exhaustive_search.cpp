// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exhaustive_search.hpp"

#include <algorithm>
#include <cmath>

#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/shared_progress.hpp"

namespace tofsmith {

namespace {
/// Equal metrics may differ by rounding; none of them is lost.
constexpr double rounding = 1.0 + 1e-9;
}  // namespace

double limit_of(const ExhaustiveTask& task, const BestCodes& best) {
  return rounding * std::min(task.limit, best.limit());
}

void put_fisher(const FisherMatrix& matrix, float* first, int stride) {
  for (const double entry : {matrix.zz, matrix.zs, matrix.ss, matrix.za, matrix.sa, matrix.aa}) {
    *first = static_cast<float>(entry);
    first += stride;
  }
}

void look_at(const ChipCode& code, const std::vector<FisherMatrix>& nodes,
             const ExhaustiveTask& task, double share, BestCodes& best, ChipSearchCounts& counts) {
  ++counts.metric_evaluations;
  const double limit = limit_of(task, best);
  const double score = task.judge->score_with_last(code, nodes, limit);
  if (!(score <= limit) || !std::isfinite(score)) {
    ++counts.pruned_by_metric;
    return;
  }
  if (!task.judge->is_safe(code, counts)) return;
  ++counts.kept;
  best.offer(code, score, share);
}

void search_in_rounds(std::int64_t items, std::int64_t items_at_once, ExhaustiveFinding& finding,
                      const SearchShare& share, const Progress& progress) {
  std::int64_t round = std::min<std::int64_t>(4, items_at_once);
  SharedProgress shared(progress, static_cast<double>(items), "codes searched");
  for (std::int64_t begin = 0; begin < items;
       begin += round, round = std::min(2 * round, items_at_once)) {
    const std::int64_t count = std::min(round, items - begin);
    std::vector<ExhaustiveFinding> parts(static_cast<std::size_t>(count),
                                         ExhaustiveFinding{finding.best, {}});
    parallel_for(count, [&](std::int64_t i) {
      ExhaustiveFinding& part = parts[static_cast<std::size_t>(i)];
      share(begin + i, part.best, part.counts);
      shared.add();
    });
    for (const ExhaustiveFinding& part : parts) {
      finding.best.merge(part.best);
      finding.counts += part.counts;
    }
  }
  report(progress, 1.0, "codes searched");
}

double exhaustive_size(const AssignmentRules& rules, int exposures) {
  double reorderings = 1.0;
  for (int tap = 2; tap <= rules.taps; ++tap) reorderings *= tap;
  const double modulations = std::exp2(rules.chips) - 2;
  const double n = rules.chips, assignments = raw_tap_assignments(rules) / reorderings;
  // Delays of light and taps on their own, and mirror images, of the first exposure; the taps'
  // own delays of the others; and their order.
  const double first = modulations * assignments / (2 * n * n);
  return exposures == 1
             ? first
             : first * std::pow(modulations * assignments / n, exposures - 1) / exposures;
}

}  // namespace tofsmith
