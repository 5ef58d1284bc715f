// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/second_return_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "tofsmith/core/people_text.hpp"
#include "tofsmith/report/bar_figure.hpp"
#include "tofsmith/report/colours.hpp"

namespace tofsmith {

namespace {

/// A candidate with its errors.
struct Judged {
  const Candidate* candidate;
  Estimate single_m, behind_m;
  std::optional<Estimate> two_return_m;
  double weighed_m;
};

std::vector<Judged> by_weighed_error(const SecondReturns& returns, const DesignResult& result,
                                     DepthErrorKind kind) {
  std::vector<Judged> all;
  for (const Candidate& c : result.candidates) {
    if (!c.second_returns) continue;
    Judged judged{&c, c.error.of(kind).geometric_mean_m, c.second_returns->single_path.of(kind),
                  std::nullopt, 0.0};
    if (c.second_returns->two_return)
      judged.two_return_m = c.second_returns->two_return->circular_m;
    judged.weighed_m = returns.weighed(judged.single_m.value, judged.behind_m.value);
    all.push_back(judged);
  }
  std::ranges::stable_sort(all, {}, &Judged::weighed_m);
  return all;
}

Table second_return_table(const SecondReturns& returns, const std::vector<Judged>& codes,
                          const Candidate& winner, std::string_view kind) {
  Table table{
      .id = "second-returns",
      .caption = fmt::format(
          "Geometric means over the operating points of the {} error of single returns (E1) and "
          "behind a second return of ratio {} to {}, {} to {} m late, decoded as single-path (E2); "
          "the same decoded as two returns (circular). Codes are chosen by E1^{:.3g} E2^{:.3g}; "
          "where decoding as two returns errs much more than of standard codes, that counts too.",
          kind, returns.ratio[0], returns.ratio[1], returns.delay_m[0], returns.delay_m[1],
          1.0 - returns.weight, returns.weight),
      .columns = {{"code"},
                  {"E1 (mm)", true},
                  {"E2 (mm)", true},
                  {"chosen by (mm)", true},
                  {"as two returns (mm)", true}}};
  for (const Judged& j : codes) {
    if (j.candidate == &winner) table.highlighted_row = static_cast<int>(table.rows.size());
    table.rows.push_back({j.candidate->code.name(), estimate_mm_text(j.single_m),
                          estimate_mm_text(j.behind_m), fmt::format("{:.1f}", 1e3 * j.weighed_m),
                          j.two_return_m ? estimate_mm_text(*j.two_return_m) : "cannot"});
  }
  return table;
}

Figure second_return_bars(const std::vector<Judged>& codes) {
  ColourAssignment colours;
  BarSeries single{.name = "one return"}, behind{.name = "second return, single-path"},
      two{.name = "second return, as two"};
  std::vector<std::string> names;
  const auto add = [](BarSeries& series, const Estimate& e) {
    series.values.push_back(1e3 * e.value);
    series.errors.push_back(1e3 * e.standard_error);
  };
  const Estimate none{std::numeric_limits<double>::quiet_NaN(), 0.0};
  for (const Judged& j : codes) {
    names.push_back(j.candidate->code.name());
    add(single, j.single_m);
    add(behind, j.behind_m);
    add(two, j.two_return_m.value_or(none));
  }
  std::vector<BarSeries> series{std::move(single), std::move(behind), std::move(two)};
  for (BarSeries& bars : series) bars.style = colours.style(bars.name);
  return bar_figure({.id = "second-return-errors",
                     .title = "Depth error without and behind second returns",
                     .caption = "What a second return adds to the error of each code, and what "
                                "two-return decoding takes away again; no bar where a code cannot "
                                "be decoded so."},
                    names, series, {.label = "depth error", .unit = "mm", .from_zero = true});
}

}  // namespace

Section second_return_section(const SecondReturns& returns, const DesignResult& result,
                              DepthErrorKind kind) {
  const std::vector<Judged> codes = by_weighed_error(returns, result, kind);
  return {"Second returns",
          {second_return_table(returns, codes, result.winner(),
                               kind == DepthErrorKind::linear ? "linear" : "circular"),
           second_return_bars(codes)}};
}

}  // namespace tofsmith
