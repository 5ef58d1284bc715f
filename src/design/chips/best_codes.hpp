// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

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
  bool offer(const ChipCode& code, double score, double share);
  void merge(const BestCodes& other);
  const std::vector<ScoredCode>& codes() const { return codes_; }
  const std::vector<ScoredCode>& improvements() const { return improvements_; }

 private:
  bool offer(ScoredCode code);
  std::size_t count_;
  std::vector<ScoredCode> codes_;
  std::vector<ScoredCode> improvements_;
};

}  // namespace tofsmith
