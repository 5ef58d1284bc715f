// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <unordered_map>

#include "design/chips/chip_scan.hpp"
#include "design/chips/exhaustive_search.hpp"

namespace tofsmith {

namespace {

constexpr std::int64_t firsts_at_once = 4;

struct Exposure {
  ChipWord light = 0;
  std::array<ChipWord, max_assigned_taps> taps{};
  std::int32_t orbit = 0;  ///< class up to delay and mirror image
  bool is_first = false;
};

/// Key of equivalent exposures: the sorted correlation functions after a delay or mirror image.
std::string functions_of(const Exposure& exposure, const AssignmentRules& rules, int shift,
                         bool is_mirror) {
  std::array<std::string, max_assigned_taps> rows;
  for (std::size_t tap = 0; tap < static_cast<std::size_t>(rules.taps); ++tap) {
    rows[tap] += static_cast<char>(std::popcount(exposure.taps[tap]));
    for (int s = 0; s < rules.chips; ++s)
      rows[tap] += static_cast<char>(std::popcount(
          exposure.taps[tap] &
          delayed_chips(exposure.light, is_mirror ? shift - s : shift + s, rules.chips)));
  }
  std::sort(rows.begin(), rows.end());
  std::string all;
  for (const std::string& row : rows) all += row;
  return all;
}

/// A common delay of taps and modulation has no effect.
std::vector<Exposure> distinct_exposures(const AssignmentRules& rules) {
  AssignmentRules all = rules;
  all.up_to_mirror = false;
  std::unordered_map<std::string, std::size_t> seen;
  std::vector<Exposure> exposures;
  for (const TapAssignment& assignment : tap_assignments(all))
    for (ChipWord light = 1; light < all_chips(rules.chips); ++light) {
      const Exposure exposure{.light = light, .taps = assignment.taps};
      if (seen.emplace(functions_of(exposure, rules, 0, false), exposures.size()).second)
        exposures.push_back(exposure);
    }
  std::int32_t orbits = 0;
  std::vector<char> has_orbit(exposures.size(), 0);
  for (std::size_t i = 0; i < exposures.size(); ++i) {
    if (has_orbit[i] != 0) continue;
    exposures[i].is_first = true;
    for (const bool is_mirror : {false, true})
      for (int shift = 0; shift < rules.chips; ++shift) {
        const std::size_t member = seen.at(functions_of(exposures[i], rules, shift, is_mirror));
        exposures[member].orbit = orbits;
        has_orbit[member] = 1;
      }
    ++orbits;
  }
  return exposures;
}

/// Search over pairs of a representative of an orbit and a member of the same or a later orbit.
class ExposurePairSearch {
 public:
  explicit ExposurePairSearch(const ExhaustiveTask& task)
      : task_(task), n_(task.rules.chips), exposures_(distinct_exposures(task.rules)) {
    std::stable_sort(exposures_.begin(), exposures_.end(),
                     [](const auto& a, const auto& b) { return a.orbit < b.orbit; });
    for (std::size_t i = 0; i < exposures_.size(); ++i)
      if (exposures_[i].is_first) firsts_.push_back(i);
    const std::size_t blocks = (exposures_.size() + scan_lanes - 1) / scan_lanes;
    const auto depths = static_cast<std::size_t>(n_);
    for (const ChipLight& light : task.judge->lights()) {
      std::vector<float>& rows =
          information_.emplace_back(blocks * depths * fisher_entries * scan_lanes, 0.0F);
      for (std::size_t i = 0; i < exposures_.size(); ++i)
        for (std::size_t s = 0; s < depths; ++s)
          put_fisher(
              information(exposures_[i], static_cast<int>(s), light),
              &rows[(i / scan_lanes * depths + s) * fisher_entries * scan_lanes + i % scan_lanes],
              scan_lanes);
    }
  }

  std::int64_t items() const { return (std::ssize(firsts_) + firsts_at_once - 1) / firsts_at_once; }

  ChipSearchCounts sizes() const {
    ChipSearchCounts counts;
    counts.raw = std::pow(raw_tap_assignments(task_.rules) * (std::exp2(n_) - 2), 2);
    for (const std::size_t first : firsts_)
      counts.after_symmetry += static_cast<double>(exposures_.size() - first);
    return counts;
  }

