// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "code/shared/hamiltonian.hpp"
#include "paper/code_styles.hpp"
#include "paper/data_tables.hpp"
#include "paper/figures.hpp"
#include "paper/pair_panels.hpp"
#include "report/shared/waveform_series.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

namespace {

const std::vector<double> peaks = {30, 15, 6, 5, 4, 3, 2};
const std::vector<double> peaks_between = {25, 20, 12, 10, 8};  // for the line over peak
const std::vector<int> orders = {3, 4, 5};
constexpr double zero_rms = 1e-6;

/// All codes of one K: solutions[code][peak] at the paper's peaks, residuals at others.
struct OrderResult {
  int order = 0;
  TargetSet targets;
  std::vector<std::vector<PairCandidate>> solutions;
  std::vector<double> between;                         // peaks
  std::vector<std::vector<double>> residuals_between;  // [code][peak]
  double variation_rms = 0.0;                          // of code 1's target about its mean

  std::string family() const { return fmt::format("hamiltonian-k{}", order); }
  double residual(std::size_t code, std::size_t peak) const {
    return solutions[code][peak].residual_rms;
  }
  double worst_residual(std::size_t peak) const {
    double worst = 0.0;
    for (std::size_t code = 0; code < solutions.size(); ++code)
      worst = std::max(worst, residual(code, peak));
    return worst;
  }
};

OrderResult factorize_order(int order, const ReproduceContext& context, const Progress& progress) {
  FactorizeOptions options;
  options.seed = context.options.seed;
  options.random_starts = context.pick(30, 12);
  options.refined = context.pick(16, 3);
  options.keep_naive = false;  // the search must find the answer by itself
  const Camera first = paper_camera(peaks[0], 0);
  OrderResult result{.order = order,
                     .targets = ideal_targets(fmt::format("hamiltonian-k{}", order), first)};
  result.between = context.pick(peaks_between, {12.0});
  const ProgressParts parts(progress, result.targets.measurements.size());
  for (const CorrelationTarget& target : result.targets.measurements) {
    const Progress of_target = parts[result.solutions.size()];
    report(of_target, 0.0, fmt::format("fig3: K = {}", order));
    const ProgressParts of_peaks(of_target, peaks.size() + result.between.size());
    std::size_t done = 0;
    const auto factorized = [&](double peak) {
      return factorize(target, paper_camera(peak, 0), options, of_peaks[done++]);
    };
    std::vector<PairCandidate> solutions;
    for (const double peak : peaks) {
      const Factorization found = factorized(peak);
      solutions.push_back(found.best());
      solutions.back().pair = centred(found.best().pair);
      if (result.solutions.empty()) result.variation_rms = found.target_variation_rms;
    }
    result.solutions.push_back(std::move(solutions));
    std::vector<double> residuals;
    for (const double peak : result.between)
      residuals.push_back(factorized(peak).best().residual_rms);
    result.residuals_between.push_back(std::move(residuals));
  }
  return result;
}

bool is_square(const Waveform& waveform) {
  return waveform.is_binary() && waveform.edges() == 2 && std::abs(waveform.duty() - 0.5) < 1e-6;
}

/// What the paper says of K = 3.
std::vector<CheckedStatement> statements_on_k3(const OrderResult& k3) {
  double worst_from_6 = 0.0, peak_used = 0.0, duty_low = 1.0, duty_high = 0.0;
  bool squares = true;
  std::vector<double> shares;
  bool grows = true;
  for (std::size_t p = 0; p < peaks.size(); ++p) {
    if (p > 0) grows = grows && k3.worst_residual(p) >= k3.worst_residual(p - 1) - zero_rms;
    if (peaks[p] < 6) shares.push_back(100 * k3.worst_residual(p) / k3.variation_rms);
    for (const auto& code : k3.solutions) {
      const WaveformPair& pair = code[p].pair;
      if (peaks[p] >= 6) {
        worst_from_6 = std::max(worst_from_6, code[p].residual_rms);
        peak_used = std::max(peak_used, pair.modulation.peak());
        duty_low = std::min(duty_low, pair.modulation.duty());
        duty_high = std::max(duty_high, pair.modulation.duty());
      }
      if (peaks[p] == 2)
        squares = squares && is_square(pair.modulation) && is_square(pair.demodulation);
    }
  }
  // Slowly: with half the peak that zero error needs, less than a third of the variation is lost.
  const bool slowly = grows && shares[2] < 100.0 / 3.0;
  return {
      {worst_from_6 < zero_rms ? Verdict::holds : Verdict::fails,
       "K = 3: zero error from p = 6 on.",
       fmt::format("Largest residual of all three codes at p = 30, 15 and 6: {:.1e} rms.",
                   worst_from_6),
       ""},
      {std::abs(peak_used - 6) < 1e-6 && duty_high - duty_low < 1e-6 ? Verdict::holds
                                                                     : Verdict::fails,
       "Even where p = 30 is allowed, only a peak of 6 is used.",
       fmt::format("Largest peak {:.4f}; duty between {:.4f} and {:.4f} (1/6 = 0.1667).", peak_used,
                   duty_low, duty_high),
       ""},
      {squares ? Verdict::holds : Verdict::fails, "At p = 2 both functions are squares.",
       squares ? fmt::format("One pulse of duty 1/2 on both arms in all three codes; residual "
                             "{:.4f} rms.",
                             k3.worst_residual(peaks.size() - 1))
               : "Some are not.",
       ""},
      {slowly  ? Verdict::holds
       : grows ? Verdict::in_part
               : Verdict::fails,
       "Below p = 6 the error grows slowly.",
       fmt::format("{:.0f}, {:.0f}, {:.0f} and {:.0f} % of the target's variation (rms) at p = 5, "
                   "4, 3 and 2.",
                   shares[0], shares[1], shares[2], shares[3]),
       "Slowly is taken as: at half the peak that zero error needs, less than a third of the "
       "variation is lost."}};
}

/// And of K = 4 and 5, in the supplement.
CheckedStatement statement_on_supplement(const std::vector<OrderResult>& all) {
  bool holds = true;
  std::vector<std::string> lines;
  for (const OrderResult& one : all) {
    const int length = hamiltonian_length(one.order);
    std::vector<std::string> residuals;
    for (std::size_t p = 0; p < peaks.size(); ++p) {
      const bool zero = one.worst_residual(p) < zero_rms;
      holds = holds && zero == (peaks[p] >= length);
      residuals.push_back(zero ? "0" : fmt::format("{:.3f}", one.worst_residual(p)));
    }
    for (std::size_t p = 0; p < one.between.size(); ++p) {
      double worst = 0.0;
      for (const auto& residuals : one.residuals_between) worst = std::max(worst, residuals[p]);
      holds = holds && (worst < zero_rms) == (one.between[p] >= length);
    }
    if (one.order > 3)
      lines.push_back(
          fmt::format("K = {} (L = {}): {}", one.order, length, fmt::join(residuals, ", ")));
  }
  return {holds ? Verdict::holds : Verdict::fails,
          "K = 4 and 5 behave alike (supplement): zero error while p reaches what the code needs, "
          "gradual loss below.",
          fmt::format("Largest residual (rms) at p = {:g}: {}. Zero where p >= L, the length of "
                      "the code's walk, and only there: {}.",
                      fmt::join(peaks, ", "), fmt::join(lines, "; "), holds ? "yes" : "no"),
          ""};
}

Figure waveforms_of_k3(const OrderResult& k3) {
  std::vector<PanelRow> rows;
  for (std::size_t p = 0; p < peaks.size(); ++p)
    rows.push_back(pair_row(fmt::format("p = {:g}", peaks[p]), k3.solutions[0][p].pair,
                            paper_camera(peaks[p], 0), k3.targets.measurements[0].samples,
                            style_of_code(k3.family())));
  return small_multiples(
      {.id = "k3",
       .title = "K = 3, code 1, at falling peak",
       .caption = "From p = 30 down to 6 nothing changes: a pulse of height 6 gives the target "
                  "exactly. Below, the pulse widens and the flanks of the correlation function "
                  "lean, until square meets square at p = 2."},
      waveform_columns(), rows);
}

Figure correlations_of(const OrderResult& one) {
  constexpr std::array<std::size_t, 3> shown = {1, 3, 6};  // p = 15, 5, 2
  std::vector<PanelColumn> columns;
  for (const std::size_t p : shown)
    columns.push_back({.title = fmt::format("p = {:g}", peaks[p]),
                       .x = {.label = "depth", .unit = "m"},
                       .y = {.label = "chi", .from_zero = true}});
  std::vector<PanelRow> rows;
  for (std::size_t code = 0; code < one.solutions.size(); ++code) {
    PanelRow row{.title = fmt::format("{}", code + 1)};
    for (const std::size_t p : shown) {
      const Camera camera = paper_camera(peaks[p], 0);
      row.panels.push_back(correlation_series(
          correlation_table(one.solutions[code][p].pair, camera, 480),
          one.targets.measurements[code].samples, camera.range_m(), style_of_code(one.family())));
    }
    rows.push_back(std::move(row));
  }
  return small_multiples(
      {.id = fmt::format("k{}", one.order),
       .title = fmt::format("K = {}: correlation functions of all codes", one.order),
       .caption =
           "Each row is a code. As the peak falls the flat tops shrink, those of fast targets "
           "first, until square meets square: at p = 2 each is a wave of triangles with the "
           "target's own number of periods, or near it."},
      columns, rows);
}

Figure residual_figure(const std::vector<OrderResult>& all) {
  static constexpr std::array dashes = {Dash::solid, Dash::solid, Dash::dash, Dash::dash_dot,
                                        Dash::dot};
  std::vector<Series> series;
  for (const OrderResult& one : all)
    for (std::size_t code = 0; code < one.solutions.size(); ++code) {
      Series curve{.name = fmt::format("K = {}, code {}", one.order, code + 1),
                   .mark = Mark::line_and_markers,
                   .style = style_of_code(one.family())};
      curve.style.dash = dashes[code];
      std::map<double, double> by_peak;
      for (std::size_t p = 0; p < peaks.size(); ++p) by_peak[peaks[p]] = one.residual(code, p);
      for (std::size_t p = 0; p < one.between.size(); ++p)
        by_peak[one.between[p]] = one.residuals_between[code][p];
      for (const auto& [peak, residual] : by_peak) {
        curve.x.push_back(peak);
        curve.y.push_back(residual);
      }
      // The codes of one K that are each other's shifts and mirrors lie on one line.
      const bool drawn = std::ranges::any_of(series, [&](const Series& other) {
        if (other.style.colour != curve.style.colour) return false;
        for (std::size_t p = 0; p < curve.y.size(); ++p)
          if (std::abs(other.y[p] - curve.y[p]) > 2e-3) return false;
        return true;
      });
      if (!drawn) series.push_back(std::move(curve));
    }
  return line_figure(
      {.id = "residuals",
       .title = "Residual over peak",
       .caption = "One line per code; codes whose line would cover another's (shifts and mirror "
                  "images) are left out. Each K reaches zero where p meets the length of its "
                  "walk, 6, 12 and 30."},
      series, {.label = "peak factor p", .logarithmic = true},
      {.label = "residual, rms of chi", .from_zero = true});
}

Table residual_table(const std::vector<OrderResult>& all) {
  Table table{.id = "table",
              .caption = "Residuals (rms of chi) of every code; 0 means below 1e-6.",
              .columns = {{"code"}}};
  for (const double peak : peaks) table.columns.push_back({fmt::format("p = {:g}", peak), true});
  for (const OrderResult& one : all)
    for (std::size_t code = 0; code < one.solutions.size(); ++code) {
      std::vector<std::string> row = {fmt::format("K = {}, code {}", one.order, code + 1)};
      for (std::size_t p = 0; p < peaks.size(); ++p) row.push_back(rms_text(one.residual(code, p)));
      table.rows.push_back(std::move(row));
    }
  return table;
}

/// Residuals as CSV and NPZ (code, peak), and the waveforms of K = 3, code 1 (peak, N).
void add_data(Reproduction& result, const std::vector<OrderResult>& all) {
  std::vector<std::vector<double>> rows;
  for (const OrderResult& one : all) {
    Eigen::MatrixXd residuals(std::ssize(one.solutions), std::ssize(peaks));
    for (std::size_t code = 0; code < one.solutions.size(); ++code)
      for (std::size_t p = 0; p < peaks.size(); ++p) {
        const PairCandidate& found = one.solutions[code][p];
        residuals(static_cast<Eigen::Index>(code), static_cast<Eigen::Index>(p)) =
            found.residual_rms;
        rows.push_back({static_cast<double>(one.order), static_cast<double>(code + 1), peaks[p],
                        found.residual_rms, found.pair.modulation.peak(),
                        found.pair.modulation.duty(), found.pair.demodulation.duty()});
      }
    result.arrays[fmt::format("residuals_k{}", one.order)] = npy_of(residuals);
  }
  result.arrays["peaks"] = npy_of(peaks);
  const OrderResult& k3 = all.front();
  PairArrays pairs;
  for (std::size_t p = 0; p < peaks.size(); ++p)
    pairs.add(k3.solutions[0][p].pair, paper_camera(peaks[p], 0),
              k3.targets.measurements[0].samples);
  pairs.store(result, "k3_code1");
  result.files["residuals.csv"] = csv_text(
      {"K", "code", "p", "residual_rms", "modulation_peak", "modulation_duty", "demodulation_duty"},
      rows);
}

}  // namespace

Reproduction reproduce_fig3(const ReproduceContext& context, const Progress& progress) {
  // 1. Every code of K = 3, 4, 5, factorized without a band limit at falling peak.
  const ProgressParts parts(progress, orders.size());
  std::vector<OrderResult> all;
  for (std::size_t i = 0; i < orders.size(); ++i)
    all.push_back(factorize_order(orders[i], context, parts[i]));

  // 2. What the paper says of them.
  Reproduction result;
  result.findings = statements_on_k3(all[0]);
  result.findings.push_back(statement_on_supplement(all));

  // 3. Waveforms of K = 3, residuals of all, correlation functions of K = 4 and 5.
  result.sections = {
      {"K = 3 at p = 30, 15, 6, 5, 4, 3, 2", {waveforms_of_k3(all[0])}},
      {"Residuals of K = 3, 4, 5", {residual_figure(all), residual_table(all)}},
      {"K = 4 and 5, as in the supplement", {correlations_of(all[1]), correlations_of(all[2])}}};
  add_data(result, all);
  return result;
}

}  // namespace tofsmith
