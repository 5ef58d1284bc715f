// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

namespace tofsmith {

/// How long work still takes, judged by how far it had come when. Steps of a work differ in speed,
/// so the last half of the time so far counts; and nothing is said while that half and the whole
/// disagree, or while there is too little to go by.
class RemainingTime {
 public:
  /// @param passed_s  seconds since the work began, no less than before
  /// @param fraction  share of the work that is done
  void add(double passed_s, double fraction);

  /// Seconds that are left; nothing while that would be a guess.
  std::optional<double> seconds() const;

 private:
  struct Moment {
    double passed_s, fraction;
  };
  double fraction_at(double passed_s) const;

  Moment now_{0.0, 0.0};
  std::vector<Moment> past_{now_};  // thinned out: each is later than the one before by its share
};

}  // namespace tofsmith
