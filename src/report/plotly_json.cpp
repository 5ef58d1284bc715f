// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/plotly_json.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/shared/text_numbers.hpp"
#include "report/logarithmic_ticks.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith::plotly {
namespace {

/// The series with the point that closes its period, if it has one.
Series closed(Series series) {
  if (!series.period || series.x.empty()) return series;
  series.x.push_back(series.x.front() + *series.period);
  series.y.push_back(series.y.front());
  if (!series.y_error.empty()) series.y_error.push_back(series.y_error.front());
  return series;
}

constexpr std::string_view base64_digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::vector<std::uint8_t> decode_base64(const std::string& encoded) {
  std::vector<std::uint8_t> bytes;
  std::uint32_t buffer = 0;
  int bits = 0;
  for (const char c : encoded) {
    if (c == '=') break;
    buffer = buffer << 6 | static_cast<std::uint32_t>(base64_digits.find(c));
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes.push_back(static_cast<std::uint8_t>(buffer >> bits & 255));
    }
  }
  return bytes;
}

Json plain_values(const Json& typed) {
  const std::string shape = typed.value("shape", "");
  const auto comma = shape.find(',');
  const std::size_t columns = comma == std::string::npos ? 0 : std::stoul(shape.substr(comma + 1));

  Json values = Json::array();
  std::size_t i = 0;
  for (const float single : floats_of(typed)) {
    const Json value = number(static_cast<double>(single));
    if (columns == 0) {
      values.push_back(value);
    } else {
      if (i++ % columns == 0) values.push_back(Json::array());
      values.back().push_back(value);
    }
  }
  return values;
}

/// From the smallest to the largest positive value, and what the margin of an axis adds to that.
std::optional<ValueRange> positive_range(std::span<const double> values) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const double value : values) {
    if (!std::isfinite(value) || value <= 0) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (high == 0) return std::nullopt;
  constexpr double rounding = 1e-6;
  if (high <= low * (1.0 + rounding)) return ValueRange{low / 3, low * 3};
  const double margin = std::pow(high / low, 0.05);
  return ValueRange{low / margin, high * margin};
}

const char* dash_name(Dash dash) {
  switch (dash) {
    case Dash::dash:
      return "dash";
    case Dash::dot:
      return "dot";
    case Dash::dash_dot:
      return "dashdot";
    default:
      return "solid";
  }
}

}  // namespace

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

Json trace_of(const Series& open_series) {
  require(open_series.x.size() == open_series.y.size(), "Series::y.size", open_series.y.size(),
          "must equal x.size = " + std::to_string(open_series.x.size()));
  require(open_series.y_error.empty() || open_series.y_error.size() == open_series.y.size(),
          "Series::y_error.size", open_series.y_error.size(), "must be 0 or equal y.size");
  const Series series = closed(open_series);
  const bool has_line = series.mark != Mark::markers;
  const bool has_markers = series.mark == Mark::markers || series.mark == Mark::line_and_markers;
  Json trace = {{"type", "scatter"},
                {"name", text(series.name)},
                {"mode", !has_line     ? "markers"
                         : has_markers ? "lines+markers"
                                       : "lines"},
                {"x", numbers(series.x)},
                {"y", numbers(series.y)},
                {"line", line(series.style)},
                {"hovertemplate", "%{x:.4g}, %{y:.4g}"}};
  // Plotly would drop points it takes for collinear and tilt the flat parts of a waveform.
  trace["line"]["simplify"] = false;
  if (series.mark == Mark::steps) trace["line"]["shape"] = "hv";
  if (has_markers) trace["marker"] = {{"color", series.style.colour}, {"size", 6}};
  if (!series.y_error.empty()) {
    trace["error_y"] = {{"type", "data"},
                        {"array", numbers(series.y_error)},
                        {"color", series.style.colour},
                        {"thickness", 1.2},
                        {"width", 3}};
  }
  return trace;
}

std::vector<double> drawn(const std::vector<Series>& series, std::vector<double> Series::*values) {
  std::vector<double> all;
  for (const Series& one : series)
    all.insert(all.end(), (one.*values).begin(), (one.*values).end());
  return all;
}

Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  // The JSON writer prints the shortest digits that read back the same.
  return *number_in(fmt::format("{:.6g}", value));
}

