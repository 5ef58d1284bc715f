// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/shared/periodic.hpp"
#include "design/factorize/shared/alternation.hpp"
#include "design/factorize/shared/start_pool.hpp"
#include "paper/code_styles.hpp"
#include "paper/context.hpp"
#include "paper/data_tables.hpp"
#include "paper/figures.hpp"
#include "paper/pair_panels.hpp"
#include "paper/reproduction.hpp"
#include "report/shared/waveform_series.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {
namespace {

constexpr double peak_factor = 15.0;
constexpr double weight = 3e-4;  // lambda, the first of the weights that the design takes in turn

/// Share of the samples within 1 % of `top` of either 0 or `top`.
double share_at_ends(const Eigen::VectorXd& x, double top) {
  const auto at_end = x.array() < 0.01 * top || x.array() > 0.99 * top;
  return static_cast<double>(at_end.count()) / static_cast<double>(x.size());
}

/// What stands in a row of the table: the median over starts of each.
struct PairShape {
  double modulation_variation = 0.0;  // in units of its maximum: 2 is a single pulse
  double demodulation_variation = 0.0;
  double modulation_share = 0.0;
  double demodulation_share = 0.0;
  double residual_rms = 0.0;
};

PairShape shape_of(const SampledPair& pair, double residual_rms) {
  const double top = pair.modulation.maxCoeff();
  return {circular_total_variation(pair.modulation) / top,
          circular_total_variation(pair.demodulation), share_at_ends(pair.modulation, top),
          share_at_ends(pair.demodulation, 1.0), residual_rms};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

PairShape median_shape(const std::vector<PairShape>& shapes) {
  const auto of = [&](double PairShape::*member) {
    std::vector<double> values;
    for (const PairShape& shape : shapes) values.push_back(shape.*member);
    return median(std::move(values));
  };
  return {of(&PairShape::modulation_variation), of(&PairShape::demodulation_variation),
          of(&PairShape::modulation_share), of(&PairShape::demodulation_share),
          of(&PairShape::residual_rms)};
}

/// The three variants on one target: medians over the starts, and what the first start gives.
struct Variants {
  PairShape without, with, projected;
  SampledPair first_without, first_with, first_projected;
};

Variants run_variants(const CorrelationTarget& target, const Camera& camera, std::uint64_t seed,
                      int starts) {
  const PairModel model(target, camera);
  CirculantTvSolver solver(camera.samples);
  FactorizeOptions options;
  options.max_iterations = 60;
  Variants variants;
  std::vector<PairShape> without, with, projected;
  for (int start = 0; start < starts; ++start) {
    const SampledPair begin = random_start(model, seed, start).pair;
    const AlternationResult free = alternate(model, begin, 0.0, options, solver);
    const AlternationResult held = alternate(model, begin, weight, options, solver);
    without.push_back(shape_of(free.relaxed, free.history.back().relaxed_residual_rms));
    with.push_back(shape_of(held.relaxed, held.history.back().relaxed_residual_rms));
    projected.push_back(shape_of(held.playable, held.playable_residual_rms));
    if (start == 0) {
      variants.first_without = free.relaxed;
      variants.first_with = held.relaxed;
      variants.first_projected = held.playable;
    }
  }
  variants.without = median_shape(without);
  variants.with = median_shape(with);
  variants.projected = median_shape(projected);
  return variants;
}

WaveformPair as_sampled(const SampledPair& pair) {
  return {Waveform::sampled(pair.modulation), Waveform::sampled(pair.demodulation)};
}

std::vector<std::string> table_row(const std::string& target, const std::string& variant,
                                   const PairShape& shape) {
  return {target,
          variant,
          fmt::format("{:.2f}", shape.modulation_variation),
          fmt::format("{:.0f} %", 100 * shape.modulation_share),
          fmt::format("{:.2f}", shape.demodulation_variation),
          fmt::format("{:.0f} %", 100 * shape.demodulation_share),
          rms_text(shape.residual_rms)};
}

std::vector<double> csv_row(const PairShape& shape) {
  return {shape.modulation_variation, shape.modulation_share, shape.demodulation_variation,
          shape.demodulation_share, shape.residual_rms};
}

/// Sec. 5.1: the alternation without total variation, with it, and projected to binary waveforms,
/// from the same random starts. Adds findings, a section and data.
void add_total_variation_ablation(Reproduction& result, const ReproduceContext& context) {
  struct Case {
    int order, code;
  };
  const Camera camera = paper_camera(peak_factor, 0);
  const int starts = context.pick(20, 6);
  Table table{.id = "variants",
              .caption = fmt::format(
                  "Medians over {} random starts, p = {:g}, no band limit. TV is the total "
                  "variation of a waveform over its maximum (one pulse: 2); at the ends means "
                  "within 1 % of 0 or of the maximum.",
                  starts, peak_factor),
              .columns = {{"target"},
                          {"variant"},
                          {"TV of m", true},
                          {"m at the ends", true},
                          {"TV of d", true},
                          {"d at the ends", true},
                          {"residual, rms", true}}};
  std::vector<std::string> row_names;
  std::vector<std::vector<double>> rows;
  bool modulation_fluctuates = true, demodulation_fluctuates = true, near_binary = true,
       binary = true;
  std::vector<std::string> without_text, with_text;
  std::vector<PanelRow> panels;
  PairArrays arrays;
  for (const Case& one : {Case{3, 1}, Case{4, 3}}) {
    const std::string name = fmt::format("hamiltonian-k{}", one.order);
    const std::string label = fmt::format("K = {}, code {}", one.order, one.code);
    const CorrelationTarget target =
        ideal_targets(name, camera).measurements[static_cast<std::size_t>(one.code - 1)];
    const Variants v = run_variants(target, camera, context.options.seed, starts);

    // Waveforms that wander have more variation than binary ones and fewer samples at the ends.
    modulation_fluctuates = modulation_fluctuates && v.without.modulation_variation >
                                                         1.25 * v.projected.modulation_variation;
    demodulation_fluctuates =
        demodulation_fluctuates &&
        v.without.demodulation_variation > 1.25 * v.projected.demodulation_variation;
    near_binary = near_binary && v.with.modulation_share >= 0.9 && v.with.demodulation_share >= 0.9;
    binary = binary && v.projected.modulation_share == 1.0 && v.projected.demodulation_share == 1.0;
    without_text.push_back(fmt::format(
        "{}: TV of m / max m {:.1f} ({:.1f} with TV, {:.1f} binary), of d {:.2f} ({:.2f}, {:.2f})",
        label, v.without.modulation_variation, v.with.modulation_variation,
        v.projected.modulation_variation, v.without.demodulation_variation,
        v.with.demodulation_variation, v.projected.demodulation_variation));
    with_text.push_back(fmt::format("{}: {:.0f} % of m, {:.0f} % of d", label,
                                    100 * v.with.modulation_share,
                                    100 * v.with.demodulation_share));
    const auto add = [&](const std::string& variant, const PairShape& shape) {
      table.rows.push_back(table_row(label, variant, shape));
      row_names.push_back(fmt::format("k{}-{} {}", one.order, one.code, variant));
      rows.push_back(csv_row(shape));
    };
    add("without TV", v.without);
    add("with TV", v.with);
    add("reprojected", v.projected);

    const LineStyle style = style_of_code(name);
    const auto draw = [&](const std::string& title, const SampledPair& pair) {
      const WaveformPair sampled = as_sampled(pair);
      if (one.order == 3) panels.push_back(pair_row(title, sampled, camera, target.samples, style));
      arrays.add(sampled, camera, target.samples);
    };
    draw("no TV", v.first_without);
    draw("TV", v.first_with);
    draw("binary", v.first_projected);
  }

  result.findings.push_back(
      {modulation_fluctuates && demodulation_fluctuates   ? Verdict::holds
       : modulation_fluctuates || demodulation_fluctuates ? Verdict::in_part
                                                          : Verdict::fails,
       "Without the total-variation term the solutions fluctuate (Sec. 5.1).",
       fmt::format("Medians over {} starts: {}; {}.", starts, without_text[0], without_text[1]),
       demodulation_fluctuates
           ? ""
           : "The modulation fluctuates. The demodulation does not: these targets run from 0 to 1, "
             "which only a gain at its bounds 0 and 1 can give, so the bounds alone make it "
             "binary."});
  result.findings.push_back(
      {near_binary ? Verdict::holds : Verdict::fails,
       "With the total-variation term they are near-binary.",
       fmt::format("Samples within 1 % of 0 or the maximum at lambda = {:g}: {}; {}.", weight,
                   with_text[0], with_text[1]),
       near_binary ? "" : "Edges that fall between samples and steps of the pulse remain."});
  result.findings.push_back({binary ? Verdict::holds : Verdict::fails,
                             "After reprojection they are binary.",
                             binary ? "Every sample of every start is 0 or the maximum."
                                    : "Some samples are neither 0 nor the maximum.",
                             ""});
  result.sections.push_back(
      {"What total variation and reprojection are for",
       {small_multiples(
            {.id = "ablation",
             .title = "One start, three variants",
             .caption = "K = 3, code 1: the last pair of the alternation without total variation, "
                        "with it, and its binary projection, from the same random waveforms. All "
                        "three correlation functions lie on the target; only the waveforms "
                        "differ. [[variants]] has the figures."},
            waveform_columns(), panels),
        table,
        Paragraph{"Rows of `ablation_*` in the data: without TV, with TV, reprojected; first "
                  "K = 3, then K = 4."}}});
  arrays.store(result, "ablation");
  result.files["ablation.csv"] =
      csv_text("variant", row_names,
               {"modulation_tv_over_max", "modulation_share_at_ends", "demodulation_tv",
                "demodulation_share_at_ends", "residual_rms"},
               rows);
}

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
                 "{:g} f0 (problem 7, below). Thin: the nominal input of the arms, binary. Thick: "
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
