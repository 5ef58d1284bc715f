// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/design_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "report/shared/table_of_rows.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/design_report.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

namespace {

using Bound = double PointDepthError::*;

/// NaN where the bound is not finite and positive.
double times_bound(const PointDepthError& point, Bound bound) {
  const double bound_m = point.*bound, error_m = point.circular_mde_m.value;
  const bool is_defined = bound_m > 0.0 && std::isfinite(bound_m) && error_m > 0.0;
  return is_defined ? error_m / bound_m : std::numeric_limits<double>::quiet_NaN();
}

std::string mean_times_bound(const DepthErrorReport& error, Bound bound) {
  double log_sum = 0.0;
  int count = 0;
  for (const PointDepthError& point : error.points) {
    const double times = times_bound(point, bound);
    if (std::isnan(times)) continue;
    log_sum += std::log(times);
    ++count;
  }
  return count > 0 ? fmt::format("{:.2f}", std::exp(log_sum / count)) : "no bound";
}

/// At most `most` codes in this order; if there are more, the best of every family and method.
std::vector<DepthErrorRow> shown_codes(std::span<const DepthErrorRow> codes,
                                       const std::vector<std::size_t>& order, std::size_t most) {
  std::vector<DepthErrorRow> shown;
  std::set<std::string> families;
  for (const std::size_t i : order) {
    const std::string& name = codes[i].error->code;
    const std::string family = codes[i].method + " " + name.substr(0, name.find('-'));
    if (shown.size() < most && (codes.size() <= most || families.insert(family).second))
      shown.push_back(codes[i]);
  }
  return shown;
}

Table distance_table(std::span<const DepthErrorRow> codes, const std::vector<std::size_t>& order) {
  Table table{
      .id = "distance-to-bounds",
      .caption =
          "Ratio of the circular error to each bound (geometric mean over the operating "
          "points). The Cramér-Rao bound applies to unbiased estimators of one code. The "
          "receiver bound applies to all codes of the camera. The direct time-of-flight "
          "(ToF) bound applies to all receivers that use the same light. The unambiguous range "
          "limits large errors, but not the bounds, so ratios can be below 1.",
      .columns = {{"code"},
                  {"error / Cramér-Rao", true},
                  {"error / receiver bound", true},
                  {"error / direct ToF bound", true}}};
  for (const std::size_t i : order) {
    const DepthErrorReport& error = *codes[i].error;
    table.rows.push_back({error.code, mean_times_bound(error, &PointDepthError::cramer_rao_mae_m),
                          mean_times_bound(error, &PointDepthError::receiver_bound_mae_m),
                          mean_times_bound(error, &PointDepthError::direct_tof_bound_mae_m)});
  }
  return table;
}

std::vector<std::size_t> by_error(std::span<const DepthErrorRow> codes, DepthErrorKind kind) {
  std::vector<std::size_t> order(codes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return codes[a].error->of(kind).geometric_mean_m.value <
           codes[b].error->of(kind).geometric_mean_m.value;
  });
  return order;
}

Table comparison_table(const Camera& camera, std::span<const DepthErrorRow> codes,
                       const std::vector<std::size_t>& order, std::size_t best) {
  const DepthErrorReport& first = *codes[0].error;
  std::int64_t min_trials = first.trials, max_trials = first.trials;
  for (const DepthErrorRow& code : codes) {
    min_trials = std::min(min_trials, code.error->trials);
    max_trials = std::max(max_trials, code.error->trials);
  }
  Table table{
      .id = "comparison",
      .caption = fmt::format(
          "Errors are geometric means over {} operating points; the column arithmetic "
          "contains the arithmetic mean of the circular error. Each operating point has {}{} "
          "trials with N = {} samples per period and true depths {}; ± is one "
          "standard error. Taps are the values that are read out per exposure. Errors are mean "
          "absolute errors; rms columns contain root mean square errors, in which rare "
          "large errors dominate. Outliers are circular errors above {:.2g} m.",
          first.points.size(), min_trials,
          max_trials > min_trials ? fmt::format(" to {}", max_trials) : "", camera.samples,
          true_depths_in_words(camera), first.outlier_threshold_m),
      .columns = {{"code"},
                  {"made by"},
                  {exposures_by_taps_title, true},
                  {"linear (mm)", true},
                  {"circular (mm)", true},
                  {"arithmetic (mm)", true},
                  {"linear rms (mm)", true},
                  {"circular rms (mm)", true},
                  {"outliers (%)", true}}};
  if (codes[best].ratio) {
    table.columns.push_back({"ratio", true});
    table.caption +=
        " Codes are ranked by the column ratio: the error of a code divided by the error of the "
        "best code.";
  }
  for (const std::size_t i : order) {
    const DepthErrorReport& e = *codes[i].error;
    double outliers = 0.0;
    for (const PointDepthError& p : e.points) outliers += p.outlier_rate.value;
    if (i == best) table.highlighted_row = static_cast<int>(table.rows.size());
    table.rows.push_back(
        {e.code, codes[i].method, exposures_by_taps(e), estimate_mm_text(e.linear.geometric_mean_m),
         estimate_mm_text(e.circular.geometric_mean_m), estimate_mm_text(e.circular.mean_m),
         estimate_mm_text(e.linear_rmse.geometric_mean_m),
         estimate_mm_text(e.circular_rmse.geometric_mean_m),
         fmt::format("{:.1f}", 100 * outliers / static_cast<double>(e.points.size()))});
    if (codes[best].ratio)
      table.rows.back().push_back(codes[i].ratio
                                      ? fmt::format("{:.3f} ± {:.3f}", codes[i].ratio->value,
                                                    codes[i].ratio->standard_error)
                                      : "1");
  }
  return table;
}

