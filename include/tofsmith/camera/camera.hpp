// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tofsmith/camera/generator.hpp"
#include "tofsmith/camera/impulse_response.hpp"
#include "tofsmith/camera/lens.hpp"
#include "tofsmith/camera/operating_range.hpp"
#include "tofsmith/camera/optics.hpp"
#include "tofsmith/camera/square_light.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/field_visitor.hpp"
#include "tofsmith/core/raw_markers.hpp"

namespace tofsmith {

/// Distribution from which the noise of electrons is drawn.
enum class NoiseModel {
  poisson,   ///< Poisson electrons plus Gaussian read noise
  gaussian,  ///< one Gaussian with the same variance, as in the paper
};
inline constexpr std::array<std::string_view, 2> noise_models = {"poisson", "gaussian"};

/// Values that the sensor reads out of one exposure.
enum class Readout {
  separate,    ///< each tap
  difference,  ///< the difference A - B of two taps, with the shot and read noise of both
  /// Rows: weighted sums of the light in N time bins of one exposure, with weights of any sign. All
  /// rows measure the same light, so that their noise is correlated. Dead time is ignored.
  rows,
};
inline constexpr std::array<std::string_view, 3> readouts = {"separate", "difference", "rows"};

/// Factor by which the sensor multiplies the light.
enum class Demodulation {
  gain,    ///< in [0, 1]: taps collect charge while their gates are open
  weight,  ///< in [-1, 1]: a mixer; shot noise grows with the square of the weight
};
inline constexpr std::array<std::string_view, 2> demodulations = {"gain", "signed"};

/// The modulated light source.
struct LightSource {
  double peak_factor = 15.0;  ///< p = P_max / P_ave
  bool binary = true;         ///< designed waveforms only switch on and off
  ImpulseResponse impulse_response;
  double edge_jitter_s = 0.0;
  std::optional<Generator> generator;  ///< generates the modulation; none: any waveform, exactly
  std::optional<SquareLight> square;   ///< square waves for DesignMethod::frequencies

  friend bool operator==(const LightSource&, const LightSource&) = default;
};

/// Keys of [light].
inline void describe(FieldVisitor& fields, LightSource& light) {
  fields.value(Key("peak_factor", "Ratio of peak to mean optical power", at_least(1))
                   .because("the peak is never below the average")
                   .usually(1, 60),
               light.peak_factor);
  fields.value(Key("binary", "Designed waveforms only switch on and off").basic(), light.binary);
  fields.table(Key("impulse_response", "Impulse response of the light source"),
               light.impulse_response);
  fields.value(Key("edge_jitter_s", "Root mean square displacement of edges from period to period",
                   at_least(0)),
               light.edge_jitter_s);
  fields.table(Key("generator", "Waveform generator of the modulation"), light.generator);
  fields.part(Key("square", "Square waves that the design method frequencies can use"),
              light.square);
}

/// The demodulating pixel.
struct Sensor {
  int taps = 1;        ///< values per exposure; 2: two buckets; more: exclusive taps
  bool binary = true;  ///< designed waveforms only switch on and off
  ImpulseResponse impulse_response;
  double edge_jitter_s = 0.0;
  std::optional<Generator> generator;  ///< generates the demodulation; none: any waveform, exactly
  double read_noise_e = 20.0;
  NoiseModel noise = NoiseModel::poisson;
  double dark_current_e_per_s = 0.0;
  double modulation_contrast = 1.0;               ///< C; below 1 the taps mix
  std::vector<double> modulation_contrasts = {};  ///< per exposure or frequency; empty: the above
  /// m: the first, third, ... tap has the sensitivity 1 + m / 2, the others have 1 - m / 2. With
  /// one tap, the same applies to exposures.
  double tap_mismatch = 0.0;
  std::optional<double> full_well_e;
  std::optional<int> adc_bits;
  std::optional<double> gain_e_per_dn;   ///< with adc_bits
  std::optional<double> black_level_dn;  ///< with adc_bits
  std::optional<double> shortest_pulse_s;
  bool drain = true;  ///< false: the gains of all taps add up to 1
  Readout readout = Readout::separate;
  Demodulation demodulation = Demodulation::gain;
  std::optional<double> readout_gap_s;   ///< none: 0
  std::optional<double> frame_period_s;  ///< none: duration of the exposures
  std::optional<int> max_exposures;      ///< for DesignMethod::frequencies; none: 8
  std::optional<std::vector<double>> integration_times_s;  ///< of one exposure; none: any

