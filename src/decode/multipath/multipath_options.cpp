// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/decode/multipath_decoder.hpp"

#include <cmath>
#include <string>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

void MultipathOptions::validate(double range_m) const {
  const std::string of_range = " the range, " + std::to_string(range_m) + " m";
  check_fields(*this, "MultipathOptions::");
  require(shortest_delay_m < range_m, "MultipathOptions::shortest_delay_m", shortest_delay_m,
          "must be > 0 and below" + of_range);
  const double longest_m = longest_delay_m.value_or(range_m / 3);
  require(longest_m > shortest_delay_m && longest_m < range_m, "MultipathOptions::longest_delay_m",
          longest_m, "must be above shortest_delay_m and below" + of_range);
  require(tail_m <= range_m, "MultipathOptions::tail_m", tail_m,
          "must be > 0 and at most" + of_range);
  doubt.validate();
  if (prior) check_fields(*prior, "ReturnPrior::");
}

}  // namespace tofsmith
