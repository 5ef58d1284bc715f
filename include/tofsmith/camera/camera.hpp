// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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
constexpr auto words_of(NoiseModel /*any*/) { return word_list("poisson", "gaussian"); }

/// Values that the sensor reads out of one exposure.
enum class Readout {
  separate,    ///< each tap
  difference,  ///< A - B of two taps, with the noise of both
  /// Weighted sums of the light in N time bins of one exposure, with weights of any sign. All rows
  /// measure the same light, so that their noise is correlated. Dead time is ignored.
  rows,
};
constexpr auto words_of(Readout /*any*/) { return word_list("separate", "difference", "rows"); }

/// Coordinates in which zncc compares rows.
enum class RowDecoder {
  whitened,  ///< in which the noise at the middle operating point is white
  plain,     ///< rows minus their mean, unweighted: for receivers that cannot whiten
};
constexpr auto words_of(RowDecoder /*any*/) { return word_list("whitened", "plain"); }

/// Factor by which the sensor multiplies the light.
enum class Demodulation {
  gain,    ///< in [0, 1], of taps that collect charge
  weight,  ///< in [-1, 1]: a mixer; shot noise grows with the square of the weight
};
constexpr auto words_of(Demodulation /*any*/) { return word_list("gain", "signed"); }

struct LightSource {
  double peak_factor = 15.0;  ///< p = P_max / P_ave
  bool binary = true;
  ImpulseResponse impulse_response;
  double edge_jitter_s = 0.0;
  std::optional<Generator> generator;  ///< none: any waveform, exactly
  std::optional<SquareLight> square;   ///< for DesignMethod::frequencies

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

struct Sensor {
  int taps = 1;  ///< 2: two buckets; more: exclusive taps
  bool binary = true;
  ImpulseResponse impulse_response;
  double edge_jitter_s = 0.0;
  std::optional<Generator> generator;  ///< none: any waveform, exactly
  double read_noise_e = 20.0;
  NoiseModel noise = NoiseModel::poisson;
  double dark_current_e_per_s = 0.0;
  double modulation_contrast = 1.0;               ///< C; below 1 the taps mix
  std::vector<double> modulation_contrasts = {};  ///< per exposure or frequency; empty: the above
  /// m: the first, third, ... tap has the sensitivity 1 + m / 2, the others 1 - m / 2. With one
  /// tap, the same applies to exposures.
  double tap_mismatch = 0.0;
  std::optional<double> full_well_e;
  std::optional<int> adc_bits;
  std::optional<double> gain_e_per_dn;
  std::optional<double> black_level_dn;
  std::optional<double> shortest_pulse_s;
  bool drain = true;
  Readout readout = Readout::separate;
  RowDecoder decoder = RowDecoder::whitened;  ///< for Readout::rows
  Demodulation demodulation = Demodulation::gain;
  std::optional<double> readout_gap_s;                     ///< none: 0
  std::optional<double> frame_period_s;                    ///< none: duration of the exposures
  std::optional<int> max_exposures;                        ///< none: 8
  std::optional<std::vector<double>> integration_times_s;  ///< none: any

  std::vector<double> contrasts_of(const CodeSet& code) const;  ///< per exposure, if the code fits
  bool is_signed() const { return demodulation == Demodulation::weight; }  ///< a mixer
  /// Returns true if a contrast below 1 mixes several taps.
  bool mixes_taps() const { return taps >= 2 || is_signed(); }
  /// Returns true if measurements are differences of light, in which ambient light, but not its
  /// noise, may cancel.
  bool subtracts() const { return is_signed() || readout == Readout::difference; }

