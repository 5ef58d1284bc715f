// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/waveform_series.hpp"
#include "reproduce/ablation.hpp"
#include "reproduce/code_styles.hpp"
#include "reproduce/figures.hpp"
#include "reproduce/pair_panels.hpp"

namespace tofsmith {

namespace {

constexpr double fig2_peak_factor = 15.0;
constexpr double fig2_f_max_in_f0 = 10.0;
const std::vector<std::string> families = {"hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5",
                                           "sinusoid-k4",    "square-k4",      "gray-k4"};

/// One impulse of unit mean power as modulation, the target itself as demodulation.
WaveformPair trivial_factorization(const CorrelationTarget& target) {
  return {rectangular_pulse(1.0 / static_cast<double>(target.samples.size())),
          Waveform::sampled(target.samples)};
}

/// What the peak limit leaves of it: the shortest pulse that may be played.
WaveformPair trivial_within_peak(const CorrelationTarget& target) {
  return {rectangular_pulse(1.0 / fig2_peak_factor), Waveform::sampled(target.samples)};
}

/// Largest residual of the trivial factorization over all targets of all families.
double worst_trivial_residual(const Camera& camera) {
  double worst = 0.0;
  for (const std::string& family : families)
    for (const CorrelationTarget& target : ideal_targets(family, camera).measurements)
      worst = std::max(worst, residual_rms(trivial_factorization(target), target, camera));
  return worst;
}

WaveformPair designed(const CorrelationTarget& target, const Camera& camera,
                      const ReproduceContext& context) {
  FactorizeOptions options;
  options.seed = context.options.seed;
  options.keep_naive = false;  // the search must find the answer by itself
  options.random_starts = context.pick(30, 10);
  return centred(factorize(target, camera, options).best().pair);
}

}  // namespace

Reproduction reproduce_fig2(const ReproduceContext& context, const Progress& progress) {
  Reproduction result;
  const Camera unlimited = paper_camera(fig2_peak_factor, 0);
  const Camera limited = paper_camera(fig2_peak_factor, fig2_f_max_in_f0);
  const LineStyle style = style_of_code("hamiltonian-k4");

  // 1. The target: a Hamiltonian correlation function, here K = 4, code 3.
  const CorrelationTarget target = ideal_targets("hamiltonian-k4", unlimited).measurements[2];
  const Eigen::VectorXd& chi = target.samples;

  // 2. Its trivial factorization: exact, and beyond any light source.
  const WaveformPair trivial = trivial_factorization(target);
  const double trivial_worst = worst_trivial_residual(unlimited);
  const double trivial_peak = trivial.modulation.peak();
  const double clipped_residual = residual_rms(trivial_within_peak(target), target, unlimited);

  // 3. Inputs designed within the peak, without and with a band limit.
  report(progress, 0.1, "fig2: factorizing");
  const WaveformPair free = designed(target, unlimited, context);
  const WaveformPair input = designed(target, limited, context);
  const double free_residual = residual_rms(free, target, unlimited);
  const double input_residual = residual_rms(input, target, limited);
  const double variation = std::sqrt((chi.array() - chi.mean()).square().mean());
  PairArrays pairs;
  pairs.add(trivial, unlimited, chi);
  pairs.add(free, unlimited, chi);
  pairs.add(input, limited, chi);
  pairs.store(result, "pairs");

  // 4. What the paper says of them.
  result.findings = {
      {trivial_worst < 1e-9 ? Verdict::holds : Verdict::fails,
       "Every target has a trivial factorization: an impulse as modulation, the target itself as "
       "demodulation.",
       fmt::format("Largest residual over the targets of {} families: {:.1e} rms.", families.size(),
                   trivial_worst),
       ""},
      {trivial_peak > fig2_peak_factor ? Verdict::holds : Verdict::fails,
       "The trivial factorization breaks the peak limit.",
       fmt::format("An impulse of unit mean power on N = {} samples has peak {:g}, {:.0f} times "
                   "p = {:g}. With the strongest pulse that p allows instead, the residual is "
                   "{:.3f} rms.",
                   chi.size(), trivial_peak, trivial_peak / fig2_peak_factor, fig2_peak_factor,
                   clipped_residual),
       "The peak grows with N: in continuous time it has no bound. The demodulation is not binary "
       "either."},
      {std::max(free.modulation.peak(), input.modulation.peak()) <= fig2_peak_factor + 1e-9 &&
               free_residual < clipped_residual && input_residual < 0.25 * variation &&
               input.modulation.is_binary() && input.demodulation.is_binary()
           ? Verdict::holds
           : Verdict::fails,
       "The designed functions keep the limits and approach the same target.",
       fmt::format("Peak {:.3g}, residual {} rms without a band limit; peak {:.3g}, residual "
                   "{:.4f} rms ({:.0f} % of the target's variation) at {:g} f0. Both binary: {}.",
                   free.modulation.peak(), rms_text(free_residual), input.modulation.peak(),
                   input_residual, 100 * input_residual / variation, fig2_f_max_in_f0,
                   input.modulation.is_binary() && input.demodulation.is_binary() ? "yes" : "no"),
       ""}};
  result.sections = {
      {"From a target to functions that can be played",
       {small_multiples(
            {.id = "trivial",
             .title = "Trivial factorization",
             .caption = fmt::format(
                 "K = 4, code 3. An impulse of height N = {} reads the demodulation out point by "
                 "point (it stands at time 0, the end of the period as well): the correlation "
                 "function is "
                 "the target, but no light source plays it.",
                 chi.size())},
            waveform_columns(), {pair_row("trivial", trivial, unlimited, chi, style)}),
        small_multiples(
            {.id = "designed",
             .title = "Designed functions",
             .caption = fmt::format(
                 "The same target with p = {:g}, without a band limit (problem 6, above) and at "
                 "{:g} f0 (problem 7, below). Thin: the input as told to the arms, binary. Thick: "
                 "the smoothed output that leaves them. Sharp corners of the target are lost "
                 "where the band ends.",
                 fig2_peak_factor, fig2_f_max_in_f0)},
            waveform_columns(),
            {pair_row("no limit", free, unlimited, chi, style),
             pair_row(fmt::format("{:g} f0", fig2_f_max_in_f0), input, limited, chi, style)}),
        Paragraph{"Rows of `pairs_*` in the data: trivial, no limit, 10 f0."}}}};

  // 5. The ablation of Sec. 5.1.
  report(progress, 0.5, "fig2: without total variation");
  add_total_variation_ablation(result, context);
  return result;
}

}  // namespace tofsmith