Json numbers(std::span<const double> values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

std::string encode_base64(std::span<const std::uint8_t> bytes) {
  std::string encoded;
  encoded.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t present = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t triple = 0;
    for (std::size_t j = 0; j < 3; ++j) triple = triple << 8 | (j < present ? bytes[i + j] : 0u);
    for (std::size_t j = 0; j < 4; ++j)
      encoded += j <= present ? base64_digits[triple >> (18 - 6 * j) & 63] : '=';
  }
  return encoded;
}

std::vector<float> floats_of(const Json& typed) {
  const auto bytes = decode_base64(typed.at("bdata").get<std::string>());
  std::vector<float> values;
  values.reserve(bytes.size() / 4);
  for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4) {
    std::uint32_t word = 0;
    for (std::size_t b = 0; b < 4; ++b) word |= static_cast<std::uint32_t>(bytes[i + b]) << 8 * b;
    values.push_back(std::bit_cast<float>(word));
  }
  return values;
}

Json typed_array(std::span<const float> values, const std::vector<std::size_t>& shape,
                 double resolution) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * values.size());
  for (const float value : values) {
    const auto word = std::bit_cast<std::uint32_t>(value);
    for (int b = 0; b < 4; ++b) bytes.push_back(static_cast<std::uint8_t>(word >> 8 * b & 255));
  }
  Json typed = {{"dtype", "f4"},
                {"bdata", encode_base64(bytes)},
                {"shape", fmt::format("{}", fmt::join(shape, ", "))}};
  if (resolution > 0.0) typed["step"] = number(resolution);
  return typed;
}

void expand_typed_arrays(Json& json) {
  if (json.is_object() && json.contains("bdata")) {
    json = plain_values(json);
  } else if (json.is_structured()) {
    for (auto& child : json) expand_typed_arrays(child);
  }
}

std::string text(std::string_view plain) {
  std::string escaped;
  for (const char c : plain) {
    if (c == '<')
      escaped += "&lt;";
    else if (c == '&')
      escaped += "&amp;";
    else
      escaped += c;
  }
  return escaped;
}

Json title(const std::string& plain) { return {{"text", text(plain)}}; }

Json axis(const Axis& axis, std::span<const double> values) {
  Json json = {{"title", title(axis_title(axis.label, axis.unit))}};
  if (axis.range) {
    require(axis.range->low < axis.range->high, "Axis::range.low", axis.range->low,
            "must be below range.high");
    require(!axis.logarithmic || axis.range->low > 0, "Axis::range.low", axis.range->low,
            "must be > 0 on a logarithmic axis");
    const auto end = [&](double v) { return number(axis.logarithmic ? std::log10(v) : v); };
    json["range"] = {end(axis.range->low), end(axis.range->high)};
  }
  if (axis.logarithmic) {
    json["type"] = "log";
    if (const auto range = axis.range ? axis.range : positive_range(values)) {
      for (const Tick& tick : logarithmic_ticks(*range)) {
        json["tickvals"].push_back(number(tick.value));
        json["ticktext"].push_back(tick.text);
      }
    }
  } else if (axis.from_zero) {
    json["rangemode"] = "tozero";
  }
  return json;
}

std::string axis_name(const std::string& letter, int index) {
  return index == 0 ? letter : letter + std::to_string(index + 1);
}

std::string axis_key(const std::string& letter, int index) {
  return index == 0 ? letter + "axis" : letter + "axis" + std::to_string(index + 1);
}

Json line(const LineStyle& style) {
  return {{"color", style.colour}, {"dash", dash_name(style.dash)}, {"width", style.width_px}};
}

Json panel_title(const std::string& plain, double x, double y) {
  return {{"text", text(plain)}, {"x", number(x)},  {"xref", "paper"},     {"xanchor", "center"},
          {"y", number(y)},      {"yref", "paper"}, {"yanchor", "bottom"}, {"showarrow", false}};
}

Figure figure(FigureText text, const Json& data, Json layout, const FigureSize& size) {
  const Json json = {{"data", data}, {"layout", std::move(layout)}};
  return Figure(std::move(text),
                json.dump(-1, ' ', false, nlohmann::detail::error_handler_t::replace), size);
}

}  // namespace tofsmith::plotly
