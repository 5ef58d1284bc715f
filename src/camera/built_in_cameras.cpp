// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Returns a camera that models the point-scanning bench of the paper: f0 = 5 MHz (range 29.98 m);
/// N = 300 samples, 3 per point of a generator of 500 MS/s and 14 bits with 100 points per period;
/// one generator and a Hann response of 150 MHz on each arm; p = 15.
///
/// The mixer multiplies the detector signal by 2 d - 1, whose mean equals the difference of two
/// taps with gains d and 1 - d: taps = 2, drain = false, readout = "difference". Ambient light and
/// dark current cancel in the mean (for d of duty 1/2), but not in the noise. The paper's read
/// noise of 20 e per measurement is 20 / sqrt(2) per tap. Shot noise is computed for all light,
/// which is pessimistic where the mixer is not at +1 or -1.
///
/// Signals are 1e6 e/s (assumed for 1 mW of average source power) behind optical densities 3 to 0.
/// The exposure is 0.3 s per point in total.
/// @see Gutierrez-Barragan et al., CVPR 2019, Table 1 and Fig. 9
Camera prototype_camera() {
  Camera camera;
  camera.name = "prototype";
  camera.fundamental_frequency_hz = 5e6;
  camera.exposure_s.total_s = 0.3;
  camera.samples = 300;
  camera.light.peak_factor = 15.0;
  camera.light.impulse_response.kind = ImpulseResponse::Kind::hann;
  camera.light.impulse_response.f_max_hz = 150e6;
  camera.light.generator = Generator{.sample_rate_hz = 500e6, .amplitude_bits = 14};
  camera.sensor.impulse_response = camera.light.impulse_response;
  camera.sensor.generator = camera.light.generator;
  camera.sensor.taps = 2;
  camera.sensor.drain = false;
  camera.sensor.readout = Readout::difference;
  camera.sensor.read_noise_e = 20.0 / std::numbers::sqrt2;
  camera.sensor.noise = NoiseModel::gaussian;  // as in the simulations of the paper
  constexpr double signal_at_od0_e_per_s = 1e6;
  for (const double optical_density : {3.0, 2.0, 1.0, 0.0})
    camera.operating.signal_e_per_s.push_back(signal_at_od0_e_per_s *
                                              std::pow(10.0, -optical_density));
  camera.operating.ambient_e_per_s = {1e3, 1e4};
  camera.validate();
  return camera;
}

using Sources = std::vector<NumberSource>;

constexpr const char* paper = "Gutierrez-Barragan et al., CVPR 2019";

Camera paper_camera(double peak_factor, std::optional<double> band_in_f0) {
  Camera camera;
  camera.sensor.noise = NoiseModel::gaussian;  // as the paper simulates it
  camera.operating = paper_operating_range();
  camera.light.peak_factor = peak_factor;
  if (band_in_f0) {
    ImpulseResponse response;
    response.kind = ImpulseResponse::Kind::hann;
    response.f_max_hz = *band_in_f0 * camera.fundamental_frequency_hz;
    camera.light.impulse_response = camera.sensor.impulse_response = response;
  }
  return camera;
}

Sources paper_sources() {
  Sources sources;
  for (const char* key :
       {"fundamental_frequency_hz", "exposure_s", "light.peak_factor", "light.impulse_response",
        "sensor.impulse_response", "sensor.read_noise_e", "sensor.noise", "operating"})
    sources.push_back({key, paper});
  return sources;
}

/// Typical parts in a room: a laser diode of 1 W and a pixel, both with 100 MHz. One tap and no
/// saturation, because it is the default for decoding raw frames. The signals correspond to white
/// surfaces at 1.1, 2.1 and 3.6 m; the ambient light ranges from lamps to 5 klx of sunlight.
Camera indoor_camera() {
  Camera camera;
  camera.fundamental_frequency_hz = 20e6;
  camera.exposure_s.total_s = 10e-3;
  camera.light.peak_factor = 4.0;
  ImpulseResponse response;
  response.kind = ImpulseResponse::Kind::lowpass;
  response.cutoff_hz = 100e6;
  camera.light.impulse_response = camera.sensor.impulse_response = response;
  camera.optics = Optics{.source_power_w = 1.0,
                         .wavelength_m = 940e-9,
                         .field_of_view_deg = {70.0, 55.0},
                         .f_number = 1.2,
                         .pixel_pitch_m = 10e-6,
                         .quantum_efficiency = 0.3,
                         .transmission = 0.85,
                         .fill_factor = 0.9,
                         .filter_width_m = 30e-9};
  camera.operating = {.signal_e_per_s = {1e6, 3e6, 1e7}, .ambient_e_per_s = {1e5, 1e6, 1e7}};
  return camera;
}

