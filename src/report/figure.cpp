// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "report/plotly_json.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

bool is_id_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
}

}  // namespace

LineStyle ColourAssignment::style(const std::string& name) {
  static constexpr std::array palette = {
      "#0072b2",  // blue
      "#d55e00",  // vermillion
      "#009e73",  // bluish green
      "#cc79a7",  // reddish purple
      "#e69f00",  // orange
      "#56b4e9",  // sky blue
      "#000000",  // black
  };
  static constexpr std::array dashes = {Dash::solid, Dash::dash, Dash::dot, Dash::dash_dot};
  const int place = order_.try_emplace(name, static_cast<int>(order_.size())).first->second;
  const std::size_t colours = palette.size();
  const auto index = static_cast<std::size_t>(place);
  return {palette[index % colours], dashes[index / colours % dashes.size()]};
}

LineStyle reference_style() { return {"#8a8f98", Dash::dot, 1.5}; }

Figure line_figure(FigureText text, const std::vector<Series>& series, const Axis& x,
                   const Axis& y) {
  require(!series.empty(), "series.size", series.size(), "must be >= 1");
  plotly::Json data = plotly::Json::array();
  for (const Series& one : series) data.push_back(plotly::trace_of(one));
  const plotly::Json layout = {{"xaxis", plotly::axis(x, plotly::drawn(series, &Series::x))},
                               {"yaxis", plotly::axis(y, plotly::drawn(series, &Series::y))},
                               {"showlegend", series.size() > 1}};
  return plotly::figure(std::move(text), data, layout, {.fixed_px = 400});
}

std::string axis_title(const std::string& label, const std::string& unit) {
  return unit.empty() ? label : label + " (" + unit + ")";
}

Figure::Figure(FigureText text, std::string plotly_json, FigureSize size)
    : text_(std::move(text)), plotly_json_(std::move(plotly_json)), size_(size) {
  require(!text_.id.empty() && std::ranges::all_of(text_.id, is_id_character), "FigureText::id",
          text_.id, "must be letters, digits and dashes");
  require(!text_.title.empty(), "FigureText::title", text_.title, "must not be empty");
}

std::string Figure::plain_plotly_json() const {
  auto json = plotly::Json::parse(plotly_json_);
  plotly::expand_typed_arrays(json);
  return json.dump();
}

std::vector<double> to_values(const Eigen::Ref<const Eigen::VectorXd>& vector) {
  return {vector.begin(), vector.end()};
}

}  // namespace tofsmith
