// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/lens_distortion.hpp"

namespace tofsmith {

/// How a light source or a sensor smooths the waveform that drives it. Its transfer function is 1
/// at frequency 0, so mean power and duty stay.
struct ImpulseResponse {
  enum class Kind { none, hann, gaussian, lowpass, file };

  Kind kind = Kind::none;  ///< its shape
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

/// Multipath that a camera meets: one second return, of ratio and delay uniform between their
/// limits. Field names are the keys of [operating.multipath] in the TOML file.
struct OperatingMultipath {
  std::array<double, 2> ratio{0.1, 0.5};    ///< r = S2 / S1, smallest and largest, in [0, 1]
  std::array<double, 2> delay_m{0.5, 3.0};  ///< behind the direct return, in (0, range) [m]
  /// How much they count where codes are designed: what is minimized is E1^(1 - weight) E2^weight,
  /// with E1 the error of single returns and E2 that with such a second one, decoded as
  /// single-path; in (0, 1).
  double weight = 0.2;

  /// A ratio and a delay from two numbers uniform on [0, 1).
  double ratio_at(double uniform) const { return ratio[0] + uniform * (ratio[1] - ratio[0]); }
  double delay_at_m(double uniform) const {
    return delay_m[0] + uniform * (delay_m[1] - delay_m[0]);
  }

  /// E1^(1 - weight) E2^weight.
  double weighed(double single_return_error, double operating_multipath_error) const;

  /// @throws std::invalid_argument naming the field as operating.multipath.*, value and rule
  void validate(double range_m) const;

  friend bool operator==(const OperatingMultipath&, const OperatingMultipath&) = default;
};

/// An arbitrary waveform generator, or a memory of patterns, that drives one arm of a camera from a
/// table of points. Its analog bandwidth is not here: it belongs to the arm's impulse response.
struct Generator {
  double sample_rate_hz = 500e6;  ///< most points per second [1/s], > 0
  int amplitude_bits = 14;        ///< of a point's amplitude, 1 .. 24
  /// Points of the table that holds one period, 2 .. 2^20; none: as many as are played. A table of
  /// more points than the sample rate allows is played by skipping some.
  std::optional<int> table_points = {};
  /// Binary waveforms switch at multiples of this time only [s]; it divides the period. None: at
  /// any point.
  std::optional<double> edge_grid_s = {};

  /// Points of one period that are played, n: as many whole ones as the sample rate allows,
  /// n f0 <= sample rate, and as the table has. The clock is then n f0.
  int points_per_period(double fundamental_frequency_hz) const;
  /// Points of the table that holds one period.
  int points_in_table(double fundamental_frequency_hz) const;

  /// @throws std::invalid_argument naming `field`.member, value and rule; also where a period has
  ///         fewer than 2 points
  void validate(std::string_view field, double fundamental_frequency_hz) const;

  friend bool operator==(const Generator&, const Generator&) = default;
};

/// What a generator's table holds of a nominal waveform, each point held for 1/n of the period.
///   - Switching times of a binary waveform first move to the edge grid, if there is one.
///   - A point takes the waveform's value at the middle of its time, as in a table that a user
///     loads. So a switching time moves to the nearest point, by at most half a point (from the
///     middle between two to the earlier one), and a pulse shorter than a point may vanish.
///   - Amplitudes are rounded to 2^bits levels from 0 to the waveform's own peak. On and off are
///     levels: a binary waveform stays binary, and one whose switching times are points does not
///     change.
/// @throws std::invalid_argument if the generator cannot play that frequency, or for values below 0
Waveform generator_table(const Waveform& waveform, const Generator& generator,
                         double fundamental_frequency_hz);

/// The actual waveform of a generator for a nominal one: its table; of a table of more points than
/// it plays, the points at the middles of those it plays.
/// @throws std::invalid_argument as generator_table()
Waveform generated(const Waveform& waveform, const Generator& generator,
                   double fundamental_frequency_hz);

/// Where `generated` puts a switching time [periods].
double generated_switching_time(double switching_time_periods, const Generator& generator,
                                double fundamental_frequency_hz);

/// Where a generator of n points per period puts a switching time [points], as `generator_table`
/// does without an edge grid.
double nearest_point(double switching_time_periods, double points_per_period);

/// Light levels, as photo-electron rates were the sensor fully open.
struct OperatingPoint {
  double signal_e_per_s = 0.0;   ///< S, of the modulated light
  double ambient_e_per_s = 0.0;  ///< A, of everything else

