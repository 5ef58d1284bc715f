// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/io/number_table.hpp"

namespace tofsmith {

/// Unit in which delays are given.
enum class DelayUnit { second, metre, bin, period };

/// "s", "m", "bin" or "period"; "ns" and the like through seconds_per_unit().
/// @throws std::invalid_argument for any other word
DelayUnit parse_delay_unit(std::string_view word);

/// Frames of a flat target at known delays, in the order in which they were taken.
struct DelaySweep {
  std::vector<double> delay_periods;  ///< of each frame (F), any real
  RawFrames frames;                   ///< (F, H, W, K) raw numbers; H = W = 1 for a table of means
  std::vector<std::string> notes;

  /// Whether sizes agree and delays run through a whole period without a gap.
  /// @throws std::invalid_argument naming what is missing
  void validate() const;
};

/// What the file of a sweep does not say.
struct DelaySweepOptions {
  std::filesystem::path shifts;  ///< delays of a stack of frames: text of one column, or .npy
  DelayUnit unit = DelayUnit::second;
  double unit_scale = 1.0;                 ///< in `unit` of one number of the file
  double fundamental_frequency_hz = 15e6;  ///< f0: a period is 1/f0, or c/(2 f0) in metres
  int samples = 240;                       ///< N, bins of a period
  DecimalMark decimal = DecimalMark::automatic;
  MeasuredTableOptions table;  ///< how an array (N, K) without delays is read
};

/// Reads a delay sweep:
///   - text: delay and K values per row,
///   - .npy or .npz of shape (F, H, W, K) beside a list of F shifts,
///   - .npy or .npz of shape (N, K): equal steps of one period, see read_measured_table().
/// @throws IoError naming file and place for what does not fit
DelaySweep read_delay_sweep(const std::filesystem::path& path, const DelaySweepOptions& options);

/// What is known of the camera that took a sweep.
struct CorrelationCalibrationOptions {
  int taps = 1;                ///< columns hold the taps of an exposure side by side
  bool differences = false;    ///< columns are differences of taps
  double range_m = 10.0;       ///< depth of a whole period [m], > 0
  Eigen::VectorXd exposure_s;  ///< T [s] (K), if they differ; else empty
  double black_level = 0.0;    ///< raw number without light, where there are no dark frames
  RawFrames dark;              ///< frames with the light off, or none
  std::optional<float> saturation_level;  ///< raw numbers from here on are clipped
  Image<float> geometry_m;  ///< depth of the flat target in each pixel less that on the axis [m];
                            ///< empty: none is taken out of the offset map

