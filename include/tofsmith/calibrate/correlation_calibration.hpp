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

/// Unit of delays.
enum class DelayUnit { second, metre, bin, period };

/// Parses "s", "m", "bin" or "period". For "ns" and other scaled units see seconds_per_unit().
/// @throws std::invalid_argument for any other word
DelayUnit parse_delay_unit(std::string_view word);

/// Frames of a flat target at known delays, in recording order.
struct DelaySweep {
  std::vector<double> delay_periods;  ///< delay of each frame (F), any real number
  RawFrames frames;                   ///< (F, H, W, K) raw numbers; H = W = 1 for a table of means
  std::vector<std::string> notes;

  /// @throws std::invalid_argument unless sizes match and the delays cover a whole period without
  ///         gaps
  void validate() const;
};

/// Properties of a delay sweep that its file does not contain.
struct DelaySweepOptions {
  std::filesystem::path shifts;  ///< delays of a stack of frames: text with one column, or .npy
  DelayUnit unit = DelayUnit::second;
  double unit_scale = 1.0;                 ///< delays in the file are multiples of this, in `unit`
  double fundamental_frequency_hz = 15e6;  ///< f0: a period is 1/f0, or c/(2 f0) in metres
  int samples = 240;                       ///< N, number of bins per period
  DecimalMark decimal = DecimalMark::automatic;
  MeasuredTableOptions table;  ///< for an array (N, K) without delays
};

/// Reads a delay sweep:
///   - text: delay and K values per row,
///   - .npy or .npz of shape (F, H, W, K), together with a list of F shifts,
///   - .npy or .npz of shape (N, K): equal steps over one period, see read_measured_table().
/// @throws IoError naming file and position if the contents do not match
DelaySweep read_delay_sweep(const std::filesystem::path& path, const DelaySweepOptions& options);

/// Properties of the camera that recorded a sweep.
struct CorrelationCalibrationOptions {
  int taps = 1;                           ///< columns contain the taps of an exposure side by side
  bool differences = false;               ///< columns are differences of taps
  double range_m = 10.0;                  ///< depth of a whole period [m], > 0
  Eigen::VectorXd exposure_s;             ///< T [s] (K), if they differ; otherwise empty
  double black_level = 0.0;               ///< raw number without light, if there are no dark frames
  RawFrames dark;                         ///< frames with the light off, or none
  std::optional<float> saturation_level;  ///< raw numbers at or above it are clipped
  Image<float> geometry_m;  ///< depth of the flat target in each pixel minus depth on the axis [m],
                            ///< removed from the offset map; empty: none

  /// @throws std::invalid_argument naming field, value and rule
  void validate(const DelaySweep& sweep) const;
};

/// Number of excluded pixels by reason. Each pixel is counted once, for the first reason.
struct DeadPixels {
  int not_a_number = 0;  ///< NaN or infinity in some frame
  int constant = 0;      ///< same number in all frames
  int saturated = 0;     ///< clipped in some frame
  int low = 0;           ///< response below a tenth of the usual one
  int total() const { return not_a_number + constant + saturated + low; }
};

/// Result of calibrate_correlation().
struct CalibratedCorrelation {
  MeasuredTable table;             ///< of the usual pixel, which has gain 1 and offset 0
  Eigen::MatrixXd standard_error;  ///< of each value of the table (N, K)
  PixelMaps maps;                  ///< offset and gain of each pixel; empty for a table of means
  double delay_error_m = 0.0;      ///< standard error of the offset of a usual pixel [m]
  double gain_error = 0.0;         ///< standard error of the gain of a usual pixel
  DeadPixels dead;
  bool drift_known = false;            ///< at least one delay was measured more than once
  bool drift_corrected = false;        ///< the drift exceeds 3 standard errors and was removed
  Estimate light_drift;                ///< relative change of the light over the sweep
  Estimate level_drift;                ///< change of the level over the sweep [raw numbers]
  std::vector<Estimate> tap_mismatch;  ///< per exposure of two taps, as Sensor::tap_mismatch
  double noise_rms = 0.0;              ///< noise of one raw number [raw numbers]
  std::string noise_source;            ///< "pixels", "repeats" or "high harmonics"
  std::vector<std::string> notes;
};