  friend bool operator==(const OperatingPoint&, const OperatingPoint&) = default;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<OperatingPoint> auto& p) {
  return std::tuple(Field("signal_e_per_s", p.signal_e_per_s, at_least(0)),
                    Field("ambient_e_per_s", p.ambient_e_per_s, at_least(0)));
}

/// How the noise of electrons is drawn.
enum class NoiseModel {
  poisson,   ///< Poisson electrons plus Gaussian read noise
  gaussian,  ///< one Gaussian of the same variance, as in the paper
};

/// Which difference between true and decoded depth counts.
enum class DepthErrorKind {
  linear,    ///< |decoded - true|, as in the paper: a wrap at the end of the range costs all of it
  circular,  ///< the shorter way round the range
};
/// The enumerator's name.
constexpr std::string_view name_of(DepthErrorKind kind) {
  return kind == DepthErrorKind::linear ? "linear" : "circular";
}

/// What leaves the sensor of the light of an exposure.
enum class Readout {
  separate,    ///< each tap by itself
  difference,  ///< two taps as A - B; their shot and read noise add
  /// Rows: weighted sums of the light in N time bins of one exposure, the weights of any sign. All
  /// are of the same light, so that their noise is correlated. Dead time is ignored.
  rows,
};

/// What the sensor multiplies the light by.
enum class Demodulation {
  gain,  ///< a share in [0, 1]: taps gather charge while their gates are open
  /// A weight in [-1, 1]: a mixer. Light makes shot noise by the square of its weight.
  weight,
};

/// The modulated light source.
struct LightSource {
  double peak_factor = 15.0;  ///< p = P_max / P_ave, >= 1
  bool binary = true;         ///< a design for it may only switch on and off
  ImpulseResponse impulse_response;
  double edge_jitter_s = 0.0;          ///< rms displacement of edges, period to period [s], >= 0
  std::optional<Generator> generator;  ///< plays the modulation; none: any waveform, exactly

  friend bool operator==(const LightSource&, const LightSource&) = default;
};

/// The demodulating pixel.
struct Sensor {
  int taps = 1;        ///< values read out of one exposure; 2 = two-bucket; n = exclusive taps
  bool binary = true;  ///< a design for it may only switch on and off
  ImpulseResponse impulse_response;
  double edge_jitter_s = 0.0;          ///< rms displacement of edges, period to period [s], >= 0
  std::optional<Generator> generator;  ///< plays the demodulation; none: any waveform, exactly
  double read_noise_e = 20.0;  ///< standard deviation per readout, of taps or rows [e], >= 0
  NoiseModel noise = NoiseModel::poisson;  ///< how noise is drawn
  double dark_current_e_per_s = 0.0;       ///< per tap; of rows, of all time bins [e/s], >= 0
  double modulation_contrast = 1.0;        ///< C in (0, 1]; below 1 the taps mix
  std::vector<double> modulation_contrasts = {};  ///< per exposure or frequency; empty: the above
  /// Relative difference in sensitivity of neighbouring taps (with one tap: of neighbouring
  /// exposures): 1 + m / 2 for the first, third, .., 1 - m / 2 for the others; in (-1, 1).
  double tap_mismatch = 0.0;
  std::optional<double> full_well_e;       ///< clip at this many electrons [e], > 0
  std::optional<int> adc_bits;             ///< quantize to this many bits, 1 .. 24
  std::optional<double> gain_e_per_dn;     ///< electrons per count [e/DN], > 0; with adc_bits
  std::optional<double> black_level_dn;    ///< count without light [DN], >= 0; with adc_bits
  std::optional<double> shortest_pulse_s;  ///< shortest pulse or gap a design may use [s], > 0
  bool drain = true;                       ///< charge may be thrown away; else taps add to 1
  Readout readout = Readout::separate;     ///< how taps leave the sensor
  Demodulation demodulation = Demodulation::gain;  ///< of taps, or of a mixer
  std::optional<double> readout_gap_s;   ///< dark time after each exposure [s], >= 0; none: 0
  std::optional<double> frame_period_s;  ///< from frame to frame [s], > 0; none: no pause

