// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/design_report.hpp"

#include <fmt/format.h>

#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

std::string ratio(const Estimate& error, const Estimate& other) {
  return fmt::format("{:.4f}", error.value / other.value);
}

}  // namespace

bool is_compared_with_zncc(std::span<const EvaluatedCode> codes) {
  return !codes.empty() && codes.front().zncc_error;
}

std::vector<std::vector<std::string>> zncc_comparison_rows(std::span<const EvaluatedCode> codes,
                                                           bool every_level) {
  std::vector<std::vector<std::string>> rows{{"code", "signal (e/s)", "ambient (e/s)",
                                              "zncc linear (mm)", "ml / zncc", "zncc circular (mm)",
                                              "ml / zncc"}};
  for (const EvaluatedCode& code : codes) {
    const DepthErrorReport &own = code.error, &zncc = *code.zncc_error;
    rows.push_back({own.code, "geometric", "mean", estimate_mm_text(zncc.linear.geometric_mean_m),
                    ratio(own.linear.geometric_mean_m, zncc.linear.geometric_mean_m),
                    estimate_mm_text(zncc.circular.geometric_mean_m),
                    ratio(own.circular.geometric_mean_m, zncc.circular.geometric_mean_m)});
    for (std::size_t i = 0; every_level && i < own.points.size(); ++i) {
      const PointDepthError &p = own.points[i], &other = zncc.points[i];
      rows.push_back(
          {own.code, fmt::format("{:.3g}", p.point.signal_e_per_s),
           fmt::format("{:.3g}", p.point.ambient_e_per_s), estimate_mm_text(other.linear_mde_m),
           ratio(p.linear_mde_m, other.linear_mde_m), estimate_mm_text(other.circular_mde_m),
           ratio(p.circular_mde_m, other.circular_mde_m)});
    }
  }
  return rows;
}

Section zncc_comparison(std::span<const EvaluatedCode> codes) {
  std::vector<std::vector<std::string>> rows = zncc_comparison_rows(codes, true);
  Table table{.id = "zncc",
              .caption =
                  "Depth error of the same trials decoded by zero-mean normalized "
                  "cross-correlation, and how many times as large that by maximum "
                  "likelihood is."};
  for (const std::string& heading : rows.front())
    table.columns.push_back({heading, heading != rows.front().front()});
  table.rows.assign(rows.begin() + 1, rows.end());
  return {"Maximum likelihood against correlation", {std::move(table)}};
}

}  // namespace tofsmith