  std::vector<double> contrasts_of(const CodeSet& code) const;  ///< per exposure, if the code fits
  bool is_signed() const { return demodulation == Demodulation::weight; }  ///< a mixer
  /// Returns true if an exposure has several taps, which a contrast below 1 mixes.
  bool mixes_taps() const { return taps >= 2 || is_signed(); }
  /// Returns true if measurements are differences of light, in which ambient light may cancel, but
  /// not its noise.
  bool subtracts() const { return is_signed() || readout == Readout::difference; }

  friend bool operator==(const Sensor&, const Sensor&) = default;
};

/// Keys of [sensor].
inline void describe(FieldVisitor& fields, Sensor& sensor) {
  fields.value(
      Key("taps", "Values that are read out of one exposure; 2: two buckets", closed(1, 16))
          .usually(1, 4),
      sensor.taps);
  fields.value(Key("binary", "Designed waveforms only switch on and off").basic(), sensor.binary);
  fields.table(Key("impulse_response", "Impulse response of the sensor"), sensor.impulse_response);
  fields.value(Key("edge_jitter_s", "Root mean square displacement of edges from period to period",
                   at_least(0)),
               sensor.edge_jitter_s);
  fields.table(Key("generator", "Waveform generator of the demodulation"), sensor.generator);
  fields.value(Key("read_noise_e", "Standard deviation of the noise of one readout", at_least(0))
                   .usually(0, 100),
               sensor.read_noise_e);
  fields.choice(Key("noise",
                    "Poisson electrons with Gaussian read noise, or one Gaussian with the "
                    "same variance")
                    .basic(),
                sensor.noise, noise_models);
  fields.value(Key("dark_current_e_per_s",
                   "Dark current of a tap; for rows, of all time bins together", at_least(0)),
               sensor.dark_current_e_per_s);
  fields.value(Key("modulation_contrast",
                   "Demodulation contrast; a list contains one value per "
                   "exposure or per frequency of the code",
                   left_open(0, 1))
                   .usually(0.1, 1),
               NumberOrList{sensor.modulation_contrast, sensor.modulation_contrasts});
  fields.value(Key("tap_mismatch",
                   "Relative difference in sensitivity of neighbouring taps, or of "
                   "neighbouring exposures of a single tap",
                   open(-1, 1)),
               sensor.tap_mismatch);
  fields.value(Key("full_well_e", "Number of electrons at which a tap saturates", above(0)),
               sensor.full_well_e);
  fields.value(
      Key("adc_bits", "Resolution of the converter; requires gain_e_per_dn", closed(1, 24)),
      sensor.adc_bits);
  fields.value(Key("gain_e_per_dn", "Electrons per count; requires adc_bits", above(0)),
               sensor.gain_e_per_dn);
  fields.value(Key("black_level_dn", "Count without light; requires adc_bits", at_least(0)),
               sensor.black_level_dn);
  fields.value(Key("shortest_pulse_s", "Shortest pulse or gap that a design may use", above(0)),
               sensor.shortest_pulse_s);
  fields.value(Key("drain", "Charge can be discarded; otherwise the gains of all taps add up to 1"),
               sensor.drain);
  fields.choice(Key("readout",
                    "Each tap, the difference of two taps, or rows: weighted sums of the "
                    "light in the time bins of one exposure")
                    .basic(),
                sensor.readout, readouts);
  fields.choice(
      Key("demodulation", "Gain of taps in [0, 1], or signed weight of a mixer in [-1, 1]"),
      sensor.demodulation, demodulations);
  fields.value(Key("readout_gap_s", "Dark time after each exposure", at_least(0)),
               sensor.readout_gap_s);
  fields.value(Key("frame_period_s",
                   "Time from frame to frame; without it, the exposures follow one "
                   "another",
                   above(0)),
               sensor.frame_period_s);
  fields.value(Key("max_exposures", "Maximum number of exposures for the design method frequencies",
                   closed(1, 16)),
               sensor.max_exposures);
  fields.value(Key("integration_times_s",
                   "Possible integration times of one exposure for the design method frequencies "
                   "(default: any); the times of a code add up to exposure_s",
                   above(0)),
               sensor.integration_times_s);
}

/// Integration time: a total that is split between the exposures, or one time per exposure.
struct ExposureTime {
  double total_s = 0.3;        ///< [s]; used if `each_s` is empty
  std::vector<double> each_s;  ///< [s]; must match the number of exposures of the code
  double of(int exposure, int exposures) const;

