// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chips/exhaustive_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/shared/shared_progress.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

std::string exposure_key(const ChipCode& code, int exposure, int shift, bool is_mirror) {
  std::vector<std::string> rows;
  for (int i = 0; i < code.taps; ++i) {
    std::string row;
    for (int s = 0; s < code.chips; ++s)
      row += static_cast<char>(
          'a' + code.correlation(exposure * code.taps + i, is_mirror ? shift - s : shift + s));
    rows.push_back(std::move(row));
  }
  std::sort(rows.begin(), rows.end());
  std::string key;
  for (const std::string& row : rows) key += row;
  return key;
}

}  // namespace

std::string symmetry_key(const ChipCode& code) {
  std::string least;
  for (const bool is_mirror : {false, true})
    for (int shift = 0; shift < code.chips; ++shift) {
      std::vector<std::string> parts;
      for (int e = 0; e < code.exposures(); ++e)
        parts.push_back(exposure_key(code, e, shift, is_mirror));
      std::sort(parts.begin(), parts.end());
      std::string key;
      for (const std::string& part : parts) key += part;
      if (least.empty() || key < least) least = std::move(key);
    }
  return least;
}

double BestCodes::limit() const {
  return codes_.size() < count_ ? std::numeric_limits<double>::infinity() : codes_.back().score;
}

void BestCodes::offer(const ChipCode& code, double score, double share) {
  offer(ScoredCode{code, score, share, symmetry_key(code)});
}

void BestCodes::offer(ScoredCode code) {
  const auto same = std::find_if(codes_.begin(), codes_.end(),
                                 [&](const auto& item) { return item.key == code.key; });
  if (same != codes_.end()) return;
  const auto place =
      std::upper_bound(codes_.begin(), codes_.end(), code.score,
                       [](const auto& value, const auto& item) { return value < item.score; });
  if (place == codes_.end() && codes_.size() == count_) return;
  if (place == codes_.begin()) improvements_.push_back(code);
  codes_.insert(place, std::move(code));
  if (codes_.size() > count_) codes_.pop_back();
}

void BestCodes::merge(const BestCodes& other) {
  for (const ScoredCode& code : other.codes_) offer(code);
}

namespace {

struct Motion {
  int shift;
  bool is_mirror;
  ChipWord of(ChipWord word, int chips) const {
    return delayed_chips(is_mirror ? reversed_chips(word, chips) : word, shift, chips);
  }
};

/// Lists the assignments whose first tap is a given word and has the smallest class of all taps.
/// Every equivalence class has such a member.
class FirstTapLister {
 public:
  FirstTapLister(const AssignmentRules& rules, const std::vector<ChipWord>& kind, ChipWord first)
      : rules_(rules), kind_(kind) {
    for (int mirror = 0; mirror <= (rules.up_to_mirror ? 1 : 0); ++mirror)
      for (int shift = 0; shift < rules.chips; ++shift) motions_.push_back({shift, mirror != 0});
    for (const Motion& motion : motions_)
      if (motion.of(first, rules.chips) == first) keeping_first_.push_back(motion);
    current_.taps[0] = first;
    choose(1, all_chips(rules.chips) & ~first, 0);
  }
  std::vector<TapAssignment> take() { return std::move(found_); }

 private:
  void choose(int tap, ChipWord free, ChipWord previous) {
    if (tap == rules_.taps) {
      if (!rules_.drain && free != 0) return;
      if (is_least()) found_.push_back(current_);
      return;
    }
    const ChipWord first = current_.taps[0];
    const int duty = std::popcount(first);
    for (ChipWord word = free; word > previous; word = (word - 1) & free) {
      if (rules_.equal_duty && std::popcount(word) != duty) continue;
      if (kind_[word] < first) continue;
      current_.taps.at(static_cast<std::size_t>(tap)) = word;  // [] makes GCC 14 warn
      choose(tap + 1, free & ~word, word);
    }
  }

  /// Returns true if no motion with a tap in first position makes the others smaller.
  bool is_least() {
    current_.is_achiral = false;
    const ChipWord first = current_.taps[0];
    for (const Motion& motion : keeping_first_)
      if (!stays_least(motion, 0)) return false;
    for (int tap = 1; tap < rules_.taps; ++tap) {
      const ChipWord word = current_.taps[static_cast<std::size_t>(tap)];
      if (kind_[word] != first) continue;
      for (const Motion& motion : motions_)
        if (motion.of(word, rules_.chips) == first && !stays_least(motion, tap)) return false;
    }
    return true;
  }

