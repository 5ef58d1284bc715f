// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/panel_layout.hpp"

#include <algorithm>

namespace tofsmith::plotly {

PanelLayout::PanelLayout(int panels, int max_columns, double gap)
    : columns_(std::min(panels, max_columns)),
      rows_((panels + columns_ - 1) / columns_),
      gap_(gap) {}

double PanelLayout::panel_width() const { return (1 - gap_ * (columns_ - 1)) / columns_; }

void PanelLayout::place(Json& layout, int panel, double row_gap, const std::string& title, Json x,
                        Json y) const {
  const double left = column(panel) * (panel_width() + gap_);
  const double right = left + panel_width();
  const double height = (1 - row_gap * (rows_ - 1)) / rows_;
  const double bottom = (rows_ - 1 - row(panel)) * (height + row_gap);
  const double top = bottom + height;
  x["domain"] = {number(left), number(right)};
  y["domain"] = {number(bottom), number(top)};
  x["anchor"] = axis_name("y", panel);
  y["anchor"] = axis_name("x", panel);
  layout[axis_key("x", panel)] = std::move(x);
  layout[axis_key("y", panel)] = std::move(y);
  if (!title.empty()) layout["annotations"].push_back(panel_title(title, (left + right) / 2, top));
}

}  // namespace tofsmith::plotly
