// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/response_spectrum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "core/shared/periodic.hpp"

namespace tofsmith {
namespace {

using std::numbers::pi;

/// Sum of h[i] exp(-2 pi j f t_i), with t from the first value.
std::complex<double> transform_at(const ResponseWindow& window, double frequency_hz) {
  const std::complex<double> turn = std::polar(1.0, -2 * pi * frequency_hz * window.time_step_s);
  std::complex<double> sum = 0.0;
  for (Eigen::Index i = window.values.size() - 1; i >= 0; --i) sum = sum * turn + window.values[i];
  return sum;
}

/// Transfer of a difference, which averages the derivative over one step.
double differencing(const ResponseWindow& window, double frequency_hz) {
  const double x = pi * frequency_hz * window.time_step_s;
  return !window.differentiated || x == 0.0 ? 1.0 : std::sin(x) / x;
}

double gain_at(const ResponseWindow& window, double frequency_hz) {
  return std::abs(transform_at(window, frequency_hz)) / window.values.sum() /
         differencing(window, frequency_hz);
}

/// Standard deviation of gain_at() by first-order propagation.
double gain_error_at(const ResponseWindow& window, double frequency_hz) {
  const Eigen::Index count = window.values.size();
  const std::complex<double> value = transform_at(window, frequency_hz);
  const double total = window.values.sum(), gain = std::abs(value) / total;
  Eigen::VectorXd slope(count);  // derivative of the gain by each value
  for (Eigen::Index i = 0; i < count; ++i) {
    const double phase = -2 * pi * frequency_hz * window.time_step_s * static_cast<double>(i);
    slope[i] =
        ((std::conj(value) * std::polar(1.0, phase)).real() / std::abs(value) - gain) / total;
  }
  double variance = 0.0;
  if (!window.differentiated) {
    variance = (slope.array().square() * window.variance.array()).sum() +
               std::pow(slope.sum(), 2) * window.background_variance;
  } else {
    for (Eigen::Index i = 0; i + 1 < count; ++i)
      variance += std::pow(slope[i] - slope[i + 1], 2) * window.variance[i];
  }
  return std::sqrt(variance) / differencing(window, frequency_hz);
}

/// Noise power in coefficient k of M.
double noise_power(const ResponseWindow& window, int k, int coefficients) {
  const double white = window.variance.sum();
  if (!window.differentiated) return white;
  return 4 * std::pow(std::sin(pi * k / coefficients), 2) * white;
}

double smoothed_power(const Eigen::VectorXcd& spectrum, Eigen::Index k, Eigen::Index reach) {
  const Eigen::Index first = std::max<Eigen::Index>(0, k - reach);
  const Eigen::Index last = std::min(spectrum.size() - 1, k + reach);
  return spectrum.segment(first, last - first + 1).cwiseAbs2().mean();
}

}  // namespace

Estimate measured_bandwidth_hz(const ResponseWindow& window) {
  const double half_rate_hz = 0.5 / window.time_step_s;
  const auto length = static_cast<double>(window.values.size());
  const double step_hz = half_rate_hz / std::max(64.0, 4 * length);
  double low_hz = 0.0, high_hz = step_hz;
  const double level = std::numbers::sqrt2 / 2;
  while (gain_at(window, high_hz) > level) {
    low_hz = high_hz;
    high_hz += step_hz;
    if (high_hz > half_rate_hz) return {NAN, NAN};
  }
  for (int i = 0; i < 60; ++i) {
    const double middle_hz = 0.5 * (low_hz + high_hz);
    (gain_at(window, middle_hz) > level ? low_hz : high_hz) = middle_hz;
  }
  const double found_hz = low_hz, move_hz = 0.01 * found_hz;
  const double slope =
      (gain_at(window, found_hz + move_hz) - gain_at(window, found_hz - move_hz)) / (2 * move_hz);
  return {found_hz, gain_error_at(window, found_hz) / std::abs(slope)};
}

DenoisedResponse denoised_response(const ResponseWindow& window, double time_step_s,
                                   double margin_s) {
  const Eigen::Index length = window.values.size();
  const auto margin = static_cast<Eigen::Index>(std::ceil(margin_s / window.time_step_s));
  const auto coefficients =
      static_cast<int>(std::bit_ceil(static_cast<unsigned>(2 * length + 2 * margin)));
  Eigen::VectorXd padded = Eigen::VectorXd::Zero(coefficients);
  padded.segment(margin, length) = window.values;
  Eigen::VectorXcd spectrum;
  PeriodicTransform(coefficients).forward(padded, spectrum);

  // Wiener filter: 1 - noise / power; 0 where noise dominates.
  const Eigen::Index reach = coefficients / length;
  Eigen::Index kept = 1;
  double left = 0.0;
  Eigen::VectorXcd filtered = spectrum;
  for (; kept < spectrum.size(); ++kept) {
    const double noise = noise_power(window, static_cast<int>(kept), coefficients);
    const double power = smoothed_power(spectrum, kept, reach);
    if (power < 2 * noise) break;
    const double pass = 1.0 - noise / power;
    const double frequency_hz = static_cast<double>(kept) / (coefficients * window.time_step_s);
    filtered[kept] *= pass / differencing(window, frequency_hz);
    left += 2 * pass * pass * noise;
  }
  // A sharp cut-off would cause ringing.
  const Eigen::Index fading = kept / 3;
  for (Eigen::Index k = kept - fading; k < kept; ++k)
    filtered[k] *= std::pow(
        std::cos(0.5 * pi * static_cast<double>(k - kept + fading) / static_cast<double>(fading)),
        2);
  filtered.conservativeResize(kept);

  const double period_s = coefficients * window.time_step_s;
  const auto value_at = [&](double t_s) {
    const std::complex<double> turn = std::polar(1.0, 2 * pi * t_s / period_s);
    std::complex<double> sum = 0.0;
    for (Eigen::Index k = kept - 1; k >= 1; --k) sum = (sum + filtered[k]) * turn;
    return (filtered[0].real() + 2 * sum.real()) / coefficients;
  };
  const auto count = static_cast<Eigen::Index>(
      std::ceil(static_cast<double>(length + 2 * margin) * window.time_step_s / time_step_s));
  Eigen::VectorXd samples(count);
  double moment_s = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t_s = static_cast<double>(i) * time_step_s;
    samples[i] = value_at(t_s);
    moment_s += t_s * samples[i];
  }
  const double centre_s = moment_s / samples.sum();
  // Make the centre a sampling point.
  const double offset_s = centre_s - time_step_s * std::floor(centre_s / time_step_s);
  const double first_s = offset_s - time_step_s * std::ceil(offset_s / time_step_s);
  for (Eigen::Index i = 0; i < count; ++i)
    samples[i] = value_at(first_s + static_cast<double>(i) * time_step_s);
  const double highest = samples.maxCoeff();
  samples /= samples.sum();

  DenoisedResponse result;
  result.response.kind = ImpulseResponse::Kind::file;
  result.response.samples.assign(samples.begin(), samples.end());
  result.response.time_step_s = time_step_s;
  result.response_centre_s = centre_s - first_s;
  result.centre_s = window.start_time_s - static_cast<double>(margin) * window.time_step_s +
                    centre_s + (window.differentiated ? 0.5 * window.time_step_s : 0.0);
  result.noise_rms =
      std::sqrt(left / (static_cast<double>(coefficients) * static_cast<double>(length))) / highest;
  return result;
}

}  // namespace tofsmith