  bool stays_least(const Motion& motion, int leading) {
    std::array<ChipWord, max_assigned_taps> moved;
    moved.fill(~ChipWord{0});
    std::size_t count = 0;
    for (int tap = 0; tap < rules_.taps; ++tap)
      if (tap != leading)
        moved[count++] = motion.of(current_.taps[static_cast<std::size_t>(tap)], rules_.chips);
    std::sort(moved.begin(), moved.end());
    const auto own = current_.taps.begin() + 1;
    const auto end = moved.begin() + count;
    const auto [moved_at, own_at] = std::mismatch(moved.begin(), end, own);
    if (moved_at == end && motion.is_mirror) current_.is_achiral = true;
    return moved_at == end || *moved_at > *own_at;
  }

  const AssignmentRules& rules_;
  const std::vector<ChipWord>& kind_;
  std::vector<Motion> motions_, keeping_first_;
  TapAssignment current_;
  std::vector<TapAssignment> found_;
};

double binomial(int n, int k) {
  return std::round(
      std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0)));
}

double raw_with_unequal_duties(int chips, int taps, bool drain) {
  // Surjections onto the taps, by inclusion-exclusion.
  double count = 0.0;
  for (int shut = 0; shut <= taps; ++shut)
    count += (shut % 2 == 0 ? 1.0 : -1.0) * binomial(taps, shut) *
             std::pow(taps - shut + (drain ? 1 : 0), chips);
  return count;
}

constexpr double rounding = 1.0 + 1e-9;

}  // namespace

std::vector<ChipWord> necklace_table(int chips) {
  std::vector<ChipWord> least(std::size_t{1} << chips, ~ChipWord{0});
  for (ChipWord word = 0; word < least.size(); ++word) {
    if (least[word] != ~ChipWord{0}) continue;  // a delay of an earlier word
    for (int shift = 0; shift < chips; ++shift) least[delayed_chips(word, shift, chips)] = word;
  }
  return least;
}

std::vector<ChipWord> modulation_necklaces(int chips) {
  const std::vector<ChipWord> least = necklace_table(chips);
  std::vector<ChipWord> words;
  for (ChipWord word = 1; word < all_chips(chips); ++word)
    if (least[word] == word) words.push_back(word);
  return words;
}

std::vector<TapAssignment> tap_assignments(const AssignmentRules& rules) {
  std::vector<ChipWord> kind = necklace_table(rules.chips);
  if (rules.up_to_mirror) {
    const std::vector<ChipWord> necklace = kind;
    for (ChipWord word = 0; word < kind.size(); ++word)
      kind[word] = std::min(necklace[word], necklace[reversed_chips(word, rules.chips)]);
  }
  std::vector<ChipWord> firsts;
  for (ChipWord word = 1; word < kind.size(); ++word)
    if (kind[word] == word &&
        (!rules.equal_duty || std::popcount(word) * rules.taps <= rules.chips))
      firsts.push_back(word);
  std::vector<std::vector<TapAssignment>> parts(firsts.size());
  parallel_for_indices(firsts.size(), [&](std::size_t at) {
    parts[at] = FirstTapLister(rules, kind, firsts[at]).take();
  });
  std::vector<TapAssignment> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

double raw_tap_assignments(const AssignmentRules& rules) {
  if (!rules.equal_duty) return raw_with_unequal_duties(rules.chips, rules.taps, rules.drain);
  double count = 0.0;
  for (int duty = 1; duty * rules.taps <= rules.chips; ++duty) {
    if (!rules.drain && duty * rules.taps != rules.chips) continue;
    double ways = 1.0;
    for (int tap = 0; tap < rules.taps; ++tap) ways *= binomial(rules.chips - tap * duty, duty);
    count += ways;
  }
  return count;
}

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
  // Symmetries: delays of modulation and taps, and mirror images, of the first exposure; delays of
  // the taps of others; the order of exposures.
  const double first = modulations * assignments / (2 * n * n);
  return exposures == 1
             ? first
             : first * std::pow(modulations * assignments / n, exposures - 1) / exposures;
}

}  // namespace tofsmith
