// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/io/number_table.hpp"

namespace tofsmith {

/// An instrument's record of a response, with a constant time step.
struct ResponseRecord {
  Eigen::VectorXd values;     ///< in units of the instrument
  double time_step_s = 0.0;   ///< > 0
  double start_time_s = 0.0;  ///< of the first value
  bool counts = false;        ///< photon counts, whose variance equals their mean
  std::vector<std::string> notes;
};

/// Properties of a record that its file does not contain.
struct ResponseRecordOptions {
  std::optional<double> time_step_s;  ///< required for values without times
  std::optional<double> time_unit_s;
  std::string column;
  DecimalMark decimal = DecimalMark::automatic;
};
auto fields_of(ConstOrNot<ResponseRecordOptions> auto& o) {
  return std::tuple(
      Field("time_step_s", o.time_step_s, above(0),
            Help{"time between two values of a record without times"}),
      Field("time_unit_s", o.time_unit_s, above(0), Help{"unit of the time column"},
            IfAbsent{"from its name, or 1"}),
      Field("column", o.column, Help{"name or number (from 1) of the column of values"}),
      Field("decimal", o.decimal, Help{"decimal mark of a text file"}));
}

/// Reads text (see number_table.hpp) with values and optional times, or a NumPy array with one
/// axis. Unequal time steps are resampled to the median step by linear interpolation. Integers >= 0
/// are treated as counts.
/// @throws IoError for times that do not increase, gaps of more than 10 steps, values that are not
///         finite, an ambiguous column of values, or fewer than 16 values
ResponseRecord read_response_record(const std::filesystem::path& path,
                                    const ResponseRecordOptions& options = {});

/// Input of the arm during the record.
enum class Excitation {
  automatic,  ///< detected in the record
  pulse,      ///< much shorter than the response
  step,       ///< switching on or off; the response is the derivative of the record
};
constexpr auto words_of(Excitation /*any*/) { return word_list("auto", "pulse", "step"); }

/// Options of calibrate_impulse_response().
struct ResponseCalibrationOptions {
  Excitation excitation = Excitation::automatic;
  double fundamental_frequency_hz = 15e6;  ///< f0
  int samples = 240;  ///< N; the time step of the result is a period over a multiple of N

  /// @throws InvalidArgument
  void validate() const;
};
auto fields_of(ConstOrNot<ResponseCalibrationOptions> auto& o) {
  return std::tuple(
      Field("excitation", o.excitation,
            Help{"input of the light source or sensor during the record"}),
      Field("fundamental_frequency_hz", o.fundamental_frequency_hz, FieldMark::from_above),
      Field("samples", o.samples, FieldMark::from_above));
}

/// A parametric response fitted to a record.
struct ParametricResponse {
  ImpulseResponse response;
  Estimate parameter_hz;
  Estimate bandwidth_hz;
  double residual_rms = 0.0;
  Eigen::VectorXd fit;
};
auto fields_of(ConstOrNot<ParametricResponse> auto& r) {
  return std::tuple(
      Field("response", r.response, Help{"fitted response: hann, gaussian or lowpass"}),
      Field("parameter_hz", r.parameter_hz, FieldMark::as_object,
            Help{"`f_max_hz` or `cutoff_hz` of `response`"}),
      Field("bandwidth_hz", r.bandwidth_hz, FieldMark::as_object, Help{"-3 dB bandwidth"}),
      Field("residual_rms", r.residual_rms,
            Help{"rms of the record minus the fit, relative to the height of the record"}),
      Field("fit", r.fit, Help{"fitted record, (T,), in its units"}));
}

struct ResponsePeak {
  double time_s = 0.0;  ///< relative to the highest peak
  double height = 0.0;  ///< relative to the highest peak
};

/// Result of calibrate_impulse_response().
struct CalibratedResponse {
  Excitation excitation = Excitation::pulse;
  bool falling = false;                  ///< negative pulse, or a step down
  double background = 0.0;               ///< before the response
  double height = 0.0;                   ///< above the background
  double noise_rms = 0.0;                ///< outside the response
  double snr_db = 0.0;                   ///< 20 log10(height / noise)
  double delay_s = 0.0;                  ///< centre of gravity of the response in the record
  ImpulseResponse response;              ///< kind "file", denoised, centre of gravity on a sample
  double response_centre_s = 0.0;        ///< centre of gravity from the first sample
  Estimate bandwidth_hz;                 ///< -3 dB, of the measured response
  std::vector<ParametricResponse> fits;  ///< by increasing residual
  std::vector<ResponsePeak> peaks;       ///< by decreasing height
  ResponseRecord record;
  std::vector<std::string> notes;

  /// Returns true if the residual of the best fit is below 1.3 noise_rms.
  bool fit_is_good() const;
};

/// Returns the -3 dB frequency of the transfer function [Hz].
/// @throws InvalidArgument for kind none, or if there is no such frequency
double bandwidth_hz(const ImpulseResponse& response);

/// Calibrates the impulse response of an arm from a record of its response to a pulse or a step.
/// The fits use weighted least squares over position, width, height and background. The measured
/// response is denoised with a Wiener filter, up to the first frequency at which noise dominates,
/// and shifted by trigonometric interpolation.
/// @throws InvalidArgument if no value is significant, or the options are invalid
/// @see docs/calibration.md
CalibratedResponse calibrate_impulse_response(ResponseRecord record,
                                              const ResponseCalibrationOptions& options = {});

}  // namespace tofsmith
