// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "evaluation_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tofsmith/core/units.hpp"
#include "tofsmith/io/csv.hpp"
#include "tofsmith/report/design_report.hpp"
#include "tofsmith/simulate/depth_error_text.hpp"

namespace tofsmith::apps {

namespace {

/// Returns a bound for a CSV file; an empty field if there is no bound.
std::string bound_field(double bound_m) {
  return std::isnan(bound_or_nan(bound_m)) ? "" : fmt::format("{:.9g}", bound_m);
}

std::string bound_text(double bound_m, const Estimate& error_m) {
  if (bound_m == 0.0) return "none";
  if (!std::isfinite(bound_m)) return "inf";
  return fmt::format("{} ({:.2f}x)", plain_number(1e3 * bound_m, 4), error_m.value / bound_m);
}

using Row = std::vector<std::string>;

Row point_row(const DepthErrorReport& error, std::string_view which, const PointDepthError& p) {
  return {error.code,
          exposures_by_taps(error),
          std::string(which),
          fmt::format("{:.3g}", p.point.signal_e_per_s),
          fmt::format("{:.3g}", p.point.ambient_e_per_s),
          estimate_mm_text(p.linear_mde_m),
          estimate_mm_text(p.circular_mde_m),
          fmt::format("{:.2f}", 100 * p.outlier_rate.value),
          bound_text(p.cramer_rao_mae_m, p.circular_mde_m),
          bound_text(p.receiver_bound_mae_m, p.circular_mde_m),
          bound_text(p.direct_tof_bound_mae_m, p.circular_mde_m)};
}

Row mean_row(const DepthErrorReport& error) {
  return {error.code,
          exposures_by_taps(error),
          fmt::format("mean of {}", error.points.size()),
          "",
          "",
          estimate_mm_text(error.linear.geometric_mean_m),
          estimate_mm_text(error.circular.geometric_mean_m),
          "",
          "",
          "",
          ""};
}

}  // namespace

std::vector<std::vector<std::string>> evaluation_rows(const std::vector<EvaluatedCode>& codes,
                                                      DepthErrorKind kind, bool every_level) {
  std::vector<Row> rows{{"code", exposures_by_taps_title, "light", "signal (e/s)", "ambient (e/s)",
                         "linear (mm)", "circular (mm)", "outliers (%)", "Cramer-Rao (mm)",
                         "receiver (mm)", "direct ToF (mm)"}};
  const auto error_m = [kind](const PointDepthError& p) {
    return (kind == DepthErrorKind::linear ? p.linear_mde_m : p.circular_mde_m).value;
  };
  for (const EvaluatedCode& code : codes) {
    const std::vector<PointDepthError>& points = code.error.points;
    const auto [best, worst] = std::ranges::minmax_element(points, {}, error_m);
    rows.push_back(mean_row(code.error));
    if (every_level || points.size() < 2) {
      for (const PointDepthError& p : points) rows.push_back(point_row(code.error, "", p));
    } else {
      rows.push_back(point_row(code.error, "best", *best));
      rows.push_back(point_row(code.error, "worst", *worst));
    }
  }
  return rows;
}

std::string evaluation_csv(const std::vector<EvaluatedCode>& codes) {
  const bool compared = is_compared_with_zncc(codes);
  const bool has_others = is_evaluated_with_interference(codes);
  std::string text = fmt::format(
      "code,signal_e_per_s,ambient_e_per_s,linear_mde_m,linear_se_m,circular_mde_m,circular_se_m,"
      "linear_rmse_m,linear_rmse_se_m,circular_rmse_m,circular_rmse_se_m,outlier_rate,"
      "cramer_rao_mae_m,receiver_bound_mae_m,direct_tof_bound_mae_m{}{}\n",
      compared ? ",zncc_linear_mde_m,zncc_circular_mde_m" : "",
      has_others ? ",interference_rms_m,interference_expected_rmse_m,interference_circular_mde_m,"
                   "interference_circular_rmse_m,interference_wrong,interference_wrong_ok,"
                   "interference_wrong_inconsistent"
                 : "");
  for (const EvaluatedCode& code : codes)
    for (std::size_t i = 0; i < code.error.points.size(); ++i) {
      const PointDepthError& p = code.error.points[i];
      text += fmt::format(
          "{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},"
          "{:.9g},{:.9g},{},{}",
          csv_field(code.error.code), p.point.signal_e_per_s, p.point.ambient_e_per_s,
          p.linear_mde_m.value, p.linear_mde_m.standard_error, p.circular_mde_m.value,
          p.circular_mde_m.standard_error, p.linear_rmse_m.value, p.linear_rmse_m.standard_error,
          p.circular_rmse_m.value, p.circular_rmse_m.standard_error, p.outlier_rate.value,
          p.cramer_rao_mae_m, bound_field(p.receiver_bound_mae_m),
          bound_field(p.direct_tof_bound_mae_m));
      if (compared)
        text += fmt::format(",{:.9g},{:.9g}", code.zncc_error->points[i].linear_mde_m.value,
                            code.zncc_error->points[i].circular_mde_m.value);
      if (has_others) {
        const InterferencePoint& lit = code.interference->points[i];
        text += fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}",
                            code.interference->rms_m, lit.expected_rmse_m, lit.circular_mde_m.value,
                            lit.circular_rmse_m.value, lit.shares.wrong, lit.shares.wrong_ok,
                            lit.shares.wrong_inconsistent);
      }
      text += "\n";
    }
  return text;
}

}  // namespace tofsmith::apps
