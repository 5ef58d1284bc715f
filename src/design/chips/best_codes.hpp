// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

/// A text that codes share exactly if delays, playing backwards and the order of taps and exposures
/// make their correlation functions equal.
std::string symmetry_key(const ChipCode& code);

/// A code and its metric.
struct ScoredCode {
  ChipCode code;
  double score = 0.0;
  double share = 0.0;  ///< of the search, when it was found
  std::string key;
};

/// The best codes seen, no two of them the same but for symmetry.
class BestCodes {
 public:
  explicit BestCodes(int count) : count_(static_cast<std::size_t>(count)) {}

  /// Codes must be below this to be kept: the worst of the best, infinite while there is room.
  double limit() const;
  /// @return whether the code is now the best
  bool offer(const ChipCode& code, double score, double share);
  /// Takes in what another has, in its order.
  void merge(const BestCodes& other);
  const std::vector<ScoredCode>& codes() const { return codes_; }
  /// Every code that was the best when it was offered or merged.
  const std::vector<ScoredCode>& improvements() const { return improvements_; }

 private:
  bool offer(ScoredCode code);
  std::size_t count_;
  std::vector<ScoredCode> codes_;  // best first
  std::vector<ScoredCode> improvements_;
};

}  // namespace tofsmith
