// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/waveform_parameters.hpp"

#include <algorithm>
#include <cmath>

#include "code/shared/on_intervals.hpp"
#include "design/exposure_shares.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

Eigen::ArrayXd logistic_of(const Eigen::ArrayXd& x) {
  return 1.0 / (1.0 + (-x.max(-500.0).min(500.0)).exp());
}

/// s(k (x - lambda)) with lambda such that the mean is `mean` in (0, 1), by safeguarded Newton.
Eigen::ArrayXd logistic_of_mean(const Eigen::ArrayXd& x, double steepness, double mean) {
  const double margin = (std::abs(std::log(mean / (1.0 - mean))) + 1.0) / steepness;
  double low = x.minCoeff() - margin, high = x.maxCoeff() + margin;
  double lambda = x.mean() - std::log(mean / (1.0 - mean)) / steepness;
  Eigen::ArrayXd value;
  for (int iteration = 0; iteration < 60; ++iteration) {
    value = logistic_of(steepness * (x - lambda));
    const double excess = value.mean() - mean;
    if (std::abs(excess) < 1e-12) break;
    (excess > 0.0 ? low : high) = lambda;
    const double slope = steepness * (value * (1.0 - value)).mean();
    const double step = slope > 0.0 ? excess / slope : 0.0;
    const double newton = lambda + step;
    lambda = newton > low && newton < high && slope > 1e-9 ? newton : 0.5 * (low + high);
    if (high - low < 1e-14 * (1.0 + std::abs(high))) break;
  }
  return value;
}

Eigen::VectorXd on_samples(const Eigen::ArrayXd& cells, int repeat) {
  Eigen::VectorXd samples(cells.size() * repeat);
  for (Eigen::Index c = 0; c < cells.size(); ++c)
    samples.segment(c * repeat, repeat).setConstant(cells[c]);
  return samples;
}

Eigen::ArrayXd sum_in_cells(const Eigen::VectorXd& samples, int repeat) {
  Eigen::ArrayXd cells(samples.size() / repeat);
  for (Eigen::Index c = 0; c < cells.size(); ++c)
    cells[c] = samples.segment(c * repeat, repeat).sum();
  return cells;
}

Eigen::ArrayXd mean_in_cells(const Eigen::VectorXd& samples, int repeat) {
  return sum_in_cells(samples, repeat) / repeat;
}

/// Adjoint of logistic_of_mean(); lambda depends on x.
Eigen::ArrayXd pull_back_of_mean(const Eigen::ArrayXd& value, double steepness,
                                 const Eigen::ArrayXd& gradient) {
  const Eigen::ArrayXd slope = value * (1.0 - value);
  const double total = slope.sum();
  const double mean = total > 1e-12 ? (slope * gradient).sum() / total : 0.0;
  return steepness * slope * (gradient - mean);
}

Eigen::ArrayXXd softmax(const Eigen::ArrayXXd& logits) {
  Eigen::ArrayXXd shares = (logits.colwise() - logits.rowwise().maxCoeff()).exp();
  const Eigen::ArrayXd sum = shares.rowwise().sum();
  return shares.colwise() / sum;
}

Waveform light_waveform(const SwitchedLabels& light) {
  return light.waveform(1, 1.0 / light.share(1));
}

}  // namespace

Eigen::ArrayXd first_samples(const Eigen::VectorXd& samples, int repeat) {
  Eigen::ArrayXd cells(samples.size() / repeat);
  for (Eigen::Index c = 0; c < cells.size(); ++c) cells[c] = samples[c * repeat];
  return cells;
}

Eigen::ArrayXXd class_shares(const WaveformSpace& space, const SampledCode& code, int e) {
  Eigen::ArrayXXd shares(space.cells, space.classes());
  for (int t = 0; t < space.taps; ++t)
    shares.col(t) = first_samples(code.demodulation.col(e * space.taps + t), space.repeat);
  if (space.drain) shares.col(space.taps) = 1.0 - shares.leftCols(space.taps).rowwise().sum();
  return shares;
}