  friend bool operator==(const Sensor&, const Sensor&) = default;
};

/// Keys of [sensor].
inline void describe(FieldVisitor& fields, Sensor& sensor) {
  fields.value(
      Key("taps", "Number of values that are read out per exposure; 2: two buckets", closed(1, 16))
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
                sensor.noise);
  fields.value(Key("dark_current_e_per_s",
                   "Dark current of a tap; if the sensor reads out rows, of all time bins "
                   "together",
                   at_least(0)),
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
                    "Values that are read out: each tap, the difference of two taps, or rows, "
                    "which are weighted sums of the light in the time bins of one exposure")
                    .basic(),
                sensor.readout);
  fields.choice(Key("decoder",
                    "Coordinates in which zncc compares rows: whitened, with white noise, or "
                    "plain, the rows minus their mean")
                    .only(sensor.readout == Readout::rows, "readout = \"rows\""),
                sensor.decoder);
  fields.choice(
      Key("demodulation", "Gain of taps in [0, 1], or signed weight of a mixer in [-1, 1]"),
      sensor.demodulation);
  fields.value(Key("readout_gap_s", "Dark time after each exposure", at_least(0)),
               sensor.readout_gap_s);
  fields.value(Key("frame_period_s",
                   "Time from frame to frame; without it, the exposures follow one "
                   "another",
                   above(0)),
               sensor.frame_period_s);
  fields.value(
      Key("max_exposures", "Maximum number of exposures for the design method `frequencies`",
          closed(1, 16)),
      sensor.max_exposures);
  fields.value(Key("integration_times_s",
                   "Possible integration times of one exposure for the design method "
                   "`frequencies` (default: any); the times of a code add up to exposure_s",
                   above(0)),
               sensor.integration_times_s);
}

/// Total integration time that is split between the exposures, or one time per exposure.
struct ExposureTime {
  double total_s = 0.3;        ///< used if `each_s` is empty
  std::vector<double> each_s;  ///< one per exposure of the code
  double of(int exposure, int exposures) const;
  double sum_s() const;

  friend bool operator==(const ExposureTime&, const ExposureTime&) = default;
};

/// Differences between the exposures of a camera and of the code. Measured tables already contain
/// them.
struct Playback {
  /// Exposures of the code in the order of the camera: a permutation of 0, 1, ... Empty: the same
  /// order.
  std::vector<int> order;
  bool reversed = false;  ///< chi(-z) is measured
  bool inverted = false;  ///< taps are swapped; a single tap is open where the code closes it
  double offset_m = 0.0;
  /// Per exposure or frequency of the code; empty: offset_m.
  std::vector<double> offsets_m;
  /// As offsets_m, as phase of the exposure's frequency; replaces offset_m.
  std::vector<double> offset_rad;
  /// As offset_rad, in counts.
  std::vector<double> offset_counts;
  double counts_per_period = 4096.0;

  bool has_list() const {
    return !offsets_m.empty() || !offset_rad.empty() || !offset_counts.empty();
  }
  /// Replaces all offsets.
  void set_offsets_m(std::vector<double> list) {
    offset_m = 0.0;
    offsets_m = std::move(list);
    offset_rad.clear();
    offset_counts.clear();
  }
  /// Returns the constant that the camera adds to the depth of each exposure of a code [m].
  /// @throws InvalidArgument if a list does not have one value per exposure or frequency
  std::vector<double> offsets_of(const CodeSet& code, double range_m) const;

  /// @throws InvalidArgument
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

/// Dependence on the temperature of the sensor, as in Temperature.
struct SensorTemperature {
  double reference_c = 25.0;
  double offset_m_per_c = 0.0;
  double signal_per_c = 0.0;
  std::optional<double> now_c;

  double above_reference_c() const { return now_c.value_or(reference_c) - reference_c; }

  friend bool operator==(const SensorTemperature&, const SensorTemperature&) = default;
};

/// Dependence of depth and signal on the temperature of the camera, found by a calibration.
/// Measured tables are valid at the reference temperature. With `sensor`, the effects of the
/// temperatures of light source and sensor add up.
struct Temperature {
  double reference_c = 25.0;
  double offset_m_per_c = 0.0;
  double signal_per_c = 0.0;    ///< d log(signal) per degree
  std::optional<double> now_c;  ///< none: the reference
  /// Absent: a single temperature.
  std::optional<SensorTemperature> sensor;

  double above_reference_c() const { return now_c.value_or(reference_c) - reference_c; }
  /// Change of the measured depth by all temperatures [m].
  double offset_m() const;
  /// Signal relative to the reference temperatures.
  double signal_gain() const;

  /// @throws InvalidArgument
  void validate() const;

  friend bool operator==(const Temperature&, const Temperature&) = default;
};

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
  std::optional<Optics> optics;  ///< none: light levels in electrons only
  OperatingRange operating;
  std::optional<Playback> playback;        ///< none: exposures are as in the code
  std::optional<Temperature> temperature;  ///< none: no dependence

  /// Returns the time between the beginnings of consecutive frames [s].
  /// @throws InvalidArgument if frame_period_s is too short
  double frame_period_s(int exposures) const;
  /// Returns the time from the beginning of frame 0 to the middle of an exposure [s].
  double exposure_middle_s(int frame, int exposure, int exposures) const;
  /// Returns the time from the beginning of frame 0 to half-way between the beginning of the first
  /// and the end of the last exposure of a frame [s].
  double frame_middle_s(int frame, int exposures) const;

