// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "report/plotly_json.hpp"

namespace tofsmith::plotly {

inline constexpr double panel_title_px = 26;
inline constexpr double colour_bar_px = 88;

/// Panels of one size in rows of `columns`, the first at the top left; every row has room for
/// panel titles above it.
class PanelLayout {
 public:
  /// @param gap  share of the width of the plot that stays free between columns
  PanelLayout(int panels, int max_columns, double gap);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  int row(int panel) const { return panel / columns_; }
  int column(int panel) const { return panel % columns_; }
  /// Width of a panel as a share of the width of the plot.
  double panel_width() const;
  /// Places the axes x and y of a panel and the heading above it.
  /// @param row_gap  share of the height of the plot that stays free between rows
  void place(Json& layout, int panel, double row_gap, const std::string& title, Json x,
             Json y) const;

 private:
  int columns_;
  int rows_;
  double gap_;
};

}  // namespace tofsmith::plotly
