// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/error_sections.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "tofsmith/report/code_figures.hpp"
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
  ColourAssignment colours;
  std::vector<Series> series;
  for (const DepthErrorRow& code : codes) {
    const DepthErrorReport& e = *code.error;
    series.push_back(series_of(e, e.code, colours.style(e.code),
                               [](const PointDepthError& p) { return p.circular_mde_m.value; }));
    series.back().mark = Mark::line_and_markers;
    for (const PointDepthError& p : e.points)
      if (p.point.ambient_e_per_s == ambient)
        series.back().y_error.push_back(1e3 * p.circular_mde_m.standard_error);
  }
  const DepthErrorReport& first = *codes.front().error;
  const auto add_bound = [&](std::string name, Dash dash, double PointDepthError::*bound) {
    LineStyle style = reference_style();
    style.dash = dash;
    Series line = series_of(first, std::move(name), style,
                            [&](const PointDepthError& p) { return p.*bound; });
    if (line.y.front() > 0.0) series.push_back(std::move(line));
  };
  add_bound("Cramér-Rao bound", Dash::dot, &PointDepthError::cramer_rao_mae_m);
  add_bound("receiver bound", Dash::dash_dot, &PointDepthError::receiver_bound_mae_m);
  add_bound("direct ToF bound", Dash::dash, &PointDepthError::direct_tof_bound_mae_m);
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

}  // namespace tofsmith
