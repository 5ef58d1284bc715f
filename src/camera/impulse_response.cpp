// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/impulse_response.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {
constexpr double pi = std::numbers::pi;

// Width of a Hann window times f_max: sinc(x) / (1 - x^2) = 1/5.
constexpr double hann_width_times_f_max = 1.444010597686313;

double hann_transfer(double x) {
  x = std::abs(x);
  if (x < 1e-9) return 1.0;
  if (std::abs(x - 1.0) < 1e-7) return 0.5;  // removable singularity
  return std::sin(pi * x) / (pi * x) / (1.0 - x * x);
}

/// Fourier transform of the linearly interpolated samples; 0 above half the sampling rate.
std::complex<double> measured_transfer(const ImpulseResponse& response, double frequency_hz) {
  const double turns_per_step = frequency_hz * response.time_step_s;
  if (std::abs(turns_per_step) > 0.5) return 0.0;
  const double x = pi * turns_per_step;
  const double sinc = x == 0.0 ? 1.0 : std::sin(x) / x;
  std::complex<double> sum = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < response.samples.size(); ++i) {
    const double phase = -2 * pi * frequency_hz * response.time_step_s * static_cast<double>(i);
    sum += response.samples[i] * std::polar(1.0, phase);
    total += response.samples[i];
  }
  return sum / total * sinc * sinc;
}

}  // namespace

std::complex<double> ImpulseResponse::transfer(double frequency_hz) const {
  switch (kind) {
    case Kind::none:
      return 1.0;
    case Kind::hann:
      return hann_transfer(frequency_hz * hann_width_times_f_max / f_max_hz);
    case Kind::gaussian: {
      const double ratio = frequency_hz / cutoff_hz;
      return std::exp2(-0.5 * ratio * ratio);  // -3 dB at the cutoff
    }
    case Kind::lowpass:
      return 1.0 / std::complex<double>(1.0, frequency_hz / cutoff_hz);
    case Kind::file:
      return measured_transfer(*this, frequency_hz);
  }
  return 1.0;
}

void ImpulseResponse::validate(std::string_view field) const {
  check_ranges(*this, std::string(field) + ".");
  if (kind != Kind::file) return;
  const std::string name = fmt::format("{}.samples", field);
  require(!samples.empty(), name, "empty", "must have at least one sample");
  const double total = std::accumulate(samples.begin(), samples.end(), 0.0);
  require(total > 0.0, name + " sum", total, "must be > 0");
}

}  // namespace tofsmith