SampledCode render(const WaveformSpace& space, const WaveformParameters& parameters,
                   const Sharpness& sharpness) {
  SampledCode code{Eigen::MatrixXd(space.samples(), space.exposures),
                   Eigen::MatrixXd(space.samples(), space.exposures * space.taps)};
  if (parameters.shares.size() > 0) code.shares = shares_of_logits(parameters.shares);
  const int columns = space.columns();
  for (int e = 0; e < space.exposures; ++e) {
    code.modulation.col(e) =
        space.peak_factor *
        on_samples(logistic_of_mean(parameters.modulation.col(e).array(), sharpness.modulation,
                                    1.0 / space.peak_factor),
                   space.repeat);
    if (columns == 1) {
      const Eigen::ArrayXd theta = parameters.demodulation.col(e).array();
      const Eigen::ArrayXd first = space.equal_duties
                                       ? logistic_of_mean(theta, sharpness.demodulation, 0.5)
                                       : logistic_of(sharpness.demodulation * theta);
      code.demodulation.col(e * space.taps) = on_samples(first, space.repeat);
      if (space.taps == 2)
        code.demodulation.col(e * space.taps + 1) = on_samples(1.0 - first, space.repeat);
      continue;
    }
    const Eigen::ArrayXXd shares = softmax(
        sharpness.demodulation * parameters.demodulation.middleCols(e * columns, columns).array());
    for (int t = 0; t < space.taps; ++t)
      code.demodulation.col(e * space.taps + t) = on_samples(shares.col(t), space.repeat);
  }
  return code;
}

WaveformParameters pull_back(const WaveformSpace& space, const SampledCode& code,
                             const Sharpness& sharpness, const SampledCode& gradient) {
  const int columns = space.columns(), taps = space.taps;
  WaveformParameters result{Eigen::MatrixXd(space.cells, space.exposures),
                            Eigen::MatrixXd(space.cells, space.exposures * columns)};
  if (code.shares.size() > 0) result.shares = pull_back_shares(code.shares, gradient.shares);
  const auto by_cell = [&](const Eigen::VectorXd& samples) {
    return sum_in_cells(samples, space.repeat);
  };
  for (int e = 0; e < space.exposures; ++e) {
    const double peak = space.peak_factor;
    const Eigen::ArrayXd level = first_samples(code.modulation.col(e), space.repeat) / peak;
    result.modulation.col(e) =
        pull_back_of_mean(level, sharpness.modulation, peak * by_cell(gradient.modulation.col(e)));
    if (columns == 1) {
      const Eigen::ArrayXd first = first_samples(code.demodulation.col(e * taps), space.repeat);
      Eigen::ArrayXd by_first = by_cell(gradient.demodulation.col(e * taps));
      if (taps == 2) by_first -= by_cell(gradient.demodulation.col(e * taps + 1));
      result.demodulation.col(e) = space.equal_duties
                                       ? pull_back_of_mean(first, sharpness.demodulation, by_first)
                                       : sharpness.demodulation * first * (1.0 - first) * by_first;
      continue;
    }
    const Eigen::ArrayXXd shares = class_shares(space, code, e);
    Eigen::ArrayXXd by_share = Eigen::ArrayXXd::Zero(space.cells, space.classes());
    for (int t = 0; t < taps; ++t)
      by_share.col(t) = by_cell(gradient.demodulation.col(e * taps + t));
    const Eigen::ArrayXd mean = (shares * by_share).rowwise().sum();
    result.demodulation.middleCols(e * columns, columns) =
        sharpness.demodulation * shares * (by_share.colwise() - mean);
  }
  return result;
}