Figure error_maps(const OperatingRange& range, const std::vector<DepthErrorRow>& codes) {
  CategoryAxis x{.label = "ambient", .unit = "e/s"}, y{.label = "signal", .unit = "e/s"};
  for (const double a : range.ambient_e_per_s) x.ticks.push_back(level_text(a));
  for (const double s : range.signal_e_per_s) y.ticks.push_back(level_text(s));
  std::vector<HeatMap> maps;
  for (const DepthErrorRow& code : codes) {
    HeatMap map{.title = code.error->code, .values = {}};
    map.values.resize(std::ssize(y.ticks), std::ssize(x.ticks));
    auto point = code.error->points.begin();  // ordered by signal
    for (Eigen::Index s = 0; s < map.values.rows(); ++s)
      for (Eigen::Index a = 0; a < map.values.cols(); ++a, ++point)
        map.values(s, a) = 1e3 * point->of(range.error).value;
    maps.push_back(std::move(map));
  }
  return heat_map_figure(
      {.id = "error-maps",
       .title = fmt::format("Mean {} depth error by light level", name_of(range.error)),
       .caption =
           "All maps have the same logarithmic colour scale. The best code is first; if there "
           "are many codes, only the best code of each family is shown."},
      maps, x, y, {.label = "depth error", .unit = "mm", .logarithmic = true});
}

}  // namespace

Figure error_by_signal(const std::string& id, const Camera& camera,
                       std::span<const DepthErrorRow> codes) {
  const double ambient = camera.operating.middle().ambient_e_per_s;
  const auto series_of = [&](const DepthErrorReport& error, std::string name,
                             const LineStyle& style, const auto& value_m) {
    Series line{.name = std::move(name), .style = style};
    for (const PointDepthError& p : error.points) {
      if (p.point.ambient_e_per_s != ambient) continue;
      line.x.push_back(p.point.signal_e_per_s);
      line.y.push_back(1e3 * value_m(p));
    }
    return line;
  };
  // Codes with similar errors follow one another: dashes show curves that coincide.
  static constexpr std::array dashes = {Dash::solid, Dash::dash, Dash::dot};
  ColourAssignment colours;
  std::vector<Series> series;
  for (const DepthErrorRow& code : codes) {
    const DepthErrorReport& e = *code.error;
    LineStyle style = colours.style(e.code);
    style.dash = dashes[series.size() % dashes.size()];
    series.push_back(series_of(e, e.code, style,
                               [](const PointDepthError& p) { return p.circular_mde_m.value; }));
    series.back().mark = Mark::line_and_markers;
    for (const PointDepthError& p : e.points)
      if (p.point.ambient_e_per_s == ambient)
        series.back().y_error.push_back(1e3 * p.circular_mde_m.standard_error);
  }
  const DepthErrorReport& first = *codes.front().error;
  const auto add_bound = [&](std::string name, Dash dash, double width_px, Bound bound) {
    Series line = series_of(first, std::move(name), {reference_style().colour, dash, width_px},
                            [&](const PointDepthError& p) { return p.*bound; });
    if (line.y.front() > 0.0) series.push_back(std::move(line));
  };
  // Wide, to be visible on the curve of a code that reaches the bound.
  add_bound("Cramér-Rao bound", Dash::dot, 4.0, &PointDepthError::cramer_rao_mae_m);
  add_bound("receiver bound", Dash::dash_dot, 1.5, &PointDepthError::receiver_bound_mae_m);
  add_bound("direct ToF bound", Dash::dash, 1.5, &PointDepthError::direct_tof_bound_mae_m);
  return line_figure(
      {.id = id,
       .title = "Circular depth error over signal",
       .caption = fmt::format(
           "The ambient light is {} e/s. The Cramér-Rao bound is computed for {}. The "
           "receiver bound applies to all codes of the camera, and the direct time-of-flight (ToF) "
           "bound applies to all receivers that use the same light.",
           level_text(ambient), first.code)},
      series, {.label = "signal", .unit = "e/s", .logarithmic = true},
      {.label = "circular depth error", .unit = "mm", .logarithmic = true});
}

Section depth_error_section(const Camera& camera, std::span<const DepthErrorRow> codes,
                            std::size_t best, bool with_curves) {
  constexpr std::size_t most_maps = 6, most_curves = 7;  // more would be unreadable
  const std::vector<std::size_t> order = by_error(codes, camera.operating.error);
  Section section{.title = "Depth error"};
  section.blocks.push_back(comparison_table(camera, codes, order, best));
  if (with_curves && camera.operating.signal_e_per_s.size() > 1)
    section.blocks.push_back(
        error_by_signal("error-by-signal", camera, shown_codes(codes, order, most_curves)));
  section.blocks.push_back(error_maps(camera.operating, shown_codes(codes, order, most_maps)));
  section.blocks.push_back(distance_table(codes, order));
  return section;
}

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
    text += fmt::format(", random {} in {} part{} per exposure", name_of(others.spreading),
                        others.parts, others.parts == 1 ? "" : "s");
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