  friend bool operator==(const ExposureTime&, const ExposureTime&) = default;
};

/// Differences between the exposures of a camera and of the code, as found by a calibration.
/// Measured tables already contain them.
struct Playback {
  /// Exposure of the code that the camera records first, second, ...: a permutation of 0, 1, ...
  /// Empty: the order of the code.
  std::vector<int> order;
  bool reversed = false;  ///< chi(-z) is measured instead of chi(z)
  bool inverted = false;  ///< taps are swapped; a single tap is open where the code closes it
  double offset_m = 0.0;  ///< constant that the camera adds to depth
  /// Constant per exposure or frequency of the code; empty: offset_m.
  std::vector<double> offsets_m;
  /// Constant per exposure or frequency, as phase of its frequency [rad]; replaces offset_m.
  std::vector<double> offset_rad;
  /// As offset_rad, but in counts; one period has counts_per_period. Replaces offset_m.
  std::vector<double> offset_counts;
  double counts_per_period = 4096.0;

  bool has_list() const {
    return !offsets_m.empty() || !offset_rad.empty() || !offset_counts.empty();
  }
  /// Replaces all offsets. @param list  as offsets_m
  void set_offsets_m(std::vector<double> list) {
    offset_m = 0.0;
    offsets_m = std::move(list);
    offset_rad.clear();
    offset_counts.clear();
  }
  /// Returns the constant that the camera adds to the depth of each exposure of a code [m].
  /// @param range_m  depth of a period of the fundamental frequency
  /// @throws InvalidArgument if a list does not have one value per exposure or frequency
  std::vector<double> offsets_of(const CodeSet& code, double range_m) const;

  /// @throws std::invalid_argument naming the field as playback.*, value and rule
  void validate(int taps) const;

  friend bool operator==(const Playback&, const Playback&) = default;
};

/// Keys of [playback].
inline void describe(FieldVisitor& fields, Playback& playback) {
  fields.value(Key("order", "Order in which the camera measures the exposures of the code",
                   closed(0, 65535)),
               playback.order);
  fields.value(Key("reversed", "Measured delay decreases with distance: chi(-z) instead of chi(z)"),
               playback.reversed);
  fields.value(Key("inverted", "Signs are opposite: taps are swapped"), playback.inverted);
  fields.value(Key("offset_m",
                   "Constant that the camera adds to depth; a list contains one value per "
                   "exposure or per frequency of the code",
                   finite()),
               NumberOrList{playback.offset_m, playback.offsets_m});
  fields.value(Key("offset_rad",
                   "Constant that the camera adds to the phase of each exposure or of each "
                   "frequency of the code",
                   finite()),
               playback.offset_rad);
  fields.value(Key("offset_counts", "As offset_rad, in counts", finite()), playback.offset_counts);
  fields.value(
      Key("counts_per_period", "Counts of one period of the phase, for offset_counts", above(0)),
      playback.counts_per_period);
}

/// Dependence of depth and signal on the temperature of the sensor, as in Temperature.
struct SensorTemperature {
  double reference_c = 25.0;
  double offset_m_per_c = 0.0;
  double signal_per_c = 0.0;
  std::optional<double> now_c;

  double above_reference_c() const { return now_c.value_or(reference_c) - reference_c; }

  friend bool operator==(const SensorTemperature&, const SensorTemperature&) = default;
};

/// Dependence of depth and signal on the temperature of the camera, as a calibration finds it.
/// Measured tables are valid at the reference temperature. With `sensor`, there are two
/// temperatures, whose changes add up: that of the light source, and that of the sensor.
struct Temperature {
  double reference_c = 25.0;
  double offset_m_per_c = 0.0;
  double signal_per_c = 0.0;    ///< d log(signal) per degree: 0.01 is about 1 % more
  std::optional<double> now_c;  ///< none: the reference
  /// Absent if a single temperature is known.
  std::optional<SensorTemperature> sensor;

  /// Degrees above the reference.
  double above_reference_c() const { return now_c.value_or(reference_c) - reference_c; }
  /// Change of the measured depth by all temperatures [m].
  double offset_m() const;
  /// Signal divided by the signal at the reference temperatures.
  double signal_gain() const;

  /// @throws std::invalid_argument naming the field as temperature.*, value and rule
  void validate() const;

