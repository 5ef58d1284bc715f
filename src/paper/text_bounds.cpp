// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/shared/actual_code.hpp"
#include "paper/data_tables.hpp"
#include "paper/pair_panels.hpp"
#include "paper/text_statements.hpp"

namespace tofsmith {

namespace {

// Smoothing sums a Fourier series; what may be missing at its end.
constexpr double series_end = 1e-6;

/// What smoothing makes of the bounds and means of a code's waveforms.
struct OutputBounds {
  double modulation_low = 0.0, modulation_high = 0.0;
  double demodulation_low = 0.0, demodulation_high = 0.0;
  double largest_change_of_mean = 0.0;
};

OutputBounds output_bounds(const CodeSet& code, const Camera& camera) {
  constexpr int points = 2400;
  constexpr double far = 1e300;
  OutputBounds bounds{far, -far, far, -far, 0.0};
  const auto add = [&](const Waveform& nominal, const ImpulseResponse& response, double& low,
                       double& high) {
    const Eigen::VectorXd actual =
        arm_output(nominal, response, camera.fundamental_frequency_hz, points);
    low = std::min(low, actual.minCoeff());
    high = std::max(high, actual.maxCoeff());
    bounds.largest_change_of_mean =
        std::max(bounds.largest_change_of_mean, std::abs(actual.mean() - nominal.mean()));
  };
  for (int i = 0; i < code.measurements(); ++i) {
    add(code.modulation_of(i), camera.light.impulse_response, bounds.modulation_low,
        bounds.modulation_high);
    add(code.demodulation(i), camera.sensor.impulse_response, bounds.demodulation_low,
        bounds.demodulation_high);
  }
  return bounds;
}

}  // namespace

void add_kept_bounds(Reproduction& result, const ReproduceContext& context,
                     const Progress& progress) {
  const std::vector<Camera> cameras = {paper_camera(15, 10), paper_camera(15, 5)};
  const std::vector<int> orders = {3, 4, 5};
  Table table{.id = "bounds",
              .caption =
                  "Extremes of what leaves the arms, over all measurements of a redesigned "
                  "code. Allowed: power 0 to p = 15, gain 0 to 1.",
              .columns = {{"camera"},
                          {"code"},
                          {"input peak", true},
                          {"m, least", true},
                          {"m, most", true},
                          {"d, least", true},
                          {"d, most", true}}};
  std::vector<std::string> row_names;
  std::vector<std::vector<double>> rows;
  double excess = 0.0, change_of_mean = 0.0;
  const ProgressParts parts(progress, cameras.size() * orders.size());
  std::size_t done = 0;
  for (const Camera& camera : cameras)
    for (const int order : orders) {
      const CodeSet& code = context.shelf.redesigned(order, camera, context.options, parts[done++]);
      const OutputBounds b = output_bounds(code, camera);
      excess = std::max({excess, -b.modulation_low, b.modulation_high - camera.light.peak_factor,
                         -b.demodulation_low, b.demodulation_high - 1.0});
      change_of_mean = std::max(change_of_mean, b.largest_change_of_mean);
      table.rows.push_back(
          {camera.name, code.name(), fmt::format("{:.3f}", code.peak()),
           fmt::format("{:.4f}", b.modulation_low > -5e-5 ? std::max(0.0, b.modulation_low)
                                                          : b.modulation_low),
           fmt::format("{:.4f}", b.modulation_high),
           fmt::format("{:.4f}", b.demodulation_low > -5e-5 ? std::max(0.0, b.demodulation_low)
                                                            : b.demodulation_low),
           fmt::format("{:.4f}", b.demodulation_high)});
      row_names.push_back(fmt::format("{} {}", camera.name, code.name()));
      rows.push_back({code.peak(), b.modulation_low, b.modulation_high, b.demodulation_low,
                      b.demodulation_high, b.largest_change_of_mean});
    }
  const bool holds = excess <= series_end && change_of_mean <= series_end;
  result.findings.push_back(
      {holds ? Verdict::holds : Verdict::fails,
       "The output functions keep the bounds of the input functions (Sec. 6.1).",
       fmt::format(
           "{} redesigned codes: largest excess over [0, p] and [0, 1] {:.0e}, largest "
           "change of a mean {:.0e} (what a Fourier series cut off at its end leaves is below "
           "{:.0e}).",
           rows.size(), excess, change_of_mean, series_end),
       "So it must be: smoothing by a Hann window, which is nowhere negative and sums to 1, takes "
       "weighted means."});
  result.sections.push_back({"Bounds of the output functions", {table}});
  result.files["bounds.csv"] = csv_text("code", row_names,
                                        {"input_peak", "modulation_low", "modulation_high",
                                         "demodulation_low", "demodulation_high", "change_of_mean"},
                                        rows);
}

void add_zero_error_at_p30(Reproduction& result, const ReproduceContext& context,
                           const Progress& progress) {
  const Camera camera = paper_camera(30, 0);
  FactorizeOptions options;
  options.seed = context.options.seed;
  options.random_starts = context.pick(30, 12);
  options.keep_naive = false;
  Table table{.id = "p30",
              .caption =
                  "p = 30, no band limit: residual of the worst measurement, and the "
                  "largest peak used.",
              .columns = {{"scheme"}, {"from"}, {"residual, rms", true}, {"peak used", true}}};
  double worst = 0.0;
  const auto add = [&](const std::string& scheme, const std::string& from, double residual,
                       double peak) {
    worst = std::max(worst, residual);
    table.rows.push_back(
        {scheme, from, fmt::format("{:.1e}", residual), fmt::format("{:.3g}", peak)});
  };

  // Hamiltonian codes are factorized; the search does not know the answer.
  const ProgressParts parts(progress, 3);
  for (const std::size_t order : {3, 4, 5}) {
    const Progress part = parts[order - 3];
    report(part, 0.0, "text: p = 30");
    double residual = 0.0, peak = 0.0;
    const std::string family = fmt::format("hamiltonian-k{}", order);
    const ProgressParts of_targets(part, order);
    std::size_t done = 0;
    for (const CorrelationTarget& target : ideal_targets(family, camera).measurements) {
      const Factorization found = factorize(target, camera, options, of_targets[done++]);
      residual = std::max(residual, found.best().residual_rms);
      peak = std::max(peak, found.best().pair.modulation.peak());
    }
    add(family, "factorized", residual, peak);
  }
  // The others are played as they are: their own waveforms have their correlation functions.
  for (const std::string family : {"sinusoid-k4", "square-k4", "multifrequency-k5"}) {
    const CodeSet code = build_family(family, camera);
    const TargetSet targets = ideal_targets(family, camera);
    double residual = 0.0;
    for (int i = 0; i < code.measurements(); ++i) {
      const Eigen::VectorXd& target = targets.measurements[static_cast<std::size_t>(i)].samples;
      const auto bins = static_cast<int>(target.size());
      const Eigen::VectorXd own =
          correlation_table({code.modulation_of(i), code.demodulation(i)}, camera, bins);
      residual = std::max(residual, (own - target).norm() / std::sqrt(static_cast<double>(bins)));
    }
    add(family, "own waveforms", residual, code.peak());
  }
  result.findings.push_back({worst < 1e-6 ? Verdict::holds : Verdict::fails,
                             "At p = 30 without a band limit every scheme factorizes with zero "
                             "error (Fig. 4a).",
                             fmt::format("Largest residual of six schemes: {:.1e} rms.", worst),
                             ""});
  result.sections.push_back({"Zero error at p = 30", {table}});
}

}  // namespace tofsmith
