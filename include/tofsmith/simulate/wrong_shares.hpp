// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tofsmith/core/fields.hpp"

namespace tofsmith {

/// Shares of trials with wrong depths. A depth is wrong if it deviates from all true depths by more
/// than three times its `deviation_m`.
struct WrongShares {
  double wrong = 0.0;
  double wrong_ok = 0.0;
  double wrong_inconsistent = 0.0;
  double inconsistent = 0.0;

  /// Share of the wrong depths that are inconsistent; none without wrong depths.
  std::optional<double> detected() const;
};
auto fields_of(ConstOrNot<WrongShares> auto& s) {
  return std::tuple(
      Field("wrong", s.wrong, closed(0, 1), Help{"share of wrong depths"}),
      Field("wrong_ok", s.wrong_ok, closed(0, 1), Help{"wrong, but with status ok"}),
      Field("wrong_inconsistent", s.wrong_inconsistent, closed(0, 1),
            Help{"wrong, with status inconsistent"}),
      Field("inconsistent", s.inconsistent, closed(0, 1), Help{"with status inconsistent"}));
}

}  // namespace tofsmith
