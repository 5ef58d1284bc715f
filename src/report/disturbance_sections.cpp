// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/design_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "report/shared/table_of_rows.hpp"
#include "tofsmith/core/units.hpp"

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

bool has_interference(const EvaluatedCode& code) { return code.interference.has_value(); }

std::string plain_mm(double length_m) {
  return std::isfinite(length_m) ? fmt::format("{:.3f}", 1e3 * length_m) : "";
}

/// @param expected, rms  of one operating point
Row interference_row(const std::string& code, std::string signal, std::string ambient, double rms_m,
                     std::string expected, std::string rms, const Estimate& alone_m,
                     const Estimate& error_m, const WrongShares& shares) {
  return {code,
          std::move(signal),
          std::move(ambient),
          plain_mm(rms_m),
          std::move(expected),
          std::move(rms),
          estimate_mm_text(alone_m),
          estimate_mm_text(error_m),
          percent(shares.wrong),
          percent(shares.wrong_ok),
          detected_text(shares)};
}

Row row(const std::string& code, const std::string& camera, const Estimate& nominal_m,
        const Estimate& calibrated_m, const Estimate& uncalibrated_m) {
  const auto ratio = [&](const Estimate& error_m) {
    return fmt::format("{:.3f}", error_m.value / nominal_m.value);
  };
  return {code,
          camera,
          estimate_mm_text(calibrated_m),
          ratio(calibrated_m),
          estimate_mm_text(uncalibrated_m),
          ratio(uncalibrated_m)};
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

bool is_evaluated_with_interference(std::span<const EvaluatedCode> codes) {
  return std::ranges::any_of(codes, has_interference);
}

std::vector<Row> interference_rows(std::span<const EvaluatedCode> codes, bool every_level) {
  std::vector<Row> rows{{"code", "signal (e/s)", "ambient (e/s)", "interference (mm)",
                         "expected rms (mm)", "rms (mm)", "alone (mm)", "error (mm)", "wrong (%)",
                         "wrong ok (%)", "detected (%)"}};
  for (const EvaluatedCode& code : codes) {
    if (!has_interference(code)) continue;
    const InterferenceReport& report = *code.interference;
    const bool is_single = report.points.size() == 1;
    if (!is_single)
      rows.push_back(interference_row(code.error.code, "all", "all", report.rms_m, "", "",
                                      code.error.circular.geometric_mean_m,
                                      report.circular.geometric_mean_m, report.shares));
    for (std::size_t i = 0; (every_level || is_single) && i < report.points.size(); ++i) {
      const InterferencePoint& p = report.points[i];
      rows.push_back(
          interference_row(code.error.code, fmt::format("{:.3g}", p.point.signal_e_per_s),
                           fmt::format("{:.3g}", p.point.ambient_e_per_s), report.rms_m,
                           plain_mm(p.expected_rmse_m), estimate_mm_text(p.circular_rmse_m),
                           code.error.points[i].circular_mde_m, p.circular_mde_m, p.shares));
    }
  }
  return rows;
}

std::string interference_text(const OperatingInterference& others) {
  std::string text = fmt::format("{} other camera{}, each with {} times the signal", others.cameras,
                                 others.cameras == 1 ? "" : "s", others.signal_ratio);
  if (others.code != "same") text += fmt::format(", code {}", others.code);
  if (others.frequency_offset_hz != 0.0)
    text += fmt::format(", frequency offset {} Hz", others.frequency_offset_hz);
  if (others.spreads())
    text += fmt::format(", random {} in {} part{} per exposure",
                        spreadings[static_cast<std::size_t>(others.spreading)], others.parts,
                        others.parts == 1 ? "" : "s");
  return text;
}

Section interference_section(std::span<const EvaluatedCode> codes,
                             const OperatingInterference& others) {
  return {
      "Other cameras",
      {table_of_rows(
          "interference",
          fmt::format(
              "Depth error with the light of {}. Interference: rms error of zncc without noise, to "
              "first order. Expected rms: the same with noise. Rms, error: rms and mean circular "
              "error of trials. Alone: mean circular error without other cameras. Wrong: share of "
              "depths whose error exceeds three predicted standard deviations. Wrong ok: "
              "share of depths that are wrong with status ok. Detected: share of the wrong depths "
              "with status "
              "inconsistent. Rows of all light levels contain geometric means of errors and means "
              "of shares.",
              interference_text(others)),
          interference_rows(codes, true), {0})}};
}

std::vector<JudgedCode> judged_codes(std::span<const EvaluatedCode> codes) {
  std::vector<JudgedCode> judged;
  for (const EvaluatedCode& code : codes)
    if (code.robustness) judged.push_back({code.error.code, *code.robustness});
  return judged;
}

std::vector<Row> robustness_rows(const std::vector<JudgedCode>& codes) {
  std::vector<Row> rows{
      {"code", "camera", "calibrated (mm)", "/ nominal", "uncalibrated (mm)", "/ nominal"}};
  for (const JudgedCode& code : codes) {
    const RobustnessReport& r = code.robustness;
    rows.push_back(row(code.name, "nominal", r.nominal_m, r.nominal_m, r.nominal_m));
    for (const PerturbedError& p : r.perturbed)
      rows.push_back(row(code.name, p.name, r.nominal_m, p.calibrated_m, p.uncalibrated_m));
    rows.push_back(
        row(code.name, "worst", r.nominal_m, r.worst_calibrated_m(), r.worst_uncalibrated_m()));
  }
  return rows;
}

Section robustness_section(const std::vector<JudgedCode>& codes) {
  const bool is_linear = codes.empty() || codes.front().robustness.kind == DepthErrorKind::linear;
  std::string caption = fmt::format(
      "{} depth error (geometric mean over the operating points) on cameras that differ from "
      "the nominal camera. Calibrated: decoded with the correlation functions of the actual "
      "camera. Uncalibrated: decoded with the correlation functions of the nominal camera. The "
      "depths and the noise are the same for all cameras, with {} trials per operating point.",
      is_linear ? "Linear" : "Circular", codes.empty() ? 0 : codes.front().robustness.trials);
  return {"Robustness",
          {table_of_rows("robustness", std::move(caption), robustness_rows(codes), {0, 1})}};
}

}  // namespace tofsmith
