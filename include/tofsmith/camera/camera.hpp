// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/generator.hpp"
#include "tofsmith/camera/impulse_response.hpp"
#include "tofsmith/camera/second_returns.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith {

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

/// How the values of an exposure's taps leave the sensor.
enum class Readout {
  separate,    ///< each tap by itself
  difference,  ///< two taps as A - B; their shot and read noise add
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
  double read_noise_e = 20.0;          ///< standard deviation per readout [e], >= 0
  NoiseModel noise = NoiseModel::poisson;  ///< how noise is drawn
  double dark_current_e_per_s = 0.0;       ///< per tap [e/s], >= 0
  double modulation_contrast = 1.0;        ///< C in (0, 1]; below 1 the taps mix
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

  friend bool operator==(const Sensor&, const Sensor&) = default;
};

/// Pinhole of the sensor; needed for point clouds and to turn z-depth into radial distance.
struct Lens {
  double fx_px = 0.0;  ///< focal length in columns [px], > 0
  double fy_px = 0.0;  ///< focal length in rows [px], > 0
  double cx_px = 0.0;  ///< column of the optical axis [px]
  double cy_px = 0.0;  ///< row of the optical axis [px]

  friend bool operator==(const Lens&, const Lens&) = default;
};

/// Light levels, as photo-electron rates were the sensor fully open.
struct OperatingPoint {
  double signal_e_per_s = 0.0;   ///< S, of the modulated light
  double ambient_e_per_s = 0.0;  ///< A, of everything else

  friend bool operator==(const OperatingPoint&, const OperatingPoint&) = default;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<OperatingPoint> auto& p) {
  return std::tuple(Field("signal_e_per_s", p.signal_e_per_s, "finite and >= 0"),
                    Field("ambient_e_per_s", p.ambient_e_per_s, "finite and >= 0"));
}

/// Where a code is judged: every pair of signal and ambient.
struct OperatingRange {
  std::vector<double> signal_e_per_s;
  std::vector<double> ambient_e_per_s;
  DepthErrorKind error = DepthErrorKind::linear;
  double albedo = 1.0;          ///< scales the signal, (0, 1]
  bool uniform_albedo = false;  ///< instead: a fresh uniform draw in (0, 1) for every trial
  /// Second returns that designs reckon with; none: light comes back once.
  std::optional<SecondReturns> multipath = {};

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

/// A continuous-wave time-of-flight camera. Field names are the keys of the TOML file.
struct Camera {
  std::string name = "camera";
  double fundamental_frequency_hz = 15e6;  ///< f0, > 0
  ExposureTime exposure_s;
  int samples = 240;  ///< N, samples per period, 8 .. 65536
  LightSource light;
  Sensor sensor;
  std::optional<Lens> lens;
  OperatingRange operating;

  /// Largest depth the camera can tell from zero [m]: c / (2 f0).
  double range_m() const;
  /// Depth of one bin [m]: range / N.
  double bin_m() const;
  /// H_d(n f0) conj(H_m(n f0)) for n = 0 .. highest: what both arms leave of harmonic n.
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

/// Why `code` cannot be played and read out on `camera`, a valid one: taps, samples, peak,
/// exposures, what a sensor without drain leaves to no tap, or pulses too short for the light's
/// generator. None: it can.
std::optional<std::string> why_not_playable(const CodeSet& code, const Camera& camera);

/// The same as a check.
/// @throws InvalidArgument with the text of why_not_playable(), if there is one
void require_fits(const CodeSet& code, const Camera& camera);

/// Why no family `name` can be built for the camera; none: build_family() does.
std::optional<std::string> why_no_family(std::string_view name, const Camera& camera);

/// The family `name`, built for the camera: within its peak, on its samples, with the second bucket
/// of every measurement where the sensor has two taps.
/// @throws InvalidArgument with the text of why_no_family(), if there is one
CodeSet build_family(std::string_view name, const Camera& camera);

/// Cameras that need no file: paper-30x, paper-10f0, paper-5f0, prototype (prototype.hpp) and
/// exclusive-3tap-9chip: three taps and a clock of 9 chips of 10 ns, for design/chip_search.hpp.
std::vector<std::string> built_in_camera_names();
/// @throws std::invalid_argument for an unknown name, with the nearest known one
Camera built_in_camera(const std::string& name);

/// Light levels of the paper's grid: the 25 pairs of S in {1e3, 10^3.5, 1e4, 10^4.5, 1e5} and
/// A in {1e2, 1e3, 1e4, 10^4.5, 1e5} e/s.
OperatingRange paper_operating_range();

}  // namespace tofsmith
