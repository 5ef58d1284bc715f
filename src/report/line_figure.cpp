// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <utility>

#include "report/shared/plotly_json.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

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

}  // namespace tofsmith