/// Three exclusive taps with a clock of nine chips per period. The light may always be on (peak
/// factor 1), and S is the rate at peak light.
Camera three_tap_camera() {
  Camera camera;
  constexpr double chip_s = 10e-9;
  camera.fundamental_frequency_hz = 1.0 / (9 * chip_s);
  camera.exposure_s.total_s = 10e-3;
  camera.samples = 180;  // chips of 9, 10, 12, 15, 18 and 20 per period are whole bins
  camera.light.peak_factor = 1.0;
  camera.sensor.taps = 3;
  camera.sensor.shortest_pulse_s = chip_s;
  camera.operating = {.signal_e_per_s = {1.1e6, 1.7e7}, .ambient_e_per_s = {0.0, 8e7}};
  return camera;
}

/// A commercial camera that outputs the difference of two taps, with light that is on for half of
/// the time. Full well and converter are not set, because the electrons per count are unknown.
Camera two_tap_camera(double fundamental_frequency_hz, double exposure_s) {
  Camera camera;
  camera.fundamental_frequency_hz = fundamental_frequency_hz;
  camera.exposure_s.total_s = exposure_s;
  camera.samples = 720;  // >= 36 per period of their highest frequency
  camera.light.peak_factor = 2.0;
  camera.sensor.taps = 2;
  camera.sensor.drain = false;
  camera.sensor.readout = Readout::difference;
  camera.sensor.modulation_contrast = 0.7;
  camera.operating = {.signal_e_per_s = {1e5, 1e6, 1e7}, .ambient_e_per_s = {1e5, 1e6}};
  return camera;
}

Camera with_frequencies(Camera camera, std::vector<double> frequencies_hz, int phase_steps,
                        int max_exposures) {
  SquareLight& square = camera.light.square.emplace();
  square.frequencies_hz = std::move(frequencies_hz);
  square.phase_steps = phase_steps;
  camera.sensor.max_exposures = max_exposures;
  return camera;
}

/// Frequencies are a clock of 96 MHz divided by 4 and by a second divider.
Camera epc660() {
  Camera camera = two_tap_camera(12e6, 4e-3);
  SquareLight& square = camera.light.square.emplace();
  square.clock_hz = 24e6;
  square.dividers = {1, 2, 4, 8, 16, 32};
  return camera;
}

struct Entry {
  BuiltInCamera listed;
  Camera camera;
};

