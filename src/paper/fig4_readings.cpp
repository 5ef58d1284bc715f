// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/fig4_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "paper/code_styles.hpp"
#include "paper/data_tables.hpp"
#include "paper/fig4_findings.hpp"
#include "report/shared/bar_figure.hpp"

namespace tofsmith {

namespace {

constexpr std::size_t reference_codes = 3;  // the ideal ones, last in every group

Camera camera_for(const Limits& limits, const Reading& reading, const ReproduceContext& context) {
  Camera camera = paper_camera(limits.peak_factor, limits.f_max_in_f0);
  camera.sensor.read_noise_e = std::sqrt(reading.read_noise_variance_e2);
  camera.operating.uniform_albedo = reading.uniform_albedo;
  return with_light_levels(std::move(camera), context);
}

/// Codes that compete on a camera; one that is decoded in another way is one more contender. Codes
/// are redesigned for the limits alone, whatever light and noise are read as.
std::vector<Contender> contenders(const Limits& limits, const ReproduceContext& context,
                                  const Progress& progress) {
  const Camera camera = paper_camera(limits.peak_factor, limits.f_max_in_f0);
  std::vector<Contender> list;
  for (const int exposures : {3, 4, 5}) {
    const CodeSet& code = context.shelf.redesigned(exposures, camera, context.options, progress);
    list.push_back({code.name(), code});
  }
  for (const char* name :
       {"sinusoid-k4", "multifrequency-k5", "square-k4", "pulsed-multifrequency-k5"})
    list.push_back({name, build_family(name, camera)});
  return list;
}

/// The codes before any limit, on a camera without: what could be lost.
std::vector<Contender> ideal_contenders() {
  std::vector<Contender> list;
  for (const int exposures : {3, 4, 5}) {
    const std::string family = fmt::format("hamiltonian-k{}", exposures);
    list.push_back({family + "-ideal", build_family(family, paper_camera(30, 0))});
  }
  return list;
}

/// All surfaces are equally exact, but that the drawn ones look longer for their best origin.
SurfacePrecision precision_for(bool drawn, const ReproduceContext& context) {
  SurfacePrecision precision = surface_precision(context);
  if (drawn) {
    if (!context.options.fast) precision.rotation_trials = 100000;
    return precision;
  }
  if (context.options.fast)
    precision.first_trials = precision.max_trials = precision.rotation_trials = 2000;
  return precision;
}

std::string mean_mm(const ErrorSurface& s) {
  return fmt::format("{:.0f} | {:.0f}", 1e3 * s.linear_geometric_mean_m.value,
                     1e3 * s.circular_geometric_mean_m.value);
}

std::string levels_mm(const ErrorSurface& s) {
  std::string text;
  for (const NamedLevel& level : named_levels())
    text +=
        fmt::format("{}{:.3g}", text.empty() ? "" : " / ", 1e3 * s.linear_at(level.point).value);
  return text;
}

Table means_table(const ReadingResult& result) {
  Table table{.id = fmt::format("means-{}", result.reading->id),
              .caption = fmt::format("Geometric mean of the linear | circular error (mm) with {}.",
                                     result.reading->title),
              .columns = {{"limits"},
                          {"K = 3", true},
                          {"K = 4", true},
                          {"K = 5", true},
                          {"sinusoid", true},
                          {"multi-freq.", true},
                          {"square", true},
                          {"pulsed", true}}};
  for (const ErrorSurfaceGroup& group : result.of_limits) {
    table.rows.push_back({group.title});
    for (std::size_t c = 0; c + reference_codes < group.surfaces.size(); ++c)
      table.rows.back().push_back(mean_mm(group.surfaces[c]));
  }
  return table;
}

/// The paper's own codes only: the others are in the CSV file.
Table levels_table(const std::vector<ReadingResult>& results) {
  Table table{.id = "levels",
              .caption = "Linear error (mm) at the light levels lo / mid / hi.",
              .columns = {{"limits"},
                          {"reading"},
                          {"K = 3", true},
                          {"K = 4", true},
                          {"K = 5", true},
                          {"sinusoid", true},
                          {"multi-freq.", true}}};
  for (const ReadingResult& result : results)
    for (const ErrorSurfaceGroup& group : result.of_limits) {
      table.rows.push_back({group.title, result.reading->id});
      for (std::size_t c = 0; c < 5; ++c) table.rows.back().push_back(levels_mm(group.surfaces[c]));
    }
  return table;
}

Figure readings_figure(const std::vector<ReadingResult>& results) {
  std::vector<std::string> categories;
  std::vector<BarSeries> series;
  const std::vector<ErrorSurface>& all = results.front().of_limits.front().surfaces;
  for (std::size_t c = 0; c + reference_codes < all.size(); ++c)
    series.push_back({.name = all[c].name, .style = style_of_code(all[c].name)});
  for (const ReadingResult& result : results)
    for (const ErrorSurfaceGroup& group : result.of_limits) {
      categories.push_back(fmt::format("{}; {}", group.title, result.reading->id));
      for (std::size_t c = 0; c < series.size(); ++c)
        series[c].values.push_back(1e3 * group.surfaces[c].linear_geometric_mean_m.value);
    }
  return bar_figure(
      {.id = "readings-figure",
       .title = "Geometric mean of the linear error",
       .caption =
           "One row per camera and reading: sd20 and var20 stand for read noise of standard "
           "deviation 20 e and of variance 20 e², albedo for albedos drawn from 0 to 1. Less "
           "read noise lowers every error. Albedos down to 0 raise every one, most those of "
           "codes that need much light: K = 5 and multi-frequency."},
      categories, series, {.label = "mean depth error", .unit = "mm", .logarithmic = true});
}

}  // namespace

ReadingResult measure_reading(const Reading& reading, const ReproduceContext& context,
                              const Progress& progress) {
  const bool first = &reading == all_readings.data();
  ReadingResult result{&reading, {}};
  std::vector<ErrorSurface> ideal;
  const ProgressParts parts(progress, 1 + all_limits.size());
  const auto measure_all = [&](const std::vector<Contender>& list, const Limits& limits, bool drawn,
                               const Progress& part) {
    const Camera camera = camera_for(limits, reading, context);
    std::vector<ErrorSurface> surfaces;
    const ProgressParts of_list(part, list.size());
    for (std::size_t i = 0; i < list.size(); ++i)
      surfaces.push_back(
          measure_surface(list[i], camera, precision_for(drawn, context), of_list[i]));
    return surfaces;
  };
  ideal = measure_all(ideal_contenders(), all_limits.front(), first, parts[0]);
  for (const Limits& limits : all_limits) {
    const bool drawn = first && &limits < all_limits.data() + drawn_limits;
    // The fraction waits where codes are not on the shelf yet.
    const ProgressParts of_limits(parts[1 + result.of_limits.size()], {0, 1});
    const std::vector<Contender> list = contenders(limits, context, of_limits[0]);
    ErrorSurfaceGroup group{limits.title, measure_all(list, limits, drawn, of_limits[1])};
    group.surfaces.insert(group.surfaces.end(), ideal.begin(), ideal.end());
    result.of_limits.push_back(std::move(group));
  }
  return result;
}

Section readings_section(const std::vector<ReadingResult>& results) {
  Section section{
      "Other limits, read noise and albedo",
      {Paragraph{
           "The paper says that read noise has a variance of 20; its authors' simulator takes "
           "20 as the standard deviation. It speaks of albedos between 0 and 1; the simulator "
           "takes one. All four readings are here, and p = 15, 5 and 2 without a band limit, "
           "as in the supplement. Codes are the same throughout; each is at its best origin "
           "in each row. K = 3, 4, 5 are the redesigned codes."},
       readings_figure(results)}};
  for (const ReadingResult& result : results) section.blocks.push_back(means_table(result));
  section.blocks.push_back(levels_table(results));
  return section;
}

Section stronger_baselines_section(const ReadingResult& result) {
  Table table{.id = "stronger",
              .caption =
                  "Linear error of each baseline over that of the best redesigned code, "
                  "geometric mean; in brackets at how many of the light levels the baseline "
                  "is better by more than two standard errors.",
              .columns = {{"limits"},
                          {"best redesigned"},
                          {"its error (mm)", true},
                          {"sinusoid", true},
                          {"multi-freq.", true},
                          {"square", true},
                          {"pulsed", true}}};
  for (const ErrorSurfaceGroup& group : result.of_limits) {
    const ErrorSurface& best = best_redesigned(group);
    table.rows.push_back({group.title, fmt::format("K = {}", best.name[13]),
                          fmt::format("{:.1f}", 1e3 * best.linear_geometric_mean_m.value)});
    for (const char* name :
         {"sinusoid-k4", "multifrequency-k5", "square-k4", "pulsed-multifrequency-k5"}) {
      const Comparison comparison = compare(best, group.of(name));
      table.rows.back().push_back(
          fmt::format("{:.2f} ({} of {})", comparison.mean, comparison.worse, comparison.levels()));
    }
  }
  return {"Baselines the paper does not have",
          {Paragraph{"Squares (`square-k4`) are as easy to play as sinusoids and measure depth "
                     "better; pulses and squares at two frequencies (`pulsed-multifrequency-k5`: 3 "
                     "phases at f0, 2 at 3 f0) come near the redesigned codes, and pass them where "
                     "the ratio in [[stronger]] is below 1."},
           table}};
}

std::string readings_csv(const std::vector<ReadingResult>& results) {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  for (const ReadingResult& result : results)
    for (const ErrorSurfaceGroup& group : result.of_limits)
      for (const ErrorSurface& s : group.surfaces) {
        names.push_back(
            fmt::format("\"{}\",\"{}\",{}", group.title, result.reading->title, s.name));
        rows.push_back({s.linear_geometric_mean_m.value, s.linear_geometric_mean_m.standard_error,
                        s.circular_geometric_mean_m.value,
                        s.circular_geometric_mean_m.standard_error});
        for (const NamedLevel& level : named_levels())
          rows.back().push_back(s.linear_at(level.point).value);
      }
  return csv_text("limits,reading,code", names,
                  {"linear_geometric_mean_m", "linear_se_m", "circular_geometric_mean_m",
                   "circular_se_m", "linear_lo_m", "linear_mid_m", "linear_hi_m"},
                  rows);
}

}  // namespace tofsmith
