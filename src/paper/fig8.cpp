// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "paper/error_surface_figures.hpp"
#include "paper/fig4_findings.hpp"
#include "paper/figures.hpp"

namespace tofsmith {

namespace {

constexpr double fig8_peak_factor = 15;
constexpr std::array<double, 2> fig8_limits_in_f0 = {10, 5};

const std::string paper_code = "hamiltonian-k4-redesigned";
// Quadrature at f0 and at 7 f0; with the second buckets 4 phases at each.
const std::string dual_frequency = "multifrequency-1x2-7x2";
const std::string single_frequency = "sinusoid-k2";
const std::string one_tap = "hamiltonian-k4-one-tap";

std::vector<Contender> contenders(const Camera& camera, const ReproduceContext& context,
                                  const Progress& progress) {
  const ProgressParts parts(progress, 4);
  std::vector<Contender> list;
  for (const int exposures : {3, 4, 5, 6}) {
    const CodeSet& code =
        context.shelf.redesigned(exposures, camera, context.options, parts[list.size()]);
    list.push_back({code.name(), code});
  }
  for (const std::string& name : {single_frequency, dual_frequency})
    list.push_back({name, build_family(name, camera)});
  return list;
}

ErrorSurfaceGroup measure(double f_max_in_f0, const ReproduceContext& context,
                          const Progress& progress) {
  const Camera camera =
      with_light_levels(two_bucket_camera(fig8_peak_factor, f_max_in_f0), context);
  ErrorSurfaceGroup group{fmt::format("p = {:g}, {:g} f0", fig8_peak_factor, f_max_in_f0), {}};
  const ProgressParts parts(progress, {40, 10, 50});  // the contenders, the one tap, measuring
  const std::vector<Contender> list =
      contenders(two_bucket_camera(fig8_peak_factor, f_max_in_f0), context, parts[0]);
  // The same light and time with one tap: what the second bucket adds.
  const Camera single = paper_camera(fig8_peak_factor, f_max_in_f0);
  const CodeSet& code = context.shelf.redesigned(4, single, context.options, parts[1]);
  const ProgressParts measuring(parts[2], list.size() + 1);
  for (const Contender& contender : list)
    group.surfaces.push_back(measure_surface(contender, camera, surface_precision(context),
                                             measuring[group.surfaces.size()]));
  group.surfaces.push_back(measure_surface({one_tap, code}, with_light_levels(single, context),
                                           surface_precision(context), measuring[list.size()]));
  return group;
}

CheckedStatement beats(const std::vector<ErrorSurfaceGroup>& panels, const std::string& baseline,
                       const std::string& words) {
  CheckedStatement finding{
      .statement = fmt::format("On two-bucket cameras at 10 f0 and 5 f0 the redesigned Hamiltonian "
                               "code (4 exposures, 8 values) beats the {}.",
                               words)};
  Comparison all;
  for (const ErrorSurfaceGroup& panel : panels) {
    const Comparison one = compare(panel.of(paper_code), panel.of(baseline));
    finding.measured += fmt::format(
        "{}{}: better at {} of {} light levels, tied at {}, worse at {}; {} has {:.2f} to {:.2f} "
        "times its error, {:.2f} on average",
        finding.measured.empty() ? "" : ". ", panel.title, one.better, one.levels(), one.even,
        one.worse, baseline, one.min, one.max, one.mean);
    all.better += one.better;
    all.even += one.even;
    all.worse += one.worse;
  }
  finding.measured += ".";
  finding.verdict = verdict_of(all);
  if (finding.verdict != Verdict::holds)
    finding.why =
        "At these few light levels the two are within the noise of each other or the "
        "baseline gains from spreading its exposure over fewer, longer measurements.";
  return finding;
}

CheckedStatement second_bucket(const std::vector<ErrorSurfaceGroup>& panels) {
  CheckedStatement finding{
      .verdict = Verdict::holds,
      .statement = "The method extends to two-bucket sensors: K exposures give 2K values.",
      .measured =
          "K = 4 with one tap has this many times the error of two buckets, in the same "
          "total time: "};
  std::string factors;
  for (const ErrorSurfaceGroup& panel : panels) {
    const Comparison gain = compare(panel.of(paper_code), panel.of(one_tap));
    factors += fmt::format("{}{:.2f} to {:.2f}, {:.2f} on average ({})",
                           factors.empty() ? "" : "; ", gain.min, gain.max, gain.mean, panel.title);
    if (gain.worse > 0) finding.verdict = Verdict::in_part;
    if (gain.mean < 1.0) finding.verdict = Verdict::fails;
  }
  finding.measured += factors + ".";
  return finding;
}

}  // namespace

Reproduction reproduce_fig8(const ReproduceContext& context, const Progress& progress) {
  // 1. All codes on both cameras.
  std::vector<ErrorSurfaceGroup> panels;
  const ProgressParts parts(progress, fig8_limits_in_f0.size());
  for (std::size_t i = 0; i < fig8_limits_in_f0.size(); ++i)
    panels.push_back(measure(fig8_limits_in_f0[i], context, parts[i]));

  // 2. What the paper says.
  Reproduction result;
  result.findings = {beats(panels, dual_frequency,
                           "dual-frequency sinusoid (4 phases at f0, 4 at "
                           "7 f0, from 4 exposures)"),
                     beats(panels, single_frequency, "sinusoid (4 phases from 2 exposures)"),
                     second_bucket(panels)};

  // 3. The figures.
  double worst = 0.0;
  for (const ErrorSurfaceGroup& panel : panels)
    for (const ErrorSurface& surface : panel.surfaces)
      worst = std::max(worst, surface.worst_standard_error());
  result.sections.push_back(
      {"How it was measured",
       {Paragraph{fmt::format(
           "Both buckets of an exposure are read: demodulation d and 1 - d. Two phases of a "
           "sinusoid 180 degrees apart so come from one exposure, and 4 phases from two. All codes "
           "share 300 ms, split evenly over their own number of exposures: K = 3 to 6 for the "
           "Hamiltonian ones (6 to 12 values), 4 for the dual-frequency sinusoid, 2 for the "
           "sinusoid. p = {:g}, read noise 20 e for every value, albedo 1, linear error at each "
           "code's best origin; the largest standard error is {:.1f} % of its value.",
           fig8_peak_factor, 100 * worst)}}});
  std::vector<std::string> names;
  for (const ErrorSurface& surface : panels.front().surfaces) names.push_back(surface.name);
  result.sections.push_back(
      {"Side by side",
       {error_by_signal({.id = "slices",
                         .title = "Mean depth error by signal",
                         .caption = "Cuts through the surfaces at ambient light 10k e/s; bars are "
                                    "two standard errors."},
                        panels, names)}});
  std::vector<RatioMap> ratios;
  for (const std::string& baseline : {dual_frequency, single_frequency})
    for (const ErrorSurfaceGroup& panel : panels)
      ratios.push_back({fmt::format("{}, {}", baseline, panel.title),
                        panel.of(baseline).linear_m.cwiseQuotient(panel.of(paper_code).linear_m)});
  result.sections.back().blocks.push_back(
      ratio_heat_maps({.id = "ratios",
                       .title = "How many times better the redesigned code is",
                       .caption = "Linear error of a baseline over that of the redesigned K = 4 "
                                  "code. Below 1 the baseline wins."},
                      ratios, panels.front().surfaces.front(), 2));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const std::string id = fmt::format("{:g}f0", fig8_limits_in_f0[i]);
    result.sections.push_back(
        {panels[i].title,
         {surfaces_3d({.id = "surfaces-" + id,
                       .title = "Mean depth error over signal and ambient light",
                       .caption = "Linear error, all axes logarithmic; drag to turn, click a name "
                                  "to hide it. Lower is better."},
                      panels[i], {single_frequency, dual_frequency, paper_code}),
          error_heat_maps({.id = "values-" + id,
                           .title = "The values",
                           .caption = "Linear mean depth error (mm), each code at its best origin "
                                      "of depth."},
                          panels[i], names),
          geometric_mean_table("means-" + id,
                               "Geometric means over all light levels, and the linear error at "
                               "three of them: S = 3.16k (lo), 10k (mid) and 100k e/s (hi), A = "
                               "10k e/s. ± is one standard error. The best linear mean is marked.",
                               panels[i])}});
  }

  // 4. The numbers.
  for (std::size_t i = 0; i < panels.size(); ++i)
    add_arrays(result.arrays, fmt::format("{:g}f0", fig8_limits_in_f0[i]), panels[i]);
  result.files["surfaces.csv"] = surfaces_csv(panels);
  return result;
}

}  // namespace tofsmith