std::vector<Entry> entries() {
  constexpr const char* kinect_pixel =
      "Sell and O'Connor, IEEE Micro 34(2), 2014, by libfreenect2's issue 150: differential";
  constexpr const char* epc = "epc660 datasheet, as in mlx75027_config's registers";
  constexpr const char* melexis = "Melexis MLX75027 datasheet, as in mlx75027_config's registers";
  return {
      {{std::string(default_camera_name),
        "typical components, indoors: 1 W, 100 MHz",
        "hamiltonian-k4",
        {}},
       indoor_camera()},
      {{"paper-30x", "simulations of the CVPR 2019 paper, peak factor 30, no band limit",
        "hamiltonian-k4", paper_sources()},
       paper_camera(30.0, {})},
      {{"paper-10f0", "simulations of the CVPR 2019 paper, bandwidth limited to 10 f0",
        "hamiltonian-k4", paper_sources()},
       paper_camera(15.0, 10.0)},
      {{"paper-5f0", "simulations of the CVPR 2019 paper, bandwidth limited to 5 f0",
        "hamiltonian-k4", paper_sources()},
       paper_camera(15.0, 5.0)},
      {{"prototype",
        "bench of the CVPR 2019 paper, with its waveform generators",
        "hamiltonian-k4",
        {{"light.peak_factor", paper},
         {"light.generator", paper},
         {"sensor.generator", paper},
         {"sensor.read_noise_e", std::string(paper) + ": 20 e, over the root of two taps"}}},
       prototype_camera()},
      {{"exclusive-3tap-9chip", "three exclusive taps on a clock of nine chips", "", {}},
       three_tap_camera()},
      {{"kinect-v2",
        "Microsoft Kinect v2: 16, 80 and 120 MHz, three phases each",
        "multifrequency-2x3-10x3-15x3",
        {{"fundamental_frequency_hz",
          "gcd of 16, 80, 120 MHz: Järemo Lawin et al., ECCV 2016; phases: libfreenect2"},
         {"light.frequencies_hz", "16, 80, 120 MHz: Järemo Lawin et al., ECCV 2016"},
         {"light.phase_steps", "three phases each: libfreenect2"},
         {"sensor.max_exposures", "nine raw frames: libfreenect2"},
         {"sensor.taps", kinect_pixel},
         {"sensor.readout", kinect_pixel}}},
       with_frequencies(two_tap_camera(8e6, 9e-3), {16e6, 80e6, 120e6}, 3, 9)},
      {{"mlx75027",
        "Melexis MLX75027, VGA: 80 and 100 MHz, four phases each",
        "multifrequency-4x4-5x4",
        {{"fundamental_frequency_hz",
          std::string(melexis) + ": 4 to 100 MHz; these two are assumed"},
         {"exposure_s", std::string(melexis) + ": 1 ms a phase by default"},
         {"light.frequencies_hz",
          std::string(melexis) + ": 4 to 100 MHz; listed are the multiples of 20 MHz"},
         {"light.phase_steps", std::string(melexis) + ": P0_PHASE_SHIFT in eighths"},
         {"sensor.max_exposures", std::string(melexis) + ": eight raw frames"},
         {"sensor.taps", std::string(melexis) + ": A and B"},
         {"sensor.readout", std::string(melexis) + ": A - B by default"}}},
       with_frequencies(two_tap_camera(20e6, 8e-3), {20e6, 40e6, 60e6, 80e6, 100e6}, 8, 8)},
      {{"epc660",
        "ESPROS epc660, QVGA: 12 MHz, four phases",
        "sinusoid-k4",
        {{"fundamental_frequency_hz", std::string(epc) + ": 96 MHz / 2 / 4 by default"},
         {"light.clock_hz", std::string(epc) + ": 96 MHz / 4"},
         {"light.dividers", std::string(epc) + ": mod_clk_div + 1; listed are the powers of two"}}},
       epc660()},
      {{"adsd3100",
        "Analog Devices ADSD3100, 1 megapixel: three frequencies (assumed), three phases each",
        "multifrequency-15x3-18x3-20x3",
        {{"exposure_s",
          "nine raw frames in the long-range mode: ToF SDK, mode_info.cpp; 1 ms each is assumed"}}},
       two_tap_camera(10e6, 9e-3)},
      {{"arducam-tof",
        "Arducam ToF camera in its 4 m mode, 240 x 180: 37.5 MHz, four phases",
        "sinusoid-k4",
        {{"fundamental_frequency_hz",
          "Arducam's SDK: _f_mod = 375e5 for a range of 4 (Arducam_tof_camera, issue 62)"}}},
       two_tap_camera(37.5e6, 4e-3)},
  };
}

}  // namespace

std::string BuiltInCamera::source_of(std::string_view key) const {
  std::string source = "assumed";
  std::size_t longest = 0;
  for (const NumberSource& candidate : sources) {
    const std::string& part = candidate.key;
    const bool covers =
        key.starts_with(part) && (key.size() == part.size() || key[part.size()] == '.');
    if (!covers || part.size() < longest) continue;
    longest = part.size();
    source = candidate.source;
  }
  return source;
}

std::vector<BuiltInCamera> list_built_in_cameras() {
  std::vector<BuiltInCamera> all;
  for (Entry& entry : entries()) all.push_back(std::move(entry.listed));
  return all;
}

std::vector<std::string> built_in_camera_names() {
  std::vector<std::string> names;
  for (const Entry& entry : entries()) names.push_back(entry.listed.name);
  return names;
}

Camera built_in_camera(const std::string& name) {
  for (Entry& entry : entries()) {
    if (entry.listed.name != name) continue;
    entry.camera.name = name;
    return std::move(entry.camera);
  }
  const std::vector<std::string> names = built_in_camera_names();
  const std::string near = nearest_word(name, names);
  reject("camera", name,
         fmt::format("is not a built-in camera ({}){}", fmt::join(names, ", "),
                     near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

}  // namespace tofsmith