/// Computes the measured table of a sweep.
///   1. Exclude dead pixels.
///   2. Determine the drift of light and level from delays that were measured more than once, as
///      straight lines in time. Remove drifts that exceed 3 standard errors.
///   3. Compute the harmonics of the curve of every pixel. Fit delay and gain of each pixel
///      relative to the mean curve by least squares over harmonics and measurements. Recompute the
///      mean curve from the aligned pixels, and repeat until neither changes.
///   4. The table is the aligned mean at N equally spaced positions of the period, where N is the
///      number of measured positions. Its errors follow from the residuals of the fits at each
///      position. table.model_error_percent is twice the ratio of these errors to the part of the
///      measurements that is due to the signal. It is too small for pixels whose curves have
///      another shape.
/// The mean gain is 1 and the mean offset is 0.
/// @throws std::invalid_argument if sweep or options are invalid, or all pixels are dead
CalibratedCorrelation calibrate_correlation(const DelaySweep& sweep,
                                            const CorrelationCalibrationOptions& options,
                                            const Progress& progress = {});

/// Depths of the recorded scene from an independent source: another sensor, a plane with known
/// pose, the camera's own processing, or a translation stage.
struct ReferenceDepth {
  /// Depth along the ray [m]: one image for all frames or one per frame, of the size of the frames,
  /// or 1 x 1 for a target with the same depth in every pixel. NaN, infinite or <= 0: unknown.
  std::vector<Image<float>> depth_m;
  bool is_z = false;  ///< depth along the optical axis; rays are given by the camera's lens
};

/// Reads reference depth in metres: .npy of shape (H, W), (F, H, W), or (F,) with one distance per
/// frame; .npz, .exr, .pfm or .png (16 bits, mm) with one image.
/// @throws IoError naming the file if the contents do not match
ReferenceDepth read_reference_depth(const std::filesystem::path& path);

/// Fitted term of a depth correction.
struct CalibratedTerm {
  std::string name;  ///< offset, cos 4, sin 4, row, column, row^2 column, log signal, ...
  Estimate value_m;  ///< the 95 % interval is +- 1.96 standard errors
};

/// Harmonic of a correlation function beyond the camera's model.
struct CalibratedHarmonic {
  int harmonic = 2;  ///< multiple of the frequency
  /// Amplitude relative to that of the fundamental, of the part in phase with the maximum of the
  /// fundamental.
  Estimate in_phase;
  Estimate quadrature;
};

/// Calibrated properties of one frequency of a code.
struct CalibratedFrequency {
  double frequency_hz = 0.0;
  Estimate offset_m;  ///< constant that the camera adds to the depth of this frequency
  /// Amplitude relative to that of the camera's model; the geometric mean of all frequencies is 1.
  Estimate contrast;
  /// Harmonics that the frames determine.
  std::vector<CalibratedHarmonic> harmonics;
};

/// Depth error for plots: the error of the nominal depth minus its mean over all pixels. Values are
/// means over the pixels with weight in the fit, and NaN if there are none.
struct DepthErrorPicture {
  std::vector<double> depth_m;   ///< centres of equal parts of the range, in nominal depth
  std::vector<double> before_m;  ///< mean error in each part
  std::vector<double> after_m;   ///< mean error in each part after the correction
  Image<float> before_image_m;   ///< mean over all frames in square cells of pixels
  Image<float> after_image_m;
};