  /// @throws std::invalid_argument naming field, value and rule
  void validate(const DelaySweep& sweep) const;
};

/// Pixels left out, each counted once, by the first reason that holds.
struct DeadPixels {
  int not_a_number = 0;  ///< NaN or infinity in some frame
  int constant = 0;      ///< the same number in all frames
  int saturated = 0;     ///< clipped in some frame
  int low = 0;           ///< responds with less than a tenth of the usual
  int total() const { return not_a_number + constant + saturated + low; }
};

/// What is known of a camera by a sweep.
struct CalibratedCorrelation {
  MeasuredTable table;             ///< of the usual pixel, its gain 1 and its offset 0
  Eigen::MatrixXd standard_error;  ///< of each value of the table (N, K)
  PixelMaps maps;                  ///< of each pixel; empty for a table of means
  double delay_error_m = 0.0;      ///< standard error of a usual pixel's offset [m]
  double gain_error = 0.0;         ///< of its gain
  DeadPixels dead;
  bool drift_known = false;            ///< some delay was measured more than once
  bool drift_corrected = false;        ///< and what was found is beyond 3 standard errors
  Estimate light_drift;                ///< change of the light over the sweep, as a share
  Estimate level_drift;                ///< change of the level over the sweep [raw numbers]
  std::vector<Estimate> tap_mismatch;  ///< of each exposure of two taps, as Sensor::tap_mismatch
  double noise_rms = 0.0;              ///< of one raw number [raw numbers]
  std::string noise_source;            ///< "pixels", "repeats" or "high harmonics"
  std::vector<std::string> notes;
};

/// The measured table of a sweep.
///   1. Dead pixels are left out.
///   2. Drift: delays measured more than once show how light and level changed in time, taken to be
///      straight lines; what is beyond 3 standard errors is taken out.
///   3. Every pixel's curve is taken apart into harmonics; its delay and gain against the mean
///      curve maximize the sum over harmonics and measurements (the least squares fit), and the
///      mean curve is made again of the pixels so aligned, until neither changes.
///   4. Table: the aligned mean at N equally spaced places of the period, N as many as there were.
///      Errors from the residuals of the fits, place by place. table.model_error_percent is twice
///      their share of the signal's part of the measurements. Pixels whose curves have another
///      shape differ by more.
/// The mean gain is 1 and the mean offset 0.
/// @throws std::invalid_argument if sweep or options are invalid, or no live pixel is left
CalibratedCorrelation calibrate_correlation(const DelaySweep& sweep,
                                            const CorrelationCalibrationOptions& options,
                                            const Progress& progress = {});

/// Depth that something else knows of what frames show: another sensor, a plane at a known pose,
/// the camera's own engine, a stage.
struct ReferenceDepth {
  /// Along the ray [m]: one for all frames or one for each, of their size, or 1 x 1 for a target
  /// that is as far in every pixel. NaN, infinite or <= 0: not known.
  std::vector<Image<float>> depth_m;
  bool is_z = false;  ///< along the optical axis instead: the camera's lens says where pixels look
};

/// Reads reference depth in metres: .npy of shape (H, W), (F, H, W), or (F,), a distance for each
/// frame; .npz .exr .pfm, and .png (16 bits, mm), of one image.
/// @throws IoError naming the file for what does not fit
ReferenceDepth read_reference_depth(const std::filesystem::path& path);

/// One term of a depth correction, as it was found.
struct CalibratedTerm {
  std::string name;  ///< offset, cos 4, sin 4, row, column, row^2 column, log signal, ..
  Estimate value_m;  ///< its 95 % interval is +- 1.96 standard errors
};

/// Harmonic of a correlation function beyond the camera's model.
struct CalibratedHarmonic {
  int harmonic = 2;   ///< of the frequency
  Estimate in_phase;  ///< share of the fundamental's amplitude, in phase with it at its maximum
  Estimate quadrature;
};

/// One frequency of a code, as reference depth determines it.
struct CalibratedFrequency {
  double frequency_hz = 0.0;
  Estimate offset_m;  ///< constant that the camera adds to the depth of this frequency
  /// Amplitude relative to that of the camera's model; the geometric mean of all frequencies is 1.
  Estimate contrast;
  std::vector<CalibratedHarmonic> harmonics;  ///< only determined ones
};

/// The error of nominal depth, less its mean, to be looked at: means over pixels that count; not a
/// number where there are none.
struct DepthErrorPicture {
  std::vector<double>
      depth_m;  ///< centres of equal parts of the range, as the nominal code decodes
  std::vector<double> before_m;  ///< over each of them
  std::vector<double> after_m;   ///< what the correction leaves of it
  Image<float> before_image_m;   ///< over all frames, of square cells of pixels
  Image<float> after_image_m;
};

/// Result of calibrate_depth().
struct CalibratedDepth {
  MeasuredTable table;    ///< the nominal functions, with the correction
  bool reversed = false;  ///< delay runs backwards; the table does too
  /// One per frequency of the code; the table contains these values. Empty: a single frequency.
  std::vector<CalibratedFrequency> frequencies;
  /// For with_depth(): offset [m] and contrast of each frequency of the code, as the keys
  /// playback.offset_m and sensor.modulation_contrast. Empty: the mean error is the offset, and the
  /// camera's contrast stays.
  std::vector<double> offsets_m, contrasts;
  std::vector<CalibratedTerm> terms;   ///< of the known part of the range
  std::vector<std::string> far_terms;  ///< names of those that count beyond it
  double known_share = 0.0;            ///< of the range in which the reference had depths
  double mean_error_m = 0.0;           ///< of the nominal depth, in [-range / 2, range / 2]
  double rms_before_m = 0.0;           ///< of its error, but for the mean
  /// Remaining error on held-out blocks of pixels; none if too few pixels have weight.
  std::optional<double> rms_m;
  /// Remaining error of far_terms on held-out parts of the range; none if the reference is at one
  /// distance.
  std::optional<double> far_rms_m;
  /// Number of folds without data to hold out or to keep, of 2 folds of blocks and 4 of the range.
  int skipped_folds = 0;
  double outlier_share = 0.0;  ///< share of pixels without weight
  /// As DecodeOptions::model_error_percent, within 20 %; none: the code has no degrees of freedom.
  std::optional<double> model_error_percent;
  std::int64_t pixels = 0;  ///< that were compared
  DepthErrorPicture picture;
  std::vector<std::string> notes;
};

/// Determines the depth error of a nominal code from reference depth on any part of the range.
///   1. For codes of several frequencies, fit offset, contrast and harmonics of each frequency.
///      They become part of the table.
///   2. Decode the frames, and reverse delay that runs backwards. Fit an offset, harmonics 1 to 8
///      of the phase, a field of degree 0 to 4 over rows and columns, and terms in the logarithm of
///      the signal by least squares with Tukey's biweight (flying pixels and wrong references have
///      no weight). Use the phase predicted from the reference, so that noise of the depth does not
///      appear as an error that depends on depth.
///   3. Choose terms by cross-validation: hold out alternate blocks among those with data. Beyond
///      the depths of the reference, use the terms that best predict held-out parts of the range.
///   4. Compute standard errors from tiles of pixels, whose errors may be correlated.
///   5. Find the model error with which at most 1 % of the pixels with the right depth are
///      inconsistent. Errors below the noise of the frames are not found.
/// @param camera  provides the nominal model of the code
/// @throws std::invalid_argument if sizes disagree, fewer than 100 pixels can be compared, or the
///         reference is in another unit, flipped, or of something else
CalibratedDepth calibrate_depth(const RawFrames& frames, const ReferenceDepth& reference,
                                const CodeSet& code, const Camera& camera,
                                const Progress& progress = {});

/// Returns the camera with the calibrated offset and direction of delay, for decoding its code
/// without the table.
Camera with_depth(Camera camera, const CalibratedDepth& found);

/// Temperatures of the frames of a recording.
struct FrameTemperatures {
  std::vector<double> of_camera_c;  ///< of the camera, or of its light source [degrees C] (F)
  std::vector<double> of_sensor_c;  ///< of the sensor [degrees C] (F); empty: not measured
};

/// Part of the drift that follows the temperature of the sensor, as in TemperatureDrift.
struct SensorDrift {
  double mean_c = 0.0;
  Estimate offset_m_per_c;
  Estimate signal_per_c;
  std::vector<double> temperature_c;
};

/// Change of depth and signal of a camera with its temperature, or with the temperatures of light
/// source and sensor.
struct TemperatureDrift {
  double mean_c = 0.0;           ///< mean of the frames [degrees C], origin of both lines
  Estimate offset_m_per_c;       ///< change of the measured depth per degree [m]
  Estimate signal_per_c;         ///< d log(signal) per degree: 0.01 is about 1 % more
  Estimate offset_m_per_c2;      ///< second-order term, in addition to the line
  Estimate signal_per_c2;        ///< second-order term of log(signal)
  double interval_factor = 0.0;  ///< half width of 95 % intervals of the slopes [standard errors]
  double offset_rms_m = 0.0;     ///< of the frames around the line [m]
  double signal_rms = 0.0;       ///< of the frames' log(signal) around the line
  std::vector<double> temperature_c;  ///< of each frame [degrees C] (F)
  std::vector<double> offset_m;       ///< of each frame against the mean of all [m] (F)
  std::vector<double> log_signal;     ///< of each frame against the mean of all (F)
  std::int64_t pixels = 0;            ///< that decode in every frame
  std::vector<std::string> notes;
  std::optional<SensorDrift> sensor;  ///< none: a single temperature was fitted
  /// Offset while the temperature rises, minus the offset while it falls [m]; none if it does not
  /// do both.
  std::optional<Estimate> hysteresis_m;
};

/// Determines the drift with temperature from frames of a static scene.
///   1. Decode all frames, and use the pixels with status ok in all of them.
///   2. Compute the offset of each frame: the median over pixels, weighted by one over the
///   predicted
///      variance, of depth minus the pixel's (circular) mean over frames. The same for log(signal).
///   3. Fit a line over each temperature by least squares. Standard errors follow from the scatter
///      of the frames around it, with Student's t of F - 2 degrees of freedom (F - 3 for two
///      temperatures). They thus include noise and other differences between frames. Drift with
///      time cannot be distinguished from drift with temperature.
///   4. Fit hysteresis, the coefficient of the sign of the temperature's change, with the lines.
/// If the two temperatures are collinear (condition number above 30), only the first is fitted.
/// Notes report this, a curved dependence, temperatures that hardly vary, and hysteresis.
/// @param temperatures  finite
/// @param camera        its own drift is ignored
/// @throws std::invalid_argument if temperatures are not as many as frames, not finite or all the
///         same, if there are fewer than 5 frames (6 for two temperatures), or no pixel decodes in
///         all of them
TemperatureDrift calibrate_temperature(const RawFrames& frames,
                                       const FrameTemperatures& temperatures, const CodeSet& code,
                                       const Camera& camera, const Progress& progress = {});
/// Returns the camera with this drift.
/// @param reference_c  temperature of the other calibrations, at which nothing changes [degrees C];
///   none: the mean of the frames
/// @param sensor_reference_c  the same for the sensor
/// @throws std::invalid_argument for a sensor_reference_c without drift of the sensor
Camera with_temperature(Camera camera, const TemperatureDrift& found,
                        std::optional<double> reference_c = {},
                        std::optional<double> sensor_reference_c = {});

/// What a lens scatters, as a bright target before black shows it.
struct CalibratedStrayLight {
  Image<float> kernel;            ///< as StrayLight takes it
  std::vector<double> radius_px;  ///< distances from the pixel (J)
  std::vector<Estimate> share;    ///< of a pixel's light in each pixel so far away (J)
  Estimate total;                 ///< of all light that is scattered
  std::int64_t target_pixels = 0;
  std::int64_t pixels = 0;  ///< around the target
  std::vector<std::string> notes;
};

/// Stray light from frames of a small bright target before black.
///   1. Means over frames, less those of `dark`, or the black level. The target are the pixels of
///   at
///      least half the light of the brightest; a pixel's light is that in the target's direction of
///      the K measurements, in units of the target's mean.
///   2. Around the target (2 pixels away and more) light is kernel * target. The kernel depends on
///      distance alone: r^2 times it is a straight line over log r between distances 1.5 times
///      apart, from 3 pixels on, and constant below. Least squares; errors by what is left over in
///      each pixel (MacKinnon and White 1985, HC3).
///   3. The target's own light follows from the kernel, and the fit is made again, three times.
/// Whatever else is bright around the target counts as stray light, so there should be nothing.
/// @param dark  the same with the target covered; may have no frames
/// @throws std::invalid_argument if sizes differ, nothing is bright, the target is saturated, fewer
///         than 4 pixels or more than a quarter of the image, or the rest is not black
CalibratedStrayLight calibrate_stray_light(const RawFrames& frames, const RawFrames& dark,
                                           const Camera& camera, const Progress& progress = {});

/// Writes a table with its correction, as read_measured_table() reads it.
/// @throws IoError as below
void write_calibrated_table(const std::filesystem::path& path, const MeasuredTable& table,
                            OutputPolicy policy);

/// Writes the table as read_measured_table() reads it: corrfs, corrfs_se, offset_dn, taps,
/// differences and, where they are known, ambient and exposure_s. Columns hold the taps of an
/// exposure side by side.
/// @throws IoError unless the extension is .npz, or as AtomicFile does
void write_calibrated_table(const std::filesystem::path& path, const CalibratedCorrelation& found,
                            OutputPolicy policy);

/// One harmonic of a measured table against that of an ideal code.
struct HarmonicRatio {
  int harmonic = 1;
  double measured = 0.0;  ///< amplitude, root of the sum of squares over measurements
  double ideal = 0.0;     ///< the same of the fitted code without responses
  Estimate ratio;         ///< what both arms pass of it; not a number where the code has none
};

/// An ideal code fitted to a measured table.
struct IdealCodeFit {
  std::string code;
  double delay_periods = 0.0;   ///< by which the measured curves arrive later
  bool reversed = false;        ///< delay runs the other way
  bool inverted = false;        ///< all signs are opposite
  std::vector<int> exposure;    ///< of the code that each measured exposure is
  double scale = 1.0;           ///< raw numbers of one unit of the code's correlation
  double ideal_residual = 0.0;  ///< rms left over the rms of the table, without responses
  double residual = 0.0;        ///< the same with the response
  ImpulseResponse response;     ///< of each of the two arms, both alike; none if nothing is gained
  Estimate parameter_hz;        ///< its f_max_hz or cutoff_hz
  Eigen::MatrixXd fitted;       ///< (N, K), without means
  std::vector<HarmonicRatio> harmonics;  ///< 1 .. 16
};

/// Fits codes to a measured table, the least residual first: common scale, delay, direction and
/// sign, the order of exposures, and one symmetric response of both arms (hann, gaussian or
/// lowpass), all by least squares over harmonics. Means of columns do not count.
/// @param table   (N, K)
/// @param error   standard errors of its values (N, K)
/// @param codes   families or codes that fit the camera's taps, of K values
/// @throws std::invalid_argument if no code has K values
std::vector<IdealCodeFit> fit_ideal_codes(const Eigen::MatrixXd& table,
                                          const Eigen::MatrixXd& error, const Camera& camera,
                                          const std::vector<CodeSet>& codes);

/// The ideal codes of K values on that camera: every family, without responses, peak or generator.
std::vector<CodeSet> ideal_codes(const Camera& camera, int measurements);

/// The camera whose arms respond as fitted and whose taps differ as measured.
Camera with_fit(Camera camera, const IdealCodeFit& fit,
                const std::vector<Estimate>& tap_mismatch = {});

}  // namespace tofsmith
