// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fast_random.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith::benchmarks {

/// A code on the camera paper-10f0.
struct DecodeCode {
  std::string_view name;    ///< option value
  std::string_view family;  ///< argument of build_family()
  int taps;
  int built_samples;  ///< every switching time is at a sample
};
inline constexpr std::array decode_codes = {
    DecodeCode{"k3", "hamiltonian-k3", 1, 240}, DecodeCode{"k4", "hamiltonian-k4", 1, 240},
    DecodeCode{"k5", "hamiltonian-k5", 1, 240}, DecodeCode{"two-bucket", "hamiltonian-k4", 2, 240},
    DecodeCode{"rank7", "hamiltonian-k8", 1, 252}};

/// @throws std::invalid_argument for unknown names
inline const DecodeCode& decode_code(std::string_view name) {
  for (const DecodeCode& code : decode_codes)
    if (code.name == name) return code;
  reject("code", name, "must be k3, k4, k5, two-bucket or rank7");
}

struct LightLevel {
  std::string_view noise;
  double signal_e_per_s;
  double ambient_e_per_s;
};
inline constexpr std::array light_levels = {
    LightLevel{"low", 1e5, 1e4}, LightLevel{"medium", 1e4, 1e4}, LightLevel{"high", 1e3, 1e4}};

/// Builds the code where sampling is exact, then resamples it to N.
inline ForwardModel forward_model(const DecodeCode& code, int samples) {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = code.built_samples;
  camera.sensor.taps = code.taps;
  const CodeSet built = build_family(code.family, camera).resampled(samples);
  camera.samples = built.samples();
  return ForwardModel(built, camera);
}

inline Camera decode_camera(const DecodeCode& code, int samples) {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = samples;
  camera.sensor.taps = code.taps;
  return camera;
}

inline DecodingTable decoding_table(const DecodeCode& code, int samples) {
  return make_decoding_table(forward_model(code, samples), decode_camera(code, samples));
}

inline constexpr int frame_width = 640, frame_height = 480;
inline constexpr int frame_pixels = frame_width * frame_height;

enum class Scene {
  planes,  ///< slanted planes with steps: neighbours have similar depths
  random,  ///< independent depths
};

/// Depth of each pixel of a scene [bins].
inline std::vector<double> scene_depth_bins(Scene scene, int samples, FastRandom& random) {
  constexpr int patch_width = 80, patch_height = 60;
  std::vector<double> depth_bin(static_cast<std::size_t>(frame_pixels));
  if (scene == Scene::random) {
    for (double& depth : depth_bin) depth = random.uniform(0.0, samples);
    return depth_bin;
  }
  for (int top = 0; top < frame_height; top += patch_height)
    for (int left = 0; left < frame_width; left += patch_width) {
      const double centre = random.uniform(0.15, 0.85) * samples;
      const double right = random.uniform(-0.05, 0.05) * samples / patch_width;
      const double down = random.uniform(-0.05, 0.05) * samples / patch_height;
      for (int row = 0; row < patch_height; ++row)
        for (int column = 0; column < patch_width; ++column)
          depth_bin[static_cast<std::size_t>((top + row) * frame_width + left + column)] =
              centre + right * (column - 0.5 * patch_width) + down * (row - 0.5 * patch_height);
    }
  return depth_bin;
}

/// Appends the raw values of a pixel (K), interpolated linearly in the table; `noise` scales the
/// standard deviation.
inline void append_pixel(const DecodingTable& table, double depth_bin, double signal_e_per_s,
                         double ambient_e_per_s, double noise, FastRandom& random,
                         std::vector<float>& raw) {
  const int from = static_cast<int>(depth_bin) % table.samples(), to = (from + 1) % table.samples();
  const double t = depth_bin - std::floor(depth_bin);
  for (int k = 0; k < table.measurements(); ++k) {
    const double chi = (1 - t) * table.correlation(from, k) + t * table.correlation(to, k);
    const double mean =
        table.exposure_s[k] * (signal_e_per_s * chi + ambient_e_per_s * table.ambient_gain[k]) +
        table.dark_electrons[k];
    const double deviation = std::sqrt(mean + table.constant_variance_e2[k]);
    raw.push_back(
        static_cast<float>((mean + noise * deviation * random.normal()) / table.gain_e_per_raw[k] +
                           table.black_level[k]));
  }
}

/// Raw values (H, W, K) of a scene with noise.
inline std::vector<float> noisy_frame(const DecodingTable& table, Scene scene,
                                      const LightLevel& light) {
  FastRandom random(7);
  std::vector<float> raw;
  raw.reserve(static_cast<std::size_t>(frame_pixels * table.measurements()));
  for (const double depth : scene_depth_bins(scene, table.samples(), random))
    append_pixel(table, depth, light.signal_e_per_s, light.ambient_e_per_s, 1.0, random, raw);
  return raw;
}

struct DecodedPlanes {
  std::vector<std::int32_t> bin = std::vector<std::int32_t>(frame_pixels);
  DepthImage image{frame_height, frame_width};
};

enum class OutputSet { bin, depth, depth_signal_ambient, depth_confidence_status, all };
inline constexpr std::array output_sets = {OutputSet::bin, OutputSet::depth,
                                           OutputSet::depth_signal_ambient,
                                           OutputSet::depth_confidence_status, OutputSet::all};

inline DecodedView view_of(OutputSet set, DecodedPlanes& planes) {
  DecodedView all = DecodedView::of(planes.image);
  all.bin = planes.bin.data();
  switch (set) {
    case OutputSet::bin:
      return {.bin = all.bin};
    case OutputSet::depth:
      return {.depth_m = all.depth_m};
    case OutputSet::depth_signal_ambient:
      return {.depth_m = all.depth_m,
              .signal_e_per_s = all.signal_e_per_s,
              .ambient_e_per_s = all.ambient_e_per_s};
    case OutputSet::depth_confidence_status:
      return {.depth_m = all.depth_m, .confidence = all.confidence, .status = all.status};
    case OutputSet::all:
      break;
  }
  return all;
}

}  // namespace tofsmith::benchmarks