  std::vector<double> contrasts_of(const CodeSet& code) const;  ///< of every exposure, if it fits
  bool is_signed() const { return demodulation == Demodulation::weight; }  ///< a mixer
  /// Whether they are differences of light, so that ambient light may cancel, but not its noise.
  bool subtracts() const { return is_signed() || readout == Readout::difference; }

  friend bool operator==(const Sensor&, const Sensor&) = default;
};

/// Pinhole of the sensor, and how its lens distorts; needed for point clouds and to turn z-depth
/// into radial distance.
struct Lens {
  double fx_px = 0.0;                             ///< focal length in columns [px], > 0
  double fy_px = 0.0;                             ///< focal length in rows [px], > 0
  double cx_px = 0.0;                             ///< column of the optical axis [px]
  double cy_px = 0.0;                             ///< row of the optical axis [px]
  std::optional<LensDistortion> distortion = {};  ///< none: an ideal pinhole
  /// Of the images that all this is of [px], > 0, both or neither; none: of any.
  std::optional<int> width_px = {}, height_px = {};
  /// In place of all these, rays as makers give them: .npy, (H, W, 2) of x/z and y/z of each pixel,
  /// or (H, W, 3) of directions; pixels of NaN see nothing. Empty: the above.
  std::string rays = {};

  friend bool operator==(const Lens&, const Lens&) = default;
};

/// How the image is blurred before it falls on pixels, and how simulations sample it there. Light
/// is what is blurred: a pixel's expected electrons are a weighted sum of those of many rays. Field
/// names are keys of [lens] in the TOML file; the kind's key is `blur`.
struct LensBlur {
  enum class Kind {
    none,      ///< each ray falls where it points
    gaussian,  ///< on a Gaussian about it
    disc,      ///< on a disc of confusion, by its distance: a thin lens out of focus
  };
  Kind kind = Kind::none;
  double blur_sigma_px = 0.0;     ///< gaussian: standard deviation in each direction [px], (0, 32]
  double focal_length_m = 0.0;    ///< disc: f [m], > 0
  double f_number = 0.0;          ///< disc: focal length over aperture, > 0
  double focus_distance_m = 0.0;  ///< disc: what is this far is sharp [m], > focal length
  double pixel_pitch_m = 0.0;     ///< disc: between centres of pixels [m], > 0
  /// n: scenes of shapes send n x n rays, evenly over a pixel's square, 1 .. 16; 1: one ray
  /// through its centre. Depth images have one value a pixel, whatever n.
  int pixel_samples = 1;

  /// Whether nothing changes: every pixel sees the ray through its centre.
  bool is_sharp() const { return kind == Kind::none && pixel_samples == 1; }

  /// Radius of the disc of confusion of what is `distance_m` away; NaN: infinitely far [px].
  ///   r = f^2 / (2 k (z_f - f)) |1 - z_f / z| / pitch,  k the f-number, z_f the focus distance
  double disc_radius_px(double distance_m) const;

  /// @throws std::invalid_argument naming the field as lens.*, value and rule
  void validate() const;