/// Result of calibrate_depth().
struct CalibratedDepth {
  MeasuredTable table;    ///< nominal correlation functions with the correction
  bool reversed = false;  ///< chi(-z) was measured, so that the table is reversed, too
  /// One per frequency of the code; the table contains these values. Empty: a single frequency.
  std::vector<CalibratedFrequency> frequencies;
  /// For with_depth(): offset [m] and contrast of each frequency of the code, as in the keys
  /// playback.offset_m and sensor.modulation_contrast. Empty: the offset is the mean error, and the
  /// contrast of the camera does not change.
  std::vector<double> offsets_m, contrasts;
  std::vector<CalibratedTerm> terms;   ///< for depths within the reference
  std::vector<std::string> far_terms;  ///< names of the terms used for all other depths
  double known_share = 0.0;            ///< share of the range that the reference covers
  double mean_error_m = 0.0;           ///< mean error of nominal depth, in [-range / 2, range / 2]
  double rms_before_m = 0.0;           ///< rms of this error minus its mean
  /// Remaining error on held-out blocks of pixels; none if too few pixels have weight.
  std::optional<double> rms_m;
  /// Remaining error of far_terms on held-out parts of the range; none if the reference is at one
  /// distance.
  std::optional<double> far_rms_m;
  /// Number of folds of the cross-validation that were skipped, because they left no data to hold
  /// out or to fit. There are 2 folds of blocks of pixels and 4 folds of the range.
  int skipped_folds = 0;
  double outlier_share = 0.0;  ///< share of pixels without weight
  /// As DecodeOptions::model_error_percent, found in steps of 20 % of its value; none: the code has
  /// no degrees of freedom.
  std::optional<double> model_error_percent;
  std::int64_t pixels = 0;  ///< number of compared pixels
  DepthErrorPicture picture;
  std::vector<std::string> notes;
};

/// Determines the depth error of a nominal code from reference depth on any part of the range.
///   1. For codes of several frequencies, fit offset, contrast and harmonics of each frequency.
///      They become part of the table.
///   2. Decode the frames. If the measured delay decreases with distance, reverse the table. Fit an
///      offset, harmonics 1 to 8 of the phase, a field of degree 0 to 4 over rows and columns, and
///      terms in the logarithm of the signal. Use least squares with Tukey's biweight, so that
///      flying pixels and wrong references have no weight. Use the phase predicted from the
///      reference, so that noise of the depth does not appear as an error that depends on depth.
///   3. Choose terms by cross-validation: hold out every other block of pixels with data. Beyond
///      the depths of the reference, use the terms that best predict held-out parts of the range.
///   4. Compute standard errors from tiles of pixels, whose errors may be correlated.
///   5. Find the model error with which at most 1 % of the pixels with the right depth are
///      inconsistent. Errors below the noise of the frames are not found.
/// @param camera  provides the nominal model of the code
/// @throws std::invalid_argument if sizes disagree, fewer than 100 pixels can be compared, or the
///         reference is in another unit, flipped, or shows another scene
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
///   2. Compute the offset of each frame: the median over pixels, weighted by the inverse predicted
///      variance, of depth minus the pixel's (circular) mean over frames. Do the same for
///      log(signal).
///   3. Fit a line over each temperature by least squares. Standard errors follow from the scatter
///      of the frames around it, with Student's t of F - 2 degrees of freedom (F - 3 for two
///      temperatures). They thus include noise and other differences between frames. Drift with
///      time cannot be distinguished from drift with temperature.
///   4. Together with the lines, fit hysteresis: the coefficient of the sign of the temperature's
///      change.
/// If the two temperatures are collinear (condition number above 30), only the first is fitted.
/// Notes report this, a curved dependence, temperatures that hardly vary, and hysteresis.
/// @param temperatures  finite
/// @param camera        its temperature drift is ignored
/// @throws std::invalid_argument if the number of temperatures differs from the number of frames,
///         temperatures are not finite or all equal, there are fewer than 5 frames (6 for two
///         temperatures), or no pixel is decoded in all frames
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

/// Result of calibrate_stray_light().
struct CalibratedStrayLight {
  Image<float> kernel;            ///< for StrayLight
  std::vector<double> radius_px;  ///< distances from the pixel (J)
  std::vector<Estimate> share;    ///< share of a pixel's light in one pixel at each distance (J)
  Estimate total;                 ///< share of all light that is scattered
  std::int64_t target_pixels = 0;
  std::int64_t pixels = 0;  ///< number of pixels around the target
  std::vector<std::string> notes;
};

