// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "evaluation_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tofsmith/io/csv.hpp"
#include "tofsmith/report/zncc_comparison.hpp"

namespace tofsmith::apps {

namespace {

/// "61.2 (1.08x)"; "none" where nothing bounds the error from below.
std::string bound_text(double bound_m, const Estimate& error_m) {
  if (bound_m == 0.0) return "none";
  if (!std::isfinite(bound_m)) return "inf";
  return fmt::format("{:.4g} ({:.2f}x)", 1e3 * bound_m, error_m.value / bound_m);
}

}  // namespace

std::vector<std::vector<std::string>> evaluation_rows(const std::vector<EvaluatedCode>& codes) {
  std::vector<std::vector<std::string>> rows{
      {"code", "K", "signal (e/s)", "ambient (e/s)", "linear (mm)", "circular (mm)", "outliers (%)",
       "Cramer-Rao (mm)", "receiver (mm)", "direct ToF (mm)"}};
  for (const EvaluatedCode& code : codes) {
    for (const PointDepthError& p : code.error.points)
      rows.push_back({code.error.code, fmt::format("{}", code.error.measurements),
                      fmt::format("{:.3g}", p.point.signal_e_per_s),
                      fmt::format("{:.3g}", p.point.ambient_e_per_s),
                      millimetres_text(p.linear_mde_m), millimetres_text(p.circular_mde_m),
                      fmt::format("{:.2f}", 100 * p.outlier_rate.value),
                      bound_text(p.cramer_rao_mae_m, p.circular_mde_m),
                      bound_text(p.receiver_bound_mae_m, p.circular_mde_m),
                      bound_text(p.direct_tof_bound_mae_m, p.circular_mde_m)});
    rows.push_back({code.error.code, "", "geometric", "mean",
                    millimetres_text(code.error.linear.geometric_mean_m),
                    millimetres_text(code.error.circular.geometric_mean_m), "", "", "", ""});
  }
  return rows;
}

std::string evaluation_csv(const std::vector<EvaluatedCode>& codes) {
  const bool compared = is_compared_with_zncc(codes);
  std::string text = fmt::format(
      "code,signal_e_per_s,ambient_e_per_s,linear_mde_m,linear_se_m,circular_mde_m,circular_se_m,"
      "outlier_rate,cramer_rao_mae_m,receiver_bound_mae_m,direct_tof_bound_mae_m{}\n",
      compared ? ",zncc_linear_mde_m,zncc_circular_mde_m" : "");
  for (const EvaluatedCode& code : codes)
    for (std::size_t i = 0; i < code.error.points.size(); ++i) {
      const PointDepthError& p = code.error.points[i];
      text +=
          fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}",
                      csv_field(code.error.code), p.point.signal_e_per_s, p.point.ambient_e_per_s,
                      p.linear_mde_m.value, p.linear_mde_m.standard_error, p.circular_mde_m.value,
                      p.circular_mde_m.standard_error, p.outlier_rate.value, p.cramer_rao_mae_m,
                      p.receiver_bound_mae_m, p.direct_tof_bound_mae_m);
      if (compared)
        text += fmt::format(",{:.9g},{:.9g}", code.zncc_error->points[i].linear_mde_m.value,
                            code.zncc_error->points[i].circular_mde_m.value);
      text += "\n";
    }
  return text;
}

}  // namespace tofsmith::apps
