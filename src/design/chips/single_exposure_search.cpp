// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include "design/chips/chip_scan.hpp"
#include "design/chips/exhaustive_search.hpp"

namespace tofsmith {

namespace {

constexpr std::size_t assignments_at_once = 4096;

/// Table rows of the scan: every necklace used by a tap over two periods, so that every delay has
/// consecutive rows.
class ScanRows {
 public:
  ScanRows(const std::vector<TapAssignment>& assignments, const AssignmentRules& rules)
      : chips_(rules.chips), row_(std::size_t{1} << rules.chips, 0) {
    const std::vector<ChipWord> necklace = necklace_table(chips_);
    std::vector<char> is_used(necklace.size(), 0);
    for (const TapAssignment& assignment : assignments)
      for (int tap = 0; tap < rules.taps; ++tap)
        is_used[necklace[assignment.taps[static_cast<std::size_t>(tap)]]] = 1;
    for (ChipWord word = 1; word < necklace.size(); ++word) {
      if (is_used[word] == 0) continue;
      for (int delay = chips_ - 1; delay >= 0; --delay)
        row_[delayed_chips(word, delay, chips_)] =
            static_cast<std::uint32_t>(necklaces_.size()) * rows_of_word() +
            static_cast<std::uint32_t>((chips_ - delay) % chips_);
      necklaces_.push_back(word);
    }
    for (const TapAssignment& assignment : assignments) {
      ScanAssignment scan{};
      for (std::size_t tap = 0; tap < static_cast<std::size_t>(rules.taps); ++tap)
        scan.row[tap] = row_[assignment.taps[tap]];
      scans_.push_back(scan);
    }
  }

  std::span<const ScanAssignment> scans() const { return scans_; }

  /// Calls `set(value, necklace, light, s)` for a block of modulations; entries at `value` have a
  /// stride of scan_lanes.
  template <typename Number, typename Set>
  void fill(std::span<const ChipWord> lights, int entries, std::vector<Number>& table,
            const Set& set) const {
    const std::size_t row_size = static_cast<std::size_t>(entries) * scan_lanes;
    table.assign(necklaces_.size() * rows_of_word() * row_size, Number{});
    Number* row = table.data();
    for (const ChipWord word : necklaces_)
      for (int s = 0; s < 2 * chips_; ++s, row += row_size)
        for (std::size_t lane = 0; lane < lights.size(); ++lane)
          set(row + lane, word, lights[lane], s);
  }

 private:
  std::uint32_t rows_of_word() const { return static_cast<std::uint32_t>(2 * chips_); }
  int chips_;
  std::vector<std::uint32_t> row_;
  std::vector<ChipWord> necklaces_;
  std::vector<ScanAssignment> scans_;
};

std::vector<TapAssignment> by_duty(std::vector<TapAssignment> assignments) {
  std::stable_sort(assignments.begin(), assignments.end(),
                   [](const TapAssignment& a, const TapAssignment& b) {
                     return std::popcount(a.taps[0]) < std::popcount(b.taps[0]);
                   });
  return assignments;
}

class SingleExposureSearch {
 public:
  explicit SingleExposureSearch(const ExhaustiveTask& task)
      : task_(task),
        n_(task.rules.chips),
        assignments_(by_duty(tap_assignments(task.rules))),
        rows_(assignments_, task.rules),
        turns_(task.rules.taps == 3 && task.rules.equal_duty),
        no_nodes_(task.judge->lights().size() * static_cast<std::size_t>(n_ * nodes_per_chip)) {
    for (const ChipWord word : modulation_necklaces(n_))
      if (!turns_ || 2 * std::popcount(word) <= n_) lights_.push_back(word);
  }

  std::int64_t items() const { return (std::ssize(lights_) + scan_lanes - 1) / scan_lanes; }

  ChipSearchCounts sizes() const {
    ChipSearchCounts counts;
    const std::vector<ChipWord> necklace = necklace_table(n_), all = modulation_necklaces(n_);
    double mirrored = 0.0;
    for (const ChipWord word : all)
      mirrored += word <= necklace[reversed_chips(word, n_)] ? 1.0 : 0.0;
    for (const TapAssignment& assignment : assignments_)
      counts.after_symmetry += assignment.is_achiral ? mirrored : static_cast<double>(all.size());
    counts.raw = raw_tap_assignments(task_.rules) * (std::exp2(n_) - 2);
    return counts;
  }

