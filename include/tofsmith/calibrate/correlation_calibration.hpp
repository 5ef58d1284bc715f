// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/fields.hpp"
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
enum class DelayUnit {
  second,
  millisecond,
  microsecond,
  nanosecond,
  picosecond,
  metre,
  bin,
  period,
};
constexpr auto words_of(DelayUnit /*any*/) {
  return word_list("s", "ms", "us", "ns", "ps", "m", "bin", "period");
}

/// Frames of a flat target at known delays, in recording order.
struct DelaySweep {
  std::vector<double> delay_periods;  ///< of each frame (F), any real number
  RawFrames frames;                   ///< (F, H, W, K) raw numbers; H = W = 1 for a table of means
  std::vector<std::string> notes;

  /// @throws InvalidArgument unless sizes match and the delays cover a whole period without gaps
  void validate() const;
};

/// Properties of a delay sweep that its file does not contain.
struct DelaySweepOptions {
  std::filesystem::path shifts;
  DelayUnit unit = DelayUnit::second;
  DecimalMark decimal = DecimalMark::automatic;
  std::optional<TableAxes> table_axes;
  std::optional<TapOrder> tap_order;
  bool keep_end_point = false;
};
auto fields_of(ConstOrNot<DelaySweepOptions> auto& o) {
  return std::tuple(
      Field("shifts", o.shifts,
            Help{"delay of each frame of a stack: a text file with one delay per line, or .npy"}),
      Field("unit", o.unit, Help{"unit of the delays: a unit of time, m of depth, bin, or period"}),
      Field("decimal", o.decimal, Help{"decimal mark of a text file"}),
      Field("table_axes", o.table_axes,
            Help{"axes of an array: samples x measurements (nk) or measurements x samples (kn)"}),
      Field("tap_order", o.tap_order, Help{"column order of an array with several taps"}),
      Field("keep_end_point", o.keep_end_point,
            Help{"keep the last row of an array even if it equals the first"}));
}

/// Reads a delay sweep:
///   - text: delay and K values per row,
///   - .npy or .npz of shape (F, H, W, K), together with a list of F shifts,
///   - .npy or .npz of shape (N, K): equal steps over one period, see read_measured_table().
/// @param camera  defines periods, bins and taps
/// @throws IoError if the contents do not match
DelaySweep read_delay_sweep(const std::filesystem::path& path, const Camera& camera,
                            const DelaySweepOptions& options = {});

/// Properties of the camera that recorded a sweep.
struct CorrelationCalibrationOptions {
  int taps = 1;                           ///< columns contain the taps of an exposure side by side
  bool differences = false;               ///< columns are differences of taps
  double range_m = 10.0;                  ///< depth of a period [m], > 0
  Eigen::VectorXd exposure_s;             ///< T [s] (K); empty: equal
  double black_level = 0.0;               ///< raw number without light, unless there are dark
                                          ///< frames
  RawFrames dark;                         ///< frames without light; may be empty
  std::optional<float> saturation_level;  ///< raw numbers at or above it are clipped
  Image<float> geometry_m;  ///< as flat_target_geometry_m(), removed from the offset map; may be
                            ///< empty

  /// @throws InvalidArgument
  void validate(const DelaySweep& sweep) const;
};

/// Number of excluded pixels by the first reason that applies.
struct DeadPixels {
  int not_a_number = 0;
  int constant = 0;
  int saturated = 0;
  int low = 0;
  int total() const { return not_a_number + constant + saturated + low; }
};
auto fields_of(ConstOrNot<DeadPixels> auto& d) {
  return std::tuple(
      Field("not_a_number", d.not_a_number, Help{"pixels that are not a number in some frame"}),
      Field("constant", d.constant, Help{"the same number in all frames"}),
      Field("saturated", d.saturated, Help{"clipped in some frame"}),
      Field("low", d.low, Help{"response below a tenth of the median"}));
}

