// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/multipath_options.hpp"

#include <cmath>
#include <string>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

void MultipathOptions::validate(double range_m) const {
  const std::string of_range = " the range, " + std::to_string(range_m) + " m";
  require(std::isfinite(threshold) && threshold >= 0.0, "MultipathOptions::threshold", threshold,
          "must be finite and >= 0");
  require(shortest_delay_m > 0.0 && shortest_delay_m < range_m,
          "MultipathOptions::shortest_delay_m", shortest_delay_m,
          "must be > 0 and below" + of_range);
  const double longest_m = longest_delay_m.value_or(range_m / 3);
  require(longest_m > shortest_delay_m && longest_m < range_m, "MultipathOptions::longest_delay_m",
          longest_m, "must be above shortest_delay_m and below" + of_range);
  require(tail_m > 0.0 && tail_m <= range_m, "MultipathOptions::tail_m", tail_m,
          "must be > 0 and at most" + of_range);
  doubt.validate();
  if (!prior) return;
  require(prior->single_probability >= 0.0 && prior->single_probability < 1.0,
          "ReturnPrior::single_probability", prior->single_probability, "must be in [0, 1)");
  require(std::isfinite(prior->mean_delay_m) && prior->mean_delay_m > 0.0,
          "ReturnPrior::mean_delay_m", prior->mean_delay_m, "must be finite and > 0");
  require(prior->largest_ratio > 0.0 && prior->largest_ratio <= 1.0, "ReturnPrior::largest_ratio",
          prior->largest_ratio, "must be in (0, 1]");
}

}  // namespace tofsmith
