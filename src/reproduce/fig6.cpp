// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reproduce/code_styles.hpp"
#include "reproduce/data_tables.hpp"
#include "reproduce/figures.hpp"
#include "reproduce/pair_panels.hpp"
#include "tofsmith/camera/played_waveform.hpp"

namespace tofsmith {

namespace {

constexpr double peak_factor = 15.0;
constexpr double f_max_in_f0 = 10.0;
constexpr int measurements = 5;

/// Largest change from one of 480 points of a period to the next, over the waveform's peak: 1 for
/// an edge.
double steepest_step(const Eigen::VectorXd& played, double peak) {
  double steepest = 0.0;
  for (Eigen::Index n = 0; n < played.size(); ++n)
    steepest = std::max(steepest, std::abs(played[(n + 1) % played.size()] - played[n]));
  return steepest / peak;
}

double correlation_coefficient(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd x = a.array() - a.mean(), y = b.array() - b.mean();
  return x.dot(y) / (x.norm() * y.norm());
}

/// One of the five codes: its pair and how smooth and how near the target it comes out.
struct DesignedCode {
  WaveformPair pair;
  double residual_rms = 0.0;
  double residual_share = 0.0;  // of the target's variation
  double coefficient = 0.0;     // between correlation function and target
  double steepest = 0.0;        // of both played waveforms
};

DesignedCode design_code(const CorrelationTarget& target, const Camera& camera,
                         const ReproduceContext& context) {
  FactorizeOptions options;
  options.seed = context.options.seed;
  options.random_starts = context.pick(30, 10);
  const Factorization found = factorize(target, camera, options);
  DesignedCode code{.pair = centred(found.best().pair)};
  code.residual_rms = found.best().residual_rms;
  code.residual_share = code.residual_rms / found.target_variation_rms;
  code.coefficient =
      correlation_coefficient(correlation_table(code.pair, camera, camera.samples), target.samples);
  constexpr int points = 480;
  const double f0_hz = camera.fundamental_frequency_hz;
  const Eigen::VectorXd m = played_waveform(code.pair.modulation, camera.light.impulse_response,
                                            f0_hz, points),
                        d = played_waveform(code.pair.demodulation, camera.sensor.impulse_response,
                                            f0_hz, points);
  code.steepest = std::max(steepest_step(m, code.pair.modulation.peak()),
                           steepest_step(d, code.pair.demodulation.peak()));
  return code;
}

}  // namespace

Reproduction reproduce_fig6(const ReproduceContext& context, const Progress& progress) {
  Reproduction result;
  const Camera camera = paper_camera(peak_factor, f_max_in_f0);
  const TargetSet targets = ideal_targets("hamiltonian-k5", camera);

  // 1. All five correlation functions, factorized within the band limit.
  std::vector<DesignedCode> codes;
  for (int i = 0; i < measurements; ++i) {
    report(progress, static_cast<double>(i) / measurements, "fig6: factorizing");
    codes.push_back(
        design_code(targets.measurements[static_cast<std::size_t>(i)], camera, context));
  }

  // 2. Two of them: the slowest, and the fastest that still follows its target.
  constexpr std::array<std::size_t, 2> shown = {0, 2};
  const LineStyle style = style_of_code("hamiltonian-k5");
  std::vector<PanelRow> panels;
  for (const std::size_t i : shown) {
    const Eigen::VectorXd& target = targets.measurements[i].samples;
    panels.push_back(pair_row(fmt::format("code {}", i + 1), codes[i].pair, camera, target, style));
  }

  bool binary = true;
  double steepest = 0.0, least_shown = 1.0;
  std::vector<std::vector<double>> rows;
  Table table{.id = "five",
              .caption =
                  "All five codes at p = 15 and 10 f0. The share is of the target's own "
                  "variation about its mean.",
              .columns = {{"code"},
                          {"residual, rms", true},
                          {"share", true},
                          {"coefficient with target", true},
                          {"duty of m", true},
                          {"duty of d", true},
                          {"edges of m + d", true},
                          {"steepest step", true}}};
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const DesignedCode& code = codes[i];
    const auto& [m, d] = code.pair;
    binary = binary && m.is_binary() && d.is_binary();
    steepest = std::max(steepest, code.steepest);
    if (std::ranges::find(shown, i) != shown.end())
      least_shown = std::min(least_shown, code.coefficient);
    table.rows.push_back({fmt::format("{}", i + 1), fmt::format("{:.3f}", code.residual_rms),
                          fmt::format("{:.0f} %", 100 * code.residual_share),
                          fmt::format("{:.3f}", code.coefficient), fmt::format("{:.3f}", m.duty()),
                          fmt::format("{:.3f}", d.duty()),
                          fmt::format("{} + {}", m.edges(), d.edges()),
                          fmt::format("{:.2f}", code.steepest)});
    rows.push_back({static_cast<double>(i + 1), code.residual_rms, code.residual_share,
                    code.coefficient, m.duty(), d.duty(), code.steepest});
    add_pair_arrays(result, fmt::format("code{}", i + 1), code.pair, camera,
                    targets.measurements[i].samples);
  }

  // 3. What the paper says of them.
  const double least = std::ranges::min_element(codes, {}, &DesignedCode::coefficient)->coefficient;
  result.findings = {
      {binary ? Verdict::holds : Verdict::fails, "The inputs are binary.",
       fmt::format("All {} pairs are {}; modulation at peak {:.3g}, the limit being {:g}.",
                   codes.size(), binary ? "switching times" : "not all switching times",
                   codes[0].pair.modulation.peak(), peak_factor),
       ""},
      {steepest < 0.25 ? Verdict::holds : Verdict::fails,
       "The outputs, smoothed by the arms, are not.",
       fmt::format("From one of 480 points of the period to the next no output changes by more "
                   "than {:.0f} % of the input's peak; the inputs change by all of it.",
                   100 * steepest),
       ""},
      {least > 0.9         ? Verdict::holds
       : least_shown > 0.9 ? Verdict::in_part
                           : Verdict::fails,
       "The correlation functions of the smoothed outputs still resemble their targets.",
       fmt::format("Correlation coefficients with the targets, code 1 to 5: {:.3f}, {:.3f}, "
                   "{:.3f}, {:.3f}, {:.3f}; residuals {:.3f}, {:.3f}, {:.3f}, {:.3f}, {:.3f} rms.",
                   codes[0].coefficient, codes[1].coefficient, codes[2].coefficient,
                   codes[3].coefficient, codes[4].coefficient, codes[0].residual_rms,
                   codes[1].residual_rms, codes[2].residual_rms, codes[3].residual_rms,
                   codes[4].residual_rms),
       least > 0.9 ? ""
                   : "The fastest targets repeat at up to 7 times f0, where two arms of 10 f0 "
                     "leave little contrast: no code can follow them in full."}};
  result.sections = {
      {"Two K = 5 codes at 10 f0",
       {small_multiples(
            {.id = "codes",
             .title = "Inputs and outputs",
             .caption = "Codes 1 and 3 of the Hamiltonian K = 5 set, redesigned for p = 15 and "
                        "10 f0. Thin: what the arms are told, binary. Thick: what leaves them, "
                        "smooth. The correlation function follows its target, with rounded "
                        "corners."},
            pair_columns(), panels),
        table}}};
  result.files["codes.csv"] = csv_text({"code", "residual_rms", "share_of_variation", "coefficient",
                                        "modulation_duty", "demodulation_duty", "steepest_step"},
                                       rows);
  return result;
}

}  // namespace tofsmith