/// Determines the stray light of a lens from frames of a small bright target on a black background.
///   1. Average the frames, and subtract the mean of `dark`, or the black level. The target
///      consists of the pixels with at least half the light of the brightest one. The light of a
///      pixel is its component along the target's vector of K measurements, in units of the
///      target's mean.
///   2. Around the target (at least 2 pixels away), light is kernel * target. The kernel depends
///      only on distance: r^2 kernel is piecewise linear in log r, with nodes at ratios of 1.5 from
///      3 pixels on, and constant below. Fit it by least squares, with standard errors from the
///      residuals of the pixels (MacKinnon and White 1985, HC3).
///   3. Compute the target's own light with the kernel, and repeat the fit three times.
/// Any other light around the target counts as stray light, so the background must be black.
/// @param dark  frames with the target covered; may be empty
/// @throws std::invalid_argument if sizes differ, there is no bright pixel, the target is
///         saturated, has fewer than 4 pixels or covers more than a quarter of the image, or the
///         background is not black
CalibratedStrayLight calibrate_stray_light(const RawFrames& frames, const RawFrames& dark,
                                           const Camera& camera, const Progress& progress = {});

/// Writes a table with its correction in the format of read_measured_table().
/// @throws IoError as below
void write_calibrated_table(const std::filesystem::path& path, const MeasuredTable& table,
                            OutputPolicy policy);

/// Writes a calibrated table in the format of read_measured_table(): corrfs, corrfs_se, offset_dn,
/// taps, differences and, if known, ambient and exposure_s. Columns contain the taps of an exposure
/// side by side.
/// @throws IoError unless the extension is .npz, or as AtomicFile
void write_calibrated_table(const std::filesystem::path& path, const CalibratedCorrelation& found,
                            OutputPolicy policy);

/// One harmonic of a measured table compared with that of an ideal code.
struct HarmonicRatio {
  int harmonic = 1;
  double measured = 0.0;  ///< amplitude, root of the sum of squares over measurements
  double ideal = 0.0;     ///< amplitude of the fitted code without impulse responses
  Estimate ratio;         ///< transmission of both arms; NaN if the code does not have the harmonic
};

/// An ideal code fitted to a measured table.
struct IdealCodeFit {
  std::string code;
  double delay_periods = 0.0;   ///< delay of the measured curves
  bool reversed = false;        ///< chi(-z) was measured instead of chi(z)
  bool inverted = false;        ///< all signs are opposite
  std::vector<int> exposure;    ///< exposure of the code for each measured exposure
  double scale = 1.0;           ///< raw numbers per unit of the code's correlation
  double ideal_residual = 0.0;  ///< residual rms / rms of the table, without impulse responses
  double residual = 0.0;        ///< residual rms / rms of the table, with `response`
  ImpulseResponse response;     ///< of each of the two arms; none if it does not improve the fit
  Estimate parameter_hz;        ///< f_max_hz or cutoff_hz of `response`
  Eigen::MatrixXd fitted;       ///< (N, K), without means
  std::vector<HarmonicRatio> harmonics;  ///< 1 to 16
};

/// Fits codes to a measured table, and returns the fits by ascending residual. The parameters are a
/// common scale, delay, direction, sign, the order of exposures, and one symmetric impulse response
/// for both arms (hann, gaussian or lowpass). They are fitted by least squares over harmonics;
/// means of columns are ignored.
/// @param table   (N, K)
/// @param error   standard errors of the table (N, K)
/// @param codes   families or codes that fit the camera's taps, with K measurements
/// @throws std::invalid_argument if no code has K measurements
std::vector<IdealCodeFit> fit_ideal_codes(const Eigen::MatrixXd& table,
                                          const Eigen::MatrixXd& error, const Camera& camera,
                                          const std::vector<CodeSet>& codes);

/// Returns the ideal codes with K measurements: all families for the camera, without impulse
/// responses, peak limit or generator.
std::vector<CodeSet> ideal_codes(const Camera& camera, int measurements);

/// Returns the camera with the fitted impulse responses and the measured tap mismatch.
Camera with_fit(Camera camera, const IdealCodeFit& fit,
                const std::vector<Estimate>& tap_mismatch = {});

}  // namespace tofsmith
