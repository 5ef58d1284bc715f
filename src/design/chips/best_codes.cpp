// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chips/best_codes.hpp"

#include <algorithm>
#include <limits>

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

bool BestCodes::offer(const ChipCode& code, double score, double share) {
  return offer(ScoredCode{code, score, share, symmetry_key(code)});
}

bool BestCodes::offer(ScoredCode code) {
  const auto same = std::find_if(codes_.begin(), codes_.end(),
                                 [&](const auto& item) { return item.key == code.key; });
  if (same != codes_.end()) return false;
  const auto place =
      std::upper_bound(codes_.begin(), codes_.end(), code.score,
                       [](const auto& value, const auto& item) { return value < item.score; });
  if (place == codes_.end() && codes_.size() == count_) return false;
  const bool is_best = place == codes_.begin();
  if (is_best) improvements_.push_back(code);
  codes_.insert(place, std::move(code));
  if (codes_.size() > count_) codes_.pop_back();
  return is_best;
}

void BestCodes::merge(const BestCodes& other) {
  for (const ScoredCode& code : other.codes_) offer(code);
}

}  // namespace tofsmith