  friend bool operator==(const LensBlur&, const LensBlur&) = default;
};

/// What turns watts and lux into electrons. Field names are keys of [optics] in the TOML file.
/// Surfaces are Lambertian and face the camera; the light fills its field of view evenly; the lens
/// is far from what it sees.
/// @see docs/optics.md for formulas and their sources
struct Optics {
  double source_power_w = 0.0;  ///< mean optical power of the modulated light [W], > 0
  double wavelength_m = 0.0;    ///< [m]
  /// Full angles that the light fills, across and down [degrees], (0, 180).
  std::array<double, 2> field_of_view_deg{};
  double f_number = 0.0;            ///< of the lens: focal length over aperture, > 0
  double pixel_pitch_m = 0.0;       ///< between centres of pixels [m], > 0
  double quantum_efficiency = 0.0;  ///< electrons per photon on the sensitive area, (0, 1]
  double transmission = 1.0;        ///< of lens and filter, at the wavelength, (0, 1]
  double fill_factor = 1.0;         ///< share of a pixel that is sensitive, (0, 1]
  std::optional<double> filter_width_m = {};  ///< band that the filter passes [m]; with sunlight
  /// Sunlight on the surface, by its illuminance [klx]: the global spectrum of ASTM G173-03, which
  /// has 109.9 klx. Where the filter passes within 800 to 1000 nm.
  std::optional<double> sunlight_klux = {};
  /// Or sunlight on the surface within the filter's band [W / m2 / nm].
  std::optional<double> sunlight_w_per_m2_nm = {};

  /// S and A of a surface of that albedo [e/s]:
  ///   S = albedo E tau / (4 k^2) pitch^2 fill QE lambda / (h c),
  ///   E = P / (4 d^2 tan(h / 2) tan(v / 2)); A the same of the sunlight that the filter passes.
  /// @throws std::invalid_argument naming field, value and rule
  OperatingPoint light_at(double distance_m, double albedo = 1.0) const;
  /// How far away a surface returns that signal [m].
  double distance_m(double signal_e_per_s, double albedo = 1.0) const;
  /// The mean optical power that it takes for that signal at that distance [W].
  double source_power_for_w(double signal_e_per_s, double distance_m, double albedo = 1.0) const;

  /// Irradiance by the light itself on a surface that faces it [W / m2].
  double source_w_per_m2(double distance_m) const;
  /// Irradiance by the sunlight that the filter passes on such a surface [W / m2].
  double sunlight_w_per_m2() const;
  /// Electrons of a pixel per joule that falls on a square metre of white surface.
  double electrons_per_j_per_m2() const;

  /// @throws std::invalid_argument naming the field as optics.*, value and rule
  void validate() const;

  friend bool operator==(const Optics&, const Optics&) = default;
};

/// Where a code is judged: every pair of signal and ambient.
struct OperatingRange {
  std::vector<double> signal_e_per_s;   ///< S [e/s], each >= 0
  std::vector<double> ambient_e_per_s;  ///< A [e/s], each >= 0
  DepthErrorKind error = DepthErrorKind::linear;
  double albedo = 1.0;          ///< scales the signal, (0, 1]
  bool uniform_albedo = false;  ///< instead: a fresh uniform draw in (0, 1) for every trial
  /// Pixels of one depth that a filter adds before it decodes, 1 .. 10000: codes are judged on such
  /// sums (judged_camera()).
  int neighbours = 1;
  /// Multipath that designs take into account; none: light comes back once.
  std::optional<OperatingMultipath> multipath = {};
  /// Where depths lie: nearest and farthest, 0 <= nearest < farthest <= range; none: anywhere in
  /// the unambiguous range.
  std::optional<std::array<double, 2>> working_distance_m = {};
  /// How often depths occur: weights >= 0 of equal parts of the working distance, or of the range,
  /// at most 10000 and not all 0; none: all depths alike.
  std::optional<std::vector<double>> depths = {};

  /// All pairs, signal by signal.
  std::vector<OperatingPoint> points() const;
  /// The pair in the middle of both lists.
  OperatingPoint middle() const;

