// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// How a light source or a sensor smooths what it is told to play. Its transfer function is 1 at
/// frequency 0, so mean power and duty stay.
struct ImpulseResponse {
  enum class Kind { none, hann, gaussian, lowpass, file };

  Kind kind = Kind::none;
  /// Of a Hann window: the frequency at which it attenuates by 5 [Hz], > 0. The window is
  /// 1.444 / f_max_hz wide and its transfer function sinc(x) / (1 - x^2), x = f * width.
  /// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 4.2 and Fig. 5
  double f_max_hz = 0.0;
  /// Of a Gaussian or a first-order low-pass: the frequency of -3 dB [Hz], > 0.
  double cutoff_hz = 0.0;
  /// Measured response, in steps of time_step_s, linear in between; scaled to sum 1 where it is
  /// used. Nothing passes above half the sampling rate.
  std::vector<double> samples;
  double time_step_s = 0.0;  ///< of `samples` [s], > 0
  std::string file;          ///< where `samples` came from

  /// Transfer function at a frequency [Hz]; 1 at 0.
  std::complex<double> transfer(double frequency_hz) const;

  /// @throws std::invalid_argument naming `field`.member, value and rule
  void validate(std::string_view field) const;

  friend bool operator==(const ImpulseResponse&, const ImpulseResponse&) = default;
};

/// "none", "hann", "gaussian", "lowpass", "file".
std::string_view name_of(ImpulseResponse::Kind kind);

}  // namespace tofsmith