  void search_item(std::int64_t item, BestCodes& best, ChipSearchCounts& counts) const {
    const auto begin = static_cast<std::size_t>(item * firsts_at_once);
    const std::size_t end = std::min<std::size_t>(begin + firsts_at_once, firsts_.size());
    const double share = static_cast<double>(item) / static_cast<double>(items());
    for (std::size_t f = begin; f < end; ++f) search_with(firsts_[f], share, best, counts);
  }

 private:
  FisherMatrix information(const Exposure& exposure, int s, const ChipLight& light) const {
    FisherMatrix sum;
    const double electrons = light.electrons_of(std::popcount(exposure.light));
    const ChipWord here = delayed_chips(exposure.light, s, n_);
    const ChipWord next = delayed_chips(exposure.light, s + 1, n_);
    for (std::size_t tap = 0; tap < static_cast<std::size_t>(task_.rules.taps); ++tap)
      sum += largest_tap_fisher(std::popcount(exposure.taps[tap] & here),
                                std::popcount(exposure.taps[tap] & next),
                                std::popcount(exposure.taps[tap]), electrons, light);
    return sum;
  }

  ChipCode code_of(const Exposure& first, const Exposure& second) const {
    ChipCode code{n_, task_.rules.taps, {first.light, second.light}, {}};
    for (const Exposure* exposure : {&first, &second})
      code.demodulation.insert(code.demodulation.end(), exposure->taps.begin(),
                               exposure->taps.begin() + task_.rules.taps);
    return code;
  }

  void search_with(std::size_t first, double share, BestCodes& best,
                   ChipSearchCounts& counts) const {
    const Exposure& own = exposures_[first];
    std::vector<float> information_of_first(task_.judge->lights().size() *
                                            static_cast<std::size_t>(n_) * fisher_entries);
    float* matrix = information_of_first.data();
    for (const ChipLight& light : task_.judge->lights())
      for (int s = 0; s < n_; ++s, matrix += fisher_entries)
        put_fisher(information(own, s, light), matrix, 1);
    const auto nodes = task_.judge->nodes_of(code_of(own, own), 1);

    constexpr std::size_t blocks_at_once = 64;
    std::array<std::uint32_t, blocks_at_once> found{};
    std::int64_t looked_at = 0;
    const std::size_t all_blocks = (exposures_.size() + scan_lanes - 1) / scan_lanes;
    for (std::size_t block = first / scan_lanes; block < all_blocks; block += blocks_at_once) {
      const std::size_t count = std::min(blocks_at_once, all_blocks - block);
      const InformationRows others = rows_from(block, limit_of(task_, best));
      find_informed_pairs(others, information_of_first, n_, count, found.data());
      for (std::size_t b = 0; b < count; ++b)
        for (std::uint32_t bits = found[b]; bits != 0; bits &= bits - 1) {
          const std::size_t second =
              (block + b) * scan_lanes + static_cast<std::size_t>(std::countr_zero(bits));
          if (second < first || second >= exposures_.size()) continue;
          ++looked_at;
          look_at(code_of(own, exposures_[second]), nodes, task_, share, best, counts);
        }
    }
    const auto pairs = static_cast<std::int64_t>(exposures_.size() - first);
    counts.examined += pairs;
    counts.pruned_by_bound += pairs - looked_at;
  }

  InformationRows rows_from(std::size_t block, double limit) const {
    InformationRows rows{.point = {}, .limit = limit, .metric = task_.judge->metric()};
    for (const auto& information : information_)
      rows.point.push_back(information.data() +
                           block * static_cast<std::size_t>(n_) * fisher_entries * scan_lanes);
    return rows;
  }

  const ExhaustiveTask& task_;
  int n_;
  std::vector<Exposure> exposures_;
  std::vector<std::size_t> firsts_;
  std::vector<std::vector<float>> information_;
};

}  // namespace

ExhaustiveFinding search_exposure_pairs(const ExhaustiveTask& task, const Progress& progress) {
  return search_all<ExposurePairSearch>(task, "exposures listed", 64, progress);
}

}  // namespace tofsmith
