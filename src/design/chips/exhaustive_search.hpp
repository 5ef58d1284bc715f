// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "design/chips/best_codes.hpp"
#include "design/chips/chip_judge.hpp"
#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

/// Maximum number of taps of enumerated assignments.
inline constexpr int max_assigned_taps = 4;

/// Assignment of each chip of a period to one of the taps, or to none.
struct TapAssignment {
  std::array<ChipWord, max_assigned_taps> taps{};
  bool is_achiral = false;  ///< equals its time reversal up to delay and order of taps
};

/// Rules for the enumeration of assignments.
struct AssignmentRules {
  int chips = 9;
  int taps = 3;
  bool equal_duty = true;    ///< all taps are open for the same number of chips
  bool drain = true;         ///< chips may remain unassigned
  bool up_to_mirror = true;  ///< list only one assignment of each mirror pair
};

/// Lists one assignment of each equivalence class under delays, order of taps and, if up_to_mirror,
/// time reversal. No tap is empty. The order depends only on the rules.
std::vector<TapAssignment> tap_assignments(const AssignmentRules& rules);

/// Returns the number of assignments before symmetries are removed.
double raw_tap_assignments(const AssignmentRules& rules);

/// Returns the smallest delayed version of every word (2^n).
std::vector<ChipWord> necklace_table(int chips);
/// Returns the modulations up to delay, except always on and always off, in ascending order.
std::vector<ChipWord> modulation_necklaces(int chips);

/// Input of an exhaustive search.
struct ExhaustiveTask {
  const ChipJudge* judge = nullptr;
  AssignmentRules rules;
  int finalists = 1;
  double limit = 0.0;  ///< score of known safe codes; worse codes are skipped
};

/// Result of an exhaustive search.
struct ExhaustiveFinding {
  BestCodes best;
  ChipSearchCounts counts;
};

/// Searches all codes of one exposure. Three taps of equal duty are pruned by the exact turning
/// test, others by a bound on the metric.
ExhaustiveFinding search_single_exposures(const ExhaustiveTask& task, const Progress& progress);

/// Searches all pairs of exposures, pruned by a bound on the metric.
ExhaustiveFinding search_exposure_pairs(const ExhaustiveTask& task, const Progress& progress);

/// Estimates the number of codes in an exhaustive search after symmetries are removed.
double exhaustive_size(const AssignmentRules& rules, int exposures);

/// Searches one item. Writes only to its own counts and best codes.
using SearchShare =
    std::function<void(std::int64_t item, BestCodes& best, ChipSearchCounts& counts)>;

/// Processes items in rounds. All items of a round start with the best codes of the previous round,
/// so results and counts do not depend on the number of threads. Rounds grow up to `items_at_once`.
void search_in_rounds(std::int64_t items, std::int64_t items_at_once, ExhaustiveFinding& finding,
                      const SearchShare& share, const Progress& progress);

/// Runs a complete search. `Search` lists the items with their counts and searches one of them.
/// @param listing  progress message while items are listed
template <typename Search>
ExhaustiveFinding search_all(const ExhaustiveTask& task, const char* listing,
                             std::int64_t items_at_once, const Progress& progress) {
  ExhaustiveFinding finding{BestCodes(task.finalists), {}};
  report(progress, 0.0, listing);
  const Search search(task);
  finding.counts = search.sizes();
  search_in_rounds(
      search.items(), items_at_once, finding,
      [&](std::int64_t item, BestCodes& best, ChipSearchCounts& counts) {
        search.search_item(item, best, counts);
      },
      progress);
  return finding;
}

/// Tests one code, given the Fisher matrices of its other exposures, and keeps it if it is good.
void look_at(const ChipCode& code, const std::vector<FisherMatrix>& nodes,
             const ExhaustiveTask& task, double share, BestCodes& best, ChipSearchCounts& counts);

/// Writes the entries of a Fisher matrix in the layout of find_informed(), `stride` floats apart.
void put_fisher(const FisherMatrix& matrix, float* first, int stride);

/// Returns the largest score that is still considered.
double limit_of(const ExhaustiveTask& task, const BestCodes& best);

}  // namespace tofsmith
