// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/field_visitor.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith {

/// Impulse response of a light source or a sensor. Its transfer function is 1 at frequency 0, so
/// mean power and duty are preserved.
struct ImpulseResponse {
  enum class Kind { none, hann, gaussian, lowpass, file };

  Kind kind = Kind::none;
  /// hann: frequency at which the window attenuates by 5. The window has a width of 1.444 /
  /// f_max_hz and the transfer function sinc(x) / (1 - x^2), x = f * width.
  /// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 4.2 and Fig. 5
  double f_max_hz = 0.0;
  double cutoff_hz = 0.0;  ///< gaussian, lowpass: -3 dB frequency
  /// file: linear between samples, normalized to sum 1 when used. The transfer function is 0 above
  /// half the sampling rate.
  std::vector<double> samples;
  double time_step_s = 0.0;  ///< file
  std::string file;          ///< file: path; may be empty

  /// Returns the transfer function at a frequency [Hz].
  std::complex<double> transfer(double frequency_hz) const;

  /// @throws InvalidArgument with a field `field`.*
  void validate(std::string_view field) const;

  friend bool operator==(const ImpulseResponse&, const ImpulseResponse&) = default;
};

constexpr auto words_of(ImpulseResponse::Kind /*any*/) {
  return word_list("none", "hann", "gaussian", "lowpass", "file");
}

/// Keys of [light.impulse_response] and [sensor.impulse_response].
inline void describe(FieldVisitor& fields, ImpulseResponse& response) {
  using Kind = ImpulseResponse::Kind;
  fields.choice(Key("kind", "Shape of the impulse response").required("\"hann\"").basic(),
                response.kind);
  const Kind kind = response.kind;
  fields.value(
      Key("f_max_hz", "Frequency at which the Hann window attenuates by a factor of 5", above(0))
          .required("150e6")
          .only(kind == Kind::hann, "kind = \"hann\"")
          .usually(1e7, 3e9),
      response.f_max_hz);
  fields.value(Key("cutoff_hz", "-3 dB frequency", above(0))
                   .required("100e6")
                   .only(kind == Kind::gaussian || kind == Kind::lowpass,
                         "kind = \"gaussian\" or \"lowpass\"")
                   .usually(1e7, 3e9),
               response.cutoff_hz);
  const bool is_file = kind == Kind::file;
  fields.value(
      Key("file", "File with the measured response: .csv or .npy").only(is_file, "kind = \"file\""),
      InputPath{response.file});
  const bool has_file = !response.file.empty();
  fields.value(Key("samples", "Measured response, linear between samples", finite())
                   .required("[0.1, 0.5, 0.3, 0.1]")
                   .only(is_file && !has_file, "kind = \"file\" and no file"),
               response.samples);
  Key time_step("time_step_s",
                "Time between samples, or between the values of a file without times", above(0));
  if (!has_file) time_step.required("1e-9");
  fields.value(time_step.only(is_file, "kind = \"file\""), response.time_step_s);
}

}  // namespace tofsmith
