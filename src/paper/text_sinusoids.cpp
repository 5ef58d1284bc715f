// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "paper/code_styles.hpp"
#include "paper/data_tables.hpp"
#include "paper/text_statements.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

namespace {

const std::vector<int> phase_steps = {3, 4, 5, 6, 7, 8};
constexpr double sinusoid_ambient_e_per_s = 1e4;

/// Circular depth error of sinusoids of every K, at one light level and read noise.
struct Curve {
  double signal_e_per_s, read_noise_e;
  std::vector<double> mde_m, standard_error_m, cramer_rao_m;

  /// Largest over smallest.
  static double spread(const std::vector<double>& values) {
    return std::ranges::max(values) / std::ranges::min(values);
  }
  /// Largest distance from the mean, in standard errors.
  double deviation() const {
    double mean = 0.0, worst = 0.0;
    for (const double value : mde_m) mean += value / static_cast<double>(mde_m.size());
    for (std::size_t i = 0; i < mde_m.size(); ++i)
      worst = std::max(worst, std::abs(mde_m[i] - mean) / standard_error_m[i]);
    return worst;
  }
};

Curve evaluate_all(double signal_e_per_s, double read_noise_e, const ReproduceContext& context) {
  Camera camera = paper_camera(30, 0);
  camera.sensor.read_noise_e = read_noise_e;
  camera.operating.signal_e_per_s = {signal_e_per_s};
  camera.operating.ambient_e_per_s = {sinusoid_ambient_e_per_s};
  Curve curve{signal_e_per_s, read_noise_e, {}, {}, {}};
  for (const int steps : phase_steps) {
    const DepthErrorReport found =
        evaluate(build_family(fmt::format("sinusoid-k{}", steps), camera), camera,
                 {.trials = context.pick(400'000, 20'000), .seed = context.options.seed});
    curve.mde_m.push_back(found.points[0].circular_mde_m.value);
    curve.standard_error_m.push_back(found.points[0].circular_mde_m.standard_error);
    curve.cramer_rao_m.push_back(found.points[0].cramer_rao_mae_m);
  }
  return curve;
}

}  // namespace

void add_sinusoids_of_any_k(Reproduction& result, const ReproduceContext& context,
                            const Progress& progress) {
  report(progress, 0.0, "text: sinusoids of any K");
  std::vector<Curve> curves;
  for (const double signal : {1e5, 1e4})
    for (const double noise : {0.0, 20.0}) curves.push_back(evaluate_all(signal, noise, context));

  std::vector<Series> series;
  std::vector<std::vector<double>> rows;
  for (const Curve& curve : curves) {
    Series drawn{.name = fmt::format("S = 1e{:.0f} e/s, read noise {:g} e ({:.1f} mm)",
                                     std::log10(curve.signal_e_per_s), curve.read_noise_e,
                                     curve.mde_m[0] * 1e3),
                 .mark = Mark::line_and_markers,
                 .style = style_of_code("sinusoid")};
    // The code is one and the same: light level and read noise differ in dash alone.
    drawn.style.dash = curve.signal_e_per_s > 5e4
                           ? (curve.read_noise_e > 0 ? Dash::dash : Dash::solid)
                           : (curve.read_noise_e > 0 ? Dash::dot : Dash::dash_dot);
    for (std::size_t i = 0; i < phase_steps.size(); ++i) {
      drawn.x.push_back(phase_steps[i]);
      drawn.y.push_back(curve.mde_m[i] / curve.mde_m[0]);
      drawn.y_error.push_back(curve.standard_error_m[i] / curve.mde_m[0]);
      rows.push_back({curve.signal_e_per_s, sinusoid_ambient_e_per_s, curve.read_noise_e,
                      static_cast<double>(phase_steps[i]), curve.mde_m[i],
                      curve.standard_error_m[i], curve.cramer_rao_m[i]});
    }
    series.push_back(std::move(drawn));
  }

  const Curve &quiet = curves[0], &noisy = curves[1], &dim_quiet = curves[2], &dim = curves[3];
  const bool equal_without =
      Curve::spread(quiet.mde_m) < 1.03 && Curve::spread(dim_quiet.mde_m) < 1.03;
  const bool equal_with = Curve::spread(noisy.mde_m) < 1.02 && Curve::spread(dim.mde_m) < 1.02;
  const auto percent = [](const std::vector<double>& values) {
    return 100 * (Curve::spread(values) - 1);
  };
  result.findings.push_back(
      {equal_without && equal_with ? Verdict::holds
       : equal_without             ? Verdict::in_part
                                   : Verdict::fails,
       "At a fixed total time, sinusoids perform alike for every K (footnote 3).",
       fmt::format(
           "K = 3 to 8 differ by {:.1f} % at S = 1e5 e/s without read noise (within {:.1f} "
           "standard errors of their mean; their Cramer-Rao bounds by {:.1f} %) and by {:.1f} % at "
           "1e4; with read noise of 20 e by {:.0f} % at S = 1e5 and by {:.0f} % at 1e4, larger K "
           "being worse.",
           percent(quiet.mde_m), quiet.deviation(), percent(quiet.cramer_rao_m),
           percent(dim_quiet.mde_m), percent(noisy.mde_m), percent(dim.mde_m)),
       equal_with ? ""
                  : "Read noise comes with every readout: K of them in the same time add K times "
                    "its variance. Only shot noise does not care how the time is split."});
  result.sections.push_back(
      {"Sinusoids of any K at a fixed total time",
       {line_figure({.id = "sinusoids",
                     .title = "Depth error over K",
                     .caption = fmt::format(
                         "Circular mean depth error of K-step sinusoids over that of K = 3, which "
                         "the legend "
                         "gives, with T = 300 ms in all, A = 1e{:.0f} e/s, and standard errors. "
                         "Flat without "
                         "read noise, rising with it, the more so the less light there is.",
                         std::log10(sinusoid_ambient_e_per_s))},
                    series, {.label = "measurements K", .unit = ""},
                    {.label = "mean depth error / that of K = 3", .unit = ""})}});
  result.files["sinusoids.csv"] =
      csv_text({"signal_e_per_s", "ambient_e_per_s", "read_noise_e", "K", "circular_mde_m",
                "standard_error_m", "cramer_rao_mae_m"},
               rows);
}

}  // namespace tofsmith
