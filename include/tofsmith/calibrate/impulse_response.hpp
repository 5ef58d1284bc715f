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

/// What an instrument recorded of a response, equally spaced in time.
struct ResponseRecord {
  Eigen::VectorXd values;     ///< in units of the instrument
  double time_step_s = 0.0;   ///< [s], > 0
  double start_time_s = 0.0;  ///< of the first value [s]
  bool counts = false;        ///< values are numbers of photons, whose variance is their mean
  std::vector<std::string> notes;
};

/// Properties of a record that its file does not contain.
struct ResponseRecordOptions {
  std::optional<double> time_step_s;  ///< needed for values without times
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
      Field("decimal", o.decimal, Help{"decimal mark of a text"}));
}

/// Reads text (see number_table.hpp) with times and values, or values alone, or a NumPy array
/// of one axis. Times that are not equally spaced are resampled onto their median step along
/// straight lines, with a note. Whole numbers from 0 on are taken as counts.
/// @throws IoError naming file and line for times that do not rise, a gap of more than 10 steps, a
///         value that is not finite, several columns of values without a choice, or fewer than 16
ResponseRecord read_response_record(const std::filesystem::path& path,
                                    const ResponseRecordOptions& options = {});

/// What the arm answered to.
enum class Excitation {
  pulse,  ///< a pulse much shorter than the response
  step,   ///< a switch on, or off; the response is its derivative
};

constexpr std::array<std::string_view, 2> words_of(Excitation /*any*/) { return {"pulse", "step"}; }
/// "pulse", "step".
std::string_view name_of(Excitation excitation);
/// @throws std::invalid_argument for any other word
Excitation parse_excitation(std::string_view name);

/// Options of calibrate_impulse_response().
struct ResponseCalibrationOptions {
  std::optional<Excitation> excitation;
  double fundamental_frequency_hz = 15e6;  ///< f0 of the camera
  int samples = 240;                       ///< N of the camera; the response comes out in steps of
                                           ///< a period over a whole multiple of it

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<ResponseCalibrationOptions> auto& o) {
  return std::tuple(
      Field("excitation", o.excitation, Help{"what the arm answered to"},
            IfAbsent{"found from the record"}),
      Field("fundamental_frequency_hz", o.fundamental_frequency_hz, FieldMark::from_above),
      Field("samples", o.samples, FieldMark::from_above));
}

/// A parametric kind of response fitted to a record.
struct ParametricResponse {
  ImpulseResponse response;   ///< hann, gaussian or lowpass
  Estimate parameter_hz;      ///< its f_max_hz or cutoff_hz
  Estimate bandwidth_hz;      ///< -3 dB
  double residual_rms = 0.0;  ///< of the record less the fit, over the height of the record
  Eigen::VectorXd fit;        ///< at the times of the record, in its units
};

struct ResponsePeak {
  double time_s = 0.0;  ///< from the highest
  double height = 0.0;  ///< over that of the highest
};

/// What is known of an arm by a record.
struct CalibratedResponse {
  Excitation excitation = Excitation::pulse;
  bool falling = false;            ///< the pulse points down, or the step is a switch off
  double background = 0.0;         ///< ahead of the response, in units of the record
  double height = 0.0;             ///< of pulse or step above it
  double noise_rms = 0.0;          ///< of the record where nothing happens
  double snr_db = 0.0;             ///< 20 log10(height / noise)
  double delay_s = 0.0;            ///< where the response's centre of gravity was in the record [s]
  ImpulseResponse response;        ///< kind "file", de-noised, its centre of gravity on a sample
  double response_centre_s = 0.0;  ///< which comes that long after its first: what it delays [s]
  Estimate bandwidth_hz;           ///< -3 dB of the measured response itself
  std::vector<ParametricResponse> fits;  ///< the least residual first
  std::vector<ResponsePeak> peaks;       ///< the highest first; two or more are kept, with a note
  ResponseRecord record;                 ///< as it was used
  std::vector<std::string> notes;

  /// Whether the best fit describes the record to its noise: residual within 1.3 noise_rms.
  bool fit_is_good() const;
};

/// First frequency [Hz] at which a response passes 1/sqrt(2) of what it passes at 0.
/// @throws std::invalid_argument for kind none, or if there is no such frequency
double bandwidth_hz(const ImpulseResponse& response);

/// Impulse response of an arm from a record of how it answers to a pulse or a step.
///   1. Find what it answers to, its background (medians ahead of it and behind) and its noise.
///   2. Fit hann, gaussian and lowpass to the record itself by weighted least squares over place,
///      width, height and background; errors from the curvature and the residual.
///   3. Differentiate a step. Keep what stands out of the noise, from its first to its last point.
///   4. De-noise: Wiener's filter 1 - noise / power on the smoothed spectrum, nothing beyond the
///      first frequency at which noise reigns.
///   5. Move the centre of gravity onto a sample and resample by the spectrum's trigonometric
///   polynomial.
/// @throws std::invalid_argument if nothing stands out of the noise, or the options are invalid
CalibratedResponse calibrate_impulse_response(ResponseRecord record,
                                              const ResponseCalibrationOptions& options = {});

}  // namespace tofsmith
