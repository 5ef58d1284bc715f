// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "design/chips/chip_judge.hpp"
#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

/// Returns a key that is equal exactly for codes whose correlation functions are equal up to delay,
/// time reversal and order of taps and exposures.
std::string symmetry_key(const ChipCode& code);

struct ScoredCode {
  ChipCode code;
  double score = 0.0;
  double share = 0.0;
  std::string key;
};

/// The best codes, distinct up to symmetry.
class BestCodes {
 public:
  explicit BestCodes(int count) : count_(static_cast<std::size_t>(count)) {}

  /// Returns the worst kept score, or infinity if there is room.
  double limit() const;
  void offer(const ChipCode& code, double score, double share);
  void merge(const BestCodes& other);
  const std::vector<ScoredCode>& codes() const { return codes_; }
  const std::vector<ScoredCode>& improvements() const { return improvements_; }

 private:
  void offer(ScoredCode code);
  std::size_t count_;
  std::vector<ScoredCode> codes_;
  std::vector<ScoredCode> improvements_;
};

inline constexpr int max_assigned_taps = 4;

struct TapAssignment {
  std::array<ChipWord, max_assigned_taps> taps{};
  bool is_achiral = false;
};

struct AssignmentRules {
  int chips = 9;
  int taps = 3;
  bool equal_duty = true;
  bool drain = true;
  bool up_to_mirror = true;
};

/// Lists one assignment per equivalence class under delay, order of taps and, if up_to_mirror, time
/// reversal. No tap is empty. The order is deterministic.
std::vector<TapAssignment> tap_assignments(const AssignmentRules& rules);

/// Returns the number of assignments without symmetries.
double raw_tap_assignments(const AssignmentRules& rules);

/// Returns the smallest delay of every word (2^n).
std::vector<ChipWord> necklace_table(int chips);
/// Returns the non-constant modulations up to delay, in ascending order.
std::vector<ChipWord> modulation_necklaces(int chips);

struct ExhaustiveTask {
  const ChipJudge* judge = nullptr;
  AssignmentRules rules;
  int finalists = 1;
  double limit = 0.0;  ///< score of known safe codes
};

struct ExhaustiveFinding {
  BestCodes best;
  ChipSearchCounts counts;
};

/// Prunes three taps of equal duty by the turning test, others by a bound on the metric.
ExhaustiveFinding search_single_exposures(const ExhaustiveTask& task, const Progress& progress);

/// Prunes by a bound on the metric.
ExhaustiveFinding search_exposure_pairs(const ExhaustiveTask& task, const Progress& progress);

double exhaustive_size(const AssignmentRules& rules, int exposures);

using SearchShare =
    std::function<void(std::int64_t item, BestCodes& best, ChipSearchCounts& counts)>;

/// Processes items in growing rounds. A round starts with the best codes of the previous one, so
/// the result does not depend on the number of threads.
void search_in_rounds(std::int64_t items, std::int64_t items_at_once, ExhaustiveFinding& finding,
                      const SearchShare& share, const Progress& progress);

/// @param listing  progress message while listing
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

void look_at(const ChipCode& code, const std::vector<FisherMatrix>& nodes,
             const ExhaustiveTask& task, double share, BestCodes& best, ChipSearchCounts& counts);

void put_fisher(const FisherMatrix& matrix, float* first, int stride);

double limit_of(const ExhaustiveTask& task, const BestCodes& best);

}  // namespace tofsmith
