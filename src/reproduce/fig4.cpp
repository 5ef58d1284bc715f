// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "reproduce/fig4_findings.hpp"
#include "reproduce/fig4_readings.hpp"
#include "reproduce/fig4_unwrapping.hpp"
#include "reproduce/figures.hpp"

namespace tofsmith {

namespace {

Section panel_section(const Limits& limits, const ErrorSurfaceGroup& group) {
  const std::string id = limits.id;
  std::vector<std::string> mapped;
  for (const ErrorSurface& surface : group.surfaces)
    if (!surface.name.ends_with("-ideal")) mapped.push_back(surface.name);
  for (const char* ideal : {"hamiltonian-k4-ideal", "hamiltonian-k5-ideal"})
    mapped.push_back(ideal);
  return {
      fmt::format("Fig. 4{}: {}{}", limits.id, limits.title,
                  limits.f_max_in_f0 > 0 ? "" : ", no band limit"),
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
                       group, mapped),
       geometric_mean_table(
           "means-" + id,
           "Geometric means over all light levels, and the linear error at three of them: "
           "S = 3.16k (lo), 10k (mid) and 100k e/s (hi), A = 10k e/s. ± is one standard "
           "error. The best linear mean is marked.",
           group)}};
}

Section comparison_section(const std::vector<ErrorSurfaceGroup>& panels) {
  std::vector<RatioMap> maps;
  for (const char* baseline : {"sinusoid-k4", "multifrequency-k5", "square-k4"})
    for (const ErrorSurfaceGroup& group : panels) {
      const ErrorSurface& best = best_redesigned(group);
      maps.push_back({fmt::format("{}, {}", baseline, group.title),
                      group.of(baseline).linear_m.cwiseQuotient(best.linear_m)});
    }
  return {
      "Side by side",
      {error_by_signal(
           {.id = "slices",
            .title = "Mean depth error by signal",
            .caption = "Cuts through the surfaces at ambient light 10k e/s; bars are two standard "
                       "errors. Multi-frequency falls steeply where 7 f0 is not cut off; squares "
                       "lie below sinusoids "
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

}  // namespace

Reproduction reproduce_fig4(const ReproduceContext& context, const Progress& progress) {
  // 1. Every code on every camera under every reading.
  std::vector<ReadingResult> results;
  const ProgressParts parts(progress, {38, 19, 19, 19, 5});  // every reading, unwrapping
  for (std::size_t r = 0; r < all_readings.size(); ++r)
    results.push_back(measure_reading(all_readings[r], context, parts[r]));
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
           "in a, b and c is {:.1f} % of its value, {:.0f} million trials in all.",
           100 * worst, trials / 1e6)}}});
  for (std::size_t l = 0; l < drawn_limits; ++l)
    result.sections.push_back(panel_section(all_limits[l], panels[l]));
  result.sections.push_back(comparison_section(panels));
  add_unwrapping(result, context, parts[all_readings.size()]);
  result.sections.push_back(stronger_baselines_section(results.front()));
  result.sections.push_back(readings_section(results));

  // 4. The numbers.
  for (std::size_t l = 0; l < drawn_limits; ++l)
    add_arrays(result.arrays, all_limits[l].id, panels[l]);
  result.files["surfaces.csv"] = surfaces_csv(panels);
  result.files["readings.csv"] = readings_csv(results);
  return result;
}

}  // namespace tofsmith
