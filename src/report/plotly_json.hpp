// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tofsmith/report/figure.hpp"

namespace tofsmith::plotly {

using Json = nlohmann::ordered_json;

/// Six significant digits; null when not finite.
Json number(double value);
Json numbers(std::span<const double> values);

/// A large array as Plotly's typed array: little-endian float32 in base64.
/// @param shape  {count} or {rows, columns}
/// @param resolution  finer differences cannot be seen: a page rounds to multiples of it, "step".
///                    0: it keeps all
Json typed_array(std::span<const float> values, const std::vector<std::size_t>& shape,
                 double resolution = 0.0);
/// What a typed array holds.
std::vector<float> floats_of(const Json& typed);
std::string encode_base64(std::span<const std::uint8_t> bytes);
/// Replaces every typed array in `json` by plain nested arrays.
void expand_typed_arrays(Json& json);

/// Text that Plotly shows as it is: its own markup (<b>, <a>) is escaped.
std::string text(std::string_view plain);
Json title(const std::string& plain);

/// Layout entry of an axis.
/// @param values  what is drawn along it; places the ticks of a logarithmic axis without a range
/// @throws std::invalid_argument if a range is empty, or not positive on a logarithmic axis
Json axis(const Axis& axis, std::span<const double> values = {});
/// "x", "x2", .. : what traces call the axis with this index from 0.
std::string axis_name(const std::string& letter, int index);
/// "xaxis", "xaxis2", ..: what the layout calls it.
std::string axis_key(const std::string& letter, int index);

/// "line" entry of a trace.
Json line(const LineStyle& style);

/// A heading over a panel, centred at x (paper coordinates), standing on y.
Json panel_title(const std::string& plain, double x, double y);

/// Figure of these traces and this layout.
Figure figure(FigureText text, const Json& data, Json layout, const FigureSize& size);

/// The trace that draws a series.
/// @throws std::invalid_argument if x, y and y_error differ in length
Json trace_of(const Series& series);

/// What the series draw along one axis: all their `values` (&Series::x or &Series::y).
std::vector<double> drawn(const std::vector<Series>& series, std::vector<double> Series::*values);

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
