// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/error_sections.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "report/bar_figure.hpp"
#include "report/depth_error_scale.hpp"
#include "report/shared/level_text.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {
namespace {

using Bound = double PointDepthError::*;

/// How many times as large as a bound the circular error is; not a number where the bound says
/// nothing.
double times_bound(const PointDepthError& point, Bound bound) {
  const double bound_m = point.*bound, error_m = point.circular_mde_m.value;
  const bool says_something = bound_m > 0.0 && std::isfinite(bound_m) && error_m > 0.0;
  return says_something ? error_m / bound_m : std::numeric_limits<double>::quiet_NaN();
}

/// Geometric mean over the points where the bound says something.
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

Table distance_table(std::span<const DepthErrorRow> codes, const std::vector<std::size_t>& order) {
  Table table{.id = "distance-to-bounds",
              .caption =
                  "How many times as large as a bound the circular error is (geometric mean over "
                  "the operating points). No estimator without bias comes below the Cramér-Rao "
                  "bound of its code, no code below the receiver bound of its camera, no receiver "
                  "below the direct time-of-flight bound of its light. They know no wrap and no "
                  "wrong lobe: where a code is little better than guessing, it may come below.",
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

FigureText map_text(bool is_limited) {
  if (is_limited)
    return {.id = "bound-maps",
            .title = "Circular error over the receiver bound",
            .caption =
                "How many times as large as what no code on this camera can beat, in as many "
                "exposures."};
  return {.id = "bound-maps",
          .title = "Circular error over the Cramér-Rao bound",
          .caption =
              "How many times as large as the code itself allows: without impulse responses "
              "no bound holds for all codes."};
}

/// How far the codes are from the bounds: a table of all three, and maps of how many times as large
/// as the receiver bound (without impulse responses, the Cramer-Rao bound) the circular error is.
/// @param order  of the codes, best first
std::vector<Block> bound_blocks(const Camera& camera, std::span<const DepthErrorRow> codes,
                                const std::vector<std::size_t>& order) {
  std::vector<Block> blocks{distance_table(codes, order)};
  const bool is_limited = camera.band_limited();
  const Bound bound =
      is_limited ? &PointDepthError::receiver_bound_mae_m : &PointDepthError::cramer_rao_mae_m;
  std::vector<HeatMap> maps;
  for (const std::size_t i : order) {
    HeatMap map = operating_map(camera.operating, *codes[i].error,
                                [&](const PointDepthError& p) { return times_bound(p, bound); });
    if (map.values.array().isFinite().any()) maps.push_back(std::move(map));
  }
  if (!maps.empty())
    blocks.push_back(operating_maps(map_text(is_limited), camera.operating, maps,
                                    {.label = "error / bound", .logarithmic = true}));
  return blocks;
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
  Table table{.id = "comparison",
              .caption = fmt::format(
                  "Depth error over {} operating points (geometric means; \"arithmetic\" is "
                  "the arithmetic mean of the circular error), {} trials each, N = {}, "
                  "true depths {}; ± is one standard error. Errors are mean absolute "
                  "ones, those in columns called rms root mean square ones, which count rare large "
                  "errors most. Outliers are circular errors beyond {:.2g} m.",
                  first.points.size(), first.trials, camera.samples, true_depths_in_words(camera),
                  first.outlier_threshold_m),
              .columns = {{"code"},
                          {"made by"},
                          {"K", true},
                          {"linear (mm)", true},
                          {"circular (mm)", true},
                          {"arithmetic (mm)", true},
                          {"linear rms (mm)", true},
                          {"circular rms (mm)", true},
                          {"outliers (%)", true}}};
  for (const std::size_t i : order) {
    const DepthErrorReport& e = *codes[i].error;
    double outliers = 0.0;
    for (const PointDepthError& p : e.points) outliers += p.outlier_rate.value;
    if (i == best) table.highlighted_row = static_cast<int>(table.rows.size());
    table.rows.push_back(
        {e.code, codes[i].method, fmt::format("{}", e.measurements),
         estimate_mm_text(e.linear.geometric_mean_m), estimate_mm_text(e.circular.geometric_mean_m),
         estimate_mm_text(e.circular.mean_m), estimate_mm_text(e.linear_rmse.geometric_mean_m),
         estimate_mm_text(e.circular_rmse.geometric_mean_m),
         fmt::format("{:.1f}", 100 * outliers / static_cast<double>(e.points.size()))});
  }
  return table;
}

Figure bars(std::span<const DepthErrorRow> codes, const std::vector<std::size_t>& order,
            ColourAssignment& colours) {
  BarSeries linear{.name = "linear"}, circular{.name = "circular"};
  linear.style = colours.style("linear");
  circular.style = colours.style("circular");
  std::vector<std::string> names;
  for (const std::size_t i : order) {
    const DepthErrorReport& e = *codes[i].error;
    names.push_back(e.code);
    linear.values.push_back(1e3 * e.linear.geometric_mean_m.value);
    linear.errors.push_back(1e3 * e.linear.geometric_mean_m.standard_error);
    circular.values.push_back(1e3 * e.circular.geometric_mean_m.value);
    circular.errors.push_back(1e3 * e.circular.geometric_mean_m.standard_error);
  }
  return bar_figure({.id = "depth-error",
                     .title = "Depth error of all candidates",
                     .caption = "Geometric mean over the operating points. The linear error counts "
                                "a wrap at the end of the range in full, the circular one takes "
                                "the shorter way round."},
                    names, {linear, circular},
                    {.label = "depth error", .unit = "mm", .from_zero = true});
}

/// Error along signal at the middle ambient level, with the bounds.
Figure curves(const Camera& camera, std::span<const DepthErrorRow> codes,
              const std::vector<std::size_t>& order, std::size_t best, ColourAssignment& colours) {
  const double ambient = camera.operating.middle().ambient_e_per_s;
  constexpr std::size_t max_curves = 6;  // more lines hide each other
  std::vector<Series> series;
  for (std::size_t rank = 0; rank < std::min(max_curves, order.size()); ++rank) {
    const DepthErrorReport& e = *codes[order[rank]].error;
    Series line{.name = e.code, .mark = Mark::line_and_markers, .style = colours.style(e.code)};
    for (const PointDepthError& p : e.points) {
      if (p.point.ambient_e_per_s != ambient) continue;
      line.x.push_back(p.point.signal_e_per_s);
      line.y.push_back(1e3 * p.circular_mde_m.value);
      line.y_error.push_back(1e3 * p.circular_mde_m.standard_error);
    }
    series.push_back(std::move(line));
  }
  const DepthErrorReport& winner = *codes[best].error;
  Series cramer_rao{.name = "Cramér-Rao bound of " + winner.code, .style = reference_style()};
  Series receiver{.name = "receiver bound of the camera", .style = reference_style()};
  receiver.style.dash = Dash::dash_dot;
  Series direct{.name = "direct time-of-flight bound of the light", .style = reference_style()};
  direct.style.dash = Dash::dash;
  for (const PointDepthError& p : winner.points) {
    if (p.point.ambient_e_per_s != ambient) continue;
    cramer_rao.x.push_back(p.point.signal_e_per_s);
    cramer_rao.y.push_back(1e3 * p.cramer_rao_mae_m);
    receiver.x.push_back(p.point.signal_e_per_s);
    receiver.y.push_back(1e3 * p.receiver_bound_mae_m);
    direct.x.push_back(p.point.signal_e_per_s);
    direct.y.push_back(1e3 * p.direct_tof_bound_mae_m);
  }
  series.push_back(std::move(cramer_rao));
  if (receiver.y.front() > 0.0) series.push_back(std::move(receiver));
  if (direct.y.front() > 0.0) series.push_back(std::move(direct));
  return line_figure(
      {.id = "error-by-signal",
       .title = "Circular depth error by signal",
       .caption = fmt::format(
           "At ambient light of {} e/s{}. The bounds hold "
           "for estimators without bias and know no wrap, so a code may come "
           "below them where it is little better than guessing.",
           level_text(ambient),
           order.size() > max_curves ? fmt::format("; the {} best codes", max_curves) : "")},
      series, {.label = "signal", .unit = "e/s", .logarithmic = true},
      {.label = "mean circular depth error", .unit = "mm", .logarithmic = true});
}

Figure heat_maps(const Camera& camera, std::span<const DepthErrorRow> codes,
                 const std::vector<std::size_t>& order, DepthErrorKind kind) {
  const bool is_linear = kind == DepthErrorKind::linear;
  std::vector<HeatMap> maps;
  for (const std::size_t i : order)
    maps.push_back(operating_map(camera.operating, *codes[i].error, [&](const PointDepthError& p) {
      return 1e3 * (is_linear ? p.linear_mde_m.value : p.circular_mde_m.value);
    }));
  return operating_maps(
      {.id = "error-maps",
       .title = fmt::format("Mean {} depth error by operating point", name_of(kind)),
       .caption = "In mm, all codes on one logarithmic colour scale, best first."},
      camera.operating, maps, {.label = "depth error", .unit = "mm", .logarithmic = true});
}

}  // namespace

Section depth_error_section(const Camera& camera, std::span<const DepthErrorRow> codes,
                            std::size_t best) {
  const DepthErrorKind kind = camera.operating.error;
  const std::vector<std::size_t> order = by_error(codes, kind);
  ColourAssignment colours;
  Section section{.title = "Depth error"};
  section.blocks.push_back(comparison_table(camera, codes, order, best));
  section.blocks.push_back(bars(codes, order, colours));
  section.blocks.push_back(heat_maps(camera, codes, order, kind));
  if (camera.operating.signal_e_per_s.size() > 1)
    section.blocks.push_back(curves(camera, codes, order, best, colours));
  for (Block& block : bound_blocks(camera, codes, order))
    section.blocks.push_back(std::move(block));
  return section;
}

}  // namespace tofsmith
