// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "report/plotly_json.hpp"

namespace tofsmith::plotly {

/// A colour scale fitted to values: what several traces of a figure share.
class ColourAxis {
 public:
  /// @throws std::invalid_argument if the scale contradicts itself (a logarithmic diverging map, an
  ///         empty range, a clip fraction outside [0, 0.5))
  ColourAxis(const ColourScale& scale, std::span<const float> values);

  const ValueRange& range() const { return range_; }
  /// What a trace must hold for a value: its logarithm on a logarithmic scale.
  double to_trace(double value) const;
  /// What values of traces may be rounded to: half of a colour's width.
  double resolution() const;
  /// Whether light text reads better than dark text on the colour of `value`.
  bool is_dark(double value) const;
  /// Layout entry "coloraxis".
  Json layout() const;
  /// Hover text of the value `variable` of a trace, with its unit.
  std::string hover(const std::string& variable) const;

 private:
  ColourScale scale_;
  ValueRange range_;
};

}  // namespace tofsmith::plotly