WaveformParameters parameters_near(const WaveformSpace& space, const SampledCode& code,
                                   double scale) {
  const int columns = space.columns();
  const double gate_scale = columns == 1 ? scale : 0.5 * scale;
  WaveformParameters result{Eigen::MatrixXd(space.cells, space.exposures),
                            Eigen::MatrixXd(space.cells, space.exposures * columns)};
  for (int e = 0; e < space.exposures; ++e) {
    const Eigen::ArrayXd light = mean_in_cells(code.modulation.col(e), space.repeat);
    result.modulation.col(e) = scale * (2.0 * light / std::max(1e-12, light.maxCoeff()) - 1.0);
    Eigen::ArrayXd drained = Eigen::ArrayXd::Ones(space.cells);
    for (int t = 0; t < space.taps; ++t) {
      const Eigen::ArrayXd gain =
          mean_in_cells(code.demodulation.col(e * space.taps + t), space.repeat);
      drained -= gain;
      if (columns == 1 && t > 0) continue;
      result.demodulation.col(e * columns + t) = gate_scale * (2.0 * gain - 1.0);
    }
    if (columns > 1 && space.drain)
      result.demodulation.col(e * columns + space.taps) = gate_scale * (2.0 * drained - 1.0);
  }
  return result;
}

SwitchedLabels SwitchedLabels::from_cells(const std::vector<int>& cells) {
  SwitchedLabels labels;
  const std::size_t count = cells.size();
  for (std::size_t c = 0; c < count; ++c) {
    if (cells[c] == cells[(c + count - 1) % count]) continue;
    labels.at.push_back(static_cast<double>(c) / static_cast<double>(count));
    labels.label.push_back(cells[c]);
  }
  if (labels.label.empty()) labels.label.push_back(cells.front());
  return labels;
}

double SwitchedLabels::share(int wanted) const {
  if (at.empty()) return label[0] == wanted ? 1.0 : 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < runs(); ++i)
    if (label[i] == wanted) sum += length(i);
  return sum;
}

Waveform SwitchedLabels::waveform(int wanted, double level) const {
  if (at.empty()) return Waveform::constant(label[0] == wanted ? level : 0.0);
  std::vector<OnInterval> on;
  for (std::size_t i = 0; i < runs(); ++i) {
    if (label[i] != wanted) continue;
    const double rise = wrap(at[i], 1.0);
    on.push_back({rise, rise + length(i)});
  }
  if (on.empty()) return Waveform::constant(0.0);
  return Waveform::binary(within_period(std::move(on)), level);
}

SampledCode sampled_on(const WaveformSpace& space, const SwitchedCode& code) {
  SampledCode result = code.sampled;
  for (std::size_t e = 0; e < code.light.size(); ++e)
    result.modulation.col(static_cast<Eigen::Index>(e)) =
        light_waveform(code.light[e]).cell_averages(space.samples());
  for (std::size_t e = 0; e < code.gates.size(); ++e)
    for (int tap = 0; tap < space.taps; ++tap)
      result.demodulation.col(static_cast<Eigen::Index>(e) * space.taps + tap) =
          code.gates[e].waveform(tap, 1.0).cell_averages(space.samples());
  return result;
}

CodeSet code_set(const std::string& name, const WaveformSpace& space, const SwitchedCode& code,
                 int samples) {
  const auto resampled = [&](const Eigen::VectorXd& values) {
    return Waveform::sampled(Waveform::sampled(values).cell_averages(samples));
  };
  std::vector<Waveform> modulation, demodulation;
  for (int e = 0; e < space.exposures; ++e) {
    modulation.push_back(code.light.empty()
                             ? resampled(code.sampled.modulation.col(e))
                             : light_waveform(code.light[static_cast<std::size_t>(e)]));
    for (int tap = 0; tap < space.taps; ++tap)
      demodulation.push_back(code.gates.empty()
                                 ? resampled(code.sampled.demodulation.col(e * space.taps + tap))
                                 : code.gates[static_cast<std::size_t>(e)].waveform(tap, 1.0));
  }
  const Eigen::VectorXd& shares = code.sampled.shares;
  return CodeSet::create(name, samples, space.taps, std::move(modulation), std::move(demodulation))
      .with_exposure_shares({shares.begin(), shares.end()});
}

}  // namespace tofsmith
