// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/pair_panels.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "camera/shared/actual_code.hpp"
#include "design/factorize/shared/pair_model.hpp"
#include "paper/data_tables.hpp"
#include "report/shared/waveform_series.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/code/families.hpp"

namespace tofsmith {

namespace {

constexpr int kept_harmonics = 480;  // a Hann window leaves nothing beyond

}  // namespace

Eigen::VectorXd correlation_table(const WaveformPair& pair, const Camera& camera, int points) {
  const CorrelationFunction chi =
      camera.band_limited()
          ? CorrelationFunction(pair.demodulation, pair.modulation, camera.transfer(kept_harmonics))
          : CorrelationFunction(pair.demodulation, pair.modulation);
  return chi.table(points);
}

double residual_rms(const WaveformPair& pair, const CorrelationTarget& target,
                    const Camera& camera) {
  return PairModel(target, camera).residual_rms(pair);
}

WaveformPair centred(const WaveformPair& pair) {
  if (!pair.modulation.is_binary() || !pair.demodulation.is_binary()) return pair;
  const auto& on = pair.modulation.on_intervals();
  if (on.empty()) return pair;
  const auto longest = std::max_element(
      on.begin(), on.end(),
      [](const OnInterval& a, const OnInterval& b) { return a.fall - a.rise < b.fall - b.rise; });
  const double delay = 0.5 - 0.5 * (longest->rise + longest->fall);
  return {pair.modulation.delayed(delay), pair.demodulation.delayed(delay)};
}

std::vector<Series> correlation_series(const Eigen::VectorXd& correlation,
                                       const Eigen::VectorXd& target, double range_m,
                                       const LineStyle& style) {
  return {{.name = "correlation function",
           .x = axis_values(static_cast<int>(correlation.size()), range_m),
           .y = to_values(correlation),
           .period = range_m,
           .style = style},
          {.name = "target",
           .x = axis_values(static_cast<int>(target.size()), range_m),
           .y = to_values(target),
           .period = range_m,
           .style = reference_style()}};
}

PanelRow pair_row(std::string title, const WaveformPair& pair, const Camera& camera,
                  const Eigen::VectorXd& target, const LineStyle& style) {
  const double f0_hz = camera.fundamental_frequency_hz;
  return {.title = std::move(title),
          .panels = {arm_series(pair.modulation, pair.modulation, camera.light.impulse_response,
                                f0_hz, style),
                     arm_series(pair.demodulation, pair.demodulation,
                                camera.sensor.impulse_response, f0_hz, style),
                     correlation_series(correlation_table(pair, camera, curve_points), target,
                                        camera.range_m(), style)}};
}

void PairArrays::add(const WaveformPair& pair, const Camera& camera,
                     const Eigen::VectorXd& target) {
  const int samples = camera.samples;
  const double f0_hz = camera.fundamental_frequency_hz;
  rows_["modulation"].push_back(pair.modulation.cell_averages(samples));
  rows_["demodulation"].push_back(pair.demodulation.cell_averages(samples));
  rows_["modulation_output"].push_back(
      arm_output(pair.modulation, camera.light.impulse_response, f0_hz, samples));
  rows_["demodulation_output"].push_back(
      arm_output(pair.demodulation, camera.sensor.impulse_response, f0_hz, samples));
  rows_["correlation"].push_back(correlation_table(pair, camera, samples));
  rows_["target"].push_back(target);
}

void PairArrays::store(Reproduction& result, const std::string& prefix) const {
  for (const auto& [name, rows] : rows_) {
    Eigen::MatrixXd matrix(std::ssize(rows), rows.front().size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      matrix.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
    result.arrays[fmt::format("{}_{}", prefix, name)] = npy_of(matrix);
  }
}

std::string rms_text(double residual_rms) {
  return residual_rms < 1e-6 ? "0" : fmt::format("{:.4f}", residual_rms);
}

TargetSet ideal_targets(std::string_view family, const Camera& camera) {
  return targets_of(make_family(family, {.samples = camera.samples}));
}

}  // namespace tofsmith