  void search_item(std::int64_t block, BestCodes& best, ChipSearchCounts& counts) const {
    const auto begin = static_cast<std::size_t>(block * scan_lanes);
    const std::span<const ChipWord> lights = std::span(lights_).subspan(
        begin, std::min<std::size_t>(scan_lanes, lights_.size() - begin));
    const double share = static_cast<double>(block) / static_cast<double>(items());
    turns_ ? search_turning(lights, share, best, counts)
           : search_informed(lights, share, best, counts);
  }

 private:
  ChipCode code_of(ChipWord light, std::size_t assignment) const {
    const auto& taps = assignments_[assignment].taps;
    return {n_, task_.rules.taps, {light}, {taps.begin(), taps.begin() + task_.rules.taps}};
  }

  template <typename Scan, typename Look>
  void for_found(std::span<const ChipWord> lights, const Scan& scan, const Look& look) const {
    std::array<std::uint32_t, assignments_at_once> found{};
    const std::uint32_t in_use = lights.size() == scan_lanes ? ~0U : (1U << lights.size()) - 1U;
    const auto scans = rows_.scans();
    for (std::size_t first = 0; first < scans.size(); first += assignments_at_once) {
      const auto part = scans.subspan(first, std::min(assignments_at_once, scans.size() - first));
      scan(part, found.data());
      for (std::size_t j = 0; j < part.size(); ++j)
        for (std::uint32_t bits = found[j] & in_use; bits != 0; bits &= bits - 1)
          look(lights[static_cast<std::size_t>(std::countr_zero(bits))], first + j);
    }
  }

  /// A complement rotates all directions by half a turn, so only modulations with at most half duty
  /// are scanned.
  void search_turning(std::span<const ChipWord> lights, double share, BestCodes& best,
                      ChipSearchCounts& counts) const {
    std::vector<std::int16_t> table;
    rows_.fill(lights, 1, table, [&](std::int16_t* count, ChipWord word, ChipWord light, int s) {
      *count = static_cast<std::int16_t>(std::popcount(word & delayed_chips(light, s, n_)));
    });
    std::int64_t codes_of_lights = 0, turning = 0;
    for (const ChipWord light : lights) codes_of_lights += has_complement(light) ? 2 : 1;
    for_found(
        lights,
        [&](std::span<const ScanAssignment> part, std::uint32_t* found) {
          find_turning(table.data(), part, n_, found);
        },
        [&](ChipWord light, std::size_t assignment) {
          turning += has_complement(light) ? 2 : 1;
          look_at(code_of(light, assignment), no_nodes_, task_, share, best, counts);
          if (has_complement(light))
            look_at(code_of(all_chips(n_) & ~light, assignment), no_nodes_, task_, share, best,
                    counts);
        });
    const std::int64_t examined = codes_of_lights * std::ssize(assignments_);
    counts.examined += examined;
    counts.pruned_by_turning += examined - turning;
  }
  bool has_complement(ChipWord light) const { return 2 * std::popcount(light) < n_; }

  void search_informed(std::span<const ChipWord> lights, double share, BestCodes& best,
                       ChipSearchCounts& counts) const {
    std::vector<std::vector<float>> tables;
    InformationRows rows{.metric = task_.judge->metric()};
    for (const ChipLight& light : task_.judge->lights())
      rows_.fill(lights, fisher_entries, tables.emplace_back(),
                 [&](float* first, ChipWord word, ChipWord on, int s) {
                   put_fisher(largest_tap_fisher(std::popcount(word & delayed_chips(on, s, n_)),
                                                 std::popcount(word & delayed_chips(on, s + 1, n_)),
                                                 std::popcount(word),
                                                 light.electrons_of(std::popcount(on)), light),
                              first, scan_lanes);
                 });
    for (const auto& table : tables) rows.point.push_back(table.data());
    std::int64_t informed = 0;
    for_found(
        lights,
        [&](std::span<const ScanAssignment> part, std::uint32_t* found) {
          rows.limit = limit_of(task_, best);
          find_informed(rows, part, n_, task_.rules.taps, found);
        },
        [&](ChipWord light, std::size_t assignment) {
          ++informed;
          look_at(code_of(light, assignment), no_nodes_, task_, share, best, counts);
        });
    const std::int64_t examined = std::ssize(lights) * std::ssize(assignments_);
    counts.examined += examined;
    counts.pruned_by_bound += examined - informed;
  }

  const ExhaustiveTask& task_;
  int n_;
  std::vector<TapAssignment> assignments_;
  ScanRows rows_;
  bool turns_;
  std::vector<FisherMatrix> no_nodes_;
  std::vector<ChipWord> lights_;
};

}  // namespace

ExhaustiveFinding search_single_exposures(const ExhaustiveTask& task, const Progress& progress) {
  return search_all<SingleExposureSearch>(task, "tap assignments listed", 16, progress);
}

}  // namespace tofsmith