  friend bool operator==(const OperatingRange&, const OperatingRange&) = default;
};

/// Integration time: a total that is split evenly over the exposures, or one time per exposure.
struct ExposureTime {
  double total_s = 0.3;        ///< [s], > 0; used when `each_s` is empty
  std::vector<double> each_s;  ///< [s], each > 0; must then match the code's exposures
  double of(int exposure, int exposures) const;

  friend bool operator==(const ExposureTime&, const ExposureTime&) = default;
};

/// How what a camera plays and reads out differs from the code's own words: what a calibration
/// finds once and everything then honours. Measured tables have it in them already.
struct Playback {
  /// Exposure of the code that is played first, second, ..: a permutation of 0, 1, ..; empty: as
  /// the code has them.
  std::vector<int> order;
  bool reversed = false;  ///< delay runs backwards: chi(-z) is measured where the code says chi(z)
  bool inverted = false;  ///< signs are opposite: taps are swapped, a single tap is open when the
                          ///< code says shut
  double offset_m = 0.0;  ///< everything looks so much farther [m]

  /// @throws std::invalid_argument naming the field as playback.*, value and rule
  void validate(int taps) const;

  friend bool operator==(const Playback&, const Playback&) = default;
};

/// How depth and signal change with the camera's temperature, as a calibration finds it. Measured
/// tables are those of the reference.
struct Temperature {
  double reference_c = 25.0;    ///< where nothing changes [degrees C]
  double offset_m_per_c = 0.0;  ///< everything looks so much farther per degree [m]
  double signal_per_c = 0.0;    ///< d log(signal) per degree: 0.01 is about 1 % more
  std::optional<double> now_c;  ///< that the camera has [degrees C]; none: the reference

  /// Degrees above the reference.
  double above_reference_c() const { return now_c.value_or(reference_c) - reference_c; }
  /// How much farther everything looks [m].
  double offset_m() const { return offset_m_per_c * above_reference_c(); }
  /// Signal over that at the reference.
  double signal_gain() const;

  /// @throws std::invalid_argument naming the field as temperature.*, value and rule
  void validate() const;

  friend bool operator==(const Temperature&, const Temperature&) = default;
};

/// A continuous-wave time-of-flight camera. Field names are the keys of the TOML file.
struct Camera {
  std::string name = "camera";
  double fundamental_frequency_hz = 15e6;  ///< f0, > 0
  ExposureTime exposure_s;
  int samples = 240;  ///< N, samples per period, 8 .. 65536
  LightSource light;
  Sensor sensor;
  RawMarkers raw;                ///< special raw numbers
  std::optional<Lens> lens;      ///< the pinhole: four keys of [lens]
  std::optional<LensBlur> blur;  ///< the other keys of [lens]; none: sharp
  std::optional<Optics> optics;  ///< what turns watts and lux into electrons; none: unknown
  OperatingRange operating;
  std::optional<Playback> playback;        ///< none: as codes say
  std::optional<Temperature> temperature;  ///< none: nothing changes with it

  /// Time from the beginning of a frame to that of the next [s]: sensor.frame_period_s, or as long
  /// as the exposures take, each with its gap.
  /// @throws std::invalid_argument if frame_period_s is shorter than those
  double frame_period_s(int exposures) const;
  /// Middle of an exposure [s], from the beginning of frame 0: exposures follow one another, with a
  /// gap after each.
  double exposure_middle_s(int frame, int exposure, int exposures) const;
  /// Middle between the beginning of a frame's first exposure and the end of its last [s].
  double frame_middle_s(int frame, int exposures) const;

  /// Depth after which everything repeats [m]: c / (2 f0).
  double range_m() const;
  /// Depth of one bin [m]: range / N.
  double bin_m() const;
  /// H_d(n f0) conj(H_m(n f0)) for n = 0 .. highest: transfer function of both arms together. Where
  /// rows are read out, the sensor's response delays what it detects, as the light's does:
  /// conj(H_d H_m).
  Eigen::VectorXcd transfer(int highest) const;
  /// H_m(n f0) of the light alone. The mean of edges that are displaced by normal deviations of
  /// rms s, period by period, is the waveform blurred by that normal density: a factor
  /// exp(-(2 pi n f0 s)^2 / 2) beside the impulse response.
  Eigen::VectorXcd light_transfer(int highest) const;
  /// H_d(n f0) of the sensor alone, with its jitter.
  Eigen::VectorXcd sensor_transfer(int highest) const;
  /// Whether either arm has an impulse response or jitter.
  bool band_limited() const;
  /// Whether the light has.
  bool light_is_band_limited() const;

