// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

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

}  // namespace tofsmith::benchmarks
