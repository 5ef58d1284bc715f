// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "camera/shared/actual_code.hpp"
#include "paper/code_styles.hpp"
#include "paper/data_tables.hpp"
#include "paper/figures.hpp"
#include "paper/pair_panels.hpp"
#include "report/shared/waveform_series.hpp"

namespace tofsmith {

namespace {

constexpr double fig6_peak_factor = 15.0;
constexpr double fig6_f_max_in_f0 = 10.0;
constexpr int measurements = 5;

/// Largest change from one of 480 points of a period to the next, over the waveform's peak: 1 for
/// an edge.
double steepest_step(const Eigen::VectorXd& actual, double peak) {
  double steepest = 0.0;
  for (Eigen::Index n = 0; n < actual.size(); ++n)
    steepest = std::max(steepest, std::abs(actual[(n + 1) % actual.size()] - actual[n]));
  return steepest / peak;
}

/// One of the five codes: its pair and how smooth and how near the target it comes out.
struct DesignedCode {
  WaveformPair pair;
  double residual_rms = 0.0;
  double residual_share = 0.0;  // of the target's variation
  double coefficient = 0.0;     // between correlation function and target
  double contrast = 0.0;        // variation of the correlation function over the target's
  double steepest = 0.0;        // of both waveforms behind the arms
};

DesignedCode design_code(const CorrelationTarget& target, const Camera& camera,
                         const ReproduceContext& context, const Progress& progress) {
  FactorizeOptions options;
  options.seed = context.options.seed;
  options.random_starts = context.pick(30, 10);
  const Factorization found = factorize(target, camera, options, progress);
  DesignedCode code{.pair = centred(found.best().pair)};
  code.residual_rms = found.best().residual_rms;
  code.residual_share = code.residual_rms / found.target_variation_rms;
  const Eigen::VectorXd chi = correlation_table(code.pair, camera, camera.samples);
  const Eigen::VectorXd seen = chi.array() - chi.mean(),
                        wanted = target.samples.array() - target.samples.mean();
  code.coefficient = seen.dot(wanted) / (seen.norm() * wanted.norm());
  code.contrast = seen.norm() / wanted.norm();
  constexpr int points = 480;
  const double f0_hz = camera.fundamental_frequency_hz;
  const Eigen::VectorXd m = arm_output(code.pair.modulation, camera.light.impulse_response, f0_hz,
                                       points),
                        d = arm_output(code.pair.demodulation, camera.sensor.impulse_response,
                                       f0_hz, points);
  code.steepest = std::max(steepest_step(m, code.pair.modulation.peak()),
                           steepest_step(d, code.pair.demodulation.peak()));
  return code;
}

}  // namespace

Reproduction reproduce_fig6(const ReproduceContext& context, const Progress& progress) {
  Reproduction result;
  const Camera camera = paper_camera(fig6_peak_factor, fig6_f_max_in_f0);
  const TargetSet targets = ideal_targets("hamiltonian-k5", camera);

  // 1. All five correlation functions, factorized within the band limit.
  const ProgressParts parts(progress, measurements);
  std::vector<DesignedCode> codes;
  for (std::size_t i = 0; i < measurements; ++i) {
    report(parts[i], 0.0, "fig6: factorizing");
    codes.push_back(design_code(targets.measurements[i], camera, context, parts[i]));
  }

  // 2. Two of them: the slowest, and the fastest that still follows its target.
  constexpr std::array<std::size_t, 2> shown = {0, 2};
  const LineStyle style = style_of_code("hamiltonian-k5");
  std::vector<PanelRow> panels;
  for (const std::size_t i : shown) {
    const Eigen::VectorXd& target = targets.measurements[i].samples;
    panels.push_back(pair_row(fmt::format("code {}", i + 1), codes[i].pair, camera, target, style));
  }

  PairArrays arrays;
  bool binary = true;
  double steepest = 0.0;
  std::vector<std::vector<double>> rows;
  Table table{.id = "five",
              .caption =
                  "All five codes at p = 15 and 10 f0. The share is of the target's own "
                  "variation about its mean, the coefficient that of correlation with the "
                  "target, contrast the variation over the target's.",
              .columns = {{"code"},
                          {"residual, rms", true},
                          {"share", true},
                          {"coefficient", true},
                          {"contrast", true},
                          {"duty of m", true},
                          {"duty of d", true},
                          {"edges, m + d", true}}};
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const DesignedCode& code = codes[i];
    const auto& [m, d] = code.pair;
    binary = binary && m.is_binary() && d.is_binary();
    steepest = std::max(steepest, code.steepest);
    table.rows.push_back({fmt::format("{}", i + 1), fmt::format("{:.3f}", code.residual_rms),
                          fmt::format("{:.0f} %", 100 * code.residual_share),
                          fmt::format("{:.3f}", code.coefficient),
                          fmt::format("{:.2f}", code.contrast), fmt::format("{:.3f}", m.duty()),
                          fmt::format("{:.3f}", d.duty()),
                          fmt::format("{} + {}", m.edges(), d.edges())});
    rows.push_back({static_cast<double>(i + 1), code.residual_rms, code.residual_share,
                    code.coefficient, code.contrast, m.duty(), d.duty(), code.steepest});
    arrays.add(code.pair, camera, targets.measurements[i].samples);
  }
  arrays.store(result, "codes");