  /// @throws std::invalid_argument naming the field, its value and the rule it breaks
  void validate() const;

  friend bool operator==(const Camera&, const Camera&) = default;
};

/// The camera judged on surfaces of that albedo at each of these distances: its operating points
/// are what its optics make of them, brightest first.
/// @param klux  sunlight on the surfaces, in place of the optics' own
/// @throws std::invalid_argument naming field, value and rule; also for a camera without optics
Camera at_distances(Camera camera, std::vector<double> distances_m, double albedo = 1.0,
                    std::optional<double> klux = {});

/// Light that captures have if nobody says another: that of the camera's optics on white surfaces
/// at that distance, with its sunlight, if it has any; else the middle of the operating points.
OperatingPoint capture_light(const Camera& camera, double reference_distance_m);

/// The camera whose single pixels measure what sums of `operating.neighbours` = n pixels do, and
/// what its codes are judged on: exposures n times as long, read noise sqrt(n) times as large with
/// quantization in it, full well and saturation of the converter n times as high, one neighbour. A
/// converter's black level is taken as high enough. The camera itself for n = 1.
/// @throws std::invalid_argument if the camera is invalid
Camera judged_camera(const Camera& camera);

/// Why `code` cannot be played and read out on `camera`, a valid one: taps, samples, peak,
/// exposures, light that no tap takes without a drain, pulses that are too short. None: it can.
std::optional<std::string> why_not_playable(const CodeSet& code, const Camera& camera);

/// The same as a check.
/// @throws InvalidArgument with the text of why_not_playable(), if there is one
void require_fits(const CodeSet& code, const Camera& camera);

/// Of a mixer the camera whose two buckets, open where a binary weight is 1 and where it is -1,
/// differ by what the mixer measures: each has half of its noise without light. Full well,
/// converter and mismatch are left out. Other cameras as they are.
Camera in_buckets(Camera camera);

/// Why no family `name` can be built for the camera; none: build_family() does.
std::optional<std::string> why_no_family(std::string_view name, const Camera& camera);

/// The family `name`, built for the camera: within its peak, on its samples, with the second bucket
/// of every measurement where the sensor has two taps, and from -1 to 1 where it is a mixer.
/// @throws InvalidArgument with the text of why_no_family(), if there is one
CodeSet build_family(std::string_view name, const Camera& camera);

/// Where a number of a camera's description is from.
struct NumberSource {
  std::string key;     ///< "sensor.taps", or the table or value that holds several keys
  std::string source;  ///< data sheet or paper, by name
};

/// A camera that needs no file, as lists show it: those of the paper, and some of the trade.
struct BuiltInCamera {
  std::string name;
  std::string description;  ///< one line
  /// The family that its raw frames are of, or that suits it (list_families()); "": none does.
  std::string code;
  std::vector<NumberSource> sources;

  /// Source of a key's value, "light.peak_factor"; "assumed" where none is known.
  std::string source_of(std::string_view key) const;
};

/// All of them; built_in_camera() builds each. built_in_camera_toml() writes one with its sources.
std::vector<BuiltInCamera> list_built_in_cameras();
/// Their names.
std::vector<std::string> built_in_camera_names();
/// @throws std::invalid_argument for an unknown name, with the nearest known one
Camera built_in_camera(const std::string& name);

/// The paper's 25 pairs of S in {1e3, 10^3.5, 1e4, 10^4.5, 1e5}, A in {1e2, 1e3, 1e4, 10^4.5, 1e5}.
OperatingRange paper_operating_range();

}  // namespace tofsmith