/// Result of calibrate_correlation().
struct CalibratedCorrelation {
  MeasuredTable table;             ///< of the usual pixel, which has gain 1 and offset 0
  Eigen::MatrixXd standard_error;  ///< (N, K)
  PixelMaps maps;                  ///< offset and gain of each pixel; empty for a table of means
  double delay_error_m = 0.0;      ///< standard error of the offset of a usual pixel
  double gain_error = 0.0;         ///< the same for the gain
  DeadPixels dead;
  bool drift_known = false;            ///< some delay was measured more than once
  bool drift_corrected = false;        ///< drifts above 3 standard errors were removed
  Estimate light_drift;                ///< relative change over the sweep
  Estimate level_drift;                ///< change over the sweep [raw numbers]
  std::vector<Estimate> tap_mismatch;  ///< per exposure of two taps, as Sensor::tap_mismatch
  double noise_rms = 0.0;              ///< of one raw number
  std::string noise_source;            ///< "pixels", "repeats" or "high harmonics"
  std::vector<std::string> notes;
};

/// Computes the measured table of a sweep: the mean curve of all pixels, aligned in delay and gain
/// by least squares, at as many equally spaced positions as were measured. The mean gain is 1 and
/// the mean offset is 0. table.model_error_percent is twice the ratio of the standard errors to the
/// signal; it is too small for pixels with another curve.
/// @throws InvalidArgument if sweep or options are invalid, or all pixels are dead
/// @see docs/calibration.md
CalibratedCorrelation calibrate_correlation(const DelaySweep& sweep,
                                            const CorrelationCalibrationOptions& options,
                                            const Progress& progress = {});

/// Depths of the recorded scene from an independent source, such as another sensor.
struct ReferenceDepth {
  /// Depth along the ray [m], one image per frame or for all frames, of the size of the frames, or
  /// of one pixel for equal depths. Unknown: NaN, infinite or <= 0.
  std::vector<Image<float>> depth_m;
  bool is_z = false;  ///< depth along the optical axis; requires the camera's lens
};

/// Reads reference depth in metres: .npy of shape (H, W), (F, H, W), or (F,) with one distance per
/// frame; .npz, .exr, .pfm or .png (16 bits, mm) with one image.
/// @throws IoError if the contents do not match
ReferenceDepth read_reference_depth(const std::filesystem::path& path);

/// Fitted term of a depth correction.
struct CalibratedTerm {
  std::string name;  ///< offset, cos 4, row^2 column, log signal, ...
  Estimate value_m;
};

/// Harmonic of a correlation function beyond the camera's model.
struct CalibratedHarmonic {
  int harmonic = 2;  ///< multiple of the frequency
  /// Relative to the fundamental, in phase with its maximum.
  Estimate in_phase;
  Estimate quadrature;
};

/// Calibrated properties of one frequency of a code.
struct CalibratedFrequency {
  double frequency_hz = 0.0;
  Estimate offset_m;  ///< that the camera adds to the depth of this frequency
  /// Amplitude relative to the camera's model; the geometric mean over frequencies is 1.
  Estimate contrast;
  /// Harmonics that the frames determine.
  std::vector<CalibratedHarmonic> harmonics;
};

/// Depth error for plots: the error of the nominal depth minus its mean, averaged over the pixels
/// with weight in the fit. NaN if there are none.
struct DepthErrorPicture {
  std::vector<double> depth_m;   ///< centres of equal parts of the range
  std::vector<double> before_m;  ///< mean error in each part
  std::vector<double> after_m;   ///< the same after the correction
  Image<float> before_image_m;   ///< mean over all frames in square cells of pixels
  Image<float> after_image_m;
};

