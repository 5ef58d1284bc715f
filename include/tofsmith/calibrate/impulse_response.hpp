// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
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
  double time_step_s = 0.0;   ///< [s], > 0
  double start_time_s = 0.0;  ///< of the first value [s]
  bool counts = false;        ///< values are photon counts, whose variance equals their mean
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

/// Reads text (see number_table.hpp) with times and values, or with values only, or a NumPy array
/// with one axis. Unequally spaced times are resampled to the median step by linear interpolation,
/// with a note. Integers >= 0 are treated as counts.
/// @throws IoError naming file and line for times that do not increase, gaps of more than 10 steps,
///         values that are not finite, an ambiguous column of values, or fewer than 16 values
ResponseRecord read_response_record(const std::filesystem::path& path,
                                    const ResponseRecordOptions& options = {});

/// Input of the arm during the record.
enum class Excitation {
  pulse,  ///< a pulse much shorter than the response
  step,   ///< switching on or off; the response is the derivative of the record
};

constexpr std::array<std::string_view, 2> words_of(Excitation /*any*/) { return {"pulse", "step"}; }
/// Returns "pulse" or "step".
std::string_view name_of(Excitation excitation);
/// Inverse of name_of(). @throws std::invalid_argument for any other word
Excitation parse_excitation(std::string_view name);

/// Options of calibrate_impulse_response().
struct ResponseCalibrationOptions {
  std::optional<Excitation> excitation;
  double fundamental_frequency_hz = 15e6;  ///< f0 of the camera
  int samples = 240;  ///< N of the camera; the step of the result is a period over a multiple of N

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<ResponseCalibrationOptions> auto& o) {
  return std::tuple(
      Field("excitation", o.excitation, Help{"input of the arm during the record"},
            IfAbsent{"detected in the record"}),
      Field("fundamental_frequency_hz", o.fundamental_frequency_hz, FieldMark::from_above),
      Field("samples", o.samples, FieldMark::from_above));
}

/// A parametric response fitted to a record.
struct ParametricResponse {
  ImpulseResponse response;   ///< hann, gaussian or lowpass
  Estimate parameter_hz;      ///< its f_max_hz or cutoff_hz
  Estimate bandwidth_hz;      ///< -3 dB
  double residual_rms = 0.0;  ///< of the record minus the fit, relative to the height of the record
  Eigen::VectorXd fit;        ///< at the times of the record, in its units
};

struct ResponsePeak {
  double time_s = 0.0;  ///< relative to the highest peak
  double height = 0.0;  ///< relative to the highest peak
};

/// Result of calibrate_impulse_response().
struct CalibratedResponse {
  Excitation excitation = Excitation::pulse;
  bool falling = false;      ///< negative pulse, or a step down
  double background = 0.0;   ///< before the response, in units of the record
  double height = 0.0;       ///< of pulse or step above the background
  double noise_rms = 0.0;    ///< of the record outside the response
  double snr_db = 0.0;       ///< 20 log10(height / noise)
  double delay_s = 0.0;      ///< centre of gravity of the response in the record [s]
  ImpulseResponse response;  ///< kind "file", denoised, with its centre of gravity on a sample
  double response_centre_s = 0.0;  ///< delay of its centre of gravity from its first sample [s]
  Estimate bandwidth_hz;           ///< -3 dB bandwidth of the measured response
  std::vector<ParametricResponse> fits;  ///< by increasing residual
  std::vector<ResponsePeak> peaks;  ///< by decreasing height; several peaks are kept, with a note
  ResponseRecord record;            ///< as used
  std::vector<std::string> notes;

  /// Returns true if the best fit agrees with the record within its noise: residual below 1.3
  /// noise_rms.
  bool fit_is_good() const;
};

/// Returns the lowest frequency [Hz] at which the transfer function falls to 1/sqrt(2) of its value
/// at 0.
/// @throws std::invalid_argument for kind none, or if there is no such frequency
double bandwidth_hz(const ImpulseResponse& response);

/// Calibrates the impulse response of an arm from a record of its response to a pulse or a step.
///   1. Detect the excitation, the background (median before and after the response) and the noise.
///   2. Fit hann, gaussian and lowpass to the record by weighted least squares over position,
///      width, height and background. Standard errors follow from curvature and residual.
///   3. Differentiate a step. Keep the range between the first and the last significant value.
///   4. Denoise with a Wiener filter, 1 - noise / power of the smoothed spectrum, up to the first
///      frequency at which noise dominates.
///   5. Move the centre of gravity to a sample and resample by the trigonometric polynomial of the
///      spectrum.
/// @throws std::invalid_argument if no value is significant, or the options are invalid
CalibratedResponse calibrate_impulse_response(ResponseRecord record,
                                              const ResponseCalibrationOptions& options = {});

}  // namespace tofsmith
