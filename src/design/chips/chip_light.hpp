// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

/// Electrons per chip at one operating point. A tap that is open for d chips and receives light of
/// level L during c chips has
///   mean      signal_e L c + ambient_e d
///   variance  mean + constant_e2.
struct ChipLight {
  double signal_e = 0.0;
  double ambient_e = 0.0;
  double constant_e2 = 0.0;
  double peak_factor = 1.0;
  int chips = 0;
  double chip_m = 0.0;
  bool is_known = false;

  ChipLight(const Camera& camera, const OperatingPoint& point, int chips, int exposures,
            ChipMetric metric = ChipMetric::unknown_light);

  double electrons_of(int on_chips) const {
    return signal_e * chip_level(on_chips, chips, peak_factor);
  }
};

std::optional<BrokenRule> why_not_plain(const Camera& camera);

void require_plain(const Camera& camera);

}  // namespace tofsmith
