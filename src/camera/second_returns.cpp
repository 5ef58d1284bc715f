// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/camera.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

double SecondReturns::weighed(double single_return_error, double second_return_error) const {
  return std::pow(single_return_error, 1.0 - weight) * std::pow(second_return_error, weight);
}

void SecondReturns::validate(double range_m) const {
  const auto limits = [](const std::array<double, 2>& ends) {
    return fmt::format("[{}, {}]", ends[0], ends[1]);
  };
  require(ratio[0] >= 0.0 && ratio[1] >= ratio[0] && ratio[1] <= 1.0, "operating.multipath.ratio",
          limits(ratio), "must be [least, largest] with 0 <= least <= largest <= 1");
  require(delay_m[0] > 0.0 && delay_m[1] >= delay_m[0] && delay_m[1] < range_m,
          "operating.multipath.delay_m", limits(delay_m),
          fmt::format("must be [shortest, longest] with 0 < shortest <= longest and below the "
                      "unambiguous range, {:.4g} m",
                      range_m));
  require(weight > 0.0 && weight < 1.0, "operating.multipath.weight", weight, "must be in (0, 1)");
}

}  // namespace tofsmith