/// Result of calibrate_depth().
struct CalibratedDepth {
  MeasuredTable table;    ///< nominal correlation functions with the correction
  bool reversed = false;  ///< chi(-z) was measured; the table is reversed, too
  /// One per frequency of the code, as in the table; empty for a single frequency.
  std::vector<CalibratedFrequency> frequencies;
  /// Values of playback.offset_m [m] and sensor.modulation_contrast for with_depth(), per
  /// frequency. Empty: the offset is the mean error and the contrast does not change.
  std::vector<double> offsets_m, contrasts;
  std::vector<CalibratedTerm> terms;   ///< for depths within the reference
  std::vector<std::string> far_terms;  ///< terms for all other depths
  double known_share = 0.0;            ///< share of the range that the reference covers
  double mean_error_m = 0.0;           ///< of the nominal depth, in [-range / 2, range / 2]
  double rms_before_m = 0.0;           ///< of this error minus its mean
  /// Remaining error on held-out blocks of pixels; none if too few have weight.
  std::optional<double> rms_m;
  /// Remaining error of far_terms on held-out parts of the range; none for a single distance.
  std::optional<double> far_rms_m;
  /// Number of cross-validation folds that were skipped for lack of data, of 2 folds of blocks and
  /// 4 folds of the range.
  int skipped_folds = 0;
  double outlier_share = 0.0;  ///< pixels without weight
  /// As DecodeOptions::model_error_percent, in steps of 20 % of its value; none without degrees of
  /// freedom.
  std::optional<double> model_error_percent;
  std::int64_t pixels = 0;
  DepthErrorPicture picture;
  std::vector<std::string> notes;
};

/// Determines the depth error of a nominal code from reference depth on any part of the range.
/// Offset, contrast and harmonics of each frequency of a multi-frequency code become part of the
/// table. Other terms are fitted to the decoded depth by least squares with Tukey's biweight and
/// chosen by cross-validation. They depend on the phase predicted from the reference, so that noise
/// does not appear as an error that depends on depth. A model error below the noise of the frames
/// is not found.
/// @throws InvalidArgument if sizes disagree, fewer than 100 pixels can be compared, or the
///         reference is in another unit, flipped, or shows another scene
/// @see docs/calibration.md
CalibratedDepth calibrate_depth(const RawFrames& frames, const ReferenceDepth& reference,
                                const CodeSet& code, const Camera& camera,
                                const Progress& progress = {});

/// Returns the camera with the calibrated offset and direction of delay, for decoding without the
/// table.
Camera with_depth(Camera camera, const CalibratedDepth& found);

/// Temperatures of the frames of a recording.
struct FrameTemperatures {
  std::vector<double> of_camera_c;  ///< of the camera or its light source [degrees C] (F)
  std::vector<double> of_sensor_c;  ///< [degrees C] (F); empty: not measured
};

/// Drift with the temperature of the sensor, as in TemperatureDrift.
struct SensorDrift {
  double mean_c = 0.0;
  Estimate offset_m_per_c;
  Estimate signal_per_c;
  std::vector<double> temperature_c;
};
auto fields_of(ConstOrNot<SensorDrift> auto& d) {
  return std::tuple(Field("mean_c", d.mean_c),
                    Field("offset_m_per_c", d.offset_m_per_c, FieldMark::as_object),
                    Field("signal_per_c", d.signal_per_c, FieldMark::as_object),
                    Field("temperature_c", d.temperature_c));
}

/// Drift of depth and signal with one temperature, or with two for light source and sensor.
struct TemperatureDrift {
  double mean_c = 0.0;
  Estimate offset_m_per_c;
  Estimate signal_per_c;
  Estimate offset_m_per_c2;
  Estimate signal_per_c2;
  double interval_factor = 0.0;
  double offset_rms_m = 0.0;
  double signal_rms = 0.0;
  std::vector<double> temperature_c;  ///< (F), as the next two
  std::vector<double> offset_m;
  std::vector<double> log_signal;
  std::int64_t pixels = 0;
  std::vector<std::string> notes;
  std::optional<SensorDrift> sensor;
  std::optional<Estimate> hysteresis_m;
};
auto fields_of(ConstOrNot<TemperatureDrift> auto& d) {
  return std::tuple(
      Field("mean_c", d.mean_c, Help{"mean temperature of the frames, the origin of both lines"}),
      Field("offset_m_per_c", d.offset_m_per_c, FieldMark::as_object,
            Help{"change of the measured depth with temperature"}),
      Field("signal_per_c", d.signal_per_c, FieldMark::as_object,
            Help{"change of log(signal) with temperature"}),
      Field("offset_m_per_c2", d.offset_m_per_c2, FieldMark::as_object,
            Help{"second-order term of the depth, in addition to the line"}),
      Field("signal_per_c2", d.signal_per_c2, FieldMark::as_object,
            Help{"second-order term of log(signal)"}),
      Field("interval_factor", d.interval_factor,
            Help{"half width of 95 % intervals of the lines, in standard errors"}),
      Field("offset_rms_m", d.offset_rms_m,
            Help{"deviation of the frames from the line of the depth"}),
      Field("signal_rms", d.signal_rms, Help{"the same for log(signal)"}),
      Field("temperature_c", d.temperature_c, Help{"temperature of each frame"}),
      Field("offset_m", d.offset_m,
            Help{"offset of each frame relative to the mean of all frames"}),
      Field("log_signal", d.log_signal, Help{"the same for log(signal)"}),
      Field("pixels", d.pixels, Help{"number of pixels that decode in every frame"}),
      Field("notes", d.notes),
      Field("sensor", d.sensor,
            Help{"drift with the temperature of the sensor, if it was fitted; the other "
                 "attributes then refer to the temperature of the light source"}),
      Field("hysteresis_m", d.hysteresis_m, FieldMark::as_object,
            Help{"offset at rising minus offset at falling temperature; none unless it does "
                 "both"}));
}