  // 3. What the paper says of them.
  bool alike = true, all_alike = true, all_contrast = true;
  std::vector<double> coefficients, contrasts;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const bool follows = codes[i].coefficient > 0.9;
    all_alike = all_alike && follows;
    alike = alike && (follows || std::ranges::find(shown, i) == shown.end());
    all_contrast = all_contrast && codes[i].contrast > 0.5;
    coefficients.push_back(codes[i].coefficient);
    contrasts.push_back(codes[i].contrast);
  }
  result.findings = {
      {binary ? Verdict::holds : Verdict::fails, "The inputs are binary.",
       fmt::format("All {} pairs are {}; modulation at peak {:.3g}, the limit being {:g}.",
                   codes.size(), binary ? "switching times" : "not all switching times",
                   codes[0].pair.modulation.peak(), fig6_peak_factor),
       ""},
      {steepest < 0.25 ? Verdict::holds : Verdict::fails,
       "The outputs, smoothed by the arms, are not.",
       fmt::format("From one of 480 points of the period to the next no output changes by more "
                   "than {:.0f} % of the input's peak; the inputs change by all of it.",
                   100 * steepest),
       ""},
      {all_alike && all_contrast ? Verdict::holds
       : alike                   ? Verdict::in_part
                                 : Verdict::fails,
       "The correlation functions of the smoothed outputs still resemble their targets.",
       fmt::format(
           "Code 1 to 5: correlation coefficient with the target {:.3f}; contrast {:.2f} of "
           "the target's.",
           fmt::join(coefficients, ", "), fmt::join(contrasts, ", ")),
       all_alike && all_contrast
           ? ""
           : "All keep the shape, but the fastest targets repeat at several times f0, where two "
             "arms of 10 f0 leave little contrast."}};
  result.sections = {
      {"Two K = 5 codes at 10 f0",
       {small_multiples(
            {.id = "codes",
             .title = "Inputs and outputs",
             .caption =
                 "Codes 1 and 3 of the Hamiltonian K = 5 set, redesigned for p = 15 and "
                 "10 f0. Thin: the nominal input of the arms, binary. Thick: what leaves them, "
                 "smooth. The correlation function follows its target, with rounded "
                 "corners."},
            waveform_columns(), panels),
        table}}};
  result.files["codes.csv"] =
      csv_text({"code", "residual_rms", "share_of_variation", "coefficient", "contrast",
                "modulation_duty", "demodulation_duty", "steepest_step"},
               rows);
  return result;
}

}  // namespace tofsmith
