// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/report/colours.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith::plotly {

using Json = nlohmann::ordered_json;

/// Six significant digits; null when not finite.
Json number(double value);
Json numbers(std::span<const double> values);

/// A large array as Plotly's typed array: little-endian float32 in base64.
/// @param shape  {count} or {rows, columns}
Json typed_array(std::span<const float> values, const std::vector<std::size_t>& shape);
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

}  // namespace tofsmith::plotly
