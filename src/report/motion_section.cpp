// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "report/shared/table_of_rows.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/report/design_report.hpp"

namespace tofsmith {

namespace {

using Row = std::vector<std::string>;

bool has_motion(const EvaluatedCode& code) { return code.motion.has_value(); }

std::string percent(double share) { return fmt::format("{:.2f}", 100.0 * share); }

std::string detected_text(const WrongShares& shares) {
  const auto detected = shares.detected();
  return detected ? percent(*detected) : "";
}

/// @param edge  null for codes with one exposure
Row motion_row(const std::string& code, std::string signal, std::string ambient,
               const MotionReport& report, const Estimate& error_m, const WrongShares& surface,
               const WrongShares* edge) {
  return {code,
          std::move(signal),
          std::move(ambient),
          fmt::format("{:.3f}", 1e3 * report.rms_bias_m),
          estimate_mm_text(error_m),
          percent(surface.wrong),
          detected_text(surface),
          edge ? percent(edge->wrong) : "",
          edge ? percent(edge->wrong_ok) : "",
          edge ? detected_text(*edge) : ""};
}

}  // namespace

bool is_evaluated_with_motion(std::span<const EvaluatedCode> codes) {
  return std::ranges::any_of(codes, has_motion);
}

std::vector<Row> motion_rows(std::span<const EvaluatedCode> codes, bool every_level) {
  std::vector<Row> rows{{"code", "signal (e/s)", "ambient (e/s)", "bias (mm)", "error (mm)",
                         "wrong (%)", "detected (%)", "edge wrong (%)", "edge ok (%)",
                         "edge detected (%)"}};
  for (const EvaluatedCode& code : codes) {
    if (!has_motion(code)) continue;
    const MotionReport& report = *code.motion;
    const MotionErrors &surface = report.surface, &edge = report.edge;
    const bool has_edge = !edge.points.empty();
    rows.push_back(motion_row(code.error.code, "all", "all", report, surface.geometric_mean_m,
                              surface.shares, has_edge ? &edge.shares : nullptr));
    for (std::size_t i = 0; every_level && i < surface.points.size(); ++i) {
      const MotionPoint& p = surface.points[i];
      rows.push_back(motion_row(code.error.code, fmt::format("{:.3g}", p.point.signal_e_per_s),
                                fmt::format("{:.3g}", p.point.ambient_e_per_s), report,
                                p.circular_mde_m, p.shares,
                                has_edge ? &edge.points[i].shares : nullptr));
    }
  }
  return rows;
}

Section motion_section(std::span<const EvaluatedCode> codes) {
  const auto first = std::ranges::find_if(codes, has_motion);
  return {
      "Motion",
      {table_of_rows(
          "motion",
          fmt::format(
              "A surface moves along the ray at {} m/s while exposures follow one another. Bias: "
              "rms depth error without noise, relative to the middle of the frame. Error: "
              "circular error with noise. Wrong: share of depths whose error exceeds three "
              "predicted standard deviations. Detected: share of the wrong depths with status "
              "inconsistent. Edge: between two exposures, one of two surfaces at random depths "
              "covers the other; a depth is wrong if it differs from the depths of both surfaces. "
              "Edge ok: share of wrong depths with status ok. Rows of all light levels contain the "
              "geometric mean of the error and means of shares.",
              first->motion->velocity_m_per_s),
          motion_rows(codes, true), {0})}};
}

}  // namespace tofsmith