/// Determines the drift with temperature from frames of a static scene. The offset of a frame is
/// the median over the pixels that are ok in all frames, weighted by the inverse predicted
/// variance, of depth minus the pixel's circular mean over frames. Lines over each temperature and
/// hysteresis, the coefficient of the sign of the temperature's change, are fitted; intervals use
/// Student's t of F - 2 degrees of freedom (F - 3 for two temperatures). If the two temperatures
/// are collinear (condition number above 30), only the first is fitted, with a note.
/// @param camera  its temperature drift is ignored
/// @throws InvalidArgument if sizes differ, temperatures are not finite or all equal, there are
///         fewer than 5 frames (6 for two temperatures), or no pixel is decoded in all frames
/// @see docs/calibration.md
TemperatureDrift calibrate_temperature(const RawFrames& frames,
                                       const FrameTemperatures& temperatures, const CodeSet& code,
                                       const Camera& camera, const Progress& progress = {});
/// Returns the camera with this drift.
/// @param reference_c  temperature of the other calibrations; none: the mean of the frames
/// @throws InvalidArgument for a sensor_reference_c without drift of the sensor
Camera with_temperature(Camera camera, const TemperatureDrift& found,
                        std::optional<double> reference_c = {},
                        std::optional<double> sensor_reference_c = {});

/// Result of calibrate_stray_light().
struct CalibratedStrayLight {
  Image<float> kernel;            ///< for StrayLight
  std::vector<double> radius_px;  ///< (J)
  std::vector<Estimate> share;    ///< (J)
  Estimate total;
  std::int64_t target_pixels = 0;
  std::int64_t pixels = 0;
  std::vector<std::string> notes;
};
auto fields_of(ConstOrNot<CalibratedStrayLight> auto& s) {
  return std::tuple(
      Field("kernel", s.kernel,
            Help{"share of a pixel's light that is scattered to each other pixel, the centre "
                 "being the pixel itself, (2 R + 1, 2 R + 1)"}),
      Field("radius_px", s.radius_px, Help{"distances from the pixel"}),
      Field("share", s.share, FieldMark::as_object,
            Help{"share of a pixel's light in one pixel at each distance"}),
      Field("total", s.total, FieldMark::as_object, Help{"scattered share of all light"}),
      Field("target_pixels", s.target_pixels, Help{"number of pixels of the target"}),
      Field("pixels", s.pixels, Help{"number of pixels around the target"}),
      Field("notes", s.notes));
}

/// Determines the stray light of a lens from frames of a small bright target, the pixels with at
/// least half the light of the brightest one, on a black background. The kernel depends on distance
/// only: r^2 kernel is piecewise linear in log r, with nodes at ratios of 1.5 from 3 pixels on, and
/// constant below. Standard errors follow from the residuals (MacKinnon and White 1985, HC3).
/// @param dark  frames with the target covered; may be empty
/// @throws InvalidArgument if sizes differ, there is no bright pixel, the target is saturated, has
///         fewer than 4 pixels or covers more than a quarter of the image, or the background is not
///         black
CalibratedStrayLight calibrate_stray_light(const RawFrames& frames, const RawFrames& dark,
                                           const Camera& camera, const Progress& progress = {});

