// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/report/figure.hpp"

namespace tofsmith::plotly {

struct Tick {
  double value = 1;
  std::string text = {};  ///< in Plotly's markup
};

/// Ticks of a logarithmic axis from range.low to range.high, both > 0: the decades when there are
/// many; 1, 2 and 5 of every decade when there are two or fewer; five places evenly apart when
/// there is less than one. Written out between 0.001 and 1000, else as powers of ten.
std::vector<Tick> logarithmic_ticks(const ValueRange& range);

}  // namespace tofsmith::plotly
