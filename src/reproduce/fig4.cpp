// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reproduce/code_styles.hpp"
#include "reproduce/data_tables.hpp"
#include "reproduce/error_surface_figures.hpp"
#include "reproduce/fig4_findings.hpp"
#include "reproduce/figures.hpp"
#include "tofsmith/report/bar_figure.hpp"

namespace tofsmith {

namespace {

/// Limits of a camera. The paper draws the first three; its supplement has the others.
struct Limits {
  const char* id;
  const char* title;
  double peak_factor;
  double f_max_in_f0;  // 0: none
};
constexpr std::array<Limits, 6> all_limits = {{{"a", "p = 30, no band limit", 30, 0},
                                               {"b", "p = 15, 10 f0", 15, 10},
                                               {"c", "p = 15, 5 f0", 15, 5},
                                               {"p15", "p = 15, no band limit", 15, 0},
                                               {"p5", "p = 5, no band limit", 5, 0},
                                               {"p2", "p = 2, no band limit", 2, 0}}};
constexpr std::size_t drawn_limits = 3;

/// What light and noise are taken to be.
struct Reading {
  const char* title;
  double read_noise_variance_e2;
  bool uniform_albedo;
};
constexpr std::array<Reading, 4> all_readings = {
    {{"read noise 20 e", 400,
      false},  // the simulator of the paper's authors: standard deviation 20
     {"read noise variance 20 e²", 20, false},  // the paper's words
     {"read noise 20 e, albedo 0-1", 400, true},
     {"read noise variance 20 e², albedo 0-1", 20, true}}};

/// All codes on all cameras under one reading.
struct ReadingResult {
  const Reading* reading;
  std::vector<ErrorSurfaceGroup> of_limits;  // as all_limits
};

Camera camera_for(const Limits& limits, const Reading& reading, const ReproduceContext& context) {
  Camera camera = paper_camera(limits.peak_factor, limits.f_max_in_f0);
  camera.sensor.read_noise_e = std::sqrt(reading.read_noise_variance_e2);
  camera.operating.uniform_albedo = reading.uniform_albedo;
  if (context.options.fast) {
    camera.operating.signal_e_per_s = {std::pow(10.0, 3.5), 1e4, 1e5};
    camera.operating.ambient_e_per_s = {1e2, 1e4, 1e5};
  }
  return camera;
}

/// Codes that compete on a camera; one that is decoded in another way is one more contender. Codes
/// are redesigned for the limits alone, whatever light and noise are read as.
std::vector<Contender> contenders(const Limits& limits, const ReproduceContext& context) {
  const Camera camera = paper_camera(limits.peak_factor, limits.f_max_in_f0);
  std::vector<Contender> list;
  for (const int exposures : {3, 4, 5}) {
    const CodeSet& code = context.shelf.redesigned(exposures, camera, context.options);
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

/// The drawn surfaces are exact everywhere, the others in their geometric means and at the named
/// light levels.
SurfacePrecision precision_for(bool drawn, const ReproduceContext& context) {
  SurfacePrecision precision{.seed = context.options.seed};
  if (!drawn) precision.standard_error = 0.06;
  if (context.options.fast) {
    precision.standard_error = precision.named_standard_error = 0.1;
    precision.first_trials = 2000;
    precision.most_trials = 40000;
    precision.rotation_trials = 4000;
  }
  return precision;
}

ReadingResult measure(const Reading& reading, const ReproduceContext& context,
                      const Progress& progress) {
  const bool first = &reading == all_readings.data();
  ReadingResult result{&reading, {}};
  std::vector<ErrorSurface> ideal;
  const double steps = 1.0 + all_limits.size();
  double done = 0.0;
  const auto measure_all = [&](const std::vector<Contender>& list, const Limits& limits,
                               bool drawn) {
    const Camera camera = camera_for(limits, reading, context);
    std::vector<ErrorSurface> surfaces;
    const auto count = static_cast<double>(list.size());
    for (std::size_t i = 0; i < list.size(); ++i)
      surfaces.push_back(
          measure_surface(list[i], camera, precision_for(drawn, context),
                          part_of(progress, (done + static_cast<double>(i) / count) / steps,
                                  (done + static_cast<double>(i + 1) / count) / steps)));
    done += 1.0;
    return surfaces;
  };
  ideal = measure_all(ideal_contenders(), all_limits.front(), first);
  for (const Limits& limits : all_limits) {
    const bool drawn = first && &limits < all_limits.data() + drawn_limits;
    ErrorSurfaceGroup group{limits.title, measure_all(contenders(limits, context), limits, drawn)};
    group.surfaces.insert(group.surfaces.end(), ideal.begin(), ideal.end());
    result.of_limits.push_back(std::move(group));
  }
  return result;
}

Section panel_section(const Limits& limits, const ErrorSurfaceGroup& group) {
  const std::string id = limits.id;
  return {
      fmt::format("Fig. 4{}: {}", limits.id, limits.title),
      {surfaces_3d(
           {.id = "surfaces-" + id,
            .title = "Mean depth error over signal and ambient light",
            .caption = "Linear error, all axes logarithmic; drag to turn, click a name "
                       "to hide it. Lower is better. Dashed: the ideal code, on a "
                       "camera without limits."},
           group,
           {"sinusoid-k4", "multifrequency-k5", "hamiltonian-k3-redesigned",
            "hamiltonian-k4-redesigned", "hamiltonian-k5-redesigned", "hamiltonian-k5-ideal"}),
       error_heat_maps({.id = "values-" + id,
                        .title = "The values",
                        .caption = "Linear mean depth error (mm) of all codes, each at its best "
                                   "origin of depth. The ideal codes are those of a camera "
                                   "without limits."},
                       group, 4),
       geometric_mean_table(
           "means-" + id,
           "Geometric means over all light levels, and the linear error at three of them: "
           "S = 10^3.5 (lo), 10^4 (mid) and 10^5 e/s (hi), A = 10^4 e/s. ± is one standard "
           "error. The best linear mean is marked.",
           group)}};
}

Section comparison_section(const std::vector<ErrorSurfaceGroup>& panels) {
  std::vector<RatioMap> maps;
  for (const char* baseline : {"sinusoid-k4", "multifrequency-k5", "square-k4"})
    for (const ErrorSurfaceGroup& group : panels) {
      const ErrorSurface& best = best_redesigned(group);
      maps.push_back({fmt::format("{} / {}, {}", baseline, best.name.substr(0, 14),
                                  group.title.substr(0, group.title.find(", no"))),
                      group.of(baseline).linear_m.cwiseQuotient(best.linear_m)});
    }
  return {
      "Side by side",
      {error_by_signal(
           {.id = "slices",
            .title = "Mean depth error by signal",
            .caption = "Cuts through the surfaces at ambient light 10^4 e/s; bars are two standard "
                       "errors. Multi-frequency is the steepest curve; squares lie below sinusoids "
                       "everywhere."},
           panels,
           {"sinusoid-k4", "multifrequency-k5", "square-k4", "pulsed-multifrequency-k5",
            "hamiltonian-k3-redesigned", "hamiltonian-k4-redesigned", "hamiltonian-k5-redesigned",
            "hamiltonian-k5-ideal"}),
       ratio_heat_maps({.id = "ratios",
                        .title = "How many times better the best redesigned code is",
                        .caption = "Linear error of a baseline over that of the redesigned code "
                                   "with the least geometric mean on this camera. Below 1 the "
                                   "baseline wins."},
                       maps, panels.front().surfaces.front(), 3)}};
}

/// Geometric means for all limits and readings.
Section readings_section(const std::vector<ReadingResult>& results) {
  const std::vector<ErrorSurface>& all = results.front().of_limits.front().surfaces;
  Table table{.id = "readings",
              .caption =
                  "Geometric mean of the linear | circular error (mm) over all light "
                  "levels, for every reading of the paper and all limits. Redesigned codes "
                  "are in the columns K = 3, 4, 5.",
              .columns = {{"limits"}, {"noise and albedo"}}};
  for (const char* header :
       {"K = 3", "K = 4", "K = 5", "sinusoid", "multi-frequency", "square", "pulsed multi-freq."})
    table.columns.push_back({header, true});
  Table levels{.id = "levels",
               .caption = "The linear error (mm) at the light levels lo / mid / hi.",
               .columns = table.columns};
  std::vector<std::string> categories;
  std::vector<BarSeries> series;
  const std::size_t codes = all.size() - 3;  // all but the ideal ones
  for (std::size_t c = 0; c < codes; ++c)
    series.push_back({.name = all[c].name, .style = style_of_code(all[c].name)});
  for (const ReadingResult& result : results)
    for (std::size_t l = 0; l < all_limits.size(); ++l) {
      const ErrorSurfaceGroup& group = result.of_limits[l];
      std::vector<std::string> means = {group.title, result.reading->title}, points = means;
      categories.push_back(fmt::format("{}; {}", group.title, result.reading->title));
      for (std::size_t c = 0; c < codes; ++c) {
        const ErrorSurface& surface = group.surfaces[c];
        means.push_back(fmt::format("{:.0f} | {:.0f}", 1e3 * surface.linear_geometric_mean_m.value,
                                    1e3 * surface.circular_geometric_mean_m.value));
        std::string cell;
        for (const NamedLevel& level : named_levels())
          cell += fmt::format("{}{:.0f}", cell.empty() ? "" : " / ",
                              1e3 * surface.linear_at(level.point).value);
        points.push_back(cell);
        series[c].values.push_back(1e3 * surface.linear_geometric_mean_m.value);
      }
      table.rows.push_back(std::move(means));
      levels.rows.push_back(std::move(points));
    }
  return {
      "Other limits, read noise and albedo",
      {Paragraph{
           "The paper says that read noise has a variance of 20; its authors' simulator takes "
           "20 as the standard deviation. It speaks of albedos between 0 and 1; the simulator "
           "takes one. All four are here, and p = 15, 5 and 2 without a band limit, as in the "
           "supplement. Codes are the same throughout; each is at its best origin for each row."},
       bar_figure({.id = "readings-figure",
                   .title = "Geometric mean of the linear error",
                   .caption = "One row per camera and reading. Variance 20 helps every code "
                              "where light is weak; albedos down to 0 hurt every code. The "
                              "order of the codes stays."},
                  categories, series,
                  {.label = "mean depth error", .unit = "mm", .logarithmic = true}),
       table, levels}};
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

}  // namespace

Reproduction reproduce_fig4(const ReproduceContext& context, const Progress& progress) {
  // 1. Every code on every camera under every reading.
  std::vector<ReadingResult> results;
  constexpr std::array<double, 5> share = {0.0, 0.4, 0.6, 0.8, 1.0};
  for (std::size_t r = 0; r < all_readings.size(); ++r)
    results.push_back(measure(all_readings[r], context, part_of(progress, share[r], share[r + 1])));
  const auto& surfaces = results.front().of_limits;
  const std::vector<ErrorSurfaceGroup> panels(surfaces.begin(), surfaces.begin() + drawn_limits);

  // 2. What the paper says of a, b and c.
  Reproduction result;
  result.findings = fig4_findings(panels);

  // 3. The figures.
  double worst = 0.0, trials = 0.0;
  for (const ErrorSurfaceGroup& panel : panels)
    for (const ErrorSurface& surface : panel.surfaces) {
      worst = std::max(worst, surface.worst_standard_error());
      trials += static_cast<double>(surface.trials);
    }
  result.sections.push_back(
      {"How it was measured",
       {Paragraph{fmt::format(
           "Linear error as in the paper: near the ends of the range noise wraps and costs the "
           "whole range. Every code is at its best origin of depth for it, which is fair to all; "
           "the circular error beside it does not depend on the origin. 300 ms in all, N = 240 "
           "samples, depths anywhere in the range, decoded between samples by zero-mean normalized "
           "cross-correlation, read noise of standard deviation 20 e, Gaussian noise, albedo 1 "
           "unless said otherwise. Trials per light level follow the standard error: the largest "
           "in a, b and c is {:.1f} % of its value, {:.2g} trials in all.",
           100 * worst, trials)}}});
  for (std::size_t l = 0; l < drawn_limits; ++l)
    result.sections.push_back(panel_section(all_limits[l], panels[l]));
  result.sections.push_back(comparison_section(panels));
  result.sections.push_back(readings_section(results));

  // 4. The numbers.
  for (std::size_t l = 0; l < drawn_limits; ++l)
    for (const ErrorSurface& surface : panels[l].surfaces) {
      std::string name = fmt::format("{}_{}", all_limits[l].id, surface.name);
      result.arrays[name + "_linear_m"] = npy_of(surface.linear_m);
      result.arrays[name + "_linear_se_m"] = npy_of(surface.linear_se_m);
      result.arrays[name + "_circular_m"] = npy_of(surface.circular_m);
    }
  result.arrays["signal_e_per_s"] = npy_of(surfaces.front().surfaces.front().signal_e_per_s);
  result.arrays["ambient_e_per_s"] = npy_of(surfaces.front().surfaces.front().ambient_e_per_s);
  result.files["surfaces.csv"] = surfaces_csv(panels);
  result.files["readings.csv"] = readings_csv(results);
  return result;
}

}  // namespace tofsmith