/// Writes a table with its correction in the format of read_measured_table().
/// @throws IoError as below
void write_calibrated_table(const std::filesystem::path& path, const MeasuredTable& table,
                            OutputPolicy policy);

/// Writes a calibrated table in the format of read_measured_table(): corrfs, corrfs_se, offset_dn,
/// taps, differences and, if known, ambient and exposure_s.
/// @throws IoError unless the extension is .npz, or as AtomicFile
void write_calibrated_table(const std::filesystem::path& path, const CalibratedCorrelation& found,
                            OutputPolicy policy);

/// Harmonic of a measured table compared with an ideal code.
struct HarmonicRatio {
  int harmonic = 1;
  double measured = 0.0;
  double ideal = 0.0;
  Estimate ratio;
};
auto fields_of(ConstOrNot<HarmonicRatio> auto& h) {
  return std::tuple(
      Field("harmonic", h.harmonic),
      Field("measured", h.measured, Help{"root of the sum of squares over measurements"}),
      Field("ideal", h.ideal, Help{"the same of the fitted code without impulse responses"}),
      Field("ratio", h.ratio, FieldMark::as_object,
            Help{"transfer of both arms; NaN if the code does not have the harmonic"}));
}

/// An ideal code fitted to a measured table.
struct IdealCodeFit {
  std::string code;
  double delay_periods = 0.0;
  bool reversed = false;
  bool inverted = false;
  std::vector<int> exposure;
  double scale = 1.0;
  double ideal_residual = 0.0;
  double residual = 0.0;
  ImpulseResponse response;
  Estimate parameter_hz;
  Eigen::MatrixXd fitted;
  std::vector<HarmonicRatio> harmonics;
};
auto fields_of(ConstOrNot<IdealCodeFit> auto& f) {
  return std::tuple(
      Field("code", f.code),
      Field("delay_periods", f.delay_periods,
            Help{"delay of the measured curves relative to the code"}),
      Field("reversed", f.reversed, Help{"delay runs in the opposite direction"}),
      Field("inverted", f.inverted, Help{"all signs are opposite"}),
      Field("exposure", f.exposure, Help{"exposure of the code for each measured exposure"}),
      Field("scale", f.scale, Help{"raw numbers per unit of the code's correlation"}),
      Field("ideal_residual", f.ideal_residual,
            Help{"rms residual relative to the rms of the table, without impulse responses"}),
      Field("residual", f.residual, Help{"the same with `response`"}),
      Field("response", f.response,
            Help{"response of each arm, equal for both; none if it does not improve the fit"}),
      Field("parameter_hz", f.parameter_hz, FieldMark::as_object,
            Help{"`f_max_hz` or `cutoff_hz` of `response`"}),
      Field("fitted", f.fitted, Help{"fitted table, (N, K), without means"}),
      Field("harmonics", f.harmonics, FieldMark::as_object, Help{"harmonics 1 to 16"}));
}

/// Fits codes to a measured table, and returns the fits by ascending residual. Parameters are
/// scale, delay, direction, sign, the order of exposures, and one symmetric impulse response for
/// both arms (hann, gaussian or lowpass), by least squares over harmonics without the mean.
/// @param table  (N, K)
/// @param error  standard errors (N, K)
/// @param codes  for the camera's taps, with K measurements
/// @throws InvalidArgument if no code has K measurements
std::vector<IdealCodeFit> fit_ideal_codes(const Eigen::MatrixXd& table,
                                          const Eigen::MatrixXd& error, const Camera& camera,
                                          const std::vector<CodeSet>& codes);

/// Returns all families with K measurements for the camera, without impulse responses, peak limit
/// or generator.
std::vector<CodeSet> ideal_codes(const Camera& camera, int measurements);

/// Returns the camera with the fitted impulse responses and the measured tap mismatch.
Camera with_fit(Camera camera, const IdealCodeFit& fit,
                const std::vector<Estimate>& tap_mismatch = {});

}  // namespace tofsmith
