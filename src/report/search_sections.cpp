// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/search_sections.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/line_figure.hpp"

namespace tofsmith {

namespace {

/// Residuals against iterations of every measurement that was designed.
void add_convergence(const DesignResult& result, Section& section) {
  for (const Candidate& c : result.candidates) {
    ColourAssignment colours;
    std::vector<Series> series;
    for (std::size_t k = 0; k < c.per_measurement.size(); ++k) {
      Series relaxed{.name = fmt::format("measurement {}", k + 1),
                     .mark = Mark::line_and_markers,
                     .style = colours.style(fmt::format("{}", k))};
      for (std::size_t i = 0; i < c.per_measurement[k].history.size(); ++i) {
        relaxed.x.push_back(static_cast<double>(i + 1));
        relaxed.y.push_back(std::max(1e-6, c.per_measurement[k].history[i].playable_residual_rms));
      }
      if (!relaxed.x.empty()) series.push_back(std::move(relaxed));
    }
    if (series.empty()) continue;
    section.blocks.push_back(line_figure(
        {.id = figure_id("convergence", c.code.name()),
         .title = fmt::format("Convergence of {}", c.code.name()),
         .caption = "Residual of the binary projection after each pair of convex steps, for the "
                    "random start that came closest; values below 1e-6 are drawn "
                    "at 1e-6."},
        series, {.label = "iteration"}, {.label = "residual, rms", .logarithmic = true}));
  }
}

/// The smallest error so far of every search, and what it counted.
void add_search_progress(const DesignResult& result, Section& section) {
  ColourAssignment colours;
  for (const Candidate& c : result.candidates) {
    if (!c.search) continue;
    section.blocks.push_back(
        KeyValueList{{{c.code.name(), fmt::format("{}. {}", c.message, c.search->account)}}});
    Series steps{.name = c.code.name(),
                 .mark = Mark::line_and_markers,
                 .style = colours.style(c.code.name())};
    for (const SearchStep& step : c.search->steps) {
      steps.x.push_back(step.work);
      steps.y.push_back(1e3 * step.error_m);
    }
    if (steps.x.empty()) continue;
    section.blocks.push_back(line_figure(
        {.id = figure_id("search", c.code.name()),
         .title = fmt::format("Search for {}", c.code.name()),
         .caption = fmt::format("The {}, against work.", c.search->error_name)},
        {steps}, {.label = c.search->work_unit}, {.label = "depth error", .unit = "mm"}));
  }
}

}  // namespace

Section gain_section(const Camera& camera, const DesignResult& result) {
  const DepthErrorKind kind = camera.operating.error;
  Table table{.id = "gains",
              .caption = fmt::format(
                  "How many times as large as that of the best the {} depth error of every other "
                  "candidate is; ± is one standard error, the two taken for independent.",
                  kind == DepthErrorKind::linear ? "linear" : "circular"),
              .columns = {{"code"}, {"made by"}, {"exposures", true}, {"times the best", true}}};
  for (const Candidate* c : by_geometric_mean_error(result, kind)) {
    if (c == &result.winner()) continue;
    const Estimate gain = gain_over(result, *c, kind);
    table.rows.push_back({c->code.name(), c->method, fmt::format("{}", c->error.exposures),
                          fmt::format("{:.3f} ± {:.3f}", gain.value, gain.standard_error)});
  }
  return {"Gain", {std::move(table)}};
}

Section search_section(const DesignResult& result) {
  Section section{.title = "Search"};
  add_search_progress(result, section);
  add_convergence(result, section);
  return section;
}

}  // namespace tofsmith
