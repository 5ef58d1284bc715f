// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

/// What is believed of later returns before a pixel is seen; depth itself may be anything. The
/// answer leans on it where light is scarce.
struct ReturnPrior {
  double single_probability = 0.5;  ///< that there is no later return, in [0, 1)
  double mean_delay_m = 0.5;        ///< delays are exponential with this mean [m], > 0
  double largest_ratio = 0.5;       ///< ratios are uniform from 0 to this, in (0, 1]
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<ReturnPrior> auto& p) {
  return std::tuple(Field("single_probability", p.single_probability, "in [0, 1)"),
                    Field("mean_delay_m", p.mean_delay_m, "finite and > 0"),
                    Field("largest_ratio", p.largest_ratio, "in (0, 1]"));
}

/// How returns beside the direct one are looked for.
struct MultipathOptions {
  /// A second return is accepted if it lowers chi^2 by more than this, >= 0. Single returns exceed
  /// 9 in about one pixel of a hundred.
  double threshold = 9.0;
  double shortest_delay_m = 0.1;  ///< of a second return behind the direct one [m], > 0
  /// Of a second return [m], above the shortest and below the range; none: a third of the range.
  std::optional<double> longest_delay_m;
  /// Mean delay of the exponential tail that TailDecoder fits [m], > 0 and at most the range.
  double tail_m = 0.5;
  /// If set, depth is the posterior median under this prior where one return does not explain the
  /// pixel, instead of the most likely one.
  std::optional<ReturnPrior> prior;
  DecodeOptions doubt;  ///< of the single return

  /// @throws std::invalid_argument naming field, value and rule
  void validate(double range_m) const;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<MultipathOptions> auto& o) {
  return std::tuple(Field("threshold", o.threshold, "finite and >= 0"),
                    Field("shortest_delay_m", o.shortest_delay_m, "> 0"),
                    Field("longest_delay_m", o.longest_delay_m), Field("tail_m", o.tail_m, "> 0"),
                    Field("prior", o.prior), Field("doubt", o.doubt));
}

}  // namespace tofsmith
