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

/// Most taps that assignments are enumerated for.
inline constexpr int max_assigned_taps = 4;

/// What each chip of a period is given to: one of the taps, or none.
struct TapAssignment {
  std::array<ChipWord, max_assigned_taps> taps{};
  bool is_achiral = false;  ///< played backwards it is itself, but for a delay and the taps' order
};

/// Which assignments are listed.
struct AssignmentRules {
  int chips = 9;
  int taps = 3;
  bool equal_duty = true;    ///< every tap is open for as many chips
  bool drain = true;         ///< chips may be given to no tap
  bool up_to_mirror = true;  ///< of two that are each other played backwards, one
};

/// One assignment of every kind that delays, the order of taps (and playing backwards) make of each
/// other; no tap is always shut. In an order that depends on the rules alone.
std::vector<TapAssignment> tap_assignments(const AssignmentRules& rules);

/// How many there are before symmetry is used.
double raw_tap_assignments(const AssignmentRules& rules);

/// The least of all delays of every word (2^n).
std::vector<ChipWord> necklace_table(int chips);
/// Modulations up to delays: on at least once and off at least once, in ascending order.
std::vector<ChipWord> modulation_necklaces(int chips);

/// What a search is to look at, and what it starts from.
struct ExhaustiveTask {
  const ChipJudge* judge = nullptr;
  AssignmentRules rules;
  int finalists = 1;
  double limit = 0.0;  ///< score of codes known to be safe: no need to look beyond
};

/// What an exhaustive search found: the best codes there are, and what became of the others.
struct ExhaustiveFinding {
  BestCodes best;
  ChipSearchCounts counts;
};

/// All codes of one exposure: three taps by exact turning of their directions where duties are
/// equal, else by a bound on the metric.
ExhaustiveFinding search_single_exposures(const ExhaustiveTask& task, const Progress& progress);

/// All pairs of exposures, by a bound on the metric.
ExhaustiveFinding search_exposure_pairs(const ExhaustiveTask& task, const Progress& progress);

/// Codes that an exhaustive search would have to look at, after symmetry, about.
double exhaustive_size(const AssignmentRules& rules, int exposures);

/// One share of a search: adds to counts and best codes that no other share writes to.
using SearchShare =
    std::function<void(std::int64_t item, BestCodes& best, ChipSearchCounts& counts)>;

/// Works through items in rounds. Within a round every item starts from what was best before it, so
/// that results and counts do not depend on threads; rounds grow as the best settles.
void search_in_rounds(std::int64_t items, std::int64_t items_at_once, ExhaustiveFinding& finding,
                      const SearchShare& share, const Progress& progress);

/// A whole search: `Search` lists what there is (items, counted by sizes) and searches an item.
/// @param listing  what listing takes its time for, for the progress
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

/// Looks at one code, given the Fisher matrices of its other exposures, and keeps it if it is good.
void look_at(const ChipCode& code, const std::vector<FisherMatrix>& nodes,
             const ExhaustiveTask& task, double share, BestCodes& best, ChipSearchCounts& counts);

/// Writes the entries of a Fisher matrix as find_informed reads them, `stride` floats apart.
void put_fisher(const FisherMatrix& matrix, float* first, int stride);

/// The score that is still looked at.
double limit_of(const ExhaustiveTask& task, const BestCodes& best);

}  // namespace tofsmith