  /// Unambiguous range [m]: c / (2 f0).
  double range_m() const;
  /// Depth of one bin [m].
  double bin_m() const;
  /// Returns H_d(n f0) conj(H_m(n f0)) for n = 0 to `highest`, with the transfer functions H_d of
  /// the sensor and H_m of the light source. For rows: conj(H_d H_m), because both arms delay the
  /// light.
  Eigen::VectorXcd transfer(int highest) const;
  /// Returns H_m(n f0). Edge jitter of rms s blurs the mean waveform, with the factor
  ///   exp(-(2 pi n f0 s)^2 / 2).
  Eigen::VectorXcd light_transfer(int highest) const;
  /// Returns H_d(n f0), with jitter.
  Eigen::VectorXcd sensor_transfer(int highest) const;
  /// Returns true if either arm has an impulse response or jitter.
  bool band_limited() const;
  /// The same for the light source alone.
  bool light_is_band_limited() const;

  /// @throws InvalidArgument
  void validate() const;

  friend bool operator==(const Camera&, const Camera&) = default;
};

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

/// Returns the camera with operating points for surfaces of the given albedo at these distances,
/// computed by its optics, brightest first.
/// @param klux  overrides the sunlight of the optics
/// @throws InvalidArgument for invalid arguments, or a camera without optics
Camera at_distances(Camera camera, std::vector<double> distances_m, double albedo = 1.0,
                    std::optional<double> klux = {});

/// Returns the default light of captures: signal of white surfaces at the given distance and
/// ambient light, from the camera's optics. The middle operating point replaces missing optics or
/// sunlight.
OperatingPoint capture_light(const Camera& camera, double reference_distance_m);

/// Returns the camera on which codes are evaluated: its pixels measure the sum of n =
/// `operating.neighbours` pixels. Exposures, gaps, frame period, full well and converter saturation
/// are n times as large, read noise and quantization sqrt(n) times. The black level is assumed to
/// be so high that the converter clips no small values.
/// @throws InvalidArgument if the camera is invalid
Camera judged_camera(const Camera& camera);

/// Returns the integration times of the exposures in the order of the camera [s]: its list, or its
/// total split by the shares of the code.
/// @throws InvalidArgument if the camera lists times for another number of exposures
std::vector<double> exposure_times_s(const CodeSet& code, const Camera& camera);
/// Returns the camera with a list of the integration times of a code; unchanged for equal shares.
Camera timed_by(const CodeSet& code, Camera camera);

/// Returns why a valid `camera` does not support `code`; none if it does.
std::optional<std::string> why_not_playable(const CodeSet& code, const Camera& camera);

/// @throws InvalidArgument with the text of why_not_playable()
void require_fits(const CodeSet& code, const Camera& camera);

/// Returns the camera with two buckets that is equivalent to a mixer: the buckets are open at
/// weights of 1 and -1, and their difference is the measurement. Each bucket has half of the noise
/// variance without light. Full well, converter and mismatch are removed. Returns other cameras
/// unchanged.
Camera in_buckets(Camera camera);

/// Returns why build_family() fails; none if it succeeds.
std::optional<std::string> why_no_family(std::string_view name, const Camera& camera);

/// Builds a family with the camera's number of samples, within its peak. For two taps, every
/// demodulation gets its complement as second bucket; for a mixer, demodulations become weights
/// from -1 to 1.
/// @throws InvalidArgument with the text of why_no_family()
CodeSet build_family(std::string_view name, const Camera& camera);

/// Source of a number in a camera.
struct NumberSource {
  std::string key;     ///< "sensor.taps", or a table or value with several keys
  std::string source;  ///< data sheet or paper
};

/// Built-in camera: of the paper, or commercial.
struct BuiltInCamera {
  std::string name;
  std::string description;
  /// Family of its raw frames, or one that suits it; "": none.
  std::string code;
  std::vector<NumberSource> sources;

  /// Returns the source of a key such as "light.peak_factor"; "assumed" if unknown.
  std::string source_of(std::string_view key) const;
};

inline constexpr std::string_view default_camera_name = "indoor";

std::vector<BuiltInCamera> list_built_in_cameras();
std::vector<std::string> built_in_camera_names();
/// @throws InvalidArgument for an unknown name
Camera built_in_camera(const std::string& name);

}  // namespace tofsmith