  friend bool operator==(const Temperature&, const Temperature&) = default;
};

/// Keys of the dependence on one temperature.
void describe_one_temperature(FieldVisitor& fields, auto& temperature) {
  fields.value(Key("reference_c", "Temperature at which the camera was calibrated", finite()),
               temperature.reference_c);
  fields.value(Key("offset_m_per_c", "Change of the measured depth per degree", finite()),
               temperature.offset_m_per_c);
  fields.value(Key("signal_per_c", "Relative change of the signal per degree", finite()),
               temperature.signal_per_c);
  fields.value(Key("now_c", "Present temperature; without it, the reference", finite()),
               temperature.now_c);
}

/// Keys of [temperature.sensor].
inline void describe(FieldVisitor& fields, SensorTemperature& sensor) {
  describe_one_temperature(fields, sensor);
}

/// Keys of [temperature].
inline void describe(FieldVisitor& fields, Temperature& temperature) {
  describe_one_temperature(fields, temperature);
  fields.table(Key("sensor",
                   "Dependence on the temperature of the sensor; the other keys then describe the "
                   "light source"),
               temperature.sensor);
}

/// A continuous-wave time-of-flight camera. Field names are the keys of a camera file.
struct Camera {
  std::string name = "camera";
  double fundamental_frequency_hz = 15e6;  ///< f0
  ExposureTime exposure_s;
  int samples = 240;  ///< N
  LightSource light;
  Sensor sensor;
  RawMarkers raw;
  std::optional<Lens> lens;      ///< none: no point clouds
  std::optional<LensBlur> blur;  ///< none: sharp
  std::optional<Optics> optics;  ///< none: light levels are known in electrons only
  OperatingRange operating;
  std::optional<Playback> playback;        ///< none: exposures are as in the code
  std::optional<Temperature> temperature;  ///< none: no dependence

  /// Returns the time between the beginnings of consecutive frames [s]: sensor.frame_period_s, or
  /// the duration of the exposures with their gaps.
  /// @throws std::invalid_argument if frame_period_s is shorter than the exposures
  double frame_period_s(int exposures) const;
  /// Returns the time from the beginning of frame 0 to the middle of an exposure [s]. Each exposure
  /// is followed by a gap.
  double exposure_middle_s(int frame, int exposure, int exposures) const;
  /// Returns the time from the beginning of frame 0 to the middle of a frame [s], which is half-way
  /// between the beginning of its first exposure and the end of its last one.
  double frame_middle_s(int frame, int exposures) const;

  /// Unambiguous range [m]: c / (2 f0).
  double range_m() const;
  /// Depth of one bin [m]: range / N.
  double bin_m() const;
  /// Returns H_d(n f0) conj(H_m(n f0)) for n = 0 to `highest`: the transfer function of both arms
  /// together, the light source (H_m) and the sensor (H_d). For rows it is conj(H_d H_m), because
  /// the responses of both arms delay the detected light.
  Eigen::VectorXcd transfer(int highest) const;
  /// Returns H_m(n f0) of the light alone. With edge jitter (independent normal displacements of
  /// rms s in every period), the mean waveform is blurred by the normal density, so that the
  /// transfer function has the additional factor exp(-(2 pi n f0 s)^2 / 2).
  Eigen::VectorXcd light_transfer(int highest) const;
  /// Returns H_d(n f0) of the sensor alone, with its jitter.
  Eigen::VectorXcd sensor_transfer(int highest) const;
  /// Returns true if either arm has an impulse response or jitter.
  bool band_limited() const;
  /// Returns true if the light source has an impulse response or jitter.
  bool light_is_band_limited() const;

  /// @throws std::invalid_argument naming the field, its value and the broken rule
  void validate() const;

  friend bool operator==(const Camera&, const Camera&) = default;
};

/// Keys of a camera file.
inline void describe(FieldVisitor& fields, Camera& camera) {
  fields.value(Key("name", "Name of the camera in reports; the name of the file by default"),
               camera.name);
  fields.value(Key("fundamental_frequency_hz",
                   "Fundamental frequency: the greatest common divisor of all modulation "
                   "frequencies",
                   at_least(1e3))
                   .because("it is in Hz, 20 MHz are 20e6")
                   .required("15e6")
                   .usually(1e6, 3e8),
               camera.fundamental_frequency_hz);
  fields.value(Key("exposure_s",
                   "Total integration time, split evenly between the exposures unless the code "
                   "contains exposure_shares; or a list with one time per exposure",
                   above(0))
                   .usually(1e-5, 1.0),
               NumberOrList{camera.exposure_s.total_s, camera.exposure_s.each_s});
  fields.value(
      Key("samples", "N, the number of samples and of depth bins per period", closed(8, 65536))
          .usually(60, 2000),
      camera.samples);
  fields.table(Key("light", "Light source"), camera.light);
  fields.table(Key("sensor", "Demodulating pixel"), camera.sensor);
  fields.table(Key("raw", "Special raw numbers"), camera.raw);
  fields.table(Key("lens", "Pinhole, distortion and blur of the lens"), camera,
               [](FieldVisitor& inner, Camera& its) {
                 inner.part(Key("pinhole", "Pinhole of the sensor and distortion of its lens"),
                            its.lens);
                 inner.part(Key("blur", "Blur of the lens in simulations"), its.blur);
               });
  fields.table(Key("optics", "Relation of watts and lux to electrons"), camera.optics);
  fields.table(Key("operating",
                   "Conditions under which codes are evaluated: every pair of signal "
                   "and ambient light"),
               camera.operating);
  fields.table(Key("playback",
                   "Differences between the exposures of the camera and the exposures of "
                   "the code"),
               camera.playback);
  fields.table(Key("temperature", "Dependence of depth and signal on the temperature"),
               camera.temperature);
}

/// Returns the camera with operating points for surfaces of the given albedo at each of these
/// distances, computed by its optics, brightest first.
/// @param klux  sunlight on the surfaces, overrides that of the optics
/// @throws std::invalid_argument naming field, value and rule; also for a camera without optics
Camera at_distances(Camera camera, std::vector<double> distances_m, double albedo = 1.0,
                    std::optional<double> klux = {});

/// Returns the default light of captures: the signal that the camera's optics receive from white
/// surfaces at the given distance, and the ambient light from their sunlight. Without optics, both
/// are taken from the middle operating point. If the optics have no sunlight, only the ambient
/// light is taken from there.
OperatingPoint capture_light(const Camera& camera, double reference_distance_m);

/// Returns the camera on which codes are evaluated: one whose single pixels measure the sum of
/// `operating.neighbours` = n pixels. Exposures, gaps, frame period, full well and saturation of
/// the converter are n times as large. The read noise, including quantization, is sqrt(n) times as
/// large. The black level is assumed to be so high that the converter clips no small values.
/// Returns the camera itself for n = 1.
/// @throws std::invalid_argument if the camera is invalid
Camera judged_camera(const Camera& camera);

/// Returns the integration times of the exposures in the order of the camera [s]: its list, or its
/// total, split by the shares of the code.
/// @throws InvalidArgument if the camera lists times for another number of exposures
std::vector<double> exposure_times_s(const CodeSet& code, const Camera& camera);
/// Returns the camera with a list of the integration times of a code; unchanged for equal shares.
Camera timed_by(const CodeSet& code, Camera camera);

/// Returns why a valid `camera` does not support `code`: taps, samples, peak, exposures, light that
/// no tap collects although there is no drain, or pulses that are too short. None: it is supported.
std::optional<std::string> why_not_playable(const CodeSet& code, const Camera& camera);

/// @throws InvalidArgument with the text of why_not_playable() if the camera does not support the
///         code
void require_fits(const CodeSet& code, const Camera& camera);

/// Returns the camera with two buckets that is equivalent to a mixer: the buckets are open where a
/// binary weight is 1 and -1, respectively, and their difference is the mixer's measurement. Each
/// bucket has half of the mixer's noise variance without light. Full well, converter and mismatch
/// are removed. Returns other cameras unchanged.
Camera in_buckets(Camera camera);

/// Returns why the family `name` cannot be built for the camera. None: build_family() succeeds.
std::optional<std::string> why_no_family(std::string_view name, const Camera& camera);

/// Builds the family `name` for the camera: with its number of samples, and without exceeding its
/// peak. For a sensor with two taps, every demodulation gets its complement as second bucket. For a
/// mixer, demodulations become weights from -1 to 1.
/// @throws InvalidArgument with the text of why_no_family()
CodeSet build_family(std::string_view name, const Camera& camera);

/// Source of a number in the description of a camera.
struct NumberSource {
  std::string key;     ///< "sensor.taps", or a table or value with several keys
  std::string source;  ///< data sheet or paper, by name
};

/// Entry in the list of built-in cameras: cameras of the paper and some commercial ones.
struct BuiltInCamera {
  std::string name;
  std::string description;  ///< one line
  /// Family of its raw frames, or one that suits it (list_families()); "": none.
  std::string code;
  std::vector<NumberSource> sources;

  /// Returns the source of a key such as "light.peak_factor"; "assumed" if it is unknown.
  std::string source_of(std::string_view key) const;
};

/// Built-in camera that commands use by default.
inline constexpr std::string_view default_camera_name = "indoor";

/// Returns all built-in cameras. See built_in_camera() and built_in_camera_toml().
std::vector<BuiltInCamera> list_built_in_cameras();
/// Returns the names of all built-in cameras.
std::vector<std::string> built_in_camera_names();
/// @throws std::invalid_argument for an unknown name, with the most similar known name
Camera built_in_camera(const std::string& name);

}  // namespace tofsmith
